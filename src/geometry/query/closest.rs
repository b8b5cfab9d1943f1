//! Nearest points, found by bounds: no part is left out that could hold a nearer one.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::math;
use crate::base::tolerance::{NEAREST, NEAREST_PAIR, ROUNDING_SHARE};
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::curves::pieces::{Node, Piece, Pieces, View, children};
use crate::geometry::query::intersect::newton::{approach, foot, segments};
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::bounds::Rates;

/// Parts looked at before the best so far is taken; far beyond what curves need that are no circles about the point.
const MOST_PARTS: usize = 200_000;

/// Parts that are halved before a curve counts as near.
const LOOKED_AT: usize = 64;

/// Pairs of parts looked at at most; parallel curves, where all are equally near, would need them all.
const MOST_PAIRS: usize = 20_000;

/// The point of a curve nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Parameter on the curve.
    pub t: f64,
    /// The point there.
    pub point: DVec3,
    /// Its distance, model units.
    pub distance: f64,
}

/// Globally nearest point of the curve; ties (to a billionth of the distance) go to the smaller parameter.
pub fn closest(curve: &Curve, p: DVec3) -> Closest {
    let pieces = curve.pieces();
    let start = curve.start();
    let rounding = ROUNDING_SHARE * (pieces.bounds(0).diagonal() + start.distance(p));
    let mut best = (curve.domain().0, start, start.distance(p));
    // A good first guess leaves little to look at.
    for piece in &pieces.pieces {
        let distance = piece.node.p.1.distance(p);
        if distance < best.2 {
            best = (pieces.sections[piece.section].to_common(piece.node.t.1), piece.node.p.1, distance);
        }
    }
    let mut search = Nearest { curve, pieces, p, rounding, best, left: MOST_PARTS };
    search.descend(0, 0, pieces.pieces.len());
    let (t, point, distance) = search.best;
    Closest { t, point, distance }
}

/// Whether a curve may come as near to a point as `reach`, by bounds alone; `false` is certain.
pub fn may_come_near(curve: &Curve, p: DVec3, reach: f64) -> bool {
    fn part(view: &View, node: &Node, rates: Rates, p: DVec3, reach: f64, left: &mut usize) -> bool {
        let apart = segments(node.p, (p, p)).0.sqrt();
        if apart - node.bulge > reach {
            return false;
        }
        // What bulges less than it is off is as near as its chord.
        if apart <= reach || *left == 0 || !node.can_split() {
            return true;
        }
        *left -= 1;
        node.halves(view, rates).iter().any(|half| part(view, half, rates, p, reach, left))
    }
    if let &Shape::Line(a, b) = curve.shape() {
        return segments((a, b), (p, p)).0.sqrt() <= reach + ROUNDING_SHARE * (a.distance(b) + a.distance(p));
    }
    let (pieces, mut left) = (curve.pieces(), LOOKED_AT);
    let reach = reach + ROUNDING_SHARE * (pieces.bounds(0).diagonal() + curve.start().distance(p));
    if distance_to_box(pieces.bounds(0), p) > reach {
        return false;
    }
    pieces.pieces.iter().any(|piece| part(&pieces.view_of(curve, piece.section), &piece.node, piece.rates, p, reach, &mut left))
}

/// Branch and bound for one point.
struct Nearest<'a> {
    curve: &'a Curve,
    pieces: &'a Pieces,
    p: DVec3,
    rounding: f64,
    best: (f64, DVec3, f64),
    left: usize,
}

impl Nearest<'_> {
    /// Whether something at least this far may still be nearer.
    fn worth(&self, distance: f64) -> bool {
        distance < self.best.2 * (1.0 - NEAREST) - self.rounding
    }

    fn offer(&mut self, view: &View, t: f64, point: DVec3) {
        let distance = point.distance(self.p);
        if self.worth(distance) || (distance < self.best.2 && point.distance(self.best.1) <= self.best.2 * NEAREST + self.rounding) {
            self.best = (view.section.to_common(t), point, distance);
        }
    }

    fn descend(&mut self, at: usize, low: usize, high: usize) {
        if !self.worth(distance_to_box(self.pieces.bounds(at), self.p)) {
            return;
        }
        if high - low > 1 {
            let (left, right, middle) = children(at, low, high);
            self.descend(left, low, middle);
            self.descend(right, middle, high);
            return;
        }
        let piece = &self.pieces.pieces[low];
        let view = self.pieces.view_of(self.curve, piece.section);
        match view.curve.shape() {
            Shape::Arc(arc) if arc.radius.is_some() => {
                let t = on_circle(arc, self.p);
                self.offer(&view, t, view.point(t));
            }
            _ => self.part(&view, &piece.node, piece.rates),
        }
    }

    fn part(&mut self, view: &View, node: &Node, rates: Rates) {
        let (apart, share, _) = segments(node.p, (self.p, self.p));
        if self.left == 0 || !self.worth(apart.sqrt() - node.bulge) {
            return;
        }
        self.left -= 1;
        let (t, point) = foot(view, self.p, node.t.0 + (node.t.1 - node.t.0) * share);
        self.offer(view, t, point);
        if self.worth(apart.sqrt() - node.bulge) && node.can_split() {
            for half in node.halves(view, rates) {
                self.part(view, &half, rates);
            }
        }
    }
}

