//! Products at their places, as a file of an assembly has them.

use crate::geometry::Motion;

/// A product at one place.
#[derive(Clone, Debug)]
pub struct Node {
    /// What the file calls it there; may be empty.
    pub name: String,
    /// Name of the product; may be empty.
    pub product: String,
    /// The first node of the same product.
    pub of: usize,
    /// Which of several files it is from.
    pub file: usize,
    /// The node that it is a part of, which stands before it.
    pub parent: Option<usize>,
    /// From the frame of the product to that of the model.
    pub motion: Motion,
}
