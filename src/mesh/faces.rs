//! Faces ready to be filled: their geometries, the ids of their border nodes, and how many nodes and elements they make.

use std::ops::Range;

use glam::DVec3;

use super::build::Input;
use super::edges::Limits;
use super::explain::{Decider, Tally};
use super::face_geometry::{FaceGeometry, Grid, Lattice, Shape};
use super::layout::{Face, Layout, side_parameters};
use super::mapped;
use super::nodes::Nodes;
use super::plan::{Elements, Method, Plan};
use super::trilateral::{Blocks, LatticeFrame};
use super::uneven::Uneven;
use crate::base::fault::{Fault, MeshFault, Result};
use crate::base::limits::{MESH_WORK, WORK_OF_AN_ELEMENT};
use crate::base::origin::Origin;
use crate::base::text::real;
use crate::base::work;
use crate::model::SurfaceId;
use crate::surface::{Domain, Surface};

/// Global node ids of a face.
#[derive(Clone, Debug, PartialEq)]
pub enum Frame {
    /// Of a grid.
    Grid(mapped::Frame),
    /// Of a lattice.
    Lattice(LatticeFrame),
    /// Of three blocks: ids by place among the blocks' nodes.
    Blocks(Vec<u32>),
    /// Of a free face: ids by place, border first.
    Free(Vec<u32>),
}

/// A face ready to be filled.
#[derive(Clone, Debug)]
pub struct FaceMesh {
    /// The surface.
    pub surface: SurfaceId,
    /// Its geometry and node ids; inner ones from `first` on.
    pub geometry: FaceGeometry,
    /// Elements.
    pub elements: Elements,
    /// First inner node.
    pub first: u32,
    /// Number of inner nodes.
    pub inner: u64,
    /// Number of triangles.
    pub triangles: u64,
    /// Number of quads.
    pub quads: u64,
    /// Points of the inner nodes, where they are not made from the geometry alone.
    pub made: Vec<DVec3>,
    /// Edges of the loops by place in the geometry, with the face on their left; of free faces.
    pub around: Vec<[u32; 2]>,
    /// What decided the sizes inside; of free faces.
    pub deciders: Vec<Decider>,
    /// Its cells between lines of constant u and v, where it was made of such.
    pub tally: Option<Tally>,
}

/// A point in the middle of a face.
pub fn middle(input: &Input, face: &Face) -> DVec3 {
    let patch = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    if face.is_triangle() {
        surface.point(1.0 / 3.0, 1.0 / 3.0)
    } else {
        surface.point(0.5 * (patch.u.0 + patch.u.1), 0.5 * (patch.v.0 + patch.v.1))
    }
}

/// Chooses how each face is made: mapped where it can be and no other method is written, else freely.
///
/// Fails with E705 for faces that cannot be mapped but must, or have no border.
pub fn choose(input: &Input, layout: &mut Layout) -> Result<()> {
    for face in &mut layout.faces {
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let crossed = || (!face.lines.is_empty() || !face.points.is_empty()).then(|| crossed(face));
        let uneven = || {
            face.uneven.map(|why| match why {
                Uneven::Row(step) => format!("with a piece of border of {}, as narrow as a row would be", short(step)),
                Uneven::Beside(step) => format!("beside a free one that needs steps of {}, which rows do not follow", short(step)),
                Uneven::Together => "whose map would fall together with that of another face".to_owned(),
                Uneven::Sharp(angle) => format!("whose map would have angles of {}°", short(angle.to_degrees())),
            })
        };
        let why = unmappable(surface, face).or_else(crossed).or_else(uneven).or_else(|| pole(face));
        let (of, at) = (surface.origin(), middle(input, face));
        let borderless = face.sides.iter().all(|s| s.uses.is_empty());
        if let Some(why) = why.clone().filter(|_| face.method == Method::Mapped || borderless) {
            return Err(MeshFault::CannotMap { surface: of, why, at }.into());
        }
        face.free = face.method.is_free() || why.is_some();
        face.why = why.filter(|_| !face.method.is_free());
        if let Some(method) = face.method.of_triangles().filter(|_| face.takes_quads()) {
            return Err(MeshFault::TrianglesOnly { of: input.plan.origin, method, surface: of, at }.into());
        }
    }
    Ok(())
}

/// Why a face of quads that nothing says to map is not, in words that follow "a face".
fn pole(face: &Face) -> Option<String> {
    let is_quads = face.method == Method::Auto && face.elements == Elements::Quads && !face.is_triangle();
    (is_quads && face.sides.iter().any(|side| side.uses.is_empty())).then(|| "with a pole, where a map would make triangles".to_owned())
}

/// A length with three digits that count.
fn short(x: f64) -> String {
    real(format!("{x:.2e}").parse().unwrap_or(x))
}

