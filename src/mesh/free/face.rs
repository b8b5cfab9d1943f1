//! A face of a mesh made freely, or taken over from an earlier run: its border in its chart, its inside fitted to the limits.

mod border;
mod fit;
mod large;
mod longest;
mod quads;
mod rings;
mod sparing;

pub(in crate::mesh) use border::Border;
pub(super) use border::ONE_PLACE;
pub use border::places;
pub use fit::FILLED;
pub(in crate::mesh) use fit::elements_ahead;
pub(in crate::mesh) use quads::halved;
pub(in crate::mesh) use rings::way_round;

use border::border;
use fit::{fitting, near};
use glam::DVec3;

use super::build::Trouble;
use super::chart::Chart;
use super::outline::Outline;
use super::taken::{self, CachedFace};
use super::tree::MAX_DEPTH;
use crate::base::fault::{Fault, MeshFault, Result};
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::base::triangulate_points::PointsFault;
use crate::base::work::{Budget, Exceeded};
use crate::mesh::build::Input;
use crate::mesh::face_geometry::{FaceGeometry, Free, Shape};
use crate::mesh::faces::{FaceMesh, Frame, middle, too_much_work, work_on};
use crate::mesh::layout::{Face, Layout};
use crate::mesh::nodes::Nodes;
use crate::mesh::plan::Elements;
use crate::mesh::reuse::CacheView;
use crate::mesh::wanted::SizeRequests;

/// Spacing of the crystal as a share of the size, so that hardly an edge comes out longer than the size allows.
pub const SPACING: f64 = 0.8;

/// Everything a face is made from.
pub struct FaceInput<'a> {
    /// The plan and the model.
    pub input: &'a Input<'a>,
    /// Its segments.
    pub layout: &'a Layout,
    /// Their nodes.
    pub nodes: &'a Nodes,
    /// Points of all border nodes.
    pub points: &'a [DVec3],
    /// What `near`, `in` and `min_size` ask for.
    pub wanted: &'a SizeRequests,
}

/// Times that the work of a face which is tried again is halved.
const FEWER: u32 = 2;

/// A face without anything in it, for as long as only its border matters.
pub fn empty(made: &FaceInput, face: &Face) -> FaceMesh {
    prepared(made, face, Free::default(), (Vec::new(), Vec::new()), Vec::new())
}

/// The border of a face, its chart, and the border in it; `None` where the surface is singular all along it.
pub(in crate::mesh) fn outlined(made: &FaceInput, face: &Face) -> Option<(Border, Chart, Outline)> {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    // FaceInput ready once for the border and the chart.
    let _ready = surface.power_form();
    let mut border = border(made, face);
    let chart = Chart::new(surface, border.uv.iter().copied())?;
    if face.near > made.input.tolerance.point {
        border.close(&chart, face.near);
    }
    let outline = Outline {
        xy: border.uv.iter().map(|uv| chart.xy(*uv)).collect(),
        p: border.ids.iter().map(|n| made.points[*n as usize]).collect(),
        loops: border.edges.clone(),
        lines: border.lines.clone(),
    };
    Some((border, chart, outline))
}

/// Makes the face, or takes it over from an earlier run.
pub fn prepare(made: &FaceInput, face: &Face, (known, job): (Option<&CacheView>, &Job)) -> Result<FaceMesh> {
    let (border, chart, mut outline) = outlined(made, face).ok_or_else(|| no_area(made, face))?;
    if face.halved > 0 && face.is_grown() {
        rings::add_rings(made, face, &border, (&chart, &mut outline));
    }
    let key = known.map(|known| {
        let odd = if face.takes_quads() { quads::odd(made, face) } else { Vec::new() };
        (known, taken::key(known, made, face, (&border, &outline), (&odd, &near(made, face, &outline))))
    });
    if let Some((known, key)) = key
        && let Some((free, inner, deciders, tally)) = known.free(key).and_then(|taken| taken.parts(border.uv.len()))
    {
        return Ok(FaceMesh { deciders, tally, ..prepared(made, face, free, (border.ids, border.edges), inner) });
    }
    let all = || grown(made, face, (border, chart, outline), job);
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    // What is tried again with shorter steps of its border, because nothing kept its limits, may take less.
    let again = if face.method.is_coarse() { face.halved.min(FEWER) } else { 0 };
    let most = work_on([surface].into_iter()) >> again;
    let ready = Budget::new(most).within(all).map_err(|Exceeded| too_much_work(made.input, surface.origin()))??;
    if let (Some((known, key)), Shape::Free(free)) = (key, &ready.geometry.shape) {
        known.keep_free(key, CachedFace::of(&ready, free));
    }
    Ok(ready)
}

