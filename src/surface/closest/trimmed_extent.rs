//! The box that a trimmed surface just fits into.
//!
//! A coordinate is largest on a border, or inside where no derivative of it leads further: in the surface's cells where both may
//! vanish, on the lines between cells where the one along the line may, or where such lines meet. Rectangles that can have no such
//! place, or lie outside the borders, are left out; the others are halved.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::range::Interval3;
use crate::base::tolerance::{BOX, EPSILON, SLIVER};
use crate::base::{job, work};
use crate::network::Chain;
use crate::surface::closest::boxed::{Boxed, MOST, Sample, UvBox, extremes, halves};
use crate::surface::closest::curve_extent::curve_bbox_between;
use crate::surface::closest::samples::stations;
use crate::surface::core::surface::Surface;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::kind::Domain;
use crate::surface::rails::side::Side;

/// The smallest box along the axes that holds a trimmed surface: no point of it, nor of its borders, stands out by more than [`BOX`]
/// of the diagonal.
pub(crate) fn trimmed_bbox(surface: &Surface) -> Boxed {
    let borders: Vec<BorderCurve> = (0..surface.n_sides()).filter_map(|k| BorderCurve::of(surface, k)).collect();
    let mut bounds = borders.iter().fold(Boxed::of(Box3::EMPTY), |bounds, border| match border {
        BorderCurve::Chain(chain, (from, to), _) => bounds.and(curve_bbox_between(chain, *from, *to)),
        BorderCurve::Line(a, b) => line_bbox(surface, *a, *b, bounds),
    });
    if surface.is_flat() {
        return bounds;
    }
    let base = surface.untrimmed();
    let (us, vs) = base.cells();
    let (xs, ys) = (stations(&us), stations(&vs));
    let jets = base.square_jets(&xs, &ys);
    let samples = (0..jets.len()).map(|k| ((xs[k % xs.len()], ys[k / xs.len()]), jets[k].p));
    let kept = |place: (f64, f64)| base.from_square(place.0, place.1);
    let samples: Vec<Sample> = samples.filter(|sample| surface.keeps(kept(sample.0).0, kept(sample.0).1)).collect();
    for (place, p) in extremes(&base, &samples) {
        let (u, v) = kept(place);
        if stands_out(&bounds.bounds, p) && surface.holds(u, v) {
            bounds = bounds.with(p);
        }
    }
    ExtentSearch { surface, base: &base, borders: &borders }.grown(bounds, (&us, &vs))
}

/// Evaluations for telling which side of the borders places are on, after which what is left counts by its bound: loops of damaged files
/// jump from place to place, and each place beside a jump takes thousands.
const MOST_WORK: u64 = 4_000_000;

fn stands_out(bounds: &Box3, p: DVec3) -> bool {
    (bounds.min - p).max(p - bounds.max).max_element() > 0.0
}

/// What a border of a trimmed surface is.
enum BorderCurve {
    /// A curve between two of its fractions, in a box in (u, v).
    Chain(Chain, (f64, f64), (DVec2, DVec2)),
    /// A straight line in (u, v).
    Line(DVec2, DVec2),
}

impl BorderCurve {
    fn of(surface: &Surface, k: usize) -> Option<Self> {
        match surface.side(k) {
            Side::Chain { chain, from, to } => Some(Self::Chain(chain, (from.min(to), from.max(to)), course_box(surface, k))),
            _ => surface.border_line(k).map(|(a, b)| Self::Line(a.into(), b.into())),
        }
    }
}

/// A box in (u, v) about what a border runs through: about its places, and farther by the longest step between them.
fn course_box(surface: &Surface, k: usize) -> (DVec2, DVec2) {
    let places = surface.parts().trim.as_ref().map_or_else(Vec::new, |trim| trim.trim_curves[k].places());
    let step = places.windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
    let low = places.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = places.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    (low - step, high + step)
}

