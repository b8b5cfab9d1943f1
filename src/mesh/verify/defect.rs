//! What may be wrong with the elements of a face.

use crate::base::text::real;

/// A defect of the elements of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// No element at all.
    Empty,
    /// An element of another kind than requested.
    Kind,
    /// A node that is not of this face, or twice in one element.
    Node(u32),
    /// Nodes of its own that no element uses, the first of them.
    Loose(u32),
    /// An edge, how often elements run along it each way, and how often they should.
    Edge([u32; 2], [u32; 2], [u32; 2]),
    /// Edges between nodes inside that are not used once each way.
    Torn,
    /// The Euler number and the one that it should be.
    Euler(i64, i64),
    /// Elements that overlap in the parameter plane.
    Folded,
    /// The area that the elements cover in the parameter plane, and the one inside the loops of the surface.
    CoveredArea(f64, f64),
    /// A node, and how far it is from its place on the surface, model units.
    Misplaced(u32, f64),
}

impl Defect {
    /// In words that follow "a face where".
    pub(crate) fn words(self) -> String {
        match self {
            Self::Empty => "there is no element".to_owned(),
            Self::Kind => "elements are of another kind than asked for".to_owned(),
            Self::Node(_) => "an element has a node of another face or the same node twice".to_owned(),
            Self::Loose(_) => "nodes are in no element".to_owned(),
            Self::Edge(_, found, wanted) => {
                format!("elements run {} and {} times along an edge, and should {} and {}", found[0], found[1], wanted[0], wanted[1])
            }
            Self::Torn => "edges inside are not shared by two elements".to_owned(),
            Self::Euler(found, wanted) => format!("the Euler number inside is {found} and should be {wanted}"),
            Self::Folded => "elements overlap".to_owned(),
            Self::CoveredArea(found, wanted) => {
                format!(
                    "elements cover {} of the parameter plane, where the loops of the surface bound {}, or cover other parts of it",
                    real(found),
                    real(wanted)
                )
            }
            Self::Misplaced(_, off) => format!("a node is {} from its place on the surface", real(off)),
        }
    }

    /// A node that shows the place.
    pub(crate) fn node(self) -> Option<u32> {
        match self {
            Self::Node(n) | Self::Loose(n) | Self::Edge([n, _], ..) | Self::Misplaced(n, _) => Some(n),
            _ => None,
        }
    }
}
