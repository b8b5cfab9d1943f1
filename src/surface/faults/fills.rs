//! Family 6: surfaces that close holes.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// What can go wrong where a hole is filled. Lengths and points are in model units, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub enum FillFault {
    /// E680: a named face lies along no border.
    NotBeside {
        /// The fill.
        fill: Origin,
        /// The face.
        face: Origin,
        /// Its place in the list.
        place: usize,
    },
    /// W681: faces and borders do not agree at a corner.
    Corner {
        /// The fill.
        fill: Origin,
        /// The corner.
        at: DVec3,
        /// By how much.
        angle: f64,
    },
    /// W682: the surface is off tangent planes or curvatures.
    Misses {
        /// The fill.
        fill: Origin,
        /// Largest angle.
        angle: f64,
        /// Largest difference of curvatures, as a share.
        bend: f64,
    },
    /// E683: seen along the direction of heights the borders cross or turn back too sharply.
    Folds {
        /// The fill.
        fill: Origin,
        /// That direction.
        normal: DVec3,
        /// How many sides were found.
        sides: usize,
    },
}

impl Describe for FillFault {
    codes! { NotBeside "E680", Corner "W681", Misses "W682", Folds "E683" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::NotBeside { fill, face, place } => {
                let which = say.quoted(*face, "a face");
                Report::new(format!("{which} lies along none of the borders"))
                    .at(*fill, format!("place {place} of `to:`"))
                    .at(*face, "this face")
                    .help("name faces that have a border of the hole on their own border, within the tolerance")
            }
            Self::Corner { fill, at, angle } => Report::new(format!(
                "at the corner {} faces and borders differ by {}: no surface continues both",
                say.point(*at),
                say.angle(*angle)
            ))
            .at(*fill, "continues them only away from there")
            .help("let borders run within the faces that they lie beside, and faces have one tangent plane at a corner; or `order: 0`"),
            Self::Misses { fill, angle, bend } => {
                let share = format!("{:.1} %", bend * 100.0);
                Report::new(format!(
                    "the surface is up to {} off the tangent planes and {share} off the curvatures beside it",
                    say.angle(*angle)
                ))
                .at(*fill, "not as smooth as asked for")
                .help("a smaller `order:`, or a hole whose faces bend more evenly, is met better; `connection(a, b)` shows where")
            }
            Self::Folds { fill, normal, sides } => {
                let n = *normal;
                let seen = format!("({:.3}, {:.3}, {:.3})", n.x, n.y, n.z);
                Report::new(format!("seen along {seen} the {sides} sides cross or turn back so far that patches round a centre fold over"))
                    .at(*fill, "no surface over these borders")
                    .help("divide the hole by a curve and fill each part")
            }
        }
    }
}
