//! Nets of profiles and guides, and sections that coincide.

use glam::DVec3;

use crate::base::fault::quantities::{round_above, typed};
use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// What can go wrong with a net of two families. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum NetFault {
    /// E641: a profile and a guide do not meet.
    Incomplete {
        /// The profile.
        profile: Origin,
        /// The guide.
        guide: Origin,
        /// Smallest distance.
        gap: f64,
        /// Where that is, on the profile.
        at: DVec3,
        /// Crossings found.
        found: usize,
        /// Crossings of the complete net.
        wanted: usize,
        /// The gap is small against both curves: they were meant to meet.
        near: bool,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E642: two curves of one family meet.
    Cross {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// They are guides, not profiles.
        guides: bool,
        /// Where they meet.
        at: DVec3,
    },
    /// E642: neighbouring sections of a skin lie within the tolerance of each other.
    OneSection {
        /// One section, or the first.
        a: Origin,
        /// The next one, or the last.
        b: Origin,
        /// On the one.
        at: DVec3,
        /// They are the first and the last one of a closed skin.
        closing: bool,
    },
    /// E643: a curve meets the other family in an order of its own.
    Order {
        /// The curve.
        curve: Origin,
        /// It is a guide, not a profile.
        guide: bool,
        /// The curve that should come first.
        a: Origin,
        /// The curve that should come after it.
        b: Origin,
        /// Meeting with `a`.
        first: DVec3,
        /// Meeting with `b`.
        second: DVec3,
    },
}

impl Describe for NetFault {
    codes! { Incomplete "E641", Cross "E642", OneSection "E642", Order "E643" }

    fn describe(&self, say: &dyn Say) -> Report {
        let family = |guide: bool| if guide { "a guide" } else { "a profile" };
        match self {
            Self::Incomplete { profile, guide, gap, at, found, wanted, near, tolerance } => {
                let report = Report::new(format!(
                    "{} and {} do not meet: they are {} apart at {}, and the tolerance is {}",
                    say.quoted(*profile, "a profile"),
                    say.quoted(*guide, "a guide"),
                    say.length(*gap),
                    say.point(*at),
                    say.length(*tolerance)
                ))
                .at(*profile, "this profile")
                .at(*guide, "misses this guide")
                .note(format!("{found} of {wanted} crossings of the net were found"));
                if *near {
                    report.help(format!("draw both through one point, or allow the gap: `tolerance: {}`", typed(say, round_above(*gap))))
                } else {
                    report.help("let every profile cross every guide, or leave one of these two out")
                }
            }
            Self::Cross { a, b, guides, at } => {
                Report::new(format!("{} and {} meet at {}", say.quoted(*a, family(*guides)), say.quoted(*b, "another one"), say.point(*at)))
                    .at(*a, if *guides { "this guide" } else { "this profile" })
                    .at(*b, "meets this one")
                    .help(if *guides {
                        "guides may end in one pole and share nothing else"
                    } else {
                        "profiles share no point; curves that end in one pole are guides"
                    })
            }
            Self::OneSection { a, b, at, closing } => Report::new(format!(
                "{} and {} coincide within the tolerance, at {}",
                say.quoted(*a, "a section"),
                say.quoted(*b, "the next one"),
                say.point(*at)
            ))
            .at(*a, if *closing { "the first section" } else { "this section" })
            .at(*b, if *closing { "the last one is the same" } else { "is the same as this one" })
            .help(if *closing {
                "leave the last one out: `closed: true` joins what is then the last section to the first"
            } else {
                "leave one of them out"
            }),
            Self::Order { curve, guide, a, b, first, second } => Report::new(format!(
                "{} meets the {} in another order than the others: {} at {}, {} at {}",
                say.quoted(*curve, family(*guide)),
                if *guide { "profiles" } else { "guides" },
                say.quoted(*a, "the first"),
                say.point(*first),
                say.quoted(*b, "the next"),
                say.point(*second)
            ))
            .at(*curve, "meets them in another order")
            .at(*a, "should come before")
            .at(*b, "this one")
            .help("let every curve meet the other family in one order, or leave this one out"),
        }
    }
}
