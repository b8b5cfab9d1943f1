//! Surfaces as values found again in a surface model: the script's own, or one extended by what it does not declare.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::{Fault, Say};
use crate::base::math::compare_points;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::module::State;
use crate::lang::eval::stages;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::value::{BodyKind, EntityHome, ModuleId, ShellValue, Value};
use crate::model::topology::Named;
use crate::model::{Model, SharedEdge, Shell, ShellRequest, SurfaceId};
use crate::network::{Chain, Network};
use crate::surface::{Side, Surface};

/// A surface model with the network it stands on.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Patches, edges and vertices.
    pub model: Arc<Model>,
    /// The script's network.
    pub network: Arc<Network>,
}

impl Scene {
    /// The script's model, extended by those of `surfaces` that it does not declare (moved ones, `let`s); where declarations failed
    /// the model of the others.
    pub fn of<'s>(cx: &mut Cx, module: ModuleId, surfaces: impl IntoIterator<Item = &'s Surface>) -> Result<Self, Halt> {
        let (model, network) = cx.ground(module)?;
        Self { model, network }.with(cx, surfaces)
    }

    /// The scene of `surfaces`, and where its patches, edges and vertices are numbered: the script's own where that declares them all,
    /// else (and where some of it failed) one of these surfaces or of what is sound, on the script's network. The same surfaces are at home in one place. What is itself a curve or
    /// surface of the script is made from them alone, on no network: how a surface is bounded does not depend on the others.
    pub fn at_home(cx: &mut Cx, module: ModuleId, surfaces: &[Surface]) -> Result<(Self, EntityHome), Halt> {
        cx.machine.asked.numbered = true;
        let alone = stages::is_within(cx, module);
        let own = if alone {
            cx.tolerance()?;
            Self { model: Arc::default(), network: Arc::default() }
        } else {
            let (model, network) = cx.ground(module)?;
            Self { model, network }
        };
        if !alone && surfaces.iter().all(|surface| own.find(surface).is_some()) {
            let annex = if cx.parts(module).is_ok() { None } else { Some(own.model.clone()) };
            return Ok((own, EntityHome { module, annex, alone }));
        }
        let nothing = Self { model: Arc::default(), ..own };
        let asked = nothing.missing(cx, surfaces);
        let same = |model: &Arc<Model>| {
            let mut pairs = model.surfaces.iter().zip(&asked);
            model.surfaces.len() == asked.len() && pairs.all(|(a, b)| side_of(&a.surface, &b.surface) == Some(false))
        };
        let known = cx.machine.at(module).annexes.iter().find(|(model, on)| *on == alone && same(model)).map(|found| found.0.clone());
        let scene = match known {
            Some(model) => Self { model, ..nothing },
            None => {
                let scene = nothing.extended(cx, asked)?;
                cx.machine.at_mut(module).annexes.push((scene.model.clone(), alone));
                scene
            }
        };
        let annex = Some(scene.model.clone());
        Ok((scene, EntityHome { module, annex, alone }))
    }

    /// This scene, extended by those of `surfaces` that it does not hold.
    pub fn with<'s>(self, cx: &mut Cx, surfaces: impl IntoIterator<Item = &'s Surface>) -> Result<Self, Halt> {
        let extra = self.missing(cx, surfaces);
        if extra.is_empty() { Ok(self) } else { self.extended(cx, extra) }
    }

    /// Those of `surfaces` that the scene does not hold, each once.
    fn missing<'s>(&self, cx: &Cx, surfaces: impl IntoIterator<Item = &'s Surface>) -> Vec<Named> {
        let mut extra: Vec<Named> = Vec::new();
        for surface in surfaces {
            let known = extra.iter().any(|named| side_of(&named.surface, surface).is_some());
            if !known && self.find(surface).is_none() {
                let name = cx.surface_name(surface);
                extra.push(Named { name, surface: surface.clone() });
            }
        }
        extra
    }

    fn extended(self, cx: &mut Cx, extra: Vec<Named>) -> Result<Self, Halt> {
        let scene = self;
        let tolerance = cx.tolerance()?;
        let all = scene.model.surfaces.iter().cloned().chain(extra).collect();
        let model = Model::build(all, &scene.network, &tolerance, cx.job)?;
        Ok(Self { model: Arc::new(model), network: scene.network })
    }

    /// A surface's place in the model, with `true` where the value is its other side.
    pub fn find(&self, surface: &Surface) -> Option<(SurfaceId, bool)> {
        let mut named = self.model.surfaces.iter().enumerate();
        named.find_map(|(n, named)| side_of(&named.surface, surface).map(|flipped| (SurfaceId::at(n), flipped)))
    }

    /// Places of several surfaces; all are in the scene they were asked with.
    pub fn find_all<'s>(&self, surfaces: impl IntoIterator<Item = &'s Surface>) -> Result<Vec<(SurfaceId, bool)>, Halt> {
        let place = |surface| self.find(surface).ok_or(Halt::Bug("a surface is not in its scene"));
        surfaces.into_iter().map(place).collect()
    }

    /// A shell as the model sees it; notes go to `sink`. A closed one points out of its material, an open one follows its first
    /// surface as listed; `flip: true` turns either.
    pub fn shell(&self, shell: &ShellValue, tolerance: &Tolerance, sink: &mut Vec<Fault>) -> Result<Shell, Halt> {
        let places = self.find_all(&shell.surfaces)?;
        let mut surfaces: Vec<SurfaceId> = Vec::with_capacity(places.len());
        places.iter().for_each(|(id, _)| {
            if !surfaces.contains(id) {
                surfaces.push(*id)
            }
        });
        let request = ShellRequest {
            name: shell.name.to_string(),
            surfaces,
            snap: shell.snap,
            // What a file calls an open shell is whatever faces stand in it.
            branches: shell.imprint.is_some() || shell.body == Some(BodyKind::Shell),
            touches: shell.body == Some(BodyKind::Solid),
            origin: shell.origin,
        };
        let mut built = self.model.shell(&request, &self.network, tolerance, sink)?;
        if shell.flip != (!built.closed && places.first().is_some_and(|(_, flipped)| *flipped)) {
            built.surfaces.iter_mut().for_each(|(_, other)| *other = !*other);
        }
        Ok(built)
    }

    /// The modeling curve along an edge; `None` for a line across a trimmed surface that follows neither u nor v.
    pub fn shared_chain(&self, edge: &SharedEdge, tolerance: &Tolerance) -> Result<Option<Chain>, Halt> {
        let Some(part) = edge.first() else { return Ok(None) };
        let whole = &self.model.edges[part.edge.index()];
        let Some(chain) = self.model.edge_chain(part.edge, &self.network, tolerance)? else { return Ok(None) };
        if part.s == (0.0, whole.length) {
            return Ok(Some(chain));
        }
        let length = whole.length;
        Ok(Some(chain.slice(part.s.0 / length, part.s.1 / length, tolerance)?))
    }
}

