//! A plane by its frame.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::geometry::Motion;
use crate::surface::data::jet::Jet2;

/// A frame in space: o + u·eu + v·ev, the vectors spanning the box of a boundary (or unit vectors, unbounded).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Where u = v = 0.
    pub origin: DVec3,
    /// ∂/∂u.
    pub eu: DVec3,
    /// ∂/∂v.
    pub ev: DVec3,
}

crate::content!(Frame { origin, eu, ev });

impl Frame {
    /// Point and derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        Jet2 { p: self.origin + self.eu * u + self.ev * v, du: self.eu, dv: self.ev, ..Jet2::default() }
    }

    /// (u, v) of the foot of a point.
    pub fn uv(&self, p: DVec3) -> (f64, f64) {
        let arm = p - self.origin;
        (arm.dot(self.eu) / self.eu.length_squared(), arm.dot(self.ev) / self.ev.length_squared())
    }

    /// The box of 0 ≤ u, v ≤ 1.
    pub fn hull(&self) -> Box3 {
        Box3::of([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| self.jet(u, v).p))
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        Self { origin: motion.point(self.origin), eu: motion.vector(self.eu), ev: motion.vector(self.ev) }
    }
}
