//! The least angle that the elements of a mapped face will have, predicted from a few of its cells, and whether a free mesh
//! is better.

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
use crate::mesh::face::map_cells::{CellNode, SampledCell, View, sampled_cells};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::size::border_spacing::{FILLED, SPACING};
use crate::mesh::size::sizing::Sizing;
use crate::surface::Surface;

/// The choice between a map and a free mesh.
pub(crate) struct MapChoiceSettings {
    /// Angles of elements below which a warning tells of them, radians: 20°.
    pub(crate) min_map_angle: f64,
    /// When a map of triangles is left for a free mesh.
    triangles: AngleChoice,
    /// The same of quads.
    quads: AngleChoice,
    /// Largest number of free elements for one of the map: rows that limits make narrow save elements.
    max_element_ratio: f64,
    /// The same for maps without angles that a warning tells of.
    max_fair_element_ratio: f64,
    /// Largest number of free elements for one that was predicted.
    max_prediction_error: f64,
    /// One triangle of a free mesh in so many may be sharper than a sharp map.
    few_sharp: usize,
    /// Largest ratio of the least angle of a sharp map and that of a free mesh that is kept.
    max_sharp_ratio: f64,
    /// Number of elements up to which a free mesh may have any number of times the predicted one.
    small_face: u64,
    /// Length of free elements between near borders, over the distance of these.
    near_border_length: f64,
    /// Number of gaps between the rows, and columns, of a grid that are sampled; maps of triangles and blocks have samples of their own.
    samples: usize,
    /// The same for lengths by bends.
    samples_by_bends: usize,
    /// Share of the elements of a face that closes on itself above which, with normals opposite to the surface's, they do not follow it.
    max_opposite_share: f64,
}

/// When a map is left because of its angles.
#[derive(Clone, Copy, Debug, PartialEq)]
struct AngleChoice {
    /// Least angle of a map that is accepted whatever a free mesh has, radians.
    accepted: f64,
    /// Least angle that free meshes nearly always have, radians.
    free: f64,
    /// Least ratio of the angles of free mesh and map for a free mesh.
    min_gain: f64,
}

pub(crate) const MAP_CHOICE: MapChoiceSettings = MapChoiceSettings {
    min_map_angle: PI / 9.0,
    // 30°, 34.5° and a gain of 4.5° or more.
    triangles: AngleChoice { accepted: FRAC_PI_6, free: 1.15 * FRAC_PI_6, min_gain: 1.15 },
    // 20°, 30°.
    quads: AngleChoice { accepted: PI / 9.0, free: FRAC_PI_6, min_gain: 1.5 },
    max_element_ratio: 2.5,
    max_fair_element_ratio: 2.0,
    max_prediction_error: 4.0,
    few_sharp: 500,
    max_sharp_ratio: 1.5,
    small_face: 100,
    near_border_length: 2.0,
    samples: 4,
    samples_by_bends: 24,
    max_opposite_share: 0.1,
};

/// Area of an equilateral triangle with sides of 1.
const EQUILATERAL: f64 = 0.433_012_701_892_219_3;

/// The predicted elements of a mapped face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapQuality {
    /// The least angle of the sampled cells, radians.
    pub angle: f64,
    /// The same without those at corners and poles.
    pub away: f64,
    /// The sharpest corner of the face itself, radians.
    pub corner: f64,
    /// Number of elements of a free mesh for one of the map; computed where the angles of a free mesh are better, else infinite.
    pub element_ratio: f64,
    /// The elements are triangles.
    pub split: bool,
}

impl MapQuality {
    /// Whether free elements have clearly larger angles and are not many more. A sharp corner has one sharp element with any method.
    pub fn is_worse_than_free(&self) -> bool {
        let fair = self.angle.min(self.away) >= MAP_CHOICE.min_map_angle;
        let most = if fair { MAP_CHOICE.max_fair_element_ratio } else { MAP_CHOICE.max_element_ratio };
        self.is_sharper_than_free() && self.element_ratio <= most
    }

    fn is_sharper_than_free(&self) -> bool {
        let AngleChoice { accepted, free, min_gain } = if self.split { MAP_CHOICE.triangles } else { MAP_CHOICE.quads };
        let worse = |angle: f64, free: f64| angle < accepted && min_gain * angle <= free;
        worse(self.angle, free.min(self.corner)) || worse(self.away, free)
    }
}

