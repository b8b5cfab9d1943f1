//! What decides sizes inside a face, and what is counted of its cells.

/// What decides sizes inside a free face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Why {
    /// The size of the mesh or of a rule on the face.
    Size,
    /// A `near` or `in` clause, by its place in the plan.
    Refined(usize),
    /// Chord error or angle.
    Bends,
    /// Short edges of the border, from which lengths grow.
    Border,
    /// A border that faces this one, or that its steps would cross.
    Gap,
    /// The floor of all sizes.
    Floor,
}

/// A decider with what it decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decider {
    /// Which.
    pub why: Why,
    /// Inner nodes whose distance it decided.
    pub nodes: usize,
    /// One of them.
    pub at: glam::DVec3,
}

/// The cells of a face between lines of constant u and v.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cells inside.
    pub whole: usize,
    /// Cells that a border crosses.
    pub crossed: usize,
    /// Corners of cells that a loop crosses, those on borders left out.
    pub corners: usize,
    /// Those at which the marks 0, 1 and 2 say what the winding does.
    pub agree: usize,
}
