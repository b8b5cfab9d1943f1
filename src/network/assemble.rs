//! From contacts to nodes and links (`docs/notes/network.md`).
//!
//! Everything is made afresh from the contacts, so that inserting, removing and rebuilding cannot differ:
//! sites (ends, cuts, contacts) are clustered to nodes, nodes become stations along each curve, and the segments
//! between stations become links, shared ones once.

use glam::DVec3;

use super::cluster::cluster;
use super::graph::{CurveId, Link, LinkId, NetCurve, Node, NodeId};
use super::hits::Contact;
use super::shared;
use crate::base::bbox::Box3;
use crate::base::fault::quantities::round_down;
use crate::base::fault::{Fault, Result};
use crate::base::math::compare_points;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::fault::{ChainFault, GraphFault};

/// What a network is assembled from.
pub struct Parts<'a> {
    /// Where curves meet.
    pub contacts: &'a [Contact],
    /// Declared points.
    pub points: &'a [DVec3],
    /// When points are one.
    pub tolerance: &'a Tolerance,
}

/// A node on one curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Arc length.
    pub s: f64,
    /// Index of the node, before numbering.
    pub node: u32,
}

/// Stations of all curves and the points of their nodes, before numbering.
pub struct Stations {
    /// Per curve, ascending.
    pub rows: Vec<Vec<Station>>,
    /// Per node.
    pub points: Vec<DVec3>,
    /// Per curve.
    pub closed: Vec<bool>,
}

/// Nodes and links of curves; writes their runs and stations into `curves` and returns notes about shared runs.
pub fn assemble(curves: &mut [NetCurve], parts: &Parts) -> Result<(Vec<Node>, Vec<Link>, Vec<Fault>)> {
    let mut stations = stations(curves, parts)?;
    isolated_rings(curves, parts, &mut stations);
    let shared = shared::match_segments(curves, parts, &mut stations);
    Ok(number(curves, stations, shared))
}

/// A place on a curve that may become a station.
#[derive(Clone, Copy)]
struct StationMark {
    curve: u32,
    s: f64,
    site: u32,
}

fn stations(curves: &[NetCurve], parts: &Parts) -> Result<Stations> {
    let tolerance = parts.tolerance;
    let closed: Vec<bool> = curves.iter().map(|c| c.curve.is_closed(tolerance)).collect();
    let lengths: Vec<f64> = curves.iter().map(|c| c.curve.length()).collect();
    let mut sites: Vec<DVec3> = Vec::with_capacity(2 * curves.len() + parts.contacts.len());
    let mut marks: Vec<StationMark> = Vec::with_capacity(2 * sites.capacity());
    for (k, c) in curves.iter().enumerate() {
        let mut mark = |s: f64, at: DVec3| {
            marks.push(StationMark { curve: k as u32, s, site: sites.len() as u32 });
            sites.push(at);
        };
        if !closed[k] {
            mark(0.0, c.curve.start());
            mark(lengths[k], c.curve.end());
        }
        for &s in &c.cuts {
            mark(s, c.curve.point(c.curve.param_at_length(s)));
        }
    }
    for contact in parts.contacts {
        for (s, at) in [(contact.s, contact.at)].into_iter().chain(contact.to) {
            marks.extend([0, 1].map(|side| StationMark { curve: contact.curves[side], s: s[side], site: sites.len() as u32 }));
            sites.push(at);
        }
    }
    for mark in &mut marks {
        let length = lengths[mark.curve as usize];
        // The end of a closed curve is its start.
        mark.s = if closed[mark.curve as usize] && mark.s >= length { 0.0 } else { mark.s.clamp(0.0, length) };
    }
    let (node_of_site, points) = nodes(curves, &sites, &marks, parts)?;
    let mut rows: Vec<Vec<Station>> = counts(&marks, curves.len()).into_iter().map(Vec::with_capacity).collect();
    for mark in &marks {
        rows[mark.curve as usize].push(Station { s: mark.s, node: node_of_site[mark.site as usize] });
    }
    let mut stations = Stations { rows, points, closed };
    for k in 0..curves.len() {
        let settled = settle(&curves[k], std::mem::take(&mut stations.rows[k]), &stations, stations.closed[k], tolerance);
        if !stations.closed[k] && settled.len() < 2 {
            let curve = &curves[k].curve;
            return Err(
                ChainFault::NoLength { of: curve.origin(), at: curve.start(), length: lengths[k], tolerance: tolerance.point }.into()
            );
        }
        stations.rows[k] = settled;
    }
    Ok(stations)
}

