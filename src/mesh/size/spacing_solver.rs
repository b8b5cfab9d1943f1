//! The spacings of all segments: what bends, facing borders, clauses and neighbours make of the sizes.

use std::collections::BTreeSet;

use crate::base::fault::Result;
use crate::base::tolerance::EPSILON;
use crate::base::{job, par};
use crate::mesh::border::layout::Layout;
use crate::mesh::request::decider::Why;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::size_requests::SizeRequests;
use crate::mesh::request::sources::{Body, STEEP, Source, Sources};
use crate::mesh::size::bend_spacing::lower_to_bends;
use crate::mesh::size::border_spacing::{BorderSpacing, BorderSpacings, SPACING_SETTINGS};
use crate::mesh::size::gaps::SegmentBeside;
use crate::mesh::size::proximity::Narrow;
use crate::mesh::size::row_spacing::{UnevenRows, lower_to_rows};
use crate::mesh::size::spacing_sampler::lowered;
use crate::mesh::size::too_large;

/// What is known of the segments before their spacings.
pub(super) struct SpacingInput<'a> {
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
    pub rows: &'a [Vec<SegmentBeside>],
}

/// The spacings of all segments.
pub(super) struct Spacings {
    /// Of segments whose steps vary.
    pub of_segments: BorderSpacings,
    /// Those that segments of mapped faces would have to follow for the free faces beside them.
    pub required_on_mapped: BorderSpacings,
    /// Numbers of rows of maps whose rows are uneven.
    pub rows: UnevenRows,
}

/// The spacings of segments whose steps vary: under limits, and where something is refined or neighbours of free faces are shorter.
/// Segments of mapped faces follow the bends of free ones beside them, and those of their own where even rows would have to be many more.
/// E217 where bends alone demand too many steps.
pub(super) fn spacings(input: &Input, layout: &Layout, given: &SpacingInput) -> Result<Spacings> {
    let n = layout.pieces.segments.len();
    let mut spacings: Vec<BorderSpacing> = given.size.iter().map(|s| BorderSpacing::even(*s)).collect();
    lower_to_bends(input, layout, given, &mut spacings);
    let rows = lower_to_rows(input, layout, given, &mut spacings);
    too_large::refuse_bends(input, layout, &spacings, given.size)?;
    let bent = spacings.clone();
    let mut even = vec![false; n];
    layout.faces.iter().filter(|f| !f.free).flat_map(|f| &f.sides).flat_map(|s| s.segments()).for_each(|k| even[k] = true);
    let least = if given.wanted.written > 0.0 { given.wanted.floor } else { input.tolerance.point };
    let solver = SpacingSolver { layout, given, even: &even, least };
    let (gaps, required_on_mapped) = solver.narrowed(input.plan.slope());
    for (spacing, gap) in spacings.iter_mut().zip(&gaps) {
        *spacing = gap.as_ref().map_or_else(|| spacing.clone(), |gap| spacing.lower(gap));
    }
    if !given.wanted.sources.is_empty() {
        let found = par::map(n, |k| solver.open(k).then(|| lowered(layout, k, &spacings[k], &given.wanted.sources, given.size[k])));
        for (spacing, found) in spacings.iter_mut().zip(found) {
            *spacing = found.unwrap_or_else(|| spacing.clone());
        }
    }
    let bent = if given.limits.chord.is_some() || given.limits.angle.is_some() { bent } else { Vec::new() };
    solver.grade(&mut spacings);
    let required_on_mapped = solver.required_on_mapped(&spacings, required_on_mapped);
    let spacings = par::map(n, |k| {
        let spacing = &spacings[k];
        let varies = given.written[k].is_none() && spacing.least() < given.size[k] * (1.0 - EPSILON);
        varies.then(|| {
            let why = spacing.at.iter().zip(&spacing.lengths).map(|(f, l)| solver.why(k, *f, *l, bent.get(k), gaps[k].as_ref())).collect();
            BorderSpacing { why, ..spacing.clone() }
        })
    });
    Ok(Spacings { of_segments: spacings, required_on_mapped, rows })
}

/// The segments of a layout with what is given of them.
struct SpacingSolver<'a> {
    layout: &'a Layout,
    given: &'a SpacingInput<'a>,
    even: &'a [bool],
    /// The least length that others grow from, model units.
    least: f64,
}

