//! How sharp the elements of a mapped face will be, told from a few of its cells before any is made, and whether it is better
//! made freely.

use std::f64::consts::{FRAC_PI_6, PI};

use glam::DVec3;

use crate::base::math::angle_between;
use crate::base::par;
use crate::mesh::border::layout::{Face, FaceSide, Uneven};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::data::quality::least_angle;
use crate::mesh::deviation::edge_length;
use crate::mesh::mapped::trilateral::LatticeIds;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::size::border_spacing::{FILLED, SPACING};
use crate::mesh::size::sizing::Sizing;
use crate::surface::Surface;

/// Angles of a map from here on are good enough, radians: 20°.
pub const SHARP: f64 = PI / 9.0;
/// What free faces hardly ever stay below, radians: 30°.
const FREE: f64 = FRAC_PI_6;
/// How much larger the least angle has to be that is worth another method.
const MIN_GAIN: f64 = 1.5;
/// Free elements for one of the map at most: rows that limits make narrow save elements.
const MORE: f64 = 2.5;
/// Free elements for one that was foreseen at most.
const DEARER: f64 = 4.0;
/// So few elements may be any number of times what was foreseen.
const FEW: u64 = 100;
/// Area of an equilateral triangle with sides of 1.
const EQUILATERAL: f64 = 0.433_012_701_892_219_3;
/// Steps of free faces between borders that are near, over their distance.
const ACROSS: f64 = 2.0;
/// Cells of blocks that are looked at.
const BLOCKS: usize = 12;

/// What a map makes of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foreseen {
    /// The least angle of the cells that were looked at, radians.
    pub angle: f64,
    /// The same without those at corners and poles.
    pub away: f64,
    /// The sharpest corner of the face itself, radians.
    pub corner: f64,
    /// Elements that a free face has for one of the map.
    pub more: f64,
}

impl Foreseen {
    /// Whether free elements have clearly larger angles, and are not many more. A sharp corner has one sharp element whatever the method.
    pub fn is_worse_than_free(&self) -> bool {
        let worse = |angle: f64, free: f64| angle < SHARP && MIN_GAIN * angle <= free;
        (worse(self.angle, FREE.min(self.corner)) || worse(self.away, FREE)) && self.more <= MORE
    }
}

/// What the maps of faces will be like; nothing for free ones.
pub fn find(made: &FaceInput, prepared: &[FaceMesh]) -> Vec<Option<Foreseen>> {
    par::map(prepared.len(), |f| (!made.layout.faces[f].free).then(|| of_face(made, &made.layout.faces[f], &prepared[f])).flatten())
}

/// Faces that are better made freely, of those that are mapped because nothing says otherwise, and the number of elements that this
/// makes. Rows whose steps are written out are what is meant.
pub fn better_free(made: &FaceInput, sizing: &Sizing, foreseen: &[Option<Foreseen>], prepared: &[FaceMesh]) -> Vec<(usize, Uneven, u64)> {
    let chosen = |(f, found): (usize, &Option<Foreseen>)| {
        let face = &made.layout.faces[f];
        let found = found.filter(Foreseen::is_worse_than_free)?;
        let open = face.method == Method::Auto && !face.kept && !is_written(face, sizing);
        let elements = found.more * (prepared[f].triangles + prepared[f].quads) as f64;
        open.then_some((f, Uneven::Sharp(found.angle), elements.ceil() as u64))
    };
    foreseen.iter().enumerate().filter_map(chosen).collect()
}

/// Faces made freely for better angles that have many more elements than was foreseen, or elements turned over against the surface.
pub fn better_mapped(made: &FaceInput, prepared: &[FaceMesh], mesh: &Mesh) -> Vec<usize> {
    let worse = |f: usize| {
        let (face, ready) = (&made.layout.faces[f], &prepared[f]);
        let many = (ready.triangles + ready.quads) as f64 > DEARER * (face.foreseen_free.max(FEW)) as f64;
        matches!(face.uneven, Some(Uneven::Sharp(_))) && (many || turned(ready, mesh))
    };
    let found = par::map(prepared.len(), worse);
    (0..prepared.len()).filter(|f| found[*f]).collect()
}

