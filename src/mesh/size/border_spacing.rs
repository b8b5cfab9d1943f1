//! Steps along borders and curves that vary: short where the faces beside them bend, near what is refined, and next to
//! shorter ones. Equal parts of ∫ ds / h.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::tolerance::{EPSILON, WHOLE_NUMBER};
use crate::base::{job, math, par};
use crate::mesh::border::counts::steps;
use crate::mesh::border::inside::trace;
use crate::mesh::border::layout::Layout;
use crate::mesh::deviation::{poles, triangle};
use crate::mesh::request::decider::Why;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::Method;
use crate::mesh::request::size_requests::SizeRequests;
use crate::mesh::request::sources::{Body, STEEP, Source, Sources};
use crate::mesh::size::gaps::{self, Beside, PLACES};
use crate::mesh::size::proximity::Narrow;
use crate::mesh::size::too_large;
use crate::surface::Surface;
use crate::surface::core::power_form::PowerForm;

/// Borders are fixed before triangulation; their steps are 10 % shorter than inner edges.
const ROOM: f64 = 0.9;
/// Distance of places along a segment over the length wanted there.
const APART: f64 = 0.5;
/// Halvings of a segment.
const MAX_DEPTH: u32 = 40;
/// Places of one segment.
const MOST_PLACES: usize = 1 << 20;
/// Rounds in which short steps are carried on to neighbours.
const ROUNDS: usize = 64;
/// What is lowered by less is not carried on.
const CHANGE_WORTH_CARRYING: f64 = 0.99;

/// Wanted lengths along a segment, from its start to its end, linear between places.
#[derive(Clone, Debug)]
pub struct BorderSpacing {
    /// Fractions of the length, 0 to 1.
    at: Vec<f64>,
    /// Model units.
    lengths: Vec<f64>,
    /// What decides at each place; empty until all is known.
    why: Vec<Why>,
}

impl BorderSpacing {
    fn even(length: f64) -> Self {
        Self { at: vec![0.0, 1.0], lengths: vec![length; 2], why: Vec::new() }
    }

    /// The largest lengths up to `most` that grow by no more than `slope` over the whole from what is said of places.
    fn about(places: &[(f64, f64)], most: f64, slope: f64) -> Self {
        let mut places = places.to_vec();
        places.extend([(0.0, most), (1.0, most)]);
        places.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        places.dedup_by_key(|p| p.0);
        for k in 1..places.len() {
            places[k].1 = places[k].1.min(places[k - 1].1 + slope * (places[k].0 - places[k - 1].0));
        }
        for k in (1..places.len()).rev() {
            places[k - 1].1 = places[k - 1].1.min(places[k].1 + slope * (places[k].0 - places[k - 1].0));
        }
        let mut made = Self { at: vec![places[0].0], lengths: vec![places[0].1], why: Vec::new() };
        for w in places.windows(2) {
            let [(f, a), (g, b)] = [w[0], w[1]];
            // Both slopes meet between the places, or reach the most before.
            let peak = 0.5 * (a + b + slope * (g - f)).min(2.0 * most);
            let ways = [(f + (peak - a) / slope, peak), (g - (peak - b) / slope, peak)];
            for (at, length) in ways.into_iter().chain([(g, b)]) {
                let (before, from) = (made.at[made.at.len() - 1], made.lengths[made.lengths.len() - 1]);
                if at > before && at <= g {
                    // Shares are added up from place to place: near enough to each other for lengths that grow.
                    let parts = (math::log(length / from).abs() / math::log(SIZE_RATIO_EQUAL)).ceil().clamp(1.0, MOST_PARTS) as usize;
                    for k in 1..=parts {
                        let now = if k == parts { length } else { from * math::exp(math::log(length / from) * k as f64 / parts as f64) };
                        let share = if k == parts { 1.0 } else { (now - from) / (length - from) };
                        made.at.push(before + (at - before) * share);
                        made.lengths.push(now);
                    }
                }
            }
        }
        made
    }

