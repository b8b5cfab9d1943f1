//! A plan carried out on a model: names become surfaces, shells and curves, and the mesher makes the mesh.

use std::sync::Arc;

use super::curve::place as point;
use super::error::Error;
use super::mesh::Mesh;
use super::model::Model;
use super::plan::MeshPlan;
use crate::base::fault::Fault;
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::lang::eval::halt::Halt;
use crate::lang::values::units::{degrees, number_text};
use crate::mesh;
use crate::mesh::request::plan::{GroupRequest, Place, Refine};
use crate::mesh::request::settings::{Given, RuleSettings, Settings, Takes};
use crate::mesh::{Plan, Rule, Target};
use crate::model::SurfaceId;
use crate::model::topology::Shell;
use crate::session::cuts::along_curves;
use crate::session::plan::Faces;

/// What a name stands for in a model.
enum Thing {
    Surface(SurfaceId),
    Shell(usize),
    Curve(usize),
}

impl MeshPlan {
    /// The mesh of a model by this plan.
    ///
    /// Fails with E201 for a name that the model does not have, E306 for a number out of its range, E7xx where a face cannot be meshed as
    /// asked.
    pub fn mesh(&self, model: &Model) -> Result<Mesh, Error> {
        self.in_range()?;
        let mut plan = Plan::of(&self.name, Vec::new());
        plan.settings = self.settings;
        let mut faces = Faces::default();
        let mut said: Vec<Fault> = Vec::new();
        let failed = |fault: Fault| Error::of_fault(&fault, &model.speaker());
        for name in &self.things {
            match find(model, name)? {
                Thing::Surface(id) => faces.add_surfaces(&mut plan, &[(id, false)]),
                Thing::Shell(k) => faces.add_shell(&mut plan, &model.shells[k], &built(model, k, &mut said)?),
                Thing::Curve(_) => {
                    return Err(Error::outside("of", format!("the curve `{name}`"), "surfaces and shells; curves are `lines`"));
                }
            }
        }
        if self.things.is_empty() {
            let placed = |surface: &super::surface::Surface| match find(model, surface.name())? {
                Thing::Surface(id) => Ok((id, false)),
                _ => Err(Error::new("E999", format!("a bug in loft: the surface `{}` is not in its model", surface.name()))),
            };
            let all = model.surfaces.iter().map(placed).collect::<Result<Vec<_>, Error>>()?;
            if all.is_empty() && self.lines.is_empty() {
                return Err(Error::outside("of", "a model without surfaces", "surfaces and shells"));
            }
            faces.add_surfaces(&mut plan, &all);
        }
        for name in &self.lines {
            match find(model, name)? {
                Thing::Curve(k) => plan.curves.push((name.clone(), model.curves[k].chain.clone())),
                _ => return Err(Error::outside("lines", format!("`{name}`"), "curves")),
            }
        }
        faces.settle(&mut plan, &model.scene, self.settings.flip(), &model.tolerance).map_err(failed)?;
        for (name, said) in &self.rules {
            for target in targets(model, name)? {
                plan.rules.push(rule(target, *said, name)?);
            }
        }
        for (name, things) in &self.groups {
            let members: Vec<Vec<Target>> = things.iter().map(|thing| targets(model, thing)).collect::<Result<_, _>>()?;
            plan.groups.push(GroupRequest { name: name.clone(), members: members.concat(), origin: Origin::NONE });
        }
        for (near, settings) in &self.refines {
            let at = vec![Place::Point(point("near", *near)?)];
            let Some(size) = settings.size else { continue };
            plan.refines.push(Refine { at, size, radius: settings.radius(), origin: Origin::NONE });
        }
        plan.bodies = faces.apart(&plan, &model.scene, &model.tolerance);
        let (mesh, found) = self.build(plan, model).map_err(failed)?;
        said.extend(found);
        let groups = self.groups.iter().map(|group| group.0.clone()).collect();
        Ok(Mesh::new(Arc::new(mesh), model.tolerance, model.unit, groups, model.rows(&said)))
    }

