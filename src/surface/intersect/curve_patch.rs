//! Where a curve meets a patch of a surface: subdivision with guaranteed bounds.
//!
//! A pair of a part of the curve and a cell is dropped when they are further apart than the tolerance. Where no tangent of
//! the part can lie in a tangent plane of the cell there is at most one meeting, and Newton's method finds it. What runs
//! along the surface is collected, part by part, and worked out at the end: touches, meetings close together, stretches.

use glam::{DVec2, DVec3};

use crate::base::solve;
use crate::base::tolerance::{EPSILON, NEWTON_STEP};
use crate::geometry::Curve;
use crate::geometry::curves::pieces::{Node, View, children};
use crate::geometry::shapes::bounds::Rates;
use crate::surface::closest::foot::Footing;
use crate::surface::intersect::sheet::{Cell, Sheet, solved};

/// Pairs looked at before giving up.
const MOST_PAIRS: usize = 1_000_000;
/// Share of the tolerance within which parts count as straight and cells as flat.
const FINE: f64 = 0.25;
/// A part that rises over the surface by no more than this many tolerances runs along it.
const DIVERGENCE: f64 = 4.0;
/// Parts that run along the surface, at most, before they say nothing more.
const MOST_NEAR: usize = 1 << 14;

/// A meeting with a patch.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Contact {
    Point(Touch),
    /// The curve runs within the tolerance of the surface between two parameters.
    Stretch {
        t: (f64, f64),
    },
}

/// A single place where they meet, or the curve touches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Parameter of the curve.
    pub t: f64,
    /// Place on the patch.
    pub uv: DVec2,
    /// The point of the curve.
    pub p: DVec3,
    /// Its distance from the surface.
    pub gap: f64,
    /// Sine of the angle to the tangent plane.
    pub sine: f64,
}

/// The parts of a section that run along a cell.
#[derive(Clone, Copy, Debug)]
struct Near {
    section: usize,
    t: (f64, f64),
    uv: DVec2,
}

/// Parts that follow each other, with the place of each.
#[derive(Clone, Debug)]
struct Run {
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

struct Part<'a> {
    view: View<'a>,
    rates: Rates,
    section: usize,
}

struct Search<'a> {
    curve: &'a Curve,
    sheet: &'a mut Sheet,
    point: f64,
    /// Longer ones that stay within the tolerance lie on the surface.
    long: f64,
    found: Vec<(usize, Touch)>,
    near: Vec<Near>,
    looked_at: usize,
    exhausted: Option<DVec3>,
}

/// All meetings of a curve with a patch within a distance, unordered; the place where the search gave up when it did.
///
/// `long`: what stays within the distance for less is a touch.
pub(crate) fn contacts(curve: &Curve, sheet: &mut Sheet, point: f64, long: f64) -> Result<Vec<Contact>, DVec3> {
    let (found, near) = (Vec::new(), Vec::new());
    let mut search = Search { curve, sheet, point, long, found, near, looked_at: 0, exhausted: None };
    let count = curve.pieces().pieces.len();
    for root in search.sheet.roots.clone() {
        search.walk((0, 0, count), root);
    }
    if let Some(at) = search.exhausted {
        return Err(at);
    }
    Ok(search.settled())
}

