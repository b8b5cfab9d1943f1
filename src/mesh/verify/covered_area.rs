//! The part of the parameter plane that the elements of a face cover, compared with the part inside the loops of its surface.
//!
//! Area and first moments of the elements in (u, v) are those of the polygon through the border nodes, which is known from the
//! loops of the surface alone: a hole that is lost or stands elsewhere, an element that is missing or there twice changes one
//! of them. Beside a pole, and where two places of one node are joined by an edge, part of the plane is a point or a line in space and
//! has no element; it is found from the edges that elements leave free there. The error of the places of nodes on a loop is bounded by how
//! the loop bends between the places that are known of it.
//! With every node on the surface at its place the area in space then differs from the surface's by chords alone.

use glam::DVec2;

use crate::base::tolerance::{MEASURE_ACCURACY, NUDGE};
use crate::mesh::border::layout::Face;
use crate::mesh::border::nodes::line;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::input::Input;
use crate::surface::{Domain, PreparedSurface, Side};

/// Largest distance of a glued border node from its place on a face, in glue distances.
const MAX_GLUED_DISTANCE: f64 = 8.0;
/// Largest number of nodes inside a face that are compared with its surface.
const MAX_PROBES: usize = 32;

/// Area and first moments of a part of the parameter plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoveredArea {
    /// Area.
    pub area: f64,
    /// ∬ (u, v).
    pub moment: DVec2,
}

impl CoveredArea {
    /// Adds a triangle.
    pub fn add(&mut self, a: DVec2, b: DVec2, c: DVec2) {
        self.add_times(1.0, a, b, c);
    }

    /// Adds a triangle so many times.
    fn add_times(&mut self, times: f64, a: DVec2, b: DVec2, c: DVec2) {
        let area = times * 0.5 * (b - a).perp_dot(c - a);
        self.area += area;
        self.moment += (a + b + c) * (area / 3.0);
    }

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self { area: self.area + other.area, moment: self.moment + other.moment }
    }

    /// Adds a quad, as two triangles.
    pub fn add_quad(&mut self, [a, b, c, d]: [DVec2; 4]) {
        self.add(a, b, c);
        self.add(a, c, d);
    }
}

/// Places of nodes in the parameter plane.
#[derive(Clone, Copy)]
pub struct NodePlaces<'a> {
    /// (u, v).
    pub uv: &'a [(f64, f64)],
    /// The node of the mesh at each.
    pub ids: &'a [u32],
}

/// The area that the elements of a face leave out of the part inside its loops, where it is a point or a line in space: beside a pole, whose
/// side in (u, v) is one node, and between places of one node on both sides of a seam.
///
/// The first `border` places are those of the loops, whose edges are `around`. Each edge that
/// has elements on one side only and is not of the loops must run back elsewhere between the same nodes, or the border of a hole is left.
/// `None` where one does not.
pub fn left_out<'a>(
    elements: impl Iterator<Item = &'a [u32]>,
    places: NodePlaces,
    border: usize,
    around: &[[u32; 2]],
) -> Option<CoveredArea> {
    let NodePlaces { uv, ids } = places;
    let mut order: Vec<u32> = (0..border as u32).collect();
    order.sort_unstable_by_key(|n| ids[*n as usize]);
    let mut twice = vec![false; border];
    for same in order.chunk_by(|a, b| ids[*a as usize] == ids[*b as usize]).filter(|same| same.len() > 1) {
        same.iter().for_each(|n| twice[*n as usize] = true);
    }
    let is_twice = |n: u32| twice.get(n as usize).is_some_and(|twice| *twice);
    // By the lower end: ascending edges of elements count up, those of the loops down.
    let mut edges: Vec<(u32, u32, i32)> = Vec::new();
    let mut count = |a: u32, b: u32, by: i32| {
        if is_twice(a) || is_twice(b) {
            edges.push((a.min(b), a.max(b), if a < b { by } else { -by }));
        }
    };
    for corners in elements {
        (0..corners.len()).for_each(|k| count(corners[k], corners[(k + 1) % corners.len()], 1));
    }
    around.iter().for_each(|[a, b]| count(*a, *b, -1));
    edges.sort_unstable();
    let mut left: Vec<(u32, u32, i32)> = Vec::new();
    let mut out = CoveredArea::default();
    for same in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (a, b, sum) = (same[0].0, same[0].1, same.iter().map(|e| e.2).sum::<i32>());
        let [p, q] = [a, b].map(|n| DVec2::from(uv[n as usize]));
        let [m, n] = [a, b].map(|n| ids[n as usize]);
        if sum != 0 {
            out.add_times(-f64::from(sum), DVec2::from(uv[0]), p, q);
        }
        if sum != 0 && m != n {
            left.push((m.min(n), m.max(n), if m < n { sum } else { -sum }));
        }
    }
    left.sort_unstable();
    let closed = left.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(|same| same.iter().map(|e| e.2).sum::<i32>() == 0);
    closed.then_some(out)
}

