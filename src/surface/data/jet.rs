//! Point and derivatives of a surface at one place.

use glam::DVec3;

use crate::base::tolerance::{PARALLEL, SINGULAR};

/// Point and derivatives up to order two at one (u, v).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet2 {
    /// The point.
    pub p: DVec3,
    /// ∂/∂u.
    pub du: DVec3,
    /// ∂/∂v.
    pub dv: DVec3,
    /// ∂²/∂u².
    pub duu: DVec3,
    /// ∂²/∂u∂v.
    pub duv: DVec3,
    /// ∂²/∂v².
    pub dvv: DVec3,
}

impl Jet2 {
    /// Mean curvature seen from a unit normal, and how far the principal curvatures are to either side of it, 1/model units; not
    /// numbers where the surface is singular.
    pub fn curvatures(&self, normal: DVec3) -> (f64, f64) {
        let (e, f, g) = (self.du.length_squared(), self.du.dot(self.dv), self.dv.length_squared());
        let (l, m, n) = (self.duu.dot(normal), self.duv.dot(normal), self.dvv.dot(normal));
        let area = e * g - f * f;
        if area <= PARALLEL * e * g {
            return (f64::NAN, f64::NAN);
        }
        let (mean, gauss) = ((e * n - 2.0 * f * m + g * l) / (2.0 * area), (l * n - m * m) / area);
        (mean, (mean * mean - gauss).max(0.0).sqrt())
    }
}

/// `du × dv` as a unit vector, or `None` where the two (nearly) vanish or fall together.
pub(crate) fn unit_normal(jet: &Jet2) -> Option<DVec3> {
    let cross = jet.du.cross(jet.dv);
    let scale = jet.du.length_squared().max(jet.dv.length_squared());
    let length = cross.length();
    (length > SINGULAR * scale && length.is_finite()).then(|| cross / length)
}

/// ∂u and ∂v of the unit normal; none where it is singular.
pub(crate) fn slopes(jet: &Jet2) -> Option<(DVec3, DVec3)> {
    let normal = unit_normal(jet)?;
    let length = jet.du.cross(jet.dv).length();
    let across = |w: DVec3| (w - normal * normal.dot(w)) / length;
    Some((across(jet.duu.cross(jet.dv) + jet.du.cross(jet.duv)), across(jet.duv.cross(jet.dv) + jet.du.cross(jet.dvv))))
}
