//! Faces of a plane graph in (u, v): loops with the face on their left, and which loop lies in which.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use crate::base::math;

/// An edge of the graph with the directions in which it leaves its ends.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    /// Its first and last vertex.
    pub ends: (usize, usize),
    /// Directions out of the first and out of the last.
    pub out: (DVec2, DVec2),
}

/// Half an edge: its number and whether it is run backwards.
pub(crate) type Half = (usize, bool);

/// The half edge that follows each one round the face on its left.
pub(crate) fn followers(edges: &[Edge]) -> BTreeMap<Half, Half> {
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
pub(crate) fn loops(next: &BTreeMap<Half, Half>) -> Vec<Vec<Half>> {
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

/// Whether loops are those of a plane graph, as many as Euler's formula asks for; else edges cross or leave a vertex in a wrong order.
pub(crate) fn is_plane(edges: &[Edge], rows: &[Vec<Half>]) -> bool {
    let vertices: BTreeSet<usize> = edges.iter().flat_map(|edge| [edge.ends.0, edge.ends.1]).collect();
    let graph = components(edges);
    let parts = vertices.iter().filter(|vertex| graph[**vertex] == **vertex).count();
    rows.len() + vertices.len() == edges.len() + 2 * parts
}

/// The edges of a plane graph that one loop runs both ways: without them what they join falls apart, and they part nothing.
pub(crate) fn bridges(rows: &[Vec<Half>]) -> BTreeSet<usize> {
    let twice = |row: &Vec<Half>| {
        let mut edges: Vec<usize> = row.iter().map(|half| half.0).collect();
        edges.sort_unstable();
        edges.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect::<Vec<_>>()
    };
    rows.iter().flat_map(twice).collect()
}

/// A number for each vertex, the same for those that edges join.
pub(crate) fn components(edges: &[Edge]) -> Vec<usize> {
    let n = edges.iter().map(|e| e.ends.0.max(e.ends.1) + 1).max().unwrap_or(0);
    let mut of: Vec<usize> = (0..n).collect();
    fn root(of: &mut [usize], mut k: usize) -> usize {
        while of[k] != k {
            of[k] = of[of[k]];
            k = of[k];
        }
        k
    }
    for edge in edges {
        let (a, b) = (root(&mut of, edge.ends.0), root(&mut of, edge.ends.1));
        of[a.max(b)] = a.min(b);
    }
    (0..n).map(|k| root(&mut of, k)).collect()
}

/// Edges without those that hang on one site only, again and again; `true` for those that stay. A site is where vertices are one
/// point; edges that are `bare` stand for none and stay.
pub(crate) fn without_tails(edges: &[Edge], sites: &[usize], bare: &[bool]) -> Vec<bool> {
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
