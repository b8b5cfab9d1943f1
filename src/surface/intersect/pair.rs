//! Two patches: places on both, the way on from one to the next.

use glam::{DMat4, DVec2, DVec3, DVec4};

use crate::base::tolerance::{EPSILON, NUDGE, SINGULAR};
use crate::surface::closest::foot::{self, FootSearch};
use crate::surface::data::jet::Jet2;
use crate::surface::intersect::sheet::{BorderLine, Patch, solved};

/// A place on both patches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    pub a: DVec2,
    pub b: DVec2,
    pub p: DVec3,
    /// Unit direction in which they meet, in the sense of the march; the chord's where they touch.
    pub way: DVec3,
    /// Sine of the angle between them.
    pub sine: f64,
}

/// Two patches that may meet.
pub(crate) struct Pair<'a> {
    pub a: &'a Patch,
    pub b: &'a Patch,
    /// The model's tolerance.
    pub point: f64,
}

/// Share of the tolerance within which a place is on both.
pub(super) const EXACT: f64 = 1.0 / 1024.0;
/// Two points are one when they are no farther apart than so many roundings.
const ROUNDINGS: f64 = 16.0;
/// Newton steps.
const STEPS: usize = 24;
/// Longest Newton step, as a share of the domain.
const LEAP: f64 = 0.25;

impl Pair<'_> {
    fn jets(&self, a: DVec2, b: DVec2) -> (Jet2, Jet2) {
        (self.a.jet(a), self.b.jet(b))
    }

    /// The place with its direction, when the two points are one.
    fn spot(&self, a: DVec2, b: DVec2) -> Option<Spot> {
        let (s, t) = self.jets(a, b);
        let close = s.p.distance(t.p) <= (EXACT * self.point).max(EPSILON * s.p.abs().max_element());
        let unit = |j: &Jet2| j.du.cross(j.dv).normalize_or_zero();
        let way = unit(&s).cross(unit(&t));
        close.then(|| Spot { a, b, p: (s.p + t.p) * 0.5, way: way.normalize_or_zero(), sine: way.length() })
    }

    /// The common place near two others: on a plane through a point with a normal, or the nearest one.
    pub fn correct(&self, a: DVec2, b: DVec2, plane: Option<(DVec3, DVec3)>) -> Option<Spot> {
        let (mut a, mut b) = (a, b);
        let mut held = false;
        for _ in 0..STEPS {
            let (s, t) = self.jets(a, b);
            let (p, n) = plane.unwrap_or_else(|| {
                let way = s.du.cross(s.dv).normalize_or_zero().cross(t.du.cross(t.dv).normalize_or_zero());
                (s.p, way.normalize_or_zero())
            });
            let m = DMat4::from_cols(s.du.extend(s.du.dot(n)), s.dv.extend(s.dv.dot(n)), (-t.du).extend(0.0), (-t.dv).extend(0.0));
            let step: DVec4 = m.inverse() * (t.p - s.p).extend((p - s.p).dot(n));
            if !step.is_finite() {
                return None;
            }
            let leap = step.abs().max_element() / LEAP;
            let step = if leap > 1.0 { step / leap } else { step };
            let (free_a, free_b) = (a + DVec2::new(step.x, step.y), b + DVec2::new(step.z, step.w));
            let (next_a, next_b) = (self.a.hold(free_a), self.b.hold(free_b));
            held = (next_a - free_a).abs().max_element().max((next_b - free_b).abs().max_element()) > NUDGE * NUDGE;
            let moved = (next_a - a).abs().max_element().max((next_b - b).abs().max_element());
            (a, b) = (next_a, next_b);
            if moved <= EPSILON {
                break;
            }
        }
        let found = self.spot(a, b)?;
        // Within the tolerance of a place beyond a border is on neither line: one goes on beyond, the other not.
        if held && !self.exact(&found) {
            return None;
        }
        // Held back at a border it may be on both and yet not where it was to be.
        let there = plane.is_none_or(|(p, n)| (found.p - p).dot(n).abs() <= self.point);
        there.then_some(found)
    }

    /// Whether the two points of a place are one but for rounding.
    fn exact(&self, spot: &Spot) -> bool {
        self.a.jet(spot.a).p.distance(self.b.jet(spot.b).p) <= ROUNDINGS * EPSILON * spot.p.abs().max_element()
    }

    /// The place where the common line leaves one patch over a border: `first` says which patch the line belongs to.
    pub fn on_border(&self, first: bool, line: BorderLine, a: DVec2, b: DVec2) -> Option<Spot> {
        let (own, other) = if first { (self.a, self.b) } else { (self.b, self.a) };
        let (x, y) = if first { (a, b) } else { (b, a) };
        let (mut x, mut y) = (own.hold(line.onto(x)), other.hold(y));
        let along = line.along();
        // Where they only touch steps may lead away from the best place again.
        let mut best = (f64::INFINITY, x, y);
        for _ in 0..STEPS {
            let (s, t) = (own.jet(x), other.jet(y));
            let gap = s.p.distance_squared(t.p);
            if gap < best.0 {
                best = (gap, x, y);
            }
            let run = s.du * along.x + s.dv * along.y;
            if run.length() <= SINGULAR * (s.du.length() + s.dv.length()) {
                // A pole: one point, whatever the place on the line.
                best = (0.0, x, other.foot(s.p, y).0);
                break;
            }
            let step = solved(run, -t.du, -t.dv, t.p - s.p)?;
            let clamp = |d: f64| d.clamp(-LEAP, LEAP);
            let next = own.hold(x + along * clamp(step.x));
            let there = other.hold(y + DVec2::new(clamp(step.y), clamp(step.z)));
            let moved = (next - x).abs().max_element().max((there - y).abs().max_element());
            (x, y) = (line.onto(next), there);
            if moved <= EPSILON {
                best = (0.0, x, y);
                break;
            }
        }
        let (_, x, y) = best;
        let (a, b) = if first { (x, y) } else { (y, x) };
        self.spot(a, b)
    }

    /// Sine of the angle between the common line and a border at a place on both.
    pub fn rise(&self, first: bool, line: BorderLine, spot: &Spot) -> f64 {
        let (own, uv) = if first { (self.a, spot.a) } else { (self.b, spot.b) };
        let (jet, along) = (own.jet(uv), line.along());
        (jet.du * along.x + jet.dv * along.y).normalize_or_zero().cross(spot.way).length()
    }

    /// Whether a place is on a border but for what may part the two points of a place: a line that leaves there over a pole has no other end.
    pub fn is_at(&self, first: bool, line: BorderLine, spot: &Spot) -> bool {
        let (own, uv) = if first { (self.a, spot.a) } else { (self.b, spot.b) };
        own.jet(own.hold(line.onto(uv))).p.distance(spot.p) <= EXACT * self.point
    }

    /// Where a step along a direction leads in both domains, to first order; `None` where a patch is singular.
    pub fn ahead(&self, at: &Spot, step: DVec3) -> Option<(DVec2, DVec2)> {
        let (s, t) = self.jets(at.a, at.b);
        Some((at.a + foot::step(s.du, s.dv, step)?, at.b + foot::step(t.du, t.dv, step)?))
    }
}