impl SpacingSolver<'_> {
    /// What decides the length at a place of a segment; `bent` is its spacing by bends alone, `gap` by borders that face it.
    fn why(&self, k: usize, f: f64, length: f64, bent: Option<&BorderSpacing>, gap: Option<&BorderSpacing>) -> Why {
        let size = self.given.size[k];
        let sources = &self.given.wanted.sources;
        let about = |x: f64| x * SPACING_SETTINGS.min_change <= length;
        match sources.who(self.layout.point(k, f), size) {
            _ if length >= size * SPACING_SETTINGS.min_change => Why::Size,
            Some(least) if about(least.size) => Why::Refined(sources.items()[least.item as usize].tag as usize),
            _ if length <= self.given.wanted.written => Why::Floor,
            _ if bent.is_some_and(|spacing| about(spacing.length_at(f))) => Why::Bends,
            _ if gap.is_some_and(|spacing| about(spacing.length_at(f))) => Why::Gap,
            _ => Why::Border,
        }
    }

    /// Spacings of segments by the borders that face them alone, growing by `slope` away from there; those that rows of mapped
    /// faces do not follow are the second list.
    fn narrowed(&self, slope: f64) -> (Vec<Option<BorderSpacing>>, Vec<Option<BorderSpacing>>) {
        let mut places: [Vec<Vec<(f64, f64)>>; 2] = [vec![Vec::new(); self.even.len()], vec![Vec::new(); self.even.len()]];
        for narrow in self.given.narrow {
            if self.given.written[narrow.segment].is_none() {
                let left = usize::from(self.even[narrow.segment] && !narrow.crossing);
                places[left][narrow.segment].push((narrow.f, narrow.size));
            }
        }
        let spacing = |(k, places): (usize, &Vec<(f64, f64)>)| {
            (!places.is_empty()).then(|| BorderSpacing::about(places, self.given.size[k], slope * self.layout.length(k)))
        };
        let [followed, left] = places.map(|places| places.iter().enumerate().map(spacing).collect());
        (followed, left)
    }

    /// Spacings that segments of mapped faces would have if they followed free faces beside them; `None` for others.
    fn required_on_mapped(&self, spacings: &[BorderSpacing], narrow: Vec<Option<BorderSpacing>>) -> Vec<Option<BorderSpacing>> {
        let mut found: Vec<Option<BorderSpacing>> = narrow;
        for face in self.layout.faces.iter().filter(|face| face.free && !face.method.is_coarse()) {
            let mut all: Vec<usize> = face.segments().collect();
            all.sort_unstable();
            all.dedup();
            let even: Vec<usize> = all.iter().copied().filter(|k| self.even[*k] && self.given.written[*k].is_none()).collect();
            if even.is_empty() {
                continue;
            }
            let cap = all.iter().map(|k| self.given.size[*k]).fold(0.0, f64::max);
            let items: Vec<Source> = all.iter().flat_map(|k| self.steps_of(*k, &spacings[*k], cap)).collect();
            let sources = Sources::new(items, self.given.wanted.sources.slope());
            for k in even {
                let spacing = lowered(self.layout, k, &spacings[k], &sources, self.given.size[k]);
                found[k] = Some(found[k].as_ref().map_or_else(|| spacing.clone(), |other| other.lower(&spacing)));
            }
        }
        found
    }

    /// Whether the steps of a segment may vary.
    fn open(&self, k: usize) -> bool {
        !self.even[k] && self.given.written[k].is_none()
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
        for _ in 0..SPACING_SETTINGS.max_rounds {
            let now: Vec<usize> = std::mem::take(&mut open).into_iter().collect();
            if now.is_empty() {
                return;
            }
            let found = par::map(now.len(), |n| self.within(&groups[now[n]], spacings));
            for (k, spacing) in found.into_iter().flatten() {
                if spacing.at.iter().zip(&spacing.lengths).any(|(f, l)| *l < SPACING_SETTINGS.min_change * spacings[k].length_at(*f)) {
                    // Two faces may both have lowered it.
                    spacings[k] = spacings[k].lower(&spacing);
                    open.extend(&of_segment[k]);
                }
            }
        }
    }

    /// Lowered spacings of segments round one face.
    fn within(&self, all: &[usize], spacings: &[BorderSpacing]) -> Vec<(usize, BorderSpacing)> {
        let cap = all.iter().map(|k| self.given.size[*k]).fold(0.0, f64::max);
        let items: Vec<Source> = all.iter().flat_map(|k| self.steps_of(*k, &spacings[*k], cap)).collect();
        if items.is_empty() {
            return Vec::new();
        }
        let sources = Sources::new(items, self.given.wanted.sources.slope());
        let open = all.iter().filter(|k| self.open(**k) && self.given.size[**k] > sources.least());
        open.map(|k| (*k, lowered(self.layout, *k, &spacings[*k], &sources, self.given.size[*k]))).collect()
    }

    /// Pieces of a segment whose steps are shorter than lengths may be beside them.
    fn steps_of(&self, k: usize, spacing: &BorderSpacing, cap: f64) -> Vec<Source> {
        let spacing = self.given.written[k].as_ref().unwrap_or(spacing);
        let length = self.layout.length(k);
        let floor = self.given.wanted.floor;
        let least = cap / (1.0 + self.given.wanted.sources.slope());
        if spacing.least().min(length).max(floor) >= least {
            return Vec::new();
        }
        let place = |f: f64| (f, self.layout.point(k, f), spacing.length_at(f).min(length));
        let mut found = Vec::new();
        for w in spacing.at.windows(2) {
            let mut open = vec![(place(w[0]), place(w[1]), SPACING_SETTINGS.max_halvings)];
            while let Some((a, b, left)) = open.pop() {
                job::poll();
                let middle = place(0.5 * (a.0 + b.0));
                let size = a.2.min(b.2);
                let straight = [(0.5, middle.1), (0.25, self.layout.point(k, 0.75 * a.0 + 0.25 * b.0))];
                let off = straight.iter().map(|(t, p)| p.distance(a.1.lerp(b.1, *t))).fold(0.0, f64::max);
                if left > 0
                    && (off > SPACING_SETTINGS.max_place_distance * size || a.2.max(b.2) > SPACING_SETTINGS.equal_ratio * size)
                    && a.1.distance(b.1) + off > SPACING_SETTINGS.max_place_distance * size
                {
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
