//! Curves that run along each other within the tolerance: overlaps, tangential contacts and pairs of crossings
//! close together are separated here.

use glam::DVec3;

use crate::base::job;
use crate::base::solve;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::geometry::curves::pieces::View;
use crate::geometry::query::intersect::newton::{Near, approach, foot};
use crate::geometry::query::intersect::search::{END_REACH, Found, Rect, Search};

/// An overlap in own parameters of two sections; `b` descends when the second curve runs the other way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shared {
    pub(crate) sections: (usize, usize),
    pub(crate) a: (f64, f64),
    pub(crate) b: (f64, f64),
}

/// Overlaps shorter than this many tolerances are points.
const SHORTEST: f64 = 4.0;
/// Samples of a run, at least and at most.
const SAMPLES: (usize, usize) = (33, 1025);
/// Distances within this many roundings are none.
const EXACT: f64 = 64.0;

/// Works out everything that the search left undecided.
pub(crate) fn resolve(search: &mut Search, tolerance: &Tolerance) -> Vec<Shared> {
    let mut rects = std::mem::take(&mut search.near);
    rects.sort_by(|x, y| x.sections.cmp(&y.sections).then(x.a.0.total_cmp(&y.a.0)).then(x.b.0.total_cmp(&y.b.0)));
    let mut shared = Vec::new();
    for group in rects.chunk_by(|x, y| x.sections == y.sections) {
        let sections = group[0].sections;
        let (a, b) = (search.a.view(sections.0), search.b.view(sections.1));
        for run in runs(group) {
            let mut contact = Contact { a, b, run, tolerance, found: Vec::new(), shared: Vec::new() };
            contact.resolve();
            search.found.extend(contact.found.iter().map(|(near, tangent)| Found { sections, near: *near, tangent: *tangent }));
            shared.extend(contact.shared.iter().map(|(a, b)| Shared { sections, a: *a, b: *b }));
        }
    }
    shared
}

/// A connected set of near parts: its extent on both sections and the number of parts.
#[derive(Clone, Copy, Debug)]
struct Run {
    a: (f64, f64),
    b: (f64, f64),
    parts: usize,
}

/// Joins parts that touch in both parameters but for rounding; `rects` ascend in `a`.
fn runs(rects: &[Rect]) -> Vec<Run> {
    let beyond = |t: f64, end: f64| t > end + EXACT * EPSILON * t.abs().max(end.abs());
    let (mut open, mut done): (Vec<Run>, Vec<Run>) = (Vec::new(), Vec::new());
    for rect in rects {
        let mut joined = Run { a: rect.a, b: rect.b, parts: 1 };
        let mut i = 0;
        while i < open.len() {
            job::poll();
            let run = open[i];
            if beyond(rect.a.0, run.a.1) {
                done.push(open.swap_remove(i));
            } else if !beyond(run.b.0, joined.b.1) && !beyond(joined.b.0, run.b.1) {
                open.swap_remove(i);
                joined = Run {
                    a: (run.a.0.min(joined.a.0), run.a.1.max(joined.a.1)),
                    b: (run.b.0.min(joined.b.0), run.b.1.max(joined.b.1)),
                    parts: run.parts + joined.parts,
                };
            } else {
                i += 1;
            }
        }
        open.push(joined);
    }
    done.extend(open);
    done.sort_by(|x, y| x.a.0.total_cmp(&y.a.0).then(x.b.0.total_cmp(&y.b.0)));
    done
}

/// One run under examination.
struct Contact<'a> {
    a: View<'a>,
    b: View<'a>,
    run: Run,
    tolerance: &'a Tolerance,
    found: Vec<(Near, bool)>,
    shared: Vec<((f64, f64), (f64, f64))>,
}

/// The run on the first section after cutting off what lies beyond the second one's ends.
struct Extent {
    low: f64,
    high: f64,
    /// Whether a curve ends there, within the tolerance of the other one.
    ended: (bool, bool),
    /// Whether both run the same way.
    along: bool,
}

/// One sampled pair: parameters and the vector from the second curve to the first.
#[derive(Clone, Copy)]
struct Sample {
    ta: f64,
    tb: f64,
    pa: DVec3,
    gap: DVec3,
}

