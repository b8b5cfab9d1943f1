//! Where two curves may meet: subdivision with guaranteed bounds [Sederberg & Nishita 1990].
//!
//! A pair of parts is dropped when their chords are further apart than both bulges and the tolerance. Where no two
//! tangents can be parallel there is at most one meeting, and Newton's method finds it. Parts that run along each
//! other within the tolerance are collected for [`super::contact`].

use glam::DVec3;

use crate::base::math;
use crate::base::tolerance::{NEWTON_STEP, NUDGE};
use crate::base::work;
use crate::geometry::curves::curve::Curve;
use crate::geometry::curves::pieces::{Node, Pieces, View, children};
use crate::geometry::query::intersect::SearchBuffers;
use crate::geometry::query::intersect::circles::{common, one_circle};
use crate::geometry::query::intersect::newton::{Near, approach, foot, segments};
use crate::geometry::shapes::bounds::Rates;

/// Pairs of parts looked at before giving up.
const MOST_PAIRS: usize = 4_000_000;
/// A meeting this many tolerances before an end that touches as well is that end's.
pub(crate) const END_REACH: f64 = 64.0;
/// Chords that diverge by no more than this many tolerances count as running along each other.
const DIVERGENCE: f64 = 4.0;

/// Parts that run along each other may differ in length by this factor.
const UNLIKE: f64 = 2.0;

/// A meeting at own parameters of two sections.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) sections: (usize, usize),
    pub(crate) near: Near,
    pub(crate) tangent: bool,
}

/// Parts of two sections that run along each other within the tolerance or nearly so.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rect {
    pub(crate) sections: (usize, usize),
    pub(crate) a: (f64, f64),
    pub(crate) b: (f64, f64),
}

/// One curve of a search.
#[derive(Clone, Copy)]
pub(crate) struct Side<'a> {
    pub(crate) curve: &'a Curve,
    pub(crate) pieces: &'a Pieces,
}

impl<'a> Side<'a> {
    pub(crate) fn of(curve: &'a Curve) -> Self {
        Self { curve, pieces: curve.pieces() }
    }

    /// With the pieces of a straight line that does not keep them in `own`.
    pub(crate) fn passing(curve: &'a Curve, own: &'a mut Option<Pieces>) -> Self {
        Self { curve, pieces: curve.passing_pieces(own) }
    }

    pub(crate) fn view(&self, section: usize) -> View<'a> {
        self.pieces.view_of(self.curve, section)
    }
}

/// A part of a piece on its way through the subdivision.
struct Part<'a> {
    view: &'a View<'a>,
    rates: Rates,
    section: usize,
}

/// What is found so far.
pub(crate) struct Search<'a> {
    pub(crate) a: Side<'a>,
    pub(crate) b: Side<'a>,
    pub(crate) point: f64,
    pub(crate) found: Vec<Found>,
    pub(crate) near: Vec<Rect>,
    /// Where the search stopped, if it did.
    pub(crate) exhausted: Option<DVec3>,
    pub(crate) looked_at: usize,
}

impl<'a> Search<'a> {
    /// A search that has found nothing yet, with the emptied lists of `buffers`.
    pub(crate) fn new(a: Side<'a>, b: Side<'a>, point: f64, buffers: &mut SearchBuffers) -> Self {
        let (mut found, mut near) = (std::mem::take(&mut buffers.found), std::mem::take(&mut buffers.near));
        found.clear();
        near.clear();
        Self { a, b, point, found, near, exhausted: None, looked_at: 0 }
    }

    /// All pairs of pieces of two curves.
    pub(crate) fn run(&mut self) {
        self.descend((0, 0, self.a.pieces.pieces.len()), (0, 0, self.b.pieces.pieces.len()));
    }

    /// Pairs of pieces of one curve between which it turns far enough to come back.
    ///
    /// A loop needs a total turning of at least π besides the corner where it closes [Fenchel 1929].
    pub(crate) fn run_self(&mut self) {
        let turned = self.turning();
        for i in 0..self.a.pieces.pieces.len() {
            self.descend_later(i, &turned, (0, 0, self.a.pieces.pieces.len()));
        }
    }

    /// Bounds of the turning from the start of the curve to the start of each piece and to its end, corners before these included.
    fn turning(&self) -> Vec<(f64, f64)> {
        let (mut turned, mut start) = (Vec::new(), 0.0);
        let pieces = &self.a.pieces.pieces;
        for (k, piece) in pieces.iter().enumerate() {
            let within = (piece.node.t.1 - piece.node.t.0) * piece.rates.turn;
            let corner = match pieces.get(k + 1) {
                Some(next) if next.section != piece.section => {
                    let (before, after) = (self.a.view(piece.section), self.a.view(next.section));
                    let (arriving, leaving) = (before.jet(piece.node.t.1).d1, after.jet(next.node.t.0).d1);
                    // Where the curve stands still it may turn back.
                    let still = arriving == DVec3::ZERO || leaving == DVec3::ZERO;
                    if still { std::f64::consts::PI } else { math::angle_between(arriving, leaving) }
                }
                _ => 0.0,
            };
            turned.push((start, start + within));
            start += within + if corner.is_finite() { corner } else { std::f64::consts::PI };
        }
        turned
    }

