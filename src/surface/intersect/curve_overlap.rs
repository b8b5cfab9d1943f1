//! Parts of a curve that run along a patch: each run of them is an overlap, or the touches and close crossings in it.

use glam::{DVec2, DVec3};

use crate::base::solve;
use crate::base::tolerance::{EPSILON, NEWTON_STEP};
use crate::geometry::curves::pieces::View;
use crate::surface::closest::foot::FootSearch;
use crate::surface::intersect::curve_patch::{Contact, CurveSearch, CurveTouch};

/// What runs along a surface for fewer tolerances than this is no overlap of its own.
pub(super) const SHORTEST_OVERLAP: f64 = 4.0;

/// The parts of a section that run along a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub section: usize,
    pub t: (f64, f64),
    pub uv: DVec2,
}

/// Parts that follow each other, with the place of each.
#[derive(Clone, Debug)]
pub(super) struct Run {
    section: usize,
    t: (f64, f64),
    places: Vec<(f64, DVec2)>,
}

impl Run {
    /// The places of the parts nearest to a parameter.
    fn near(&self, t: f64) -> &[(f64, DVec2)] {
        const AROUND: usize = 4;
        let k = self.places.partition_point(|p| p.0 < t);
        &self.places[k.saturating_sub(AROUND)..(k + AROUND).min(self.places.len())]
    }
}

impl CurveSearch<'_> {
    /// The overlap of a run, else its touches and crossings.
    pub(super) fn resolve(&mut self, run: &Run, out: &mut Vec<Contact>) {
        const SAMPLES: usize = 65;
        let pieces = self.curve.pieces();
        let (view, section) = (pieces.view_of(self.curve, run.section), pieces.sections[run.section]);
        let (t0, t1) = run.t;
        let at = |k: usize| if k + 1 == SAMPLES { t1 } else { t0 + (t1 - t0) * k as f64 / (SAMPLES - 1) as f64 };
        // From the place before, or, where that leads off (past a pole, over a fold), from that of the part.
        let mut uv = run.places[0].1;
        let mut samples: Vec<OverlapSample> = Vec::with_capacity(SAMPLES);
        for k in 0..SAMPLES {
            let mut best = self.sample(&view, at(k), uv);
            for (_, place) in run.near(at(k)) {
                if best.gap <= self.point {
                    break;
                }
                let fresh = self.sample(&view, at(k), *place);
                best = if fresh.gap < best.gap { fresh } else { best };
            }
            uv = best.uv;
            samples.push(best);
        }
        let common = |t: f64| section.to_common(t);
        let overlap = longest(&samples, |s| s.gap <= self.point);
        if let Some((i, j)) = overlap {
            let ended = |s: &OverlapSample| view.at_end(s.t) || self.at_border(s.uv);
            let length = (i..j).map(|k| samples[k].p.distance(samples[k + 1].p)).sum::<f64>();
            let close = longest(&samples, |s| s.gap <= 0.5 * self.point);
            let lies = close.is_some_and(|(i, j)| (i..j).map(|k| samples[k].p.distance(samples[k + 1].p)).sum::<f64>() > self.long);
            let whole = ended(&samples[i]) && ended(&samples[j]) && length > SHORTEST_OVERLAP * self.point && (j - i) > 2;
            if lies || whole && self.is_flat_run(&samples[i..=j]) {
                let (from, to) = (self.overlap_end(&view, &samples, i, true), self.overlap_end(&view, &samples, j, false));
                out.push(Contact::Overlap { t: (common(from), common(to)) });
                self.found.retain(|(s, touch)| *s != run.section || touch.t < from || touch.t > to);
                return;
            }
        }
        self.points(&view, run, &samples);
    }

    /// Where an overlap that lies on the surface ends beyond its last sample: there the gap begins to grow.
    fn overlap_end(&self, view: &View, samples: &[OverlapSample], k: usize, first: bool) -> f64 {
        const ROUNDS: usize = 60;
        const EXACT: f64 = 64.0;
        let beyond = if first { k.checked_sub(1) } else { Some(k + 1).filter(|k| *k < samples.len()) };
        let Some(beyond) = beyond else { return samples[k].t };
        let inner = samples.iter().map(|s| s.gap).fold(f64::INFINITY, f64::min).max(samples[k].gap);
        let limit = (2.0 * inner).max(EXACT * EPSILON * samples[k].p.abs().max_element()).min(self.point);
        let (mut low, mut high) = (samples[k].t, samples[beyond].t);
        for _ in 0..ROUNDS {
            let middle = 0.5 * (low + high);
            if self.sample(view, middle, samples[k].uv).gap <= limit { low = middle } else { high = middle }
        }
        low
    }

    /// Whether the heights over a run have no crossing in them that stands out: it lies on the surface from end to end.
    fn is_flat_run(&self, samples: &[OverlapSample]) -> bool {
        samples.iter().all(|s| s.height.abs() <= 0.5 * self.point)
    }

    /// Crossings and touches among samples.
    fn points(&mut self, view: &View, run: &Run, samples: &[OverlapSample]) {
        let section = run.section;
        let before = self.found.len();
        for w in samples.windows(2) {
            if w[0].height * w[1].height < 0.0 {
                let root = self.root(view, &w[0], &w[1]);
                self.take(view, section, root);
            }
        }
        let last = samples.len() - 1;
        for k in 0..=last {
            let (a, b) = (samples[k.saturating_sub(1)].gap, samples[(k + 1).min(last)].gap);
            if samples[k].gap <= a && samples[k].gap <= b {
                let (low, high) = (&samples[k.saturating_sub(1)], &samples[(k + 1).min(last)]);
                let t = solve::lowest(low.t, high.t, EPSILON.sqrt(), |t| self.sample(view, t, samples[k].uv).gap);
                let bottom = self.sample(view, t, samples[k].uv);
                let best = if bottom.gap < samples[k].gap { bottom } else { samples[k] };
                self.take(view, section, best);
            }
        }
        // Several touches without a rise between them are one.
        let mut fresh = self.found.split_off(before);
        fresh.sort_by(|a, b| a.1.gap.total_cmp(&b.1.gap).then(a.1.t.total_cmp(&b.1.t)));
        let alone =
            |kept: &[(usize, CurveTouch)], touch: &CurveTouch| kept.iter().all(|(s, k)| *s != section || k.p.distance(touch.p) > self.long);
        for one in fresh {
            if alone(&self.found, &one.1) {
                self.found.push(one);
            }
        }
    }

    fn take(&mut self, view: &View, section: usize, s: OverlapSample) {
        if s.gap <= self.point {
            let touch = self.touch(view, s.t, s.uv);
            self.found.push((section, touch));
        }
    }

    fn root(&self, view: &View, x: &OverlapSample, y: &OverlapSample) -> OverlapSample {
        let (mut low, mut high) = (*x, *y);
        const ROUNDS: usize = 80;
        for _ in 0..ROUNDS {
            let middle = self.sample(view, 0.5 * (low.t + high.t), low.uv);
            if middle.t <= low.t || middle.t >= high.t {
                break;
            }
            if middle.height * x.height > 0.0 { low = middle } else { high = middle }
        }
        if low.gap <= high.gap { low } else { high }
    }

    fn sample(&self, view: &View, t: f64, near: DVec2) -> OverlapSample {
        let p = view.point(t);
        let (uv, gap) = self.sheet.patch.foot(p, near);
        let jet = self.sheet.patch.jet(uv);
        let height = (p - jet.p).dot(jet.du.cross(jet.dv).normalize_or_zero());
        OverlapSample { t, uv, p, gap, height }
    }

    fn at_border(&self, uv: DVec2) -> bool {
        let patch = &self.sheet.patch;
        patch.lines().into_iter().any(|line| line.inside(patch, uv) <= NEWTON_STEP)
    }
}

