//! Lays a division into families out as a flow: completeness, orders, directions, borders [Koh & Park 1990, §4.2].

use super::flow::{Flow, FlowFault, FlowKind, FlowOptions, Member, NodeList, Overhang};
use super::flow_detection::{Division, Grid, Passage, Ring, shared};

/// A division with what it is judged by.
pub struct Layout<'a> {
    /// The node lists.
    pub grid: &'a Grid<'a>,
    /// The families.
    pub division: &'a Division,
    /// What the caller knows.
    pub options: &'a FlowOptions,
}

/// A fault with the share of success before it, 0…1.
type Failure = (f64, FlowFault);

/// The flow, or the share of crossings found and what is wrong.
pub fn lay_out(layout: &Layout) -> Result<Flow, Failure> {
    let (lists, Division { phi, psi, poles }) = (layout.grid.lists, layout.division);
    let crossings = crossings(layout)?;
    let closed_u = if psi.is_empty() { layout.options.closed } else { closure(lists, psi)? };
    let closed_v = poles.is_empty() && closure(lists, phi)?;
    if layout.options.closed && !closed_u && !closed_v {
        return Err((1.0, FlowFault::NotClosed { open: psi.first().copied().unwrap_or(phi[0]) }));
    }
    enough(layout, closed_u, closed_v)?;
    let along = |curve: usize, m: usize, n: usize| lists[curve].position(crossings[m][n]).unwrap_or(0.0);

    // Order of Φ along the first Ψ written, whose direction is +u.
    let mut columns: Vec<usize> = (0..phi.len()).collect();
    if let Some(&first) = psi.first() {
        columns.sort_by(|&a, &b| along(first, a, 0).total_cmp(&along(first, b, 0)));
    }
    let mut rows: Vec<usize> = (0..psi.len()).collect();
    let guide = guide(layout, columns[0]);
    let turned = guide_turned(layout, phi[guide], &rows, |n| along(phi[guide], guide, n), closed_v);
    rows.sort_by(|&a, &b| along(phi[guide], guide, a).total_cmp(&along(phi[guide], guide, b)));
    if turned {
        rows.reverse();
    }
    if closed_v {
        let start = rows.iter().position(|&n| n == 0).unwrap_or(0);
        rows.rotate_left(start);
    }

    let ring = |curve: usize, others: &[(usize, f64, f64)]| Ring {
        curve,
        passages: others.iter().map(|&(by, at, there)| Passage { at, by, there }).collect(),
    };
    let row_ways = closed_u.then(|| {
        let passed = |n: usize| columns.iter().map(|&m| (phi[m], along(psi[n], m, n), along(phi[m], m, n))).collect::<Vec<_>>();
        let rings: Vec<Ring> = rows.iter().map(|&n| ring(psi[n], &passed(n))).collect();
        ways(layout.grid, &rings, rows.iter().position(|&n| n == 0).unwrap_or(0))
    });
    let mut along_u = Vec::with_capacity(psi.len());
    for (k, &n) in rows.iter().enumerate() {
        let at: Vec<f64> = columns.iter().map(|&m| along(psi[n], m, n)).collect();
        let nodes: Vec<usize> = columns.iter().map(|&m| crossings[m][n]).collect();
        let others: Vec<usize> = columns.iter().map(|&m| phi[m]).collect();
        let reversed = direction(psi[n], &at, row_ways.as_ref().map(|ways| ways[k]), &others, &nodes)?;
        along_u.push(Member { curve: psi[n], reversed, crossings: at });
    }
    let column_ways = closed_v.then(|| {
        let passed = |m: usize| rows.iter().map(|&n| (psi[n], along(phi[m], m, n), along(psi[n], m, n))).collect::<Vec<_>>();
        let rings: Vec<Ring> = columns.iter().map(|&m| ring(phi[m], &passed(m))).collect();
        ways(layout.grid, &rings, columns.iter().position(|&m| m == guide).unwrap_or(0))
    });
    let start_pole = start_pole(layout, guide);
    let mut along_v = Vec::with_capacity(phi.len());
    for (k, &m) in columns.iter().enumerate() {
        let at: Vec<f64> = rows.iter().map(|&n| along(phi[m], m, n)).collect();
        let nodes: Vec<usize> = rows.iter().map(|&n| crossings[m][n]).collect();
        let others: Vec<usize> = rows.iter().map(|&n| psi[n]).collect();
        let reversed = match start_pole {
            Some(pole) => {
                let reversed = lists[phi[m]].nodes[0] != pole;
                monotone(phi[m], &at, reversed, &others, &nodes)?;
                reversed
            }
            None => direction(phi[m], &at, column_ways.as_ref().map(|ways| ways[k]), &others, &nodes)?,
        };
        along_v.push(Member { curve: phi[m], reversed, crossings: at });
    }
    let kind = match poles.len() {
        0 => FlowKind::Quadrilateral,
        1 => FlowKind::DegenerateTrilateral,
        _ => FlowKind::DegenerateBilateral,
    };
    let end_pole = start_pole.and_then(|start| poles.iter().copied().find(|&p| p != start));
    let mut flow = Flow { kind, along_u, along_v, closed_u, closed_v, poles: (start_pole, end_pole), overhangs: Vec::new() };
    flow.overhangs = overhangs(&flow);
    Ok(flow)
}

