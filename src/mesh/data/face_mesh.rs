//! Faces before their elements: their geometries, the ids of their border nodes, and how many nodes and elements they make.

use std::ops::Range;

use glam::DVec3;

use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::data::quality::QualityTally;
use crate::mesh::mapped::diagonals::{DiagonalRule, diagonals};
use crate::mesh::mapped::grid;
use crate::mesh::mapped::trilateral::LatticeIds;
use crate::mesh::request::decider::{Decided, Tally};
use crate::mesh::request::methods::Elements;
use crate::model::SurfaceId;
use crate::surface::Surface;

/// A face before its elements are filled in.
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
    /// What is known of a free face beside its elements.
    pub inside: Option<FreeInside>,
}

/// What a free face has beside its elements.
#[derive(Clone, Debug, Default)]
pub struct FreeInside {
    /// Points of the inner nodes.
    pub points: Vec<DVec3>,
    /// Edges of the loops by place in the list of (u, v), with the face on their left.
    pub loops: Vec<[u32; 2]>,
    /// What decided the sizes at the inner nodes.
    pub decided: Decided,
    /// Its cells between lines of constant u and v, where it was made of these.
    pub tally: Option<Tally>,
    /// Nodes of its border that slid along it.
    pub slid: Vec<SlidNode>,
}

/// A border node that slid along its segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidNode {
    /// Its place in the list of (u, v).
    pub node: u32,
    /// Its fraction of the length of the segment now.
    pub fraction: f64,
}

crate::plain!(SlidNode { node, fraction });

/// The triangles and quads of one face among those of its mesh.
pub type FaceRanges = (Range<usize>, Range<usize>);

/// The triangles and quads of each face among those of the mesh, where they follow each other face by face.
pub fn element_ranges(prepared: &[FaceMesh]) -> Vec<FaceRanges> {
    let (mut t, mut q) = (0, 0);
    let one = |face: &FaceMesh| {
        let own = (t..t + face.triangles as usize, q..q + face.quads as usize);
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
        match &mut self.geometry.nodes {
            FaceNodes::Grid(_, frame) => frame.first = first,
            FaceNodes::Lattice(_, frame) => frame.first = first,
            FaceNodes::Free(_, places) => {
                let border = places.len() - self.inner as usize;
                places[border..].iter_mut().zip(first..).for_each(|(place, id)| *place = id);
            }
            FaceNodes::Blocks(_, places) => places[..self.inner as usize].iter_mut().zip(first..).for_each(|(place, id)| *place = id),
        }
    }

    /// Points of the inner nodes.
    pub fn points(&self, surface: &Surface, out: &mut [DVec3]) {
        match &self.geometry.nodes {
            FaceNodes::Free(..) => out.copy_from_slice(self.inside.as_ref().map_or(&[], |inside| &inside.points)),
            FaceNodes::Grid(grid, _) => grid.inner_points(surface, out),
            FaceNodes::Lattice(lattice, _) => {
                for (p, (i, j)) in out.iter_mut().zip(LatticeIds::inner(lattice.size())) {
                    let (u, v) = lattice.uv(i, j);
                    *p = surface.point(u, v);
                }
            }
            FaceNodes::Blocks(blocks, _) => {
                for (p, (u, v)) in out.iter_mut().zip(&blocks.uv) {
                    *p = surface.point(*u, *v);
                }
            }
        }
    }

    /// For each cell of a grid of triangles whether its other diagonal is the better one. `node` gives points of border and
    /// inner nodes.
    pub fn diagonals(&self, surface: &Surface, node: &(dyn Fn(u32) -> DVec3 + Sync), rule: DiagonalRule) -> Vec<bool> {
        match &self.geometry.nodes {
            FaceNodes::Grid(grid, frame) if self.elements == Elements::Triangles => diagonals(grid, frame, surface, node, rule),
            _ => Vec::new(),
        }
    }

    /// Elements by global ids, with these [`Self::diagonals`].
    pub fn fill(&self, diagonals: &[bool], triangles: &mut [[u32; 3]], quads: &mut [[u32; 4]]) {
        match &self.geometry.nodes {
            FaceNodes::Grid(_, frame) => {
                grid::fill(frame, self.elements, self.geometry.flipped, diagonals, triangles, quads);
            }
            FaceNodes::Lattice(lattice, frame) => {
                for (slot, t) in triangles.iter_mut().zip(LatticeIds::triangles(lattice.size())) {
                    let [a, b, c] = t.map(|(i, j)| frame.node(i, j));
                    *slot = if self.geometry.flipped { [a, c, b] } else { [a, b, c] };
                }
            }
            FaceNodes::Blocks(blocks, places) => {
                for (slot, q) in quads.iter_mut().zip(&blocks.quads) {
                    let [a, b, c, d] = q.map(|n| places[n as usize]);
                    *slot = if self.geometry.flipped { [a, d, c, b] } else { [a, b, c, d] };
                }
            }
            FaceNodes::Free(free, places) => {
                for (slot, t) in triangles.iter_mut().zip(&free.triangles) {
                    let [a, b, c] = t.map(|n| places[n as usize]);
                    *slot = if self.geometry.flipped { [a, c, b] } else { [a, b, c] };
                }
                for (slot, q) in quads.iter_mut().zip(&free.quads) {
                    let [a, b, c, d] = q.map(|n| places[n as usize]);
                    *slot = if self.geometry.flipped { [a, d, c, b] } else { [a, b, c, d] };
                }
            }
        }
    }
}

/// Notes the quality of the elements of each face.
pub fn measure_quality(prepared: &mut [FaceMesh], mesh: &Mesh) {
    let ranges = element_ranges(prepared);
    for (face_mesh, (triangles, quads)) in prepared.iter_mut().zip(ranges) {
        face_mesh.geometry.quality = Some(QualityTally::of(&mesh.triangles[triangles], &mesh.quads[quads], &mesh.nodes));
    }
}
