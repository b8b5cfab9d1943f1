//! Surfaces through sections alone: each section is contained exactly, and splines run across them.

use super::coons::evenly;
use super::core::{Border, Side, Surface, SurfaceKind};
use super::gordon::{CurveNet, Named, blended};
use super::rail::Rail;
use super::reparam::Map;
use crate::base::fault::{Fault, NetFault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, FlowKind};

/// Places along a section at which neighbours are compared.
const COMPARED: usize = 32;
/// Starts tried along a closed section before the best one is made better.
const STARTS: usize = 64;
/// Steps of golden sections to the best start.
const STEPS: usize = 40;

/// How the surface runs from section to section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    /// Straight, with a kink along each inner section.
    Linear,
    /// By cubic splines, twice continuously differentiable.
    Cubic,
}

/// The surface through sections in the order given, u along them, with warnings (W614).
///
/// Every section is read in the direction, and every closed one from the start, in which it runs nearest to the section
/// before; v goes with the mean distance between sections. `closed` joins the last section to the first one. Needs two
/// sections, three where closed; all of them open or all closed.
pub fn skin(sections: &[Chain], across: Across, closed: bool, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let round = sections.iter().all(|c| c.is_closed(tolerance));
    let mut aligned: Vec<(Chain, bool)> = Vec::with_capacity(sections.len());
    for section in sections {
        job::look();
        let next = match aligned.last() {
            None => (section.clone(), false),
            Some(before) if round => nearest_start(before, section, tolerance)?,
            Some(before) => (section.clone(), apart(before, (section, 0.0, true)) < apart(before, (section, 0.0, false))),
        };
        aligned.push(next);
    }
    let nodes_v = distances(&aligned, closed);
    if let Some(k) = nodes_v.windows(2).position(|w| (w[1] - w[0]).max(0.0) <= tolerance.parameter) {
        let (a, b) = (&sections[k], &sections[(k + 1) % sections.len()]);
        return Err(NetFault::Cross { a: a.origin(), b: b.origin(), guides: false, at: b.start() }.into());
    }
    let map = |turned: bool| if turned { Map::reverse() } else { Map::identity() };
    let along_u: Vec<Rail> = aligned.iter().map(|(chain, turned)| Rail::new(chain.clone(), map(*turned))).collect();
    let net = CurveNet { along_u, along_v: Vec::new(), nodes: (evenly(2), nodes_v), closed: (false, closed) };
    let flow = crate::network::Flow {
        kind: FlowKind::Quadrilateral,
        along_u: Vec::new(),
        along_v: Vec::new(),
        closed_u: round,
        closed_v: closed,
        poles: (None, None),
        overhangs: Vec::new(),
    };
    let named = Named { origin, kind: SurfaceKind::Skin, flow: flow.phrase(), chains: sections.to_vec() };
    let (surface, notes) = blended(net, named, across == Across::Linear, tolerance);
    let side = if round { Side::Seam } else { Side::Free };
    Ok((surface.with_ends(side, round), notes))
}

/// A section as it is read: `turn` of its length later, backwards or not.
fn read((chain, turn, turned): (&Chain, f64, bool), x: f64) -> glam::DVec3 {
    let x = if turned { 1.0 - x } else { x };
    let f = x + turn;
    chain.point(if f > 1.0 { f - 1.0 } else { f })
}

/// Sum of squared distances between two sections.
fn apart((before, turned): &(Chain, bool), section: (&Chain, f64, bool)) -> f64 {
    let at = |k: usize| k as f64 / COMPARED as f64;
    (0..=COMPARED).map(|k| read((before, 0.0, *turned), at(k)).distance_squared(read(section, at(k)))).sum()
}

/// A closed section from the start, and in the direction, that twists least against the one before.
///
/// Corners go to corners: where both have equally many, only these are tried.
fn nearest_start(before: &(Chain, bool), section: &Chain, tolerance: &Tolerance) -> Result<(Chain, bool)> {
    let corners = |chain: &Chain| chain.kinks(tolerance).into_iter().filter(|f| *f < 1.0).collect::<Vec<_>>();
    let (own, other) = (corners(section), corners(&before.0));
    let kinked = own.len() == other.len() && !own.is_empty();
    let starts = if kinked { own } else { (0..STARTS).map(|k| k as f64 / STARTS as f64).collect() };
    let off = |start: f64, turned: bool| apart(before, (section, start.rem_euclid(1.0), turned));
    let mut best = (f64::INFINITY, 0.0, false);
    for (start, turned) in starts.iter().flat_map(|start| [(*start, false), (*start, true)]) {
        let miss = off(start, turned);
        if miss < best.0 * (1.0 - tolerance.parameter) {
            best = (miss, start, turned);
        }
    }
    let mut start = best.1;
    if !kinked && start != 0.0 {
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let (mut low, mut high) = (start - 1.0 / STARTS as f64, start + 1.0 / STARTS as f64);
        for _ in 0..STEPS {
            let (c, d) = (high - golden * (high - low), low + golden * (high - low));
            if off(c, best.2) < off(d, best.2) { high = d } else { low = c }
        }
        start = (0.5 * (low + high)).rem_euclid(1.0);
    }
    if start * section.length() <= tolerance.point || (1.0 - start) * section.length() <= tolerance.point {
        return Ok((section.clone(), best.2));
    }
    Ok((section.slice(start, start, tolerance)?, best.2))
}

/// v of the sections: sums of their mean distances, from 0 to 1.
fn distances(aligned: &[(Chain, bool)], closed: bool) -> Vec<f64> {
    let n = aligned.len();
    let at = |k: usize| k as f64 / COMPARED as f64;
    let mean = |a: &(Chain, bool), b: &(Chain, bool)| {
        let point = |of: &(Chain, bool), k: usize| read((&of.0, 0.0, of.1), at(k));
        (0..=COMPARED).map(|k| point(a, k).distance(point(b, k))).sum::<f64>()
    };
    let mut sums = vec![0.0];
    for k in 1..n + usize::from(closed) {
        sums.push(sums[k - 1] + mean(&aligned[k - 1], &aligned[k % n]));
    }
    let whole = sums[sums.len() - 1];
    let last = sums.len() - 1;
    sums.iter().enumerate().map(|(k, sum)| if k == last { 1.0 } else { sum / whole }).collect()
}

impl Surface {
    /// The same with both ends of u free or joined.
    fn with_ends(&self, side: Side, round: bool) -> Self {
        let mut parts = self.parts().clone();
        parts.closed.0 = round;
        for k in [1, 3] {
            parts.borders[k] = Border::straight(side.clone());
        }
        Self::new(parts)
    }
}