fn distance_to_box(bounds: &Box3, p: DVec3) -> f64 {
    (bounds.min - p).max(p - bounds.max).max(DVec3::ZERO).length()
}

/// Angle of the point of a circle's arc nearest to `p`; the first one when all are equally near.
fn on_circle(arc: &EllipticArc, p: DVec3) -> f64 {
    let d = p - arc.center;
    let (x, y) = (d.dot(arc.u), d.dot(arc.v));
    let angle = math::atan2(y, x);
    let angle = if angle < 0.0 { angle + std::f64::consts::TAU } else { angle };
    if angle <= arc.sweep {
        return angle;
    }
    let far = |t: f64| arc.jet(t).p.distance_squared(p);
    if far(arc.sweep) < far(0.0) { arc.sweep } else { 0.0 }
}

/// Globally nearest pair of points of two curves: parameters on both and the distance.
///
/// No other pair is nearer by more than a millionth of the distance; the pair itself is as exact as rounding allows.
pub fn closest_pair(a: &Curve, b: &Curve) -> (f64, f64, f64) {
    let (pa, pb) = (a.pieces(), b.pieces());
    let rounding = ROUNDING_SHARE * pa.bounds(0).union(*pb.bounds(0)).diagonal();
    let mut best = (a.domain().0, b.domain().0, a.start().distance(b.start()));
    for x in &pa.pieces {
        for y in &pb.pieces {
            let apart = x.node.p.1.distance(y.node.p.1);
            if apart < best.2 {
                let common = |pieces: &Pieces, piece: &Piece| pieces.sections[piece.section].to_common(piece.node.t.1);
                best = (common(pa, x), common(pb, y), apart);
            }
        }
    }
    let mut heap = BinaryHeap::new();
    for (i, x) in pa.pieces.iter().enumerate() {
        for (j, y) in pb.pieces.iter().enumerate() {
            if box_gap(&x.node.bounds(), &y.node.bounds()) < best.2 {
                heap.push(Pair::new((i, j), x.node, y.node));
            }
        }
    }
    for _ in 0..MOST_PAIRS {
        job::poll();
        let Some(pair) = heap.pop() else { break };
        if pair.bound >= best.2 * (1.0 - NEAREST_PAIR) - rounding {
            break;
        }
        let (x, y) = (&pa.pieces[pair.pieces.0], &pb.pieces[pair.pieces.1]);
        let (va, vb) = (pa.view_of(a, x.section), pb.view_of(b, y.section));
        let at = |n: &Node, share: f64| n.t.0 + (n.t.1 - n.t.0) * share;
        let near = approach(&va, &vb, (at(&pair.nodes.0, pair.shares.0), at(&pair.nodes.1, pair.shares.1)));
        if near.gap() < best.2 {
            best = (va.section.to_common(near.ta), vb.section.to_common(near.tb), near.gap());
        }
        let (m, n) = pair.nodes;
        if m.bulge >= n.bulge && m.can_split() {
            heap.extend(m.halves(&va, x.rates).map(|half| Pair::new(pair.pieces, half, n)));
        } else if n.can_split() {
            heap.extend(n.halves(&vb, y.rates).map(|half| Pair::new(pair.pieces, m, half)));
        }
    }
    best
}

fn box_gap(x: &Box3, y: &Box3) -> f64 {
    (x.min - y.max).max(y.min - x.max).max(DVec3::ZERO).length()
}

/// Two parts with the least distance their points can have.
struct Pair {
    bound: f64,
    pieces: (usize, usize),
    nodes: (Node, Node),
    shares: (f64, f64),
}

