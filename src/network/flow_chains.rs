//! Flows of chains: meetings become node lists, node lists become a flow, failures get their measurements.

use crate::network::fault::GridFault;
use glam::DVec3;

use super::chain::Chain;
use super::flow::{Flow, FlowFault, FlowOptions, NodeList};
use super::flow_detection::{Grid, detect_grid, shared};
use super::meet::{closest_points, meet};
use super::ring_way::same_way;
use super::snap::may_snap;
use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::network::fault::NoFlow;
use crate::network::fault::{CurveEnd, EndFault};

/// What the script says about a flow of chains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChainFlow {
    /// `u:`: places, in the list of chains, of those said to run along u.
    pub along_u: Vec<usize>,
    /// `v:`: places of those said to run along v.
    pub along_v: Vec<usize>,
    /// `pole:`
    pub pole: Option<DVec3>,
    /// `closed: true`
    pub closed: bool,
}

/// A place on a chain that a node stands for.
#[derive(Clone, Copy, Debug)]
struct Mark {
    chain: usize,
    f: f64,
    node: usize,
}

/// The flow of chains in order of writing, with the points of its nodes (poles are indices into them).
///
/// Pieces beyond the border are in [`Flow::overhangs`]. Fails with E501 when two border ends miss each other and the
/// flow would be found with a larger tolerance, else with E601–E605.
pub fn of_chains(chains: &[Chain], options: &ChainFlow, tolerance: &Tolerance) -> Result<(Flow, Vec<DVec3>)> {
    let (nodes, lists) = node_lists(chains, tolerance)?;
    let pole = match options.pole {
        None => None,
        Some(p) => Some(nearest(&nodes, p, tolerance).ok_or_else(|| no_pole(chains, p))?),
    };
    let hints = FlowOptions { along_u: options.along_u.clone(), along_v: options.along_v.clone(), pole, closed: options.closed };
    let grid = Grid { lists: &lists, same_way: &|a, b| same_way(chains, a, b, tolerance) };
    match detect_grid(&grid, &hints) {
        Ok(flow) => Ok((flow, nodes)),
        Err(fault) => Err(Meetings { chains, nodes: &nodes, lists: &lists }.explain(fault, &hints, tolerance)),
    }
}

/// Nodes of chains by themselves: ends and meetings, as points and one list per chain.
pub fn node_lists(chains: &[Chain], tolerance: &Tolerance) -> Result<(Vec<DVec3>, Vec<NodeList>)> {
    let n = chains.len();
    let boxes: Vec<_> = chains.iter().map(Chain::bbox).collect();
    let mut pairs = Vec::new();
    for a in 0..n {
        pairs.extend((a + 1..n).filter(|&b| boxes[a].touches(&boxes[b], tolerance.point)).map(|b| (a, b)));
    }
    let meetings = par::try_map(pairs.len(), |k| meet(&chains[pairs[k].0], &chains[pairs[k].1], tolerance))?;
    let mut marks = Vec::new();
    let mut nodes: Vec<DVec3> = Vec::new();
    let mut mark = |chain: usize, f: f64, point: DVec3, node: Option<usize>| {
        let node = node.or_else(|| nodes.iter().position(|p| tolerance.same_point(*p, point))).unwrap_or_else(|| {
            nodes.push(point);
            nodes.len() - 1
        });
        marks.push(Mark { chain, f, node });
        node
    };
    for (k, chain) in chains.iter().enumerate() {
        let first = mark(k, 0.0, chain.start(), None);
        mark(k, 1.0, chain.end(), chain.is_closed(tolerance).then_some(first));
    }
    for (&(a, b), found) in pairs.iter().zip(&meetings) {
        for m in found {
            let node = mark(a, m.fa, m.point, None);
            mark(b, m.fb, m.point, Some(node));
            if let Some((fa, fb)) = m.overlap_end {
                let node = mark(a, fa, chains[a].point(fa), None);
                mark(b, fb, chains[a].point(fa), Some(node));
            }
        }
    }
    marks.sort_by(|x, y| x.chain.cmp(&y.chain).then(x.f.total_cmp(&y.f)));
    let mut lists = vec![NodeList { nodes: Vec::new(), at: Vec::new() }; n];
    for m in &marks {
        let list = &mut lists[m.chain];
        let reach = REACH * tolerance.point / chains[m.chain].length();
        let repeats = list.nodes.last() == Some(&m.node) && list.at.last().is_some_and(|at| m.f - at <= reach);
        if !repeats {
            list.nodes.push(m.node);
            list.at.push(m.f);
        } else if m.f == 1.0 && list.at.len() > 1 {
            // The end itself, rather than a hit a hair before it.
            list.at.pop();
            list.at.push(1.0);
        }
    }
    Ok((nodes, lists))
}

/// Marks of one node are at most this many tolerances apart along a chain.
const REACH: f64 = 4.0;

fn nearest(nodes: &[DVec3], p: DVec3, tolerance: &Tolerance) -> Option<usize> {
    let near = |k: &usize| nodes[*k].distance(p);
    (0..nodes.len()).min_by(|a, b| near(a).total_cmp(&near(b))).filter(|k| near(k) <= tolerance.point)
}

fn no_pole(chains: &[Chain], pole: DVec3) -> Fault {
    let ends = chains.iter().flat_map(|c| [c.start(), c.end()]);
    let nearest = ends.min_by(|a, b| a.distance_squared(pole).total_cmp(&b.distance_squared(pole))).unwrap_or(pole);
    GridFault::FlowUnknown { curves: origins(chains), why: NoFlow::NoPole { pole, nearest } }.into()
}

fn origins(chains: &[Chain]) -> Vec<Origin> {
    chains.iter().map(Chain::origin).collect()
}