    /// Steps that grow geometrically, the last `bias` times the first: their size is linear in the length.
    pub fn of_count(length: f64, count: u32, bias: f64) -> Self {
        let first = if bias == 1.0 { 1.0 } else { math::log(bias) / (bias - 1.0) } * length / f64::from(count);
        Self { at: vec![0.0, 1.0], lengths: vec![first, first * bias], why: Vec::new() }
    }

    /// The shortest length.
    pub fn least(&self) -> f64 {
        self.lengths.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// What decides which share of the steps, in order.
    pub fn shares(&self) -> Vec<(Why, f64)> {
        let mut shares: std::collections::BTreeMap<Why, f64> = std::collections::BTreeMap::new();
        let mut total = 0.0;
        for k in 1..self.why.len() {
            let half = 0.5 * (self.at[k] - self.at[k - 1]);
            for end in [k - 1, k] {
                *shares.entry(self.why[end]).or_insert(0.0) += half / self.lengths[end];
                total += half / self.lengths[end];
            }
        }
        shares.into_iter().map(|(why, sum)| (why, sum / total)).collect()
    }

    /// The longest length.
    pub fn most(&self) -> f64 {
        self.lengths.iter().copied().fold(0.0, f64::max)
    }

    /// Places, fractions of the segment.
    pub fn places(&self) -> impl Iterator<Item = f64> + '_ {
        self.at.iter().copied()
    }