impl Cx<'_> {
    /// The name of a surface: as declared; of a member of a `let` its place there, as `parts[0]`, and of a part of such a member that
    /// member's. What is in no declaration is called by its source, where that is short.
    pub fn surface_name(&self, surface: &Surface) -> String {
        self.place_in_let(surface).unwrap_or_else(|| self.name(surface.origin()))
    }

    /// The place of a surface in the `let` whose expression made it.
    fn place_in_let(&self, surface: &Surface) -> Option<String> {
        let place = self.outermost(self.program.origins.place(surface.origin())?);
        let module = self.machine.at(place.module);
        let (at, declarations) = (place.declaration as usize, &module.script.declarations);
        let State::Done(value) = module.states.get(at)? else { return None };
        if declarations.keyword(at) != Keyword::Let {
            return None;
        }
        let found = std::iter::once(surface).chain(surface.part_of()).find_map(|one| {
            let same = path_of(value, &|other| other.is(one));
            same.or_else(|| path_of(value, &|other| side_of(other, one).is_some()))
        });
        Some(format!("{}{}", self.program.names.text(declarations.bound(at)?.name), found?))
    }
}

/// The indices, as `[1][0]`, of the first surface of a value of which something is true; none for a value that is itself one.
fn path_of(value: &Value, is: &dyn Fn(&Surface) -> bool) -> Option<String> {
    match value {
        Value::Surface(surface) => is(surface).then(String::new),
        Value::List(items) => items.iter().enumerate().find_map(|(k, item)| path_of(item, is).map(|rest| format!("[{k}]{rest}"))),
        _ => None,
    }
}

/// Surfaces of which some may be given again, as they are or with their other side: each once, as it was given first.
pub(crate) fn each_once(surfaces: Vec<Surface>) -> Vec<Surface> {
    let mut kept: Vec<Surface> = Vec::with_capacity(surfaces.len());
    let mut known: BTreeMap<(Origin, [u64; 6]), Vec<usize>> = BTreeMap::new();
    for surface in surfaces {
        let hull = surface.hull();
        let [a, b] = [hull.min, hull.max].map(|p| p.to_array().map(f64::to_bits));
        let same = known.entry((surface.origin(), [a[0], a[1], a[2], b[0], b[1], b[2]])).or_default();
        if !same.iter().any(|k| side_of(&kept[*k], &surface).is_some()) {
            same.push(kept.len());
            kept.push(surface);
        }
    }
    kept
}

/// Whether two surfaces are one: `Some(false)`, or `Some(true)` when `other` is the other side of it.
///
/// One expression may make many (a comprehension, the faces of a file), so their points are compared as well.
pub(crate) fn side_of(surface: &Surface, other: &Surface) -> Option<bool> {
    if surface.origin() != other.origin() {
        return None;
    }
    if surface.is(other) {
        return Some(false);
    }
    if surface.n_sides() != other.n_sides() || corners(surface) != corners(other) {
        return None;
    }
    // Away from every line of symmetry, so that the turned surface shows another point there.
    const PROBE: (f64, f64) = (0.31, 0.23);
    let there = other.point(PROBE.0, PROBE.1);
    // Parts of one surface have its points, and may have their corners in common.
    let same = |one: &Surface| one.point(PROBE.0, PROBE.1) == there && one.outlines() == other.outlines();
    if same(surface) {
        return Some(false);
    }
    same(&surface.flipped()).then_some(true)
}

/// Where the borders of a surface begin and end, in an order of their own.
fn corners(surface: &Surface) -> Vec<DVec3> {
    let ends = (0..surface.n_sides()).filter_map(|k| match surface.side(k) {
        Side::Chain { chain, from, to } => Some([chain.point(from), chain.point(to)]),
        _ => None,
    });
    let mut all: Vec<DVec3> = ends.flatten().collect();
    all.sort_by(|a, b| compare_points(*a, *b));
    all
}
