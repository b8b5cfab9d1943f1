//! How far a surface or a spline is from what it is made on.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// N677: a surface deviates within what is allowed; E654: a border does by more. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum DeviationFault {
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
    /// E654: a spline through as many points as may be leaves its curve.
    BorderNotResolved {
        /// The curve.
        border: Origin,
        /// How far the spline is off.
        off: f64,
        /// Where, on the curve.
        at: DVec3,
        /// How far it may be.
        within: f64,
        /// The points.
        points: usize,
    },
}

impl Describe for DeviationFault {
    codes! { Gap "N677", Smoothed "N677", AsNet "N677", BorderNotResolved "E654" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
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
                let sampled = if *proved { "" } else { " at all sampled points" };
                format!("{net} approximates {surface} within {off}{sampled}")
            })
            .at(*net, "a B-spline approximation"),
            Self::BorderNotResolved { border, off, at, within, points } => Report::new(format!(
                "a spline through {points} points leaves {} by {} at {}",
                say.quoted(*border, "the border"),
                say.length(*off),
                say.point(*at)
            ))
            .at(*border, "this curve")
            .note(format!("allowed are {}", say.length(*within)))
            .help("allow more with `within:`, or split the curve where it bends sharply"),
        }
    }
}