/// Share of the elements of a face that closes on itself from which on, seen from their backs, they do not follow its surface.
const TWISTED: f64 = 0.1;

/// Whether an element is seen from its back along the normal of the surface in its middle.
fn turned(ready: &FaceMesh, mesh: &Mesh) -> bool {
    backs(ready, mesh).0 > 0
}

/// Whether the elements of a free face go through its surface and not along it, as a few of them round a whole ring may.
pub fn is_twisted(ready: &FaceMesh, mesh: &Mesh) -> bool {
    let (backs, all) = backs(ready, mesh);
    backs as f64 > TWISTED * all as f64
}

/// How many elements of a free face are seen from their backs along the normals of the surface in their middles, and how many there are.
fn backs(ready: &FaceMesh, mesh: &Mesh) -> (usize, usize) {
    let FaceNodes::Free(free, ids) = &ready.geometry.nodes else { return (0, 0) };
    let surface = &ready.geometry.surface;
    let back = |corners: &[u32]| {
        let share = 1.0 / corners.len() as f64;
        let uv = corners.iter().map(|n| free.uv[*n as usize]).fold((0.0, 0.0), |s, uv| (s.0 + share * uv.0, s.1 + share * uv.1));
        let p = |k: usize| mesh.nodes[ids[corners[k] as usize] as usize];
        let last = corners.len() - 1;
        (p(last - 1) - p(0)).cross(p(last) - p(last - 2)).dot(surface.normal(uv.0, uv.1)) <= 0.0
    };
    if surface.is_flat() {
        return (0, 0);
    }
    let triangles = free.triangles.iter().filter(|t| back(&t[..])).count();
    let quads = free.quads.iter().filter(|q| back(&q[..])).count();
    (triangles + quads, free.triangles.len() + free.quads.len())
}

/// Whether all steps of a side are written, or their growth.
pub fn is_written(face: &Face, sizing: &Sizing) -> bool {
    let says = |k: usize| sizing.decisions[k].count.is_some() || sizing.bias_rule[k].is_some();
    let all = |side: &FaceSide| !side.uses.is_empty() && side.uses.iter().all(|u| says(u.segment));
    face.sides.iter().any(all)
}

/// A node of a cell: its number and its place.
type Node = (u32, (f64, f64));

/// Nodes of a face with their points, which are made where they are inside.
struct View<'a> {
    made: &'a FaceInput<'a>,
    ready: &'a FaceMesh,
}

impl View<'_> {
    fn point(&self, (id, (u, v)): Node) -> DVec3 {
        if id < self.ready.first { self.made.points[id as usize] } else { self.ready.geometry.surface.point(u, v) }
    }

    /// Corners of a cell, those at a pole once.
    fn cell(&self, nodes: &[Node]) -> Vec<DVec3> {
        let distinct = (0..nodes.len()).filter(|k| nodes[*k].0 != nodes[(k + 1) % nodes.len()].0);
        distinct.map(|k| self.point(nodes[k])).collect()
    }
}

fn of_face(made: &FaceInput, face: &Face, ready: &FaceMesh) -> Option<Foreseen> {
    let view = View { made, ready };
    let cells = cells(ready)?;
    let split = ready.elements == Elements::Triangles;
    let shapes: Vec<Vec<DVec3>> = cells.iter().map(|cell| view.cell(&cell.nodes)).collect();
    let angles: Vec<f64> = shapes.iter().map(|cell| least_angle(cell, split)).collect();
    let angle = angles.iter().copied().fold(f64::INFINITY, f64::min);
    let away = angles.iter().zip(&cells).zip(&shapes).filter(|((_, cell), shape)| !cell.corner && shape.len() == cell.nodes.len());
    let away = away.map(|((angle, _), _)| *angle).fold(f64::INFINITY, f64::min);
    let corner = corners(&view, face, ready);
    let limits = Limits::of(made.input);
    let bends = (limits.chord.is_some() || limits.angle.is_some()) && !ready.geometry.surface.is_flat();
    let each = cells.iter().zip(&shapes).filter(|(_, shape)| shape.len() > 2).map(|(cell, shape)| {
        let by_bends = if bends { wanted(&ready.geometry.surface, &limits, &cell.nodes) } else { f64::INFINITY };
        more_elements(face.size.0.min(by_bends), (shape, shape.len() < cell.nodes.len()), split)
    });
    let more = each.sum::<f64>() / cells.len() as f64;
    Some(Foreseen { angle, away, corner, more })
}