/// The node in which each Φ (row) meets each Ψ (column).
fn crossings(layout: &Layout) -> Result<Vec<Vec<usize>>, Failure> {
    let (lists, Division { phi, psi, poles }) = (layout.grid.lists, layout.division);
    let wanted = phi.len() * psi.len();
    let (mut found, mut first_missing, mut double) = (0, None, None);
    let mut table = vec![Vec::with_capacity(psi.len()); phi.len()];
    for (row, &a) in table.iter_mut().zip(phi) {
        for &b in psi {
            let nodes: Vec<usize> = shared(&lists[a], &lists[b]).into_iter().filter(|n| !poles.contains(n)).collect();
            match nodes.as_slice() {
                [] => first_missing = first_missing.or(Some((a.min(b), a.max(b)))),
                [_] => found += 1,
                [one, two, ..] => double = double.or(Some(FlowFault::Double { a: a.min(b), b: a.max(b), nodes: (*one, *two) })),
            }
            row.push(nodes.first().copied().unwrap_or(usize::MAX));
        }
    }
    let share = if wanted == 0 { 0.0 } else { found as f64 / wanted as f64 };
    for family in [phi, psi] {
        for (k, &a) in family.iter().enumerate() {
            for &b in &family[k + 1..] {
                if let Some(&node) = shared(&lists[a], &lists[b]).iter().find(|n| !poles.contains(n)) {
                    return Err((0.5 * share, FlowFault::Crosses { a, b, node }));
                }
            }
        }
    }
    match (first_missing, double) {
        (Some((a, b)), _) => Err((share, FlowFault::Incomplete { a, b, found, wanted })),
        (None, Some(double)) => Err((share, double)),
        (None, None) => Ok(table),
    }
}

/// Whether all curves of a family are closed; a mixture is a fault.
fn closure(lists: &[NodeList], family: &[usize]) -> Result<bool, Failure> {
    let closed = family.iter().copied().find(|&c| lists[c].is_closed());
    let open = family.iter().copied().find(|&c| !lists[c].is_closed());
    match (closed, open) {
        (Some(closed), Some(open)) => Err((1.0, FlowFault::HalfClosed { closed, open })),
        (closed, _) => Ok(closed.is_some()),
    }
}

/// Two curves span an open direction; one is enough where it closes or a pole stands for the other.
fn enough(layout: &Layout, closed_u: bool, closed_v: bool) -> Result<(), Failure> {
    let Division { phi, psi, poles } = layout.division;
    let across_u = phi.len() >= if closed_u { 1 } else { 2 };
    let across_v = psi.len() + poles.len() >= if closed_v { 1 } else { 2 };
    if across_u && across_v { Ok(()) } else { Err((0.5, FlowFault::TooFew { given: layout.grid.lists.len() })) }
}

/// The Φ that orders the Ψ and gives +v between poles: the first curve written when it is one, else Φ at u = 0.
fn guide(layout: &Layout, first_column: usize) -> usize {
    let Division { phi, psi, .. } = layout.division;
    if psi.first().is_none_or(|&c| phi[0] < c) && !layout.division.poles.is_empty() { 0 } else { first_column }
}