/// Chains with the nodes in which they meet, and the list of nodes of each.
#[derive(Clone, Copy)]
pub(super) struct Meetings<'a> {
    pub chains: &'a [Chain],
    pub nodes: &'a [DVec3],
    pub lists: &'a [NodeList],
}

impl Meetings<'_> {
    /// A failure of node lists in measurements. Ends that miss by a little are the cause of all that follows from it.
    pub(super) fn explain(&self, fault: FlowFault, hints: &FlowOptions, tolerance: &Tolerance) -> Fault {
        let Self { chains, nodes, lists } = *self;
        if chains.len() > FLOW_SIDES && is_ring(lists) {
            return GridFault::FlowUnknown { curves: origins(chains), why: NoFlow::Ring { sides: chains.len() } }.into();
        }
        if matches!(fault, FlowFault::Incomplete { .. } | FlowFault::Alone { .. } | FlowFault::TooFew { .. })
            && let Some(miss) = ends_that_miss(chains, lists, hints, tolerance)
        {
            return miss;
        }
        let origin = |k: usize| chains[k].origin();
        let unknown = |why: NoFlow| GridFault::FlowUnknown { curves: origins(chains), why };
        match fault {
            FlowFault::TooFew { given } => unknown(NoFlow::TooFewCurves { given }),
            FlowFault::Alone { curve } => {
                let (gap, nearest, at) = (0..chains.len())
                    .filter(|&k| k != curve)
                    .map(|k| (closest_points(&chains[curve], &chains[k]), k))
                    .map(|((p, q), k)| (p.distance(q), k, p))
                    .min_by(|a, b| a.0.total_cmp(&b.0))
                    .unwrap_or((0.0, curve, chains[curve].start()));
                unknown(NoFlow::Alone { curve: origin(curve), nearest: origin(nearest), gap, at })
            }
            FlowFault::NoFamilies { a, b, node } => unknown(NoFlow::NoFamilies { a: origin(a), b: origin(b), at: nodes[node] }),
            FlowFault::Incomplete { a, b, found, wanted } => {
                let (p, q) = closest_points(&chains[a], &chains[b]);
                GridFault::GridIncomplete { a: origin(a), b: origin(b), gap: p.distance(q), at: p, found, wanted }
            }
            FlowFault::Double { a, b, nodes: (one, two) } => {
                GridFault::GridDouble { a: origin(a), b: origin(b), first: nodes[one], second: nodes[two] }
            }
            FlowFault::NotMonotone { curve, others: (a, b), nodes: (one, two) } => {
                GridFault::GridNotMonotone { curve: origin(curve), a: origin(a), b: origin(b), first: nodes[one], second: nodes[two] }
            }
            FlowFault::Crosses { a, b, node } => GridFault::FamilyCrosses { a: origin(a), b: origin(b), at: nodes[node] },
            FlowFault::HalfClosed { closed, open } => unknown(NoFlow::HalfClosed { closed: origin(closed), open: origin(open) }),
            FlowFault::NotClosed { open } => unknown(NoFlow::NotClosed { open: origin(open) }),
            FlowFault::NoPole { node } => return no_pole(chains, nodes[node]),
        }
        .into()
    }
}

/// Most sides of a flow.
const FLOW_SIDES: usize = 4;

/// Whether curves meet at their ends alone, each with one other at either end, and close one loop.
fn is_ring(lists: &[NodeList]) -> bool {
    let (mut at, mut here) = (0, lists[0].nodes[0]);
    let mut met = 0;
    loop {
        let [a, b] = lists[at].nodes[..] else { return false };
        here = if a == here { b } else { a };
        met += 1;
        let mut others = (0..lists.len()).filter(|k| *k != at && lists[*k].nodes.contains(&here));
        match (others.next(), others.next()) {
            (Some(0), None) => return met == lists.len(),
            (Some(next), None) if met < lists.len() => at = next,
            _ => return false,
        }
    }
}

/// Joins pairs of ends, the nearest first, until the flow is found: the widest of the gaps that had to close is the miss.
fn ends_that_miss(chains: &[Chain], lists: &[NodeList], hints: &FlowOptions, tolerance: &Tolerance) -> Option<Fault> {
    if chains.len() > JOINED {
        return None;
    }
    let end = |k: usize, last: bool| CurveEnd { of: chains[k].origin(), last, at: if last { chains[k].end() } else { chains[k].start() } };
    let node =
        |lists: &[NodeList], k: usize, last: bool| if last { lists[k].nodes.last().copied() } else { lists[k].nodes.first().copied() };
    let mut misses = Vec::new();
    for a in 0..chains.len() {
        job::poll();
        for b in a + 1..chains.len() {
            if !shared(&lists[a], &lists[b]).is_empty() {
                continue;
            }
            let ends = [(false, false), (false, true), (true, false), (true, true)];
            misses.extend(ends.map(|(x, y)| (end(a, x).at.distance(end(b, y).at), (a, x), (b, y))));
        }
    }
    misses.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut lists = lists.to_vec();
    for (_, (a, x), (b, y)) in misses {
        let (keep, drop) = (node(&lists, a, x)?, node(&lists, b, y)?);
        for n in lists.iter_mut().flat_map(|list| &mut list.nodes).filter(|n| **n == drop) {
            *n = keep;
        }
        let grid = Grid { lists: &lists, same_way: &|_, _| true };
        if detect_grid(&grid, hints).is_ok() {
            let near = may_snap(end(a, x).at.distance(end(b, y).at), chains[a].length().min(chains[b].length()));
            return Some(EndFault::EndsMiss { a: end(a, x), b: end(b, y), near, tolerance: tolerance.point }.into());
        }
    }
    None
}

/// Up to this many chains the ends that miss are searched for.
const JOINED: usize = 16;
