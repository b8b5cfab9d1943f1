//! Near misses: ends that end beside a curve by little more than the tolerance (W514).
//!
//! Curves are cut into stretches whose boxes follow from arc length alone: a stretch of length h between points d
//! apart stays within √(h² − d²)/2 of their segment. A tree of these boxes leaves few curves to measure.

use super::graph::NetCurve;
use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::fault::{CurveEnd, Fault, NetworkFault};
use crate::base::par;
use crate::base::tolerance::{NEAR_MISS, Tolerance};
use crate::geometry::closest;

/// A curve as long as the model is cut into about this many stretches.
const STRETCHES: f64 = 24.0;

/// W514 for ends that miss a curve by up to [`NEAR_MISS`] tolerances, in order of curves; of one curve when it is given.
pub fn near_misses(curves: &[NetCurve], one: Option<usize>, tolerance: &Tolerance) -> Vec<Fault> {
    let reach = NEAR_MISS * tolerance.point;
    let size = curves.iter().fold(Box3::EMPTY, |all, c| all.union(c.curve.bbox())).diagonal();
    let stretches = par::map(curves.len(), |k| stretches(&curves[k], size));
    let owner: Vec<usize> = stretches.iter().enumerate().flat_map(|(k, boxes)| std::iter::repeat_n(k, boxes.len())).collect();
    let tree = BoxTree::build(&stretches.concat());
    let found = par::map(2 * curves.len(), |i| {
        let (k, last) = (i / 2, i % 2 == 1);
        misses(curves, (k, last), one, reach, tolerance, |bbox, near| tree.query(bbox, reach, |piece| near.push(owner[piece])))
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

fn stretches(net: &NetCurve, size: f64) -> Vec<Box3> {
    let length = net.curve.length();
    let n = (STRETCHES * length / size).clamp(1.0, STRETCHES).ceil() as usize;
    let step = length / n as f64;
    let points: Vec<glam::DVec3> = if n == 1 { vec![net.curve.start(), net.curve.end()] } else { net.curve.points_along(n + 1) };
    points
        .windows(2)
        .map(|w| {
            let slack = 0.5 * (step * step - w[0].distance_squared(w[1])).max(0.0).sqrt();
            let chord = Box3::of([w[0], w[1]]);
            Box3 { min: chord.min - slack, max: chord.max + slack }
        })
        .collect()
}

fn misses(
    curves: &[NetCurve],
    (k, last): (usize, bool),
    one: Option<usize>,
    reach: f64,
    tolerance: &Tolerance,
    query: impl Fn(&Box3, &mut Vec<usize>),
) -> Vec<Miss> {
    let net = &curves[k];
    if net.curve.is_closed(tolerance) {
        return Vec::new();
    }
    let (at, node) = if last { (net.curve.end(), net.nodes[net.nodes.len() - 1]) } else { (net.curve.start(), net.nodes[0]) };
    let mut near = Vec::new();
    query(&Box3::of([at]), &mut near);
    near.sort_unstable();
    near.dedup();
    let mut found = Vec::new();
    for other in near {
        let target = &curves[other];
        let wanted = one.is_none_or(|one| one == k || one == other);
        // A curve that passes through the end's node, or meets this curve a little before its end, is not missed.
        let stub = |s: &f64| if last { net.curve.length() - s <= 2.0 * reach } else { *s <= 2.0 * reach };
        let met = |node: &super::graph::NodeId| target.nodes.contains(node);
        if !wanted || other == k || met(&node) || net.nodes.iter().zip(&net.stations).any(|(n, s)| stub(s) && met(n)) {
            continue;
        }
        let nearest = closest(&target.curve, at);
        if nearest.distance <= tolerance.point || nearest.distance > reach {
            continue;
        }
        let ends = [(false, target.curve.start()), (true, target.curve.end())];
        let other_end = ends.into_iter().find(|(_, p)| tolerance.same_point(*p, nearest.point)).map(|(last, _)| last);
        let end = CurveEnd { of: net.curve.origin(), last, at };
        let fault = NetworkFault::NearMiss {
            end,
            other: target.curve.origin(),
            nearest: nearest.point,
            other_end: other_end.is_some(),
            tolerance: tolerance.point,
        };
        found.push(Miss { curve: k, last, other, other_end, fault: fault.into() });
    }
    found
}
