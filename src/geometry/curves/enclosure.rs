//! Bounds of a curve's direction and curvature over an interval, from control points and closed forms: nothing is sampled.
//!
//! Both are geometric (derivatives by arc length), so a piece may be bounded in whatever parameter suits it.

use glam::DVec3;

use crate::base::math;
use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::{EPSILON, SLIVER};
use crate::base::work;
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::shapes::nurbs::{Nurbs, projected};
use crate::geometry::shapes::nurbs_edit::Bezier;

/// What the unit tangent and the curvature vector of an interval may be.
#[derive(Clone, Copy, Debug)]
pub struct Enclosure {
    /// dC/ds.
    pub tangent: Interval3,
    /// d²C/ds²; unbounded where there is a cusp.
    pub bend: Interval3,
    /// Sum over the corners inside of how far each coordinate of the tangent jumps.
    pub jumps: DVec3,
}

impl Enclosure {
    /// Of both intervals.
    pub fn union(self, other: &Self) -> Self {
        Self { tangent: self.tangent.union(other.tangent), bend: self.bend.union(other.bend), jumps: self.jumps + other.jumps }
    }

    /// Of the interval run backwards.
    pub fn reversed(self) -> Self {
        Self { tangent: -self.tangent, ..self }
    }

    fn smooth(tangent: Interval3, bend: Interval3) -> Self {
        Self { tangent, bend, jumps: DVec3::ZERO }
    }
}

/// The enclosure of a curve between two parameters of its domain.
pub fn enclosure(curve: &Curve, t0: f64, t1: f64) -> Enclosure {
    work::spend(4);
    match curve.shape() {
        Shape::Line(a, b) => Enclosure::smooth(Interval3::at((*b - *a).normalize_or_zero()), Interval3::default()),
        Shape::Arc(arc) => match arc.radius {
            Some(r) => {
                let (out, along) = turned(arc.u, arc.v, t0, t1);
                Enclosure::smooth(along * (1.0 / r), out * (-1.0 / (r * r)))
            }
            None => of_nurbs(&arc.part(t0, t1).to_nurbs(), 0.0),
        },
        Shape::Helix(helix) => {
            let (out, along) = turned(helix.u, helix.v, t0, t1);
            let speed = helix.speed();
            Enclosure::smooth((along + helix.rise) * (1.0 / speed), out * (-1.0 / (speed * speed)))
        }
        Shape::Nurbs(c) => {
            let (first, last) = curve.domain();
            of_nurbs(&c.part(t0, t1), SLIVER * (last - first))
        }
        Shape::Offset(offset) => {
            let base = enclosure(&offset.base, t0, t1);
            // Same directions; lengths grow by 1 − d·k.
            let left = Interval3::at(offset.normal).cross(&base.tangent);
            let growth = Interval::at(1.0) - base.bend.dot(&left) * offset.distance;
            Enclosure { bend: if growth.low > 0.0 { base.bend * growth.inverse() } else { Interval3::ANY }, ..base }
        }
        Shape::Composite(c) => {
            let (mut first, mut last) = (c.locate(t0).0, c.locate_before(t1).0);
            let least = SLIVER * (c.breaks[c.breaks.len() - 1] - c.breaks[0]);
            if first < last && c.breaks[first + 1] - t0 <= least {
                first += 1;
            }
            if first < last && t1 - c.breaks[last] <= least {
                last -= 1;
            }
            let one = |i: usize| enclosure(&c.pieces[i], c.own(i, t0.max(c.breaks[i])), c.own(i, t1.min(c.breaks[i + 1])));
            (first + 1..=last).fold(one(first), |whole, i| {
                let jump = direction(&c.pieces[i], false) - direction(&c.pieces[i - 1], true);
                Enclosure { jumps: whole.jumps + jump.abs(), ..whole }.union(&one(i))
            })
        }
    }
}

/// Unit tangent at an end of a curve.
fn direction(curve: &Curve, last: bool) -> DVec3 {
    let (a, b) = curve.domain();
    if last { curve.jet_before(b).d1 } else { curve.jet(a).d1 }.normalize_or_zero()
}

