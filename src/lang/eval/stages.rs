//! The stages that depend on everything declared: parts, network, surface model, meshes; each made once.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::Fault;
use crate::base::limits::WORK_OF_AN_ELEMENT;
use crate::base::origin::Origin;
use crate::base::work;
use crate::lang::eval::context::Cx;
use crate::lang::eval::faults::member_name;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::module::{Module, Stage, State};
use crate::lang::eval::pipeline::{Declared, Parts, Sound};
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::origins::NO_MEMBER;
use crate::lang::values::value::{MeshValue, ModuleId, ShellValue, Value};
use crate::lang::words::names::Names;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::network::Network;

/// Geometry that the network and the surface model are built from.
const GEOMETRY: &[Keyword] = &[Keyword::Point, Keyword::Curve, Keyword::ModelingCurve, Keyword::Surface];

/// Told declaration, keyword, indices, name and value of each member.
type MemberVisitor<'m> = &'m mut dyn FnMut(u32, Keyword, [u32; 2], Arc<str>, &Value);
/// Declaration, indices, name and value of a member.
type Found<T> = (u32, [u32; 2], Arc<str>, T);

/// Evaluates all declarations of these keywords; the first that failed is the reason to stop.
fn all(cx: &mut Cx, module: ModuleId, keywords: &[Keyword]) -> Result<(), Halt> {
    let script = cx.machine.at(module).script.clone();
    cx.machine.stages += 1;
    let mut stop: Option<Halt> = None;
    for (i, keyword) in script.declarations.keywords().enumerate() {
        if keywords.contains(&keyword)
            && let Err(found) = cx.ensure(module, i as u32)
        {
            stop = Some(match stop {
                Some(before) => before.or(found),
                None => found,
            });
        }
    }
    cx.machine.stages -= 1;
    // A curve that did not parse leaves a hole that must not be meshed over.
    if stop.is_none() && !script.broken.is_empty() {
        stop = Some(Halt::Broken);
    }
    stop.map_or(Ok(()), Err)
}

/// Values of a declaration with their members, in order.
fn walk(value: &Value, levels: usize, member: [u32; 2], level: usize, out: &mut dyn FnMut([u32; 2], &Value)) {
    match value {
        Value::List(items) if level < levels => {
            for (i, item) in items.iter().enumerate() {
                let mut member = member;
                member[level.min(1)] = i as u32;
                walk(item, levels, member, level + 1, out);
            }
        }
        other => out(member, other),
    }
}

/// Calls `out` for each evaluated member of each declaration with one of these keywords.
pub(crate) fn each_member(module: &Module, names: &Names, keywords: &[Keyword], out: MemberVisitor<'_>) {
    let declarations = &module.script.declarations;
    for (i, keyword) in declarations.keywords().enumerate() {
        if !keywords.contains(&keyword) {
            continue;
        }
        let (State::Done(value), Some(b)) = (&module.states[i], declarations.bound(i)) else { continue };
        // A shell of a part with several bodies is one of each.
        let levels = declarations.family_size(i) + usize::from(keyword == Keyword::Shell);
        walk(value, levels, [NO_MEMBER; 2], 0, &mut |member, value| {
            let name = names.text(b.name);
            let name = if member == [NO_MEMBER; 2] { name.into() } else { member_name(name, member).into() };
            out(i as u32, keyword, member, name, value);
        });
    }
}

/// What is evaluated so far of a script's geometry.
pub(crate) fn gather(cx: &mut Cx, module: ModuleId) -> Parts {
    let mut parts = Parts::default();
    let declared = |keyword| cx.machine.at(module).script.declarations.with_keyword(keyword).count();
    let mut points: Vec<Found<DVec3>> = Vec::with_capacity(declared(Keyword::Point));
    parts.curves.reserve(declared(Keyword::Curve));
    each_member(cx.machine.at(module), &cx.program.names, GEOMETRY, &mut |i, keyword, member, name, value| match (keyword, value) {
        (Keyword::Point, Value::Vector(p, _)) => points.push((i, member, name, *p)),
        (Keyword::Curve, Value::Curve(c)) => parts.curves.push(Declared { name, origin: c.origin(), value: c.clone() }),
        (Keyword::ModelingCurve, Value::Curve(c)) => parts.modeling.push(Declared { name, origin: c.origin(), value: c.clone() }),
        (Keyword::Surface, Value::Surface(s)) => parts.surfaces.push(Declared { name, origin: s.origin(), value: s.clone() }),
        _ => {}
    });
    parts.points.reserve_exact(points.len());
    for (declaration, member, name, value) in points {
        let origin = cx.own_origin(Code { nodes: &[], module, declaration }, member);
        parts.points.push(Declared { name, origin, value });
    }
    parts
}

