//! Sections in Bézier pieces, deformed to touch guides elsewhere.

use std::sync::Arc;

use glam::{DMat3, DVec3, DVec4};

use crate::base::fault::Result;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, NEAREST, Tolerance};
use crate::geometry::curves::curve::Shape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::geometry::shapes::nurbs_edit::Bezier;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::data::breaks::chain_breaks;

/// Pieces of a smooth part of a section, at most.
const MOST: usize = 1 << 10;
/// How often the distance is doubled within which a piece is one.
const WIDENED: usize = 32;

/// A section as pieces between common breaks: homogeneous Bézier points, all of one degree.
pub type Pieces = Vec<Vec<DVec4>>;

/// The map that takes a section's anchors to those of a station.
pub struct Deformation {
    turn: DMat3,
    from: DVec3,
    to: DVec3,
    centres: (DVec3, DVec3),
    /// λ.
    pub scale: f64,
    /// What is left at the anchors, with their section parameters.
    rest: Vec<(f64, DVec3)>,
}

impl Deformation {
    /// From anchors (parameter of the section, point) to their targets, after a turn about the first one.
    pub fn new(anchors: &[(f64, DVec3)], targets: &[DVec3], turn: DMat3, tolerance: &Tolerance) -> Self {
        let (from, to) = (anchors[0].1, targets[0]);
        let moved: Vec<DVec3> = anchors.iter().map(|a| to + turn * (a.1 - from)).collect();
        let n = targets.len() as f64;
        let centres = (moved.iter().sum::<DVec3>() / n, targets.iter().sum::<DVec3>() / n);
        let mean = |points: &[DVec3], c: DVec3| points.iter().map(|p| p.distance(c)).sum::<f64>() / n;
        let (before, after) = (mean(&moved, centres.0), mean(targets, centres.1));
        let scale = if targets.len() == 1 || before <= tolerance.point { 1.0 } else { after / before };
        let left = |(k, q): (usize, &DVec3)| (anchors[k].0, *q - (centres.1 + (moved[k] - centres.0) * scale));
        let rest = targets.iter().enumerate().map(left).collect();
        Self { turn, from, to, centres, scale, rest }
    }

    /// The same for a closed section: what is left at the first anchor is left again at the end.
    pub fn closing(mut self) -> Self {
        let first = self.rest[0].1;
        self.rest.push((1.0, first));
        self
    }

    /// What is left over at a parameter of the section.
    fn rest(&self, t: f64) -> DVec3 {
        let k = self.rest.partition_point(|r| r.0 <= t);
        if k == 0 || k == self.rest.len() {
            return self.rest[k.saturating_sub(1)].1;
        }
        let ((t0, before), (t1, after)) = (self.rest[k - 1], self.rest[k]);
        let y = (t - t0) / (t1 - t0);
        let b = y * y * (3.0 - 2.0 * y);
        before * (1.0 - b) + after * b
    }

    /// A point of the section that moves with what is left over at a parameter.
    pub fn point(&self, p: DVec3, t: f64) -> DVec3 {
        let moved = self.to + self.turn * (p - self.from);
        self.centres.1 + (moved - self.centres.0) * self.scale + self.rest(t)
    }

    /// All pieces; `breaks` are the section's parameters at their ends.
    pub fn pieces(&self, pieces: &Pieces, breaks: &[f64]) -> Pieces {
        pieces.iter().zip(breaks.windows(2)).map(|(piece, w)| self.piece(piece, (w[0], w[1]))).collect()
    }

    fn piece(&self, piece: &[DVec4], (t0, t1): (f64, f64)) -> Vec<DVec4> {
        let degree = piece.len() - 1;
        let points: Vec<DVec3> = piece.iter().map(|q| projected(*q)).collect();
        let ends = (self.point(points[0], t0), self.point(points[degree], t1));
        let way = points[degree] - points[0];
        let share = |p: DVec3| if way == DVec3::ZERO { 0.0 } else { (p - points[0]).dot(way) / way.length_squared() };
        let straight = points.iter().all(|p| (*p - points[0] - way * share(*p)).length() <= EPSILON * way.length());
        let moved = |i: usize| -> DVec3 {
            let p = points[i];
            if i == 0 {
                ends.0
            } else if i == degree {
                ends.1
            } else if straight {
                ends.0 + (ends.1 - ends.0) * share(p)
            } else if 2 * i < degree {
                self.point(p, t0)
            } else if 2 * i > degree {
                self.point(p, t1)
            } else {
                0.5 * (self.point(p, t0) + self.point(p, t1))
            }
        };
        (0..=degree).map(|i| weighted(moved(i), piece[i].w)).collect()
    }
}

