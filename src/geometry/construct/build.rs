//! The curve constructors of the language; none needs a tolerance, so that the model's box can decide it.
//!
//! They refuse what is degenerate beyond rounding; what is merely small is found by [`Curve::check`].

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::{LengthRange, Result, ValueFault};
use crate::base::limits::{COORDINATE, knot_beyond};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, NUDGE, PARALLEL};
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::fault::{CurveFault, KnotFault};
use crate::geometry::data::kind::Kind;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::helix::Helix;
use crate::geometry::shapes::nurbs::{MAX_DEGREE, Nurbs, weighted};

pub use crate::geometry::construct::offset_build::offset;
pub use crate::geometry::construct::spline::{Ends, Spline, spline};

/// E408 unless all numbers of a point or vector are finite, E306 when one exceeds `COORDINATE`.
pub(crate) fn finite(v: DVec3, argument: &'static str, of: Origin) -> Result<()> {
    if !v.is_finite() {
        return Err(CurveFault::NonFinite { of, argument, index: None }.into());
    }
    in_range(v, argument)
}

fn in_range(v: DVec3, argument: &'static str) -> Result<()> {
    let largest = v.abs().max_element();
    if largest <= COORDINATE {
        return Ok(());
    }
    Err(ValueFault::LengthOutside { argument, found: largest, range: LengthRange::Within(COORDINATE) }.into())
}

fn finite_number(x: f64, argument: &'static str, of: Origin) -> Result<()> {
    finite(DVec3::splat(x), argument, of)
}

pub(crate) fn finite_points(points: &[DVec3], of: Origin) -> Result<()> {
    match points.iter().position(|p| !p.is_finite()) {
        Some(i) => Err(CurveFault::NonFinite { of, argument: "points", index: Some(i) }.into()),
        None => points.iter().try_for_each(|p| in_range(*p, "points")),
    }
}

pub(crate) fn enough(points: &[DVec3], needed: usize, what: &'static str, of: Origin) -> Result<()> {
    if points.len() >= needed {
        return Ok(());
    }
    Err(CurveFault::TooFewPoints { of, what, argument: "points", needed, given: points.len() }.into())
}

/// E403 for neighbours that are exactly one point; the last and the first are neighbours when `closed`.
pub(crate) fn all_different(points: &[DVec3], closed: bool, of: Origin) -> Result<()> {
    let count = points.len();
    let pairs = if closed { count } else { count - 1 };
    match (0..pairs).find(|&i| points[i] == points[(i + 1) % count]) {
        Some(index) => Err(CurveFault::DuplicatePoints { of, index, count, at: points[index], distance: 0.0, tolerance: 0.0 }.into()),
        None => Ok(()),
    }
}

/// The unit vector along a vector; E408 unless it is finite, E409 where it has no length.
pub(crate) fn direction(v: DVec3, argument: &'static str, needed: &'static str, of: Origin) -> Result<DVec3> {
    if !v.is_finite() {
        return Err(CurveFault::NonFinite { of, argument, index: None }.into());
    }
    // A plain length would overflow or vanish for extreme numbers.
    let scale = v.abs().max_element();
    math::unit(v / scale, 0.0).ok_or_else(|| CurveFault::ZeroDirection { of, argument, needed }.into())
}

/// Straight segment from `a` to `b`.
pub fn line(a: DVec3, b: DVec3, origin: Origin) -> Result<Curve> {
    finite(a, "a", origin)?;
    finite(b, "b", origin)?;
    if a == b {
        return Err(CurveFault::ZeroLength { of: origin, length: 0.0, tolerance: 0.0 }.into());
    }
    Ok(Curve::new(Shape::Line(a, b), Kind::Line, origin))
}