/// Notes that what is being evaluated depends on everything that a script declares.
fn asks(cx: &mut Cx, module: ModuleId) {
    let own = cx.machine.running.last().is_none_or(|r| r.0 == module);
    cx.machine.asked.world = true;
    cx.machine.asked.fleeting |= !own;
}

/// Whether a curve, surface or point of a script is being made, so that the whole geometry cannot be asked for.
pub(crate) fn is_within(cx: &Cx, module: ModuleId) -> bool {
    cx.own_part(module, GEOMETRY).is_some()
}

pub(crate) fn parts(cx: &mut Cx, module: ModuleId) -> Result<Arc<Parts>, Halt> {
    asks(cx, module);
    if let Stage::Done(parts) = &cx.machine.at(module).parts {
        return Ok(parts.clone());
    }
    cx.tolerance()?;
    if let Some(part) = cx.own_part(module, GEOMETRY) {
        return Err(cx.circle_through_all(part));
    }
    all(cx, module, GEOMETRY)?;
    let parts = Arc::new(gather(cx, module));
    cx.machine.at_mut(module).parts = Stage::Done(parts.clone());
    Ok(parts)
}

/// Evaluates all declarations of these keywords; those that failed are left out, and the first of them is told.
fn all_sound(cx: &mut Cx, module: ModuleId, keywords: &[Keyword]) -> Result<Option<(ModuleId, u32)>, Halt> {
    asks(cx, module);
    all(cx, module, keywords).map_or_else(without, |()| Ok(None))
}

/// The declaration that failed where one can go on without it; what cannot be gone on from stays.
fn without(stop: Halt) -> Result<Option<(ModuleId, u32)>, Halt> {
    match stop {
        Halt::Skipped(m, d) => Ok(Some((m, d))),
        Halt::Broken | Halt::Failed => Ok(None),
        Halt::NotYet | Halt::Fault(_) | Halt::Bug(_) => Err(stop),
    }
}

/// Notes that meshes of a script are made without a declaration.
fn lacking(cx: &mut Cx, module: ModuleId, missing: Option<(ModuleId, u32)>) {
    let lacks = &mut cx.machine.at_mut(module).lacks;
    *lacks = lacks.or(missing);
}

/// The declared groups of a script with what they hold.
pub(crate) fn groups(cx: &mut Cx, module: ModuleId) -> Result<Vec<Declared<Vec<Value>>>, Halt> {
    let missing = all_sound(cx, module, &[Keyword::Group])?;
    lacking(cx, module, missing);
    let mut found: Vec<Found<Vec<Value>>> = Vec::new();
    each_member(cx.machine.at(module), &cx.program.names, &[Keyword::Group], &mut |i, _, member, name, value| {
        if let Value::List(items) = value {
            found.push((i, member, name, items.to_vec()));
        }
    });
    let own = |cx: &mut Cx, (declaration, member, name, value)| {
        let origin: Origin = cx.own_origin(Code { nodes: &[], module, declaration }, member);
        Declared { name, origin, value }
    };
    Ok(found.into_iter().map(|f| own(cx, f)).collect())
}

/// The declared shells of a script.
pub(crate) fn shells(cx: &mut Cx, module: ModuleId) -> Result<Vec<Declared<Arc<ShellValue>>>, Halt> {
    all_sound(cx, module, &[Keyword::Shell])?;
    let mut found = Vec::new();
    each_member(cx.machine.at(module), &cx.program.names, &[Keyword::Shell], &mut |_, _, _, name, value| {
        if let Value::Shell(s) = value {
            found.push(Declared { name, origin: s.origin, value: s.clone() });
        }
    });
    Ok(found)
}

/// Makes a stage at most once; a fault is reported once and what depends on it is skipped. Its work is not charged to what asks for
/// it first: a call that runs out of its budget would leave it half made.
fn once<T: Clone>(
    cx: &mut Cx,
    slot: impl for<'a> Fn(&'a mut Cx<'_>) -> Option<&'a mut Stage<T>>,
    make: impl FnOnce(&mut Cx) -> Result<T, Halt>,
) -> Result<T, Halt> {
    match slot(cx) {
        Some(Stage::Done(made)) => return Ok(made.clone()),
        Some(Stage::Failed) => return Err(Halt::Broken),
        Some(Stage::Skipped(m, d)) => return Err(Halt::Skipped(*m, *d)),
        Some(Stage::Running) | None => return Err(Halt::Bug("a stage that needs itself")),
        Some(stage) => *stage = Stage::Running,
    }
    // What a stage says is its own, whichever declaration asked first.
    let sink = std::mem::take(&mut cx.sink.reports);
    let job = cx.job;
    let made = job.watch(|| work::uncharged(|| make(cx))).unwrap_or_else(|fault| Err(fault.into()));
    let said = std::mem::replace(&mut cx.sink.reports, sink);
    cx.machine.filed.extend(said.into_iter().map(|d| (None, d)));
    let (stage, result) = match made {
        Ok(made) => (Stage::Done(made.clone()), Ok(made)),
        Err(Halt::Fault(Fault::Interrupted)) => (Stage::Failed, Err(Halt::Broken)),
        Err(Halt::Fault(fault)) => {
            let diagnostic = cx.diagnose(&fault);
            cx.machine.filed.push((None, diagnostic));
            (Stage::Failed, Err(Halt::Broken))
        }
        Err(Halt::Bug(what)) => (Stage::Failed, Err(Halt::Bug(what))),
        Err(Halt::Skipped(m, d)) => (Stage::Skipped(m, d), Err(Halt::Skipped(m, d))),
        Err(Halt::NotYet) => (Stage::Waiting, Err(Halt::NotYet)),
        Err(_) => (Stage::Failed, Err(Halt::Broken)),
    };
    if let Some(slot) = slot(cx) {
        *slot = stage;
    }
    result
}

