//! Arcs of circles and ellipses, evaluated by their angle.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::math;
use crate::base::tolerance::EPSILON;
use crate::geometry::data::jet::Jet;
use crate::geometry::data::motion::Motion;
use crate::geometry::shapes::nurbs::{Nurbs, weighted};

/// center + u·cos θ + v·sin θ for θ from 0 to `sweep`; starts at `center + u`.
///
/// `u` and `v` are conjugate half-diameters: at right angles and equally long on a circle, else any pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticArc {
    /// Centre.
    pub center: DVec3,
    /// From the centre to the first point.
    pub u: DVec3,
    /// Derivative at the first point.
    pub v: DVec3,
    /// Angle run through, radians, 0 < sweep ≤ 2π.
    pub sweep: f64,
    /// Radius, when it is a circle's.
    pub radius: Option<f64>,
}

crate::content!(EllipticArc { center, u, v, sweep, radius });

impl EllipticArc {
    /// Recognises circles up to rounding.
    pub fn new(center: DVec3, u: DVec3, v: DVec3, sweep: f64) -> Self {
        let (uu, vv) = (u.length_squared(), v.length_squared());
        let slack = 64.0 * EPSILON * uu.max(vv);
        let round = (uu - vv).abs() <= slack && u.dot(v).abs() <= slack;
        Self { center, u, v, sweep, radius: round.then(|| uu.sqrt()) }
    }

    /// Point and derivatives at angle `t`.
    #[inline]
    pub fn jet(&self, t: f64) -> Jet {
        let (s, c) = math::sin_cos(t);
        let from_center = self.u * c + self.v * s;
        Jet { p: self.center + from_center, d1: self.v * c - self.u * s, d2: -from_center }
    }

    /// Arc between two angles.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        let (s, c) = math::sin_cos(t0);
        Self { u: self.u * c + self.v * s, v: self.v * c - self.u * s, sweep: t1 - t0, ..*self }
    }

    /// The run backwards.
    pub fn reversed(&self) -> Self {
        let (s, c) = math::sin_cos(self.sweep);
        Self { u: self.u * c + self.v * s, v: self.u * s - self.v * c, ..*self }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        Self {
            center: motion.point(self.center),
            u: motion.vector(self.u),
            v: motion.vector(self.v),
            sweep: self.sweep,
            radius: self.radius.map(|r| r * motion.scale()),
        }
    }

    /// The exact box: the ends and, per axis, the extreme angles that the sweep reaches.
    pub fn bbox(&self) -> Box3 {
        let mut bounds = Box3::of([self.jet(0.0).p, self.jet(self.sweep).p]);
        for axis in 0..3 {
            let (u, v) = (self.u[axis], self.v[axis]);
            let first = math::atan2(v, u);
            for turn in [-1.0, 0.0, 1.0, 2.0] {
                let t = first + turn * std::f64::consts::PI;
                if 0.0 < t && t < self.sweep {
                    let reach = (u * u + v * v).sqrt();
                    let mut p = self.jet(t).p;
                    // The extreme itself, not what rounding of the angle makes of it.
                    p[axis] = self.center[axis] + if turn.abs() == 1.0 { -reach } else { reach };
                    bounds = bounds.with(p);
                }
            }
        }
        bounds
    }

    /// n = ⌈sweep/90°⌉ rational quadratic pieces over 0…sweep; middle weights cos(sweep/2n) (the arc rule).
    pub fn to_nurbs(&self) -> Nurbs {
        let quarters = self.sweep / std::f64::consts::FRAC_PI_2;
        let n = ((quarters - 4.0 * EPSILON * quarters).ceil() as usize).max(1);
        let half = self.sweep / (2 * n) as f64;
        let weight = math::cos(half);
        let mut poles = vec![(self.center + self.u).extend(1.0)];
        let mut knots = vec![0.0; 3];
        for i in 0..n {
            let at = |k: usize| if k == 2 * n { self.sweep } else { half * k as f64 };
            let middle = self.jet(at(2 * i + 1)).p - self.center;
            poles.push(weighted(self.center + middle / weight, weight));
            poles.push(self.jet(at(2 * i + 2)).p.extend(1.0));
            knots.extend([at(2 * i + 2); 2]);
        }
        knots.push(self.sweep);
        Nurbs { degree: 2, knots, poles, polynomial: false }
    }
}
