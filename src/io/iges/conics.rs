//! Arcs and conic sections in the plane z = const.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3, DVec4};

use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::EPSILON;
use crate::geometry::curves::curve::Shape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::nurbs::weighted;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::io::cad::defect::{Defect, defect};
use crate::io::iges::entity_data::Conic;

const TURN: f64 = std::f64::consts::TAU;

/// The plane z = const of a conic, and when two points of it are one.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// Height, model units.
    pub z: f64,
    /// Largest distance of points that are one, model units.
    pub same: f64,
    /// The import.
    pub origin: Origin,
}

impl Level {
    fn point(&self, p: DVec2) -> DVec3 {
        p.extend(self.z)
    }
}

/// A curve and how far its last point is from the one that was given.
pub type Missed = (Curve, f64);

/// The arc round `center` from `start` counter-clockwise to `end`; the whole circle when they are one point.
pub fn arc(level: &Level, [center, start, end]: [DVec2; 3]) -> Result<Missed, Defect> {
    let (u, e) = (start - center, end - center);
    let radius = u.length();
    if radius <= EPSILON * center.length() || radius == 0.0 {
        return Err(defect("its radius is 0"));
    }
    let sweep = swept(math::atan2(u.perp_dot(e), u.dot(e)), start.distance(end) <= level.same);
    let v = u.perp();
    let arc = EllipticArc::new(level.point(center), u.extend(0.0), v.extend(0.0), sweep);
    let kind = if sweep == TURN { Kind::Circle } else { Kind::Arc };
    Ok((Curve::new(Shape::Arc(Box::new(arc)), kind, level.origin), (radius - e.length()).abs()))
}

/// The angle of a run that is a whole turn when its ends are one.
fn swept(angle: f64, closed: bool) -> f64 {
    if closed {
        TURN
    } else if angle <= 0.0 {
        angle + TURN
    } else {
        angle
    }
}

/// The conic section through two points of it: an ellipse counter-clockwise, else the branch between them.
pub fn conic(level: &Level, coefficients: &Conic, [start, end]: [DVec2; 2]) -> Result<Missed, Defect> {
    let size = coefficients[..3].iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if size == 0.0 {
        return Err(defect("its equation has no square term"));
    }
    // An ellipse's x² counts as positive.
    let sign = if coefficients[0] + coefficients[2] < 0.0 { -size } else { size };
    let [a, b, c, d, e, f] = coefficients.map(|x| x / sign);
    let miss = |p: DVec2| {
        let slope = DVec2::new(2.0 * a * p.x + b * p.y + d, b * p.x + 2.0 * c * p.y + e).length();
        let value = a * p.x * p.x + b * p.x * p.y + c * p.y * p.y + d * p.x + e * p.y + f;
        if slope > 0.0 { (value / slope).abs() } else { 0.0 }
    };
    let missed = miss(start).max(miss(end));
    let determinant = 4.0 * a * c - b * b;
    if determinant > EPSILON {
        let center = DVec2::new(b * e - 2.0 * c * d, b * d - 2.0 * a * e) / determinant;
        let q = |x: DVec2| DVec2::new(a * x.x + 0.5 * b * x.y, 0.5 * b * x.x + c * x.y);
        return ellipse(level, center, q, [start, end]).map(|curve| (curve, missed));
    }
    let form = DMat3::from_cols(DVec3::new(a, 0.5 * b, 0.5 * d), DVec3::new(0.5 * b, c, 0.5 * e), DVec3::new(0.5 * d, 0.5 * e, f));
    branch(level, &form, [start, end]).map(|curve| (curve, missed))
}

/// center + p cos θ + v sin θ with conjugate half-diameters p and v: pᵀQv = 0.
fn ellipse(level: &Level, center: DVec2, q: impl Fn(DVec2) -> DVec2, [start, end]: [DVec2; 2]) -> Result<Curve, Defect> {
    let p = start - center;
    let k = p.dot(q(p));
    let across = q(p).perp();
    let spread = across.dot(q(across));
    if !(k > 0.0 && spread > 0.0) {
        return Err(defect("its first point is not on an ellipse"));
    }
    let v = across * (k / spread).sqrt();
    let e = end - center;
    let sweep = swept(math::atan2(e.dot(q(v)), e.dot(q(p))), start.distance(end) <= level.same);
    let arc = EllipticArc::new(level.point(center), p.extend(0.0), v.extend(0.0), sweep);
    Ok(Curve::new(Shape::Arc(Box::new(arc)), Kind::Ellipse, level.origin))
}

