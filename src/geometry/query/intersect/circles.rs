//! Arcs of one circle: where they run over each other follows from their angles, without subdivision.

use std::f64::consts::{PI, TAU};

use crate::base::math;
use crate::geometry::curves::curve::Shape;
use crate::geometry::curves::pieces::{Node, View};
use crate::geometry::shapes::arc::EllipticArc;

/// Whether two arcs lie on one circle, nowhere further apart than a quarter of the tolerance.
pub(crate) fn one_circle<'a>(a: &View<'a>, b: &View<'a>, point: f64) -> Option<(&'a EllipticArc, &'a EllipticArc)> {
    let (Shape::Arc(x), Shape::Arc(y)) = (a.curve.shape(), b.curve.shape()) else { return None };
    let (rx, ry) = (x.radius?, y.radius?);
    let apart = x.center.distance(y.center) + (rx - ry).abs();
    if apart > 0.125 * point {
        return None;
    }
    let normal = x.u.cross(x.v) / (rx * rx);
    let tilt = normal.dot(y.u).abs().max(normal.dot(y.v).abs());
    (tilt <= 0.125 * point / std::f64::consts::SQRT_2).then_some((&**x, &**y))
}

/// The overlaps of two parts (less than half a turn each), in their own angles; ends count.
pub(crate) fn common(x: &EllipticArc, m: &Node, y: &EllipticArc, n: &Node) -> Option<((f64, f64), (f64, f64))> {
    Some((over(x, m, n)?, over(y, n, m)?))
}

/// The angles of `m` on its arc that the part `n` covers.
fn over(arc: &EllipticArc, m: &Node, n: &Node) -> Option<(f64, f64)> {
    let middle = 0.5 * (m.t.0 + m.t.1);
    let angle = |p: glam::DVec3| {
        let d = p - arc.center;
        let away = math::atan2(d.dot(arc.v), d.dot(arc.u)) - middle;
        away - TAU * ((away + PI) / TAU).floor()
    };
    let (p, q) = (angle(n.p.0), angle(n.p.1));
    let half = 0.5 * (m.t.1 - m.t.0);
    let slack = crate::base::tolerance::PARALLEL;
    let (low, high) = (p.min(q).max(-half), p.max(q).min(half));
    (low <= high + slack).then(|| (middle + low.min(high), middle + low.max(high)))
}
