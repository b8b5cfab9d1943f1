//! Where chains meet, for `&`, `meet` and for finding flows.

use glam::DVec3;

use super::chain::{Chain, Run, same_curve};
use super::snap::may_snap;
use crate::base::fault::Result;
use crate::base::job;
use crate::base::tolerance::Tolerance;
use crate::geometry::intersect;
use crate::geometry::{Hit, closest_pair};
use crate::network::fault::MeetingFault;

/// One meeting of two chains: a node of the two, or the ends of an overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The point: an end or joint point where one is among the hits, else the mean.
    pub point: DVec3,
    /// Fraction on the first chain.
    pub fa: f64,
    /// Fraction on the second chain.
    pub fb: f64,
    /// They touch without crossing.
    pub tangent: bool,
    /// `Some((fa, fb))`: the other end of an overlap that begins here.
    pub overlap_end: Option<(f64, f64)>,
}

/// All meetings, ordered along `a`, each node once.
pub fn meet(a: &Chain, b: &Chain, tolerance: &Tolerance) -> Result<Vec<Meeting>> {
    let mut found = Vec::new();
    if !a.bbox().touches(&b.bbox(), tolerance.point) {
        return Ok(found);
    }
    for (ka, run_a) in a.runs().iter().enumerate() {
        for (kb, run_b) in b.runs().iter().enumerate() {
            job::poll();
            if same_curve(&run_a.curve, &run_b.curve) {
                on_one_curve(RunOf { chain: a, place: ka }, RunOf { chain: b, place: kb }, tolerance, &mut found);
            } else if run_a.curve.bbox().touches(&run_b.curve.bbox(), tolerance.point) {
                for hit in intersect(&run_a.curve, &run_b.curve, tolerance)? {
                    collect(hit, RunOf { chain: a, place: ka }, RunOf { chain: b, place: kb }, tolerance, &mut found);
                }
            }
        }
    }
    Ok(tidy(a, b, found, tolerance))
}

/// The one meeting that `a & b` stands for; none, several or an overlap are E507, E508, E509 with candidates and the closest miss.
pub fn meet_once(a: &Chain, b: &Chain, tolerance: &Tolerance) -> Result<Meeting> {
    let meetings = meet(a, b, tolerance)?;
    if meetings.iter().any(|m| m.overlap_end.is_some()) {
        let overlaps = meetings.iter().filter_map(|m| m.overlap_end.map(|(fa, _)| (m.point, a.point(fa)))).collect();
        return Err(MeetingFault::Overlap { a: a.origin(), b: b.origin(), overlaps }.into());
    }
    match meetings.as_slice() {
        [one] => Ok(*one),
        [] => {
            let (pa, pb) = closest_points(a, b);
            let near = may_snap(pa.distance(pb), a.length().min(b.length()));
            Err(MeetingFault::NoMeeting { a: (a.origin(), pa), b: (b.origin(), pb), near, tolerance: tolerance.point }.into())
        }
        several => {
            let candidates = several.iter().map(|m| (m.point, m.fa)).collect();
            Err(MeetingFault::SeveralMeetings { a: a.origin(), b: b.origin(), candidates }.into())
        }
    }
}

/// The nearest points of two chains.
pub fn closest_points(a: &Chain, b: &Chain) -> (DVec3, DVec3) {
    let mut best = (a.start(), b.start());
    let mut offer = |pair: (DVec3, DVec3)| {
        if pair.0.distance_squared(pair.1) < best.0.distance_squared(best.1) {
            best = pair;
        }
    };
    for end in [a.start(), a.end()] {
        offer((end, b.closest(end).1));
    }
    for end in [b.start(), b.end()] {
        offer((a.closest(end).1, end));
    }
    for piece_a in a.runs().iter().flat_map(super::slice::pieces) {
        for piece_b in b.runs().iter().flat_map(super::slice::pieces) {
            job::poll();
            let (ta, tb, _) = closest_pair(&piece_a, &piece_b);
            offer((piece_a.point(ta), piece_b.point(tb)));
        }
    }
    best
}