/// Straight segments through points; closed ones return to the first. The parameter is the length.
pub fn polyline(points: &[DVec3], closed: bool, origin: Origin) -> Result<Curve> {
    finite_points(points, origin)?;
    enough(points, if closed { 3 } else { 2 }, if closed { "a closed polyline" } else { "a polyline" }, origin)?;
    all_different(points, closed, origin)?;
    let around = points.iter().chain(points.first().filter(|_| closed));
    let mut knots = vec![0.0, 0.0];
    let mut poles: Vec<glam::DVec4> = Vec::with_capacity(points.len() + 1);
    for p in around {
        if let Some(before) = poles.last() {
            knots.push(knots[knots.len() - 1] + p.distance(before.truncate()));
        }
        poles.push(p.extend(1.0));
    }
    knots.push(knots[knots.len() - 1]);
    Ok(from_nurbs(Nurbs::new(1, knots, poles), Kind::Polyline, origin))
}

fn from_nurbs(curve: Nurbs, kind: Kind, origin: Origin) -> Curve {
    Curve::new(Shape::Nurbs(Arc::new(curve)), kind, origin)
}

/// Arc from `a` to `b` through `through`.
pub fn arc_through(a: DVec3, b: DVec3, through: DVec3, origin: Origin) -> Result<Curve> {
    for (p, argument) in [(a, "a"), (b, "b"), (through, "through")] {
        finite(p, argument, origin)?;
    }
    let (to_through, to_end) = (through - a, b - a);
    let across = to_through.cross(to_end);
    let (l1, l2) = (to_through.length_squared(), to_end.length_squared());
    if across.length_squared() <= l1 * l2 * (16.0 * EPSILON) * (16.0 * EPSILON) {
        return Err(CurveFault::Collinear { of: origin, points: [a, through, b] }.into());
    }
    let to_center = (to_end.cross(across) * l1 + across.cross(to_through) * l2) / (2.0 * across.length_squared());
    let center = a + to_center;
    let u = -to_center;
    let v = across.normalize().cross(u);
    let w = b - center;
    let angle = math::atan2(w.dot(v), w.dot(u));
    let sweep = if angle > 0.0 { angle } else { angle + TAU };
    let radius = Some(u.length());
    Ok(Curve::new(Shape::Arc(Box::new(EllipticArc { center, u, v, sweep, radius })), Kind::Arc, origin).built_through(Some(through)))
}

/// The angle as a positive sweep and a sign; E411 for zero and E412 beyond one turn.
fn sweep_of(angle: f64, argument: &'static str, of: Origin) -> Result<(f64, f64)> {
    finite_number(angle, argument, of)?;
    let sweep = angle.abs();
    if sweep <= EPSILON {
        return Err(CurveFault::ZeroAngle { of, argument }.into());
    }
    if sweep > TAU * (1.0 + PARALLEL) {
        return Err(CurveFault::AngleTooLarge { of, argument, angle }.into());
    }
    Ok((sweep.min(TAU), angle.signum()))
}

/// Arc about `center` from `start` by `angle` radians (positive: counter-clockwise seen against `normal`), up to one turn.
pub fn arc_center(center: DVec3, start: DVec3, angle: f64, normal: DVec3, origin: Origin) -> Result<Curve> {
    let (sweep, sign) = sweep_of(angle, "angle", origin)?;
    round_arc(center, start, normal, sweep, sign, Kind::Arc, origin)
}

fn round_arc(center: DVec3, start: DVec3, normal: DVec3, sweep: f64, sign: f64, kind: Kind, origin: Origin) -> Result<Curve> {
    finite(center, "center", origin)?;
    finite(start, "start", origin)?;
    let normal = direction(normal, "normal", "with a length", origin)?;
    let u = start - center;
    let Some(radial) = math::unit(u, 0.0) else {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "start", needed: "away from the centre" }.into());
    };
    if normal.dot(radial).abs() > NUDGE {
        let (angle, to) = (math::angle_between(normal, radial), "the line from `center` to `start`");
        return Err(ValueFault::NotAcross { argument: "normal", angle, to }.into());
    }
    let v = normal.cross(radial).normalize() * (u.length() * sign);
    Ok(Curve::new(Shape::Arc(Box::new(EllipticArc { center, u, v, sweep, radius: Some(u.length()) })), kind, origin))
}