impl Pair {
    fn new(pieces: (usize, usize), x: Node, y: Node) -> Self {
        let (apart, s, t) = segments(x.p, y.p);
        Self { bound: (apart.sqrt() - x.bulge - y.bulge).max(0.0), pieces, nodes: (x, y), shares: (s, t) }
    }

    fn key(&self) -> (f64, usize, usize, f64, f64) {
        (self.bound, self.pieces.0, self.pieces.1, self.nodes.0.t.0, self.nodes.1.t.0)
    }
}

/// The heap gives the least bound first; ties go by place on the curves.
impl Ord for Pair {
    fn cmp(&self, other: &Self) -> Ordering {
        let (x, y) = (self.key(), other.key());
        let order = x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)).then(x.2.cmp(&y.2)).then(x.3.total_cmp(&y.3)).then(x.4.total_cmp(&y.4));
        order.reverse()
    }
}

impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Pair {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build;

    fn bezier() -> Curve {
        let poles = [(0.0, 0.0, 0.0), (4.0, 6.0, 1.0), (-3.0, 6.0, 2.0), (1.0, 0.0, 1.0)].map(|(x, y, z)| DVec3::new(x, y, z));
        build::bezier(&poles, None, Origin::NONE).unwrap()
    }

    #[test]
    fn nothing_sampled_is_nearer() {
        let helix = build::helix(DVec3::ZERO, DVec3::Z, DVec3::X * 2.0, 0.7, 3.0, Origin::NONE).unwrap();
        let ellipse = build::ellipse(DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 0.1, 0.3, 5.0, Origin::NONE).unwrap();
        for curve in [bezier(), helix, ellipse] {
            let (a, b) = curve.domain();
            for i in 0..60 {
                let f = f64::from(i);
                let p = DVec3::new((f * 0.7) % 5.0 - 2.5, (f * 1.3) % 7.0 - 2.0, (f * 0.37) % 3.0);
                let found = closest(&curve, p);
                assert!((curve.point(found.t).distance(p) - found.distance).abs() < 1e-12);
                let sampled =
                    (0..=2000).map(|k| curve.point(a + (b - a) * f64::from(k) / 2000.0).distance(p)).fold(f64::INFINITY, f64::min);
                assert!(found.distance <= sampled + 1e-9 && found.distance > sampled - 1e-3, "{} {sampled}", found.distance);
            }
        }
    }

    #[test]
    fn ties_go_to_the_smaller_parameter() {
        let circle = build::circle(DVec3::ZERO, 2.0, DVec3::Z, Origin::NONE).unwrap();
        assert_eq!(closest(&circle, DVec3::new(0.0, 0.0, 1.0)).t, 0.0);
        let ellipse = build::ellipse(DVec3::ZERO, DVec3::X * 3.0, DVec3::Y, 0.0, std::f64::consts::TAU, Origin::NONE).unwrap();
        assert!((closest(&ellipse, DVec3::ZERO).t - std::f64::consts::FRAC_PI_2).abs() < 1e-7);
    }

    #[test]
    fn nearest_pairs() {
        let line = |a: [f64; 3], b: [f64; 3]| build::line(DVec3::from(a), DVec3::from(b), Origin::NONE).unwrap();
        let (_, _, gap) = closest_pair(&line([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]), &line([0.5, 1.0, 2.0], [0.5, -1.0, 2.0]));
        assert!((gap - 2.0).abs() < 1e-15);
        let circle = build::circle(DVec3::ZERO, 1.0, DVec3::Z, Origin::NONE).unwrap();
        let (ta, tb, gap) = closest_pair(&circle, &line([2.0, 5.0, 0.0], [2.0, -1.0, 0.0]));
        assert!((gap - 1.0).abs() < 1e-12 && ta.min(std::f64::consts::TAU - ta) < 1e-6 && (tb - 5.0 / 6.0).abs() < 1e-6);
        let curve = bezier();
        let (ta, tb, gap) = closest_pair(&curve, &line([0.5, -1.0, 0.2], [0.5, 9.0, 0.2]));
        let sampled = (0..=500)
            .map(|k| {
                let p = curve.point(f64::from(k) / 500.0);
                math::hypot(p.x - 0.5, p.z - 0.2)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(gap <= sampled && gap > sampled - 1e-2, "{gap} {sampled} at {ta} {tb}");
    }
}
