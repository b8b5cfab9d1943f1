//! One side of the section of a surface of revolution over an interval of its profile, as cubics.

use glam::{DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::solve::bracketed;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::geometry::Nurbs;
use crate::surface::intersect::fit_branch::SHARE;
use crate::surface::intersect::turned_spans::{EndKind, Place, Section, Span};
use crate::surface::trims::project::{Landing, cubics};

/// Intervals between two breaks of the profile to begin with.
const FIRST: usize = 8;
/// Largest angle between a chord and the curve at its ends, as a cosine.
const TURN: f64 = 0.95;
/// Halvings of an interval at most.
const HALVINGS: usize = 48;

/// A place of the curve: where on the profile, where in the plane, unit directions before and after it.
#[derive(Clone, Copy)]
struct Spot {
    v: f64,
    at: DVec2,
    ways: [DVec2; 2],
}

/// One side of an interval.
struct Branch<'a> {
    section: &'a Section,
    span: &'a Span,
    /// Sign of y.
    side: f64,
}

/// Cubics within a quarter of the tolerance of one side (the sign of y) of a section over an interval, in space. `None` where its
/// direction could not be told.
pub(super) fn fitted(
    section: &Section,
    span: &Span,
    side: f64,
    placed: &dyn Fn((f64, f64)) -> DVec3,
    lost: &dyn Fn(DVec3) -> Fault,
    tolerance: &Tolerance,
) -> Result<Option<Vec<Nurbs>>> {
    let branch = Branch { section, span, side };
    let spots = branch.spots(tolerance);
    if spots.iter().any(|spot| spot.ways.contains(&DVec2::ZERO)) {
        return Ok(None);
    }
    let stops: Vec<f64> = (0..spots.len()).map(|k| k as f64).collect();
    let land = |f: f64, _: Option<DVec2>, before: bool| {
        let k = if before { f.ceil() as usize } else { f.floor() as usize + 1 }.clamp(1, spots.len() - 1);
        let (at, d1) = branch.between(&spots[k - 1], &spots[k], f - (k - 1) as f64);
        let p = placed((at.x, at.y));
        Ok(Landing { uv: at, p, d1: placed((at.x + d1.x, at.y + d1.y)) - p })
    };
    cubics(&stops, SHARE * tolerance.point, land, lost).map(Some)
}

impl Branch<'_> {
    /// y², with the residuals at the ends taken off in proportion, so that it is 0 there.
    fn square(&self, v: f64, place: &Place) -> f64 {
        let [from, to] = &self.span.ends;
        let share = (v - from.v) / (to.v - from.v);
        (place.g - from.residual * (1.0 - share) - to.residual * share).max(0.0)
    }

    fn at(&self, v: f64, place: &Place) -> DVec2 {
        DVec2::new(place.s, self.side * self.square(v, place).sqrt())
    }

    /// The unit tangent of the curve, for growing v.
    fn way(&self, v: f64, place: &Place) -> DVec2 {
        let [from, to] = &self.span.ends;
        // At a node both derivatives vanish; beside it y is the root of the second one.
        for (end, sign) in [(from, 1.0), (to, -1.0)] {
            if end.v == v && end.kind == EndKind::Node {
                return DVec2::new(place.rise / self.section.b, self.side * sign * place.bend.max(0.0).sqrt()).normalize_or_zero();
            }
        }
        let y = if [from, to].iter().any(|end| end.v == v && end.kind == EndKind::Turn) { 0.0 } else { self.square(v, place).sqrt() };
        DVec2::new(place.rise * y, 0.5 * self.side * self.section.b * place.slope).normalize_or_zero()
    }

    fn spot(&self, v: f64) -> Spot {
        let (after, before) = (self.section.place(v), self.section.place_before(v));
        Spot { v, at: self.at(v, &after), ways: [self.way(v, &before), self.way(v, &after)] }
    }

    /// Places so near to each other that the curve turns little from one to the next.
    fn spots(&self, tolerance: &Tolerance) -> Vec<Spot> {
        let [from, to] = &self.span.ends;
        let stops = [&[from.v][..], &self.span.breaks, &[to.v]].concat();
        let mut out = vec![self.spot(from.v)];
        for w in stops.windows(2) {
            job::poll();
            let inner = (1..FIRST).map(|k| w[0] + (w[1] - w[0]) * k as f64 / FIRST as f64);
            for v in inner.chain([w[1]]) {
                self.halved(self.spot(v), &mut out, HALVINGS, tolerance);
            }
        }
        out
    }

    /// Adds the places up to one.
    fn halved(&self, to: Spot, out: &mut Vec<Spot>, left: usize, tolerance: &Tolerance) {
        let from = out[out.len() - 1];
        let chord = to.at - from.at;
        let straight = |way: DVec2| way.dot(chord) >= TURN * chord.length();
        if left > 0 && chord.length() > tolerance.point && !(straight(from.ways[1]) && straight(to.ways[0])) {
            let middle = self.crossing(&from, &to, 0.5);
            if middle > from.v && middle < to.v {
                self.halved(self.spot(middle), out, left - 1, tolerance);
                self.halved(to, out, left - 1, tolerance);
                return;
            }
        }
        out.push(to);
    }

    /// The place of the profile at which the curve crosses the line across a chord at a share of it.
    fn crossing(&self, from: &Spot, to: &Spot, share: f64) -> f64 {
        let chord = to.at - from.at;
        let level = share * chord.length_squared();
        bracketed(from.v, to.v, EPSILON, |v| {
            let place = self.section.place(v);
            let at = self.at(v, &place);
            let rate = DVec2::new(place.rise / self.section.b, 0.5 * place.slope / at.y);
            ((at - from.at).dot(chord) - level, rate.dot(chord))
        })
    }

    /// Place and derivative at a share of the chord between two places, by that share.
    fn between(&self, from: &Spot, to: &Spot, share: f64) -> (DVec2, DVec2) {
        let chord = to.at - from.at;
        let (at, way) = if share <= 0.0 {
            (from.at, from.ways[1])
        } else if share >= 1.0 {
            (to.at, to.ways[0])
        } else {
            let v = self.crossing(from, to, share);
            let place = self.section.place(v);
            (self.at(v, &place), self.way(v, &place))
        };
        let run = way.dot(chord);
        if run <= 0.5 * chord.length() {
            return (at, chord);
        }
        let d1 = way * (chord.length_squared() / run);
        // Near a turn the profile tells the place along the curve to half of its digits, and across it to all of them.
        (at + d1 * (share - (at - from.at).dot(chord) / chord.length_squared()), d1)
    }
}