/// Grows a box by that of a straight line in (u, v), by branch and bound.
fn line_bbox(surface: &Surface, a: DVec2, b: DVec2, mut bounds: Boxed) -> Boxed {
    // Where the surface closes a line may run over its seam.
    let mut cuts: Vec<f64> = [(a.x, b.x), (a.y, b.y)].into_iter().flat_map(|(a, b)| seams(a, b)).collect();
    cuts.sort_by(f64::total_cmp);
    let stops = [&[0.0], &cuts[..], &[1.0]].concat();
    let mut open: VecDeque<(DVec2, DVec2)> = stops.windows(2).map(|w| (a.lerp(b, w[0]), a.lerp(b, w[1]))).collect();
    let mut seen = 0;
    while let Some((a, b)) = open.pop_front() {
        job::poll();
        bounds = bounds.and(Box3::of([a, b].map(|uv| surface.point(uv.x, uv.y))));
        let hull = spread_between(surface, a, b).p.bounds();
        let over = (hull.max - bounds.bounds.max).max(bounds.bounds.min - hull.min).max_element();
        if over <= BOX * bounds.bounds.diagonal() {
            continue;
        }
        seen += 1;
        if seen > MOST || a.distance(b) <= EPSILON {
            bounds = bounds.held_by(hull);
            continue;
        }
        let middle = a.lerp(b, 0.5);
        open.extend([(a, middle), (middle, b)]);
    }
    bounds
}

/// Shares of the way from one value to another at which it is whole.
fn seams(a: f64, b: f64) -> Vec<f64> {
    let wholes = (a.min(b).floor() as i64 + 1)..(a.max(b).ceil() as i64);
    wholes.map(|n| (n as f64 - a) / (b - a)).collect()
}

/// Bounds over the rectangle about a straight line in (u, v) that crosses no seam.
fn spread_between(surface: &Surface, a: DVec2, b: DVec2) -> Enclosure {
    let ends = |a: f64, b: f64| {
        let middle = 0.5 * (a + b);
        let turn = if (0.0..=1.0).contains(&middle) { 0.0 } else { middle.floor() };
        ((a.min(b) - SLIVER - turn).clamp(0.0, 1.0), (a.max(b) + SLIVER - turn).clamp(0.0, 1.0))
    };
    surface.enclosure(ends(a.x, b.x), ends(a.y, b.y))
}

struct ExtentSearch<'a> {
    surface: &'a Surface,
    /// The surface below it.
    base: &'a Surface,
    borders: &'a [BorderCurve],
}

