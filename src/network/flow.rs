//! Flow types of curve grids [Koh & Park 1990, §4.2]: what a set of curves spans, and which way.
//!
//! ```text
//!    v ↑  Φ0   Φ1   Φ2          Φ (along v, at u = uₘ) and Ψ (along u, at v = vₙ) meet in one node each.
//!   Ψ1 ├───┼────┼────┤          A pole takes the place of a Ψ: all Φ end in it. In a closed family the
//!   Ψ0 └───┴────┴────┘→ u       other curves are rings, and Φ0 stands for u = 0 and u = 1.
//! ```

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
    /// Its raw arc-length fraction (own direction) at its crossing with each curve of the other family, in that family's order; poles left out.
    pub crossings: Vec<f64>,
}

/// A piece of a curve beyond the border, which the flow leaves out (N609).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overhang {
    /// Place in the list of curves given.
    pub curve: usize,
    /// Raw arc-length fractions of the piece left out, ascending: it lies at an end of the curve.
    pub piece: (f64, f64),
}

/// A flow: which curves run along u (each at constant v), which along v, and what closes or collapses.
///
/// Curves through a pole run along v, and a single pole is v = 0. The first curve along u that was written sets +u; of
/// the two outer ones the first written is v = 0. In a closed family the first crossing of that curve after its
/// start is u = 0. A uniform trilateral has its first curve along u (v = 0, from vertex 0 to vertex 1), and two
/// along v: the side u = 0 (vertex 0 to vertex 2) and the slant (vertex 1 to vertex 2); crossings are then the
/// fractions at these two vertices.
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
    /// Pieces beyond the border.
    pub overhangs: Vec<Overhang>,
}

impl Flow {
    /// The flow in words, as the JSON report has it: "quadrilateral closed in u".
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

    /// Number of intervals in u and v, M and N of [Koh & Park 1990, §4.1]; poles count as curves along u, a uniform trilateral is (1, 1).
    pub fn orders(&self) -> (usize, usize) {
        if self.kind == FlowKind::UniformTrilateral {
            return (1, 1);
        }
        let poles = usize::from(self.poles.0.is_some()) + usize::from(self.poles.1.is_some());
        let (m, n) = (self.along_v.len(), self.along_u.len() + poles);
        (if self.closed_u { m } else { m - 1 }, if self.closed_v { n } else { n - 1 })
    }
}

/// The nodes of one curve from start to end, as indices into a list of nodes; a closed curve repeats its first node.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeList {
    /// The nodes.
    pub nodes: Vec<usize>,
    /// Their arc-length fractions on the curve, ascending from 0 to 1.
    pub at: Vec<f64>,
}

impl NodeList {
    /// Nodes at equal distances, where only their order is known.
    pub fn evenly(nodes: &[usize]) -> Self {
        let last = nodes.len().saturating_sub(1).max(1) as f64;
        Self { nodes: nodes.to_vec(), at: (0..nodes.len()).map(|k| k as f64 / last).collect() }
    }

    /// Whether it ends in the node where it starts.
    pub fn is_closed(&self) -> bool {
        self.nodes.len() > 1 && self.nodes.first() == self.nodes.last()
    }

    /// Fraction where it passes a node first.
    pub fn position(&self, node: usize) -> Option<f64> {
        self.nodes.iter().position(|&n| n == node).map(|k| self.at[k])
    }

    /// Whether it is open and ends in the node.
    pub fn ends_at(&self, node: usize) -> bool {
        !self.is_closed() && (self.nodes.first() == Some(&node) || self.nodes.last() == Some(&node))
    }
}

/// What the caller knows about a flow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlowOptions {
    /// Curves said to run along u.
    pub along_u: Vec<usize>,
    /// Curves said to run along v.
    pub along_v: Vec<usize>,
    /// A node said to be a pole.
    pub pole: Option<usize>,
    /// The flow must close in u even where node lists do not show it (two meridians).
    pub closed: bool,
}

/// Why curves span no flow; curves and nodes are indices into the lists given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlowFault {
    /// Fewer curves than any flow has.
    TooFew {
        /// How many were given.
        given: usize,
    },
    /// A curve that meets none of the others.
    Alone {
        /// The curve.
        curve: usize,
    },
    /// Two curves meet in every division into families, but no division is a grid.
    NoFamilies {
        /// One curve.
        a: usize,
        /// The other one.
        b: usize,
        /// Where they meet.
        node: usize,
    },
    /// Two curves of different families share no node.
    Incomplete {
        /// One curve.
        a: usize,
        /// The other one.
        b: usize,
        /// Crossings found.
        found: usize,
        /// Crossings of the complete grid.
        wanted: usize,
    },
    /// Two curves meet twice.
    Double {
        /// One curve.
        a: usize,
        /// The other one.
        b: usize,
        /// Two of the nodes.
        nodes: (usize, usize),
    },
    /// A curve meets two others in an order that the rest of its family does not have.
    NotMonotone {
        /// The curve.
        curve: usize,
        /// The one that should come first and the one that should follow.
        others: (usize, usize),
        /// Its nodes with them.
        nodes: (usize, usize),
    },
    /// Two curves of one family meet away from a pole.
    Crosses {
        /// One curve.
        a: usize,
        /// The other one.
        b: usize,
        /// Where they meet.
        node: usize,
    },
    /// One curve of a family is closed, another one open.
    HalfClosed {
        /// The closed one.
        closed: usize,
        /// The open one.
        open: usize,
    },
    /// Closure was asked for, but a curve along u is open.
    NotClosed {
        /// The open curve.
        open: usize,
    },
    /// The named pole is not an end that two curves share, or the curves through it were said to run along u.
    NoPole {
        /// The node.
        node: usize,
    },
}