    /// The mesh of a finished plan with what is to be said about its rules.
    fn build(&self, mut plan: Plan, model: &Model) -> Result<(mesh::Mesh, Vec<Fault>), Fault> {
        let job = Job::new();
        let scene = along_curves(model.scene.clone(), &mut plan, &model.tolerance, &job)?;
        let input = mesh::Input { plan: &plan, model: &scene.model, network: &scene.network, tolerance: &model.tolerance };
        let built = mesh::MeshLayouts::new(&input)?.build(&input, None, &job)?;
        let said = built.remarks.iter().map(|remark| remark.fault(&input)).collect();
        Ok((built.mesh, said))
    }

    /// E306 for the first number that is out of its range.
    fn in_range(&self) -> Result<(), Error> {
        within_range(&self.settings)?;
        self.rules.iter().try_for_each(|(_, settings)| within_range(settings))?;
        self.refines.iter().try_for_each(|(_, settings)| within_range(settings))
    }
}

/// E306 for the first number of a block that is out of its range.
fn within_range(settings: &impl Settings) -> Result<(), Error> {
    for (declared, given, _) in settings.written() {
        let Given::Number(x) = given else { continue };
        let broken = declared.range.iter().find(|bound| !(bound.0)(x)).map(|bound| bound.1);
        if let Some(range) = if x.is_finite() { broken } else { Some("a finite number") } {
            let found = if declared.takes == Takes::Angle { degrees(x) } else { x };
            return Err(Error::outside(declared.word, number_text(found), range));
        }
    }
    Ok(())
}

/// The place of a declared surface in the surface model.
fn place(model: &Model, name: &str) -> Option<SurfaceId> {
    model.scene.model.surfaces.iter().position(|named| named.name == name).map(SurfaceId::at)
}

/// What a name stands for; E201 where it stands for nothing.
fn find(model: &Model, name: &str) -> Result<Thing, Error> {
    if let Some(id) = place(model, name) {
        return Ok(Thing::Surface(id));
    }
    let shell = model.shells.iter().position(|shell| *shell.name == *name).map(Thing::Shell);
    let curve = || model.curves.iter().position(|curve| curve.name() == name).map(Thing::Curve);
    shell.or_else(curve).ok_or_else(|| Error::new("E201", format!("`{name}` is not a surface, shell or curve of the model")))
}

/// A shell as the surface model sees it.
fn built(model: &Model, k: usize, said: &mut Vec<Fault>) -> Result<Shell, Error> {
    model.scene.shell(&model.shells[k], &model.tolerance, said).map_err(|halt| match halt {
        Halt::Fault(fault) => Error::of_fault(&fault, &model.speaker()),
        _ => Error::new("E999", format!("a bug in loft: the shell `{}` is not in its model", model.shells[k].name)),
    })
}

/// What rules and groups on a thing apply to.
fn targets(model: &Model, name: &str) -> Result<Vec<Target>, Error> {
    Ok(match find(model, name)? {
        Thing::Surface(id) => vec![Target::Surface(id)],
        Thing::Shell(k) => built(model, k, &mut Vec::new())?.surfaces.iter().map(|found| Target::Surface(found.0)).collect(),
        Thing::Curve(k) => vec![Target::Chain(model.curves[k].chain.clone())],
    })
}

/// Settings of a target; E306 where such a thing does not have them.
fn rule(target: Target, settings: RuleSettings, name: &str) -> Result<Rule, Error> {
    let is_curve = matches!(target, Target::Chain(_));
    let other = settings.written().find(|(declared, ..)| match declared.word {
        "bias" => !is_curve,
        "elements" | "method" => is_curve,
        _ => false,
    });
    if let Some((declared, ..)) = other {
        let on = if is_curve { "on a surface or shell" } else { "on a curve" };
        return Err(Error::outside(declared.word, format!("`{name}`"), on));
    }
    Ok(Rule { settings, ..Rule::on(target, Origin::NONE) })
}
