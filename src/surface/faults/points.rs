//! Family 6: measured points.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// What deserves a word about measured points. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum PointsFault {
    /// W678: points that scatter more than was stated, so that a surface follows their noise.
    Scatter {
        /// The surface.
        surface: Origin,
        /// Standard deviation as estimated.
        found: f64,
        /// As stated.
        stated: f64,
        /// The point farthest off the run of its neighbours.
        at: DVec3,
        /// Control points along u and along v.
        net: (usize, usize),
    },
    /// W679: a point much farther off its neighbours than others, and than it may move.
    Outlier {
        /// Its row, from 0; none of a single row.
        row: Option<usize>,
        /// Its place in the row, from 0.
        place: usize,
        /// Where it was measured.
        at: DVec3,
        /// About how far it is off the run of its neighbours.
        off: f64,
        /// How far it may move.
        within: f64,
    },
}

impl Describe for PointsFault {
    codes! { Scatter "W678", Outlier "W679" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Scatter { surface, found, stated, at, net } => Report::new(format!(
                "the points of {} scatter by about {}, more than the stated {}, most at {}: the surface follows them with {} × {} control points",
                say.quoted(*surface, "this surface"),
                say.length(*found),
                say.length(*stated),
                say.point(*at),
                net.0,
                net.1
            ))
            .label(Subject::Argument("noise"), "less than their third differences say")
            .help(format!("noise: {}", say.length(*found).replace(' ', ""))),
            Self::Outlier { row, place, at, off, within } => {
                let which = row.map_or_else(|| format!("point {place}"), |row| format!("point {place} of row {row}"));
                Report::new(format!(
                    "{which}, measured at {}, is about {} off the run of its neighbours, farther than the others, and may move {}",
                    say.point(*at),
                    say.length(*off),
                    say.length(*within)
                ))
                .label(Subject::Argument("points"), "a wrong value, or a corner")
                .help("correct the value; of a corner say so: `corners:` with its place in the row, or `kinks:` with an angle")
            }
        }
    }
}
