//! Corners of curves made round by arcs or cut straight.
//!
//! The arc of a corner touches the two sides that meet there. Its centre is where the sides' offsets meet, followed from
//! the corner (radius 0) outwards: so it is the one of this corner, and where the way ends the largest radius is known.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::base::fault::{LengthRange, Result, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, NEAREST, NUDGE, ROUNDING_SHARE};
use crate::geometry::construct::build::{all_different, composite, enough, finite, finite_points};
use crate::geometry::construct::offset_build::{height_over, smooth_pieces};
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::corner_fault::CornerFault;
use crate::geometry::data::kind::Kind;
use crate::geometry::shapes::arc::EllipticArc;

/// Steps of the radius from nothing to the wanted one, where nothing hinders.
const STEPS: f64 = 8.0;
/// Largest share of a side that one step runs over.
const STRIDE: f64 = 0.125;
/// Newton steps towards a centre.
const ROUNDS: usize = 12;
/// Halvings of the interval that holds the largest size of a corner.
const HALVINGS: usize = 48;

/// What a corner becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Treatment {
    /// An arc of this radius that touches both sides, model units.
    Round(f64),
    /// A straight cut that takes this length off each side, model units.
    Cut(f64),
}

impl Treatment {
    fn size(self) -> f64 {
        match self {
            Self::Round(size) | Self::Cut(size) => size,
        }
    }

    fn sized(self, size: f64) -> Self {
        match self {
            Self::Round(_) => Self::Round(size),
            Self::Cut(_) => Self::Cut(size),
        }
    }
}

