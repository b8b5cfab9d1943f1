//! Family 6: nets of profiles and guides.

use glam::DVec3;

use crate::base::fault::quantities::{round_above, typed};
use crate::base::fault::{Code, Describe, Report, Say};
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
    /// N677: the curves of a net miss each other within what is allowed.
    Gap {
        /// The surface.
        surface: Origin,
        /// The curve along u of the pair that is farthest apart.
        profile: Origin,
        /// The curve along v.
        guide: Origin,
        /// How far apart they are.
        gap: f64,
        /// Between the two.
        at: DVec3,
        /// How many pairs miss each other by more than the model's tolerance.
        pairs: usize,
    },
    /// N677: a skin keeps to its sections within what is allowed.
    Smoothed {
        /// The surface.
        surface: Origin,
        /// The section that it leaves most.
        section: Origin,
        /// By how much.
        off: f64,
        /// Where, on the section.
        at: DVec3,
        /// Spans across.
        spans: usize,
        /// Spans of the skin through all sections.
        given: usize,
    },
    /// N677: a B-spline stands for a surface that is none.
    AsNet {
        /// The B-spline.
        net: Origin,
        /// The surface.
        surface: Origin,
        /// How far it is off at most.
        off: f64,
        /// Whether that is proved; else it is the most at sampled places.
        proved: bool,
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
    fn code(&self) -> Code {
        Code(match self {
            Self::Incomplete { .. } => "E641",
            Self::Cross { .. } | Self::OneSection { .. } => "E642",
            Self::Gap { .. } | Self::Smoothed { .. } | Self::AsNet { .. } => "N677",
            Self::Order { .. } => "E643",
        })
    }

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
            Self::Gap { surface, profile, guide, gap, at, pairs } => Report::new(format!(
                "{} and {} miss each other by {} at {}; {} lies between them",
                say.quoted(*profile, "a profile"),
                say.quoted(*guide, "a guide"),
                say.length(*gap),
                say.point(*at),
                say.quoted(*surface, "the surface")
            ))
            .at(*profile, "this profile")
            .at(*guide, "misses this guide")
            .note(match pairs {
                1 => "all others meet".to_owned(),
                n => format!("{n} pairs of the net miss each other, this one most"),
            }),
            Self::Smoothed { surface, section, off, at, spans, given } => Report::new(format!(
                "{} deviates from {} by {} at {}, the most of all sections",
                say.quoted(*surface, "the surface"),
                say.quoted(*section, "a section"),
                say.length(*off),
                say.point(*at)
            ))
            .at(*section, "largest deviation")
            .note(match spans {
                1 => format!("one span across; through all sections there would be {given}"),
                n => format!("{n} spans across; through all sections there would be {given}"),
            }),
            Self::AsNet { net, surface, off, proved } => Report::new({
                let (net, surface, off) = (say.quoted(*net, "the net"), say.quoted(*surface, "its surface"), say.length(*off));
                let bound = if *proved { "nowhere" } else { "at no sampled place" };
                format!("{net} is {bound} farther than {off} from {surface}")
            })
            .at(*net, "a B-spline approximation"),
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
