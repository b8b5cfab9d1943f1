//! Some cells of a mapped face, for what is predicted of all of them.

use glam::DVec3;

use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::mapped::trilateral::LatticeIds;

/// Number of cells of blocks that are sampled.
const BLOCK_SAMPLES: usize = 12;

/// A node of a cell: its number and its place.
pub(super) type CellNode = (u32, (f64, f64));

/// Nodes of a face with their points, which are computed for inner ones.
pub(super) struct View<'a> {
    pub(super) face_input: &'a FaceInput<'a>,
    pub(super) face_mesh: &'a FaceMesh,
}

impl View<'_> {
    pub(super) fn point(&self, (id, (u, v)): CellNode) -> DVec3 {
        if id < self.face_mesh.first { self.face_input.points[id as usize] } else { self.face_mesh.geometry.surface.point(u, v) }
    }

    /// Corners of a cell, those at a pole once.
    pub(super) fn cell(&self, nodes: &[CellNode]) -> Vec<DVec3> {
        let distinct = (0..nodes.len()).filter(|k| nodes[*k].0 != nodes[(k + 1) % nodes.len()].0);
        distinct.map(|k| self.point(nodes[k])).collect()
    }
}

/// A cell of a map.
pub(super) struct SampledCell {
    pub(super) nodes: Vec<CellNode>,
    /// At a corner of the face.
    pub(super) corner: bool,
    /// Number of cells in its row and in its column; 1 where they are not alike.
    pub(super) rows: (usize, usize),
}

/// Some cells of a map: of a grid so many along each direction, its ends among them.
pub(super) fn sampled_cells(face_mesh: &FaceMesh, samples: usize) -> Option<Vec<SampledCell>> {
    match &face_mesh.geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let (nu, nv) = grid.size();
            let node = |(i, j): (usize, usize)| (frame.node(i, j), grid.uv(i, j));
            let some = |n: usize| {
                let half = samples / 2;
                let both = |k: usize| [k * n / samples, n - 1 - k * n / samples];
                let mut places: Vec<usize> = (0..half).flat_map(both).chain([n / 2]).collect();
                places.sort_unstable();
                places.dedup();
                places
            };
            let at = some(nv).into_iter().flat_map(|j| some(nu).into_iter().map(move |i| (i, j)));
            let end = |k: usize, n: usize| k == 0 || k == n - 1;
            let cell = |(i, j): (usize, usize)| SampledCell {
                nodes: [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(node).to_vec(),
                corner: end(i, nu) && end(j, nv),
                rows: (nu, nv),
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
            Some(all.map(|t| SampledCell { nodes: t.map(node).to_vec(), corner: corner(t[0]), rows: (n, n) }).collect())
        }
        FaceNodes::Blocks(blocks, places) => {
            let node = |n: u32| (places[n as usize], blocks.uv[n as usize]);
            let count = blocks.quads.len();
            let apart = count.div_ceil(BLOCK_SAMPLES).max(1);
            let some = blocks.quads.iter().step_by(apart).chain(blocks.quads.last());
            let ends: Vec<u32> = blocks.sides.iter().filter_map(|side| side.first()).chain(blocks.sides[1].last()).copied().collect();
            let corner = |q: &[u32; 4]| q.iter().any(|n| ends.contains(n));
            Some(some.map(|q| SampledCell { nodes: q.map(node).to_vec(), corner: corner(q), rows: (1, 1) }).collect())
        }
        _ => None,
    }
}