/// What lies inside a face, in words that follow "a face".
fn crossed(face: &Face) -> String {
    let some = |n: usize, one: &str, many: &str| if n == 1 { one.to_owned() } else { format!("{n} {many}") };
    let lines = some(face.lines.len(), "a curve", "pieces of curves");
    let points = some(face.points.len(), "a point", "points");
    match (face.lines.is_empty(), face.points.is_empty()) {
        (false, true) => format!("with {lines} inside, off its mesh lines"),
        (true, _) => format!("with {points} inside, off its mesh lines"),
        (false, false) => format!("with {lines} and {points} inside, off its mesh lines"),
    }
}

/// Why a face cannot be mapped, in words that follow "a face".
fn unmappable(surface: &Surface, face: &Face) -> Option<String> {
    if matches!(surface.domain(), Domain::Loop | Domain::Unbounded) {
        return Some(match surface.domain() {
            Domain::Loop if face.sides.len() == 1 => "with one side and no map".to_owned(),
            Domain::Loop => format!("with {} sides and no map between them", face.sides.len()),
            _ => "without borders".to_owned(),
        });
    }
    let empty = |k: usize| face.sides[k].uses.is_empty();
    if face.is_triangle() {
        return (0..3).any(empty).then(|| "with three sides of which one is a point".to_owned());
    }
    (0..4).any(|k| empty(k) && empty((k + 1) % 4)).then(|| "with two neighbouring sides that are points".to_owned())
}

/// E704 when faces for which only quads are wanted got triangles.
pub fn refuse_triangles(input: &Input, layout: &Layout, prepared: &[FaceMesh]) -> Result<()> {
    let mut places = Vec::new();
    for (face, ready) in layout.faces.iter().zip(prepared) {
        if ready.elements == Elements::Quads && ready.triangles > 0 {
            let pole = face.sides.iter().find_map(|s| s.pole).map_or_else(|| middle(input, face), |p| layout.pieces.junctions[p]);
            places.push((input.model.surfaces[face.surface.index()].surface.origin(), ready.triangles, pole));
        }
    }
    if places.is_empty() { Ok(()) } else { Err(MeshFault::QuadsImpossible { mesh: input.plan.origin, places }.into()) }
}

/// Side nodes of a face with their lengths along the side.
pub struct Line {
    /// Nodes.
    pub ids: Vec<u32>,
    /// Arc length from the side's start, model units.
    pub lengths: Vec<f64>,
}

/// The nodes along a side, ascending; a pole gives `steps + 1` times its node.
pub fn line(layout: &Layout, nodes: &Nodes, face: &Face, side: usize, steps: usize) -> Line {
    let border = &face.sides[side];
    let (mut ids, mut lengths) = (Vec::new(), Vec::new());
    for u in &border.uses {
        let segment = nodes.of_segment(layout, u.segment, u.against);
        let fractions = nodes.fractions(u.segment, u.against);
        if !ids.is_empty() {
            ids.pop();
            lengths.pop();
        }
        ids.extend(segment);
        lengths.extend(fractions.iter().map(|f| if *f == 1.0 { u.s.1 } else { u.s.0 + (u.s.1 - u.s.0) * f }));
    }
    if border.uses.is_empty() {
        ids = vec![border.pole.map_or(0, |p| nodes.of_junction(p)); steps + 1];
    }
    Line { ids, lengths }
}

/// The geometry and ids of a face; `rows` are the counts of its rows, `first` becomes its first inner node.
pub fn prepare(input: &Input, layout: &Layout, nodes: &Nodes, face: &Face, rows: &[u32]) -> Result<FaceMesh> {
    if face.is_triangle() {
        return prepare_triangle(input, layout, nodes, face);
    }
    let patch = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let steps = |k: usize| rows[k % 2] as usize;
    let lines = [0, 1, 2, 3].map(|k| line(layout, nodes, face, k, steps(k)));
    let mut values =
        [0, 1, 2, 3].map(|k| if lines[k].lengths.is_empty() { Vec::new() } else { side_parameters(input, face, k, &lines[k].lengths) });
    for k in 0..4 {
        if values[k].is_empty() {
            let (low, high) = if k % 2 == 0 { patch.u } else { patch.v };
            // At a pole lines go on as they come from the other side; between two poles they are even.
            let even = || (0..=steps(k)).map(|i| low + (high - low) * i as f64 / steps(k) as f64).collect();
            let opposite = &values[(k + 2) % 4];
            values[k] = if opposite.is_empty() { even() } else { opposite.clone() };
        }
    }
    let poles = [0, 1, 2, 3].map(|k| face.sides[k].uses.is_empty());
    let [a, b, c, d] = lines;
    let frame = mapped::Frame { sides: [a.ids, b.ids, c.ids, d.ids], poles, first: 0 };
    let (triangles, quads) = frame.elements(face.elements);
    let grid = Grid::new(patch.u, patch.v, values, input.tolerance);
    Ok(FaceMesh {
        inner: frame.inner(),
        geometry: FaceGeometry { surface: surface.clone(), shape: Shape::Grid(grid), frame: Frame::Grid(frame), flipped: face.flipped },
        surface: face.surface,
        elements: face.elements,
        first: 0,
        triangles,
        quads,
        made: Vec::new(),
        around: Vec::new(),
        deciders: Vec::new(),
        tally: None,
    })
}