/// A cell of a map.
struct Cell {
    nodes: Vec<Node>,
    /// At a corner of the face.
    corner: bool,
}

/// Some cells of a map.
fn cells(ready: &FaceMesh) -> Option<Vec<Cell>> {
    match &ready.geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let (nu, nv) = grid.size();
            let node = |(i, j): (usize, usize)| (frame.node(i, j), grid.uv(i, j));
            let some = |n: usize| [0, n / 2, n - 1];
            let at = some(nv).into_iter().flat_map(|j| some(nu).map(|i| (i, j)));
            let end = |k: usize, n: usize| k == 0 || k == n - 1;
            let cell = |(i, j): (usize, usize)| Cell {
                nodes: [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(node).to_vec(),
                corner: end(i, nu) && end(j, nv),
            };
            Some(at.map(cell).collect())
        }
        FaceNodes::Lattice(lattice, frame) => {
            let n = lattice.size();
            let node = |(i, j): (usize, usize)| (frame.node(i, j), lattice.uv(i, j));
            let (third, half) = (n / 3, n / 2);
            let near = |(i, j): (usize, usize)| {
                [(third, third), (0, 0), (n - 1, 0), (0, n - 1), (half, 0), (0, half), (n - 1 - half, half)].contains(&(i, j))
            };
            let all = LatticeIds::triangles(n).filter(|t| near(t[0]));
            let corner = |at: (usize, usize)| [(0, 0), (n - 1, 0), (0, n - 1)].contains(&at);
            Some(all.map(|t| Cell { nodes: t.map(node).to_vec(), corner: corner(t[0]) }).collect())
        }
        FaceNodes::Blocks(blocks, places) => {
            let node = |n: u32| (places[n as usize], blocks.uv[n as usize]);
            let count = blocks.quads.len();
            let apart = count.div_ceil(BLOCKS).max(1);
            let some = blocks.quads.iter().step_by(apart).chain(blocks.quads.last());
            let ends: Vec<u32> = blocks.sides.iter().filter_map(|side| side.first()).chain(blocks.sides[1].last()).copied().collect();
            let corner = |q: &[u32; 4]| q.iter().any(|n| ends.contains(n));
            Some(some.map(|q| Cell { nodes: q.map(node).to_vec(), corner: corner(q) }).collect())
        }
        _ => None,
    }
}

/// The sharpest corner of a face: between the first steps of its sides; at a pole all round it.
fn corners(view: &View, face: &Face, ready: &FaceMesh) -> f64 {
    let FaceNodes::Grid(_, frame) = &ready.geometry.nodes else {
        let sides: Vec<&[u32]> = match &ready.geometry.nodes {
            FaceNodes::Lattice(_, frame) => frame.sides.iter().map(Vec::as_slice).collect(),
            _ => return least_of_blocks(view, face, ready),
        };
        let ends = [(sides[0], false, sides[2], false), (sides[0], true, sides[1], false), (sides[1], true, sides[2], true)];
        return ends.into_iter().map(|(a, x, b, y)| between(view, (a, x), (b, y))).fold(f64::INFINITY, f64::min);
    };
    let s = &frame.sides;
    let ends = [(0, false, 3, false), (0, true, 1, false), (2, true, 1, true), (2, false, 3, true)];
    let plain = ends.iter().filter(|(a, _, b, _)| !frame.poles[*a] && !frame.poles[*b]);
    let mut least = plain.map(|(a, x, b, y)| between(view, (&s[*a], *x), (&s[*b], *y))).fold(f64::INFINITY, f64::min);
    for (k, _) in frame.poles.iter().enumerate().filter(|(_, pole)| **pole) {
        least = least.min(round_pole(view, ready, k));
    }
    least
}

