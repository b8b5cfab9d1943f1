//! Sections in Bézier pieces, deformed to touch guides elsewhere.

use std::sync::Arc;

use glam::{DMat3, DVec3, DVec4};

use crate::base::fault::Result;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::{NEAREST, Tolerance};
use crate::geometry::curves::curve::Shape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::geometry::shapes::nurbs_edit::Bezier;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::swept::displacement::Displacement;

/// Pieces of a smooth part of a section, at most.
const MOST: usize = 1 << 10;
/// How often the distance is doubled within which a piece is one.
const WIDENED: usize = 32;

/// A section as pieces between common breaks: homogeneous Bézier points, all of one degree.
pub type Pieces = Vec<Vec<DVec4>>;

/// The map that takes a section's anchors to those of a station: a turn, a scale λ and, along the section, what is left at the anchors.
pub struct Deformation {
    turn: DMat3,
    from: DVec3,
    to: DVec3,
    centres: (DVec3, DVec3),
    /// λ.
    pub scale: f64,
    /// What is left at the anchors.
    rest: Vec<DVec3>,
}

impl Deformation {
    /// From anchors to their targets, after a turn about the first one.
    pub fn new(anchors: &[DVec3], targets: &[DVec3], turn: DMat3, tolerance: &Tolerance) -> Self {
        let (from, to) = (anchors[0], targets[0]);
        let moved: Vec<DVec3> = anchors.iter().map(|a| to + turn * (*a - from)).collect();
        let n = targets.len() as f64;
        let centres = (moved.iter().sum::<DVec3>() / n, targets.iter().sum::<DVec3>() / n);
        let mean = |points: &[DVec3], c: DVec3| points.iter().map(|p| p.distance(c)).sum::<f64>() / n;
        let (before, after) = (mean(&moved, centres.0), mean(targets, centres.1));
        let scale = if targets.len() == 1 || before <= tolerance.point { 1.0 } else { after / before };
        let left = |(k, q): (usize, &DVec3)| *q - (centres.1 + (moved[k] - centres.0) * scale);
        let rest = targets.iter().enumerate().map(left).collect();
        Self { turn, from, to, centres, scale, rest }
    }

    /// A point of the section, without what is left at the anchors.
    fn carried(&self, p: DVec3) -> DVec3 {
        let moved = self.to + self.turn * (p - self.from);
        self.centres.1 + (moved - self.centres.0) * self.scale
    }

    /// All pieces; `along` says how a displacement of the anchors goes on along the section, where there are several.
    pub(super) fn pieces(&self, pieces: &Pieces, along: Option<&Displacement>) -> Pieces {
        let carried = |piece: &Vec<DVec4>| piece.iter().map(|q| weighted(self.carried(projected(*q)), q.w)).collect();
        let mut made: Pieces = pieces.iter().map(carried).collect();
        if let Some(along) = along {
            along.field(&self.rest).apply(&mut made, pieces);
        }
        made
    }
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
        let targets = [(0.0, 0.0, 0.0), (2.5, 3.0, 0.2), (5.0, 0.5, 0.0)].map(DVec3::from);
        let found = Deformation::new(&[0, 2, 4].map(|k| knots[k]), &targets, DMat3::IDENTITY, &Tolerance::new(1e-6, 5.0));
        assert!((found.scale - 1.2948486617878667).abs() < 1e-12, "{}", found.scale);
        let rest = [(0.08969732357573346, -0.3034342254747556, -0.06666666666666667), (0.0, 0.10686845094951103, 0.13333333333333336)];
        for (k, wanted) in rest.into_iter().enumerate() {
            assert!(found.rest[k].distance(wanted.into()) < 1e-12, "{k}");
        }
    }
}