impl Contact<'_> {
    fn resolve(&mut self) {
        let extent = self.extent();
        let wide =
            extent.low < extent.high && self.a.point(extent.low).distance(self.a.point(extent.high)) > SHORTEST * self.tolerance.point;
        // A closed run has its ends at one place and is still long.
        let long = wide || (extent.low < extent.high && self.run.parts > 2 && self.length(&extent) > SHORTEST * self.tolerance.point);
        if !long {
            self.single(&extent);
            return;
        }
        let samples = self.samples(&extent);
        let together = samples.iter().all(|s| s.gap.length() <= self.tolerance.point);
        if extent.ended == (true, true) && together {
            self.share(samples[0], samples[samples.len() - 1]);
            return;
        }
        let exact = self.exact_stretches(&extent);
        if exact.is_empty() {
            self.points(&samples, extent.ended);
            return;
        }
        let (mut from, mut ended) = (extent.low, extent.ended.0);
        for (low, high) in exact {
            self.between(&samples, (from, low.ta), (ended, false));
            self.share(low, high);
            (from, ended) = (high.ta, false);
        }
        self.between(&samples, (from, extent.high), (ended, extent.ended.1));
    }

    fn length(&self, extent: &Extent) -> f64 {
        let at = |i: u32| self.a.point(extent.low + (extent.high - extent.low) * f64::from(i) / 16.0);
        (0..16).map(|i| at(i).distance(at(i + 1))).sum()
    }

    fn share(&mut self, low: Sample, high: Sample) {
        self.shared.push(((low.ta, high.ta), (low.tb, high.tb)));
    }

    /// A run too short to be anything but one point.
    fn single(&mut self, extent: &Extent) {
        let (middle_a, middle_b) = (0.5 * (extent.low + extent.high), 0.5 * (self.run.b.0 + self.run.b.1));
        let (tb, _) = foot(&self.b, self.a.point(middle_a), middle_b);
        let mut best = approach(&self.a, &self.b, (middle_a, tb));
        // Near-parallel directions leave Newton's method undecided; the middle itself is as good.
        for t in [middle_a, extent.low, extent.high] {
            let (tb, pb) = foot(&self.b, self.a.point(t), middle_b);
            let there = Near { ta: t, tb, pa: self.a.point(t), pb };
            if there.gap() < best.gap() || !self.inside(best) {
                best = there;
            }
        }
        self.push(best, false);
    }

    fn inside(&self, near: Near) -> bool {
        let grown = |t: f64, run: (f64, f64)| {
            let slack = run.1 - run.0;
            run.0 - slack <= t && t <= run.1 + slack
        };
        grown(near.ta, self.run.a) && grown(near.tb, self.run.b)
    }

    fn push(&mut self, near: Near, tangent: bool) {
        if near.gap() <= self.tolerance.point {
            self.found.push((near, tangent));
        }
    }

    fn sample(&self, ta: f64, guess: f64) -> Sample {
        let pa = self.a.point(ta);
        let (tb, pb) = foot(&self.b, pa, guess);
        Sample { ta, tb, pa, gap: pa - pb }
    }

    /// A starting parameter on the second section.
    fn guess(&self, ta: f64, along: bool) -> f64 {
        let (a, b) = (self.run.a, self.run.b);
        let share = if a.1 > a.0 { (ta - a.0) / (a.1 - a.0) } else { 0.5 };
        b.0 + (b.1 - b.0) * if along { share } else { 1.0 - share }
    }

    fn extent(&self) -> Extent {
        let (run_a, run_b) = (self.run.a, self.run.b);
        let (middle_a, middle_b) = (0.5 * (run_a.0 + run_a.1), 0.5 * (run_b.0 + run_b.1));
        let along = self.a.jet(middle_a).d1.dot(self.b.jet(middle_b).d1) >= 0.0;
        let mut extent = Extent { low: run_a.0, high: run_a.1, ended: (false, false), along };
        let touches = |t: f64| self.sample(t, self.guess(t, along)).gap.length() <= self.tolerance.point;
        let (first, last) = self.a.section.range;
        extent.ended.0 = run_a.0 <= first && touches(first);
        extent.ended.1 = run_a.1 >= last && touches(last);
        let range = self.b.section.range;
        for (end, p, is_start) in [(range.0, self.b.section.ends.0, true), (range.1, self.b.section.ends.1, false)] {
            if end < run_b.0 || run_b.1 < end {
                continue;
            }
            // On a closed curve the foot nearest to the side where the second curve lives is meant.
            let side = if is_start == along { run_a.0 } else { run_a.1 };
            let (t, on) = foot(&self.a, p, if self.run.parts > 4 { side } else { middle_a });
            if on.distance(p) > self.tolerance.point {
                continue;
            }
            if is_start == along {
                if t >= extent.low {
                    (extent.low, extent.ended.0) = (t, true);
                }
            } else if t <= extent.high {
                (extent.high, extent.ended.1) = (t, true);
            }
        }
        extent
    }

    fn samples(&self, extent: &Extent) -> Vec<Sample> {
        let count = (4 * self.run.parts + 1).clamp(SAMPLES.0, SAMPLES.1);
        let mut guess = self.guess(extent.low, extent.along);
        let mut rate = 0.0;
        let mut out: Vec<Sample> = Vec::with_capacity(count);
        for i in 0..count {
            job::poll();
            let ta = if i + 1 == count { extent.high } else { extent.low + (extent.high - extent.low) * i as f64 / (count - 1) as f64 };
            let sample = self.sample(ta, guess + rate);
            if let Some(before) = out.last() {
                rate = sample.tb - before.tb;
            }
            guess = sample.tb;
            out.push(sample);
        }
        out
    }

    /// Overlaps between knots or ends over which the curves are the same but for rounding.
    fn exact_stretches(&self, extent: &Extent) -> Vec<(Sample, Sample)> {
        let mut marks = vec![extent.low, extent.high];
        marks.extend(self.a.curve.knots());
        for tb in self.b.curve.knots() {
            if self.run.b.0 <= tb && tb <= self.run.b.1 {
                let share = (tb - self.run.b.0) / (self.run.b.1 - self.run.b.0);
                let share = if extent.along { share } else { 1.0 - share };
                marks.push(foot(&self.a, self.b.point(tb), self.run.a.0 + (self.run.a.1 - self.run.a.0) * share).0);
            }
        }
        marks.retain(|t| (extent.low..=extent.high).contains(t));
        marks.sort_by(f64::total_cmp);
        marks.dedup_by(|x, y| self.a.point(*x).distance(self.a.point(*y)) <= EXACT * self.tolerance.rounding);
        let same = |t0: f64, t1: f64| {
            (0..=12).all(|i| {
                let t = t0 + (t1 - t0) * f64::from(i) / 12.0;
                self.sample(t, self.guess(t, extent.along)).gap.length() <= EXACT * self.tolerance.rounding
            })
        };
        let mut overlaps: Vec<(f64, f64)> = Vec::new();
        for pair in marks.windows(2) {
            if self.a.point(pair[0]).distance(self.a.point(pair[1])) > SHORTEST * self.tolerance.point && same(pair[0], pair[1]) {
                match overlaps.last_mut() {
                    Some(last) if last.1 == pair[0] => last.1 = pair[1],
                    _ => overlaps.push((pair[0], pair[1])),
                }
            }
        }
        let at = |t: f64| self.sample(t, self.guess(t, extent.along));
        overlaps.into_iter().map(|(low, high)| (at(low), at(high))).collect()
    }

    /// Points among the samples between two parameters, away from overlaps at open sides.
    fn between(&mut self, samples: &[Sample], (low, high): (f64, f64), ended: (bool, bool)) {
        let inner: Vec<Sample> = samples.iter().copied().filter(|s| low < s.ta && s.ta < high).collect();
        if inner.len() >= 3 {
            self.points(&inner, ended);
        }
    }

    /// Crossings, tangential contacts and touching ends along a run of samples.
    fn points(&mut self, samples: &[Sample], ended: (bool, bool)) {
        let last = samples.len() - 1;
        let size = |i: usize| samples[i].gap.length();
        let by_size = |x: &usize, y: &usize| size(*x).total_cmp(&size(*y));
        let (Some(nearest), Some(farthest)) = ((0..=last).min_by(by_size), (0..=last).max_by(by_size)) else { return };
        // The direction in which the gap changes; along it the gap has a sign.
        let normal = (samples[farthest].gap - samples[nearest].gap).normalize_or_zero();
        let before = self.found.len();
        // Heights within rounding are none: a run of them touches or crosses as its neighbours say.
        let height = |i: usize| samples[i].gap.dot(normal);
        let clear: Vec<usize> = (0..=last).filter(|&i| height(i).abs() > self.tolerance.rounding).collect();
        for pair in clear.windows(2) {
            let (i, j) = (pair[0], pair[1]);
            if height(i) * height(j) < 0.0 {
                self.crossing(samples[i], samples[j], normal);
            } else if j > i + 1 {
                self.touch(samples[i], samples[j], normal);
            }
        }
        for i in 1..last {
            let (x, y, z) = (height(i - 1), height(i), height(i + 1));
            let lowest = y.abs() > self.tolerance.rounding && y.abs() <= x.abs() && y.abs() < z.abs();
            if lowest && x * y > 0.0 && y * z > 0.0 {
                self.touch(samples[i - 1], samples[i + 1], normal);
            }
        }
        if ended.0 && size(0) <= size(1) {
            self.end_contact(samples[0], before);
        }
        if ended.1 && size(last) <= size(last - 1) {
            self.end_contact(samples[last], before);
        }
        if self.found.len() == before {
            let s = samples[nearest];
            self.push(near_of(s), false);
        }
    }

    /// A touching end; crossings just before it are the same meeting.
    fn end_contact(&mut self, end: Sample, since: usize) {
        let near = near_of(end);
        if near.gap() <= self.tolerance.point {
            let reach = END_REACH * self.tolerance.point;
            let mut index = 0;
            self.found.retain(|(other, _)| {
                index += 1;
                index <= since || other.pa.distance(near.pa) > reach
            });
            self.push(near, false);
        }
    }

    /// The root of the signed gap between two samples of different sign.
    fn crossing(&mut self, x: Sample, y: Sample, normal: DVec3) {
        let root = self.root(x, y, normal);
        self.push(near_of(root), false);
    }

    fn root(&self, x: Sample, y: Sample, normal: DVec3) -> Sample {
        let (mut low, mut high) = (x, y);
        let accuracy = EPSILON * (self.a.section.range.1 - self.a.section.range.0);
        for round in 0..100 {
            let (f0, f1) = (low.gap.dot(normal), high.gap.dot(normal));
            if f0 == 0.0 || high.ta - low.ta <= accuracy {
                return low;
            }
            // False position, with bisection every third time so that the bracket shrinks from both sides.
            let share = if round % 3 == 2 { 0.5 } else { f0 / (f0 - f1) };
            let middle = self.sample(low.ta + (high.ta - low.ta) * share, low.tb + (high.tb - low.tb) * share);
            if (middle.gap.dot(normal) > 0.0) == (f0 > 0.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// A least gap between two samples on one side: a contact, or two crossings when the gap changes sign there.
    fn touch(&mut self, x: Sample, z: Sample, normal: DVec3) {
        let sign = x.gap.dot(normal).signum();
        let height = |t: f64| {
            let share = (t - x.ta) / (z.ta - x.ta);
            self.sample(t, x.tb + (z.tb - x.tb) * share)
        };
        let t = solve::lowest(x.ta, z.ta, EPSILON.sqrt(), |t| height(t).gap.dot(normal) * sign);
        let bottom = height(t);
        let depth = bottom.gap.dot(normal) * sign;
        if depth < -self.tolerance.rounding {
            let (first, second) = (self.root(x, bottom, normal), self.root(bottom, z, normal));
            if first.pa.distance(second.pa) > self.tolerance.point {
                self.push(near_of(first), false);
                self.push(near_of(second), false);
                return;
            }
        }
        self.push(near_of(bottom), true);
    }
}

fn near_of(s: Sample) -> Near {
    Near { ta: s.ta, tb: s.tb, pa: s.pa, pb: s.pa - s.gap }
}
