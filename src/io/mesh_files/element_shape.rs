//! Shapes of elements by their nodes.

/// Shapes of elements, as decks tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Two nodes.
    Line2,
    /// Two nodes and the middle.
    Line3,
    /// Three nodes.
    Triangle3,
    /// Three corners and three mid nodes.
    Triangle6,
    /// Four nodes.
    Quad4,
    /// Four corners and four mid nodes.
    Quad8,
}

impl Shape {
    /// The shapes that a mesh of this order has: line, triangle, quad.
    pub fn of_order(order: u8) -> [Self; 3] {
        if order == 2 { [Self::Line3, Self::Triangle6, Self::Quad8] } else { [Self::Line2, Self::Triangle3, Self::Quad4] }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Line2 => "2-node lines",
            Self::Line3 => "3-node lines",
            Self::Triangle3 => "3-node triangles",
            Self::Triangle6 => "6-node triangles",
            Self::Quad4 => "4-node quads",
            Self::Quad8 => "8-node quads",
        }
    }
}
