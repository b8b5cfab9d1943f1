//! A mesh as plain arrays.

use std::ops::Range;

use glam::DVec3;

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
}
