//! E601: why curves span no surface.

use glam::DVec3;

use crate::base::fault::{Report, Say, Subject};
use crate::base::origin::Origin;

/// Why curves span no flow, nearest to success first.
#[derive(Clone, Debug, PartialEq)]
pub enum NoFlow {
    /// Fewer curves than any flow has.
    TooFewCurves {
        /// How many were given.
        given: usize,
    },
    /// They are the sides of one loop, more than four.
    Ring {
        /// How many.
        sides: usize,
    },
    /// These two meet, so they cannot run the same way, yet every division into two families puts them together.
    NoFamilies {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Where they meet.
        at: DVec3,
    },
    /// A curve that meets none of the others.
    Alone {
        /// The curve.
        curve: Origin,
        /// The curve that comes nearest to it.
        nearest: Origin,
        /// Smallest distance of the two, model units.
        gap: f64,
        /// Where that is, on the curve that meets no other.
        at: DVec3,
    },
    /// All crossings but some are there.
    Missing {
        /// Crossings found.
        found: usize,
        /// Crossings of the complete grid.
        wanted: usize,
        /// First curve of a missing crossing.
        a: Origin,
        /// Second curve of it.
        b: Origin,
        /// Smallest distance of the two, model units.
        gap: f64,
        /// Where that is, on `a`.
        at: DVec3,
    },
    /// Several flows fit and nothing in the call decides.
    Several {
        /// What would decide, as it is typed: "`pole:` or `u:`".
        decide: &'static str,
    },
    /// Of curves that run the same way one is closed, another one open.
    HalfClosed {
        /// The closed one.
        closed: Origin,
        /// The open one.
        open: Origin,
    },
    /// Closure was asked for, but a curve is open.
    NotClosed {
        /// The open curve.
        open: Origin,
    },
    /// The named pole is not an end that curves share.
    NoPole {
        /// The named point.
        pole: DVec3,
        /// The nearest end of a curve.
        nearest: DVec3,
    },
}

/// What the report says of curves that span no flow.
pub(crate) fn describe(curves: &[Origin], why: &NoFlow, say: &dyn Say) -> Report {
    match why {
        NoFlow::TooFewCurves { given } => Report::new(format!("{given} curve{} cannot span a surface", if *given == 1 { "" } else { "s" }))
            .label(Subject::Call, "needs four borders, or three, or two with common ends")
            .help("coons(south, east, north, west)"),
        NoFlow::Ring { sides } => {
            let mut report = Report::new(format!("a loop of {sides} sides: a surface of two families of curves has four, or three"));
            for curve in curves {
                report = report.at(*curve, "");
            }
            report.help("`fill([a, b, c, …])` closes a hole of any number of sides")
        }
        NoFlow::NoFamilies { a, b, at } => Report::new(format!(
            "these {} curves do not form two families: {} and {} meet at {} but would run the same way",
            curves.len(),
            say.quoted(*a, "one curve"),
            say.quoted(*b, "another one"),
            say.point(*at)
        ))
        .at(*a, "this curve")
        .at(*b, "meets this one")
        .help("say which run along u and which along v: `u: [a, b], v: [c, d]`"),
        NoFlow::Alone { curve, nearest, gap, at } => Report::new(format!(
            "{} meets none of the other curves; {} is nearest, {} away at {}",
            say.quoted(*curve, "a curve"),
            say.quoted(*nearest, "another one"),
            say.length(*gap),
            say.point(*at)
        ))
        .at(*curve, "meets nothing")
        .at(*nearest, "is nearest")
        .help("end the curves at the same declared points"),
        NoFlow::Missing { found, wanted, a, b, gap, at } => Report::new(format!(
            "{found} of {wanted} crossings found: {} and {} share no node; their nearest points are {} apart at {}",
            say.quoted(*a, "one curve"),
            say.quoted(*b, "another one"),
            say.length(*gap),
            say.point(*at)
        ))
        .at(*a, "this curve")
        .at(*b, "does not meet this one")
        .help("end both at the same declared point"),
        NoFlow::Several { decide } => {
            let mut report = Report::new(format!("these {} curves span more than one surface", curves.len()));
            for curve in curves {
                report = report.at(*curve, "");
            }
            report.help(format!("decide with {decide}"))
        }
        NoFlow::HalfClosed { closed, open } => Report::new(format!(
            "{} is closed and {} is open, but the two run the same way",
            say.quoted(*closed, "one curve"),
            say.quoted(*open, "another one")
        ))
        .at(*closed, "closed")
        .at(*open, "open")
        .help("close both, or cut the closed one: `c[A..B]`"),
        NoFlow::NotClosed { open } => Report::new(format!("the surface cannot close: {} is open", say.quoted(*open, "a curve along u")))
            .label(Subject::Argument("closed"), "asked for here")
            .at(*open, "open")
            .help("leave out `closed: true`, or take a closed curve"),
        NoFlow::NoPole { pole, nearest } => {
            let ((here, there), away) = (say.pair(*pole, *nearest), say.length(pole.distance(*nearest)));
            Report::new(format!("no curves end together at the pole {here}; the nearest end is {away} away at {there}"))
                .label(Subject::Argument("pole"), "not a common end")
                .help("the pole is the point in which all curves of one family end")
        }
    }
}
