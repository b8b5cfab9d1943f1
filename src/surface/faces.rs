//! Faces of a plane graph in (u, v): loops with the face on their left, and which loop lies in which.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::base::math;

/// An edge of the graph with the directions in which it leaves its ends.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    /// Its first and last vertex.
    pub ends: (usize, usize),
    /// Directions out of the first and out of the last.
    pub out: (DVec2, DVec2),
}

/// Half an edge: its number and whether it is run backwards.
pub(super) type Half = (usize, bool);

/// The half edge that follows each one round the face on its left.
pub(super) fn followers(edges: &[Edge]) -> BTreeMap<Half, Half> {
    let mut around: BTreeMap<usize, Vec<(f64, Half)>> = BTreeMap::new();
    for (k, edge) in edges.iter().enumerate() {
        let angle = |d: DVec2| math::atan2(d.y, d.x);
        around.entry(edge.ends.0).or_default().push((angle(edge.out.0), (k, false)));
        around.entry(edge.ends.1).or_default().push((angle(edge.out.1), (k, true)));
    }
    let mut next = BTreeMap::new();
    for fan in around.values_mut() {
        fan.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for i in 0..fan.len() {
            // Arriving along the twin of fan[i], the face on the left goes on along its neighbour clockwise.
            let (k, backwards) = fan[i].1;
            next.insert((k, !backwards), fan[(i + fan.len() - 1) % fan.len()].1);
        }
    }
    next
}

/// The loops of half edges.
pub(super) fn loops(next: &BTreeMap<Half, Half>) -> Vec<Vec<Half>> {
    let mut seen: BTreeMap<Half, ()> = BTreeMap::new();
    let mut out = Vec::new();
    for &start in next.keys() {
        let mut row = Vec::new();
        let mut at = start;
        while seen.insert(at, ()).is_none() {
            row.push(at);
            let Some(then) = next.get(&at) else { break };
            at = *then;
        }
        if !row.is_empty() {
            out.push(row);
        }
    }
    out
}

/// Edges without those that hang on one site only, again and again; `true` for those that stay. A site is where vertices are one
/// point; edges that are `bare` stand for none and stay.
pub(super) fn without_tails(edges: &[Edge], sites: &[usize], bare: &[bool]) -> Vec<bool> {
    let mut stays = vec![true; edges.len()];
    let ends = |k: usize| [sites[edges[k].ends.0], sites[edges[k].ends.1]];
    loop {
        let mut degree: BTreeMap<usize, usize> = BTreeMap::new();
        let held = |stays: &[bool]| (0..edges.len()).filter(|k| stays[*k] && !bare[*k]).collect::<Vec<_>>();
        for site in held(&stays).into_iter().flat_map(ends) {
            *degree.entry(site).or_default() += 1;
        }
        let loose: Vec<usize> = held(&stays).into_iter().filter(|k| ends(*k).iter().any(|site| degree[site] == 1)).collect();
        if loose.is_empty() {
            return stays;
        }
        loose.into_iter().for_each(|k| stays[k] = false);
    }
}