impl ExtentSearch<'_> {
    /// The box grown by what of the inside stands out of it.
    fn grown(&self, mut bounds: Boxed, (us, vs): (&[f64], &[f64])) -> Boxed {
        let (closed_u, closed_v) = self.base.closed();
        let lines = |inner: &[f64], closed: bool| if closed { [&[0.0], inner, &[1.0]].concat() } else { inner.to_vec() };
        let (across_u, across_v) = (lines(us, closed_u), lines(vs, closed_v));
        for (u, v) in across_v.iter().flat_map(|v| across_u.iter().map(|u| (*u, *v))) {
            bounds = self.with(bounds, (u, v), self.base.point(u, v));
        }
        let cells = |inner: &[f64]| -> Vec<(f64, f64)> { [&[0.0], inner, &[1.0]].concat().windows(2).map(|w| (w[0], w[1])).collect() };
        // About the lines between cells, narrow ones.
        let thin = |lines: &[f64]| -> Vec<(f64, f64)> { lines.iter().map(|x| ((x - SLIVER).max(0.0), (x + SLIVER).min(1.0))).collect() };
        let all = |us: Vec<(f64, f64)>, vs: Vec<(f64, f64)>| vs.into_iter().flat_map(move |v| us.clone().into_iter().map(move |u| (u, v)));
        let (us, vs) = (cells(us), cells(vs));
        let cells = all(us.clone(), vs.clone()).chain(all(thin(&across_u), vs)).chain(all(us, thin(&across_v)));
        // Each with whether no border is known to run over it.
        let mut open: VecDeque<(UvBox, bool)> = cells.map(|cell| (cell, false)).collect();
        let triangle = self.base.domain() == Domain::Triangle;
        let (room, gap) = (BOX * bounds.bounds.diagonal(), self.surface.gap());
        let (mut seen, mut spent) = (0, 0);
        while let Some(((u, v), clear)) = open.pop_front() {
            job::poll();
            if triangle && u.0 + v.0 >= 1.0 {
                continue;
            }
            let enclosure = self.base.enclosure(u, v);
            let hull = enclosure.p.bounds();
            let out = |grown: &Boxed| (hull.max - grown.bounds.max).max(grown.bounds.min - hull.min);
            let turns = |d: &Enclosure, k: usize| {
                let (du, dv) = (d.du.coordinate(k), d.dv.coordinate(k));
                (du.low <= 0.0 && du.high >= 0.0 || u.1 - u.0 <= 2.0 * SLIVER)
                    && (dv.low <= 0.0 && dv.high >= 0.0 || v.1 - v.0 <= 2.0 * SLIVER)
            };
            let stands = |over: DVec3| (0..3).any(|k| over[k] > room && turns(&enclosure, k));
            if !stands(out(&bounds)) {
                continue;
            }
            if spent > MOST_WORK {
                bounds = bounds.held_by(hull);
                continue;
            }
            let mid = (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
            let (held, units) = work::measured(|| clear || self.surface.holds(mid.0, mid.1));
            spent += units;
            let clear = clear || self.is_clear((u, v), &enclosure, gap);
            // What of so small a rectangle lies inside is as near to a border.
            if !held && (clear || hull.diagonal() <= room) {
                continue;
            }
            if held {
                bounds = bounds.with(enclosure.mid.p);
            }
            let over = out(&bounds);
            if !stands(over) {
                continue;
            }
            seen += 1;
            if seen > MOST || (u.1 - u.0).max(v.1 - v.0) <= EPSILON {
                bounds = bounds.held_by(hull);
                continue;
            }
            // Inside, where the coordinate that stands out most runs most; else the longer way, to see whether a border runs over it.
            let k = (0..3).max_by(|x, y| over[*x].total_cmp(&over[*y])).unwrap_or(0);
            let reach = |d: &Interval3| if clear { d.coordinate(k).reach() } else { d.reach() };
            let along_u = reach(&enclosure.du) * (u.1 - u.0) >= reach(&enclosure.dv) * (v.1 - v.0);
            open.extend(halves((u, v), along_u).map(|half| (half, clear)));
        }
        bounds
    }

    fn with(&self, bounds: Boxed, (u, v): (f64, f64), p: DVec3) -> Boxed {
        if stands_out(&bounds.bounds, p) && self.surface.holds(u, v) { bounds.with(p) } else { bounds }
    }

    /// Whether no border runs over a rectangle: of curves, by their distance from its middle; they lie within `gap` of the surface.
    fn is_clear(&self, (u, v): UvBox, enclosure: &Enclosure, gap: f64) -> bool {
        let (mid, hull) = (enclosure.mid.p, enclosure.p.bounds());
        let reach = (hull.max - mid).max(mid - hull.min).length() + gap;
        let (low, high) = (DVec2::new(u.0, v.0), DVec2::new(u.1, v.1));
        let center = 0.5 * (low + high);
        let copies = self.surface.copies((center.x, center.y));
        let apart =
            |a: DVec2, b: DVec2| copies.iter().map(|copy| *copy - center).all(|by| a.cmplt(low + by).any() || b.cmpgt(high + by).any());
        self.borders.iter().all(|border| match border {
            BorderCurve::Chain(chain, _, (least, most)) => {
                apart(*most, *least) || chain.bbox().distance_squared(mid) > reach * reach || chain.closest(mid).2 > reach
            }
            BorderCurve::Line(a, b) => apart(a.max(*b), a.min(*b)),
        })
    }
}