fn counts(marks: &[StationMark], n: usize) -> Vec<usize> {
    let mut counts = vec![0; n];
    for mark in marks {
        counts[mark.curve as usize] += 1;
    }
    counts
}

/// Clusters sites and declared points: the node of each site, and the points of the nodes.
fn nodes(curves: &[NetCurve], sites: &[DVec3], marks: &[StationMark], parts: &Parts) -> Result<(Vec<u32>, Vec<DVec3>)> {
    let all: Vec<DVec3> = sites.iter().chain(parts.points).copied().collect();
    let roots = cluster(&all, parts.tolerance.point);
    let mut order: Vec<(u32, u32)> = roots.iter().zip(0_u32..).map(|(&root, k)| (root, k)).collect();
    order.sort_unstable();
    let (mut node_of_site, mut points) = (vec![0_u32; sites.len()], Vec::with_capacity(sites.len()));
    let mut scratch = Vec::new();
    for group in order.chunk_by(|a, b| a.0 == b.0) {
        // Declared points come after all sites; the root of a group is its least index.
        if group[0].0 as usize >= sites.len() {
            continue;
        }
        let own = group.partition_point(|&(_, k)| (k as usize) < sites.len());
        scratch.clear();
        scratch.extend(group[..own].iter().map(|&(_, k)| sites[k as usize]));
        let declared = group[own..].iter().map(|&(_, k)| all[k as usize]);
        if scratch.len() > 1 && too_wide(&scratch, parts.tolerance) {
            return Err(ambiguous(curves, &group[..own], sites, marks, parts.tolerance));
        }
        let mean = mean(&mut scratch);
        let near = |p: &DVec3| p.distance_squared(mean);
        let point = declared.min_by(|a, b| near(a).total_cmp(&near(b)).then(compare_points(*a, *b))).unwrap_or(mean);
        for &(_, k) in &group[..own] {
            node_of_site[k as usize] = points.len() as u32;
        }
        points.push(point);
    }
    Ok((node_of_site, points))
}

/// The mean, independent of the order given and exact where all points are equal.
fn mean(points: &mut [DVec3]) -> DVec3 {
    if let [one] = points {
        return *one;
    }
    points.sort_unstable_by(|a, b| compare_points(*a, *b));
    let base = points[0];
    base + points.iter().map(|p| *p - base).sum::<DVec3>() / points.len() as f64
}

/// Whether two of the points are more than two tolerances apart; of very many points only the outermost are compared.
fn too_wide(points: &[DVec3], tolerance: &Tolerance) -> bool {
    let limit = 2.0 * tolerance.point;
    Box3::of(points.iter().copied()).diagonal() > limit && widest(points).0 > limit
}

/// The widest pair: distance and indices.
fn widest(points: &[DVec3]) -> (f64, usize, usize) {
    const COMPARED: usize = 2000;
    let step = points.len().div_ceil(COMPARED);
    let mut best = (0.0, 0, 0);
    for a in (0..points.len()).step_by(step) {
        for b in a + 1..points.len() {
            let d = points[a].distance(points[b]);
            if d > best.0 {
                best = (d, a, b);
            }
        }
    }
    best
}