/// (1 − β) A + β B with β = 3x² − 2x³, piece by piece; smooth where both are.
pub fn blended(a: &Pieces, b: &Pieces, x: f64, closed: bool, tolerance: &Tolerance) -> Pieces {
    let beta = x * x * (3.0 - 2.0 * x);
    let mixed = |(p, q): (&DVec4, &DVec4)| *p * (1.0 - beta) + *q * beta;
    let mut made: Pieces = a.iter().zip(b).map(|(p, q)| p.iter().zip(q).map(mixed).collect()).collect();
    let n = made.len();
    for k in 0..n {
        let next = (k + 1) % n;
        if next == 0 && !closed {
            break;
        }
        let smooth = |pieces: &Pieces| {
            let (before, after) = handles(&pieces[k], &pieces[next]);
            !tolerance.is_kink(before, after)
        };
        if smooth(a) && smooth(b) {
            straighten(&mut made, (k, next));
        }
    }
    made
}

/// Ways to the joint of two pieces and from it, between Bézier points.
fn handles(before: &[DVec4], after: &[DVec4]) -> (DVec3, DVec3) {
    let last = before.len() - 1;
    let joint = projected(before[last]);
    (joint - projected(before[last - 1]), projected(after[1]) - joint)
}

/// Turns both handles of a joint into their common direction, as long as they are: blends of two smooth curves whose speeds
/// jump in different ratios need not be smooth.
fn straighten(pieces: &mut Pieces, (k, next): (usize, usize)) {
    let (before, after) = handles(&pieces[k], &pieces[next]);
    let way = (before + after).normalize_or_zero();
    if way == DVec3::ZERO {
        return;
    }
    let last = pieces[k].len() - 1;
    let joint = projected(pieces[k][last]);
    let w = (pieces[k][last - 1].w, pieces[next][1].w);
    pieces[k][last - 1] = weighted(joint - way * before.length(), w.0);
    pieces[next][1] = weighted(joint + way * after.length(), w.1);
}

/// Pieces in a row as one curve, and the fractions of its length at their ends.
pub fn curve(pieces: &Pieces, origin: Origin) -> (Chain, Vec<f64>) {
    let each: Vec<Nurbs> = pieces.iter().map(|poles| Nurbs::bezier(0.0, 1.0, poles.clone())).collect();
    let curve = Curve::new(Shape::Nurbs(Arc::new(Nurbs::joined(&each))), Kind::Nurbs, origin);
    let length = curve.length();
    let last = pieces.len();
    let at = |k: usize| {
        if k == 0 {
            0.0
        } else if k == last {
            1.0
        } else {
            curve.length_at(k as f64) / length
        }
    };
    let breaks = (0..=last).map(at).collect();
    (Chain::of_curve(&curve), breaks)
}

/// Fractions between which a section is one Bézier piece each, 0 and 1 included.
pub fn own_breaks(chain: &Chain, tolerance: &Tolerance) -> Result<Vec<f64>> {
    let stops = [vec![0.0], chain_breaks(chain), vec![1.0]].concat();
    let mut all = vec![0.0];
    for w in stops.windows(2) {
        // Arcs: pieces well below a right angle. Helices and offset curves: as many as each is one piece within the tolerance.
        let several = whole_pieces(&part(chain, (w[0], w[1]), tolerance)?).len();
        let mut n = if several > 1 { 2 * several } else { 1 };
        let at = |k: usize, n: usize| w[0] + (w[1] - w[0]) * k as f64 / n as f64;
        while n < MOST {
            job::poll();
            let parts = (0..n).map(|k| part(chain, (at(k, n), at(k + 1, n)), tolerance).map(|p| whole_pieces(&p).len()));
            if parts.collect::<Result<Vec<usize>>>()?.iter().all(|pieces| *pieces == 1) {
                break;
            }
            n *= 2;
        }
        all.extend((1..=n).map(|k| if k == n { w[1] } else { w[0] + (w[1] - w[0]) * k as f64 / n as f64 }));
    }
    Ok(all)
}

