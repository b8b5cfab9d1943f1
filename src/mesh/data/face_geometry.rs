//! Faces of a mesh on their surfaces: where their nodes lie, and which nodes of the mesh they are.

use crate::mesh::data::quality::QualityTally;
use crate::mesh::mapped::grid::{Grid, GridIds};
use crate::mesh::mapped::trilateral::{Blocks, Lattice, LatticeIds, lattice_points};
use crate::surface::Surface;

/// Geometries of the faces of a mesh, in the order of its faces; they ride along for measuring and never decide whether two
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
    /// Where its nodes lie, and which nodes of the mesh they are.
    pub nodes: FaceNodes,
    /// The other side is up.
    pub flipped: bool,
    /// Quality of its elements, once they are made; `None` for those of a kept mesh, and moved ones.
    pub quality: Option<QualityTally>,
}

impl FaceGeometry {
    /// The same face in a mesh where its nodes come `by` later.
    pub fn shifted(mut self, by: u32) -> Self {
        self.nodes.shift(by);
        self
    }
}

/// How a face is divided: where its nodes lie in (u, v), with their ids in the mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum FaceNodes {
    /// One grid.
    Grid(Grid, GridIds),
    /// One lattice of triangles.
    Lattice(Lattice, LatticeIds),
    /// Three grids of quads that meet inside a triangle; ids by place in their list of (u, v).
    Blocks(Blocks, Vec<u32>),
    /// Elements that no map gave; ids by place in their list of (u, v), border first.
    Free(Free, Vec<u32>),
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

impl FaceNodes {
    /// Moves all ids up.
    pub fn shift(&mut self, by: u32) {
        let lists: Vec<&mut Vec<u32>> = match self {
            Self::Grid(_, ids) => {
                ids.first += by;
                ids.sides.iter_mut().collect()
            }
            Self::Lattice(_, ids) => {
                ids.first += by;
                ids.sides.iter_mut().collect()
            }
            Self::Blocks(_, ids) | Self::Free(_, ids) => vec![ids],
        };
        lists.into_iter().flatten().for_each(|id| *id += by);
    }

    /// (u, v) of the nodes in a list; none of a grid, where rows and columns give them.
    pub fn listed_uv(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Grid(..) => Vec::new(),
            Self::Lattice(lattice, _) => lattice_points(lattice),
            Self::Blocks(blocks, _) => blocks.uv.clone(),
            Self::Free(free, _) => free.uv.clone(),
        }
    }

    /// Ids by place in the list of (u, v); none of a grid.
    pub fn listed_ids(&self) -> Vec<u32> {
        match self {
            Self::Grid(..) => Vec::new(),
            Self::Lattice(lattice, ids) => {
                let n = lattice.size();
                (0..=n).flat_map(|j| (0..=n - j).map(move |i| (i, j))).map(|(i, j)| ids.node(i, j)).collect()
            }
            Self::Blocks(_, ids) | Self::Free(_, ids) => ids.clone(),
        }
    }

    /// Visits the cells by places in the list of (u, v); none of a grid.
    pub fn each_listed_cell(&self, mut visit: impl FnMut(&[usize])) {
        match self {
            Self::Grid(..) => {}
            Self::Lattice(lattice, _) => {
                LatticeIds::triangles(lattice.size()).for_each(|t| visit(&t.map(|(i, j)| lattice.index(i, j))));
            }
            Self::Blocks(blocks, _) => blocks.quads.iter().for_each(|q| visit(&q.map(|n| n as usize))),
            Self::Free(free, _) => {
                free.triangles.iter().for_each(|t| visit(&t.map(|n| n as usize)));
                free.quads.iter().for_each(|q| visit(&q.map(|n| n as usize)));
            }
        }
    }
}