/// Whole circle that begins at `start`, counter-clockwise seen against `normal`.
pub fn circle_start(center: DVec3, start: DVec3, normal: DVec3, origin: Origin) -> Result<Curve> {
    round_arc(center, start, normal, TAU, 1.0, Kind::Circle, origin)
}

/// Whole circle of a radius; begins on the model's x axis seen from the centre (y where the normal is x).
pub fn circle(center: DVec3, radius: f64, normal: DVec3, origin: Origin) -> Result<Curve> {
    finite(center, "center", origin)?;
    finite_number(radius, "radius", origin)?;
    if radius <= 0.0 {
        return Err(ValueFault::LengthOutside { argument: "radius", found: radius, range: LengthRange::Positive }.into());
    }
    let normal = direction(normal, "normal", "with a length", origin)?;
    let along = |axis: DVec3| axis - normal * normal.dot(axis);
    let x = if along(DVec3::X).length() > PARALLEL { along(DVec3::X) } else { along(DVec3::Y) };
    let u = x.normalize() * radius;
    let arc = EllipticArc { center, u, v: normal.cross(u), sweep: TAU, radius: Some(radius) };
    Ok(Curve::new(Shape::Arc(Box::new(arc)), Kind::Circle, origin))
}

/// Ellipse with semi-axes `major` and `minor` (vectors at right angles), from parameter angle `from` by `sweep` radians.
///
/// Other vectors that do not lie on one line give the ellipse with these conjugate half-diameters.
pub fn ellipse(center: DVec3, major: DVec3, minor: DVec3, from: f64, sweep: f64, origin: Origin) -> Result<Curve> {
    finite(center, "center", origin)?;
    let (along, across) = (direction(major, "major", "with a length", origin)?, direction(minor, "minor", "with a length", origin)?);
    if along.cross(across).length() <= PARALLEL {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "minor", needed: "at right angles to `major`" }.into());
    }
    finite_number(from, "from", origin)?;
    let (sweep, sign) = sweep_of(sweep, "angle", origin)?;
    let (s, c) = math::sin_cos(from);
    let arc = EllipticArc::new(center, major * c + minor * s, (minor * c - major * s) * sign, sweep);
    Ok(Curve::new(Shape::Arc(Box::new(arc)), Kind::Ellipse, origin))
}

/// Conic section from `a` to `b` with tangents towards `apex`; `rho` in (0, 1), ½ is a parabola.
pub fn conic(a: DVec3, apex: DVec3, b: DVec3, rho: f64, kind: Kind, origin: Origin) -> Result<Curve> {
    for (p, argument) in [(a, "a"), (apex, "apex"), (b, "b")] {
        finite(p, argument, origin)?;
    }
    if !(rho > 0.0 && rho < 1.0) {
        return Err(CurveFault::Rho { of: origin, rho }.into());
    }
    if apex == a || apex == b {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "apex", needed: "away from both ends" }.into());
    }
    let poles = vec![a.extend(1.0), weighted(apex, rho / (1.0 - rho)), b.extend(1.0)];
    Ok(from_nurbs(Nurbs::bezier(0.0, 1.0, poles), kind, origin))
}

/// Bézier curve of degree `points.len() - 1`, rational when weights are given.
pub fn bezier(points: &[DVec3], weights: Option<&[f64]>, origin: Origin) -> Result<Curve> {
    enough(points, 2, "a Bézier curve", origin)?;
    if points.len() > MAX_DEGREE + 1 {
        let range = format!("2 to {} points; a bspline takes any number", MAX_DEGREE + 1);
        return Err(ValueFault::OutsideRange { argument: "points", found: points.len().to_string(), range }.into());
    }
    let poles = weighted_poles(points, weights, origin)?;
    Ok(from_nurbs(Nurbs::bezier(0.0, 1.0, poles), Kind::Bezier, origin))
}

