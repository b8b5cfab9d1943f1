//! Family 6: offsets of surfaces that are not smooth, and walls.

use glam::DVec3;

use super::{Describe, Report, Say};
use crate::base::origin::Origin;

/// What can go wrong with an offset or a wall. Lengths and points are in model units, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub enum WallFault {
    /// E670: the surface has a crease.
    Creased {
        /// The offset.
        offset: Origin,
        /// The surface.
        surface: Origin,
        /// Where the normals jump most.
        at: DVec3,
        /// By how much.
        angle: f64,
    },
    /// E670: the surface has a tip.
    Tip {
        /// The offset.
        offset: Origin,
        /// The surface.
        surface: Origin,
        /// The tip.
        at: DVec3,
    },
}

impl Describe for WallFault {
    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Creased { offset, surface, at, angle } => Report::new(
                "E670",
                format!("{} has a crease of {} at {}", say.quoted(*surface, "the surface"), say.angle(*angle), say.point(*at)),
            )
            .at(*surface, "its normals jump there")
            .at(*offset, "has no one place beside the crease")
            .help("divide it along the crease, `split(s, by: …)`, and move the parts one by one"),
            Self::Tip { offset, surface, at } => {
                Report::new("E670", format!("{} has a tip at {}", say.quoted(*surface, "the surface"), say.point(*at)))
                    .at(*surface, "its normals do not come together there")
                    .at(*offset, "has no one place beside the tip")
                    .help("cut the tip off first, `trim(s, by: …, keep: …)`")
            }
        }
    }
}
