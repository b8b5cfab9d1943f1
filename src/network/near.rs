//! Near misses: ends that end beside a curve by little more than the tolerance (W514).
//!
//! Curves are cut into stretches whose boxes follow from arc length alone: a stretch of length h between points d
//! apart stays within √(h² − d²)/2 of their segment. A tree of these boxes leaves few curves to measure.

use glam::DVec3;

use super::graph::NetCurve;
use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::fault::{CurveEnd, Fault, NetworkFault};
use crate::base::par;
use crate::base::tolerance::{NEAR_MISS, Tolerance};
use crate::geometry::closest;

/// A curve as long as the model is cut into about this many stretches.
const STRETCHES: f64 = 24.0;

/// Curves handed to a thread at once.
const CHUNK: usize = 512;

/// W514 for ends that miss a curve by up to [`NEAR_MISS`] tolerances, in order of curves; of one curve when it is given.
pub fn near_misses(curves: &[NetCurve], one: Option<usize>, tolerance: &Tolerance) -> Vec<Fault> {
    let reach = NEAR_MISS * tolerance.point;
    let size = curves.iter().fold(Box3::EMPTY, |all, c| all.union(c.curve.bbox())).diagonal();
    let chunks = curves.len().div_ceil(CHUNK);
    let range = |i: usize| i * CHUNK..((i + 1) * CHUNK).min(curves.len());
    let stretches = par::map(chunks, |i| {
        let mut found = Vec::with_capacity(CHUNK);
        for k in range(i) {
            stretches(&curves[k], size, |bbox| found.push((bbox, k)));
        }
        found
    })
    .concat();
    let tree = BoxTree::build(&stretches.iter().map(|s| s.0).collect::<Vec<_>>());
    let found = par::map(chunks, |i| {
        let (mut near, mut found) = (Vec::new(), Vec::new());
        for (k, last) in range(i).flat_map(|k| [(k, false), (k, true)]) {
            let Some(at) = open_end(&curves[k], last, tolerance) else { continue };
            near.clear();
            tree.query(&Box3::of([at]), reach, |stretch| near.push(stretches[stretch].1));
            near.sort_unstable();
            near.dedup();
            found.extend(near.iter().filter_map(|&other| miss(curves, (k, last, at), other, one, tolerance)));
        }
        found
    });
    // Two ends that miss each other are one miss.
    let mut all: Vec<Miss> = found.into_iter().flatten().collect();
    let mutual = |m: &Miss| m.other_end.is_some_and(|last| m.curve > m.other || (m.curve == m.other && m.last && !last));
    let keys: Vec<(usize, bool, usize, Option<bool>)> = all.iter().map(|m| (m.curve, m.last, m.other, m.other_end)).collect();
    all.retain(|m| !(mutual(m) && m.other_end.is_some_and(|last| keys.contains(&(m.other, last, m.curve, Some(m.last))))));
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

fn stretches(net: &NetCurve, size: f64, mut found: impl FnMut(Box3)) {
    let length = net.curve.length();
    let n = (STRETCHES * length / size).clamp(1.0, STRETCHES).ceil() as usize;
    let step = length / n as f64;
    let mut stretch = |p: DVec3, q: DVec3| {
        let slack = 0.5 * (step * step - p.distance_squared(q)).max(0.0).sqrt();
        let chord = Box3::of([p, q]);
        found(Box3 { min: chord.min - slack, max: chord.max + slack });
    };
    if n == 1 {
        stretch(net.curve.start(), net.curve.end());
    } else {
        net.curve.points_along(n + 1).windows(2).for_each(|w| stretch(w[0], w[1]));
    }
}

fn open_end(net: &NetCurve, last: bool, tolerance: &Tolerance) -> Option<DVec3> {
    let open = net.nodes.first() != net.nodes.last() || !net.curve.is_closed(tolerance);
    open.then(|| if last { net.curve.end() } else { net.curve.start() })
}

/// Whether an end of one curve misses another one, and by how much.
fn miss(curves: &[NetCurve], (k, last, at): (usize, bool, DVec3), other: usize, one: Option<usize>, tolerance: &Tolerance) -> Option<Miss> {
    let (net, target, reach) = (&curves[k], &curves[other], NEAR_MISS * tolerance.point);
    if other == k || one.is_some_and(|one| one != k && one != other) {
        return None;
    }
    // A curve that passes through the end's node, or meets this curve a little before its end, is not missed.
    let length = net.curve.length();
    let stub = |s: f64| if last { length - s <= 2.0 * reach } else { s <= 2.0 * reach };
    if net.nodes.iter().zip(&net.stations).any(|(node, &s)| stub(s) && target.nodes.contains(node)) {
        return None;
    }
    let nearest = closest(&target.curve, at);
    if nearest.distance <= tolerance.point || nearest.distance > reach {
        return None;
    }
    let ends = [(false, target.curve.start()), (true, target.curve.end())];
    let other_end = ends.into_iter().find(|(_, p)| tolerance.same_point(*p, nearest.point)).map(|(last, _)| last);
    let fault = NetworkFault::NearMiss {
        end: CurveEnd { of: net.curve.origin(), last, at },
        other: target.curve.origin(),
        nearest: nearest.point,
        other_end: other_end.is_some(),
        tolerance: tolerance.point,
    };
    Some(Miss { curve: k, last, other, other_end, fault: fault.into() })
}