/// E506, with the widest pair first and the curves they lie on.
fn ambiguous(curves: &[NetCurve], group: &[(u32, u32)], sites: &[DVec3], marks: &[StationMark], tolerance: &Tolerance) -> Fault {
    const SHOWN: usize = 4;
    let points: Vec<DVec3> = group.iter().map(|&(_, k)| sites[k as usize]).collect();
    let (diameter, a, b) = widest(&points);
    let origin = |k: usize| {
        let mark = marks.iter().find(|m| m.site == group[k].1);
        mark.map_or(Origin::NONE, |m| curves[m.curve as usize].curve.origin())
    };
    let shown: Vec<usize> = [a, b].into_iter().chain((0..points.len()).filter(|&k| k != a && k != b)).take(SHOWN).collect();
    // The smallest distance that is not mere rounding is what a smaller tolerance must stay below.
    let gap = least_gap(&points, tolerance.rounding);
    GraphFault::ClusterAmbiguous {
        points: shown.into_iter().map(|k| (points[k], origin(k))).collect(),
        count: points.len(),
        diameter,
        tolerance: tolerance.point,
        smaller: round_down(gap.unwrap_or(tolerance.point)),
    }
    .into()
}

/// The smallest distance of two of the points above `rounding`: a sweep along the widest axis.
fn least_gap(points: &[DVec3], rounding: f64) -> Option<f64> {
    let size = Box3::of(points.iter().copied());
    let size = size.max - size.min;
    let axis = size.max_position();
    let mut sorted = points.to_vec();
    sorted.sort_unstable_by(|a, b| a[axis].total_cmp(&b[axis]).then(compare_points(*a, *b)));
    sorted.dedup();
    let mut least = f64::INFINITY;
    for (k, p) in sorted.iter().enumerate() {
        for q in &sorted[k + 1..] {
            if q[axis] - p[axis] >= least {
                break;
            }
            let d = p.distance(*q);
            if d > rounding {
                least = least.min(d);
            }
        }
    }
    least.is_finite().then_some(least)
}

/// Stations in order, hits of one passage through a node as one of them.
pub fn settle(net: &NetCurve, mut row: Vec<Station>, stations: &Stations, closed: bool, tolerance: &Tolerance) -> Vec<Station> {
    let length = net.curve.length();
    row.sort_unstable_by(|a, b| a.s.total_cmp(&b.s).then(a.node.cmp(&b.node)));
    let repeats = row.windows(2).any(|w| w[0].node == w[1].node) || (closed && row.len() > 1 && row[0].node == row[row.len() - 1].node);
    if !repeats {
        return row;
    }
    // A passage is one when it is no longer than a node is wide, or stays at the node in the middle.
    let stays = |from: f64, to: f64, node: u32| {
        to - from <= 4.0 * tolerance.point || {
            let middle = 0.5 * (from + to);
            let s = if middle > length { middle - length } else { middle };
            net.curve.point(net.curve.param_at_length(s)).distance(stations.points[node as usize]) <= 2.0 * tolerance.point
        }
    };
    let mut out: Vec<Station> = Vec::with_capacity(row.len());
    let mut start = 0;
    for k in 1..=row.len() {
        if k < row.len() && row[k].node == row[k - 1].node && stays(row[k - 1].s, row[k].s, row[k].node) {
            continue;
        }
        let (first, last) = (row[start].s, row[k - 1].s);
        let at_end = !closed && last == length && first > 0.0;
        out.push(Station {
            s: if first == 0.0 || first == last {
                first
            } else if at_end {
                length
            } else {
                0.5 * (first + last)
            },
            node: row[start].node,
        });
        start = k;
    }
    if closed && out.len() > 1 {
        let (first, last) = (out[0], out[out.len() - 1]);
        if first.node == last.node && stays(last.s, first.s + length, first.node) {
            out.pop();
            if first.s > 0.0 {
                let middle = 0.5 * (last.s + first.s + length);
                out[0].s = if middle >= length { middle - length } else { 0.0 };
            }
        }
    }
    out
}