    /// The length at a fraction, model units.
    pub fn length_at(&self, f: f64) -> f64 {
        let k = self.at.partition_point(|a| *a <= f).clamp(1, self.at.len() - 1);
        let (a, b) = (self.at[k - 1], self.at[k]);
        let t = if b > a { ((f - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        self.lengths[k - 1] + (self.lengths[k] - self.lengths[k - 1]) * t
    }

    /// Number of steps over the whole for no step longer than wanted or than `size`.
    pub fn demand(&self, length: f64, size: f64, most: u32) -> u32 {
        let part = |k: usize| {
            let (a, b) = (self.lengths[k - 1].min(size), self.lengths[k].min(size));
            (self.at[k] - self.at[k - 1]) * 0.5 * (1.0 / a + 1.0 / b)
        };
        let sum: f64 = length * (1..self.at.len()).map(part).sum::<f64>();
        let n = (sum - WHOLE_NUMBER).ceil().clamp(1.0, f64::from(most)) as u32;
        // Even steps are what the size asks for at the least.
        n.max((length / size - WHOLE_NUMBER).ceil().clamp(1.0, f64::from(most)) as u32)
    }

    /// Fractions 0…1 of so many steps.
    pub fn steps(&self, count: u32) -> Vec<f64> {
        let mut run = vec![0.0];
        for k in 1..self.at.len() {
            let part = (self.at[k] - self.at[k - 1]) * 0.5 * (1.0 / self.lengths[k - 1] + 1.0 / self.lengths[k]);
            run.push(run[k - 1] + part);
        }
        let total = run[run.len() - 1];
        let mut at = steps(count, 1.0);
        let last = at.len() - 1;
        for f in &mut at[1..last] {
            let wanted = *f * total;
            let k = run.partition_point(|r| *r <= wanted).clamp(1, run.len() - 1);
            let share = (wanted - run[k - 1]) / (run[k] - run[k - 1]);
            *f = self.at[k - 1] + (self.at[k] - self.at[k - 1]) * share;
        }
        at
    }
}

/// Of each segment where its steps vary.
pub type BorderSpacings = Vec<Option<BorderSpacing>>;

/// What is known of the segments before their spacings.
pub struct SpacingInput<'a> {
    /// Lengths wanted at places.
    pub wanted: &'a SizeRequests,
    /// Chord error and angle.
    pub limits: &'a Limits,
    /// Size of each segment, model units.
    pub size: &'a [f64],
    /// Steps that are written out.
    pub written: &'a [Option<BorderSpacing>],
    /// Places where borders face each other.
    pub narrow: &'a [Narrow],
    /// What runs beside each face.
    pub rows: &'a [Vec<Beside>],
}

/// The spacings of segments: on free faces under limits, elsewhere where something is refined or neighbours are shorter.
/// Stretches of mapped faces follow the bends of free ones beside them and nothing else: their rows are even. The second
/// list has the spacings that those would have to follow, were they not. E217 where bends alone ask for too much.
pub fn along(input: &Input, layout: &Layout, ask: &SpacingInput) -> Result<(BorderSpacings, BorderSpacings)> {
    let n = layout.pieces.segments.len();
    let mut spacings: Vec<BorderSpacing> = ask.size.iter().map(|s| BorderSpacing::even(*s)).collect();
    bends(input, layout, ask, &mut spacings);
    too_large::refuse_bends(input, layout, &spacings, ask.size)?;
    let bent = spacings.clone();
    let mut even = vec![false; n];
    layout.faces.iter().filter(|f| !f.free).flat_map(|f| &f.sides).flat_map(|s| s.segments()).for_each(|k| even[k] = true);
    let least = if ask.wanted.written > 0.0 { ask.wanted.floor } else { input.tolerance.point };
    let walker = SpacingSolver { layout, ask, even: &even, least };
    let (gaps, required_on_mapped) = walker.narrowed(input.plan.slope());
    for (spacing, gap) in spacings.iter_mut().zip(&gaps) {
        *spacing = gap.as_ref().map_or_else(|| spacing.clone(), |gap| lower_of(spacing, gap));
    }
    if !ask.wanted.sources.is_empty() {
        let found = par::map(n, |k| walker.open(k).then(|| walker.lowered(k, &spacings[k], &ask.wanted.sources)));
        for (spacing, found) in spacings.iter_mut().zip(found) {
            *spacing = found.unwrap_or_else(|| spacing.clone());
        }
    }
    let bent = if ask.limits.chord.is_some() || ask.limits.angle.is_some() { bent } else { Vec::new() };
    walker.grade(&mut spacings);
    let required_on_mapped = walker.required_on_mapped(&spacings, required_on_mapped);
    let spacings = par::map(n, |k| {
        let spacing = &spacings[k];
        let taken = ask.written[k].is_none() && spacing.least() < ask.size[k] * (1.0 - EPSILON);
        taken.then(|| {
            let why =
                spacing.at.iter().zip(&spacing.lengths).map(|(f, l)| walker.why(k, (*f, *l), (bent.get(k), gaps[k].as_ref()))).collect();
            BorderSpacing { why, ..spacing.clone() }
        })
    });
    Ok((spacings, required_on_mapped))
}

/// Lowers spacings to what the bends of free faces ask for.
fn bends(input: &Input, layout: &Layout, ask: &SpacingInput, spacings: &mut [BorderSpacing]) {
    if ask.limits.chord.is_none() && ask.limits.angle.is_none() {
        return;
    }
    let found = par::map(layout.faces.len(), |f| of_face(input, layout, (f, &ask.rows[f]), ask.limits));
    for (segment, lengths) in found.into_iter().flatten() {
        let (spacing, size) = (&mut spacings[segment], ask.size[segment]);
        if spacing.at.len() == 2 {
            *spacing = BorderSpacing {
                at: (0..=PLACES).map(|k| k as f64 / PLACES as f64).collect(),
                lengths: vec![size; PLACES + 1],
                why: Vec::new(),
            };
        }
        spacing.lengths.iter_mut().zip(lengths).for_each(|(l, other)| *l = l.min(other.max(ask.wanted.written)));
    }
    let graded = graded(layout, spacings.len());
    for (segment, spacing) in spacings.iter_mut().enumerate().filter(|(k, p)| p.at.len() > 2 && graded[*k]) {
        level(&mut spacing.lengths, input.plan.slope() * layout.length(segment) / PLACES as f64);
    }
}

/// Stretches beside a free face on which lengths grow step by step.
fn graded(layout: &Layout, n: usize) -> Vec<bool> {
    let mut graded = vec![false; n];
    let grown = layout.faces.iter().filter(|f| f.free && !f.method.is_coarse());
    grown.flat_map(|f| f.sides.iter().flat_map(|s| s.segments()).chain(f.lines.iter().copied())).for_each(|k| graded[k] = true);
    graded
}

/// Lengths grow by no more than `step` from place to place.
fn level(lengths: &mut [f64], step: f64) {
    for k in 1..lengths.len() {
        lengths[k] = lengths[k].min(lengths[k - 1] + step);
    }
    for k in (1..lengths.len()).rev() {
        lengths[k - 1] = lengths[k - 1].min(lengths[k] + step);
    }
}

struct SpacingSolver<'a> {
    layout: &'a Layout,
    ask: &'a SpacingInput<'a>,
    even: &'a [bool],
    /// The least length that others grow from, model units.
    least: f64,
}

impl SpacingSolver<'_> {
    /// What decides the length at a place of a segment; `bent` is its spacing by bends alone, `gap` by borders that face it.
    fn why(&self, k: usize, (f, length): (f64, f64), (bent, gap): (Option<&BorderSpacing>, Option<&BorderSpacing>)) -> Why {
        let size = self.ask.size[k];
        let sources = &self.ask.wanted.sources;
        let about = |x: f64| x * CHANGE_WORTH_CARRYING <= length;
        match sources.who(self.layout.point(k, f), size) {
            _ if length >= size * CHANGE_WORTH_CARRYING => Why::Size,
            Some(least) if about(least.size) => Why::Refined(sources.items()[least.item as usize].tag as usize),
            _ if length <= self.ask.wanted.written => Why::Floor,
            _ if bent.is_some_and(|spacing| about(spacing.length_at(f))) => Why::Bends,
            _ if gap.is_some_and(|spacing| about(spacing.length_at(f))) => Why::Gap,
            _ => Why::Border,
        }
    }

