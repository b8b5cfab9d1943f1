//! Glues the pieces of all surfaces: vertices within tolerance are one, edges that lie on each other are one.

use std::collections::BTreeMap;

use glam::DVec3;

use super::patches::{Pieces, RawEdge};
use super::topology::{Edge, EdgeCurve, EdgeId, Model, Named, Patch, PatchId, PatchSide, SurfaceId, Vertex, VertexId};
use crate::base::bbox::Box3;
use crate::base::boxtree::{BoxTree, PAIR};
use crate::base::job;
use crate::base::math::compare_points;
use crate::base::tolerance::Tolerance;
use crate::network::Network;
use crate::surface::Domain;

/// Groups of points that are one: for each point the index of its group; groups are numbered by first appearance.
///
/// Closeness is passed on: a chain of close points is one group. Also gives the representative of each group, its
/// first point in coordinate order.
fn cluster(points: &[DVec3], tolerance: &Tolerance) -> (Vec<usize>, Vec<DVec3>) {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| compare_points(points[a], points[b]).then(a.cmp(&b)));
    let mut parent: Vec<usize> = (0..points.len()).collect();
    let mut join = |a: usize, b: usize| {
        let (ra, rb) = (root(&mut parent, a), root(&mut parent, b));
        parent[ra.max(rb)] = ra.min(rb);
    };
    // Corners of many faces are often one place to the last bit.
    let places: Vec<&[usize]> = order.chunk_by(|a, b| points[*a] == points[*b]).collect();
    places.iter().flat_map(|place| place.windows(2)).for_each(|w| join(w[0], w[1]));
    let boxes: Vec<Box3> = places.iter().map(|place| Box3::of([points[place[0]]])).collect();
    for (a, b) in BoxTree::build(&boxes).pairs(tolerance.point, PAIR) {
        let (a, b) = (places[a as usize][0], places[b as usize][0]);
        if tolerance.same_point(points[a], points[b]) {
            join(a, b);
        }
    }
    let mut groups = vec![usize::MAX; points.len()];
    let mut first: Vec<DVec3> = Vec::new();
    for n in 0..points.len() {
        let r = root(&mut parent, n);
        if r == n {
            groups[n] = first.len();
            first.push(points[n]);
        } else {
            groups[n] = groups[r];
            let group = &mut first[groups[r]];
            if compare_points(points[n], *group).is_lt() {
                *group = points[n];
            }
        }
    }
    (groups, first)
}

/// Root of a union–find tree, with path halving.
pub fn root(parent: &mut [usize], mut n: usize) -> usize {
    while parent[n] != n {
        parent[n] = parent[parent[n]];
        n = parent[n];
    }
    n
}

/// Joins the trees of two members; the smaller root stays one.
pub fn join(parent: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b)] = a.min(b);
}

/// How one edge lies on another with the same end vertices: `Some(true)` the other way round, `None` not at all.
fn same_run(a: &[DVec3; 3], b: &[DVec3; 3], tolerance: &Tolerance) -> Option<bool> {
    if !tolerance.same_point(a[1], b[1]) {
        return None;
    }
    if tolerance.same_point(a[0], b[0]) && tolerance.same_point(a[2], b[2]) {
        Some(false)
    } else if tolerance.same_point(a[0], b[2]) && tolerance.same_point(a[2], b[0]) {
        Some(true)
    } else {
        None
    }
}

/// Which geometry an edge takes when several faces bring one: links, other chains, lines of a surface.
pub fn preference(curve: &EdgeCurve) -> u8 {
    match curve {
        EdgeCurve::Links { .. } => 0,
        EdgeCurve::Run { .. } => 1,
        EdgeCurve::Iso { .. } => 2,
    }
}

/// The same run of links or line the other way round.
fn reversed(curve: &EdgeCurve, network: &Network) -> EdgeCurve {
    match curve {
        EdgeCurve::Iso { surface, from, to } => EdgeCurve::Iso { surface: *surface, from: *to, to: *from },
        EdgeCurve::Run { chain, span } => {
            EdgeCurve::Run { chain: chain.reversed(), span: (chain.length() - span.1, chain.length() - span.0) }
        }
        EdgeCurve::Links { links, span } => {
            let total: f64 = links.iter().map(|(l, _)| network.links[l.index()].s).map(|s| s.1 - s.0).sum();
            let links = links.iter().rev().map(|(l, against)| (*l, !against)).collect();
            EdgeCurve::Links { links, span: (total - span.1, total - span.0) }
        }
    }
}

