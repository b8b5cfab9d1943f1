//! Curves through or near many points: the interpolating C2 cubic, or one within a tolerance with fewest spans.
//!
//! Within a tolerance: least squares with one span, then a knot where the error is largest, until every point lies within the
//! tolerance; then every knot goes without which that is still so. Parameters are corrected to the nearest places meanwhile.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::job;
use crate::base::math;
use crate::base::origin::Origin;
use crate::geometry::construct::build::{all_different, composite, enough, finite_points};
use crate::geometry::construct::fewest::{finer, swings, turns};
use crate::geometry::construct::spline::{Ends, Spacing, open_slopes, periodic_slopes, through};
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::kind::Kind;
use crate::geometry::shapes::least_squares::{Cubics, DEGREE, Problem};
use crate::geometry::shapes::nurbs::Nurbs;

/// Rounds of correcting parameters for one set of knots.
const ROUNDS: usize = 3;
/// Shares of the way from a datum to the next one at which a curve is looked at.
const BETWEEN: [f64; 3] = [0.25, 0.5, 0.75];
/// Spans of a closed curve to begin with.
const AROUND: usize = 4;

/// Settings of [`fit`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    /// How far the curve may pass from a point, model units; none: through all.
    pub tolerance: Option<f64>,
    /// How a curve through all leaves the first point; none: as the parabola through three points does.
    pub start: Option<Ends>,
    /// How it arrives at the last point.
    pub end: Option<Ends>,
    /// Spacing of the knots of a curve through all.
    pub spacing: Spacing,
    /// Whether it returns to the first point.
    pub closed: bool,
    /// Turns of the data above this angle are kept as corners, radians.
    pub kinks: Option<f64>,
}

/// The curve through or near points.
///
/// A closed one with corners starts at the first of them. Fails with E402 for too few points, E403 for two neighbours that are one.
pub fn fit(points: &[DVec3], how: &Fit, origin: Origin) -> Result<Curve> {
    finite_points(points, origin)?;
    let closed = how.closed;
    enough(points, if closed { 3 } else { 2 }, if closed { "a closed fit" } else { "a fit" }, origin)?;
    all_different(points, closed, origin)?;
    let n = points.len();
    let at = |i: usize| points[i % n];
    let corner = |i: usize| {
        let (before, after) = (at(i) - at(i + n - 1), at(i + 1) - at(i));
        how.kinks.is_some_and(|least| math::angle_between(before, after) > least)
    };
    let corners: Vec<usize> = if closed { (0..n).filter(|i| corner(*i)).collect() } else { (1..n - 1).filter(|i| corner(*i)).collect() };
    let made = |nurbs: Nurbs| Curve::new(Shape::Nurbs(Arc::new(nurbs)), Kind::Fit, origin);
    let stops: Vec<usize> = match (closed, corners.first()) {
        (true, None) => return Ok(made(ring(points, how))),
        (true, Some(first)) => corners.iter().copied().chain([first + n]).collect(),
        (false, _) => [0].into_iter().chain(corners).chain([n - 1]).collect(),
    };
    let last = stops.len() - 2;
    let pieces = stops.windows(2).enumerate().map(|(k, ends)| {
        let part: Vec<DVec3> = (ends[0]..=ends[1]).map(at).collect();
        let tangents = [how.start.filter(|_| k == 0), how.end.filter(|_| k == last)];
        made(run(&part, how, tangents))
    });
    let pieces: Vec<Curve> = pieces.collect();
    Ok(composite(&pieces, origin)?.of_kind(Kind::Fit))
}

/// Chord lengths between neighbours.
fn chords(points: &[DVec3]) -> Vec<f64> {
    points.windows(2).map(|p| p[0].distance(p[1])).collect()
}

/// Open, without corners.
fn run(points: &[DVec3], how: &Fit, tangents: [Option<Ends>; 2]) -> Nurbs {
    let whole = || {
        let spans = how.spacing.spans(points);
        let [start, end] = tangents.map(|end| end.unwrap_or(Ends::Bessel));
        through(points, &spans, &open_slopes(points, &spans, [start.first(points, &spans), end.last(points, &spans)]))
    };
    how.tolerance.and_then(|tolerance| FitSearch::new(points, tolerance, false).nearest()).unwrap_or_else(whole)
}

/// Closed, without corners.
fn ring(points: &[DVec3], how: &Fit) -> Nurbs {
    let around: Vec<DVec3> = points.iter().chain(points.first()).copied().collect();
    let whole = || {
        let spans = how.spacing.spans(&around);
        through(&around, &spans, &periodic_slopes(&around, &spans))
    };
    how.tolerance.and_then(|tolerance| FitSearch::new(&around, tolerance, true).nearest()).unwrap_or_else(whole)
}

/// Points to come near to; a closed row repeats the first one at its end.
struct FitSearch<'a> {
    points: &'a [DVec3],
    tolerance: f64,
    closed: bool,
    /// How much the points turn.
    turns: Vec<f64>,
}