fn prepare_triangle(input: &Input, layout: &Layout, nodes: &Nodes, face: &Face) -> Result<FaceMesh> {
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let lines = [0, 1, 2].map(|k| line(layout, nodes, face, k, 0));
    let values = [0, 1, 2].map(|k| side_parameters(input, face, k, &lines[k].lengths));
    let [a, b, c] = lines;
    let ids = [a.ids, b.ids, c.ids];
    let n = ids[0].len() as u64 - 1;
    if face.elements == Elements::Triangles {
        let inner = if n < 2 { 0 } else { (n - 1) * (n - 2) / 2 };
        return Ok(FaceMesh {
            geometry: FaceGeometry {
                surface: surface.clone(),
                shape: Shape::Lattice(Lattice { sides: values }),
                frame: Frame::Lattice(LatticeFrame { sides: ids, first: 0 }),
                flipped: face.flipped,
            },
            surface: face.surface,
            elements: face.elements,
            first: 0,
            inner,
            triangles: n * n,
            quads: 0,
            made: Vec::new(),
            around: Vec::new(),
            deciders: Vec::new(),
            tally: None,
        });
    }
    let Some(blocks) = Blocks::new(&values) else {
        let counts = [0, 1, 2].map(|k| ids[k].len() as u32 - 1);
        return Err(MeshFault::SidesDoNotClose { counts, written: Vec::new(), surface: surface.origin() }.into());
    };
    let mut places = vec![0; blocks.uv.len()];
    for (side, line) in blocks.sides.iter().zip(&ids) {
        side.iter().zip(line).for_each(|(place, id)| places[*place as usize] = *id);
    }
    Ok(FaceMesh {
        inner: blocks.inner as u64,
        triangles: 0,
        quads: blocks.quads.len() as u64,
        geometry: FaceGeometry {
            surface: surface.clone(),
            shape: Shape::Blocks(blocks),
            frame: Frame::Blocks(places),
            flipped: face.flipped,
        },
        surface: face.surface,
        elements: face.elements,
        first: 0,
        made: Vec::new(),
        around: Vec::new(),
        deciders: Vec::new(),
        tally: None,
    })
}

impl Frame {
    /// Moves all ids up.
    pub fn shift(&mut self, by: u32) {
        let lists: Vec<&mut Vec<u32>> = match self {
            Self::Grid(frame) => {
                frame.first += by;
                frame.sides.iter_mut().collect()
            }
            Self::Lattice(frame) => {
                frame.first += by;
                frame.sides.iter_mut().collect()
            }
            Self::Blocks(places) | Self::Free(places) => vec![places],
        };
        lists.into_iter().flatten().for_each(|id| *id += by);
    }
}

/// The triangles and quads of one face among those of its mesh.
pub type FaceRanges = (Range<usize>, Range<usize>);

/// The triangles and quads of each face among those of the mesh, where they follow each other face by face.
pub fn element_ranges(prepared: &[FaceMesh]) -> Vec<FaceRanges> {
    let (mut t, mut q) = (0, 0);
    let one = |ready: &FaceMesh| {
        let own = (t..t + ready.triangles as usize, q..q + ready.quads as usize);
        (t, q) = (own.0.end, own.1.end);
        own
    };
    prepared.iter().map(one).collect()
}

impl FaceMesh {
    /// What remains of it beside the mesh.
    pub fn into_chart(self) -> FaceGeometry {
        self.geometry
    }

    /// Gives the inner nodes their ids.
    pub fn number(&mut self, first: u32) {
        self.first = first;
        match &mut self.geometry.frame {
            Frame::Grid(frame) => frame.first = first,
            Frame::Lattice(frame) => frame.first = first,
            Frame::Free(places) => {
                let border = places.len() - self.inner as usize;
                places[border..].iter_mut().zip(first..).for_each(|(place, id)| *place = id);
            }
            Frame::Blocks(places) => places[..self.inner as usize].iter_mut().zip(first..).for_each(|(place, id)| *place = id),
        }
    }

