//! Helices, evaluated by their angle.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::math;
use crate::geometry::data::jet::Jet;
use crate::geometry::data::motion::Motion;

/// center + u·cos θ + v·sin θ + rise·θ for θ from 0 to `sweep`; `u`, `v` and `rise` at right angles, |u| = |v|.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Helix {
    /// Foot of the first point on the axis.
    pub center: DVec3,
    /// From the axis to the first point.
    pub u: DVec3,
    /// A quarter turn further, same length.
    pub v: DVec3,
    /// Rise along the axis a radian.
    pub rise: DVec3,
    /// Angle run through, radians, positive.
    pub sweep: f64,
}

crate::content!(Helix { center, u, v, rise, sweep });

impl Helix {
    /// Point and derivatives at angle `t`.
    pub fn jet(&self, t: f64) -> Jet {
        let (s, c) = math::sin_cos(t);
        let from_axis = self.u * c + self.v * s;
        Jet { p: self.center + self.rise * t + from_axis, d1: self.v * c - self.u * s + self.rise, d2: -from_axis }
    }

    /// Length a radian.
    pub fn speed(&self) -> f64 {
        (self.u.length_squared() + self.rise.length_squared()).sqrt()
    }

    /// Run between two angles.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        let (s, c) = math::sin_cos(t0);
        Self {
            center: self.center + self.rise * t0,
            u: self.u * c + self.v * s,
            v: self.v * c - self.u * s,
            rise: self.rise,
            sweep: t1 - t0,
        }
    }

    /// The run backwards.
    pub fn reversed(&self) -> Self {
        let (s, c) = math::sin_cos(self.sweep);
        Self {
            center: self.center + self.rise * self.sweep,
            u: self.u * c + self.v * s,
            v: self.u * s - self.v * c,
            rise: -self.rise,
            sweep: self.sweep,
        }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        Self {
            center: motion.point(self.center),
            u: motion.vector(self.u),
            v: motion.vector(self.v),
            rise: motion.vector(self.rise),
            sweep: self.sweep,
        }
    }

    /// A box that holds it: that of the tube it winds on.
    pub fn bbox(&self) -> Box3 {
        let reach = DVec3::from_array(std::array::from_fn(|i| math::hypot(self.u[i], self.v[i])));
        let axis = Box3::of([self.center, self.center + self.rise * self.sweep]);
        Box3 { min: axis.min - reach, max: axis.max + reach }
    }
}