/// Edges found so far, by their pair of end vertices.
struct EdgeTable<'a> {
    network: &'a Network,
    tolerance: &'a Tolerance,
    edges: Vec<Edge>,
    probes: Vec<[DVec3; 3]>,
    by_ends: BTreeMap<(VertexId, VertexId), Vec<EdgeId>>,
}

impl EdgeTable<'_> {
    /// The edge a raw edge becomes, with `true` where the raw one runs against it.
    fn add(&mut self, raw: &RawEdge, ends: (VertexId, VertexId)) -> (EdgeId, bool) {
        let key = (ends.0.min(ends.1), ends.0.max(ends.1));
        for &id in self.by_ends.get(&key).into_iter().flatten() {
            let Some(against) = same_run(&self.probes[id.index()], &raw.probes, self.tolerance) else {
                continue;
            };
            let edge = &mut self.edges[id.index()];
            // Links carry an edge better than a surface's own line: other faces and curves know them.
            if preference(&raw.curve) < preference(&edge.curve) {
                edge.curve = if against { reversed(&raw.curve, self.network) } else { raw.curve.clone() };
                edge.length = raw.length;
            }
            return (id, against);
        }
        let id = EdgeId::at(self.edges.len());
        self.edges.push(Edge { vertices: ends, curve: raw.curve.clone(), length: raw.length, users: Vec::new() });
        self.probes.push(raw.probes);
        self.by_ends.entry(key).or_default().push(id);
        (id, false)
    }
}

/// The model of surfaces that were cut into pieces, one list entry a surface.
pub(super) fn glue(surfaces: Vec<Named>, pieces: &[Pieces], network: &Network, tolerance: &Tolerance) -> Model {
    let points: Vec<DVec3> = pieces.iter().flat_map(|p| p.vertices.iter().copied()).collect();
    let (group, places) = cluster(&points, tolerance);
    let nodes = node_index(network);
    let vertices: Vec<Vertex> = places
        .into_iter()
        .map(|point| match nearest_node(&nodes, network, point, tolerance) {
            Some(node) => Vertex { point: network.nodes[node.index()].point, node: Some(node) },
            None => Vertex { point, node: None },
        })
        .collect();
    let mut table = EdgeTable { network, tolerance, edges: Vec::new(), probes: Vec::new(), by_ends: BTreeMap::new() };
    let mut patches = Vec::new();
    let mut base = 0;
    for (index, part) in pieces.iter().enumerate() {
        job::poll();
        let vertex = |corner: usize| VertexId::at(group[base + corner]);
        let ids: Vec<_> = part.edges.iter().map(|raw| table.add(raw, (vertex(raw.ends.0), vertex(raw.ends.1)))).collect();
        let around = surfaces[index].surface.domain() == Domain::Loop;
        for raw in &part.patches {
            let id = PatchId::at(patches.len());
            let mut sides = Vec::new();
            for (k, side) in raw.sides.iter().enumerate() {
                let edges: Vec<_> = side.edges.iter().map(|e| ids[*e]).collect();
                // The loop runs counter-clockwise: the last two sides of four, the last one of three, backwards.
                let backwards = k >= 2 && !around;
                for (edge, against) in &edges {
                    table.edges[edge.index()].users.push((id, *against != backwards));
                }
                sides.push(PatchSide { edges, pole: side.pole.map(vertex) });
            }
            patches.push(Patch { surface: SurfaceId::at(index), u: raw.u, v: raw.v, sides });
        }
        base += part.vertices.len();
    }
    Model { surfaces, patches, edges: table.edges, vertices }
}

/// Nodes in order of x.
fn node_index(network: &Network) -> Vec<usize> {
    let mut order: Vec<usize> = (0..network.nodes.len()).collect();
    order.sort_by(|&a, &b| compare_points(network.nodes[a].point, network.nodes[b].point));
    order
}

/// The nearest node within tolerance; ties go to the first in coordinate order.
fn nearest_node(order: &[usize], network: &Network, point: DVec3, tolerance: &Tolerance) -> Option<crate::network::NodeId> {
    let first = order.partition_point(|&n| network.nodes[n].point.x < point.x - tolerance.point);
    order[first..]
        .iter()
        .take_while(|&&n| network.nodes[n].point.x <= point.x + tolerance.point)
        .filter(|&&n| tolerance.same_point(network.nodes[n].point, point))
        .min_by(|&&a, &&b| network.nodes[a].point.distance(point).total_cmp(&network.nodes[b].point.distance(point)))
        .map(|&n| crate::network::NodeId::at(n))
}
