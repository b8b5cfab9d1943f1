//! Near misses: free ends that end beside a curve by little more than the tolerance (W514).
//!
//! An end that meets something at its node is joined: it is free to pass close to others, as neighbours of a dense
//! polygon do. A curve shorter than the search distance misses nothing and is not missed.
//!
//! Curves are cut into pieces whose boxes follow from arc length alone: a piece of length h between points d
//! apart stays within √(h² − d²)/2 of their segment. A tree of these boxes leaves few curves to measure.

use glam::DVec3;

use super::graph::{NetCurve, NodeId};
use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::fault::Fault;
use crate::base::par;
use crate::base::tolerance::{NEAR_MISS, Tolerance};
use crate::geometry::{closest, may_come_near};
use crate::network::fault::{CurveEnd, EndFault};

/// A curve as long as the model is cut into about this many pieces.
const PIECES: f64 = 24.0;

/// Curves handed to a thread at once.
const CHUNK: usize = 512;

/// W514 for free ends that miss a curve by up to [`NEAR_MISS`] tolerances, in order of curves; of one curve when it is given.
pub fn near_misses(curves: &[NetCurve], one: Option<usize>, tolerance: &Tolerance) -> Vec<Fault> {
    let reach = NEAR_MISS * tolerance.point;
    let ends = ends(curves, one, tolerance);
    if ends.is_empty() {
        return Vec::new();
    }
    let size = curves.iter().fold(Box3::EMPTY, |all, c| all.union(c.curve.bbox())).diagonal();
    let chunks = curves.len().div_ceil(CHUNK);
    let range = |i: usize| i * CHUNK..((i + 1) * CHUNK).min(curves.len());
    let pieces = par::map(chunks, |i| {
        let mut found = Vec::with_capacity(CHUNK);
        for k in range(i).filter(|&k| curves[k].curve.length() >= reach) {
            pieces(&curves[k], size, |bbox| found.push((bbox, k)));
        }
        found
    })
    .concat();
    let groups: Vec<&[(NodeId, End)]> = ends.chunk_by(|a, b| a.0 == b.0).collect();
    let boxes: Vec<Box3> = groups.iter().map(|group| Box3::of(group.iter().map(|(_, end)| end.at))).collect();
    let tree = BoxTree::build(&pieces.iter().map(|s| s.0).collect::<Vec<_>>());
    let mut near: Vec<(usize, usize)> = Vec::new();
    BoxTree::build(&boxes).pairs_with(&tree, reach, |group, piece| {
        // A curve that passes through the node is not missed.
        let other = pieces[piece].1;
        if !curves[other].nodes.contains(&groups[group][0].0) {
            near.push((group, other));
        }
    });
    near.sort_unstable();
    near.dedup();
    let found = par::map(near.len(), |i| {
        let (group, other) = near[i];
        groups[group].iter().filter_map(|(_, end)| miss(curves, *end, other, one, tolerance)).collect::<Vec<_>>()
    });
    // Two ends that miss each other are one miss.
    let mut all: Vec<Miss> = found.into_iter().flatten().collect();
    all.sort_by_key(|m| (m.curve, m.last, m.other));
    let mutual = |m: &Miss| m.other_end.is_some_and(|last| m.curve > m.other || (m.curve == m.other && m.last && !last));
    // Ascending: an end misses another curve once.
    let keys: Vec<(usize, bool, usize, Option<bool>)> = all.iter().map(|m| (m.curve, m.last, m.other, m.other_end)).collect();
    let known = |key: (usize, bool, usize, Option<bool>)| keys.binary_search(&key).is_ok();
    all.retain(|m| !(mutual(m) && m.other_end.is_some_and(|last| known((m.other, last, m.curve, Some(m.last))))));
    all.into_iter().map(|m| m.fault).collect()
}

/// A miss before it is reported.
struct Miss {
    curve: usize,
    last: bool,
    other: usize,
    other_end: Option<bool>,
    fault: Fault,
}