/// The predicted elements of mapped faces; `None` for free ones.
pub fn find(face_input: &FaceInput, prepared: &[FaceMesh]) -> Vec<Option<MapQuality>> {
    par::map(prepared.len(), |f| {
        (!face_input.layout.faces[f].free).then(|| of_face(face_input, &face_input.layout.faces[f], &prepared[f])).flatten()
    })
}

/// Faces of the method `auto` for which a free mesh is better, with its predicted number of elements. Faces with rows of written counts stay
/// mapped.
pub fn better_free(
    face_input: &FaceInput,
    sizing: &Sizing,
    predicted: &[Option<MapQuality>],
    prepared: &[FaceMesh],
) -> Vec<(usize, Uneven, u64)> {
    let chosen = |(f, found): (usize, &Option<MapQuality>)| {
        let face = &face_input.layout.faces[f];
        let found = found.filter(MapQuality::is_worse_than_free)?;
        let open = face.method == Method::Auto && !face.kept && !is_written(face, sizing);
        let elements = found.element_ratio * (prepared[f].triangles + prepared[f].quads) as f64;
        open.then_some((f, Uneven::Sharp(found.angle), elements.ceil() as u64))
    };
    predicted.iter().enumerate().filter_map(chosen).collect()
}

/// Faces that are free for better angles and have clearly worse ones, or many more elements than predicted, or elements with normals opposite to the surface's.
pub fn better_mapped(face_input: &FaceInput, prepared: &[FaceMesh], mesh: &Mesh) -> Vec<usize> {
    let worse = |f: usize| {
        let (face, face_mesh) = (&face_input.layout.faces[f], &prepared[f]);
        let many = (face_mesh.triangles + face_mesh.quads) as f64
            > MAP_CHOICE.max_prediction_error * (face.foreseen_free.max(MAP_CHOICE.small_face)) as f64;
        let Some(Uneven::Sharp(of_map)) = face.uneven else { return false };
        many || opposite(face_mesh, mesh).0 > 0 || is_sharper(face_mesh, mesh, of_map)
    };
    let found = par::map(prepared.len(), worse);
    (0..prepared.len()).filter(|f| found[*f]).collect()
}

/// Whether triangles of a free face of triangles have smaller angles than its map would have, radians. A few of them do not matter where the map
/// has angles that a warning would tell of as well.
fn is_sharper(face_mesh: &FaceMesh, mesh: &Mesh, of_map: f64) -> bool {
    let FaceNodes::Free(free, ids) = &face_mesh.geometry.nodes else { return false };
    let corners = |t: &[u32; 3]| t.map(|n| mesh.nodes[ids[n as usize] as usize]);
    let angles = free.triangles.iter().map(|t| least_angle(&corners(t), false));
    let sharper: Vec<f64> = angles.filter(|angle| *angle < of_map).collect();
    let few = sharper.len() * MAP_CHOICE.few_sharp <= free.triangles.len()
        && sharper.iter().all(|angle| MAP_CHOICE.max_sharp_ratio * angle >= of_map);
    free.quads.is_empty() && !sharper.is_empty() && !(of_map < MAP_CHOICE.min_map_angle && few)
}

/// Whether the elements of a free face cross its surface instead of following it, as a few of them round a whole ring may.
pub fn is_twisted(face_mesh: &FaceMesh, mesh: &Mesh) -> bool {
    let (opposite, all) = opposite(face_mesh, mesh);
    opposite as f64 > MAP_CHOICE.max_opposite_share * all as f64
}

/// Number of elements of a free face with normals opposite to the surface's in their middles, and of all.
fn opposite(face_mesh: &FaceMesh, mesh: &Mesh) -> (usize, usize) {
    let FaceNodes::Free(free, ids) = &face_mesh.geometry.nodes else { return (0, 0) };
    let surface = &face_mesh.geometry.surface;
    let is_opposite = |corners: &[u32]| {
        let share = 1.0 / corners.len() as f64;
        let uv = corners.iter().map(|n| free.uv[*n as usize]).fold((0.0, 0.0), |s, uv| (s.0 + share * uv.0, s.1 + share * uv.1));
        let p = |k: usize| mesh.nodes[ids[corners[k] as usize] as usize];
        let last = corners.len() - 1;
        (p(last - 1) - p(0)).cross(p(last) - p(last - 2)).dot(surface.normal(uv.0, uv.1)) <= 0.0
    };
    if surface.is_flat() {
        return (0, 0);
    }
    let triangles = free.triangles.iter().filter(|t| is_opposite(&t[..])).count();
    let quads = free.quads.iter().filter(|q| is_opposite(&q[..])).count();
    (triangles + quads, free.triangles.len() + free.quads.len())
}

