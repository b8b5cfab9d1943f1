//! The curve constructors of the language; none needs a tolerance, so that the model's box can decide it.

use glam::DVec3;

use super::curve::{Curve, Kind, Shape};
use crate::base::fault::{CurveFault, Result};
use crate::base::origin::Origin;

/// End condition of an interpolating spline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Zero second derivative.
    Natural,
    /// Tangent along this direction (any length); the derivative is the unit direction × the chord parameter's speed 1.
    Clamped(DVec3),
}

/// Settings of [`spline`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spline {
    /// At the first point.
    pub start: Ends,
    /// At the last point.
    pub end: Ends,
    /// Periodic: the first point follows the last one.
    pub closed: bool,
}

fn missing(origin: Origin, what: &str) -> crate::base::fault::Fault {
    CurveFault::Other { of: origin, what: what.to_owned() }.into()
}

/// Straight segment from `a` to `b`.
pub fn line(a: DVec3, b: DVec3, origin: Origin) -> Result<Curve> {
    Ok(Curve::new(Shape::Line(a, b), Kind::Line, origin))
}

/// Straight segments through points; closed ones return to the first.
pub fn polyline(points: &[DVec3], closed: bool, origin: Origin) -> Result<Curve> {
    let _ = (points, closed);
    Err(missing(origin, "polyline"))
}

/// Arc from `a` to `b` through `through`.
pub fn arc_through(a: DVec3, b: DVec3, through: DVec3, origin: Origin) -> Result<Curve> {
    let _ = (a, b, through);
    Err(missing(origin, "arc"))
}

/// Arc about `center` from `start` by `angle` radians (positive: counter-clockwise seen against `normal`), up to one turn.
pub fn arc_center(center: DVec3, start: DVec3, angle: f64, normal: DVec3, origin: Origin) -> Result<Curve> {
    let _ = (center, start, angle, normal);
    Err(missing(origin, "arc"))
}

/// Whole circle that begins at `start`, counter-clockwise seen against `normal`.
pub fn circle_start(center: DVec3, start: DVec3, normal: DVec3, origin: Origin) -> Result<Curve> {
    let _ = (center, start, normal);
    Err(missing(origin, "circle"))
}

/// Whole circle of a radius; begins on the model's x axis seen from the centre (y where the normal is x).
pub fn circle(center: DVec3, radius: f64, normal: DVec3, origin: Origin) -> Result<Curve> {
    let _ = (center, radius, normal);
    Err(missing(origin, "circle"))
}

/// Ellipse with semi-axes `major` and `minor` (vectors at right angles), from parameter angle `from` by `sweep` radians.
pub fn ellipse(center: DVec3, major: DVec3, minor: DVec3, from: f64, sweep: f64, origin: Origin) -> Result<Curve> {
    let _ = (center, major, minor, from, sweep);
    Err(missing(origin, "ellipse"))
}

/// Conic section from `a` to `b` with tangents towards `apex`; `rho` in (0, 1), ½ is a parabola.
pub fn conic(a: DVec3, apex: DVec3, b: DVec3, rho: f64, kind: Kind, origin: Origin) -> Result<Curve> {
    let _ = (a, apex, b, rho, kind);
    Err(missing(origin, "conic"))
}

/// C2 cubic spline through points, chord-length knots [math.md section 11.2].
pub fn spline(points: &[DVec3], settings: &Spline, origin: Origin) -> Result<Curve> {
    let _ = (points, settings);
    Err(missing(origin, "spline"))
}

/// Bézier curve of degree `points.len() - 1`, rational when weights are given.
pub fn bezier(points: &[DVec3], weights: Option<&[f64]>, origin: Origin) -> Result<Curve> {
    let _ = (points, weights);
    Err(missing(origin, "bezier"))
}

/// B-spline; without knots clamped uniform ones over 0…1.
pub fn bspline(points: &[DVec3], degree: usize, knots: Option<&[f64]>, closed: bool, origin: Origin) -> Result<Curve> {
    let _ = (points, degree, knots, closed);
    Err(missing(origin, "bspline"))
}

/// Rational B-spline from poles, weights and knots.
pub fn nurbs(points: &[DVec3], weights: &[f64], knots: &[f64], degree: usize, origin: Origin) -> Result<Curve> {
    let _ = (points, weights, knots, degree);
    Err(missing(origin, "nurbs"))
}

/// Helix about the line through `center` along the unit vector `axis`, from `start`, rising `pitch` a turn.
pub fn helix(center: DVec3, axis: DVec3, start: DVec3, pitch: f64, turns: f64, origin: Origin) -> Result<Curve> {
    let _ = (center, axis, start, pitch, turns);
    Err(missing(origin, "helix"))
}

/// Offset of a plane curve by `distance` to the left seen against the unit vector `normal`.
pub fn offset(curve: &Curve, distance: f64, normal: DVec3, origin: Origin) -> Result<Curve> {
    let _ = (curve, distance, normal);
    Err(missing(origin, "offset"))
}

/// Curves in a row as one; each must start where the one before ends (their joints are kept as they are).
pub fn composite(pieces: &[Curve], origin: Origin) -> Result<Curve> {
    let _ = pieces;
    Err(missing(origin, "composite"))
}