impl Search<'_> {
    /// Pieces of the curve below a node of its tree against a cell.
    fn walk(&mut self, x: (usize, usize, usize), cell: usize) {
        let pieces = self.curve.pieces();
        if !pieces.bounds(x.0).touches(&self.sheet.cell(cell).bounds, self.point) {
            return;
        }
        if x.2 - x.1 == 1 {
            let piece = &pieces.pieces[x.1];
            let part = Part { view: pieces.view_of(self.curve, piece.section), rates: piece.rates, section: piece.section };
            self.pair(&part, &piece.node, cell);
            return;
        }
        let (left, right, middle) = children(x.0, x.1, x.2);
        self.walk((left, x.1, middle), cell);
        self.walk((right, middle, x.2), cell);
    }

    fn pair(&mut self, part: &Part, node: &Node, k: usize) {
        self.looked_at += 1;
        if self.exhausted.is_some() || self.sheet.is_outside(k) || apart(node, self.sheet.cell(k), self.point) {
            return;
        }
        if self.looked_at > MOST_PAIRS || self.near.len() > MOST_NEAR {
            self.exhausted = Some(node.middle);
            return;
        }
        let cell = self.sheet.cell(k);
        let fine = node.bulge <= FINE * self.point && cell.thick <= FINE * self.point;
        let crossing = crosses(node, cell, self.point);
        if crossing {
            let (uv, t) = (cell.middle(), 0.5 * (node.t.0 + node.t.1));
            if let Some(touch) = self.newton(&part.view, uv, t)
                && touch.gap <= self.point
                && within(node, cell, &touch)
            {
                self.found.push((part.section, touch));
                return;
            }
        }
        let length = node.p.0.distance(node.p.1);
        if !crossing && !fine && length > self.long && cell.reach() <= 4.0 * length && self.lies(&part.view, node, cell) {
            let uv = self.sheet.patch.foot(node.middle, cell.middle()).0;
            self.near.push(Near { section: part.section, t: node.t, uv });
            return;
        }
        if fine {
            let cell = self.sheet.cell(k);
            if let Some(touch) = self.lowest(&part.view, node, cell) {
                if crossing {
                    self.found.push((part.section, touch));
                } else {
                    self.near.push(Near { section: part.section, t: node.t, uv: touch.uv });
                }
            }
            // Of flat parts that cross nothing more is to be had; of those along each other only small ones say where.
            return;
        }
        let first = if length > 4.0 * cell.reach() {
            true
        } else if cell.reach() > 4.0 * length {
            false
        } else {
            node.bulge >= cell.thick
        };
        self.split(part, node, k, first);
    }

    fn split(&mut self, part: &Part, node: &Node, k: usize, first: bool) {
        if first && node.can_split() {
            for half in node.halves(&part.view, part.rates) {
                self.pair(part, &half, k);
            }
        } else if let Some((a, b)) = self.sheet.halves(k) {
            self.pair(part, node, a);
            self.pair(part, node, b);
        } else if node.can_split() {
            for half in node.halves(&part.view, part.rates) {
                self.pair(part, &half, k);
            }
        } else {
            self.near.push(Near { section: part.section, t: node.t, uv: self.sheet.cell(k).middle() });
        }
    }

    /// Newton's method for S(u, v) = C(t), held in the patch and the section.
    fn newton(&self, view: &View, uv: DVec2, t: f64) -> Option<Touch> {
        const STEPS: usize = 24;
        let (patch, (low, high)) = (&self.sheet.patch, view.section.range);
        let (mut uv, mut t) = (uv, t);
        for _ in 0..STEPS {
            let (s, c) = (patch.jet(uv), view.jet(t));
            let step = solved(s.du, s.dv, -c.d1, c.p - s.p)?;
            let next = patch.hold(uv + DVec2::new(step.x, step.y));
            let there = (t + step.z).clamp(low, high);
            let still = (next - uv).abs().max_element() <= EPSILON && (there - t).abs() <= EPSILON * (high - low);
            (uv, t) = (next, there);
            if still {
                break;
            }
        }
        Some(self.touch(view, t, uv))
    }

    fn touch(&self, view: &View, t: f64, uv: DVec2) -> Touch {
        let (c, s) = (view.jet(t), self.sheet.patch.jet(uv));
        let sine = s.du.cross(s.dv).normalize_or_zero().dot(c.d1.normalize_or_zero()).abs();
        Touch { t, uv, p: c.p, gap: c.p.distance(s.p), sine }
    }

    /// The least distance of a straight part and a flat cell, when it is within the tolerance.
    fn lowest(&self, view: &View, node: &Node, cell: &Cell) -> Option<Touch> {
        const ROUNDS: usize = 32;
        let mut uv = cell.middle();
        let chord = node.p.1 - node.p.0;
        let mut share = 0.5;
        let mut best: Option<Touch> = None;
        for _ in 0..ROUNDS {
            let t = node.t.0 + (node.t.1 - node.t.0) * share;
            let p = view.point(t);
            let (foot, _) = self.sheet.patch.foot(p, uv);
            uv = cell.hold(foot);
            let s = self.sheet.patch.jet(uv).p;
            let touch = self.touch(view, t, uv);
            let better = best.as_ref().is_none_or(|b| touch.gap < b.gap * (1.0 - NEWTON_STEP));
            if better {
                best = Some(touch);
            }
            // The foot of the surface's point on the chord.
            let next = ((s - node.p.0).dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
            if !next.is_finite() || !better && (next - share).abs() <= NEWTON_STEP {
                break;
            }
            share = next;
        }
        best.filter(|b| b.gap <= self.point)
    }

    /// What was found, with the parts that run along the surface worked out.
    fn settled(mut self) -> Vec<Contact> {
        let near = std::mem::take(&mut self.near);
        let mut out: Vec<Contact> = Vec::new();
        for run in runs(near) {
            self.resolve(&run, &mut out);
        }
        let pieces = self.curve.pieces();
        for (section, touch) in &self.found {
            let t = pieces.sections[*section].to_common(touch.t);
            out.push(Contact::Point(Touch { t, ..*touch }));
        }
        out
    }

    fn resolve(&mut self, run: &Run, out: &mut Vec<Contact>) {
        const SAMPLES: usize = 65;
        let pieces = self.curve.pieces();
        let (view, section) = (pieces.view_of(self.curve, run.section), pieces.sections[run.section]);
        let (t0, t1) = run.t;
        let at = |k: usize| if k + 1 == SAMPLES { t1 } else { t0 + (t1 - t0) * k as f64 / (SAMPLES - 1) as f64 };
        // From the place before, or, where that leads off (past a pole, over a fold), from that of the part.
        let mut uv = run.places[0].1;
        let mut samples: Vec<Sample> = Vec::with_capacity(SAMPLES);
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
        let stretch = longest(&samples, |s| s.gap <= self.point);
        if let Some((i, j)) = stretch {
            let ended = |s: &Sample| view.at_end(s.t) || self.at_border(s.uv);
            let length = (i..j).map(|k| samples[k].p.distance(samples[k + 1].p)).sum::<f64>();
            let close = longest(&samples, |s| s.gap <= 0.5 * self.point);
            let lies = close.is_some_and(|(i, j)| (i..j).map(|k| samples[k].p.distance(samples[k + 1].p)).sum::<f64>() > self.long);
            let whole = ended(&samples[i]) && ended(&samples[j]) && length > 4.0 * self.point && (j - i) > 2;
            if lies || whole && self.is_flat_run(&samples[i..=j]) {
                let (from, to) = (self.stretch_end(&view, &samples, i, true), self.stretch_end(&view, &samples, j, false));
                out.push(Contact::Stretch { t: (common(from), common(to)) });
                self.found.retain(|(s, touch)| *s != run.section || touch.t < from || touch.t > to);
                return;
            }
        }
        self.points(&view, run, &samples);
    }

    /// Where a stretch that lies on the surface ends beyond its last sample: there the gap begins to grow.
    fn stretch_end(&self, view: &View, samples: &[Sample], k: usize, first: bool) -> f64 {
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

    /// Whether a part that does not cross lies on the surface from end to end: every one of a row of places does.
    fn lies(&self, view: &View, node: &Node, cell: &Cell) -> bool {
        const PLACES: usize = 9;
        let allowed = 0.5 * self.point;
        let mut uv = self.sheet.patch.foot(node.middle, cell.middle());
        if uv.1 > allowed {
            return false;
        }
        (0..PLACES).all(|k| {
            let t = node.t.0 + (node.t.1 - node.t.0) * k as f64 / (PLACES - 1) as f64;
            let p = view.point(t);
            let again = self.sheet.patch.foot(p, uv.0);
            uv = if again.1 <= allowed { again } else { self.sheet.patch.foot(p, cell.middle()) };
            uv.1 <= allowed
        })
    }

    /// Whether the heights over a run have no crossing in them that stands out: it lies on the surface from end to end.
    fn is_flat_run(&self, samples: &[Sample]) -> bool {
        samples.iter().all(|s| s.height.abs() <= 0.5 * self.point)
    }

    /// Crossings and touches among samples.
    fn points(&mut self, view: &View, run: &Run, samples: &[Sample]) {
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
        let alone = |kept: &[(usize, Touch)], touch: &Touch| kept.iter().all(|(s, k)| *s != section || k.p.distance(touch.p) > self.long);
        for one in fresh {
            if alone(&self.found, &one.1) {
                self.found.push(one);
            }
        }
    }

    fn take(&mut self, view: &View, section: usize, s: Sample) {
        if s.gap <= self.point {
            let touch = self.touch(view, s.t, s.uv);
            self.found.push((section, touch));
        }
    }

    fn root(&self, view: &View, x: &Sample, y: &Sample) -> Sample {
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

    fn sample(&self, view: &View, t: f64, near: DVec2) -> Sample {
        let p = view.point(t);
        let (uv, gap) = self.sheet.patch.foot(p, near);
        let jet = self.sheet.patch.jet(uv);
        let height = (p - jet.p).dot(jet.du.cross(jet.dv).normalize_or_zero());
        Sample { t, uv, p, gap, height }
    }

    fn at_border(&self, uv: DVec2) -> bool {
        let patch = &self.sheet.patch;
        patch.lines().into_iter().any(|line| line.inside(patch, uv) <= NEWTON_STEP)
    }
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    uv: DVec2,
    p: DVec3,
    gap: f64,
    /// Over the tangent plane, with its sign.
    height: f64,
}

/// The longest row of samples that all fulfil something: its first and last.
fn longest(samples: &[Sample], holds: impl Fn(&Sample) -> bool) -> Option<(usize, usize)> {
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
fn runs(mut near: Vec<Near>) -> Vec<Run> {
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

/// Whether a part of a curve and a cell are further apart than a distance.
fn apart(node: &Node, cell: &Cell, point: f64) -> bool {
    if !node.bounds().touches(&cell.bounds, point) {
        return true;
    }
    if cell.normal == DVec3::ZERO {
        return false;
    }
    let (range, a, b) = (cell.along(cell.normal), node.p.0.dot(cell.normal), node.p.1.dot(cell.normal));
    let reach = node.bulge + point;
    a.min(b) - reach > range.high || a.max(b) + reach < range.low
}

/// Whether no tangent of the part lies in a tangent plane of the cell: they meet once at most.
fn crosses(node: &Node, cell: &Cell, point: f64) -> bool {
    let (sine, cosine) = node.cone;
    if cosine <= 0.0 {
        return false;
    }
    let rise = cell.normals.along(node.axis);
    let least = if rise.low > 0.0 { rise.low } else { -rise.high };
    // n·t ≥ cos φ · n·axis − sin φ · |n × axis| for tangents t within φ of the axis.
    let across = cell.normals.cross(&crate::base::range::Interval3::at(node.axis)).reach();
    // A part that hardly rises over its length runs along the surface.
    let rises = node.p.0.distance(node.p.1) * least > DIVERGENCE * point * cell.normals.reach();
    rises && least * cosine > across * sine
}

fn within(node: &Node, cell: &Cell, touch: &Touch) -> bool {
    let slack = (node.t.1 - node.t.0) / 64.0;
    node.t.0 - slack <= touch.t && touch.t <= node.t.1 + slack && cell.holds(touch.uv)
}
