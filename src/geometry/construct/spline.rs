//! The interpolating cubic spline [de Boor 1978, chapter IV]: C2, knots by chord length, its root [Lee 1989] or uniform.

use std::sync::Arc;

use glam::{DVec3, DVec4};

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::solve::{Row, cyclic, tridiagonal};
use crate::geometry::construct::build::{all_different, direction, enough, finite_points};
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::kind::Kind;
use crate::geometry::shapes::nurbs::Nurbs;

/// End condition of an interpolating spline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Zero second derivative.
    Natural,
    /// The derivative of the parabola through the three points at the end.
    Bessel,
    /// Tangent along this direction (any length); the derivative is the unit direction × the chord parameter's speed 1.
    Clamped(DVec3),
}

/// How far apart the parameters of neighbouring points are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// As far as the points.
    #[default]
    Chord,
    /// The root of that, for points of uneven distances [Lee 1989].
    Centripetal,
    /// All alike.
    Uniform,
}

impl Spacing {
    /// The span of two points at a distance.
    pub fn of(self, distance: f64) -> f64 {
        match self {
            Self::Chord => distance,
            Self::Centripetal => distance.sqrt(),
            Self::Uniform => 1.0,
        }
    }

    /// The spans of a row of points, one fewer than these.
    pub fn spans(self, points: &[DVec3]) -> Vec<f64> {
        points.windows(2).map(|p| self.of(p[0].distance(p[1]))).collect()
    }
}

impl Ends {
    /// Derivative at the first point; none: natural. A direction has the speed of the first chord.
    pub fn first(self, points: &[DVec3], spans: &[f64]) -> Option<DVec3> {
        match self {
            Self::Natural => None,
            Self::Bessel => Some(bessel(points, spans)),
            Self::Clamped(along) => Some(along.normalize_or_zero() * (points[0].distance(points[1]) / spans[0])),
        }
    }

    /// The same at the last point.
    pub fn last(self, points: &[DVec3], spans: &[f64]) -> Option<DVec3> {
        match self {
            Self::Natural => None,
            Self::Bessel => Some(bessel_last(points, spans)),
            Self::Clamped(along) => {
                let n = spans.len();
                Some(along.normalize_or_zero() * (points[n - 1].distance(points[n]) / spans[n - 1]))
            }
        }
    }
}

/// Derivative at the first point of the parabola through the first three [de Boor 1978, chapter IV].
pub fn bessel(points: &[DVec3], spans: &[f64]) -> DVec3 {
    let secant = |i: usize| (points[i + 1] - points[i]) / spans[i];
    if spans.len() < 2 {
        return secant(0);
    }
    secant(0) + (secant(0) - secant(1)) * (spans[0] / (spans[0] + spans[1]))
}

/// The same at the last point.
pub fn bessel_last(points: &[DVec3], spans: &[f64]) -> DVec3 {
    let (points, spans): (Vec<DVec3>, Vec<f64>) = (points.iter().rev().copied().collect(), spans.iter().rev().copied().collect());
    -bessel(&points, &spans)
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

/// C2 cubic spline through points, chord-length knots.
pub fn spline(points: &[DVec3], settings: &Spline, origin: Origin) -> Result<Curve> {
    spaced(points, settings, Spacing::Chord, origin)
}

/// C2 cubic spline through points with knots of a spacing.
///
/// Fails with E402 below 2 points, 3 of a closed one; E403 for two neighbours that are one; E409 for a direction without a length.
pub fn spaced(points: &[DVec3], settings: &Spline, spacing: Spacing, origin: Origin) -> Result<Curve> {
    finite_points(points, origin)?;
    let closed = settings.closed;
    enough(points, if closed { 3 } else { 2 }, if closed { "a closed spline" } else { "a spline" }, origin)?;
    all_different(points, closed, origin)?;
    let end = |end: Ends, argument: &'static str| -> Result<Ends> {
        let Ends::Clamped(v) = end else { return Ok(end) };
        direction(v, argument, "with a length", origin).map(Ends::Clamped)
    };
    let ends = [end(settings.start, "start")?, end(settings.end, "end")?];
    let around: Vec<DVec3> = points.iter().chain(points.first().filter(|_| closed)).copied().collect();
    let spans = spacing.spans(&around);
    let given = || [ends[0].first(&around, &spans), ends[1].last(&around, &spans)];
    let slopes = if closed { periodic_slopes(&around, &spans) } else { open_slopes(&around, &spans, given()) };
    let curve = through(&around, &spans, &slopes);
    Ok(Curve::new(Shape::Nurbs(Arc::new(curve)), Kind::Spline, origin))
}