/// Straight segments through points, each corner rounded by an arc in the plane of its two sides.
///
/// A closed one starts where the arc of the first corner ends. E414 where the radius does not fit; `argument` names it.
pub fn rounded_polyline(points: &[DVec3], closed: bool, round: (f64, &'static str), origin: Origin) -> Result<Curve> {
    finite_points(points, origin)?;
    enough(points, if closed { 3 } else { 2 }, if closed { "a closed polyline" } else { "a polyline" }, origin)?;
    all_different(points, closed, origin)?;
    positive(round.0, round.1, origin)?;
    let around: Vec<DVec3> = points.iter().chain(points.first().filter(|_| closed)).copied().collect();
    let sides = around.windows(2).map(|p| Curve::new(Shape::Line(p[0], p[1]), Kind::Line, origin)).collect();
    let plan = Plan { sides, closed, treatment: Treatment::Round(round.0), argument: round.1, origin };
    let corners = plan.corners();
    Ok(plan.treated(&corners)?.of_kind(Kind::Polyline))
}

/// The corners of a curve at these places, or all of them, rounded or cut.
///
/// A closed curve whose first corner is treated starts where the new piece there ends. `argument` names the size. E414 where the
/// size does not fit, E415 where the curve has no corner, E416 where the sides of a corner to be rounded leave its plane.
pub fn treat(curve: &Curve, at: Option<&[DVec3]>, how: (Treatment, &'static str), origin: Origin) -> Result<Curve> {
    positive(how.0.size(), how.1, origin)?;
    let size = curve.bbox().diagonal();
    let closed = curve.start().distance(curve.end()) <= NEAREST * size;
    let plan = Plan { sides: sides_of(curve)?, closed, treatment: how.0, argument: how.1, origin };
    let all = plan.corners();
    let chosen = match at {
        None => all,
        Some(places) => plan.chosen(&all, places, NUDGE * size)?,
    };
    if chosen.is_empty() {
        return Err(CornerFault::NoCorner { of: curve.origin(), at: None, nearest: None }.into());
    }
    if matches!(how.0, Treatment::Round(_)) {
        chosen.iter().try_for_each(|corner| plan.check_plane(corner, size))?;
    }
    plan.treated(&chosen)
}

fn positive(size: f64, argument: &'static str, origin: Origin) -> Result<()> {
    finite(DVec3::splat(size), argument, origin)?;
    if size > 0.0 {
        return Ok(());
    }
    Err(ValueFault::LengthOutside { argument, found: size, range: LengthRange::Positive }.into())
}

/// The runs of a curve between its corners.
fn sides_of(curve: &Curve) -> Result<Vec<Curve>> {
    let mut runs: Vec<Vec<Curve>> = Vec::new();
    for piece in smooth_pieces(curve) {
        match runs.last_mut() {
            Some(run) if run.last().is_some_and(|before| turn(before, &piece) <= NUDGE) => run.push(piece),
            _ => runs.push(vec![piece]),
        }
    }
    runs.iter().map(|run| composite(run, curve.origin())).collect()
}

/// Angle by which the direction turns from the end of one curve to the start of the next.
fn turn(before: &Curve, after: &Curve) -> f64 {
    math::angle_between(arriving(before), leaving(after))
}

fn arriving(side: &Curve) -> DVec3 {
    side.directions(side.domain().1).0
}

fn leaving(side: &Curve) -> DVec3 {
    side.directions(side.domain().0).1
}

/// A corner between two neighbouring sides.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// The side that ends here and the one that starts here.
    sides: (usize, usize),
    at: DVec3,
    /// Unit normal seen against which the curve turns left; none where it turns straight back.
    normal: Option<DVec3>,
    /// By how much it turns, radians, above 0.
    turn: f64,
}

/// The sides of a curve and what is wanted of its corners.
struct Plan {
    sides: Vec<Curve>,
    closed: bool,
    treatment: Treatment,
    argument: &'static str,
    origin: Origin,
}

impl Plan {
    fn corners(&self) -> Vec<Corner> {
        let n = self.sides.len();
        let pairs = (0..n).map(|i| (i, (i + 1) % n)).take(if self.closed { n } else { n - 1 });
        let corners = pairs.map(|(i, k)| {
            let (a, b) = (arriving(&self.sides[i]).normalize(), leaving(&self.sides[k]).normalize());
            let normal = math::unit(a.cross(b), NUDGE);
            Corner { sides: (i, k), at: self.sides[i].end(), normal, turn: math::angle_between(a, b) }
        });
        corners.filter(|corner| corner.turn > NUDGE).collect()
    }

    /// The corners at these places, in the order of the curve.
    fn chosen(&self, all: &[Corner], places: &[DVec3], reach: f64) -> Result<Vec<Corner>> {
        let mut taken = vec![false; all.len()];
        for p in places {
            let nearest = (0..all.len()).min_by(|i, k| all[*i].at.distance(*p).total_cmp(&all[*k].at.distance(*p)));
            match nearest {
                Some(i) if all[i].at.distance(*p) <= reach => taken[i] = true,
                _ => return Err(CornerFault::NoCorner { of: self.origin, at: Some(*p), nearest: nearest.map(|i| all[i].at) }.into()),
            }
        }
        Ok(all.iter().zip(taken).filter_map(|(corner, taken)| taken.then_some(*corner)).collect())
    }

    /// E416: an arc lies in a plane, so both sides must.
    fn check_plane(&self, corner: &Corner, size: f64) -> Result<()> {
        let Some(normal) = corner.normal else { return Ok(()) };
        for i in [corner.sides.0, corner.sides.1] {
            let out = height_over(&self.sides[i], normal);
            if out > NUDGE * size {
                return Err(CornerFault::NotFlat { of: self.origin, at: corner.at, out }.into());
            }
        }
        Ok(())
    }

    /// Parameters on both sides where the new piece of a corner begins and ends; none where it does not fit them.
    fn ends(&self, corner: &Corner, treatment: Treatment) -> Option<(f64, f64)> {
        let (a, b) = (&self.sides[corner.sides.0], &self.sides[corner.sides.1]);
        let back = |length: f64| {
            let slack = 1.0 + NEAREST * EPSILON.sqrt();
            let fits = length <= a.length() * slack && length <= b.length() * slack;
            fits.then(|| (a.param_at_length(a.length() - length), b.param_at_length(length)))
        };
        match treatment {
            Treatment::Cut(length) => back(length),
            Treatment::Round(radius) => {
                let normal = corner.normal?;
                match (a.shape(), b.shape()) {
                    (Shape::Line(..), Shape::Line(..)) => back(radius * math::tan(0.5 * corner.turn)),
                    _ => Touching { a, b, normal }.reach(radius),
                }
            }
        }
    }

    /// What is left of each side; none where some side is used up.
    fn ranges(&self, corners: &[Corner], treatment: Treatment) -> Option<Vec<(f64, f64)>> {
        let mut ranges: Vec<(f64, f64)> = self.sides.iter().map(Curve::domain).collect();
        for corner in corners {
            let (end, start) = self.ends(corner, treatment)?;
            ranges[corner.sides.0].1 = end;
            ranges[corner.sides.1].0 = start;
        }
        let slack = |side: &Curve| ROUNDING_SHARE * (side.domain().1 - side.domain().0);
        ranges.iter().zip(&self.sides).all(|(r, side)| r.0 <= r.1 + slack(side)).then_some(ranges)
    }

    /// The largest size, not above the wanted one, that fits a corner and those with which it shares a side.
    fn largest(&self, corners: &[Corner], which: usize) -> f64 {
        let own = corners[which].sides;
        let shares = |c: &Corner| [c.sides.0, c.sides.1].iter().any(|s| *s == own.0 || *s == own.1);
        let near: Vec<Corner> = corners.iter().filter(|c| shares(c)).copied().collect();
        let (mut low, mut high) = (0.0, self.treatment.size());
        if self.ranges(&near, self.treatment).is_some() {
            return high;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.ranges(&near, self.treatment.sized(middle)).is_some() { low = middle } else { high = middle }
        }
        low
    }

    fn treated(&self, corners: &[Corner]) -> Result<Curve> {
        let Some(ranges) = self.ranges(corners, self.treatment) else {
            let sizes = (0..corners.len()).map(|i| (self.largest(corners, i), corners[i].at));
            let (largest, at) = sizes.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, DVec3::ZERO));
            let fault = CornerFault::TooNarrow { of: self.origin, argument: self.argument, wanted: self.treatment.size(), largest, at };
            return Err(fault.into());
        };
        let mut pieces = Vec::new();
        for (i, (side, (from, to))) in self.sides.iter().zip(&ranges).enumerate() {
            let (a, b) = side.domain();
            if to - from > ROUNDING_SHARE * (b - a) {
                pieces.push(side.part(*from, *to));
            }
            if let Some(corner) = corners.iter().find(|c| c.sides.0 == i) {
                pieces.push(self.piece(corner, (*to, ranges[corner.sides.1].0)));
            }
        }
        match pieces.as_slice() {
            [one] => Ok(one.with_origin(self.origin)),
            _ => Ok(Curve::new(Shape::Composite(Arc::new(Composite::new(pieces))), Kind::Composite, self.origin)),
        }
    }

    /// The arc or the cut between a parameter of each side.
    fn piece(&self, corner: &Corner, (ta, tb): (f64, f64)) -> Curve {
        let (a, b) = (&self.sides[corner.sides.0], &self.sides[corner.sides.1]);
        let (p, q) = (a.point(ta), b.point(tb));
        match (self.treatment, corner.normal) {
            (Treatment::Round(radius), Some(normal)) => {
                let (start, end) = (a.directions(ta).0.normalize(), b.directions(tb).1.normalize());
                let (u, v) = (start.cross(normal) * radius, start * radius);
                let sweep = math::atan2(start.cross(end).dot(normal), start.dot(end));
                let arc = EllipticArc { center: p - u, u, v, sweep, radius: Some(radius) };
                Curve::new(Shape::Arc(Box::new(arc)), Kind::Arc, self.origin)
            }
            _ => Curve::new(Shape::Line(p, q), Kind::Line, self.origin),
        }
    }
}

