//! What a picture draws, sorted by what it is, and the box that frames it.

use std::sync::Arc;

use glam::DVec3;

use super::picture_names as names;
use super::pictures::unsupported;
use super::plan::surfaces_of;
use crate::base::bbox::Box3;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::pipeline::Sound;
use crate::lang::eval::scene::Scene;
use crate::lang::values::plans::PictureSpec;
use crate::lang::values::value::{EntityHome, MeshValue, Value};
use crate::mesh::Mesh;
use crate::model::{PatchId, SharedEdge, SurfaceId};
use crate::network::{Chain, Network};
use crate::surface::{Domain, Surface};

/// Places of a curve that its box is taken from.
const MAX_SAMPLES: usize = 33;
/// Share of the model around a point that `zoom:` shows.
const AROUND: f64 = 0.05;

/// What a picture draws, sorted out.
#[derive(Default)]
pub(super) struct Things {
    /// Surfaces of shells and by themselves, each with `true` for its other side.
    pub surfaces: Vec<(SurfaceId, bool)>,
    /// Patches by themselves.
    pub patches: Vec<(Scene, PatchId)>,
    /// Meshes, those that the script declares with `true`.
    pub meshes: Vec<(Arc<Mesh>, bool)>,
    /// Curves, links and edges with their names.
    pub curves: Vec<(String, Chain)>,
    /// Edges that no curve carries.
    pub edges: Vec<(Scene, Arc<SharedEdge>)>,
    /// Points with their names, empty where they have none.
    pub points: Vec<(String, DVec3)>,
    /// A whole network.
    pub network: Option<Arc<Network>>,
    /// How far apart edges of the shells may be and still be one, model units.
    pub near: f64,
}

/// The surface model with everything that is drawn or zoomed to in it.
pub(super) fn scene_of(cx: &mut Cx, spec: &PictureSpec, sound: &Sound) -> Result<Scene, Halt> {
    let base = Scene { model: sound.model.clone(), network: sound.network.clone() };
    let values = spec.things.iter().chain(&spec.zoom);
    let surfaces: Vec<&Surface> = values.flat_map(|(value, _)| surfaces_of(value)).collect();
    base.with(cx, surfaces)
}

/// Sorts values out by what they are.
pub(super) fn sort(cx: &mut Cx, values: &[(Value, Origin)], scene: &Scene, tolerance: Tolerance) -> Result<Things, Halt> {
    let (mut things, mut imported) = (Things::default(), names::Imported::default());
    for (value, origin) in values {
        match value {
            Value::Surface(surface) if surface.domain() == Domain::Unbounded => {
                return Err(unsupported(*origin, "a plane without borders cannot be drawn", "draw `plane(curves)`"));
            }
            Value::Surface(surface) => things.surfaces.extend(scene.find_all([surface])?),
            // A shell that is none (in pieces, one-sided) shows its surfaces as they are.
            Value::Shell(shell) => things.surfaces.extend(match scene.shell(shell, &tolerance, &mut Vec::new()) {
                Ok(built) => {
                    things.near = things.near.max(built.near);
                    built.surfaces
                }
                Err(_) => scene.find_all(&shell.surfaces)?,
            }),
            Value::Mesh(mesh) => things.meshes.push((cx.mesh(mesh)?, matches!(**mesh, MeshValue::Declared { .. }))),
            Value::Patch(home, patch) => things.patches.push((own(cx, home)?, *patch)),
            Value::Curve(chain) => things.curves.push((imported.name(cx, chain), chain.clone())),
            Value::Link(module, link) => {
                let network = cx.network(*module)?;
                things.curves.push((names::of_link(&network, *link), network.link_chain(*link)));
            }
            Value::Edge(home, edge) => things.edges.push((own(cx, home)?, edge.clone())),
            Value::Vertex(home, vertex) => {
                let point = cx.model(home)?.vertices[vertex.index()].point;
                things.points.push((String::new(), point));
            }
            Value::Node(p) | Value::Vector(p, _) => things.points.push((String::new(), *p)),
            Value::Network(module) => things.network = Some(cx.sound(*module)?.network),
            _ => {}
        }
    }
    things.surfaces.sort_unstable_by_key(|s| s.0);
    things.surfaces.dedup_by_key(|s| s.0);
    Ok(things)
}

/// The surface model that edges and patches of a script are numbered in.
fn own(cx: &mut Cx, home: &EntityHome) -> Result<Scene, Halt> {
    Ok(Scene { model: cx.model(home)?, network: cx.network_of(home)? })
}

/// Points that things lie between, for framing them.
pub(super) fn outline(things: &Things, scene: &Scene) -> Vec<DVec3> {
    let mut out: Vec<DVec3> = Vec::new();
    let of_surface = |id: &SurfaceId| corners(&crate::surface::bbox(&scene.model.surfaces[id.index()].surface));
    things.surfaces.iter().for_each(|(id, _)| out.extend(of_surface(id)));
    for (scene, patch) in &things.patches {
        let patch = &scene.model.patches[patch.index()];
        let surface = &scene.model.surfaces[patch.surface.index()].surface;
        let at = |(low, high): (f64, f64), k: usize| low + (high - low) * k as f64 / 8.0;
        out.extend((0..81).map(|k| surface.point(at(patch.u, k % 9), at(patch.v, k / 9))));
    }
    things.meshes.iter().for_each(|(mesh, _)| out.extend(corners(&Box3::of(mesh.nodes.iter().copied()))));
    let mut along = |chain: &Chain| out.extend((0..MAX_SAMPLES).map(|k| chain.point(k as f64 / (MAX_SAMPLES - 1) as f64)));
    things.curves.iter().for_each(|(_, chain)| along(chain));
    if let Some(network) = &things.network {
        network.curves.iter().for_each(|c| along(&Chain::of_curve(&c.curve)));
    }
    for (scene, edge) in &things.edges {
        let Some(track) = scene.model.shared_track(edge, &scene.network) else { continue };
        out.extend((0..MAX_SAMPLES).map(|k| track.point(track.length() * k as f64 / (MAX_SAMPLES - 1) as f64)));
    }
    out.extend(things.points.iter().map(|p| p.1));
    out
}

pub(super) fn corners(around: &Box3) -> Vec<DVec3> {
    if around.is_empty() {
        return Vec::new();
    }
    around.corners().to_vec()
}

/// The box of what is zoomed to; around a point a part of the model.
pub(super) fn around(focus: &[DVec3], everything: &Box3) -> Box3 {
    let own = Box3::of(focus.iter().copied());
    let least = AROUND * everything.diagonal();
    if own.diagonal() >= least {
        return own;
    }
    let half = DVec3::splat(0.5 * least);
    Box3 { min: own.center() - half, max: own.center() + half }
}
