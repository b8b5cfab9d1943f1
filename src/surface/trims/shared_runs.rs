//! Where curves on a surface meet: runs along which they are one, and shallow crossings, which are one place.

use std::f64::consts::PI;

use crate::base::fault::Result;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::base::{math, solve};
use crate::network::{Chain, Meeting, meet};

/// Places at which the gap between two curves along a run is looked at.
const SAMPLES: usize = 16;
/// Gaps of up to so many roundings are none.
const EXACT: f64 = 64.0;
/// Curves cross at a small angle where their directions differ by less than this, in radians.
const SHALLOW: f64 = 0.1;
/// Runs of two curves between meetings are one where neither is longer than the other by this factor.
const UNLIKE: f64 = 2.0;

/// The meetings of two curves, ordered along the first, a shallow crossing as one point.
///
/// Curves that cross or leave a common end at a small angle are within the tolerance of each other for a while, and may seem to meet
/// several times or to share a part of it.
pub(crate) fn meetings(a: &Chain, b: &Chain, tolerance: &Tolerance) -> Result<Vec<Meeting>> {
    let mut out: Vec<Meeting> = Vec::new();
    for next in meet(a, b, tolerance)? {
        match out.pop() {
            Some(last) => match together(a, b, (&last, &next), tolerance) {
                Some(run) => out.push(run),
                None => out.extend([last, next]),
            },
            None => out.push(next),
        }
    }
    for m in &mut out {
        if let Some((fa, fb)) = m.overlap_end.and_then(|to| crossing(a, b, ((m.fa, m.fb), to), tolerance)) {
            *m = Meeting { point: a.point(fa), fa, fb, tangent: m.tangent, overlap_end: None };
        }
    }
    Ok(out)
}

/// Whether two curves run in about the same direction, forwards or backwards, at a place of each.
fn alongside(a: &Chain, b: &Chain, (fa, fb): (f64, f64)) -> bool {
    let angle = math::angle_between(a.jet(fa).d1, b.jet(fb).d1);
    angle.min(PI - angle) <= SHALLOW
}

/// The run from one meeting to the end of another, where it is within the tolerance, but not one curve, between them.
fn together(a: &Chain, b: &Chain, (first, next): (&Meeting, &Meeting), tolerance: &Tolerance) -> Option<Meeting> {
    let (from, to) = (first.overlap_end.unwrap_or((first.fa, first.fb)), (next.fa, next.fb));
    let (own, other) = ((to.0 - from.0).abs() * a.length(), (to.1 - from.1).abs() * b.length());
    let alike = own.min(other) * UNLIKE + tolerance.point >= own.max(other);
    let gap = |k: usize| b.closest(a.point(from.0 + (to.0 - from.0) * k as f64 / SAMPLES as f64)).2;
    if !alike || !alongside(a, b, from) || !alongside(a, b, to) || (1..SAMPLES).any(|k| gap(k) > tolerance.point) {
        return None;
    }
    Some(Meeting { overlap_end: Some(next.overlap_end.unwrap_or(to)), ..*first })
}

/// The one place, by its fractions on both curves, that a run within the tolerance stands for: where they are nearest.
///
/// Such a run goes on beyond both its ends, for as long again, where the curves do; `None` for a run along which they are one, or
/// that is all of what lies within the tolerance.
fn crossing(a: &Chain, b: &Chain, (start, end): ((f64, f64), (f64, f64)), tolerance: &Tolerance) -> Option<(f64, f64)> {
    let (from, to) = (start.0, end.0);
    let gap = |f: f64| b.closest(a.point(f)).2;
    let at = |k: usize| from + (to - from) * k as f64 / SAMPLES as f64;
    let gaps: Vec<f64> = (0..=SAMPLES).map(|k| gap(at(k))).collect();
    if gaps.iter().all(|gap| *gap <= EXACT * tolerance.rounding) {
        return None;
    }
    let closed = a.is_closed(tolerance);
    let on = |f: f64| if closed { f - f.floor() } else { f };
    let ends = |chain: &Chain, f: f64| !chain.is_closed(tolerance) && chain.length() * f.min(1.0 - f) <= tolerance.point;
    let stops = (ends(a, from) || ends(b, start.1), ends(a, to) || ends(b, end.1));
    let beyond = [(stops.0, from - (to - from)), (stops.1, to + (to - from))];
    let goes_on = |f: f64| (closed || (0.0..=1.0).contains(&f)) && gap(on(f)) <= tolerance.point;
    let parallel = alongside(a, b, start) && alongside(a, b, end);
    if !parallel || stops == (true, true) || !beyond.iter().all(|(stops, f)| *stops || goes_on(*f)) {
        return None;
    }
    let least = (0..=SAMPLES).min_by(|x, y| gaps[*x].total_cmp(&gaps[*y]))?;
    let inside = solve::lowest(at(least.saturating_sub(1)), at((least + 1).min(SAMPLES)), EPSILON, gap);
    let place = if gap(inside) < gaps[least] { inside } else { at(least) };
    Some((place, b.closest(a.point(place)).0))
}