fn grown(made: &FaceInput, face: &Face, (border, chart, outline): (Border, Chart, Outline), job: &Job) -> Result<FaceMesh> {
    if face.elements != Elements::Triangles && face.method.of_triangles().is_none() {
        return quads::prepare(made, face, border, (&chart, &outline), job);
    }
    let (triangulation, deciders, tally) = match fitting(made, face, &chart, &outline, job)? {
        Ok(fitted) => fitted,
        Err(trouble) => return Err(fault(made, face, &border, trouble)),
    };
    // Rings are fixed, but no part of the border.
    let fixed = border.uv.len();
    // At a pole the chart has an edge that is a point in space.
    let node = |n: u32| border.ids.get(n as usize).copied();
    let flat = |t: &[u32; 3]| (0..3).any(|k| node(t[k]).is_some() && node(t[k]) == node(t[(k + 1) % 3]));
    let triangles: Vec<[u32; 3]> = triangulation.tri.iter().copied().filter(|t| !flat(t)).collect();
    let mut uv = border.uv;
    uv.extend(triangulation.xy[fixed..].iter().map(|xy| chart.uv(*xy)));
    let inner = triangulation.p[fixed..].to_vec();
    let free = Free { uv, border: fixed, triangles, ..Free::default() };
    Ok(FaceMesh { deciders, tally, ..prepared(made, face, free, (border.ids, border.edges), inner) })
}

/// A face of these places and elements; `ids` and edges of its loops.
fn prepared(made: &FaceInput, face: &Face, free: Free, (mut ids, around): (Vec<u32>, Vec<[u32; 2]>), inner: Vec<DVec3>) -> FaceMesh {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let (triangles, quads) = (free.triangles.len() as u64, free.quads.len() as u64);
    ids.resize(free.uv.len(), 0);
    FaceMesh {
        surface: face.surface,
        geometry: FaceGeometry { surface: surface.clone(), shape: Shape::Free(free), frame: Frame::Free(ids), flipped: face.flipped },
        elements: face.elements,
        first: 0,
        inner: inner.len() as u64,
        triangles,
        quads,
        made: inner,
        around,
        deciders: Vec::new(),
        tally: None,
    }
}

fn no_area(made: &FaceInput, face: &Face) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    MeshFault::FaceEmpty { surface, at: middle(made.input, face) }.into()
}

/// What went wrong, in the user's words.
fn fault(made: &FaceInput, face: &Face, border: &Border, trouble: Trouble) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    let place = |n: u32| border.ids.get(n as usize).map_or(DVec3::ZERO, |id| made.points[*id as usize]);
    match trouble {
        Trouble::Border(PointsFault::Crosses(a, b)) => {
            MeshFault::BordersCross { surface, at: 0.5 * (place(a) + place(b)), size: face.size.0 }.into()
        }
        Trouble::Border(PointsFault::Same(a, _)) => MeshFault::BordersCross { surface, at: place(a), size: face.size.0 }.into(),
        Trouble::Border(PointsFault::Flat) | Trouble::Empty => no_area(made, face),
        Trouble::Deep(at) => MeshFault::TreeTooDeep { surface, at, levels: MAX_DEPTH }.into(),
        Trouble::Odd => {
            let odd = face.segments().find(|s| made.nodes.count(*s) % 2 == 1).unwrap_or(0);
            MeshFault::OddCount { count: (0, Origin::NONE), surface, at: made.layout.point(odd, 0.5) }.into()
        }
        Trouble::Full => {
            let plan = made.input.plan;
            let bent = !made.input.model.surfaces[face.surface.index()].surface.is_flat();
            let limit = plan.chord_error.or(plan.angle_error).filter(|_| bent).map(|limit| limit.1);
            let of = limit.unwrap_or_else(|| crate::mesh::ahead::of_size(made.input, face.size.1));
            crate::mesh::faces::too_many(plan, of, None)
        }
    }
}