/// A closed curve that meets nothing gets a node at its start.
fn isolated_rings(curves: &[NetCurve], parts: &Parts, stations: &mut Stations) {
    let isolated: Vec<usize> = (0..curves.len()).filter(|&k| stations.rows[k].is_empty()).collect();
    if isolated.is_empty() {
        return;
    }
    let all: Vec<DVec3> = isolated.iter().map(|&k| curves[k].curve.start()).chain(parts.points.iter().copied()).collect();
    let roots = cluster(&all, parts.tolerance.point);
    for (i, &k) in isolated.iter().enumerate() {
        let near = |p: &DVec3| p.distance_squared(all[i]);
        let declared = (isolated.len()..all.len()).filter(|&j| roots[j] == roots[i]).map(|j| all[j]);
        let point = declared.min_by(|a, b| near(a).total_cmp(&near(b)).then(compare_points(*a, *b))).unwrap_or(all[i]);
        stations.rows[k].push(Station { s: 0.0, node: stations.points.len() as u32 });
        stations.points.push(point);
    }
}

/// Numbers nodes and links in the order of curves as given, then along curves.
fn number(curves: &mut [NetCurve], stations: Stations, shared: shared::Shared) -> (Vec<Node>, Vec<Link>, Vec<Fault>) {
    const NONE: u32 = u32::MAX;
    let mut number_of = vec![NONE; stations.points.len()];
    let mut nodes: Vec<Node> = Vec::with_capacity(stations.points.len());
    for (net, row) in curves.iter_mut().zip(&stations.rows) {
        net.nodes.clear();
        net.stations.clear();
        for station in row {
            let number = &mut number_of[station.node as usize];
            if *number == NONE {
                *number = nodes.len() as u32;
                nodes.push(Node { point: stations.points[station.node as usize], ends: Vec::new() });
            }
            net.nodes.push(NodeId(*number));
            net.stations.push(station.s);
        }
    }
    for (k, net) in curves.iter_mut().enumerate().filter(|(k, _)| stations.closed[*k]) {
        // Back to the first node, one turn on.
        net.nodes.push(net.nodes[0]);
        net.stations.push(stations.rows[k][0].s + net.curve.length());
    }
    let mut links: Vec<Link> = Vec::with_capacity(2 * nodes.len());
    for (k, net) in curves.iter_mut().enumerate() {
        net.links.clear();
        for i in 0..net.nodes.len() - 1 {
            if shared.owner(k, i) != (k, i) {
                net.links.push((LinkId(NONE), false));
                continue;
            }
            let (link, ends) = (LinkId::at(links.len()), (net.nodes[i], net.nodes[i + 1]));
            net.links.push((link, false));
            links.push(Link { curve: CurveId::at(k), s: (net.stations[i], net.stations[i + 1]), nodes: ends });
            nodes[ends.0.index()].ends.push((link, false));
            nodes[ends.1.index()].ends.push((link, true));
        }
    }
    // What others own has its number only now.
    for k in 0..curves.len() {
        for i in 0..curves[k].links.len() {
            let (owner, j) = shared.owner(k, i);
            if (owner, j) != (k, i) {
                curves[k].links[i] = (curves[owner].links[j].0, runs_against(curves, (k, i), (owner, j)));
            }
        }
    }
    (nodes, links, shared.notes)
}

/// Whether a segment of one curve runs against the segment of another that it shares.
fn runs_against(curves: &[NetCurve], (k, i): (usize, usize), (owner, j): (usize, usize)) -> bool {
    let (net, other) = (&curves[k], &curves[owner]);
    let (own, theirs) = ((net.nodes[i], net.nodes[i + 1]), (other.nodes[j], other.nodes[j + 1]));
    if own.0 != own.1 {
        return own != theirs;
    }
    // A shared loop: the first quarter decides.
    let at = |net: &NetCurve, i: usize, x: f64| {
        let s = net.stations[i] + (net.stations[i + 1] - net.stations[i]) * x;
        let length = net.curve.length();
        net.curve.point(net.curve.param_at_length(if s > length { s - length } else { s }))
    };
    let quarter = at(net, i, 0.25);
    quarter.distance_squared(at(other, j, 0.75)) < quarter.distance_squared(at(other, j, 0.25))
}