/// A place on a loop, and how far from there the node may lie.
pub type LoopPlace = (DVec2, f64);

/// The area that elements must cover, and by how much it may differ.
#[derive(Clone, Copy, Debug)]
pub struct WantedArea {
    /// Of the polygons through the places of the border nodes.
    pub polygons: CoveredArea,
    /// Largest difference, by the bounds of the places.
    pub slack: CoveredArea,
}

/// The area that a face must cover: inside the polygons through the places of its border nodes, loop by loop.
pub fn inside(loops: &[Vec<LoopPlace>]) -> WantedArea {
    let (mut wanted, mut slack) = (CoveredArea::default(), CoveredArea::default());
    let first = loops.iter().flatten().next().map_or(DVec2::ZERO, |p| p.0);
    let reach = loops.iter().flatten().map(|p| (p.0 - first).abs()).fold(DVec2::ZERO, DVec2::max);
    for polygon in loops {
        let n = polygon.len();
        for k in 0..n {
            let ((before, _), (here, off), (next, other)) = (polygon[(k + n - 1) % n], polygon[k], polygon[(k + 1) % n]);
            wanted.add(first, here, next);
            let more = 0.5 * before.distance(next) * off + 0.5 * off * other + NUDGE * here.distance(next);
            slack.area += more;
            slack.moment += more * (before.abs().max(here.abs()).max(next.abs()) + DVec2::splat(off + other));
        }
    }
    let more = MEASURE_ACCURACY * (reach.x * reach.y).abs();
    slack.area += more;
    slack.moment += (first.abs() + 2.0 * reach) * more;
    WantedArea { polygons: wanted, slack }
}

/// Whether the covered area is the wanted one within its slack.
pub fn agrees(covered: CoveredArea, wanted: WantedArea) -> bool {
    let WantedArea { polygons, slack } = wanted;
    let off = (covered.moment - polygons.moment).abs();
    (covered.area - polygons.area).abs() <= slack.area && off.x <= slack.moment.x && off.y <= slack.moment.y
}

/// Compares the area that the elements of a face cover with the one that the loops of its surface bound; fails with both. Places of border nodes
/// are estimated first, and computed on the surface only where the estimate does not agree.
pub(crate) fn compare(face_input: &FaceInput, face: &Face, covered: CoveredArea) -> std::result::Result<(), (f64, f64)> {
    if agrees(covered, inside(&loops(face_input, face, false))) {
        return Ok(());
    }
    let wanted = inside(&loops(face_input, face, true));
    if agrees(covered, wanted) { Ok(()) } else { Err((covered.area, wanted.polygons.area)) }
}

