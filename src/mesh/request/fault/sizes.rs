//! Sizes and limits that cannot be kept.

use glam::DVec3;

use crate::base::fault::quantities::{round_up, typed};
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// A limit of a mesh, by its setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshLimit {
    /// Length of edges.
    Size,
    /// Distance of elements from their surface.
    ChordError,
    /// Turn of the normal over an element.
    AngleError,
}

/// What can go wrong with sizes and limits. Lengths are model units, angles radians.
#[derive(Clone, Debug, PartialEq)]
pub enum SizeFault {
    /// E707: a size below the floor of all sizes.
    BelowFloor {
        /// The size and its expression.
        size: (f64, Origin),
        /// The floor and its expression.
        floor: (f64, Origin),
    },
    /// E707: a limit that the floor of the size keeps from being met.
    FloorKeeps {
        /// The setting.
        limit: MeshLimit,
        /// Its expression.
        written_at: Origin,
        /// The floor and its expression.
        floor: (f64, Origin),
        /// The size that the limit needs.
        needed: f64,
        /// Where.
        at: DVec3,
    },
    /// E703 without a count: a limit that is still broken after the last refinement.
    NotReached {
        /// The setting.
        limit: MeshLimit,
        /// Its expression.
        written_at: Origin,
        /// The surface.
        surface: Origin,
        /// What was reached.
        reached: f64,
        /// Where it is broken.
        at: DVec3,
    },
    /// E703 without a count: an edge glued so far beside a face that no step keeps the chord error.
    GapTooWide {
        /// How far the edge is from the surface, model units.
        gap: f64,
        /// The chord error with its expression.
        limit: (f64, Origin),
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
    },
}

impl MeshLimit {
    /// The word of the setting.
    pub fn word(self) -> &'static str {
        match self {
            Self::Size => "size",
            Self::ChordError => "chord_error",
            Self::AngleError => "angle_error",
        }
    }
}

impl std::fmt::Display for MeshLimit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.word())
    }
}

/// How far above what was reached an advised limit is.
const ABOVE: f64 = 1.1;
/// An advised chord error over the gap beside a face: a third of it and more is left to the bend.
const BESIDE: f64 = 1.5;

impl Describe for SizeFault {
    codes! { BelowFloor "E707", FloorKeeps "E707", NotReached "E703", GapTooWide "E703" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::BelowFloor { size, floor } => {
                Report::new(format!("the size {} is below `min_size`, {}", say.length(size.0), say.length(floor.0)))
                    .at(size.1, "below the minimum")
                    .at(floor.1, "the smallest size allowed")
                    .help(format!("lower `min_size` to {} or less", say.length(size.0)))
            }
            Self::FloorKeeps { limit, written_at, floor, needed, at } => {
                let (place, size) = (say.point(*at), say.length(*needed));
                Report::new(format!("`min_size` prevents `{limit}` at {place}, which needs edges of {size}"))
                    .at(*written_at, format!("needs {size}"))
                    .at(floor.1, format!("edges are at least {}", say.length(floor.0)))
                    .help(format!("`min_size` below {size}, or a larger `{limit}`"))
            }
            Self::NotReached { limit, written_at, surface, reached, at } => {
                let found = match *limit {
                    _ if !reached.is_finite() => "no finite bound was found".to_owned(),
                    MeshLimit::AngleError => say.angle(*reached),
                    _ => say.length(*reached),
                };
                let help = match *limit {
                    _ if !reached.is_finite() => format!("raise `{limit}`"),
                    MeshLimit::AngleError => format!("`{limit}: {}deg`, or more", (reached.to_degrees() * ABOVE).ceil()),
                    _ => format!("`{limit}: {}`, or more", typed(say, round_up(*reached * ABOVE))),
                };
                Report::new(format!("`{limit}` cannot be kept on {}: {found} at {}", say.quoted(*surface, "a face"), say.point(*at)))
                    .at(*written_at, "not kept")
                    .at(*surface, "this face")
                    .help(help)
            }
            Self::GapTooWide { gap, limit, surface, at } => {
                let (off, above) = (say.length(*gap), typed(say, round_up(*gap * BESIDE)));
                let whose = say.quoted(*surface, "a face");
                Report::new(format!("`chord_error` cannot be kept on {whose}: an edge glued to it is {off} away at {}", say.point(*at)))
                    .at(limit.1, format!("{} is not above the gap", say.length(limit.0)))
                    .at(*surface, "this face")
                    .help(format!("`chord_error: {above}`; or make the faces meet: a gap is no part of the bend"))
                    .edit(Subject::Entity(limit.1), Edit::Put(above))
            }
        }
    }
}