/// Homogeneous poles after all checks of points and weights.
fn weighted_poles(points: &[DVec3], weights: Option<&[f64]>, of: Origin) -> Result<Vec<glam::DVec4>> {
    finite_points(points, of)?;
    if points.windows(2).all(|p| p[0] == p[1]) {
        return Err(CurveFault::ZeroLength { of, length: 0.0, tolerance: 0.0 }.into());
    }
    let Some(weights) = weights else { return Ok(points.iter().map(|p| p.extend(1.0)).collect()) };
    if weights.len() != points.len() {
        let range = format!("as many as points, {}", points.len());
        return Err(ValueFault::OutsideRange { argument: "weights", found: weights.len().to_string(), range }.into());
    }
    if let Some(index) = weights.iter().position(|w| !w.is_finite()) {
        return Err(CurveFault::NonFinite { of, argument: "weights", index: Some(index) }.into());
    }
    if let Some(index) = weights.iter().position(|w| *w <= 0.0) {
        return Err(CurveFault::Weight { of, index, weight: weights[index] }.into());
    }
    Ok(points.iter().zip(weights).map(|(p, w)| weighted(*p, *w)).collect())
}

fn check_degree(degree: usize) -> Result<()> {
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(());
    }
    Err(ValueFault::OutsideRange { argument: "degree", found: degree.to_string(), range: format!("from 1 to {MAX_DEGREE}") }.into())
}

/// Knots must be as many as needed, not decrease, keep the curve in one piece and leave it a domain.
pub(crate) fn check_knots(knots: &[f64], points: usize, degree: usize, of: Origin) -> Result<()> {
    let fault = |what| -> Result<()> { Err(CurveFault::Knots { of, what }.into()) };
    let needed = points + degree + 1;
    if knots.len() != needed {
        return fault(KnotFault::Count { needed, given: knots.len(), points, degree });
    }
    if let Some(index) = knots.iter().position(|x| !x.is_finite()) {
        return Err(CurveFault::NonFinite { of, argument: "knots", index: Some(index) }.into());
    }
    if let Some(i) = knots.windows(2).position(|x| x[1] < x[0]) {
        return fault(KnotFault::Decreasing { index: i + 1, pair: (knots[i], knots[i + 1]) });
    }
    if let Some(found) = knot_beyond(knots) {
        return fault(KnotFault::Beyond { found });
    }
    let (first, last) = (knots[degree], knots[points]);
    if first == last {
        return fault(KnotFault::EmptyDomain { knot: first });
    }
    for same in knots.chunk_by(|a, b| a == b) {
        let allowed = if first < same[0] && same[0] < last { degree } else { degree + 1 };
        if same.len() > allowed {
            return fault(KnotFault::TooOften { knot: same[0], times: same.len(), allowed });
        }
    }
    Ok(())
}

/// B-spline; without knots clamped uniform ones over 0…1. A closed one is periodic: its poles repeat.
pub fn bspline(points: &[DVec3], degree: usize, knots: Option<&[f64]>, closed: bool, origin: Origin) -> Result<Curve> {
    check_degree(degree)?;
    if points.len() <= degree {
        let fault = CurveFault::TooFewPoints {
            of: origin,
            what: if closed { "a closed B-spline of this degree" } else { "a B-spline of this degree" },
            argument: "points",
            needed: degree + 1,
            given: points.len(),
        };
        return Err(fault.into());
    }
    let poles = weighted_poles(points, None, origin)?;
    if closed {
        return closed_bspline(poles, degree, knots, origin);
    }
    let uniform = || {
        let spans = points.len() - degree;
        let inner = (1..spans).map(|i| i as f64 / spans as f64);
        std::iter::repeat_n(0.0, degree + 1).chain(inner).chain(std::iter::repeat_n(1.0, degree + 1)).collect()
    };
    let knots: Vec<f64> = knots.map_or_else(uniform, <[f64]>::to_vec);
    check_knots(&knots, poles.len(), degree, origin)?;
    Ok(clamped(Nurbs::new(degree, knots, poles), Kind::Bspline, origin))
}

