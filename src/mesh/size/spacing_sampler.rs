//! A spacing lowered to what sources of sizes want along a segment: sampled until lengths can hardly change between places.

use glam::DVec3;

use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::layout::Layout;
use crate::mesh::request::sources::Sources;
use crate::mesh::size::border_spacing::{BorderSpacing, SPACING_SETTINGS};

/// The spacing of a segment lowered to the lengths that sources want, `cap` at most; places are added where lengths change.
pub(super) fn lowered(layout: &Layout, segment: usize, spacing: &BorderSpacing, sources: &Sources, cap: f64) -> BorderSpacing {
    if sources.least() >= spacing.lengths.iter().copied().fold(0.0, f64::max) {
        return spacing.clone();
    }
    let mut sampler =
        Sampler { layout, segment, spacing, sources, cap, lowered: BorderSpacing { at: Vec::new(), lengths: Vec::new(), why: Vec::new() } };
    let mut last = sampler.place(0.0);
    sampler.push(&last);
    for next in &spacing.at[1..] {
        let next = sampler.place(*next);
        sampler.between(&last, &next, SPACING_SETTINGS.max_halvings);
        sampler.push(&next);
        last = next;
    }
    sampler.lowered
}

/// A place on a segment.
struct SpacingSample {
    f: f64,
    p: DVec3,
    length: f64,
    /// The length there before the sources.
    own: f64,
    /// The source that decides, whatever the size of the segment.
    item: Option<u32>,
}

/// Samples the lengths that sources want along a segment.
struct Sampler<'a> {
    layout: &'a Layout,
    segment: usize,
    spacing: &'a BorderSpacing,
    sources: &'a Sources,
    cap: f64,
    lowered: BorderSpacing,
}

impl Sampler<'_> {
    fn place(&self, f: f64) -> SpacingSample {
        let p = self.layout.point(self.segment, f);
        let own = self.spacing.length_at(f).min(self.cap);
        let found = self.sources.who(p, own);
        let length = found.map_or(own, |l| l.size);
        SpacingSample { f, p, length, own, item: found.map(|l| l.item) }
    }

    fn push(&mut self, spot: &SpacingSample) {
        self.lowered.at.push(spot.f);
        self.lowered.lengths.push(spot.length);
    }

    /// Halves the way between two places until lengths can hardly change on it.
    fn between(&mut self, a: &SpacingSample, b: &SpacingSample, left: u32) {
        let gap = (b.f - a.f) * self.layout.length(self.segment);
        // No source wants less than is there already; what sources want at both ends does not bound what they want between.
        let settled = a.own.max(b.own) <= self.sources.least() * (1.0 + WHOLE_NUMBER);
        if left == 0
            || settled
            || gap <= SPACING_SETTINGS.max_place_distance * a.length.min(b.length)
            || self.lowered.at.len() >= SPACING_SETTINGS.max_places
        {
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
        self.push(&middle);
        self.between(&middle, b, left - 1);
    }
}
