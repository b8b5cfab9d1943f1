//! The length wanted at each place of a border or curve whose steps vary, and its division into equal parts of ∫ ds / h.

use std::collections::BTreeMap;

use crate::base::math;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::counts::steps;
use crate::mesh::request::decider::Why;

/// What steers the spacing of borders.
pub(super) struct SpacingSettings {
    /// Lengths on borders over those inside that the bends of a face allow: borders cannot be divided once triangles stand on them.
    pub border_ratio: f64,
    /// Largest distance of places along a segment over the length wanted there.
    pub max_place_distance: f64,
    /// Halvings of a segment at most.
    pub max_halvings: u32,
    /// Places of one segment at most.
    pub max_places: usize,
    /// Places put between two of a spacing at most.
    pub max_parts: f64,
    /// Ratio up to which two lengths count as one.
    pub equal_ratio: f64,
    /// Rounds in which short steps are carried on to neighbours, at most.
    pub max_rounds: usize,
    /// A length above this share of the one before is not carried on.
    pub min_change: f64,
    /// Places of a row over which lengths may be interpolated, at most.
    pub max_linear_places: usize,
    /// Largest distance of the ends of such an interval over the length there: what makes elements smaller at a place, as a seam does,
    /// acts as far off as they are long.
    pub max_linear_distance: f64,
    /// Largest ratio of the lengths at its ends.
    pub max_linear_ratio: f64,
    /// Largest error of the interpolated length over the true one.
    pub max_linear_error: f64,
}

pub(super) const SPACING_SETTINGS: SpacingSettings = SpacingSettings {
    border_ratio: 0.9,
    max_place_distance: 0.5,
    max_halvings: 40,
    max_places: 1 << 20,
    max_parts: 256.0,
    equal_ratio: 1.15,
    max_rounds: 64,
    min_change: 0.99,
    max_linear_places: 16,
    max_linear_distance: 0.5,
    max_linear_ratio: 1.1,
    max_linear_error: 0.02,
};

/// Room that a row has above the size (language reference, mesh settings).
pub const SIZE_ROOM: f64 = 1.05;

/// Spacing of the lattice as a share of the size, so that hardly an edge comes out longer than the size allows.
pub const SPACING: f64 = 0.8;

/// The same of squares on bent faces, in quadtrees, and of quads and triangles.
pub const SQUARE_SPACING: f64 = 0.85;

/// The same of a lattice of squares on a plane face, which is stretched between its holes: with 0.85 one side in fifty was opened for a further quad,
/// which has irregular nodes at its ends, and most faces were made twice.
pub const PLANE_SQUARE_SPACING: f64 = 0.75;

/// First lengths over those that bends allow: triangles are not all equilateral. With more so many break the limit that dividing and
/// repairing them costs more time than it saves triangles, with less there are more triangles (`docs/notes/free-mesh.md`, 7).
pub const FILLED: f64 = 0.83;

/// Wanted lengths along a segment, from its start to its end, linear between places.
#[derive(Clone, Debug)]
pub struct BorderSpacing {
    /// Fractions of the length, 0 to 1.
    pub(super) at: Vec<f64>,
    /// Model units.
    pub(super) lengths: Vec<f64>,
    /// What decides at each place; empty until all is known.
    pub(super) why: Vec<Why>,
}

impl BorderSpacing {
    /// One length all along.
    pub(super) fn even(length: f64) -> Self {
        Self { at: vec![0.0, 1.0], lengths: vec![length; 2], why: Vec::new() }
    }

    /// The largest lengths up to `most` that grow by no more than `slope` over the whole from those at places: fractions and lengths.
    pub(super) fn about(places: &[(f64, f64)], most: f64, slope: f64) -> Self {
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
        let mut spacing = Self { at: vec![places[0].0], lengths: vec![places[0].1], why: Vec::new() };
        for w in places.windows(2) {
            let [(f, a), (g, b)] = [w[0], w[1]];
            // Both slopes meet between the places, or reach the most before.
            let peak = 0.5 * (a + b + slope * (g - f)).min(2.0 * most);
            let ways = [(f + (peak - a) / slope, peak), (g - (peak - b) / slope, peak)];
            for (at, length) in ways.into_iter().chain([(g, b)]) {
                if at <= g {
                    spacing.grow_to(at, length);
                }
            }
        }
        spacing
    }

    /// Adds a place, unless it is not beyond the last one, and others before it: shares are added up from place to place, near enough to each
    /// other for lengths that grow.
    pub(super) fn grow_to(&mut self, at: f64, length: f64) {
        let (before, from) = (self.at[self.at.len() - 1], self.lengths[self.lengths.len() - 1]);
        if at <= before {
            return;
        }
        let parts =
            (math::log(length / from).abs() / math::log(SPACING_SETTINGS.equal_ratio)).ceil().clamp(1.0, SPACING_SETTINGS.max_parts);
        for k in 1..=parts as usize {
            let is_last = k == parts as usize;
            let now = if is_last { length } else { from * math::exp(math::log(length / from) * k as f64 / parts) };
            let share = if is_last { 1.0 } else { (now - from) / (length - from) };
            self.at.push(before + (at - before) * share);
            self.lengths.push(now);
        }
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
        let mut shares: BTreeMap<Why, f64> = BTreeMap::new();
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

    /// What decides at a fraction; `None` where it is not known.
    pub fn why_at(&self, f: f64) -> Option<Why> {
        let k = self.at.partition_point(|a| *a <= f).clamp(1, self.at.len() - 1);
        let nearer = if f - self.at[k - 1] <= self.at[k] - f { k - 1 } else { k };
        self.why.get(nearer).copied()
    }

    /// Number of steps over the whole for no step longer than wanted or than `size`; `most` at most.
    pub fn demand(&self, length: f64, size: f64, most: u32) -> u32 {
        let part = |k: usize| {
            let (a, b) = (self.lengths[k - 1].min(size), self.lengths[k].min(size));
            (self.at[k] - self.at[k - 1]) * 0.5 * (1.0 / a + 1.0 / b)
        };
        let sum: f64 = length * (1..self.at.len()).map(part).sum::<f64>();
        let n = (sum - WHOLE_NUMBER).ceil().clamp(1.0, f64::from(most)) as u32;
        // Even steps are what the size demands at least.
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

    /// The lower of two spacings at the places of both.
    pub(super) fn lower(&self, other: &Self) -> Self {
        let mut at: Vec<f64> = self.at.iter().chain(&other.at).copied().collect();
        at.sort_by(f64::total_cmp);
        at.dedup();
        let lengths = at.iter().map(|f| self.length_at(*f).min(other.length_at(*f))).collect();
        Self { at, lengths, why: Vec::new() }
    }
}

/// For each segment its spacing, where its steps vary.
pub type BorderSpacings = Vec<Option<BorderSpacing>>;
