//! Local search: the nearest points of two sections, and of a point and a section.

use glam::DVec3;

use crate::base::job;
use crate::base::tolerance::{EPSILON, NEWTON_STEP};
use crate::geometry::curves::pieces::View;
use crate::geometry::data::jet::Jet;

/// Corrections at most.
const ROUNDS: usize = 24;

/// Two parameters with the points there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    pub(crate) ta: f64,
    pub(crate) tb: f64,
    pub(crate) pa: DVec3,
    pub(crate) pb: DVec3,
}

impl Near {
    pub(crate) fn gap(&self) -> f64 {
        self.pa.distance(self.pb)
    }
}

/// Newton's method for the least |A(s) − B(t)|² from a starting pair, kept inside both sections.
///
/// The result is the nearest pair that was met, whether or not the iteration settled.
pub(crate) fn approach(a: &View, b: &View, (mut s, mut t): (f64, f64)) -> Near {
    let (ra, rb) = (a.section.range, b.section.range);
    let (slack_a, slack_b) = (NEWTON_STEP * (ra.1 - ra.0), NEWTON_STEP * (rb.1 - rb.0));
    let mut best: Option<(f64, Near)> = None;
    job::poll();
    for _ in 0..ROUNDS {
        let (ja, jb) = (a.jet(s), b.jet(t));
        let here = Near { ta: s, tb: t, pa: ja.p, pb: jb.p };
        let gap = here.gap();
        if best.is_none_or(|(least, _)| gap < least) {
            best = Some((gap, here));
        }
        let (ds, dt) = newton_step(&ja, &jb, (at_end(s, ra), at_end(t, rb)));
        let (next_s, next_t) = ((s + ds).clamp(ra.0, ra.1), (t + dt).clamp(rb.0, rb.1));
        let (ds, dt) = (next_s - s, next_t - t);
        if !(ds.is_finite() && dt.is_finite()) {
            break;
        }
        (s, t) = (next_s, next_t);
        if ds.abs() <= slack_a && dt.abs() <= slack_b {
            // What the step leaves is its square.
            return Near { ta: s, tb: t, pa: ja.p + ja.d1 * ds, pb: jb.p + jb.d1 * dt };
        }
    }
    best.map_or_else(|| Near { ta: s, tb: t, pa: a.point(s), pb: b.point(t) }, |(_, best)| best)
}

/// Which end of its range a parameter is at: −1, 0 or 1.
fn at_end(x: f64, range: (f64, f64)) -> i8 {
    i8::from(x >= range.1) - i8::from(x <= range.0)
}

/// The step towards the least distance; a parameter at an end that the descent would leave stays.
fn newton_step(ja: &Jet, jb: &Jet, ends: (i8, i8)) -> (f64, f64) {
    let d = ja.p - jb.p;
    let (gs, gt) = (d.dot(ja.d1), -d.dot(jb.d1));
    let (aa, bb, ab) = (ja.d1.length_squared(), jb.d1.length_squared(), ja.d1.dot(jb.d1));
    // The whole Hessian where it is positive definite, else its Gauss-Newton part.
    let (mut hs, mut ht) = (aa + d.dot(ja.d2), bb - d.dot(jb.d2));
    let mut det = hs * ht - ab * ab;
    if !(hs > 0.0 && det > EPSILON * aa * bb) {
        (hs, ht) = (aa, bb);
        det = hs * ht - ab * ab;
    }
    let held = |end: i8, slope: f64| f64::from(end) * slope < 0.0;
    match (held(ends.0, gs), held(ends.1, gt)) {
        (true, true) => (0.0, 0.0),
        (true, false) => (0.0, -gt / ht),
        (false, true) => (-gs / hs, 0.0),
        (false, false) if det > EPSILON * aa * bb => ((-gs * ht - gt * ab) / det, (-gt * hs - gs * ab) / det),
        (false, false) => (-gs / (2.0 * hs), -gt / (2.0 * ht)),
    }
}

/// Newton's method for the point of a section nearest to `p`, from the parameter `t`.
pub(crate) fn foot(view: &View, p: DVec3, mut t: f64) -> (f64, DVec3) {
    let range = view.section.range;
    let slack = NEWTON_STEP * (range.1 - range.0);
    for _ in 0..ROUNDS {
        let j = view.jet(t);
        let d = j.p - p;
        let speed2 = j.d1.length_squared();
        let whole = speed2 + d.dot(j.d2);
        let slope = if whole > 0.25 * speed2 { whole } else { speed2 };
        let next = (t - d.dot(j.d1) / slope).clamp(range.0, range.1);
        if !next.is_finite() {
            return (t, j.p);
        }
        let step = next - t;
        t = next;
        if step.abs() <= slack {
            return (t, j.p + j.d1 * step + j.d2 * (0.5 * step * step));
        }
    }
    (t, view.point(t))
}

/// Squared distance of two segments and the shares along both where it is taken.
#[inline]
pub(crate) fn segments((p0, p1): (DVec3, DVec3), (q0, q1): (DVec3, DVec3)) -> (f64, f64, f64) {
    let (u, v, w) = (p1 - p0, q1 - q0, p0 - q0);
    let (uu, vv, uv) = (u.dot(u), v.dot(v), u.dot(v));
    let (uw, vw) = (u.dot(w), v.dot(w));
    let det = uu * vv - uv * uv;
    let foot_on_first = |t: f64| if uu > 0.0 { ((uv * t - uw) / uu).clamp(0.0, 1.0) } else { 0.0 };
    let mut s = if det > EPSILON * uu * vv { ((uv * vw - vv * uw) / det).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = if vv > 0.0 { (uv * s + vw) / vv } else { -1.0 };
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = foot_on_first(t);
    }
    ((w + u * s - v * t).length_squared(), s, t)
}