    /// Spacings of segments by the borders that face them alone; longer by `slope` away from there. Those that rows of mapped
    /// faces do not follow are apart.
    fn narrowed(&self, slope: f64) -> (Vec<Option<BorderSpacing>>, Vec<Option<BorderSpacing>>) {
        let mut places: [Vec<Vec<(f64, f64)>>; 2] = [vec![Vec::new(); self.even.len()], vec![Vec::new(); self.even.len()]];
        for narrow in self.ask.narrow {
            if self.ask.written[narrow.segment].is_none() {
                let left = usize::from(self.even[narrow.segment] && !narrow.must);
                places[left][narrow.segment].push((narrow.f, narrow.size));
            }
        }
        let spacing = |(k, places): (usize, &Vec<(f64, f64)>)| {
            (!places.is_empty()).then(|| BorderSpacing::about(places, self.ask.size[k], slope * self.layout.length(k)))
        };
        let [taken, left] = places.map(|places| places.iter().enumerate().map(spacing).collect());
        (taken, left)
    }

    /// What segments of mapped faces would be like if they followed what is beside them on free faces; nothing of others.
    fn required_on_mapped(&self, spacings: &[BorderSpacing], narrow: Vec<Option<BorderSpacing>>) -> Vec<Option<BorderSpacing>> {
        let mut found: Vec<Option<BorderSpacing>> = narrow;
        for face in self.layout.faces.iter().filter(|face| face.free && !face.method.is_coarse()) {
            let mut all: Vec<usize> = face.segments().collect();
            all.sort_unstable();
            all.dedup();
            let even: Vec<usize> = all.iter().copied().filter(|k| self.even[*k] && self.ask.written[*k].is_none()).collect();
            if even.is_empty() {
                continue;
            }
            let cap = all.iter().map(|k| self.ask.size[*k]).fold(0.0, f64::max);
            let items: Vec<Source> = all.iter().flat_map(|k| self.steps_of(*k, &spacings[*k], cap)).collect();
            let sources = Sources::new(items, self.ask.wanted.sources.slope());
            for k in even {
                let spacing = self.lowered(k, &spacings[k], &sources);
                found[k] = Some(found[k].as_ref().map_or_else(|| spacing.clone(), |other| lower_of(other, &spacing)));
            }
        }
        found
    }