/// Indices of the first two chains that are the same runs, in either direction.
pub fn given_twice(chains: &[Chain], tolerance: &Tolerance) -> Option<(usize, usize)> {
    let ends = |c: &Chain| (c.start(), c.end());
    let same_ends = |a: &Chain, b: &Chain| {
        let ((a0, a1), (b0, b1)) = (ends(a), ends(b));
        let same = |p, q| tolerance.same_point(p, q);
        same(a0, b0) && same(a1, b1) || same(a0, b1) && same(a1, b0)
    };
    let run = |x: &Run, y: &Run| {
        let span = |r: &Run| (r.s0.min(r.s1), r.s0.max(r.s1));
        let ((a0, a1), (b0, b1)) = (span(x), span(y));
        (a0 - b0).abs() <= tolerance.point && (a1 - b1).abs() <= tolerance.point && same_curve(&x.curve, &y.curve)
    };
    let forwards = |a: &Chain, b: &Chain| a.runs().iter().zip(b.runs()).all(|(x, y)| run(x, y));
    let backwards = |a: &Chain, b: &Chain| a.runs().iter().zip(b.runs().iter().rev()).all(|(x, y)| run(x, y));
    let same = |a: &Chain, b: &Chain| {
        a.runs().len() == b.runs().len()
            && (a.length() - b.length()).abs() <= tolerance.point
            && same_ends(a, b)
            && (forwards(a, b) || backwards(a, b))
    };
    (1..chains.len()).find_map(|b| (0..b).find(|&a| same(&chains[a], &chains[b])).map(|a| (a, b)))
}

/// The arc length of a run that stands for a place of its curve: inside within the tolerance, on any turn.
fn on_run(run: &Run, s: f64, tolerance: &Tolerance) -> Option<f64> {
    let (lo, hi) = (run.s0.min(run.s1), run.s0.max(run.s1));
    turns(run, tolerance).map(|turn| s + turn).find(|s| *s >= lo - tolerance.point && *s <= hi + tolerance.point).map(|s| s.clamp(lo, hi))
}

/// A run of a chain.
#[derive(Clone, Copy)]
struct RunOf<'a> {
    chain: &'a Chain,
    place: usize,
}

impl RunOf<'_> {
    fn run(&self) -> &Run {
        &self.chain.runs()[self.place]
    }

    fn fraction(&self, s: f64) -> f64 {
        self.chain.fraction(self.place, s)
    }
}

/// Turns a hit of two curves into a meeting of two chains, when it lies on both runs.
fn collect(hit: Hit, a: RunOf, b: RunOf, tolerance: &Tolerance, found: &mut Vec<Meeting>) {
    let (run_a, run_b) = (a.run(), b.run());
    match hit {
        Hit::Point { ta, tb, at, tangent, .. } => {
            let sa = on_run(run_a, run_a.curve.length_at(ta), tolerance);
            let sb = on_run(run_b, run_b.curve.length_at(tb), tolerance);
            if let (Some(sa), Some(sb)) = (sa, sb) {
                found.push(Meeting { point: at, fa: a.fraction(sa), fb: b.fraction(sb), tangent, overlap_end: None });
            }
        }
        Hit::Overlap { a: (ta0, ta1), b: (tb0, tb1) } => {
            let lengths = |run: &Run, (t0, t1): (f64, f64)| (run.curve.length_at(t0), run.curve.length_at(t1));
            let (whole_a, whole_b) = (lengths(run_a, (ta0, ta1)), lengths(run_b, (tb0, tb1)));
            let moved = |(s0, s1): (f64, f64), turn: f64| (s0 + turn, s1 + turn);
            // Both runs may hold only a part of the overlap: share of it from 0 to 1 that each holds.
            let held = |run: &Run, (s0, s1): (f64, f64)| {
                let (lo, hi) = (run.s0.min(run.s1), run.s0.max(run.s1));
                let share = |s: f64| (s - s0) / (s1 - s0);
                (share(lo).min(share(hi)).max(0.0), share(lo).max(share(hi)).min(1.0))
            };
            for turn_a in turns(run_a, tolerance) {
                for turn_b in turns(run_b, tolerance) {
                    let (along_a, along_b) = (moved(whole_a, turn_a), moved(whole_b, turn_b));
                    let (held_a, held_b) = (held(run_a, along_a), held(run_b, along_b));
                    let (from, to) = (held_a.0.max(held_b.0), held_a.1.min(held_b.1));
                    let at = |share: f64| (along_a.0 + (along_a.1 - along_a.0) * share, along_b.0 + (along_b.1 - along_b.0) * share);
                    // Runs that hold nothing of it, or its end at most, share a point of it at most.
                    let length = (along_a.1 - along_a.0).abs() * (to - from);
                    if length >= -tolerance.point {
                        push_overlap(a, b, (at(from), at(to)), tolerance, found);
                    }
                }
            }
        }
    }
}

