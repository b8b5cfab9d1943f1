//! Faults of the grid of curves that a surface is made on.

use glam::DVec3;

use super::no_flow::{self, NoFlow};
use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// Why curves make no grid. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum GridFault {
    /// E601: the curves span no flow.
    FlowUnknown {
        /// The curves given.
        curves: Vec<Origin>,
        /// What is nearest to success.
        why: NoFlow,
    },
    /// E602: two curves of a grid share no node.
    GridIncomplete {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Smallest distance.
        gap: f64,
        /// Where that is, on `a`.
        at: DVec3,
        /// Crossings found.
        found: usize,
        /// Crossings of the complete grid.
        wanted: usize,
    },
    /// E603: two curves of a grid meet twice.
    GridDouble {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// First meeting.
        first: DVec3,
        /// Second meeting.
        second: DVec3,
    },
    /// E604: the curves of one family are met in different orders, or two meetings coincide in the mean.
    GridNotMonotone {
        /// The curve along which they come in the wrong order.
        curve: Origin,
        /// The curve that should come first.
        a: Origin,
        /// The curve that should come after it.
        b: Origin,
        /// Meeting with `a`.
        first: DVec3,
        /// Meeting with `b`.
        second: DVec3,
    },
    /// E605: two curves of one family meet away from a pole.
    FamilyCrosses {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Where they meet.
        at: DVec3,
    },
}

impl Describe for GridFault {
    codes! { FlowUnknown "E601", GridIncomplete "E602", GridDouble "E603", GridNotMonotone "E604", FamilyCrosses "E605" }

    fn describe(&self, say: &dyn Say) -> Report {
        use GridFault as F;
        match self {
            F::FlowUnknown { curves, why } => no_flow::describe(curves, why, say),
            F::GridIncomplete { a, b, gap, at, found, wanted } => Report::new(format!(
                "{} and {} share no node; their nearest points are {} apart at {}",
                say.quoted(*a, "a curve along u"),
                say.quoted(*b, "a curve along v"),
                say.length(*gap),
                say.point(*at)
            ))
            .at(*a, "this curve")
            .at(*b, "does not meet this one")
            .note(format!("{found} of {wanted} crossings of the grid were found"))
            .help("let every curve along u cross every curve along v, or leave one of these two out"),
            F::GridDouble { a, b, first, second } => {
                let (here, there) = say.pair(*first, *second);
                let (one, other) = (say.quoted(*a, "one curve"), say.quoted(*b, "another one"));
                Report::new(format!("{one} and {other} meet twice, at {here} and at {there}"))
                    .both(*a, *b, "this curve")
                    .help("take the run with one of the two meetings: `c[A..B]`")
            }
            F::GridNotMonotone { curve, a, b, first, second } => {
                let (here, there) = say.pair(*first, *second);
                let (one, next) = (say.quoted(*a, "the first"), say.quoted(*b, "the next"));
                let along = say.quoted(*curve, "one curve");
                Report::new(format!("along {along} the curves come in the wrong order: {one} at {here}, {next} at {there}"))
                    .at(*curve, "met in another order than its neighbours")
                    .at(*a, "should come before")
                    .at(*b, "this one")
                    .help("every curve along u must meet the curves along v in the same order")
            }
            F::FamilyCrosses { a, b, at } => Report::new(format!(
                "{} and {} run the same way but meet at {}",
                say.quoted(*a, "one curve"),
                say.quoted(*b, "another one"),
                say.point(*at)
            ))
            .at(*a, "this curve")
            .at(*b, "meets this one")
            .help("curves of one family may share a pole and nothing else; if this is one, say `pole: P`"),
        }
    }
}
