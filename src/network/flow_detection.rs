//! Finds flows from node lists alone [Koh & Park 1990, §4.2].
//!
//! Every division into families that could be a flow is laid out completely; the first one that holds wins, and of
//! those that fail the one nearest to success says what is missing.

use super::flow::{Flow, FlowFault, FlowKind, FlowOptions, Member, NodeList};
use super::layout::{Layout, lay_out};
use crate::base::job;

/// A ring with the places where the other family passes it: all of them, and there are one or two.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// Place in the list of curves.
    pub curve: usize,
    /// Its meetings with the curves that cross it, in their order.
    pub passages: Vec<Passage>,
}

/// A place where a curve crosses a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Fraction on the ring.
    pub at: f64,
    /// Place of the curve in the list of curves.
    pub by: usize,
    /// Fraction on that curve.
    pub there: f64,
}

/// Node lists in order of writing, and who decides what they cannot.
pub struct Grid<'a> {
    /// One list per curve.
    pub lists: &'a [NodeList],
    /// Whether two neighbouring rings run the same way, asked where at most two curves cross them.
    pub same_way: &'a dyn Fn(&Ring, &Ring) -> bool,
}

/// A division into families, to be laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct Division {
    /// Curves along v.
    pub phi: Vec<usize>,
    /// Curves along u.
    pub psi: Vec<usize>,
    /// Nodes in which all Φ end.
    pub poles: Vec<usize>,
}

/// The flow of curves with these node lists; taken as drawn where rings could run either way.
pub fn detect(lists: &[NodeList], options: &FlowOptions) -> Result<Flow, FlowFault> {
    detect_grid(&Grid { lists, same_way: &|_, _| true }, options)
}

/// [`detect`] with somebody who decides the way of rings.
pub fn detect_grid(grid: &Grid, options: &FlowOptions) -> Result<Flow, FlowFault> {
    let n = grid.lists.len();
    if n < 2 {
        return Err(FlowFault::TooFew { given: n });
    }
    if let Some(flow) = triangle(grid, options) {
        return Ok(flow);
    }
    let mut best: Option<(f64, FlowFault)> = None;
    let mut offer = |score: f64, fault: FlowFault| {
        if best.is_none_or(|(held, _)| score > held) {
            best = Some((score, fault));
        }
    };
    for division in divisions(grid, options, &mut offer) {
        job::poll();
        match lay_out(&Layout { grid, division: &division, options }) {
            Ok(flow) => return Ok(flow),
            Err((score, fault)) => offer(score, fault),
        }
    }
    Err(match (best, options.pole) {
        (Some((_, fault)), _) => fault,
        (None, Some(node)) => FlowFault::NoPole { node },
        (None, None) => FlowFault::TooFew { given: n },
    })
}