/// The corners of three sides that blocks of quads fill.
fn least_of_blocks(view: &View, face: &Face, ready: &FaceMesh) -> f64 {
    let FaceNodes::Blocks(blocks, places) = &ready.geometry.nodes else { return f64::INFINITY };
    let side = |k: usize| blocks.sides[k].iter().map(|n| places[*n as usize]).collect::<Vec<u32>>();
    let s = [side(0), side(1), side(2)];
    let ends = [(0, false, 2, false), (0, true, 1, false), (1, true, 2, true)];
    debug_assert!(face.is_triangle());
    ends.into_iter().map(|(a, x, b, y)| between(view, (&s[a], x), (&s[b], y))).fold(f64::INFINITY, f64::min)
}

/// The angle between the steps at an end of two sides.
fn between(view: &View, (a, a_last): (&[u32], bool), (b, b_last): (&[u32], bool)) -> f64 {
    let step = |ids: &[u32], last: bool| {
        let (at, next) = if last { (ids[ids.len() - 1], ids[ids.len() - 2]) } else { (ids[0], ids[1]) };
        view.made.points[next as usize] - view.made.points[at as usize]
    };
    let (a, b) = (step(a, a_last), step(b, b_last));
    if a == DVec3::ZERO || b == DVec3::ZERO { 0.0 } else { angle_between(a, b) }
}

/// The angle all round a pole: that of a few of its triangles, for all.
fn round_pole(view: &View, ready: &FaceMesh, side: usize) -> f64 {
    let FaceNodes::Grid(grid, frame) = &ready.geometry.nodes else { return f64::INFINITY };
    let (nu, nv) = grid.size();
    let n = if side.is_multiple_of(2) { nu } else { nv };
    let next = |k: usize| match side {
        0 => (k, 1),
        1 => (nu - 1, k),
        2 => (k, nv - 1),
        _ => (1, k),
    };
    let at = view.made.points[frame.sides[side][0] as usize];
    let way = |k: usize| {
        let (i, j) = next(k);
        view.point((frame.node(i, j), grid.uv(i, j))) - at
    };
    let one = |k: usize| {
        let (a, b) = (way(k), way(k + 1));
        if a == DVec3::ZERO || b == DVec3::ZERO { 0.0 } else { angle_between(a, b) }
    };
    n as f64 * (one(0) + one(n / 2) + one(n - 1)) / 3.0
}

/// The length that limits want of free elements in the middle of a cell.
fn wanted(surface: &Surface, limits: &Limits, nodes: &[Node]) -> f64 {
    let share = 1.0 / nodes.len() as f64;
    let (u, v) = nodes.iter().fold((0.0, 0.0), |(u, v), (_, at)| (u + share * at.0, v + share * at.1));
    edge_length::wanted(&surface.jet(u, v), limits.chord, limits.angle) * FILLED / SPACING
}

/// Free elements for one of the map, by a cell: free ones are as long as the size lets them be, and no longer than twice what borders
/// that are near to each other are apart. A cell at a pole is narrow because the map is, and no borders are near each other there.
fn more_elements(size: f64, (cell, at_pole): (&[DVec3], bool), split: bool) -> f64 {
    let n = cell.len();
    let lengths: Vec<f64> = (0..n).map(|k| cell[k].distance(cell[(k + 1) % n])).collect();
    let (along, across) = match lengths[..] {
        [a, b, c, d] => (0.5 * (a + c), 0.5 * (b + d)),
        _ => (lengths.iter().copied().fold(0.0, f64::max), lengths.iter().copied().fold(f64::INFINITY, f64::min)),
    };
    let twice = (1..n - 1).map(|k| (cell[k] - cell[0]).cross(cell[k + 1] - cell[0])).sum::<DVec3>().length();
    let area = if split && n == 4 { 0.25 * twice } else { 0.5 * twice };
    let apart = if at_pole { f64::INFINITY } else { ACROSS * along.min(across) };
    let length = (SPACING * size).min(apart);
    let own = if split { EQUILATERAL } else { 1.0 };
    if length > 0.0 { area / (own * length * length) } else { 0.0 }
}