#[derive(Clone, Copy, Debug)]
struct OverlapSample {
    t: f64,
    uv: DVec2,
    p: DVec3,
    gap: f64,
    /// Over the tangent plane, with its sign.
    height: f64,
}

/// The longest row of samples that all fulfil something: its first and last.
fn longest(samples: &[OverlapSample], holds: impl Fn(&OverlapSample) -> bool) -> Option<(usize, usize)> {
    let mut best: Option<(usize, usize)> = None;
    let mut start = None;
    for k in 0..=samples.len() {
        if k < samples.len() && holds(&samples[k]) {
            let from = *start.get_or_insert(k);
            if best.is_none_or(|(a, b)| k - from > b - a) {
                best = Some((from, k));
            }
        } else {
            start = None;
        }
    }
    best.filter(|(a, b)| b > a)
}

/// Joins parts that follow each other on the curve.
pub(super) fn runs(mut near: Vec<Near>) -> Vec<Run> {
    near.sort_by(|x, y| x.section.cmp(&y.section).then(x.t.0.total_cmp(&y.t.0)).then(x.t.1.total_cmp(&y.t.1)));
    let mut out: Vec<Run> = Vec::new();
    for part in near {
        let place = (0.5 * (part.t.0 + part.t.1), part.uv);
        match out.last_mut() {
            Some(last) if last.section == part.section && part.t.0 <= last.t.1 => {
                last.t.1 = last.t.1.max(part.t.1);
                last.places.push(place);
            }
            _ => out.push(Run { section: part.section, t: part.t, places: vec![place] }),
        }
    }
    out.iter_mut().for_each(|run| run.places.sort_by(|a, b| a.0.total_cmp(&b.0)));
    out
}