/// Nodes that two curves share, each once.
pub fn shared(a: &NodeList, b: &NodeList) -> Vec<usize> {
    let mut nodes: Vec<usize> = a.nodes.iter().copied().filter(|n| b.nodes.contains(n)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Three curves, each pair with one node of its own.
fn triangle(grid: &Grid, options: &FlowOptions) -> Option<Flow> {
    let lists = grid.lists;
    let hinted = options.along_v.len() == 2 || options.along_u.len() > 1;
    if lists.len() != 3 || options.pole.is_some() || hinted || options.closed || lists.iter().any(NodeList::is_closed) {
        return None;
    }
    let first = options.along_u.first().copied().unwrap_or(0);
    let (second, third) = ((first + 1) % 3, (first + 2) % 3);
    let pair = |a: usize, b: usize| match shared(&lists[a], &lists[b]).as_slice() {
        [one] => Some(*one),
        _ => None,
    };
    let (with_second, with_third, top) = (pair(first, second)?, pair(first, third)?, pair(second, third)?);
    if with_second == with_third || with_second == top || with_third == top {
        return None;
    }
    // Vertex 0 is where the first curve begins.
    let begins_at_second = lists[first].position(with_second) < lists[first].position(with_third);
    let (left, slant, v0, v1) =
        if begins_at_second { (second, third, with_second, with_third) } else { (third, second, with_third, with_second) };
    let member = |curve: usize, from: usize, to: usize| {
        let crossings: Vec<f64> = [from, to].iter().filter_map(|&n| lists[curve].position(n)).collect();
        Member { curve, reversed: crossings[1] < crossings[0], crossings }
    };
    let mut flow = Flow {
        kind: FlowKind::UniformTrilateral,
        along_u: vec![member(first, v0, v1)],
        along_v: vec![member(left, v0, top), member(slant, v1, top)],
        closed_u: false,
        closed_v: false,
        poles: (None, None),
        overhangs: Vec::new(),
    };
    flow.overhangs = super::layout::overhangs(&flow);
    Some(flow)
}

/// Divisions worth laying out, the likeliest first; what rules a division out beforehand is offered as a fault.
fn divisions(grid: &Grid, options: &FlowOptions, offer: &mut dyn FnMut(f64, FlowFault)) -> Vec<Division> {
    let mut found = poles(grid, options, 2);
    if options.pole.is_none() {
        found.extend(two_families(grid, options, offer));
    }
    found.extend(poles(grid, options, 1));
    found.retain(|d| {
        let fits = options.along_u.iter().all(|c| d.psi.contains(c)) && options.along_v.iter().all(|c| d.phi.contains(c));
        if !fits && let Some(&node) = d.poles.first() {
            offer(0.0, FlowFault::NoPole { node });
        }
        fits
    });
    found
}

/// Divisions with one or two poles: the curves that end in a node run along v, the others along u.
fn poles(grid: &Grid, options: &FlowOptions, count: usize) -> Vec<Division> {
    let lists = grid.lists;
    let mut ends: Vec<usize> = lists.iter().filter(|l| !l.is_closed()).flat_map(|l| [l.nodes[0], l.nodes[l.nodes.len() - 1]]).collect();
    ends.sort_unstable();
    ends.dedup();
    let mut found: Vec<Division> = Vec::new();
    for &pole in &ends {
        let (phi, psi): (Vec<usize>, Vec<usize>) = (0..lists.len()).partition(|&c| lists[c].ends_at(pole));
        if phi.len() < 2 {
            continue;
        }
        let poles = if count == 1 {
            vec![pole]
        } else {
            let far = |c: usize| if lists[c].nodes[0] == pole { lists[c].nodes[lists[c].nodes.len() - 1] } else { lists[c].nodes[0] };
            let other = far(phi[0]);
            if other <= pole || phi.iter().any(|&c| far(c) != other) {
                continue;
            }
            vec![pole, other]
        };
        if options.pole.is_none_or(|named| poles.contains(&named)) && (count == 2 || !psi.is_empty()) {
            found.push(Division { phi, psi, poles });
        }
    }
    found
}

/// Divisions without poles: the two colours of the graph of meetings.
fn two_families(grid: &Grid, options: &FlowOptions, offer: &mut dyn FnMut(f64, FlowFault)) -> Vec<Division> {
    let n = grid.lists.len();
    if options.along_u.len() + options.along_v.len() == n {
        return vec![Division { phi: options.along_v.clone(), psi: options.along_u.clone(), poles: Vec::new() }];
    }
    let mut edges: Vec<(usize, usize)> = Vec::new();
    for a in 0..n {
        edges.extend((a + 1..n).filter(|&b| !shared(&grid.lists[a], &grid.lists[b]).is_empty()).map(|b| (a, b)));
    }
    if let Some(curve) = (0..n).find(|&c| edges.iter().all(|&(a, b)| a != c && b != c)) {
        offer(TELLING, FlowFault::Alone { curve });
        return Vec::new();
    }
    match colours(n, &edges, None) {
        Ok(parts) => combinations(n, &parts, options),
        Err((a, b)) => {
            // One meeting too many, when without it the rest is a grid.
            if n <= SEARCHED {
                for &extra in &edges {
                    let Ok(parts) = colours(n, &edges, Some(extra)) else { continue };
                    let grids = combinations(n, &parts, options);
                    if grids.iter().any(|d| d.phi.len() * d.psi.len() + 1 == edges.len() && d.phi.len() > 1 && d.psi.len() > 1) {
                        let node = shared(&grid.lists[extra.0], &grid.lists[extra.1])[0];
                        offer(1.0, FlowFault::Crosses { a: extra.0, b: extra.1, node });
                        return Vec::new();
                    }
                }
            }
            let node = shared(&grid.lists[a], &grid.lists[b])[0];
            offer(SLIGHT, FlowFault::NoFamilies { a, b, node });
            Vec::new()
        }
    }
}

/// Score of a failure that says more than missing crossings would.
const TELLING: f64 = 0.9;
/// Score of a failure that says little.
const SLIGHT: f64 = 0.01;
/// Up to this many curves the one meeting too many is searched for.
const SEARCHED: usize = 24;
/// Up to this many separate parts all ways to join their families are tried.
const PARTS: usize = 8;

/// Two colours per connected part, as lists of curves; or two curves that meet and have one colour.
fn colours(n: usize, edges: &[(usize, usize)], without: Option<(usize, usize)>) -> Result<Vec<[Vec<usize>; 2]>, (usize, usize)> {
    let mut colour: Vec<Option<usize>> = vec![None; n];
    let mut parts = Vec::new();
    for first in 0..n {
        job::poll();
        if colour[first].is_some() {
            continue;
        }
        colour[first] = Some(0);
        let (mut part, mut queue, mut next) = ([Vec::new(), Vec::new()], vec![first], 0);
        while next < queue.len() {
            let a = queue[next];
            next += 1;
            let own = colour[a].unwrap_or(0);
            part[own].push(a);
            for &(p, q) in edges.iter().filter(|&&e| Some(e) != without) {
                let b = if p == a {
                    q
                } else if q == a {
                    p
                } else {
                    continue;
                };
                match colour[b] {
                    None => {
                        colour[b] = Some(1 - own);
                        queue.push(b);
                    }
                    Some(c) if c == own => return Err((a.min(b), a.max(b))),
                    Some(_) => {}
                }
            }
        }
        parts.push(part);
    }
    Ok(parts)
}

/// All ways to join the colours of separate parts to two families; the one of the first curve runs along u.
fn combinations(n: usize, parts: &[[Vec<usize>; 2]], options: &FlowOptions) -> Vec<Division> {
    let free = parts.len().saturating_sub(1).min(PARTS);
    let mut found = Vec::new();
    for flips in 0..1_usize << free {
        job::poll();
        let mut families = [Vec::with_capacity(n), Vec::with_capacity(n)];
        for (k, part) in parts.iter().enumerate() {
            let flip = k > 0 && k <= free && flips >> (k - 1) & 1 == 1;
            families[usize::from(flip)].extend(&part[0]);
            families[usize::from(!flip)].extend(&part[1]);
        }
        for family in &mut families {
            family.sort_unstable();
        }
        let [psi, phi] = families;
        // Curve 0 is in the first colour of the first part; only a hint puts it along v.
        let swap = options.along_u.iter().any(|c| phi.contains(c)) || options.along_v.iter().any(|c| psi.contains(c));
        found.push(if swap { Division { phi: psi, psi: phi, poles: Vec::new() } } else { Division { phi, psi, poles: Vec::new() } });
    }
    found
}
