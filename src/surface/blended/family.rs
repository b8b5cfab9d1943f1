//! One family of a grid of curves: each cut to the borders, with its fractions at the nodes, and their means as parameters.

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::network::fault::GridFault;
use crate::network::flow::Member;
use crate::surface::blended::coons::Grid;
use crate::surface::faults::BorderFault;

/// The curves of one direction, with what they are cut by.
pub(super) struct GridFamily<'a> {
    pub members: &'a [Member],
    pub across: &'a [Member],
    pub closed: bool,
    /// Whether the first and last node of this family's curves are poles.
    pub poles: (bool, bool),
    /// An end nearer than this to its border lies on it, model units.
    pub snap: f64,
}

/// A curve with its raw fraction at every node of its direction, trimmed to the border and, when closed, begun at the seam.
pub(super) struct Prepared {
    pub chain: Chain,
    pub raw: Vec<f64>,
    pub place: usize,
}

/// The curves of a family, each cut to the borders.
pub(super) fn prepare(grid: &Grid, family: GridFamily, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Result<Vec<Prepared>> {
    let one = |member: &Member| -> Result<Prepared> {
        let chain = grid.chains[member.curve].clone();
        let (first, last) = if member.reversed { (1.0, 0.0) } else { (0.0, 1.0) };
        let mut raw = member.crossings.clone();
        if family.closed {
            return shifted(chain, member, family.snap, tolerance);
        }
        if family.poles.0 || raw.is_empty() {
            raw.insert(0, first);
        }
        if family.poles.1 || raw.len() < 2 {
            raw.push(last);
        }
        let n = raw.len();
        let least = family.snap / chain.length();
        if (raw[0] - first).abs() <= least {
            raw[0] = first;
        }
        if (raw[n - 1] - last).abs() <= least {
            raw[n - 1] = last;
        }
        if raw[0] == first && raw[n - 1] == last {
            return Ok(Prepared { chain, raw, place: member.curve });
        }
        trimmed(grid, &family, member, chain, raw, tolerance, notes)
    };
    family.members.iter().map(one).collect()
}

/// A closed chain begun at its first crossing, so that the seam is at 0 and 1.
fn shifted(chain: Chain, member: &Member, snap: f64, tolerance: &Tolerance) -> Result<Prepared> {
    let start = member.crossings.first().copied().unwrap_or(0.0);
    let least = snap / chain.length();
    let at_seam = start <= least || start >= 1.0 - least;
    let chain = if at_seam { chain } else { chain.slice(start, start, tolerance)? };
    let after = |raw: f64| if at_seam { raw } else { (raw - start).rem_euclid(1.0) };
    let (first, last) = if member.reversed { (1.0, 0.0) } else { (0.0, 1.0) };
    let mut raw = vec![first];
    raw.extend(member.crossings.iter().skip(1).map(|&r| after(r)));
    raw.push(last);
    Ok(Prepared { chain, raw, place: member.curve })
}

/// The part of a curve between the borders; what stands out is left out with a note.
fn trimmed(
    grid: &Grid,
    family: &GridFamily,
    member: &Member,
    chain: Chain,
    raw: Vec<f64>,
    tolerance: &Tolerance,
    notes: &mut Vec<Fault>,
) -> Result<Prepared> {
    let (first, last) = if member.reversed { (1.0, 0.0) } else { (0.0, 1.0) };
    let (from, to) = (raw[0], raw[raw.len() - 1]);
    let border = |k: usize| family.across.get(k).map_or(Origin::NONE, |m| grid.chains[m.curve].origin());
    for (end, here, k) in [(first, from, 0), (last, to, family.across.len().saturating_sub(1))] {
        let length = (here - end).abs() * chain.length();
        if length > family.snap.max(tolerance.point) {
            notes.push(BorderFault::EndTrimmed { curve: chain.origin(), border: border(k), end: chain.point(end), length }.into());
        }
    }
    let part = chain.slice(from.min(to), from.max(to), tolerance)?;
    let n = raw.len();
    let (low, span) = (from.min(to), (to - from).abs());
    let mut raw: Vec<f64> = raw.iter().map(|r| (r - low) / span).collect();
    (raw[0], raw[n - 1]) = (first, last);
    Ok(Prepared { chain: part, raw, place: member.curve })
}

/// u_i: the mean over the family of the oriented fractions [Koh & Park 1990, eq. 4.6–4.7]; E604 unless they ascend.
pub(super) fn averages(curves: &[Prepared], grid: &Grid, across: &[Member], tolerance: &Tolerance) -> Result<Vec<f64>> {
    let n = curves.first().map_or(2, |c| c.raw.len());
    let origin = |k: usize| across.get(k % across.len().max(1)).map_or(Origin::NONE, |m| grid.chains[m.curve].origin());
    let disorder = |curve: &Prepared, i: usize| {
        let (first, second) = (curve.chain.point(curve.raw[i - 1]), curve.chain.point(curve.raw[i]));
        Fault::from(GridFault::GridNotMonotone { curve: curve.chain.origin(), a: origin(i - 1), b: origin(i), first, second })
    };
    let oriented = |curve: &Prepared, i: usize| if curve.raw[0] > curve.raw[n - 1] { 1.0 - curve.raw[i] } else { curve.raw[i] };
    for curve in curves {
        if let Some(i) = (1..n).find(|&i| oriented(curve, i) - oriented(curve, i - 1) <= tolerance.parameter) {
            return Err(disorder(curve, i));
        }
    }
    let mean = |i: usize| {
        // Added in one order whatever the order of the curves: the sum must not depend on it.
        let mut all: Vec<f64> = curves.iter().map(|curve| oriented(curve, i)).collect();
        all.sort_by(f64::total_cmp);
        all.iter().sum::<f64>() / all.len() as f64
    };
    Ok((0..n)
        .map(|i| {
            if i == 0 {
                0.0
            } else if i + 1 == n {
                1.0
            } else {
                mean(i)
            }
        })
        .collect())
}

/// Values from 0 to 1 at equal distances.
pub(crate) fn evenly(n: usize) -> Vec<f64> {
    (0..n).map(|i| i as f64 / (n - 1) as f64).collect()
}

/// The chains in the order they were given.
pub(super) fn in_order(along_u: &[Prepared], along_v: &[Prepared]) -> Vec<Chain> {
    let mut all: Vec<&Prepared> = along_u.iter().chain(along_v).collect();
    all.sort_by_key(|c| c.place);
    all.into_iter().map(|c| c.chain.clone()).collect()
}
