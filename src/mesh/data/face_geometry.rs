//! Where the nodes of a mapped face lie in (u, v): a grid between four divided sides, or a lattice between three.

use crate::mesh::mapped::grid;
use crate::mesh::mapped::grid::Grid;
use crate::mesh::mapped::trilateral::Lattice;
use crate::mesh::mapped::trilateral::LatticeFrame;

use crate::surface::Surface;

/// FaceGeometries of the faces of a mesh, in the order of its faces; they ride along for measuring and never decide whether two
/// meshes are equal.
#[derive(Clone, Debug, Default)]
pub struct FaceGeometries(pub Vec<FaceGeometry>);

impl PartialEq for FaceGeometries {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// One face of a mesh on its surface.
#[derive(Clone, Debug)]
pub struct FaceGeometry {
    /// The surface.
    pub surface: Surface,
    /// Where its nodes lie.
    pub shape: Shape,
    /// Which nodes of the mesh they are.
    pub frame: Frame,
    /// The other side is up.
    pub flipped: bool,
}

impl FaceGeometry {
    /// The same face in a mesh where its nodes come `by` later.
    pub fn shifted(mut self, by: u32) -> Self {
        self.frame.shift(by);
        self
    }
}

/// How a face is divided.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One grid.
    Grid(Grid),
    /// One lattice of triangles.
    Lattice(Lattice),
    /// Three grids of quads that meet inside a triangle, by the (u, v) of their nodes.
    Blocks(crate::mesh::mapped::trilateral::Blocks),
    /// Elements that no map gave, by the (u, v) of their nodes.
    Free(Free),
}

/// Triangles and quads over (u, v): nodes of the border first, then inner ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Free {
    /// Places of the nodes.
    pub uv: Vec<(f64, f64)>,
    /// Number of border nodes; some may be one node of the mesh in two places (a seam).
    pub border: usize,
    /// Corners of the triangles, counter-clockwise in (u, v).
    pub triangles: Vec<[u32; 3]>,
    /// Corners of the quads, counter-clockwise in (u, v).
    pub quads: Vec<[u32; 4]>,
}

/// Global node ids of a face.
#[derive(Clone, Debug, PartialEq)]
pub enum Frame {
    /// Of a grid.
    Grid(grid::Frame),
    /// Of a lattice.
    Lattice(LatticeFrame),
    /// Of three blocks: ids by place among the blocks' nodes.
    Blocks(Vec<u32>),
    /// Of a free face: ids by place, border first.
    Free(Vec<u32>),
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

/// Cells of a lattice, of blocks or of a free face by places in their lists of (u, v).
pub fn each_cell(shape: &Shape, mut visit: impl FnMut(&[usize])) {
    match shape {
        Shape::Lattice(lattice) => {
            LatticeFrame::triangles(lattice.size()).for_each(|t| visit(&t.map(|(i, j)| lattice.index(i, j))));
        }
        Shape::Blocks(blocks) => blocks.quads.iter().for_each(|q| visit(&q.map(|n| n as usize))),
        Shape::Free(free) => {
            free.triangles.iter().for_each(|t| visit(&t.map(|n| n as usize)));
            free.quads.iter().for_each(|q| visit(&q.map(|n| n as usize)));
        }
        Shape::Grid(_) => {}
    }
}

/// Global ids by place in the list of (u, v).
pub fn ids(shape: &Shape, frame: &Frame) -> Vec<u32> {
    match (shape, frame) {
        (Shape::Lattice(lattice), Frame::Lattice(frame)) => {
            let n = lattice.size();
            (0..=n).flat_map(|j| (0..=n - j).map(move |i| (i, j))).map(|(i, j)| frame.node(i, j)).collect()
        }
        (_, Frame::Blocks(places) | Frame::Free(places)) => places.clone(),
        _ => Vec::new(),
    }
}
