//! Offsets of smooth plane curves, evaluated through the curve they follow.

use glam::DVec3;

use crate::geometry::curves::curve::Curve;
use crate::geometry::data::jet::Jet;
use crate::geometry::data::motion::Motion;

/// base(t) + distance · (normal × unit tangent): to the left seen against `normal`.
///
/// The base is smooth and turns nowhere tighter than `distance`, so the offset runs with it everywhere.
#[derive(Clone, Debug)]
pub struct Offset {
    /// The curve it follows: an arc of an ellipse or a rational B-spline.
    pub base: Curve,
    /// Distance to the left, model units; negative to the right.
    pub distance: f64,
    /// Unit normal of the plane.
    pub normal: DVec3,
}

crate::content!(Offset { base, distance, normal });

impl Offset {
    /// Point and derivatives from those of the base.
    pub fn jet_of(&self, base: Jet, third: DVec3) -> Jet {
        let Jet { p, d1, d2 } = base;
        let speed2 = d1.length_squared();
        let speed = speed2.sqrt();
        let left = self.normal.cross(d1) / speed;
        // With k = (C′ × C″)·n / |C′|³ the offset is C′(1 − dk) first and C″(1 − dk) − dk′C′ second.
        let area = d1.cross(d2).dot(self.normal);
        let k = area / (speed2 * speed);
        let dk = d1.cross(third).dot(self.normal) / (speed2 * speed) - 3.0 * k * d1.dot(d2) / speed2;
        let factor = 1.0 - self.distance * k;
        Jet { p: p + left * self.distance, d1: d1 * factor, d2: d2 * factor - d1 * (self.distance * dk) }
    }

    /// The run backwards: left becomes right.
    pub fn reversed(&self) -> Self {
        Self { base: self.base.reversed(), distance: -self.distance, normal: self.normal }
    }

    /// Run between two parameters.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        Self { base: self.base.part(t0, t1), ..*self }
    }

    /// Carried by a motion; a mirror exchanges left and right.
    pub fn moved(&self, motion: &Motion) -> Self {
        let turn = if motion.mirrors() { -1.0 } else { 1.0 };
        Self {
            base: self.base.moved(motion),
            distance: self.distance * motion.scale() * turn,
            normal: motion.vector(self.normal) / motion.scale(),
        }
    }
}
