//! From contacts to nodes and links (`docs/notes/network.md`).
//!
//! Everything is made afresh from the contacts, so that inserting, removing and rebuilding cannot differ:
//! sites (ends, cuts, contacts) are clustered to nodes, nodes become stations along each curve, and the segments
//! between stations become links, shared ones once.

use glam::DVec3;

use super::cluster::cluster;
use super::graph::{Link, NetCurve, Node};
use super::hits::Contact;
use super::numbering::number;
use super::rows::Rows;
use super::shared;
use crate::base::bbox::Box3;
use crate::base::fault::quantities::round_down;
use crate::base::fault::{Fault, Result};
use crate::base::math::compare_points;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
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
    pub rows: Rows,
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
    let mut sites: Vec<DVec3> = Vec::with_capacity(2 * curves.len() + parts.contacts.len() + parts.points.len());
    let mut marks: Vec<StationMark> = Vec::with_capacity(2 * (curves.len() + parts.contacts.len()));
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
        for (s, at) in [(contact.s, contact.at)].into_iter().chain(contact.to.as_deref().copied()) {
            marks.extend([0, 1].map(|side| StationMark { curve: contact.curves[side], s: s[side], site: sites.len() as u32 }));
            sites.push(at);
        }
    }
    for mark in &mut marks {
        let length = lengths[mark.curve as usize];
        // The end of a closed curve is its start.
        mark.s = if closed[mark.curve as usize] && mark.s >= length { 0.0 } else { mark.s.clamp(0.0, length) };
    }
    let (node_of_site, points) = nodes(curves, sites, &marks, parts)?;
    let of_curves = marks.iter().map(|mark| (mark.curve, Station { s: mark.s, node: node_of_site[mark.site as usize] }));
    let mut rows = Rows::of(curves.len(), of_curves);
    drop((marks, node_of_site));
    let mut short = None;
    rows.change_each(|k, row| {
        settle(&curves[k].curve, lengths[k], row, &points, closed[k], tolerance);
        if !closed[k] && row.len() < 2 {
            short.get_or_insert(k);
        }
    });
    if let Some(k) = short {
        let curve = &curves[k].curve;
        return Err(ChainFault::NoLength { of: curve.origin(), at: curve.start(), length: lengths[k], tolerance: tolerance.point }.into());
    }
    Ok(Stations { rows, points, closed })
}

/// Clusters sites and declared points: the node of each site, and the points of the nodes.
fn nodes(curves: &[NetCurve], sites: Vec<DVec3>, marks: &[StationMark], parts: &Parts) -> Result<(Vec<u32>, Vec<DVec3>)> {
    // Declared points come after all sites; the root of a group is its least index.
    let (n, mut all) = (sites.len(), sites);
    all.extend(parts.points);
    let roots = cluster(&all, parts.tolerance.point);
    let groups = Groups::of(&roots);
    let (mut node_of_site, mut points) = (vec![0_u32; n], Vec::with_capacity(n.div_ceil(2)));
    let mut scratch = Vec::new();
    for group in (0..n).filter(|k| roots[*k] as usize == *k).map(|root| groups.of_root(root)) {
        let own = &group[..group.partition_point(|k| (*k as usize) < n)];
        let first = all[own[0] as usize];
        let mean = if own.len() > 1 && own.iter().all(|k| all[*k as usize] == first) {
            // What the mean of equal points is, but for the sorting.
            first + DVec3::ZERO
        } else {
            scratch.clear();
            scratch.extend(own.iter().map(|k| all[*k as usize]));
            if scratch.len() > 1 && too_wide(&scratch, parts.tolerance) {
                return Err(ambiguous(curves, own, &all, marks, parts.tolerance));
            }
            mean(&mut scratch)
        };
        let declared = group[own.len()..].iter().map(|k| all[*k as usize]);
        let near = |p: &DVec3| p.distance_squared(mean);
        let point = declared.min_by(|a, b| near(a).total_cmp(&near(b)).then(compare_points(*a, *b))).unwrap_or(mean);
        for k in own {
            node_of_site[*k as usize] = points.len() as u32;
        }
        points.push(point);
    }
    Ok((node_of_site, points))
}

/// The indices of each group in one list, ascending.
struct Groups {
    /// Where the group of each root begins; one more at the end.
    first: Vec<u32>,
    members: Vec<u32>,
}