/// The Bézier pieces of a part, but for slivers that rounding leaves where it is cut beside a knot.
fn whole_pieces(part: &Nurbs) -> Vec<Bezier> {
    let mut all = part.beziers();
    let reach = |piece: &Bezier| piece.poles.windows(2).map(|w| projected(w[0]).distance(projected(w[1]))).sum::<f64>();
    let lengths: Vec<f64> = all.iter().map(reach).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let mut kept = lengths.iter().map(|length| *length > NEAREST * longest);
    all.retain(|_| kept.next().unwrap_or(true));
    all
}

fn part(chain: &Chain, (f0, f1): (f64, f64), tolerance: &Tolerance) -> Result<Nurbs> {
    let part = if f0 <= 0.0 && f1 >= 1.0 { chain.clone() } else { chain.slice(f0, f1, tolerance)? };
    part.to_curve()?.to_nurbs(tolerance)
}

/// A section cut at some fractions, of at least third degree.
pub fn cut(chain: &Chain, breaks: &[f64], tolerance: &Tolerance) -> Result<Pieces> {
    const LEAST: usize = 3;
    breaks
        .windows(2)
        .map(|w| {
            // What was one piece may be two at other ends: then it is one within a little more.
            let mut near = *tolerance;
            for _ in 0..WIDENED {
                let found = part(chain, (w[0], w[1]), &near)?;
                let found = whole_pieces(&found.elevated(LEAST.saturating_sub(found.degree)));
                if let [one] = found.as_slice() {
                    return Ok(one.poles.clone());
                }
                near.point *= 2.0;
            }
            let what = "a section in pieces".to_owned();
            Err(CurveFault::NotConverged { of: chain.origin(), what, at: chain.point(w[0]) }.into())
        })
        .collect()
}

/// Raises all pieces to one degree.
pub fn level(sections: &mut [Pieces]) {
    let degree = sections.iter().flatten().map(|p| p.len() - 1).max().unwrap_or(0);
    for piece in sections.iter_mut().flatten() {
        let by = degree + 1 - piece.len();
        if by > 0 {
            *piece = Nurbs::bezier(0.0, 1.0, piece.clone()).elevated(by).poles;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_section_is_deformed_as_it_should_be() {
        let knots = [(0.0, 0.0, 0.0), (1.0, 1.5, 0.0), (2.0, 2.0, 0.0), (3.0, 1.5, 0.0), (4.0, 0.0, 0.0)].map(DVec3::from);
        let t = [0.0, 0.3086088907313406, 0.5, 0.6913911092686593, 1.0];
        let targets = [(0.0, 0.0, 0.0), (2.5, 3.0, 0.2), (5.0, 0.5, 0.0)].map(DVec3::from);
        let anchors = [0, 2, 4].map(|k| (t[k], knots[k]));
        let found = Deformation::new(&anchors, &targets, DMat3::IDENTITY, &Tolerance::new(1e-6, 5.0));
        assert!((found.scale - 1.2948486617878667).abs() < 1e-12, "{}", found.scale);
        let wanted = [
            (0.0, 0.0, 0.0),
            (1.2345177463178878, 2.2182448400196786, 0.13452110512314291),
            (2.5, 3.0, 0.2),
            (3.765482253682112, 2.3819420772118214, 0.13452110512314294),
            (5.0, 0.5, 0.0),
        ];
        for k in 0..5 {
            assert!(found.point(knots[k], t[k]).distance(wanted[k].into()) < 1e-12, "{k}");
        }
    }

    #[test]
    fn blends_take_three_squares_less_two_cubes() {
        let piece = |y: f64| vec![vec![DVec4::new(0.0, y, 0.0, 1.0); 4]];
        let tolerance = Tolerance::new(1e-6, 5.0);
        for (x, share) in [(0.25, 0.15625), (0.5, 0.5), (0.75, 0.84375)] {
            assert_eq!(blended(&piece(0.0), &piece(1.0), x, false, &tolerance)[0][0].y, share);
        }
    }
}