/// Whether all steps of a side are written, or their growth.
pub fn is_written(face: &Face, sizing: &Sizing) -> bool {
    let is_fixed = |k: usize| sizing.decisions[k].count.is_some() || sizing.bias_rule[k].is_some();
    let all = |side: &FaceSide| !side.uses.is_empty() && side.uses.iter().all(|u| is_fixed(u.segment));
    face.sides.iter().any(all)
}

fn of_face(face_input: &FaceInput, face: &Face, face_mesh: &FaceMesh) -> Option<MapQuality> {
    let view = View { face_input, face_mesh };
    let cells = sampled_cells(face_mesh, MAP_CHOICE.samples)?;
    let split = face_mesh.elements == Elements::Triangles;
    let shapes: Vec<Vec<DVec3>> = cells.iter().map(|cell| view.cell(&cell.nodes)).collect();
    let angles: Vec<f64> = shapes.iter().map(|cell| least_angle(cell, split)).collect();
    let angle = angles.iter().copied().fold(f64::INFINITY, f64::min);
    let away = angles.iter().zip(&cells).zip(&shapes).filter(|((_, cell), shape)| !cell.corner && shape.len() == cell.nodes.len());
    let away = away.map(|((angle, _), _)| *angle).fold(f64::INFINITY, f64::min);
    let corner = corners(&view, face, face_mesh);
    let mut quality = MapQuality { angle, away, corner, element_ratio: f64::INFINITY, split };
    if quality.is_sharper_than_free() {
        let limits = Limits::of(face_input.input);
        let bends = (limits.chord.is_some() || limits.angle.is_some()) && !face_mesh.geometry.surface.is_flat();
        quality.element_ratio = if bends {
            // Lengths by bends vary from row to row.
            let cells = sampled_cells(face_mesh, MAP_CHOICE.samples_by_bends)?;
            mean_element_ratio(&view, face, &cells, &|nodes| wanted(&face_mesh.geometry.surface, &limits, nodes))
        } else {
            mean_element_ratio(&view, face, &cells, &|_| f64::INFINITY)
        };
    }
    Some(quality)
}

/// Number of free elements for one of the map, by the mean of some cells; `by_bends` is the length that limits allow in a cell.
fn mean_element_ratio(view: &View, face: &Face, cells: &[SampledCell], by_bends: &dyn Fn(&[CellNode]) -> f64) -> f64 {
    let split = view.face_mesh.elements == Elements::Triangles;
    let ratio = |cell: &SampledCell| {
        let shape = view.cell(&cell.nodes);
        let size = face.size.0.min(by_bends(&cell.nodes));
        if shape.len() > 2 { element_ratio(size, &shape, shape.len() < cell.nodes.len(), cell.rows, split) } else { 0.0 }
    };
    cells.iter().map(ratio).sum::<f64>() / cells.len() as f64
}

/// The sharpest corner of a face: between the first steps of its sides; at a pole all round it.
fn corners(view: &View, face: &Face, face_mesh: &FaceMesh) -> f64 {
    let FaceNodes::Grid(_, frame) = &face_mesh.geometry.nodes else {
        let sides: Vec<&[u32]> = match &face_mesh.geometry.nodes {
            FaceNodes::Lattice(_, frame) => frame.sides.iter().map(Vec::as_slice).collect(),
            _ => return least_of_blocks(view, face, face_mesh),
        };
        let ends = [(sides[0], false, sides[2], false), (sides[0], true, sides[1], false), (sides[1], true, sides[2], true)];
        return ends
            .into_iter()
            .map(|(a, x, b, y)| between(view, SideEnd { ids: a, last: x }, SideEnd { ids: b, last: y }))
            .fold(f64::INFINITY, f64::min);
    };
    let s = &frame.sides;
    let ends = [(0, false, 3, false), (0, true, 1, false), (2, true, 1, true), (2, false, 3, true)];
    let plain = ends.iter().filter(|(a, _, b, _)| !frame.poles[*a] && !frame.poles[*b]);
    let mut least = plain
        .map(|(a, x, b, y)| between(view, SideEnd { ids: &s[*a], last: *x }, SideEnd { ids: &s[*b], last: *y }))
        .fold(f64::INFINITY, f64::min);
    for (k, _) in frame.poles.iter().enumerate().filter(|(_, pole)| **pole) {
        least = least.min(round_pole(view, face_mesh, k));
    }
    least
}