    /// Points of the inner nodes.
    pub fn points(&self, surface: &Surface, out: &mut [DVec3]) {
        match &self.geometry.shape {
            Shape::Free(_) => out.copy_from_slice(&self.made),
            Shape::Grid(grid) => grid.inner_points(surface, out),
            Shape::Lattice(lattice) => {
                for (p, (i, j)) in out.iter_mut().zip(LatticeFrame::inner(lattice.size())) {
                    let (u, v) = lattice.uv(i, j);
                    *p = surface.point(u, v);
                }
            }
            Shape::Blocks(blocks) => {
                for (p, (u, v)) in out.iter_mut().zip(&blocks.uv) {
                    *p = surface.point(*u, *v);
                }
            }
        }
    }

    /// For each cell of a grid of triangles whether its other diagonal is the better one. `node` gives points of border and
    /// inner nodes, `even` the distance below which both diagonals of a cell are as good.
    pub fn diagonals(&self, surface: &Surface, node: &(dyn Fn(u32) -> DVec3 + Sync), even: f64) -> Vec<bool> {
        match (&self.geometry.frame, &self.geometry.shape) {
            (Frame::Grid(frame), Shape::Grid(grid)) if self.elements == Elements::Triangles => {
                mapped::diagonals(grid, frame, surface, node, even)
            }
            _ => Vec::new(),
        }
    }

    /// Elements by global ids, with these [`Self::diagonals`].
    pub fn fill(&self, diagonals: &[bool], triangles: &mut [[u32; 3]], quads: &mut [[u32; 4]]) {
        match (&self.geometry.frame, &self.geometry.shape) {
            (Frame::Grid(frame), Shape::Grid(_)) => {
                mapped::fill(frame, self.elements, self.geometry.flipped, diagonals, triangles, quads);
            }
            (Frame::Lattice(frame), Shape::Lattice(lattice)) => {
                for (slot, t) in triangles.iter_mut().zip(LatticeFrame::triangles(lattice.size())) {
                    let [a, b, c] = t.map(|(i, j)| frame.node(i, j));
                    *slot = if self.geometry.flipped { [a, c, b] } else { [a, b, c] };
                }
            }
            (Frame::Blocks(places), Shape::Blocks(blocks)) => {
                for (slot, q) in quads.iter_mut().zip(&blocks.quads) {
                    let [a, b, c, d] = q.map(|n| places[n as usize]);
                    *slot = if self.geometry.flipped { [a, d, c, b] } else { [a, b, c, d] };
                }
            }
            (Frame::Free(places), Shape::Free(free)) => {
                for (slot, t) in triangles.iter_mut().zip(&free.triangles) {
                    let [a, b, c] = t.map(|n| places[n as usize]);
                    *slot = if self.geometry.flipped { [a, c, b] } else { [a, b, c] };
                }
                for (slot, q) in quads.iter_mut().zip(&free.quads) {
                    let [a, b, c, d] = q.map(|n| places[n as usize]);
                    *slot = if self.geometry.flipped { [a, d, c, b] } else { [a, b, c, d] };
                }
            }
            _ => {}
        }
    }
}

/// The limits a plan sets on faces.
pub fn limits_of(input: &Input) -> Limits {
    Limits::of(input)
}

/// Too many elements, before anything is allocated; `None` where it is not known how many.
pub fn too_many(plan: &Plan, of: Origin, elements: Option<u64>) -> Fault {
    MeshFault::TooMany { of, name: plan.name.clone(), elements, limit: plan.most_elements }.into()
}

/// More work than a mesh may take, of a face or of all.
pub fn too_much_work(input: &Input, surface: Origin) -> Fault {
    let plan = input.plan;
    let limit = plan.chord_error.or(plan.angle_error).map(|limit| limit.1);
    MeshFault::TooMuchWork { of: limit.unwrap_or_else(|| plan.size_origin()), name: plan.name.clone(), surface }.into()
}

/// Work that a mesh of some surfaces may take beside that of its elements, in evaluations of curves and surfaces: more where a point of
/// one is made of many curves.
pub fn work_on<'a>(surfaces: impl Iterator<Item = &'a Surface>) -> u64 {
    /// Curves that are worth as much again.
    const CURVES: usize = 16;
    let curves = |surface: &Surface| {
        let (across, along) = surface.curves_of_a_point();
        across + along
    };
    MESH_WORK * (1 + surfaces.map(curves).max().unwrap_or(0) / CURVES) as u64
}

/// Raises what a mesh or face may take to what so many elements are worth, with what was `worth` for it before.
pub fn allow(elements: u64, worth: &mut u64) {
    let now = elements.saturating_mul(WORK_OF_AN_ELEMENT);
    if let Some(budget) = work::budget() {
        budget.allow(now.saturating_sub(*worth));
    }
    *worth = now.max(*worth);
}