/// Whether +v runs against the guide.
fn guide_turned(layout: &Layout, guide: usize, rows: &[usize], along: impl Fn(usize) -> f64, closed_v: bool) -> bool {
    if let Some(pole) = start_pole(layout, layout.division.phi.iter().position(|&c| c == guide).unwrap_or(0)) {
        return layout.grid.lists[guide].nodes[0] != pole;
    }
    if closed_v {
        return false;
    }
    // Of the two outer Ψ the first written is v = 0.
    let lowest = rows.iter().copied().min_by(|&a, &b| along(a).total_cmp(&along(b)));
    let highest = rows.iter().copied().max_by(|&a, &b| along(a).total_cmp(&along(b)));
    highest < lowest
}

/// The pole at v = 0: the named one, the only one, else the start of the guide.
fn start_pole(layout: &Layout, guide: usize) -> Option<usize> {
    let Division { phi, poles, .. } = layout.division;
    match (poles.as_slice(), layout.options.pole) {
        ([], _) => None,
        ([one], _) => Some(*one),
        (_, Some(named)) => Some(named),
        (_, None) => Some(layout.grid.lists[phi[guide]].nodes[0]),
    }
}

/// Whether each ring runs against the one at place `first`, from neighbour to neighbour: only where at most two curves pass
/// them, as the order of more than two decides.
fn ways(grid: &Grid, rings: &[Ring], first: usize) -> Vec<bool> {
    let mut ways = vec![false; rings.len()];
    if rings.iter().any(|ring| ring.passages.len() > 2) {
        return ways;
    }
    let upward = (first + 1..rings.len()).map(|k| (k - 1, k));
    for (from, to) in upward.chain((0..first).rev().map(|k| (k + 1, k))) {
        ways[to] = ways[from] == (grid.same_way)(&rings[from], &rings[to]);
    }
    ways
}

/// Whether a curve meets the others in falling order; rings (`way`) by their cyclic order, or as `way` says where they have none.
fn direction(curve: usize, at: &[f64], way: Option<bool>, others: &[usize], nodes: &[usize]) -> Result<bool, Failure> {
    let Some(way) = way else {
        let reversed = at.len() > 1 && at[at.len() - 1] < at[0];
        monotone(curve, at, reversed, others, nodes)?;
        return Ok(reversed);
    };
    if at.len() <= 2 {
        return Ok(way);
    }
    // From the first crossing on, fractions rise or fall all the way round.
    let turns: Vec<f64> = at.iter().map(|f| (f - at[0]).rem_euclid(1.0)).collect();
    let reversed = turns[turns.len() - 1] < turns[1];
    let ordered: Vec<f64> = if reversed { turns.iter().map(|t| (1.0 - t).rem_euclid(1.0)).collect() } else { turns };
    monotone(curve, &ordered, false, others, nodes)?;
    Ok(reversed)
}

fn monotone(curve: usize, at: &[f64], reversed: bool, others: &[usize], nodes: &[usize]) -> Result<(), Failure> {
    match at.windows(2).position(|w| if reversed { w[1] >= w[0] } else { w[1] <= w[0] }) {
        None => Ok(()),
        Some(k) => Err((1.0, FlowFault::NotMonotone { curve, others: (others[k], others[k + 1]), nodes: (nodes[k], nodes[k + 1]) })),
    }
}

