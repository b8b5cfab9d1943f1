//! Nets of profiles and guides: the two families are said, what they span is found like any flow.

use std::cmp::Ordering;

use glam::DVec3;

use super::chain::Chain;
use super::flow::{Flow, FlowFault, FlowOptions, NodeList};
use super::flow_chains::{Meetings, node_lists};
use super::flow_detection::{Grid, detect_grid, shared};
use super::meet::closest_points;
use super::ring_way::same_way;
use super::snap::may_snap;
use crate::base::fault::{Fault, Result};
use crate::base::math::compare_points;
use crate::base::tolerance::Tolerance;
use crate::network::fault::NetFault;

/// Places along a curve at which two curves are compared.
const COMPARED: usize = 32;

/// Each curve once: one that runs along another over its whole length, either way, is the same curve given twice, as a net
/// closed by repeating its first curve has it. Of curves that differ within the tolerance which one is kept follows from its points,
/// not by its place in the list; it runs like the first one given.
pub fn distinct(family: Vec<Chain>, tolerance: &Tolerance) -> Vec<Chain> {
    let mut kept: Vec<Chain> = Vec::with_capacity(family.len());
    for chain in family {
        let same = kept.iter_mut().find_map(|other| runs_along(other, &chain, tolerance).map(|turned| (other, turned)));
        match same {
            None => kept.push(chain),
            Some((other, turned)) => {
                if compare(&chain, other).is_lt() {
                    *other = if turned { chain.reversed() } else { chain };
                }
            }
        }
    }
    kept
}

/// Whether `b` runs along `a`, and then whether the other way round.
fn runs_along(a: &Chain, b: &Chain, tolerance: &Tolerance) -> Option<bool> {
    let at = |k: usize| k as f64 / COMPARED as f64;
    let all = |turned: bool| {
        (0..=COMPARED).all(|k| {
            let p = b.point(if turned { 1.0 - at(k) } else { at(k) });
            tolerance.same_point(a.point(at(k)), p)
        })
    };
    let as_long = (a.length() - b.length()).abs() <= COMPARED as f64 * tolerance.point;
    [false, true].into_iter().find(|turned| as_long && all(*turned))
}

/// Order of curves by their points, whichever way they run.
fn compare(a: &Chain, b: &Chain) -> Ordering {
    let first_of = |x: DVec3, y: DVec3| if compare_points(x, y).is_lt() { x } else { y };
    let place = |chain: &Chain, k: usize| {
        let f = k as f64 / COMPARED as f64;
        first_of(chain.point(f), chain.point(1.0 - f))
    };
    (0..=COMPARED / 2).map(|k| compare_points(place(a, k), place(b, k))).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
}

/// The flow of profiles (along u) and guides (along v), with the points of its nodes; `chains` has the profiles first.
///
/// Fails with E641 where a pair misses each other, E642 where two of one family meet away from a pole, E643 where a curve
/// meets the others in an order of its own, else with E601–E605.
pub fn of_net(chains: &[Chain], profiles: usize, tolerance: &Tolerance) -> Result<(Flow, Vec<DVec3>)> {
    let (nodes, lists) = node_lists(chains, tolerance)?;
    let hints = FlowOptions { along_u: (0..profiles).collect(), along_v: (profiles..chains.len()).collect(), ..FlowOptions::default() };
    let grid = Grid { lists: &lists, same_way: &|a, b| same_way(chains, a, b, tolerance) };
    match detect_grid(&grid, &hints) {
        Ok(flow) => Ok((flow, nodes)),
        Err(fault) => Err(net_fault(&Meetings { chains, nodes: &nodes, lists: &lists }, fault, &hints, tolerance)),
    }
}

fn net_fault(meetings: &Meetings, fault: FlowFault, hints: &FlowOptions, tolerance: &Tolerance) -> Fault {
    let Meetings { chains, nodes, lists } = *meetings;
    let profiles = hints.along_u.len();
    let origin = |k: usize| chains[k].origin();
    match fault {
        FlowFault::Crosses { a, b, node } => NetFault::Cross { a: origin(a), b: origin(b), guides: a >= profiles, at: nodes[node] }.into(),
        FlowFault::NotMonotone { curve, others: (a, b), nodes: (one, two) } => NetFault::Order {
            curve: origin(curve),
            guide: curve >= profiles,
            a: origin(a),
            b: origin(b),
            first: nodes[one],
            second: nodes[two],
        }
        .into(),
        other => missing(chains, lists, profiles, tolerance).unwrap_or_else(|| meetings.explain(other, hints, tolerance)),
    }
}

/// E641 for the pair without a crossing that is farthest apart.
fn missing(chains: &[Chain], lists: &[NodeList], profiles: usize, tolerance: &Tolerance) -> Option<Fault> {
    let wanted = profiles * (chains.len() - profiles);
    let pairs = (0..profiles).flat_map(|a| (profiles..chains.len()).map(move |b| (a, b)));
    let apart: Vec<(usize, usize)> = pairs.filter(|&(a, b)| shared(&lists[a], &lists[b]).is_empty()).collect();
    let measured = apart.iter().map(|&(a, b)| {
        let (p, q) = closest_points(&chains[a], &chains[b]);
        (p.distance(q), a, b, p)
    });
    let (gap, a, b, at) = measured.max_by(|x, y| x.0.total_cmp(&y.0))?;
    let fault = NetFault::Incomplete {
        profile: chains[a].origin(),
        guide: chains[b].origin(),
        gap,
        at,
        found: wanted - apart.len(),
        wanted,
        near: may_snap(gap, chains[a].length().min(chains[b].length())),
        tolerance: tolerance.point,
    };
    Some(fault.into())
}
