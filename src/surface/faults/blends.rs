//! Family 6: roundings between two surfaces.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// Why two surfaces have no edge that a ball can roll along. Points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum NoBlend {
    /// They meet in no curve.
    Apart {
        /// Where they touch, if they do.
        touch: Option<DVec3>,
    },
    /// They meet in several curves.
    Several {
        /// The middle of each.
        middles: Vec<DVec3>,
    },
    /// The curve has a corner.
    Corner {
        /// Where.
        at: DVec3,
    },
    /// They are tangent to each other.
    Tangent {
        /// Where.
        at: DVec3,
    },
    /// The curve, or the rounding, ends inside a surface.
    EndsInside {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
    },
    /// The rounding runs over a border.
    Leaves {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
    },
    /// A surface runs on beyond the edge, and the point to keep is on the other one, which parts its sides.
    KeepOn {
        /// The surface.
        surface: Origin,
        /// The other one.
        on: Origin,
        /// The point.
        at: DVec3,
    },
    /// No radius fits.
    NoRadius {
        /// Where it fails.
        at: DVec3,
    },
}

/// What can go wrong with a rounding. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum BlendFault {
    /// E673: the ball is too large.
    TooLarge {
        /// The rounding.
        blend: Origin,
        /// One surface.
        a: Origin,
        /// The other one.
        b: Origin,
        /// The radius asked for.
        radius: f64,
        /// The largest one that fits.
        largest: f64,
        /// Beside which place of the edge it fails.
        at: DVec3,
    },
    /// E674: no edge to roll along.
    NoEdge {
        /// One surface.
        a: Origin,
        /// The other one.
        b: Origin,
        /// What is missing.
        why: NoBlend,
    },
}

impl Describe for BlendFault {
    codes! { TooLarge "E673", NoEdge "E674" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::TooLarge { blend, a, b, radius, largest, at } => {
                let (x, y) = (say.quoted(*a, "one surface"), say.quoted(*b, "the other"));
                let message = format!(
                    "a ball with a radius of {} does not fit between {x} and {y} near {}; the largest radius is {}",
                    say.length(*radius),
                    say.point(*at),
                    say.length(floored(*largest))
                );
                Report::new(message)
                    .at(*blend, "too large here")
                    .help("take a smaller `radius:`, or surfaces that extend farther from the edge")
            }
            Self::NoEdge { a, b, why } => no_edge((*a, *b), why, say).both(*a, *b, "this surface"),
        }
    }
}

/// Three digits of a length, rounded down, so that the stated radius fits.
fn floored(length: f64) -> f64 {
    const DIGITS: f64 = 1e2;
    let unit = crate::base::math::pow(10.0, crate::base::math::log10(length).floor()) / DIGITS;
    (length / unit).floor() * unit
}

fn no_edge((a, b): (Origin, Origin), why: &NoBlend, say: &dyn Say) -> Report {
    let (x, y) = (say.quoted(a, "one surface"), say.quoted(b, "the other"));
    match why {
        NoBlend::Apart { touch: Some(at) } => Report::new(format!("{x} and {y} meet in no edge: they touch at {}", say.point(*at))),
        NoBlend::Apart { touch: None } => {
            Report::new(format!("{x} and {y} meet in no edge")).help("draw them so that they meet: `meet(a, b)` is the list of the curves")
        }
        NoBlend::Several { middles } => {
            let places = say.points(middles).join(", ");
            Report::new(format!("{x} and {y} meet in {} edges, near {places}: a rounding needs one", middles.len()))
                .help("cut one of them first, `trim(s, by: …, keep: …)`, so that one edge is left")
        }
        NoBlend::Corner { at } => Report::new(format!("the edge of {x} and {y} has a corner at {}", say.point(*at)))
            .help("round the corner of the curve first, or divide the surfaces there and blend them one by one"),
        NoBlend::Tangent { at } => {
            Report::new(format!("{x} and {y} are tangent to each other at {}: there is no edge to round", say.point(*at)))
        }
        NoBlend::EndsInside { surface, at } => {
            let name = say.quoted(*surface, "a surface");
            Report::new(format!("the rounding of {x} and {y} ends inside {name} at {}, so it cuts off no part of it", say.point(*at)))
                .help(format!("let {name} end where the edge does, at right angles to it, or close the edge"))
        }
        NoBlend::Leaves { surface, at } => {
            let name = say.quoted(*surface, "a surface");
            Report::new(format!("the rounding of {x} and {y} crosses the border of {name} at {}", say.point(*at)))
                .help(format!("take a smaller `radius:`, or blend before {name} is cut there"))
        }
        NoBlend::KeepOn { surface, on, at } => {
            let (name, other) = (say.quoted(*surface, "a surface"), say.quoted(*on, "the other one"));
            Report::new(format!(
                "`keep:` does not determine which side of {name} stays: {} is on {other}, with {name} on both sides of it",
                say.point(*at)
            ))
            .help(format!("{name} extends past the edge: choose a point that is on neither surface, as where the ball is"))
        }
        NoBlend::NoRadius { at } => Report::new(format!("no ball touches both {x} and {y} near {}", say.point(*at)))
            .help("`-s` puts the ball on the other side of a surface"),
    }
}
