//! Faces ready to be filled: their geometries, the ids of their border nodes, and how many nodes and elements they make.

use crate::mesh::data::face_geometry::Frame;
use std::ops::Range;

use glam::DVec3;

use crate::mesh::data::face_geometry::{FaceGeometry, Shape};
use crate::mesh::mapped::grid;
use crate::mesh::mapped::trilateral::LatticeFrame;
use crate::mesh::request::decider::{Decider, Tally};
use crate::mesh::request::plan::Elements;
use crate::model::SurfaceId;
use crate::surface::Surface;

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
                grid::diagonals(grid, frame, surface, node, even)
            }
            _ => Vec::new(),
        }
    }

    /// Elements by global ids, with these [`Self::diagonals`].
    pub fn fill(&self, diagonals: &[bool], triangles: &mut [[u32; 3]], quads: &mut [[u32; 4]]) {
        match (&self.geometry.frame, &self.geometry.shape) {
            (Frame::Grid(frame), Shape::Grid(_)) => {
                grid::fill(frame, self.elements, self.geometry.flipped, diagonals, triangles, quads);
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
