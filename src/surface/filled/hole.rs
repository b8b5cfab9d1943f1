//! The sides of a hole: its borders walked round, cut at kinks and put together where they run on smoothly.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Jet;
use crate::network::Chain;
use crate::surface::faults::LoopRole;
use crate::surface::rails::boundary::walked;

/// Fewest sides; a hole that has fewer corners gets more where sides are longest.
const LEAST_SIDES: usize = 3;
/// Sides of a hole that is cut where it has no corners.
const CUT_SIDES: usize = 4;

/// A side, in the direction of the walk.
#[derive(Clone, Debug)]
pub struct HoleSide {
    /// Its curve.
    pub chain: Chain,
    /// From its ends to the corners of the hole, within the tolerance.
    shifts: (DVec3, DVec3),
}

impl HoleSide {
    /// Point and derivatives by the fraction.
    pub fn jet(&self, f: f64) -> Jet {
        let jet = self.chain.jet(f);
        let (a, b) = self.shifts;
        Jet { p: jet.p + a * (1.0 - f) + b * f, d1: jet.d1 + (b - a), ..jet }
    }

    /// The point.
    pub fn point(&self, f: f64) -> DVec3 {
        let (a, b) = self.shifts;
        self.chain.point(f) + a * (1.0 - f) + b * f
    }
}

/// The sides of the hole that some borders go round, from a corner of the first one on, in its direction.
pub fn sides(borders: &[Chain], origin: Origin, tolerance: &Tolerance) -> Result<Vec<HoleSide>> {
    let mut pieces = Vec::new();
    for (chain, against) in walked(borders, LoopRole::Fill, tolerance)? {
        let chain = if against { chain.reversed() } else { chain };
        pieces.extend(between_kinks(&chain, tolerance)?);
    }
    let count = pieces.len();
    let smooth = |k: usize| !tolerance.is_kink(pieces[(k + count - 1) % count].jet_before(1.0).d1, pieces[k].jet(0.0).d1);
    let corners: Vec<usize> = (0..count).filter(|k| !smooth(*k)).collect();
    let mut chains = if corners.len() >= LEAST_SIDES { joined(&pieces, &corners, origin, tolerance)? } else { pieces };
    if chains.len() < LEAST_SIDES {
        let parts = CUT_SIDES / chains.len();
        let mut cut = Vec::new();
        for chain in &chains {
            for k in 0..parts {
                cut.push(chain.slice(k as f64 / parts as f64, (k + 1) as f64 / parts as f64, tolerance)?);
            }
        }
        chains = cut;
    }
    let n = chains.len();
    let corner = |k: usize| 0.5 * (chains[(k + n - 1) % n].end() + chains[k % n].start());
    let side = |k: usize| HoleSide { shifts: (corner(k) - chains[k].start(), corner(k + 1) - chains[k].end()), chain: chains[k].clone() };
    Ok((0..n).map(side).collect())
}

/// The parts of a curve between its kinks.
fn between_kinks(chain: &Chain, tolerance: &Tolerance) -> Result<Vec<Chain>> {
    let kinks = chain.kinks(tolerance);
    if kinks.is_empty() {
        return Ok(vec![chain.clone()]);
    }
    let mut ends = kinks.clone();
    if chain.is_closed(tolerance) {
        let first = ends[0];
        ends.push(first);
    } else {
        ends.insert(0, 0.0);
        ends.push(1.0);
    }
    if ends.len() == 2 && ends[0] == ends[1] && ends[0] == 0.0 {
        return Ok(vec![chain.clone()]);
    }
    ends.windows(2).map(|w| chain.slice(w[0], w[1], tolerance)).collect()
}

/// Pieces from corner to corner as one chain each.
fn joined(pieces: &[Chain], corners: &[usize], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Chain>> {
    let count = pieces.len();
    let one = |(n, &first): (usize, &usize)| {
        let next = corners.get(n + 1).copied().unwrap_or(corners[0] + count);
        let parts: Vec<Chain> = (first..next).map(|k| pieces[k % count].clone()).collect();
        match parts.as_slice() {
            [one] => Ok(one.clone()),
            many => Chain::join(many, origin, tolerance),
        }
    };
    corners.iter().enumerate().map(one).collect()
}