    fn descend_later(&mut self, i: usize, turned: &[(f64, f64)], y: (usize, usize, usize)) {
        let pieces = self.a.pieces;
        // A corner after the later piece lies between no places of the two.
        let enough = turned[y.2 - 1].1 - turned[i].0 >= std::f64::consts::PI * (1.0 - NEWTON_STEP);
        if y.2 <= i + 1 || !enough || !pieces.pieces[i].node.bounds().touches(pieces.bounds(y.0), self.point) {
            return;
        }
        if y.2 - y.1 == 1 {
            self.pair(i, y.1);
        } else {
            let (left, right, middle) = children(y.0, y.1, y.2);
            self.descend_later(i, turned, (left, y.1, middle));
            self.descend_later(i, turned, (right, middle, y.2));
        }
    }

    /// Pairs below two nodes of the trees: node, first piece, one past the last.
    fn descend(&mut self, x: (usize, usize, usize), y: (usize, usize, usize)) {
        let (pieces_a, pieces_b) = (self.a.pieces, self.b.pieces);
        if !pieces_a.bounds(x.0).touches(pieces_b.bounds(y.0), self.point) {
            return;
        }
        let (many_x, many_y) = (x.2 - x.1, y.2 - y.1);
        if many_x == 1 && many_y == 1 {
            self.pair(x.1, y.1);
        } else if many_x >= many_y {
            let (left, right, middle) = children(x.0, x.1, x.2);
            self.descend((left, x.1, middle), y);
            self.descend((right, middle, x.2), y);
        } else {
            let (left, right, middle) = children(y.0, y.1, y.2);
            self.descend(x, (left, y.1, middle));
            self.descend(x, (right, middle, y.2));
        }
    }

    /// One pair of pieces.
    pub(crate) fn pair(&mut self, i: usize, j: usize) {
        let (x, y) = (&self.a.pieces.pieces[i], &self.b.pieces.pieces[j]);
        let (va, vb) = (self.a.view(x.section), self.b.view(y.section));
        if let Some((m, n)) = one_circle(&va, &vb, self.point) {
            if let Some((a, b)) = common(m, &x.node, n, &y.node) {
                self.near.push(Rect { sections: (x.section, y.section), a, b });
            }
            return;
        }
        let (pa, pb) = (Part { view: &va, rates: x.rates, section: x.section }, Part { view: &vb, rates: y.rates, section: y.section });
        self.meet(&pa, &x.node, &pb, &y.node, segments(x.node.p, y.node.p));
    }

    /// Two parts whose chords are `apart` (squared), nearest at shares `s` and `t` along them.
    fn meet(&mut self, a: &Part, x: &Node, b: &Part, y: &Node, (apart, s, t): (f64, f64, f64)) {
        self.looked_at += 1;
        let bulges = x.bulge + y.bulge;
        let reach = bulges + self.point;
        // Also when the numbers have run out of range and compare with nothing.
        if apart > reach * reach || apart.is_nan() || !reach.is_finite() {
            return;
        }
        if self.looked_at > MOST_PAIRS {
            self.exhausted = Some(x.middle);
            return;
        }
        let fine = bulges <= 0.5 * self.point;
        if let Some(sine) = self.transversal(x, y) {
            let inner = |share: f64| 0.0 < share && share < 1.0;
            if fine || (inner(s) && inner(t)) {
                let near = approach(a.view, b.view, (x.t.0 + (x.t.1 - x.t.0) * s, y.t.0 + (y.t.1 - y.t.0) * t));
                if near.gap() <= self.point && self.belongs((a.view, x), (b.view, y), &near, sine) {
                    self.settle(a, b, near, sine);
                    return;
                }
            }
        } else if fine && self.alike(x, y) {
            self.near.push(Rect { sections: (a.section, b.section), a: x.t, b: y.t });
            return;
        }
        // The one that bulges more is halved, the longer one where both are straight enough.
        let length = |n: &Node| n.p.0.distance_squared(n.p.1);
        let first = if fine || x.bulge == y.bulge { length(x) >= length(y) } else { x.bulge > y.bulge };
        match (first, x.can_split(), y.can_split()) {
            (true, true, _) | (false, true, false) => {
                for (t, p) in x.half_ends() {
                    let chords = segments(p, y.p);
                    if !self.is_too_far(chords.0, Node::most_bulge(t, a.rates) + y.bulge) {
                        self.meet(a, &Node::new(a.view, t, p, a.rates), b, y, chords);
                    }
                }
            }
            (_, _, true) => {
                for (t, p) in y.half_ends() {
                    let chords = segments(x.p, p);
                    if !self.is_too_far(chords.0, x.bulge + Node::most_bulge(t, b.rates)) {
                        self.meet(a, x, b, &Node::new(b.view, t, p, b.rates), chords);
                    }
                }
            }
            (_, false, false) => self.near.push(Rect { sections: (a.section, b.section), a: x.t, b: y.t }),
        }
    }

