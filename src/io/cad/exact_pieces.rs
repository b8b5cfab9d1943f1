//! What a curve is made of where it is lines and arcs of circles: known from how it was made, or from the control points of a spline,
//! never from points along it.

use glam::DVec3;

use crate::base::math::atan2;
use crate::base::tolerance::{SLIVER, Tolerance};
use crate::geometry::curves::curve::Shape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::nurbs::projected;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::io::cad::border;
use crate::io::cad::control_nets::spline;

/// Lines and arcs in the place of pieces of a curve that are such, in its direction, with what else there is between them; the curve
/// itself where no piece is one, or one would be shorter than the tolerance.
pub(super) fn exact_pieces(curve: &Curve, tolerance: &Tolerance) -> Vec<Curve> {
    let whole = curve.length();
    let mut pieces: Vec<Curve> = border::pieces(curve).iter().flat_map(|piece| of_piece(piece, tolerance)).collect();
    // Cutting at a joint may leave a piece that has no length but for rounding.
    pieces.retain(|piece| piece.length() > SLIVER * whole);
    if !pieces.iter().any(is_simple) || pieces.iter().any(|piece| piece.length() <= tolerance.point) {
        return vec![curve.clone()];
    }
    pieces
}

fn is_simple(curve: &Curve) -> bool {
    match curve.shape() {
        Shape::Line(..) => true,
        Shape::Arc(arc) => arc.radius.is_some(),
        _ => false,
    }
}

/// A piece, in parts where it is a spline.
fn of_piece(piece: &Curve, tolerance: &Tolerance) -> Vec<Curve> {
    let Shape::Nurbs(nurbs) = piece.shape() else { return vec![piece.clone()] };
    let of_spline = |part: Nurbs| simple(&part, piece, tolerance).unwrap_or_else(|| spline(part, piece.origin()));
    let stops = loose_knots(nurbs);
    let parts: Vec<Curve> = stops.windows(2).map(|w| of_spline(nurbs.part(w[0], w[1]))).collect();
    if parts.iter().any(is_simple) { parts } else { vec![piece.clone()] }
}

/// The ends of the domain of a spline and the inner knots at which it is as loose as two splines in a row.
fn loose_knots(nurbs: &Nurbs) -> Vec<f64> {
    let (a, b) = nurbs.domain();
    let inner = nurbs.knots.chunk_by(|a, b| a == b).filter(|same| same.len() >= nurbs.degree && same[0] > a && same[0] < b);
    std::iter::once(a).chain(inner.map(|same| same[0])).chain(std::iter::once(b)).collect()
}

/// The line or arc of a circle that a spline of one span, or of control points in a line, is.
fn simple(part: &Nurbs, of: &Curve, tolerance: &Tolerance) -> Option<Curve> {
    straight(part, tolerance)
        .map(|(a, b)| Curve::new(Shape::Line(a, b), Kind::Line, of.origin()))
        .or_else(|| round(part, tolerance).map(|arc| Curve::new(Shape::Arc(Box::new(arc)), Kind::Arc, of.origin())))
}

/// The ends of a line: the control points lie on it one after the other, all weights above 0.
fn straight(part: &Nurbs, tolerance: &Tolerance) -> Option<(DVec3, DVec3)> {
    let points: Vec<DVec3> = part.poles.iter().map(|q| projected(*q)).collect();
    let (first, last) = (points[0], points[points.len() - 1]);
    let way = (last - first).normalize_or_zero();
    let lies = |p: &DVec3| (*p - first).reject_from_normalized(way).length() <= tolerance.rounding;
    let ascends = points.windows(2).all(|w| (w[1] - w[0]).dot(way) >= 0.0);
    let is_line = way != DVec3::ZERO && ascends && points.iter().all(lies) && part.poles.iter().all(|q| q.w > 0.0);
    is_line.then_some((first, last))
}

/// The arc of less than half a turn that a rational parabola is: its control triangle has two equal sides, and the weight of the middle
/// is the cosine of the angle at its foot.
fn round(part: &Nurbs, tolerance: &Tolerance) -> Option<EllipticArc> {
    let [q0, q1, q2] = part.poles[..] else { return None };
    if part.degree != 2 || q0.w.min(q1.w).min(q2.w) <= 0.0 {
        return None;
    }
    let (a, b, c) = (projected(q0), projected(q1), projected(q2));
    let (chord, middle) = (c - a, a.midpoint(c));
    let (height, half) = (b - middle, 0.5 * chord.length());
    let side = (half * half + height.length_squared()).sqrt();
    let weight = q1.w / (q0.w * q2.w).sqrt();
    // Where the curve would be in its middle, and where the circle through its ends with these tangents is.
    let bow = height.length() * weight / (1.0 + weight);
    let of_circle = height.length() * half / (half + side);
    let upright = (height.dot(chord) / chord.length()).abs();
    if height.length() <= tolerance.point || (bow - of_circle).abs() > tolerance.rounding || upright > tolerance.rounding {
        return None;
    }
    let radius = half * side / height.length();
    let out = height.normalize_or_zero();
    let center = middle + out * (of_circle - radius);
    let (u, along) = (a - center, b - a);
    let v = along.reject_from(u).normalize_or_zero() * u.length();
    let sweep = 2.0 * atan2(height.length(), half);
    Some(EllipticArc { center, u, v, sweep, radius: Some(u.length()) })
}
