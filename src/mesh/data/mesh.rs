//! A mesh as plain arrays.

use std::ops::Range;

use glam::DVec3;

use crate::mesh::data::face_geometry::FaceGeometries;
use crate::mesh::data::node_sizes::NodeSizes;

/// Elements of one patch or curve, contiguous in the arrays.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceRange {
    /// Name of the surface (faces) or curve (lines) as declared.
    pub name: String,
    /// Triangles of it.
    pub triangles: Range<u32>,
    /// Quads of it.
    pub quads: Range<u32>,
    /// Line elements of it.
    pub lines: Range<u32>,
}

/// A named set. Element numbers count lines, then triangles, then quads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// Name as declared.
    pub name: String,
    /// Nodes, ascending, from 0.
    pub nodes: Vec<u32>,
    /// Line elements, ascending.
    pub lines: Vec<u32>,
    /// Triangles, ascending.
    pub triangles: Vec<u32>,
    /// Quads, ascending.
    pub quads: Vec<u32>,
}

impl Group {
    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty() && self.lines.is_empty() && self.triangles.is_empty() && self.quads.is_empty()
    }

    /// Highest dimension of what it holds: 2 faces, 1 lines, 0 nodes.
    pub fn dimension(&self) -> u8 {
        if !self.triangles.is_empty() || !self.quads.is_empty() { 2 } else { u8::from(!self.lines.is_empty()) }
    }
}

/// A mesh: nodes and elements, elements of one face contiguous, corner nodes counter-clockwise seen against the normal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name as declared.
    pub name: String,
    /// 1 or 2.
    pub order: u8,
    /// Nodes, model units; mid nodes of order 2 come after all corner nodes.
    pub nodes: Vec<DVec3>,
    /// Nodes that are elements of their own (points in the mesh).
    pub points: Vec<u32>,
    /// Two-node line elements.
    pub lines: Vec<[u32; 2]>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Quads.
    pub quads: Vec<[u32; 4]>,
    /// Order 2: middle node of each line.
    pub line_mids: Vec<u32>,
    /// Order 2: mid nodes of each triangle, after corners 0, 1, 2.
    pub triangle_mids: Vec<[u32; 3]>,
    /// Order 2: mid nodes of each quad, after corners 0, 1, 2, 3.
    pub quad_mids: Vec<[u32; 4]>,
    /// Which elements belong to which surface and patch, in order.
    pub faces: Vec<FaceRange>,
    /// Named sets: one per surface, then one per `group`, in order of declaration.
    pub groups: Vec<Group>,
    /// Where the nodes of its faces lie on their surfaces; empty for meshes that were read.
    pub geometries: FaceGeometries,
    /// Largest distance between the steps of borders of one face alone and their curves, model units; 0 for meshes that were read.
    pub border_error: f64,
    /// Asked lengths at its corner nodes and what decided them; empty where nobody asked for them, and for meshes that were read.
    pub sizes: NodeSizes,
}

impl Mesh {
    /// Nodes that are not mid nodes of order 2.
    pub fn corner_count(&self) -> usize {
        let mids = self.line_mids.iter().chain(self.triangle_mids.as_flattened()).chain(self.quad_mids.as_flattened());
        mids.min().map_or(self.nodes.len(), |first| *first as usize)
    }

    /// Numbers the mid nodes higher by so many.
    fn shift_mids(&mut self, by: u32) {
        let mids = self.line_mids.iter_mut().chain(self.triangle_mids.as_flattened_mut()).chain(self.quad_mids.as_flattened_mut());
        mids.for_each(|mid| *mid += by);
    }

    /// Adds the nodes and elements of another mesh after this one's, mid nodes of both after the corner nodes of both; groups are
    /// left to the caller.
    pub fn append(&mut self, mut other: Mesh) {
        if self.nodes.is_empty() {
            *self = other;
            return;
        }
        self.border_error = self.border_error.max(other.border_error);
        let (corners, all) = (self.corner_count(), self.nodes.len() as u32);
        let own_mids = self.nodes.split_off(corners);
        let more = other.corner_count();
        if !(self.sizes.of.is_empty() && other.sizes.of.is_empty()) {
            self.sizes.append(corners, &other.sizes, more);
        }
        self.shift_mids(more as u32);
        other.shift_mids(all);
        self.nodes.extend(other.nodes.drain(..more));
        self.nodes.extend(own_mids);
        self.nodes.append(&mut other.nodes);
        let n = corners as u32;
        let (l, t, q) = (self.lines.len() as u32, self.triangles.len() as u32, self.quads.len() as u32);
        self.points.extend(other.points.iter().map(|p| p + n));
        self.lines.extend(other.lines.iter().map(|e| e.map(|p| p + n)));
        self.triangles.extend(other.triangles.iter().map(|e| e.map(|p| p + n)));
        self.quads.extend(other.quads.iter().map(|e| e.map(|p| p + n)));
        self.line_mids.append(&mut other.line_mids);
        self.triangle_mids.append(&mut other.triangle_mids);
        self.quad_mids.append(&mut other.quad_mids);
        self.geometries.0.extend(other.geometries.0.into_iter().map(|geometry| geometry.shifted(n)));
        let shift = |r: &Range<u32>, by: u32| r.start + by..r.end + by;
        self.faces.extend(other.faces.into_iter().map(|f| FaceRange {
            triangles: shift(&f.triangles, t),
            quads: shift(&f.quads, q),
            lines: shift(&f.lines, l),
            name: f.name,
        }));
    }
}