/// Two sides in a plane, from the corner between them.
struct Touching<'a> {
    a: &'a Curve,
    b: &'a Curve,
    normal: DVec3,
}

/// A point at a distance to the left of a curve, in the plane, and how it moves.
struct Beside {
    p: DVec2,
    by_t: DVec2,
    left: DVec2,
    /// 1 less distance times curvature: above 0 as long as the offset runs with its curve.
    factor: f64,
}

impl Touching<'_> {
    /// Where a circle of this radius touches both sides, followed from the corner; none where the way ends before.
    fn reach(&self, radius: f64) -> Option<(f64, f64)> {
        let (first, last) = (self.a.domain(), self.b.domain());
        let (mut at, mut r) = ((first.1, last.0), 0.0);
        let mut step = radius / STEPS;
        let slack = (ROUNDING_SHARE * (first.1 - first.0), ROUNDING_SHARE * (last.1 - last.0));
        while r < radius {
            let next = if radius - r <= step { radius } else { r + step };
            let near = |found: &(f64, f64)| {
                let stride = ((found.0 - at.0) / (first.1 - first.0)).abs().max(((found.1 - at.1) / (last.1 - last.0)).abs());
                stride <= STRIDE && found.0 >= first.0 - slack.0 && found.1 <= last.1 + slack.1
            };
            match self.newton(at, (r, next)).filter(near) {
                Some(found) => {
                    (at, r) = ((found.0.max(first.0), found.1.min(last.1)), next);
                    step *= 2.0;
                }
                None => step *= 0.5,
            }
            if step < ROUNDING_SHARE * radius {
                return None;
            }
        }
        Some(at)
    }

    /// From the place at one radius to that at another one.
    fn newton(&self, (mut ta, mut tb): (f64, f64), (from, to): (f64, f64)) -> Option<(f64, f64)> {
        let across = arriving(self.a).normalize();
        let plane = (across, self.normal.cross(across));
        let scale = to + self.a.bbox().diagonal().min(self.b.bbox().diagonal());
        let mut radius = from;
        for round in 0..ROUNDS {
            let (a, b) = (self.beside(self.a, ta, radius, plane), self.beside(self.b, tb, radius, plane));
            if a.factor <= 0.0 || b.factor <= 0.0 {
                return None;
            }
            // At the old radius the first step follows the change of radius, later ones correct what is left.
            let miss = if round == 0 { (a.left - b.left) * (to - from) } else { a.p - b.p };
            if round > 0 && miss.length() <= EPSILON * scale {
                return Some((ta, tb));
            }
            radius = to;
            let det = a.by_t.perp_dot(b.by_t);
            if det.abs() <= EPSILON * a.by_t.length() * b.by_t.length() {
                return None;
            }
            ta += miss.perp_dot(b.by_t) / -det;
            tb += miss.perp_dot(a.by_t) / -det;
        }
        let (a, b) = (self.beside(self.a, ta, to, plane), self.beside(self.b, tb, to, plane));
        ((a.p - b.p).length() <= NEAREST * scale * NEAREST.sqrt()).then_some((ta, tb))
    }

    fn beside(&self, side: &Curve, t: f64, distance: f64, (x, y): (DVec3, DVec3)) -> Beside {
        let (first, last) = side.domain();
        // Just outside its domain a side is continued straight.
        let inside = t.clamp(first, last);
        let jet = side.jet(inside);
        let flat = |v: DVec3| DVec2::new(v.dot(x), v.dot(y));
        let d1 = flat(jet.d1);
        let speed = d1.length();
        let left = d1.perp() / speed;
        let factor = 1.0 - distance * d1.perp_dot(flat(jet.d2)) / (speed * speed * speed);
        Beside { p: flat(jet.p) + d1 * (t - inside) + left * distance, by_t: d1 * factor, left, factor }
    }
}