/// Whole turns by which places on the curve of a run may be moved.
fn turns(run: &Run, tolerance: &Tolerance) -> impl Iterator<Item = f64> + use<> {
    let length = run.curve.length();
    [0.0, length, -length].into_iter().take(if run.curve.is_closed(tolerance) { 3 } else { 1 })
}

/// An overlap given by arc lengths on both curves; one of no length is a point, one of negative length nothing.
fn push_overlap(a: RunOf, b: RunOf, (from, to): ((f64, f64), (f64, f64)), tolerance: &Tolerance, found: &mut Vec<Meeting>) {
    let length = to.0 - from.0;
    if length < -tolerance.point {
        return;
    }
    let meeting = |(sa, sb): (f64, f64)| (a.fraction(sa), b.fraction(sb));
    let (mut first, mut last) = (meeting(from), meeting(to));
    if last.0 < first.0 {
        std::mem::swap(&mut first, &mut last);
    }
    let overlap_end = (length > tolerance.point).then_some(last);
    found.push(Meeting { point: a.chain.point(first.0), fa: first.0, fb: first.1, tangent: true, overlap_end });
}

/// Two runs on one curve overlap in what both run over.
fn on_one_curve(a: RunOf, b: RunOf, tolerance: &Tolerance, found: &mut Vec<Meeting>) {
    let (run_a, run_b) = (a.run(), b.run());
    for turn in turns(run_a, tolerance) {
        let lo = run_a.s0.min(run_a.s1).max(run_b.s0.min(run_b.s1) + turn);
        let hi = run_a.s0.max(run_a.s1).min(run_b.s0.max(run_b.s1) + turn);
        push_overlap(a, b, ((lo, lo - turn), (hi, hi - turn)), tolerance, found);
    }
}

/// Sorted along `a`, overlaps joined over joints, each node once.
fn tidy(a: &Chain, b: &Chain, mut found: Vec<Meeting>, tolerance: &Tolerance) -> Vec<Meeting> {
    let (near_a, near_b) = (tolerance.point / a.length(), tolerance.point / b.length());
    let (closed_a, closed_b) = (a.is_closed(tolerance), b.is_closed(tolerance));
    for m in &mut found {
        // The start of a closed chain stands for its end.
        if m.overlap_end.is_none() {
            m.fa = if closed_a && m.fa >= 1.0 - near_a { 0.0 } else { m.fa };
            m.fb = if closed_b && m.fb >= 1.0 - near_b { 0.0 } else { m.fb };
        }
        let (pa, pb) = (corner(a, m.fa, near_a), corner(b, m.fb, near_b));
        m.point = pa.or(pb).unwrap_or(m.point);
    }
    found.sort_by(|x, y| x.fa.total_cmp(&y.fa).then(x.fb.total_cmp(&y.fb)));
    let mut out: Vec<Meeting> = Vec::with_capacity(found.len());
    for m in found {
        // A curve may have a span too short to be found as a part of the overlap.
        let goes_on = |(fa, fb): (f64, f64)| {
            m.fa <= fa + REACH * near_a && (m.overlap_end.is_none() && m.fa <= fa + near_a || (m.fb - fb).abs() <= REACH * near_b)
        };
        if let Some(last) = out.last_mut()
            && last.overlap_end.is_some_and(goes_on)
        {
            // A point on an overlap adds nothing, an overlap that goes on lengthens it.
            if let (Some(end), Some(more)) = (&mut last.overlap_end, m.overlap_end)
                && more.0 > end.0
            {
                *end = more;
            }
            continue;
        }
        let near = |k: &Meeting| {
            k.overlap_end.is_none() && tolerance.same_point(k.point, m.point) && (k.fa - m.fa).abs() * a.length() <= REACH * tolerance.point
        };
        if m.overlap_end.is_none() && out.iter().rev().take_while(|k| m.fa - k.fa <= REACH * near_a).any(near) {
            continue;
        }
        // A point where an overlap begins is a part of it.
        if m.overlap_end.is_some() {
            while out.last().is_some_and(near) {
                out.pop();
            }
        }
        out.push(m);
    }
    out
}

/// Hits of one node are at most this many tolerances apart along a chain.
const REACH: f64 = 4.0;

/// The end or joint of a chain within reach of a fraction.
fn corner(chain: &Chain, f: f64, near: f64) -> Option<DVec3> {
    let joints = chain.joints();
    let k = joints.partition_point(|&j| j < f);
    [k.wrapping_sub(1), k]
        .into_iter()
        .filter_map(|k| joints.get(k))
        .find(|&&j| (j - f).abs() <= near)
        .map(|&j| if j >= 1.0 { chain.end() } else { chain.point(j) })
}