fn pieces(net: &NetCurve, size: f64, mut found: impl FnMut(Box3)) {
    let length = net.curve.length();
    let n = (PIECES * length / size).clamp(1.0, PIECES).ceil() as usize;
    let step = length / n as f64;
    let mut piece = |p: DVec3, q: DVec3| {
        let slack = 0.5 * (step * step - p.distance_squared(q)).max(0.0).sqrt();
        let chord = Box3::of([p, q]);
        found(Box3 { min: chord.min - slack, max: chord.max + slack });
    };
    if n == 1 {
        piece(net.curve.start(), net.curve.end());
    } else {
        net.curve.points_along(n + 1).windows(2).for_each(|w| piece(w[0], w[1]));
    }
}

/// An end of an open curve.
#[derive(Clone, Copy)]
struct End {
    curve: usize,
    last: bool,
    at: DVec3,
}

/// All free ends of open curves by node; when one curve is given, those of others too: they may miss it.
fn ends(curves: &[NetCurve], one: Option<usize>, tolerance: &Tolerance) -> Vec<(NodeId, End)> {
    let reach = NEAR_MISS * tolerance.point;
    let bbox = one.map(|k| curves[k].curve.bbox());
    let meets = meets(curves);
    let mut ends: Vec<(NodeId, End)> = Vec::new();
    for (k, net) in curves.iter().enumerate() {
        let (first, last) = (net.nodes[0], net.nodes[net.nodes.len() - 1]);
        // An end that comes back to its own start is joined to it.
        if first == last || net.curve.length() < reach {
            continue;
        }
        for (node, last, at) in [(first, false, net.curve.start()), (last, true, net.curve.end())] {
            let free = meets[node.index()] <= 1;
            if free && (one == Some(k) || bbox.is_none_or(|bbox| bbox.touches(&Box3::of([at]), reach))) {
                ends.push((node, End { curve: k, last, at }));
            }
        }
    }
    ends.sort_unstable_by_key(|(node, end)| (*node, end.curve, end.last));
    ends
}

/// How often curves come to each node.
fn meets(curves: &[NetCurve]) -> Vec<u32> {
    let mut meets: Vec<u32> = Vec::new();
    for node in curves.iter().flat_map(|net| net.nodes.iter()) {
        if node.index() >= meets.len() {
            meets.resize(node.index() + 1, 0);
        }
        meets[node.index()] += 1;
    }
    meets
}

/// Whether an end of one curve misses another one, and by how much.
fn miss(curves: &[NetCurve], end: End, other: usize, one: Option<usize>, tolerance: &Tolerance) -> Option<Miss> {
    let End { curve: k, last, at } = end;
    let (net, target, reach) = (&curves[k], &curves[other], NEAR_MISS * tolerance.point);
    if other == k || one.is_some_and(|one| one != k && one != other) {
        return None;
    }
    // A curve that passes through the end's node, or meets this curve a little before its end, is not missed.
    let length = net.curve.length();
    let stations = &net.stations;
    let stub = if last {
        stations.partition_point(|s| length - s > 2.0 * reach)..stations.len()
    } else {
        0..stations.partition_point(|s| *s <= 2.0 * reach)
    };
    if net.nodes[stub].iter().any(|node| target.nodes.contains(node)) {
        return None;
    }
    if !may_come_near(&target.curve, at, reach) {
        return None;
    }
    let nearest = closest(&target.curve, at);
    if nearest.distance <= tolerance.point || nearest.distance > reach {
        return None;
    }
    let ends = [(false, target.curve.start()), (true, target.curve.end())];
    let other_end = ends.into_iter().find(|(_, p)| tolerance.same_point(*p, nearest.point)).map(|(last, _)| last);
    let fault = EndFault::NearMiss {
        end: CurveEnd { of: net.curve.origin(), last, at },
        other: target.curve.origin(),
        nearest: nearest.point,
        other_end: other_end.is_some(),
        tolerance: tolerance.point,
    };
    Some(Miss { curve: k, last, other, other_end, fault: fault.into() })
}
