//! Profiles that are revolved or extruded.

use glam::DVec3;

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::base::text::decimals;

/// What can go wrong with a profile that is revolved or extruded. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum ProfileFault {
    /// E621: the axis is not a straight line.
    AxisNotStraight {
        /// The axis.
        axis: Origin,
        /// Its largest distance from the line through its ends.
        off: f64,
        /// Where that is.
        at: DVec3,
    },
    /// E622: the profile lies in the axis.
    GeneratrixOnAxis {
        /// The profile.
        profile: Origin,
        /// First point of the stretch in the axis.
        from: DVec3,
        /// Last point of it.
        to: DVec3,
    },
    /// E623: the profile meets the axis between its ends.
    GeneratrixCrossesAxis {
        /// The profile.
        profile: Origin,
        /// Where.
        at: DVec3,
        /// Fraction of the profile's arc length.
        fraction: f64,
    },
    /// E624: the profile runs along the direction in which it is carried.
    SweepDegenerate {
        /// The profile.
        profile: Origin,
        /// First point of the stretch.
        from: DVec3,
        /// Last point of it.
        to: DVec3,
    },
}

impl Describe for ProfileFault {
    codes! { AxisNotStraight "E621", GeneratrixOnAxis "E622", GeneratrixCrossesAxis "E623", SweepDegenerate "E624" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::AxisNotStraight { axis, off, at } => Report::new(format!(
                "the axis {} is not straight: {} off at {}",
                say.quoted(*axis, "of the rotation"),
                say.length(*off),
                say.point(*at)
            ))
            .at(*axis, "must be one straight line")
            .help("axis: line((0, 0, 0), (0, 0, 1))")
            .edit(Subject::Call, Edit::Set("axis", "line((0, 0, 0), (0, 0, 1))".to_owned())),
            Self::GeneratrixOnAxis { profile, from, to } => {
                let (from, to) = say.pair(*from, *to);
                Report::new(format!("{} lies on the axis from {from} to {to}", say.quoted(*profile, "the profile")))
                    .at(*profile, "sweeps no area there")
                    .help("leave that stretch out: `profile[A..B]`")
            }
            Self::GeneratrixCrossesAxis { profile, at, fraction } => Report::new(format!(
                "{} meets the axis between its ends, at {}, {} % along",
                say.quoted(*profile, "the profile"),
                say.point(*at),
                decimals(fraction * 100.0, 1)
            ))
            .at(*profile, "meets the axis")
            .help(format!("revolve one side only: `{}[0%..{}%]`", named_or(say.name(*profile), "profile"), decimals(fraction * 100.0, 6)))
            .edit(
                Subject::Argument("profile"),
                Edit::Instead { of: say.name(*profile), put: format!("{}[0%..{}%]", say.name(*profile), decimals(fraction * 100.0, 6)) },
            ),
            Self::SweepDegenerate { profile, from, to } => {
                let ((from, to), which) = (say.pair(*from, *to), say.quoted(*profile, "the profile"));
                Report::new(format!("{which} runs along the direction of the sweep from {from} to {to}: no area"))
                    .at(*profile, "parallel to the sweep")
                    .help("choose another `by:`, or leave that stretch out")
            }
        }
    }
}

/// A name, or a word that stands for one that is missing.
fn named_or(name: String, otherwise: &str) -> String {
    if name.is_empty() { otherwise.to_owned() } else { name }
}
