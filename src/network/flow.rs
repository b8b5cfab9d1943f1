//! Flow types of curve grids, found from node lists alone [Koh & Park 1990, §4.2; math.md section 7].

/// What a grid of curves spans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlowKind {
    /// Complete grid.
    Quadrilateral,
    /// One side is a pole.
    DegenerateTrilateral,
    /// Two opposite sides are poles.
    DegenerateBilateral,
    /// Three curves forming a triangle.
    UniformTrilateral,
}

/// One curve of a family.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Place in the list of curves given.
    pub curve: usize,
    /// Whether it runs against the family's direction.
    pub reversed: bool,
    /// Its raw arc-length fraction (own direction) at its crossing with each curve of the other family, in that family's order.
    pub crossings: Vec<f64>,
}

/// A flow: which curves run along u (each at constant v), which along v, and what closes or collapses.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// The kind.
    pub kind: FlowKind,
    /// Curves along u, ascending v; without poles.
    pub along_u: Vec<Member>,
    /// Curves along v, ascending u. In a flow closed in u the first one is not repeated at u = 1.
    pub along_v: Vec<Member>,
    /// u is periodic.
    pub closed_u: bool,
    /// v is periodic.
    pub closed_v: bool,
    /// Nodes of the poles at v = 0 and v = 1 (index into the node list given), where there are.
    pub poles: (Option<usize>, Option<usize>),
}

impl Flow {
    /// The phrase of math.md section 7, as the JSON report has it: "quadrilateral closed in u".
    pub fn phrase(&self) -> String {
        let mut text = match self.kind {
            FlowKind::Quadrilateral => "quadrilateral",
            FlowKind::DegenerateTrilateral => "degenerate trilateral",
            FlowKind::DegenerateBilateral => "degenerate bilateral",
            FlowKind::UniformTrilateral => "uniform trilateral",
        }
        .to_owned();
        match (self.closed_u, self.closed_v) {
            (true, true) => text.push_str(" closed in u and v"),
            (true, false) => text.push_str(" closed in u"),
            (false, true) => text.push_str(" closed in v"),
            _ => {}
        }
        text
    }
}