/// A curve with the parameters of the points on it and how far it is from each.
struct FittedSpline {
    cubics: Cubics,
    curve: Nurbs,
    parameters: Vec<f64>,
    off: Vec<f64>,
}

impl<'a> FitSearch<'a> {
    fn new(points: &'a [DVec3], tolerance: f64, closed: bool) -> Self {
        Self { points, tolerance, closed, turns: turns(points, closed) }
    }

    /// The curve of fewest spans that was found within the tolerance; none where it would need as many as there are points.
    fn nearest(&self) -> Option<Nurbs> {
        let mut parameters = vec![0.0];
        for chord in chords(self.points) {
            parameters.push(parameters[parameters.len() - 1] + chord);
        }
        let length = parameters[parameters.len() - 1];
        let spans = if self.closed { AROUND } else { 1 };
        let breaks = (0..=spans).map(|i| length * i as f64 / spans as f64).collect();
        let mut found = self.best(Cubics { breaks, closed: self.closed, degree: DEGREE }, &parameters)?;
        while !self.is_near(&found) {
            job::poll();
            let more = finer(&found.cubics.breaks, &found.parameters, &found.off);
            let next = more
                .map(|breaks| Cubics { breaks, closed: self.closed, degree: DEGREE })
                .find_map(|cubics| self.best(cubics, &found.parameters));
            found = next?;
        }
        Some(self.spared(found).curve)
    }

    /// Whether all data are within the tolerance, and nothing swings out between them.
    fn is_near(&self, found: &FittedSpline) -> bool {
        found.off.iter().all(|off| *off <= self.tolerance) && self.is_calm(found)
    }

    /// Whether it runs near the chords between the data, as far as these let it.
    fn is_calm(&self, found: &FittedSpline) -> bool {
        let turns = &self.turns;
        let calm = |k: usize| {
            let (a, b, turn) = (self.points[k], self.points[k + 1], turns[k].max(turns[k + 1]));
            let (s, t) = (found.parameters[k], found.parameters[k + 1]);
            BETWEEN.iter().all(|f| !swings(found.curve.jet(s + (t - s) * f).p, a.lerp(b, *f), turn, self.tolerance))
        };
        (0..turns.len() - 1).all(calm)
    }

    /// Without the knots that are not needed.
    fn spared(&self, mut found: FittedSpline) -> FittedSpline {
        let least = if self.closed { 2 } else { 1 };
        let mut i = 1;
        while i + 1 < found.cubics.breaks.len() && found.cubics.breaks.len() - 1 > least {
            job::poll();
            let mut fewer = found.cubics.clone();
            fewer.breaks.remove(i);
            match self.best(fewer, &found.parameters).filter(|other| self.is_near(other)) {
                Some(other) => found = other,
                None => i += 1,
            }
        }
        found
    }

    /// Least squares with parameters corrected; the best of the rounds.
    fn best(&self, cubics: Cubics, parameters: &[f64]) -> Option<FittedSpline> {
        let mut found = self.solved(cubics, parameters.to_vec())?;
        let largest = |found: &FittedSpline| found.off.iter().copied().fold(0.0, f64::max);
        for _ in 0..ROUNDS {
            if self.is_near(&found) {
                break;
            }
            let Some(better) = self.corrected(&found).and_then(|moved| self.solved(found.cubics.clone(), moved)) else { break };
            if largest(&better) >= largest(&found) {
                break;
            }
            found = better;
        }
        Some(found)
    }

    fn solved(&self, cubics: Cubics, parameters: Vec<f64>) -> Option<FittedSpline> {
        // The last point of a closed row is the first one again.
        let used = parameters.len() - usize::from(self.closed);
        let mut poles = Problem::new(&cubics, &parameters[..used])?.solve(&self.points[..used]);
        if self.closed {
            let n = poles.len();
            poles.extend((0..DEGREE).map(|k| poles[k % n]).collect::<Vec<_>>());
        }
        let poles = poles.iter().map(|p| p.extend(1.0)).collect();
        let (first, last) = (cubics.breaks[0], cubics.breaks[cubics.breaks.len() - 1]);
        let curve = Nurbs::new(DEGREE, cubics.knots(), poles);
        let curve = if self.closed { curve.part(first, last) } else { curve };
        let off = parameters.iter().zip(self.points).map(|(t, p)| curve.jet(*t).p.distance(*p)).collect();
        Some(FittedSpline { cubics, curve, parameters, off })
    }

    /// Parameters a Newton step nearer to the feet of the points; none where they would change their order.
    fn corrected(&self, found: &FittedSpline) -> Option<Vec<f64>> {
        let n = found.parameters.len();
        let moved = |i: usize| {
            let t = found.parameters[i];
            if i == 0 || i + 1 == n {
                return t;
            }
            let jet = found.curve.jet(t);
            let off = self.points[i] - jet.p;
            let bend = jet.d1.length_squared() - off.dot(jet.d2);
            if bend > 0.0 { t + off.dot(jet.d1) / bend } else { t }
        };
        let moved: Vec<f64> = (0..n).map(moved).collect();
        moved.windows(2).all(|t| t[0] < t[1]).then_some(moved)
    }
}
