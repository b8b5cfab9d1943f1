//! `snap`: ends of measured curves that are nearly one point are moved together once (language, "Curves").

use glam::DVec3;

use super::cluster::cluster;
use crate::base::fault::{Fault, Result};
use crate::base::math::compare_points;
use crate::base::origin::Origin;
use crate::base::tolerance::{SNAP_SHARE, Tolerance};
use crate::network::fault::{CurveEnd, EndFault};

/// An end that `snap` looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapEnd {
    /// The curve and its end.
    pub end: CurveEnd,
    /// Whether it may go elsewhere.
    pub hold: Hold,
    /// Length of the curve, model units.
    pub length: f64,
}

/// Whether an end may go elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// The curve can be built anew with this end elsewhere: it is made from points.
    Free,
    /// The curve cannot.
    Fixed,
    /// It was moved in a round before and stays, since other curves are made from it; two such ends may be apart.
    Settled,
}

/// An end that goes elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// Place in the list of ends.
    pub end: usize,
    /// Where it goes.
    pub to: DVec3,
}

/// Whether `snap` may be offered for a gap between ends of curves, the `shorter` of which has this length: it joins ends that
/// were measured twice, and leaves curves what they are ([`SNAP_SHARE`]).
pub fn may_snap(gap: f64, shorter: f64) -> bool {
    gap <= SNAP_SHARE * shorter
}

/// Moves that bring ends closer than `distance` together: to the end among them that cannot move, else to the declared
/// point, else to their mean. Each move is noted in `sink` (N513, W223 where it is large against the curve); two ends that cannot
/// move are E511, but for two that are settled.
///
/// `asked` is the expression in which the distance is written. Independent of the order of ends.
pub fn snap(
    ends: &[SnapEnd],
    points: &[DVec3],
    distance: f64,
    asked: Origin,
    tolerance: &Tolerance,
    sink: &mut Vec<Fault>,
) -> Result<Vec<Move>> {
    let all: Vec<DVec3> = ends.iter().map(|e| e.end.at).chain(points.iter().copied()).collect();
    let roots = cluster(&all, distance);
    let mut order: Vec<u32> = (0..all.len() as u32).collect();
    order.sort_unstable_by_key(|&k| (roots[k as usize], k));
    let mut moves = Vec::new();
    for group in order.chunk_by(|&a, &b| roots[a as usize] == roots[b as usize]) {
        let members: Vec<usize> = group.iter().map(|&k| k as usize).filter(|&k| k < ends.len()).collect();
        if members.is_empty() || group.len() == 1 {
            continue;
        }
        let declared: Vec<DVec3> = group.iter().map(|&k| k as usize).filter(|&k| k >= ends.len()).map(|k| all[k]).collect();
        let fixed: Vec<usize> = members.iter().copied().filter(|&k| ends[k].hold != Hold::Free).collect();
        let is_settled = |k: usize| ends[k].hold == Hold::Settled;
        for (i, &a) in fixed.iter().enumerate() {
            let apart = |b: usize| (!is_settled(a) || !is_settled(b)) && !tolerance.same_point(all[a], all[b]);
            if let Some(&b) = fixed[i + 1..].iter().find(|&&b| apart(b)) {
                let settled = [a, b].into_iter().find(|k| is_settled(*k)).map(|k| ends[k].end.of);
                return Err(EndFault::SnapFixed { a: ends[a].end, b: ends[b].end, snap: distance, asked, settled }.into());
            }
        }
        let fixed_points: Vec<DVec3> = fixed.iter().map(|&k| all[k]).collect();
        let mean = mean(members.iter().map(|&k| all[k]).collect());
        for &k in &members {
            let targets = if !fixed_points.is_empty() { &fixed_points } else { &declared };
            let near = |p: &DVec3| p.distance_squared(all[k]);
            let to = targets.iter().copied().min_by(|a, b| near(a).total_cmp(&near(b)).then(compare_points(*a, *b))).unwrap_or(mean);
            if ends[k].hold == Hold::Free && to != all[k] {
                moves.push(Move { end: k, to });
            }
        }
    }
    moves.sort_unstable_by_key(|m| m.end);
    // Where nothing is wrong, rounding is not worth a word.
    sink.extend(
        moves
            .iter()
            .filter(|m| m.to.distance(all[m.end]) > tolerance.rounding)
            .map(|m| EndFault::Snapped { end: ends[m.end].end, to: m.to, length: ends[m.end].length, asked }.into()),
    );
    Ok(moves)
}

/// The mean, independent of the order given.
fn mean(mut points: Vec<DVec3>) -> DVec3 {
    points.sort_unstable_by(|a, b| compare_points(*a, *b));
    let base = points[0];
    base + points.iter().map(|p| *p - base).sum::<DVec3>() / points.len() as f64
}

#[cfg(test)]
mod tests {
    use super::Hold::{Fixed, Free, Settled};
    use super::*;

    fn end(x: f64, hold: Hold) -> SnapEnd {
        SnapEnd { end: CurveEnd { of: Origin::NONE, last: false, at: DVec3::new(x, 0.0, 0.0) }, hold, length: 10.0 }
    }

    fn moved(ends: &[SnapEnd], points: &[f64]) -> Result<Vec<(usize, f64)>> {
        let points: Vec<DVec3> = points.iter().map(|&x| DVec3::new(x, 0.0, 0.0)).collect();
        let mut sink = Vec::new();
        let moves = snap(ends, &points, 0.5, Origin::NONE, &Tolerance::new(1e-6, 10.0), &mut sink)?;
        assert_eq!(sink.len(), moves.len());
        Ok(moves.into_iter().map(|m| (m.end, m.to.x)).collect())
    }

    #[test]
    fn snap_is_offered_for_gaps_small_against_the_curves() {
        assert!(may_snap(0.3, 4000.0) && may_snap(40.0, 4000.0));
        assert!(!may_snap(1000.0, 4000.0) && !may_snap(1.0, 2.0));
    }

    #[test]
    fn ends_go_to_the_fixed_end_the_declared_point_or_their_mean() {
        assert_eq!(moved(&[end(0.0, Free), end(0.25, Free), end(9.0, Free)], &[]).unwrap(), [(0, 0.125), (1, 0.125)]);
        assert_eq!(moved(&[end(0.0, Free), end(0.25, Free)], &[0.3]).unwrap(), [(0, 0.3), (1, 0.3)]);
        assert_eq!(moved(&[end(0.0, Free), end(0.25, Fixed)], &[0.3]).unwrap(), [(0, 0.25)]);
        assert_eq!(moved(&[end(4.0, Free)], &[4.25]).unwrap(), [(0, 4.25)]);
        assert_eq!(moved(&[end(0.0, Fixed), end(0.25, Fixed)], &[]).unwrap_err().code().0, "E511");
    }

    #[test]
    fn settled_ends_draw_others_and_may_be_apart() {
        assert_eq!(moved(&[end(0.0, Settled), end(0.25, Free), end(0.4, Settled)], &[0.26]).unwrap(), [(1, 0.4)]);
        assert_eq!(moved(&[end(0.0, Settled), end(0.25, Fixed)], &[]).unwrap_err().code().0, "E511");
    }
}
