//! From everything found to the list of hits: each meeting once, overlaps joined, ordered along the first curve.

use crate::base::tolerance::Tolerance;
use crate::geometry::curves::curve::Curve;
use crate::geometry::query::intersect::Hit;
use crate::geometry::query::intersect::contact::Shared;
use crate::geometry::query::intersect::search::{Found, Search, Side};

/// A meeting in the whole curves' parameters.
#[derive(Clone, Copy)]
struct Point {
    ta: f64,
    tb: f64,
    found: Found,
    /// Number of curve ends at it.
    ends: u8,
}

/// How far back along the first curve a repeated meeting is looked for.
const LOOK_BACK: usize = 16;

/// All hits, ordered along the first curve, into an empty list.
pub(crate) fn hits(search: &Search, shared: &[Shared], tolerance: &Tolerance, all: &mut Vec<Hit>) {
    if shared.is_empty() && search.found.is_empty() {
        return;
    }
    if let ([found], true) = (search.found.as_slice(), shared.is_empty()) {
        // As nearly always: nothing to be compared with.
        all.push(point(search, found, tolerance).hit());
        return;
    }
    let overlaps = join(search, shared, tolerance);
    let (a, b) = (search.a, search.b);
    let mut points: Vec<Point> = search
        .found
        .iter()
        .map(|found| point(search, found, tolerance))
        .filter(|p| !overlaps.iter().any(|s| s.holds(a.curve, b.curve, p, tolerance)))
        .collect();
    points.sort_by(|x, y| x.ta.total_cmp(&y.ta).then(x.tb.total_cmp(&y.tb)));
    let points = once(points, a.curve, b.curve, tolerance);
    all.extend(points.iter().map(Point::hit).chain(overlaps.iter().map(|s| Hit::Overlap { a: s.a, b: s.b })));
    if !overlaps.is_empty() {
        all.sort_by(|x, y| x.start().total_cmp(&y.start()));
    }
}

impl Point {
    fn hit(&self) -> Hit {
        let near = &self.found.near;
        Hit::Point { ta: self.ta, tb: self.tb, at: (near.pa + near.pb) * 0.5, gap: near.gap(), tangent: self.found.tangent }
    }
}

/// What was found with the parameters of the whole curves.
fn point(search: &Search, found: &Found, tolerance: &Tolerance) -> Point {
    let (a, b) = (search.a, search.b);
    let whole = |side: Side, section: usize, t: f64| {
        let (t, domain) = (side.pieces.sections[section].to_common(t), side.curve.domain());
        // On a closed curve the last parameter stands for the first.
        if t == domain.1 && side.curve.is_closed(tolerance) { domain.0 } else { t }
    };
    let (ta, tb) = (whole(a, found.sections.0, found.near.ta), whole(b, found.sections.1, found.near.tb));
    let (va, vb) = (a.view(found.sections.0), b.view(found.sections.1));
    let ends = u8::from(va.at_end(found.near.ta)) + u8::from(vb.at_end(found.near.tb));
    let mut found = *found;
    // An end neither crosses nor touches by itself: its direction decides.
    if ends > 0 {
        let (da, db) = (va.jet(found.near.ta).d1, vb.jet(found.near.tb).d1);
        found.tangent = !tolerance.is_kink(da, db) || !tolerance.is_kink(da, -db);
    }
    Point { ta, tb, found, ends }
}

/// Whether two parameters of a curve are one place on it: near in space and also half-way between them.
pub(crate) fn same_place(curve: &Curve, t: f64, u: f64, reach: f64) -> bool {
    if t == u {
        return true;
    }
    let p = curve.point(t);
    let near = |v: f64| curve.point(v).distance_squared(p) <= reach * reach;
    if near(u) && near(0.5 * (t + u)) {
        return true;
    }
    // Over the seam of a closed curve.
    let (a, b) = curve.domain();
    let (low, high) = (t.min(u), t.max(u));
    (low - a) + (b - high) < 0.25 * (b - a) && near(u) && near(a) && near(b)
}

/// Keeps one of every group of meetings that are one place on both curves.
fn once(points: Vec<Point>, a: &Curve, b: &Curve, tolerance: &Tolerance) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::with_capacity(points.len());
    let many = points.len() > 1;
    for point in points {
        let again = |other: &Point| {
            let reach = tolerance.point;
            let near = other.found.near.pa.distance_squared(point.found.near.pa) <= reach * reach;
            near && same_place(a, other.ta, point.ta, reach) && same_place(b, other.tb, point.tb, reach)
        };
        let skip = kept.len().saturating_sub(LOOK_BACK);
        // The first ones are looked at as well: they may lie beyond the seam.
        let place = if many {
            let back = (skip..kept.len()).rev().find(|i| again(&kept[*i]));
            back.or_else(|| (0..skip.min(LOOK_BACK)).find(|i| again(&kept[*i])))
        } else {
            None
        };
        match place {
            None => kept.push(point),
            Some(i) => {
                let rank = |p: &Point| (p.ends, -p.found.near.gap());
                if rank(&point) > rank(&kept[i]) {
                    kept[i] = point;
                }
            }
        }
    }
    kept.sort_by(|x, y| x.ta.total_cmp(&y.ta).then(x.tb.total_cmp(&y.tb)));
    kept
}

/// An overlap in the whole curves' parameters.
#[derive(Clone, Copy)]
struct Overlap {
    a: (f64, f64),
    b: (f64, f64),
}

impl Overlap {
    /// Whether a meeting lies on it, ends included.
    fn holds(&self, a: &Curve, b: &Curve, p: &Point, tolerance: &Tolerance) -> bool {
        let reach = tolerance.point;
        let (b0, b1) = (self.b.0.min(self.b.1), self.b.0.max(self.b.1));
        let on = |curve: &Curve, t: f64, (low, high): (f64, f64)| {
            (low..=high).contains(&t) || same_place(curve, t, low, reach) || same_place(curve, t, high, reach)
        };
        on(a, p.ta, self.a) && on(b, p.tb, (b0, b1))
    }
}

/// Overlaps that follow each other on both curves become one.
fn join(search: &Search, shared: &[Shared], tolerance: &Tolerance) -> Vec<Overlap> {
    let common = |side: Side, section: usize, t: (f64, f64)| {
        let s = side.pieces.sections[section];
        (s.to_common(t.0), s.to_common(t.1))
    };
    let mut all: Vec<Overlap> =
        shared.iter().map(|s| Overlap { a: common(search.a, s.sections.0, s.a), b: common(search.b, s.sections.1, s.b) }).collect();
    all.sort_by(|x, y| x.a.0.total_cmp(&y.a.0).then(x.b.0.total_cmp(&y.b.0)));
    let mut out: Vec<Overlap> = Vec::new();
    for next in all {
        let follows = |last: &Overlap| {
            let same_way = (last.b.1 >= last.b.0) == (next.b.1 >= next.b.0);
            let meet =
                |curve: &Curve, t: f64, u: f64| t == u || same_place(curve, t, u, tolerance.point) && (t - u).abs() < 0.5 * width(curve);
            same_way && meet(search.a.curve, last.a.1, next.a.0) && meet(search.b.curve, last.b.1, next.b.0)
        };
        match out.iter_mut().find(|last| follows(last)) {
            Some(last) => {
                last.a.1 = next.a.1;
                last.b.1 = next.b.1;
            }
            None => out.push(next),
        }
    }
    out
}

fn width(curve: &Curve) -> f64 {
    curve.domain().1 - curve.domain().0
}