impl Groups {
    fn of(roots: &[u32]) -> Self {
        let mut first = vec![0_u32; roots.len() + 1];
        for root in roots {
            first[*root as usize + 1] += 1;
        }
        for k in 0..roots.len() {
            first[k + 1] += first[k];
        }
        let (mut next, mut members) = (first.clone(), vec![0_u32; roots.len()]);
        for (k, root) in roots.iter().enumerate() {
            let place = &mut next[*root as usize];
            members[*place as usize] = k as u32;
            *place += 1;
        }
        Self { first, members }
    }

    fn of_root(&self, root: usize) -> &[u32] {
        &self.members[self.first[root] as usize..self.first[root + 1] as usize]
    }
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
fn ambiguous(curves: &[NetCurve], group: &[u32], sites: &[DVec3], marks: &[StationMark], tolerance: &Tolerance) -> Fault {
    const SHOWN: usize = 4;
    let points: Vec<DVec3> = group.iter().map(|k| sites[*k as usize]).collect();
    let (diameter, a, b) = widest(&points);
    let origin = |k: usize| {
        let mark = marks.iter().find(|m| m.site == group[k]);
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

/// Puts the stations of a curve in order, hits of one passage through a node as one of them; `points` are those of the nodes.
pub fn settle(curve: &Curve, length: f64, row: &mut Vec<Station>, points: &[DVec3], closed: bool, tolerance: &Tolerance) {
    row.sort_unstable_by(|a, b| a.s.total_cmp(&b.s).then(a.node.cmp(&b.node)));
    let repeats = row.windows(2).any(|w| w[0].node == w[1].node) || (closed && row.len() > 1 && row[0].node == row[row.len() - 1].node);
    if !repeats {
        return;
    }
    // A passage is one when it is no longer than a node is wide, or stays at the node in the middle.
    let stays = |from: f64, to: f64, node: u32| {
        to - from <= 4.0 * tolerance.point || {
            let middle = 0.5 * (from + to);
            let s = if middle > length { middle - length } else { middle };
            curve.point(curve.param_at_length(s)).distance(points[node as usize]) <= 2.0 * tolerance.point
        }
    };
    let (mut start, mut kept) = (0, 0);
    for k in 1..=row.len() {
        if k < row.len() && row[k].node == row[k - 1].node && stays(row[k - 1].s, row[k].s, row[k].node) {
            continue;
        }
        let (first, last) = (row[start].s, row[k - 1].s);
        let at_end = !closed && last == length && first > 0.0;
        let s = if first == 0.0 || first == last {
            first
        } else if at_end {
            length
        } else {
            0.5 * (first + last)
        };
        row[kept] = Station { s, node: row[start].node };
        (start, kept) = (k, kept + 1);
    }
    row.truncate(kept);
    if closed && row.len() > 1 {
        let (first, last) = (row[0], row[row.len() - 1]);
        if first.node == last.node && stays(last.s, first.s + length, first.node) {
            row.pop();
            if first.s > 0.0 {
                let middle = 0.5 * (last.s + first.s + length);
                row[0].s = if middle >= length { middle - length } else { 0.0 };
            }
        }
    }
}

/// A closed curve that meets nothing gets a node at its start.
fn isolated_rings(curves: &[NetCurve], parts: &Parts, stations: &mut Stations) {
    let isolated: Vec<usize> = (0..curves.len()).filter(|&k| stations.rows.row(k).is_empty()).collect();
    if isolated.is_empty() {
        return;
    }
    let all: Vec<DVec3> = isolated.iter().map(|&k| curves[k].curve.start()).chain(parts.points.iter().copied()).collect();
    let roots = cluster(&all, parts.tolerance.point);
    for (i, &k) in isolated.iter().enumerate() {
        let near = |p: &DVec3| p.distance_squared(all[i]);
        let declared = (isolated.len()..all.len()).filter(|&j| roots[j] == roots[i]).map(|j| all[j]);
        let point = declared.min_by(|a, b| near(a).total_cmp(&near(b)).then(compare_points(*a, *b))).unwrap_or(all[i]);
        stations.rows.set(k, vec![Station { s: 0.0, node: stations.points.len() as u32 }]);
        stations.points.push(point);
    }
}
