//! Curves and edges as points close enough together for the picture.

use std::collections::BTreeSet;

use glam::DVec3;

use super::scene::{Kind, Line};
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::model::{Meeting, Model, SurfaceId, Track};
use crate::network::{Chain, Network};

/// Parts that a smooth piece is looked at in before it may count as straight.
const PARTS: usize = 4;
/// Halvings of a part.
const DEPTH: u32 = 7;

/// Points of a way from `a` to `b`, none farther than `fine` from its chords; the first point is left out.
fn follow(at: &dyn Fn(f64) -> DVec3, (a, b): (f64, f64), fine: f64, depth: u32, out: &mut Vec<DVec3>) {
    let middle = 0.5 * (a + b);
    let (p, q, m) = (at(a), at(b), at(middle));
    if depth > 0 && m.distance(0.5 * (p + q)) > fine && p.distance(q).max(p.distance(m)) > fine {
        follow(at, (a, middle), fine, depth - 1, out);
        follow(at, (middle, b), fine, depth - 1, out);
    } else {
        out.push(q);
    }
}

fn smooth(at: &dyn Fn(f64) -> DVec3, (a, b): (f64, f64), fine: f64, out: &mut Vec<DVec3>) {
    let mut own = Vec::new();
    for k in 0..PARTS {
        let part = |k: usize| if k == PARTS { b } else { a + (b - a) * k as f64 / PARTS as f64 };
        follow(at, (part(k), part(k + 1)), fine, DEPTH, &mut own);
    }
    // What is straight needs its ends only.
    let (first, last) = (at(a), at(b));
    let along = last - first;
    let off = |p: &DVec3| along.cross(*p - first).length() > fine * along.length();
    if own.iter().any(off) {
        out.extend(own);
    } else {
        out.push(last);
    }
}

/// Points along a chain, its kinks and joints among them.
pub fn chain(chain: &Chain, fine: f64, tolerance: &Tolerance) -> Vec<DVec3> {
    let mut corners: Vec<f64> = chain.joints().iter().copied().chain(chain.kinks(tolerance)).collect();
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    let at = |f: f64| chain.point(f);
    let mut points = vec![at(corners[0])];
    corners.windows(2).for_each(|w| smooth(&at, (w[0], w[1]), fine, &mut points));
    points
}

/// Points along a stretch of an edge.
pub fn track(track: &Track, (from, to): (f64, f64), fine: f64) -> Vec<DVec3> {
    let at = |s: f64| track.point(s);
    let mut points = vec![at(from)];
    // A run of several links may bend where they join: look everywhere.
    let n = PARTS * 4;
    let part = |k: usize| if k == n { to } else { from + (to - from) * k as f64 / n as f64 };
    (0..n).for_each(|k| follow(&at, (part(k), part(k + 1)), fine, DEPTH, &mut points));
    points
}

/// The edges of some surfaces: free ones, kinks, and where surfaces meet; borders up to `near` apart meet.
pub fn borders(
    (model, network): (&Model, &Network),
    (members, near): (&BTreeSet<SurfaceId>, f64),
    fine: f64,
    tolerance: &Tolerance,
) -> Vec<Line> {
    let stretches = model.stretches(members, near, network, tolerance);
    par::map(stretches.len(), |k| {
        let stretch = &stretches[k];
        let kind = match stretch.meeting {
            Meeting::Free => Kind::Free,
            Meeting::Kink => Kind::Kink,
            Meeting::Seam | Meeting::Joined => Kind::Border,
            Meeting::Crowded => Kind::Crowded,
        };
        Line { kind, points: track(&stretch.track, stretch.s, fine) }
    })
}