    /// Whether two parts with at most these bulges cannot meet: then the half is not evaluated, and is charged as if it were.
    fn is_too_far(&mut self, apart: f64, bulges: f64) -> bool {
        let reach = bulges + self.point;
        let far = apart > reach * reach;
        if far {
            self.looked_at += 1;
            work::spend(1);
        }
        far
    }

    /// Whether both parts are about equally long, so that one gives the place on the other where they run together.
    fn alike(&self, x: &Node, y: &Node) -> bool {
        let (p, q) = (x.p.0.distance_squared(x.p.1), y.p.0.distance_squared(y.p.1));
        let longer = p.max(q);
        longer <= UNLIKE * UNLIKE * p.min(q) || longer <= (END_REACH * self.point) * (END_REACH * self.point)
    }

    /// Sine of the angle between the axes when no tangents of the two parts can be parallel and the chords part by
    /// more than a few tolerances.
    #[inline]
    fn transversal(&self, x: &Node, y: &Node) -> Option<f64> {
        let ((sx, cx), (sy, cy)) = (x.cone, y.cone);
        if cx <= 0.0 || cy <= 0.0 || cx * cy <= sx * sy {
            return None;
        }
        let sine = x.axis.cross(y.axis).length();
        let shorter = x.p.0.distance_squared(x.p.1).min(y.p.0.distance_squared(y.p.1));
        let limit = DIVERGENCE * self.point;
        (sine > (sx * cy + cx * sy) * (1.0 + NUDGE) && sine * sine * shorter > limit * limit).then_some(sine)
    }

    /// Whether a meeting lies in both parts, or beyond an end by no more than the tolerance allows it to move.
    fn belongs(&self, (a, x): (&View, &Node), (b, y): (&View, &Node), near: &Near, sine: f64) -> bool {
        let beyond = |node: &Node, t: f64| {
            let h = node.t.1 - node.t.0;
            (node.t.0 - t).max(t - node.t.1).max(0.0) / h * node.p.0.distance(node.p.1)
        };
        let out = beyond(x, near.ta).max(beyond(y, near.tb));
        if out == 0.0 {
            return true;
        }
        if out * sine > 2.0 * self.point {
            return false;
        }
        // Outside the parts the curves may be parallel again.
        let (da, db) = (a.jet(near.ta).d1.normalize_or_zero(), b.jet(near.tb).d1.normalize_or_zero());
        da.cross(db).length() > 0.5 * sine
    }

    /// Records a crossing; an end of a section that lies on the other curve within the tolerance takes its place.
    fn settle(&mut self, a: &Part, b: &Part, near: Near, sine: f64) {
        let found = Found { sections: (a.section, b.section), near, tangent: false };
        let close = END_REACH * self.point;
        // Further along, an end may still lie within the tolerance when the curves part slowly.
        let slow = (2.0 * self.point / sine).max(close);
        let off = |view: &View, p: DVec3| [view.section.ends.0, view.section.ends.1].map(|end| end.distance_squared(p));
        let away = [off(a.view, near.pa), off(b.view, near.pb)];
        if away.as_flattened().iter().all(|away| *away > slow * slow) {
            self.found.push(found);
            return;
        }
        let mut taken: Option<Near> = None;
        for (view, other, first) in [(a.view, b.view, true), (b.view, a.view, false)] {
            let from = if first { near.pa } else { near.pb };
            for (end, t) in [(view.section.ends.0, view.section.range.0), (view.section.ends.1, view.section.range.1)] {
                let away = end.distance_squared(from);
                if away > slow * slow {
                    continue;
                }
                let (at, p) = foot(other, end, if first { near.tb } else { near.ta });
                if p.distance_squared(end) > self.point * self.point {
                    continue;
                }
                let touch = if first { Near { ta: t, tb: at, pa: end, pb: p } } else { Near { ta: at, tb: t, pa: p, pb: end } };
                if away > close * close {
                    self.found.push(Found { near: touch, ..found });
                } else if taken.is_none_or(|best| better(a.view, b.view, touch, best)) {
                    taken = Some(touch);
                }
            }
        }
        self.found.push(Found { near: taken.unwrap_or(near), ..found });
    }
}

/// Whether a contact at ends is to be preferred: more ends, then the smaller gap.
fn better(a: &View, b: &View, new: Near, old: Near) -> bool {
    let ends = |n: Near| {
        let at = |t: f64, range: (f64, f64)| u8::from(t == range.0 || t == range.1);
        at(n.ta, a.section.range) + at(n.tb, b.section.range)
    };
    (ends(new), -new.gap()) > (ends(old), -old.gap())
}
