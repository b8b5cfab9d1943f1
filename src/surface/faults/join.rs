//! Family 7: surfaces that make no one surface.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// E722: why surfaces are not joined. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum JoinFault {
    /// They share no whole border.
    Apart {
        /// One surface.
        a: Origin,
        /// The nearest of the others.
        b: Origin,
        /// How far their nearest borders are apart at the most.
        gap: f64,
        /// Where that is, on the border of `a`.
        at: DVec3,
    },
    /// A surface meets others on sides that are not opposite, or several on one.
    NotInRow {
        /// The surface.
        a: Origin,
        /// One of the others.
        b: Origin,
        /// Another one.
        c: Origin,
    },
    /// A surface without four sides.
    NotFourSided {
        /// The surface.
        a: Origin,
    },
}

impl Describe for JoinFault {
    codes! { Apart "E722", NotInRow "E722", NotFourSided "E722" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Apart { a, b, gap, at } => {
                let (x, y) = (say.quoted(*a, "one surface"), say.quoted(*b, "the other"));
                let (gap, at) = (say.length(*gap), say.point(*at));
                Report::new(format!("{x} and {y} share no whole border; their nearest borders are {gap} apart, at {at}"))
                    .both(*a, *b, "this surface")
                    .help("divide the longer border first, `split(s, by: …)`, or draw both on one curve")
            }
            Self::NotInRow { a, b, c } => {
                let (x, y, z) = (say.quoted(*a, "one surface"), say.quoted(*b, "another"), say.quoted(*c, "a third"));
                Report::new(format!("{x} meets {y} and {z} on sides that are not opposite: they do not follow one another"))
                    .at(*a, "in the middle")
                    .at(*b, "on one side")
                    .at(*c, "on another")
                    .help("a `shell` holds surfaces that meet in any way; `join` those of one row")
            }
            Self::NotFourSided { a } => Report::new(format!("{} has no four sides that u and v run along", say.quoted(*a, "one surface")))
                .at(*a, "trimmed, or of other than four sides")
                .help("join whole surfaces first and trim the whole; a `shell` holds any surfaces"),
        }
    }
}