/// Derivatives at the points that make the second derivative continuous; `ends` are given ones, else natural.
pub fn open_slopes(points: &[DVec3], spans: &[f64], ends: [Option<DVec3>; 2]) -> Vec<DVec3> {
    let n = spans.len();
    let secant = |i: usize| (points[i + 1] - points[i]) / spans[i];
    let mut rows: Vec<Row> = Vec::with_capacity(n + 1);
    let mut right = Vec::with_capacity(n + 1);
    for i in 0..=n {
        let (row, value) = match (i == 0, i == n) {
            (true, _) => ends[0].map_or(([0.0, 2.0, 1.0], secant(0) * 3.0), |d| ([0.0, 1.0, 0.0], d)),
            (_, true) => ends[1].map_or(([1.0, 2.0, 0.0], secant(n - 1) * 3.0), |d| ([0.0, 1.0, 0.0], d)),
            _ => inner_row(secant(i - 1), secant(i), spans[i - 1], spans[i]),
        };
        rows.push(row);
        right.push(value);
    }
    tridiagonal(&rows, &mut right);
    right
}

/// Derivatives of the closed spline; `points` repeat the first one at the end.
pub fn periodic_slopes(points: &[DVec3], spans: &[f64]) -> Vec<DVec3> {
    let n = spans.len();
    let secant = |i: usize| (points[i + 1] - points[i]) / spans[i];
    let (rows, mut right): (Vec<Row>, Vec<DVec3>) = (0..n)
        .map(|i| {
            let before = if i == 0 { n - 1 } else { i - 1 };
            inner_row(secant(before), secant(i), spans[before], spans[i])
        })
        .unzip();
    cyclic(&rows, &mut right);
    right.push(right[0]);
    right
}

fn inner_row(before: DVec3, after: DVec3, h0: f64, h1: f64) -> (Row, DVec3) {
    // Weights of the two secants; the row sums to 3.
    let (a, b) = (h1 / (h0 + h1), h0 / (h0 + h1));
    ([a, 2.0, b], (before * a + after * b) * 3.0)
}

/// The C2 cubic with these points and derivatives on the knots x₀⁴, x₁, …, xₙ⁴.
pub fn through(points: &[DVec3], spans: &[f64], slopes: &[DVec3]) -> Nurbs {
    let n = spans.len();
    let mut x = vec![0.0];
    for h in spans {
        x.push(x[x.len() - 1] + h);
    }
    // Inner Bézier points of span i.
    let bezier = |i: usize| (points[i] + slopes[i] * (spans[i] / 3.0), points[i + 1] - slopes[i + 1] * (spans[i] / 3.0));
    let mut poles: Vec<DVec4> = vec![points[0].extend(1.0), bezier(0).0.extend(1.0)];
    for i in 1..n {
        // The pole of knots x[i-1], x[i], x[i+1]: the blossom of either neighbour; the longer one extrapolates less.
        let (before, after) = (spans[i - 1], spans[i]);
        let pole = if after >= before {
            let (c1, c2) = bezier(i);
            c1 - (c2 - c1) * (before / after)
        } else {
            let (c1, c2) = bezier(i - 1);
            c2 + (c2 - c1) * (after / before)
        };
        poles.push(pole.extend(1.0));
    }
    poles.push(bezier(n - 1).1.extend(1.0));
    poles.push(points[n].extend(1.0));
    let knots = std::iter::repeat_n(x[0], 4).chain(x[1..n].iter().copied()).chain(std::iter::repeat_n(x[n], 4)).collect();
    Nurbs { degree: 3, knots, poles, polynomial: true }
}