    /// Whether the steps of a segment may vary.
    fn open(&self, k: usize) -> bool {
        !self.even[k] && self.ask.written[k].is_none()
    }

    /// A spacing with what sources ask for as well; places are added where lengths change.
    fn lowered(&self, k: usize, spacing: &BorderSpacing, sources: &Sources) -> BorderSpacing {
        let cap = self.ask.size[k];
        if sources.least() >= spacing.lengths.iter().copied().fold(0.0, f64::max) {
            return spacing.clone();
        }
        let mut sampler = Sampler {
            walker: self,
            k,
            spacing,
            sources,
            cap,
            made: BorderSpacing { at: Vec::new(), lengths: Vec::new(), why: Vec::new() },
        };
        let mut last = sampler.place(0.0);
        sampler.take(&last);
        for next in &spacing.at[1..] {
            let next = sampler.place(*next);
            sampler.between(&last, &next, MAX_DEPTH);
            sampler.take(&next);
            last = next;
        }
        sampler.made
    }

    /// Carries short steps on to the neighbours across free faces, and from curve to curve outside faces.
    fn grade(&self, spacings: &mut [BorderSpacing]) {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut on_face = vec![false; spacings.len()];
        for face in &self.layout.faces {
            let mut all: Vec<usize> = face.sides.iter().flat_map(|s| s.segments()).chain(face.lines.iter().copied()).collect();
            all.iter().for_each(|k| on_face[*k] = true);
            all.sort_unstable();
            all.dedup();
            groups.push(if face.free && !face.method.is_coarse() { all } else { Vec::new() });
        }
        groups.push((0..spacings.len()).filter(|k| !on_face[*k]).collect());
        let mut of_segment: Vec<Vec<usize>> = vec![Vec::new(); spacings.len()];
        groups.iter().enumerate().for_each(|(g, all)| all.iter().for_each(|k| of_segment[*k].push(g)));
        let mut open: BTreeSet<usize> = (0..groups.len()).collect();
        for _ in 0..ROUNDS {
            let now: Vec<usize> = std::mem::take(&mut open).into_iter().collect();
            if now.is_empty() {
                return;
            }
            let found = par::map(now.len(), |n| self.within(&groups[now[n]], spacings));
            for (k, spacing) in found.into_iter().flatten() {
                if spacing.at.iter().zip(&spacing.lengths).any(|(f, l)| *l < CHANGE_WORTH_CARRYING * spacings[k].length_at(*f)) {
                    // Two faces may both have lowered it.
                    spacings[k] = lower_of(&spacings[k], &spacing);
                    open.extend(&of_segment[k]);
                }
            }
        }
    }

    /// Lowered spacings of segments round one face.
    fn within(&self, all: &[usize], spacings: &[BorderSpacing]) -> Vec<(usize, BorderSpacing)> {
        let cap = all.iter().map(|k| self.ask.size[*k]).fold(0.0, f64::max);
        let items: Vec<Source> = all.iter().flat_map(|k| self.steps_of(*k, &spacings[*k], cap)).collect();
        if items.is_empty() {
            return Vec::new();
        }
        let sources = Sources::new(items, self.ask.wanted.sources.slope());
        let open = all.iter().filter(|k| self.open(**k) && self.ask.size[**k] > sources.least());
        open.map(|k| (*k, self.lowered(*k, &spacings[*k], &sources))).collect()
    }

