//! Sides of a hull: x forward, y to port.

use crate::base::bbox::Box3;

/// Share of the breadth by which a hull of one side may reach over the plane y = 0.
const OVER_CENTRE: f64 = 0.01;

/// A side of a hull.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Where y is positive.
    Port,
    /// Where y is negative.
    Starboard,
}

impl Side {
    /// The only side of what lies in a box; `None` where it has both. Lengths nearer than `tolerance`, model units, are one.
    pub fn only(bounds: &Box3, tolerance: f64) -> Option<Self> {
        let (port, starboard) = (bounds.max.y.max(0.0), (-bounds.min.y).max(0.0));
        let is_one = port.min(starboard) <= tolerance.max(OVER_CENTRE * port.max(starboard));
        is_one.then_some(if port >= starboard { Self::Port } else { Self::Starboard })
    }
}