/// What lies beyond the first and last crossing of open curves; an end in a pole lies on the border.
pub fn overhangs(flow: &Flow) -> Vec<Overhang> {
    let mut found = Vec::new();
    let rows = flow.along_u.iter().filter(|_| !flow.closed_u).map(|m| (m, false, false));
    let columns = flow.along_v.iter().filter(|_| !flow.closed_v).map(|m| (m, flow.poles.0.is_some(), flow.poles.1.is_some()));
    for (member, pole_first, pole_last) in rows.chain(columns) {
        let (low, high) = member.crossings.iter().fold((1.0_f64, 0.0_f64), |(lo, hi), &f| (lo.min(f), hi.max(f)));
        let (pole_low, pole_high) = if member.reversed { (pole_last, pole_first) } else { (pole_first, pole_last) };
        if !pole_low && low > 0.0 && low < 1.0 {
            found.push(Overhang { curve: member.curve, piece: (0.0, low) });
        }
        if !pole_high && high < 1.0 && high > 0.0 {
            found.push(Overhang { curve: member.curve, piece: (high, 1.0) });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::flow_detection::detect;
    use super::*;

    /// Lists as words of letters, one per node.
    fn lists(words: &[&str]) -> Vec<NodeList> {
        words.iter().map(|w| NodeList::evenly(&w.bytes().map(|b| usize::from(b - b'A')).collect::<Vec<_>>())).collect()
    }

    fn found(words: &[&str]) -> Flow {
        detect(&lists(words), &FlowOptions::default()).unwrap()
    }

    fn curves(members: &[Member]) -> Vec<(usize, bool)> {
        members.iter().map(|m| (m.curve, m.reversed)).collect()
    }

    #[test]
    fn the_first_curve_sets_u_and_the_first_outer_one_sets_v() {
        // a: A→B, then the others in any order and direction.
        let flow = found(&["AB", "CB", "CD", "DA"]);
        assert_eq!(curves(&flow.along_u), [(0, false), (2, true)]);
        assert_eq!(curves(&flow.along_v), [(3, true), (1, true)]);
        let flow = found(&["AB", "AD", "BC", "DC"]);
        assert_eq!(curves(&flow.along_u), [(0, false), (3, false)]);
        assert_eq!(curves(&flow.along_v), [(1, false), (2, false)]);
    }

    #[test]
    fn an_inner_first_curve_sets_u_but_not_v() {
        // Rows ABC, DEF, GHI; the middle one is written first and backwards, then the top one.
        let flow = found(&["FED", "GHI", "ABC", "ADG", "BEH", "CFI"]);
        assert_eq!(curves(&flow.along_u), [(1, true), (0, false), (2, true)]);
        assert_eq!(curves(&flow.along_v), [(5, true), (4, true), (3, true)]);
        assert_eq!(flow.along_u[0].crossings, [1.0, 0.5, 0.0]);
    }

    #[test]
    fn overhanging_ends_are_named() {
        let flow = found(&["XABY", "CD", "EAC", "BD"]);
        assert_eq!(flow.overhangs.len(), 3);
        assert_eq!(flow.overhangs[0], Overhang { curve: 0, piece: (0.0, 1.0 / 3.0) });
    }

    #[test]
    fn rings_begin_at_the_first_crossing_of_the_first_ring() {
        let flow = found(&["ABCA", "FEDF", "BE", "DA", "CF"]);
        assert_eq!((flow.closed_u, flow.orders()), (true, (3, 1)));
        assert_eq!(curves(&flow.along_v), [(3, true), (2, false), (4, false)]);
        assert_eq!(curves(&flow.along_u), [(0, false), (1, true)]);
        assert_eq!(flow.along_u[1].crossings, [2.0 / 3.0, 1.0 / 3.0, 0.0]);
    }

    #[test]
    fn faults_say_what_is_nearest_to_success() {
        let fault = |words: &[&str]| detect(&lists(words), &FlowOptions::default()).unwrap_err();
        assert_eq!(fault(&["AEB", "DC", "AD", "EF", "BC"]), FlowFault::Incomplete { a: 1, b: 3, found: 5, wanted: 6 });
        assert_eq!(fault(&["ABX", "CXD", "AC", "BXD"]), FlowFault::Crosses { a: 0, b: 1, node: 23 });
        assert_eq!(fault(&["AEB", "DFC", "AD", "EFX", "BXC"]), FlowFault::Crosses { a: 3, b: 4, node: 23 });
        assert_eq!(fault(&["ABC", "EDF", "AD", "BE", "CF"]), FlowFault::NotMonotone { curve: 1, others: (2, 3), nodes: (3, 4) });
        assert_eq!(fault(&["AB"]), FlowFault::TooFew { given: 1 });
        assert!(matches!(fault(&["AB", "BC", "CD", "DA", "XY"]), FlowFault::Alone { curve: 4 }));
    }
}