    /// Pieces of a segment whose steps are shorter than lengths may be beside them.
    fn steps_of(&self, k: usize, spacing: &BorderSpacing, cap: f64) -> Vec<Source> {
        let spacing = self.ask.written[k].as_ref().unwrap_or(spacing);
        let length = self.layout.length(k);
        let floor = self.ask.wanted.floor;
        let least = cap / (1.0 + self.ask.wanted.sources.slope());
        if spacing.least().min(length).max(floor) >= least {
            return Vec::new();
        }
        let place = |f: f64| (f, self.layout.point(k, f), spacing.length_at(f).min(length));
        let mut found = Vec::new();
        for w in spacing.at.windows(2) {
            let mut open = vec![(place(w[0]), place(w[1]), MAX_DEPTH)];
            while let Some((a, b, left)) = open.pop() {
                job::poll();
                let middle = place(0.5 * (a.0 + b.0));
                let size = a.2.min(b.2);
                let straight = [(0.5, middle.1), (0.25, self.layout.point(k, 0.75 * a.0 + 0.25 * b.0))];
                let off = straight.iter().map(|(t, p)| p.distance(a.1.lerp(b.1, *t))).fold(0.0, f64::max);
                if left > 0 && (off > APART * size || a.2.max(b.2) > SIZE_RATIO_EQUAL * size) && a.1.distance(b.1) + off > APART * size {
                    open.extend([(a, middle, left - 1), (middle, b, left - 1)]);
                    continue;
                }
                // The larger of both, so that no segment lowers itself.
                let raw = a.2.max(b.2);
                let size = raw.max(floor);
                if size < least {
                    let source = Source { body: Body::Segment(a.1, b.1), radius: 0.0, size, steep: 1.0, tag: 0 };
                    found.push(source);
                    // From what is below the floor lengths grow fast up to it.
                    let raw = raw.max(self.least);
                    if raw < floor {
                        found.push(Source { size: raw, steep: STEEP, ..source });
                    }
                }
            }
        }
        found
    }
}

/// Places put between two of a spacing at most.
const MOST_PARTS: f64 = 256.0;
/// Ratio of lengths that count as one.
const SIZE_RATIO_EQUAL: f64 = 1.15;

/// The lower of two spacings at the places of both.
fn lower_of(a: &BorderSpacing, b: &BorderSpacing) -> BorderSpacing {
    let mut at: Vec<f64> = a.at.iter().chain(&b.at).copied().collect();
    at.sort_by(f64::total_cmp);
    at.dedup();
    let lengths = at.iter().map(|f| a.length_at(*f).min(b.length_at(*f))).collect();
    BorderSpacing { at, lengths, why: Vec::new() }
}

/// A place on a segment.
struct Spot {
    f: f64,
    p: DVec3,
    length: f64,
    /// What the segment wants there before the sources.
    own: f64,
    /// The source that decides, whatever the size of the segment.
    item: Option<u32>,
}

struct Sampler<'a> {
    walker: &'a SpacingSolver<'a>,
    k: usize,
    spacing: &'a BorderSpacing,
    sources: &'a Sources,
    cap: f64,
    made: BorderSpacing,
}

impl Sampler<'_> {
    fn place(&self, f: f64) -> Spot {
        let p = self.walker.layout.point(self.k, f);
        let own = self.spacing.length_at(f).min(self.cap);
        let found = self.sources.who(p, own);
        let length = found.map_or(own, |l| l.size);
        Spot { f, p, length, own, item: found.map(|l| l.item) }
    }

    fn take(&mut self, spot: &Spot) {
        self.made.at.push(spot.f);
        self.made.lengths.push(spot.length);
    }

    /// Halves the way between two places until lengths can hardly change on it.
    fn between(&mut self, a: &Spot, b: &Spot, left: u32) {
        let gap = (b.f - a.f) * self.walker.layout.length(self.k);
        // No source asks for less than is there already; what sources ask for at both ends says nothing of the way between.
        let settled = a.own.max(b.own) <= self.sources.least() * (1.0 + WHOLE_NUMBER);
        if left == 0 || settled || gap <= APART * a.length.min(b.length) || self.made.at.len() >= MOST_PLACES {
            return;
        }
        if a.item == b.item && a.item.is_some_and(|item| self.sources.holds(item, (a.p, b.p), gap)) {
            return;
        }
        let middle = self.place(0.5 * (a.f + b.f));
        // No source reaches the way at all.
        if self.sources.who(middle.p, self.cap + self.sources.steepest() * 0.5 * gap).is_none() {
            return;
        }
        self.between(a, &middle, left - 1);
        self.take(&middle);
        self.between(&middle, b, left - 1);
    }
}