/// The rational quadratic piece between two points of a hyperbola or parabola, from its equation XᵀMX = 0.
///
/// The middle pole is where the tangents M·X₀ and M·X₂ meet; putting the piece into the equation gives w² = −X₀ᵀMX₂ / 2X₁ᵀMX₁.
fn branch(level: &Level, form: &DMat3, [start, end]: [DVec2; 2]) -> Result<Curve, Defect> {
    if start == end {
        return Err(defect("its ends coincide"));
    }
    let (x0, x2) = (start.extend(1.0), end.extend(1.0));
    let meet = (*form * x0).cross(*form * x2);
    if meet.z.abs() <= EPSILON * meet.length() {
        return Err(defect("its end tangents do not meet"));
    }
    let x1 = meet / meet.z;
    let square = -x0.dot(*form * x2) / (2.0 * x1.dot(*form * x1));
    if !(square > 0.0 && square.is_finite()) {
        return Err(defect("its ends are on different branches"));
    }
    let poles: Vec<DVec4> = [(x0, 1.0), (x1, square.sqrt()), (x2, 1.0)].map(|(p, w)| weighted(level.point(p.truncate()), w)).to_vec();
    Ok(Curve::new(Shape::Nurbs(Arc::new(Nurbs::bezier(0.0, 1.0, poles))), Kind::Conic, level.origin))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAT: Level = Level { z: 0.0, same: 0.0, origin: Origin::NONE };

    fn checked(coefficients: Conic, ends: [(f64, f64); 2], middle: impl Fn(DVec3) -> bool) {
        let ends = ends.map(|(x, y)| DVec2::new(x, y));
        let (curve, missed) = conic(&Level { z: 2.0, ..FLAT }, &coefficients, ends).expect("a conic");
        assert!(missed < 1e-12, "{missed}");
        let (a, b) = curve.domain();
        for k in 0..=20 {
            let p = curve.point(a + (b - a) * f64::from(k) / 20.0);
            let [qa, qb, qc, qd, qe, qf] = coefficients;
            let value = qa * p.x * p.x + qb * p.x * p.y + qc * p.y * p.y + qd * p.x + qe * p.y + qf;
            assert!(value.abs() < 1e-11 && p.z == 2.0, "{value} at {p}");
        }
        assert!(curve.start().distance(ends[0].extend(2.0)) < 1e-13 && curve.end().distance(ends[1].extend(2.0)) < 1e-12);
        assert!(middle(curve.point(0.5 * (a + b))));
    }

    #[test]
    fn all_three_kinds_fulfil_their_equation() {
        let h = std::f64::consts::FRAC_1_SQRT_2;
        // x²/9 + y²/4 = 1, both signs of the equation, the short and the long way.
        checked([4.0, 0.0, 9.0, 0.0, 0.0, -36.0], [(3.0, 0.0), (0.0, 2.0)], |p| p.x > 0.0 && p.y > 0.0);
        checked([-4.0, 0.0, -9.0, 0.0, 0.0, 36.0], [(0.0, 2.0), (3.0, 0.0)], |p| p.x < 0.0 && p.y < 0.0);
        // x² − y² = 1, y = x², turned: xy = 1.
        checked([1.0, 0.0, -1.0, 0.0, 0.0, -1.0], [(2.0_f64.sqrt(), -1.0), (2.0_f64.sqrt(), 1.0)], |p| p.y.abs() < 1e-12 && p.x > 0.9);
        checked([1.0, 0.0, 0.0, 0.0, -1.0, 0.0], [(-1.0, 1.0), (2.0, 4.0)], |p| p.y < 4.0);
        checked([0.0, 1.0, 0.0, 0.0, 0.0, -1.0], [(0.5, 2.0), (4.0, 0.25)], |p| p.x < 4.0);
        checked([1.0, 1.0, 1.0, -h, 0.0, -1.0], [root(h), root(h)], |_| true);
    }

    /// The point of x² + xy + y² − h x − 1 = 0 on the positive x axis.
    fn root(h: f64) -> (f64, f64) {
        (0.5 * (h + (h * h + 4.0).sqrt()), 0.0)
    }

    #[test]
    fn what_is_no_conic_is_said() {
        let ends = [DVec2::new(1.0, 0.0), DVec2::new(-1.0, 0.0)];
        assert!(conic(&FLAT, &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0], ends).is_err());
        assert!(conic(&FLAT, &[1.0, 0.0, -1.0, 0.0, 0.0, -1.0], ends).is_err());
    }
}