/// `knots` of a closed B-spline are one period: points + 1 values, first and last one apart by it.
fn closed_bspline(mut poles: Vec<glam::DVec4>, degree: usize, knots: Option<&[f64]>, origin: Origin) -> Result<Curve> {
    let n = poles.len();
    let period: Vec<f64> = knots.map_or_else(|| (0..=n).map(|i| i as f64 / n as f64).collect(), <[f64]>::to_vec);
    if period.len() != n + 1 {
        let what = KnotFault::Count { needed: n + 1, given: period.len(), points: n, degree };
        return Err(CurveFault::Knots { of: origin, what }.into());
    }
    let length = period[n] - period[0];
    let at = |i: isize| {
        let turns = i.div_euclid(n as isize);
        period[i.rem_euclid(n as isize) as usize] + turns as f64 * length
    };
    let d = degree as isize;
    let all: Vec<f64> = (-d..=n as isize + d).map(at).collect();
    poles.extend_from_within(..degree);
    check_knots(&all, poles.len(), degree, origin)?;
    Ok(clamped(Nurbs::new(degree, all, poles), Kind::Bspline, origin))
}

/// With full end knots, so that first and last pole are the ends.
fn clamped(curve: Nurbs, kind: Kind, origin: Origin) -> Curve {
    let (a, b) = curve.domain();
    let (n, p) = (curve.poles.len(), curve.degree);
    let full = curve.knots[0] == a && curve.knots[n + p] == b;
    from_nurbs(if full { curve } else { curve.part(a, b) }, kind, origin)
}

/// Rational B-spline from poles, weights and knots.
pub fn nurbs(points: &[DVec3], weights: &[f64], knots: &[f64], degree: usize, origin: Origin) -> Result<Curve> {
    check_degree(degree)?;
    if points.len() <= degree {
        let (needed, given) = (degree + 1, points.len());
        return Err(CurveFault::TooFewPoints { of: origin, what: "a NURBS of this degree", argument: "points", needed, given }.into());
    }
    let poles = weighted_poles(points, Some(weights), origin)?;
    check_knots(knots, poles.len(), degree, origin)?;
    Ok(clamped(Nurbs::new(degree, knots.to_vec(), poles), Kind::Nurbs, origin))
}

/// Helix about the line through `center` along the vector `axis`, from `start`, rising `pitch` a turn.
///
/// Turns below zero go clockwise seen against the axis, and still rise by `pitch` each.
pub fn helix(center: DVec3, axis: DVec3, start: DVec3, pitch: f64, turns: f64, origin: Origin) -> Result<Curve> {
    finite(center, "center", origin)?;
    finite(start, "start", origin)?;
    let axis = direction(axis, "axis", "with a length", origin)?;
    finite_number(pitch, "pitch", origin)?;
    finite_number(turns, "turns", origin)?;
    if turns == 0.0 {
        return Err(CurveFault::ZeroAngle { of: origin, argument: "turns" }.into());
    }
    let foot = center + axis * (start - center).dot(axis);
    let u = start - foot;
    if u.length() <= EPSILON * (start - center).length() {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "start", needed: "away from the axis" }.into());
    }
    let v = axis.cross(u) * turns.signum();
    let helix = Helix { center: foot, u, v, rise: axis * (pitch / TAU), sweep: turns.abs() * (4.0 * FRAC_PI_2) };
    Ok(Curve::new(Shape::Helix(Box::new(helix)), Kind::Helix, origin))
}

/// Curves in a row as one; each must start where the one before ends (their joints are kept as they are).
pub fn composite(pieces: &[Curve], origin: Origin) -> Result<Curve> {
    match pieces {
        [] => Err(CurveFault::TooFewPoints { of: origin, what: "a joined curve", argument: "pieces", needed: 1, given: 0 }.into()),
        [one] => Ok(one.with_origin(origin)),
        _ => Ok(Curve::new(Shape::Composite(Arc::new(Composite::new(pieces.iter().cloned()))), Kind::Composite, origin)),
    }
}