/// Wanted lengths along the segments of one face.
fn of_face(input: &Input, layout: &Layout, (f, rows): (usize, &[Beside]), limits: &Limits) -> Vec<(usize, Vec<f64>)> {
    let own = &layout.faces[f];
    let surface = &input.model.surfaces[own.surface.index()].surface;
    if !own.free || surface.is_flat() {
        return Vec::new();
    }
    let quick = surface.power_form();
    let ready = (surface, quick.as_ref());
    let wanted = |row: &Beside, apart: f64| {
        if own.method.is_coarse() {
            spared(ready, row, apart, (own.size.0, limits, own.method == Method::Display))
        } else {
            by_bends(ready, row, apart, (own.size.0, limits))
        }
    };
    let mut found = Vec::new();
    let apart = |segment: usize| layout.length(segment) / PLACES as f64;
    // Cells halve by twos and fit best where a curve has one length; `display` joins them again.
    let by_cells = own.method == Method::Isoline;
    let both = |row: &Beside, apart: f64| {
        let curve = |i: usize| if by_cells { f64::INFINITY } else { by_curve(&row.points, i, limits) };
        wanted(row, apart).into_iter().enumerate().map(|(i, length)| length.min(curve(i))).collect::<Vec<_>>()
    };
    for (u, row) in own.sides.iter().flat_map(|side| &side.uses).zip(rows) {
        found.push((u.segment, both(row, apart(u.segment))));
    }
    for line in &own.lines {
        let points: Vec<DVec3> = (0..=PLACES).map(|k| layout.point(*line, k as f64 / PLACES as f64)).collect();
        let places = trace(surface, &input.model.patches[own.patch.index()], &points);
        let row = Beside::new(surface, (places, points), input.tolerance.point * gaps::SLIGHT);
        found.push((*line, both(&row, apart(*line))));
    }
    found
}

/// The length at a place of a row of points for which a step keeps the limits as a piece of the curve, by the circle through it and
/// its neighbours: what is left to find out by [`super::edges::least_steps`] for all steps together is next to nothing.
fn by_curve(points: &[DVec3], i: usize, limits: &Limits) -> f64 {
    let i = i.clamp(1, points.len() - 2);
    let (a, b) = (points[i] - points[i - 1], points[i + 1] - points[i]);
    let bend = 2.0 * a.cross(b).length() / (a.length() * b.length() * (a + b).length());
    let by_chord = limits.chord.map_or(f64::INFINITY, |limit| (8.0 * limit / bend).sqrt());
    let by_angle = limits.angle.map_or(f64::INFINITY, |limit| limit / bend);
    by_chord.min(by_angle)
}

/// Lengths along a row of places `apart` so that triangles on both sides of it keep the limits, the chord error less how far
/// `off` the surface the row is within a step.
fn by_bends(surfaces: (&Surface, Option<&PowerForm>), row: &Beside, apart: f64, (size, limits): (f64, &Limits)) -> Vec<f64> {
    let (surface, last) = (surfaces.0, row.places.len() - 1);
    let step = |i: usize| DVec2::from(row.places[(i + 1).min(last)]) - DVec2::from(row.places[(i + 1).min(last) - 1]);
    let tangents = |at: DVec2| surface.tangents_by(surfaces.1, at.x, at.y);
    let length = |i: usize, off: f64| {
        let chord = limits.chord.map(|limit| gaps::left(limit, off));
        let wanted = |at: DVec2| {
            let jet = surface.jet_by(surfaces.1, at.x, at.y);
            let plain = triangle::wanted(&jet, chord, limits.angle).min(size / FILLED);
            let along = jet.du * step(i).x + jet.dv * step(i).y;
            let sure = |limit| triangle::surely(surfaces, (at, &jet), along, (limit, plain));
            ROOM * FILLED * chord.map_or(plain, sure)
        };
        let at = DVec2::from(row.places[i]);
        poles::at_tip(surface, &tangents, at, &wanted).unwrap_or_else(|| wanted(at))
    };
    let within = |i: usize, h: f64| {
        let reach = (h / apart).ceil().min(last as f64) as usize;
        row.off[i.saturating_sub(reach)..=(i + reach).min(last)].iter().copied().fold(0.0, f64::max)
    };
    let one = |i: usize| {
        let own = length(i, row.off[i]);
        let worst = within(i, own);
        if worst > row.off[i] { length(i, worst) } else { own }
    };
    by_few(row, apart, limits, &one)
}