/// Places of the border nodes of a face by the loops of its surface, loop by loop; computed where `is_exact`, else estimated.
fn loops(face_input: &FaceInput, face: &Face, is_exact: bool) -> Vec<Vec<LoopPlace>> {
    let input = face_input.input;
    let record = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let corners = |all: &[(f64, f64)]| vec![all.iter().map(|p| (DVec2::from(*p), 0.0)).collect::<Vec<LoopPlace>>()];
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    let mut found = match surface.domain() {
        Domain::Triangle => corners(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
        Domain::Loop => {
            let (mut loops, mut first) = (Vec::new(), 0);
            for sides in surface.loops() {
                let around = (first..first + sides).flat_map(|k| side(face_input, face, k, is_exact));
                loops.push(around.collect());
                first += sides;
            }
            loops
        }
        _ => corners(&[(u0, v0), (u1, v0), (u1, v1), (u0, v1)]),
    };
    // What lies beside its place in space does so in (u, v), and where borders were glued places of one node become one.
    let around =
        |polygon: &Vec<LoopPlace>| (0..polygon.len()).map(|k| polygon[k].0.distance(polygon[(k + 1) % polygon.len()].0)).sum::<f64>();
    let length: f64 = face.sides.iter().map(|side| side.length).sum();
    let scale = found.iter().map(around).sum::<f64>() / length;
    let near = MAX_GLUED_DISTANCE * face.near.max(input.tolerance.point) * if scale.is_finite() { scale } else { 0.0 };
    found.iter_mut().flatten().for_each(|place| place.1 += near);
    found
}

/// Places of the nodes along one side of a face with loops.
fn side(face_input: &FaceInput, face: &Face, k: usize, is_exact: bool) -> Vec<LoopPlace> {
    let surface = &face_input.input.model.surfaces[face.surface.index()].surface;
    if face.sides[k].uses.is_empty() {
        return surface.border_line(k).map(|(a, b)| vec![(a.into(), 0.0), (b.into(), 0.0)]).unwrap_or_default();
    }
    let line = line(face_input.layout, face_input.nodes, face, k, 1);
    let shares = line.lengths.iter().map(|s| s / face.sides[k].length);
    match surface.side(k) {
        Side::Chain { from, to, .. } if is_exact => {
            let place = |share: f64| surface.border_place(k, from + (to - from) * share);
            shares.filter_map(|share| Some((place(share)?.into(), 0.0))).collect()
        }
        _ => shares.filter_map(|share| surface.border_about(k, share)).collect(),
    }
}

/// The first node that is not on the surface at its place: all of those on the border, and some inside.
pub(crate) fn misplaced(input: &Input, face: &Face, face_mesh: &FaceMesh, mesh: &Mesh) -> Option<(u32, f64)> {
    let surface = &face_mesh.geometry.surface;
    let near = MAX_GLUED_DISTANCE * face.near.max(input.tolerance.point);
    // Under limits the power form was computed for the bounds.
    let has_power_form = face.free && (input.plan.settings.chord_error.is_some() || input.plan.settings.angle_error.is_some());
    let prepared = if has_power_form { surface.prepared() } else { PreparedSurface::plain(surface) };
    let off = |(n, (u, v)): (u32, (f64, f64))| {
        let off = prepared.evaluator().point(u, v).distance(mesh.nodes[n as usize]);
        (off > near || off.is_nan()).then_some((n, off))
    };
    let inner = |all: usize| (0..all).step_by(all.div_ceil(MAX_PROBES).max(1));
    match &face_mesh.geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let (nu, nv) = grid.size();
            let rows = (0..=nu).flat_map(|i| [(i, 0), (i, nv)]).chain((0..=nv).flat_map(|j| [(0, j), (nu, j)]));
            let within = inner(nu * nv).map(|k| (k % nu, k / nu));
            rows.chain(within).map(|(i, j)| (frame.node(i, j), grid.uv(i, j))).find_map(off)
        }
        FaceNodes::Lattice(lattice, frame) => {
            let n = lattice.size();
            let rows = (0..=n).flat_map(|k| [(k, 0), (0, k), (k, n - k)]);
            rows.map(|(i, j)| (frame.node(i, j), lattice.uv(i, j))).find_map(off)
        }
        FaceNodes::Blocks(blocks, ids) => {
            let all = inner(blocks.inner).chain(blocks.inner..ids.len());
            all.map(|k| (ids[k], blocks.uv[k])).find_map(off)
        }
        FaceNodes::Free(free, ids) => {
            let all = (0..free.border).chain(inner(ids.len() - free.border).map(|k| k + free.border));
            all.map(|k| (ids[k], free.uv[k])).find_map(off)
        }
    }
}
