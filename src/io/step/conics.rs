//! Curves that have no ends of their own, by their parameters: lines and conic sections.

use glam::DVec3;

use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::EPSILON;
use crate::geometry::construct::build;
use crate::geometry::curves::curve::Shape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::nurbs::weighted;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::io::cad::defect::{Defect, defect};

const TURN: f64 = std::f64::consts::TAU;

/// A line or a conic section in model units; angles in radians.
#[derive(Clone, Copy, Debug)]
pub enum Endless {
    /// p + t d.
    Line(DVec3, DVec3),
    /// c + u cos t + v sin t.
    Ellipse(DVec3, DVec3, DVec3),
    /// c + u cosh t + v sinh t.
    Hyperbola(DVec3, DVec3, DVec3),
    /// c + u t² + 2 v t, the lengths of both being the focal distance.
    Parabola(DVec3, DVec3, DVec3),
}

impl Endless {
    /// Whether it comes back to where it began.
    pub fn closes(&self) -> bool {
        matches!(self, Self::Ellipse(..))
    }

    /// A point and the unit normal of the plane of a conic.
    pub fn plane(&self) -> (DVec3, DVec3) {
        match *self {
            Self::Line(c, d) => (c, math::any_normal(d)),
            Self::Ellipse(c, u, v) | Self::Hyperbola(c, u, v) | Self::Parabola(c, u, v) => (c, u.cross(v).normalize_or_zero()),
        }
    }

    /// The parameter of the point nearest to a place, for ellipses from 0 to a whole turn; exact where the place is on the curve.
    pub fn parameter(&self, p: DVec3) -> f64 {
        let along = |c: DVec3, d: DVec3| (p - c).dot(d) / d.length_squared();
        match *self {
            Self::Line(c, d) => along(c, d),
            Self::Ellipse(c, u, v) => {
                let t = math::atan2(along(c, v), along(c, u));
                if t < 0.0 { t + TURN } else { t }
            }
            Self::Hyperbola(c, _, v) => math::asinh(along(c, v)),
            Self::Parabola(c, _, v) => 0.5 * along(c, v),
        }
    }

    /// The point at a parameter.
    pub fn point(&self, t: f64) -> DVec3 {
        match *self {
            Self::Line(c, d) => c + d * t,
            Self::Ellipse(c, u, v) => {
                let (s, k) = math::sin_cos(t);
                c + u * k + v * s
            }
            Self::Hyperbola(c, u, v) => c + u * math::cosh(t) + v * math::sinh(t),
            Self::Parabola(c, u, v) => c + u * (t * t) + v * (2.0 * t),
        }
    }

    /// The curve from one parameter to a larger one, of ellipses at most a turn.
    pub fn part(&self, t0: f64, t1: f64, origin: Origin) -> Result<Curve, Defect> {
        if !(t0.is_finite() && t1.is_finite() && t1 > t0) {
            return Err(defect(format!("it has no stretch from {t0} to {t1}")));
        }
        match *self {
            Self::Line(..) => Ok(build::line(self.point(t0), self.point(t1), origin)?),
            Self::Ellipse(c, u, v) => {
                let (s, k) = math::sin_cos(t0);
                let sweep = if t1 - t0 >= TURN * (1.0 - EPSILON) { TURN } else { t1 - t0 };
                let arc = EllipticArc::new(c, u * k + v * s, v * k - u * s, sweep);
                let kind = match (arc.radius.is_some(), sweep == TURN) {
                    (true, true) => Kind::Circle,
                    (true, false) => Kind::Arc,
                    (false, _) => Kind::Ellipse,
                };
                Ok(Curve::new(Shape::Arc(Box::new(arc)), kind, origin))
            }
            Self::Hyperbola(c, u, v) => {
                let (middle, w) = (0.5 * (t0 + t1), math::cosh(0.5 * (t1 - t0)));
                let apex = c + (u * math::cosh(middle) + v * math::sinh(middle)) / w;
                piece([self.point(t0), apex, self.point(t1)], w, Kind::Conic, origin)
            }
            Self::Parabola(c, u, v) => {
                let apex = c + u * (t0 * t1) + v * (t0 + t1);
                piece([self.point(t0), apex, self.point(t1)], 1.0, Kind::Parabola, origin)
            }
        }
    }
}

/// A quadratic piece whose middle point has a weight.
fn piece(points: [DVec3; 3], w: f64, kind: Kind, origin: Origin) -> Result<Curve, Defect> {
    if !(w.is_finite() && points.iter().all(|p| p.is_finite())) {
        return Err(defect("it reaches too far"));
    }
    let poles = vec![weighted(points[0], 1.0), weighted(points[1], w), weighted(points[2], 1.0)];
    Ok(Curve::new(Shape::Nurbs(std::sync::Arc::new(Nurbs::bezier(0.0, 1.0, poles))), kind, origin))
}
