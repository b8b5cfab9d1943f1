//! Kinds of elements, with their nodes and numbers.

use std::ops::Range;

use crate::mesh::{FaceRange, Group, Mesh};

/// Kind of an element, in the order in which they are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Line elements.
    Line,
    /// Triangles.
    Triangle,
    /// Quads.
    Quad,
}

impl Kind {
    /// How many a mesh has.
    pub fn count(self, mesh: &Mesh) -> usize {
        match self {
            Self::Line => mesh.lines.len(),
            Self::Triangle => mesh.triangles.len(),
            Self::Quad => mesh.quads.len(),
        }
    }

    /// Those of a group.
    pub fn of_group(self, group: &Group) -> &[u32] {
        match self {
            Self::Line => &group.lines,
            Self::Triangle => &group.triangles,
            Self::Quad => &group.quads,
        }
    }

    /// Those of a surface or curve.
    pub fn of_face(self, face: &FaceRange) -> &Range<u32> {
        match self {
            Self::Line => &face.lines,
            Self::Triangle => &face.triangles,
            Self::Quad => &face.quads,
        }
    }

    /// Number of the first one in a file, from 1.
    pub fn first_number(self, mesh: &Mesh) -> u64 {
        let before = match self {
            Self::Line => 0,
            Self::Triangle => mesh.lines.len(),
            Self::Quad => mesh.lines.len() + mesh.triangles.len(),
        };
        before as u64 + 1
    }

    /// Nodes of the element at `index`: corners, then mid nodes.
    pub fn nodes(self, mesh: &Mesh, index: usize, mut each: impl FnMut(u32)) {
        let second = mesh.order == 2;
        match self {
            Self::Line => {
                mesh.lines[index].iter().for_each(|n| each(*n));
                if second {
                    each(mesh.line_mids[index]);
                }
            }
            Self::Triangle => {
                mesh.triangles[index].iter().for_each(|n| each(*n));
                if second {
                    mesh.triangle_mids[index].iter().for_each(|n| each(*n));
                }
            }
            Self::Quad => {
                mesh.quads[index].iter().for_each(|n| each(*n));
                if second {
                    mesh.quad_mids[index].iter().for_each(|n| each(*n));
                }
            }
        }
    }

    /// Nodes of one such element.
    pub fn nodes_each(self, order: u8) -> usize {
        let corners = match self {
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Quad => 4,
        };
        match (order, self) {
            (2, Self::Line) => 3,
            (2, _) => 2 * corners,
            _ => corners,
        }
    }
}

/// All kinds, in the order of their numbers.
pub const KINDS: [Kind; 3] = [Kind::Line, Kind::Triangle, Kind::Quad];

/// Numbers of a group's elements in a file, from 1, ascending.
pub fn element_numbers(mesh: &Mesh, group: &Group) -> Vec<u64> {
    KINDS
        .iter()
        .flat_map(|kind| {
            let first = kind.first_number(mesh);
            kind.of_group(group).iter().map(move |n| first + u64::from(*n))
        })
        .collect()
}
