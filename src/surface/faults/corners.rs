//! Family 6: corners of a surface at which two of its curves run along each other.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// Two curves with parallel tangents in a node, where they should span the surface's tangent plane. Points are model units, angles radians.
#[derive(Clone, Debug, PartialEq)]
pub enum CornerFault {
    /// E653: a curve along u and one along v.
    TangentsParallel {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Where.
        at: DVec3,
        /// Angle between the tangent lines.
        angle: f64,
        /// What is taken for parallel.
        least: f64,
    },
    /// E652: two neighbouring curves that end in a pole.
    PoleParallel {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// The pole.
        at: DVec3,
        /// Angle between the tangent lines.
        angle: f64,
        /// What is taken for parallel.
        least: f64,
    },
}

impl Describe for CornerFault {
    codes! { TangentsParallel "E653", PoleParallel "E652" }

    fn describe(&self, say: &dyn Say) -> Report {
        let (Self::TangentsParallel { a, b, at, angle, least } | Self::PoleParallel { a, b, at, angle, least }) = self;
        let pole = matches!(self, Self::PoleParallel { .. });
        let (x, y) = (say.quoted(*a, "one curve"), say.quoted(*b, "another"));
        let place = if pole { "the pole" } else { "the corner" };
        let (at, angle, least) = (say.point(*at), say.angle(*angle), say.angle(*least));
        Report::new(format!("{x} and {y} have parallel tangents at {place} {at}: {angle} apart, and more than {least} is needed"))
            .both(*a, *b, "this curve")
            .help(if pole {
                "let them leave the pole in different and not in opposite directions, or take another corner as `pole:`"
            } else {
                "turn one of them there: a surface has no normal where its curves run along each other"
            })
    }
}
