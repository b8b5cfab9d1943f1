//! Family 6: surfaces through scattered points.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// What can go wrong with scattered points, or deserves a word. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum ScatterFault {
    /// W225: points given twice.
    Merged {
        /// The surface.
        surface: Origin,
        /// How many were left out.
        count: usize,
        /// The first of them.
        at: DVec3,
        /// Largest distance of two points that count as one.
        tolerance: f64,
    },
    /// E665: points that span no surface.
    OneLine {
        /// The surface.
        surface: Origin,
        /// How many points.
        count: usize,
        /// One end of the line.
        from: DVec3,
        /// The other one.
        to: DVec3,
    },
    /// E675: two points at one place of the plane.
    SamePlace {
        /// The surface.
        surface: Origin,
        /// One.
        a: DVec3,
        /// The other one.
        b: DVec3,
        /// Largest distance of two places that count as one.
        tolerance: f64,
    },
    /// W668: a side of a triangle that is very steep.
    Steep {
        /// The surface.
        surface: Origin,
        /// One end.
        a: DVec3,
        /// The other one.
        b: DVec3,
        /// Rise over run.
        steep: f64,
    },
    /// W226: a surface that stands out far over its points.
    StandsOut {
        /// The surface.
        surface: Origin,
        /// The place that is farthest beyond the heights of all points, of those looked at.
        at: DVec3,
        /// How far beyond.
        off: f64,
        /// Largest difference of the points' heights.
        range: f64,
    },
}

impl Describe for ScatterFault {
    codes! { Merged "W225", OneLine "E665", SamePlace "E675", Steep "W668", StandsOut "W226" }

    fn describe(&self, say: &dyn Say) -> Report {
        let label = |report: Report, text: &str| report.label(Subject::Argument("points"), text);
        match self {
            Self::Merged { surface, count, at, tolerance } => {
                let (points, are) = if *count == 1 { ("point", "is") } else { ("points", "are") };
                let message = format!(
                    "{count} {points} of {} {are} left out: within {} of another one, first at {}",
                    say.quoted(*surface, "this surface"),
                    say.length(*tolerance),
                    say.point(*at)
                );
                label(Report::new(message), "some are given twice")
            }
            Self::OneLine { surface, count, from, to } => {
                let ((a, b), which) = (say.pair(*from, *to), say.quoted(*surface, "this surface"));
                let message = format!(
                    "the {count} points of {which} span no surface: projected along its direction, all lie on the line from {a} to {b}"
                );
                label(Report::new(message), "all on one line").help("add points beside that line, or choose another `along:`")
            }
            Self::SamePlace { surface, a, b, tolerance } => {
                let ((a, b), which) = (say.pair(*a, *b), say.quoted(*surface, "this surface"));
                let message = format!(
                    "two points of {which} lie above one another: {a} and {b} have the same place in its plane, within {}",
                    say.length(*tolerance)
                );
                label(Report::new(message), "a place has one height")
                    .help("choose `along:` so that no place has two points, or divide points of a closed surface into parts for which that is possible")
            }
            Self::Steep { surface, a, b, steep } => {
                let ((a, b), which) = (say.pair(*a, *b), say.quoted(*surface, "this surface"));
                let message = format!("{which} has a slope of {steep:.0} from {a} to {b}");
                label(Report::new(message), "very steep")
                    .help("points of two sheets are not one surface over a plane: leave one sheet out, or choose another `along:`")
            }
            Self::StandsOut { surface, at, off, range } => {
                let which = say.quoted(*surface, "this surface");
                let (off, at, range) = (say.length(*off), say.point(*at), say.length(*range));
                let message = format!("{which} overshoots the heights of its points by {off} at {at}; the heights span {range}");
                label(Report::new(message), "neighbours with very different heights")
                    .help("leave out points that are close together at different heights, or add points where the surface overshoots")
            }
        }
    }
}