/// The corners of three sides that blocks of quads fill.
fn least_of_blocks(view: &View, face: &Face, face_mesh: &FaceMesh) -> f64 {
    let FaceNodes::Blocks(blocks, places) = &face_mesh.geometry.nodes else { return f64::INFINITY };
    let side = |k: usize| blocks.sides[k].iter().map(|n| places[*n as usize]).collect::<Vec<u32>>();
    let s = [side(0), side(1), side(2)];
    let ends = [(0, false, 2, false), (0, true, 1, false), (1, true, 2, true)];
    debug_assert!(face.is_triangle());
    ends.into_iter()
        .map(|(a, x, b, y)| between(view, SideEnd { ids: &s[a], last: x }, SideEnd { ids: &s[b], last: y }))
        .fold(f64::INFINITY, f64::min)
}

/// The first or the last end of a side.
#[derive(Clone, Copy)]
struct SideEnd<'a> {
    /// Nodes of the side.
    ids: &'a [u32],
    last: bool,
}

/// The angle between the steps of two sides at their common end.
fn between(view: &View, a: SideEnd, b: SideEnd) -> f64 {
    let step = |SideEnd { ids, last }: SideEnd| {
        let (at, next) = if last { (ids[ids.len() - 1], ids[ids.len() - 2]) } else { (ids[0], ids[1]) };
        view.face_input.points[next as usize] - view.face_input.points[at as usize]
    };
    let (a, b) = (step(a), step(b));
    if a == DVec3::ZERO || b == DVec3::ZERO { 0.0 } else { angle_between(a, b) }
}

/// The angle all round a pole: that of a few of its triangles, for all.
fn round_pole(view: &View, face_mesh: &FaceMesh, side: usize) -> f64 {
    let FaceNodes::Grid(grid, frame) = &face_mesh.geometry.nodes else { return f64::INFINITY };
    let (nu, nv) = grid.size();
    let n = if side.is_multiple_of(2) { nu } else { nv };
    let next = |k: usize| match side {
        0 => (k, 1),
        1 => (nu - 1, k),
        2 => (k, nv - 1),
        _ => (1, k),
    };
    let at = view.face_input.points[frame.sides[side][0] as usize];
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

/// The length of free elements that keeps the limits in the middle of a cell.
fn wanted(surface: &Surface, limits: &Limits, nodes: &[CellNode]) -> f64 {
    let share = 1.0 / nodes.len() as f64;
    let (u, v) = nodes.iter().fold((0.0, 0.0), |(u, v), (_, at)| (u + share * at.0, v + share * at.1));
    edge_length::wanted(&surface.jet(u, v), limits.chord, limits.angle) * FILLED / SPACING
}

/// Number of free elements for one of the map, by a cell: free ones are as long as the size allows, and no longer than twice the distance of
/// near borders, which are as far apart as its row or column is long. A cell at a pole is narrow by the map alone: no borders are near each
/// other there.
fn element_ratio(size: f64, cell: &[DVec3], at_pole: bool, rows: (usize, usize), split: bool) -> f64 {
    let n = cell.len();
    let lengths: Vec<f64> = (0..n).map(|k| cell[k].distance(cell[(k + 1) % n])).collect();
    let (along, across) = match lengths[..] {
        [a, b, c, d] => (0.5 * (a + c), 0.5 * (b + d)),
        _ => (lengths.iter().copied().fold(0.0, f64::max), lengths.iter().copied().fold(f64::INFINITY, f64::min)),
    };
    let twice = (1..n - 1).map(|k| (cell[k] - cell[0]).cross(cell[k + 1] - cell[0])).sum::<DVec3>().length();
    let area = if split && n == 4 { 0.25 * twice } else { 0.5 * twice };
    let borders = (rows.0 as f64 * along).min(rows.1 as f64 * across);
    let apart = if at_pole { f64::INFINITY } else { MAP_CHOICE.near_border_length * borders };
    let length = (SPACING * size).min(apart);
    let own = if split { EQUILATERAL } else { 1.0 };
    if length > 0.0 { area / (own * length * length) } else { 0.0 }
}