/// u·cos t + v·sin t and its derivative over an interval of t, about the middle.
fn turned(u: DVec3, v: DVec3, t0: f64, t1: f64) -> (Interval3, Interval3) {
    let (s, c) = math::sin_cos(0.5 * (t0 + t1));
    let (out, along) = (u * c + v * s, v * c - u * s);
    let half = (0.5 * (t1 - t0)).min(std::f64::consts::PI);
    let (sine, cosine) = math::sin_cos(half);
    let sides = Interval::around_zero(if half < std::f64::consts::FRAC_PI_2 { sine } else { 1.0 });
    let forward = Interval { low: cosine, high: 1.0 };
    (forward * out + sides * along, forward * along + sides * out)
}

/// Pieces no wider than `least` are passed over beside wider ones: they are there because a part that was to end at a knot ends
/// beside it, and differences of their control points over their width are nothing but rounding.
fn of_nurbs(c: &Nurbs, least: f64) -> Enclosure {
    let mut whole: Option<(Enclosure, DVec3)> = None;
    let pieces = c.beziers();
    let wide = pieces.iter().any(|piece| piece.t1 - piece.t0 > least);
    for piece in pieces.iter().filter(|piece| !wide || piece.t1 - piece.t0 > least) {
        let own = of_bezier(piece, c.polynomial);
        let n = piece.poles.len();
        let start = (projected(piece.poles[1]) - projected(piece.poles[0])).normalize_or_zero();
        let end = (projected(piece.poles[n - 1]) - projected(piece.poles[n - 2])).normalize_or_zero();
        let joined = match whole {
            None => own,
            Some((enclosure, before)) => {
                let jump = (start - before).abs();
                let jump = if jump.max_element() <= EPSILON { DVec3::ZERO } else { jump };
                Enclosure { jumps: enclosure.jumps + jump, ..enclosure }.union(&own)
            }
        };
        whole = Some((joined, end));
    }
    whole.map_or(Enclosure::smooth(Interval3::ANY, Interval3::ANY), |w| w.0)
}

/// From the hulls of the derivative nets; a rational piece by the quotient rule about its first point.
fn of_bezier(piece: &Bezier, polynomial: bool) -> Enclosure {
    let h = piece.t1 - piece.t0;
    let p = (piece.poles.len() - 1) as f64;
    let origin = projected(piece.poles[0]);
    let local: Vec<_> = piece.poles.iter().map(|q| (q.truncate() - origin * q.w, q.w)).collect();
    let first: Vec<_> = local.windows(2).map(|w| ((w[1].0 - w[0].0) * (p / h), (w[1].1 - w[0].1) * (p / h))).collect();
    let f = (p - 1.0) / h;
    let second: Vec<_> = first.windows(2).map(|w| ((w[1].0 - w[0].0) * f, (w[1].1 - w[0].1) * f)).collect();
    let vectors = |net: &[(DVec3, f64)]| if net.is_empty() { Interval3::default() } else { Interval3::of(net.iter().map(|q| q.0)) };
    let numbers = |net: &[(DVec3, f64)]| net.iter().map(|q| Interval::at(q.1)).reduce(Interval::union).unwrap_or_default();
    let (mut d1, mut d2) = (vectors(&first), vectors(&second));
    if polynomial {
        let w = 1.0 / piece.poles[0].w;
        (d1, d2) = (d1 * w, d2 * w);
    } else {
        let place = Interval3::of(local.iter().map(|q| q.0 / q.1));
        let over = numbers(&local).inverse();
        let (w1, w2) = (numbers(&first), numbers(&second));
        d1 = (d1 - place * w1) * over;
        d2 = (d2 - d1 * (w1 * 2.0) - place * w2) * over;
    }
    by_length(&d1, &d2)
}

/// Tangent and curvature from derivatives by any parameter: (C″ − T (T·C″)) / |C′|².
fn by_length(d1: &Interval3, d2: &Interval3) -> Enclosure {
    let speed = d1.length();
    let unit = Interval3 { low: DVec3::NEG_ONE, high: DVec3::ONE };
    if speed.low <= EPSILON * speed.high {
        return Enclosure::smooth(unit, Interval3::ANY);
    }
    let tangent = (*d1 * speed.inverse()).intersection(unit);
    let bend = (*d2 - tangent * tangent.dot(d2)) * speed.square().inverse();
    Enclosure::smooth(tangent, bend)
}