/// The whole geometry, or what was evaluated of it.
pub(crate) fn sound(cx: &mut Cx, module: ModuleId) -> Result<Sound, Halt> {
    match parts(cx, module) {
        Ok(parts) => {
            if let (Ok(network), Ok(model)) = (network(cx, module), model(cx, module)) {
                return Ok(Sound { parts, network, model, stands: true });
            }
        }
        Err(stop) => {
            without(stop)?;
        }
    }
    once(cx, |cx| Some(&mut cx.machine.at_mut(module).sound), |cx| gathered(cx, module))
}

/// Network and model of what was evaluated. What is wrong with the rest was said when the whole was asked for.
fn gathered(cx: &mut Cx, module: ModuleId) -> Result<Sound, Halt> {
    let parts = Arc::new(gather(cx, module));
    // What is odd about a part of the curves may be right with the rest.
    let sink = std::mem::take(&mut cx.sink.reports);
    let network = network(cx, module).or_else(|_| cx.pipeline.network(cx, module, &parts));
    cx.sink.reports = sink;
    let stands = network.is_ok();
    let network = network.unwrap_or_default();
    let model = cx.pipeline.model(cx, module, &parts, network.clone()).map_err(|_| Halt::Broken)?;
    Ok(Sound { parts, network, model, stands })
}

/// What shells and meshes are made on: the whole model, or what is sound where declarations of it failed.
pub(crate) fn ground(cx: &mut Cx, module: ModuleId) -> Result<(Arc<Model>, Arc<Network>), Halt> {
    match parts(cx, module) {
        Ok(_) => Ok((model(cx, module)?, network(cx, module)?)),
        Err(stop) => {
            let missing = without(stop)?;
            lacking(cx, module, missing);
            let Sound { network, model, stands, .. } = sound(cx, module)?;
            if stands { Ok((model, network)) } else { Err(Halt::Broken) }
        }
    }
}

pub(crate) fn network(cx: &mut Cx, module: ModuleId) -> Result<Arc<Network>, Halt> {
    let parts = parts(cx, module)?;
    once(cx, |cx| Some(&mut cx.machine.at_mut(module).network), |cx| cx.pipeline.network(cx, module, &parts))
}

pub(crate) fn model(cx: &mut Cx, module: ModuleId) -> Result<Arc<Model>, Halt> {
    let parts = parts(cx, module)?;
    let make = |cx: &mut Cx| {
        let network = network(cx, module)?;
        cx.pipeline.model(cx, module, &parts, network)
    };
    once(cx, |cx| Some(&mut cx.machine.at_mut(module).model), make)
}

pub(crate) fn mesh(cx: &mut Cx, mesh: &MeshValue) -> Result<Arc<Mesh>, Halt> {
    let found = made_mesh(cx, mesh)?;
    // A call that asks a mesh may look at all of it.
    if let Some(budget) = work::budget() {
        budget.allow((found.triangles.len() + found.quads.len() + found.lines.len()) as u64 * WORK_OF_AN_ELEMENT);
    }
    Ok(found)
}

fn made_mesh(cx: &mut Cx, mesh: &MeshValue) -> Result<Arc<Mesh>, Halt> {
    match mesh {
        MeshValue::Data(mesh, _) => Ok(mesh.clone()),
        MeshValue::Declared { module, index } => {
            let (module, index) = (*module, *index as usize);
            cx.machine.asked.fleeting = true;
            cx.tolerance()?;
            let Some(spec) = cx.machine.at(module).meshes.get(index).cloned() else {
                return Err(Halt::Bug("a mesh that was not declared"));
            };
            let made = once(cx, |cx| cx.machine.at_mut(module).mesh_stages.get_mut(index), |cx| cx.pipeline.mesh(cx, module, &spec));
            // What waits for a mesh that failed names it.
            match (made, cx.program.origins.place(spec.origin)) {
                (Err(Halt::Broken), Some(place)) => Err(Halt::Skipped(place.module, place.declaration)),
                (made, _) => made,
            }
        }
    }
}
