//! Borders of a surface: boundaries, loops and ends of curves that do not fit it.

use glam::DVec3;

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::base::text::real;

/// What can go wrong with the border of a surface, or deserves a word. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum BorderFault {
    /// N609: an end stands out over the border and is left out.
    EndTrimmed {
        /// The curve.
        curve: Origin,
        /// The border it stands out over.
        border: Origin,
        /// The end that is left out.
        end: DVec3,
        /// Length left out.
        length: f64,
    },
    /// E611: the boundary crosses itself.
    LoopSelfIntersects {
        /// One curve.
        a: Origin,
        /// The other one (or the same).
        b: Origin,
        /// Where.
        at: DVec3,
        /// Fractions of arc length along both.
        along: (f64, f64),
    },
    /// E612: a loop of a closed surface with border on both sides of it.
    LoopGoesRound {
        /// The loop.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// The trimming.
        trimming: Origin,
        /// A point of the loop.
        at: DVec3,
    },
    /// E613: a loop that is not on its surface.
    LoopOutsideSurface {
        /// The curve.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// How far the curve is from the surface, model units.
        off: f64,
        /// Where.
        at: DVec3,
        /// The model's tolerance.
        tolerance: f64,
    },
    /// E613: a loop in (u, v) that leaves 0…1.
    LoopOutsideParameters {
        /// The curve.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// Where.
        uv: (f64, f64),
    },
    /// E655 `plane-not-flat`: boundary curves that lie in no one plane.
    PlaneNotFlat {
        /// The curve with the point farthest off.
        curve: Origin,
        /// Largest distance from the mean plane.
        off: f64,
        /// Where that is.
        at: DVec3,
        /// What would pass.
        tolerance: f64,
    },
}

impl Describe for BorderFault {
    codes! {
        EndTrimmed "N609", LoopSelfIntersects "E611", LoopGoesRound "E612", LoopOutsideSurface "E613",
        LoopOutsideParameters "E613", PlaneNotFlat "E655"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::EndTrimmed { curve, border, end, length } => Report::new(format!(
                "{} extends {} past {} to {}; the overhang is ignored",
                say.quoted(*curve, "a curve"),
                say.length(*length),
                say.quoted(*border, "the border"),
                say.point(*end)
            ))
            .at(*curve, "trimmed to the border"),
            Self::LoopSelfIntersects { a, b, at, along } => Report::new(format!(
                "the boundary crosses itself: {} meets {} at {}, {} % along one and {} % along the other",
                say.quoted(*a, "one curve"),
                say.quoted(*b, "another one"),
                say.point(*at),
                (along.0 * 100.0).round(),
                (along.1 * 100.0).round()
            ))
            .at(*a, "this curve")
            .at(*b, "crosses this one")
            .help("list the corners in order around the face"),
            Self::LoopGoesRound { of, surface, trimming, at } => {
                let (which, whose) = (say.quoted(*of, "the loop"), say.quoted(*surface, "the surface"));
                Report::new(format!(
                    "{which} runs around {whose} through {}, with a border on each side: it bounds no part alone",
                    say.point(*at)
                ))
                .at(*trimming, "trimmed here")
                .at(*of, "this loop")
                .help("`by:` this loop with `keep:` a point of the part that stays")
            }
            Self::LoopOutsideSurface { of, surface, off, at, tolerance } => Report::new(format!(
                "{} leaves {}: it is {} away at {}, and the tolerance is {}",
                say.quoted(*of, "the curve"),
                say.quoted(*surface, "the surface"),
                say.length(*off),
                say.point(*at),
                say.length(*tolerance)
            ))
            .at(*of, "this loop")
            .at(*surface, "this surface")
            .help("build the curve on the surface, or `project` it"),
            Self::LoopOutsideParameters { of, surface, uv } => {
                let (curve, of_surface) = (say.quoted(*of, "the curve"), say.quoted(*surface, "the surface"));
                Report::new(format!("{curve} leaves {of_surface} at u = {}, v = {}: both run from 0 to 1", real(uv.0), real(uv.1)))
                    .at(*of, "x and y of this loop are u and v")
                    .at(*surface, "this surface")
            }
            Self::PlaneNotFlat { curve, off, at, tolerance } => Report::new(format!(
                "the boundary is not flat: {} is {} off the plane at {}; the tolerance is {}",
                say.quoted(*curve, "one curve"),
                say.length(*off),
                say.point(*at),
                say.length(*tolerance)
            ))
            .at(*curve, "leaves the plane of the others")
            .help("`coons` takes borders that are not flat")
            .edit(Subject::Call, Edit::Instead { of: "plane".to_owned(), put: "coons".to_owned() }),
        }
    }
}