/// Places of a row that lengths may be linear over, and the share of a length that these may be apart: what makes elements at a place smaller,
/// as a seam, does so as far off as they are long.
const LINEAR: usize = 16;
const NEAR: f64 = 0.5;
/// Share of a length by which others may be off it and still are linear.
const EVEN: f64 = 0.02;
/// Ratio of the lengths at both ends of what may be linear.
const SLOPED: f64 = 1.1;

/// Lengths at all places of a row, `apart` from each other, by as few of them as tell: where one between two that are near each other is their mean,
/// and borders run alike beside the surface, lengths are linear.
fn by_few(row: &Beside, apart: f64, limits: &Limits, length: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let last = row.places.len() - 1;
    let room = limits.chord.map_or(f64::INFINITY, |limit| EVEN * limit);
    let mut found = vec![0.0; last + 1];
    (found[0], found[last]) = (length(0), length(last));
    let mut open: Vec<(usize, usize)> = vec![(0, last)];
    while let Some((a, b)) = open.pop() {
        let middle = a.midpoint(b);
        if middle == a {
            continue;
        }
        let own = length(middle);
        found[middle] = own;
        let (most, least) = (found[a].max(found[b]), found[a].min(found[b]));
        let off = |pick: fn(f64, f64) -> f64| row.off[a..=b].iter().copied().reduce(pick).unwrap_or(0.0);
        let even = most <= SLOPED * least && (own - 0.5 * (most + least)).abs() <= EVEN * own && off(f64::max) - off(f64::min) <= room;
        if b - a > LINEAR || (b - a) as f64 * apart > NEAR * least || !even {
            open.extend([(a, middle), (middle, b)]);
            continue;
        }
        for (from, to) in [(a, middle), (middle, b)] {
            let (start, end) = (found[from], found[to]);
            (from + 1..to).for_each(|k| found[k] = start + (end - start) * (k - from) as f64 / (to - from) as f64);
        }
    }
    found
}

/// The same where triangles may be long: an edge is no longer than what any place on it wants.
fn spared(ready: (&Surface, Option<&PowerForm>), row: &Beside, apart: f64, (size, limits, leans): (f64, &Limits, bool)) -> Vec<f64> {
    let (surface, last) = (ready.0, row.places.len() - 1);
    let wide = surface.hull().diagonal().min(size);
    let step = |i: usize| DVec2::from(row.places[(i + 1).min(last)]) - DVec2::from(row.places[(i + 1).min(last) - 1]);
    let length = |i: usize| {
        let at = row.places[i];
        let jet = surface.jet_by(ready.1, at.0, at.1);
        // At a pole there is nothing across, and what is beside it decides.
        if poles::is_pole(&|_| [jet.p, jet.du, jet.dv], at.into()) {
            return size;
        }
        let along = jet.du * step(i).x + jet.dv * step(i).y;
        let chord = limits.chord.map(|limit| gaps::left(limit, row.off[i]));
        triangle::wanted_along(ready, (DVec2::from(at), &jet), along, (chord, limits.angle), (wide, leans)).min(size)
    };
    let lengths: Vec<f64> = (0..=last).map(length).collect();
    // An edge about a place reaches half its length to both sides.
    let reached = |i: usize| {
        let shorter = |(j, other): (usize, &f64)| other.max(2.0 * apart * i.abs_diff(j) as f64);
        lengths.iter().enumerate().map(shorter).fold(lengths[i], f64::min)
    };
    (0..=last).map(reached).collect()
}

/// Spacing of the lattice as a share of the size, so that hardly an edge comes out longer than the size allows.
pub const SPACING: f64 = 0.8;

/// First lengths over those that bends ask for: triangles are not all equilateral.
pub const FILLED: f64 = 0.83;
