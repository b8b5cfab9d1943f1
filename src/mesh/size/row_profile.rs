//! How many rows of a mapped face limits demand from place to place along its sides.

use glam::DVec3;

use crate::base::tolerance::WHOLE_NUMBER;
use crate::base::{job, work};
use crate::mesh::border::layout::Face;
use crate::mesh::border::side_parameters::SideMap;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::size::border_spacing::BorderSpacing;
use crate::surface::{Evaluator, Jet2};

/// What steers the search for demands.
struct ProfileSettings {
    /// Places across the rows at which bends are taken, at least, evenly between the sides.
    across: usize,
    /// Break lines across the rows between which bends are taken too, at most.
    max_breaks: usize,
    /// Places in an interval at which bends are taken, as shares of it: none on a break line.
    places: [f64; 3],
    /// Largest ratio of demands at these places in an interval that is not halved.
    max_ratio: f64,
    /// An interval of fewer rows is not halved.
    min_rows: f64,
    /// Halvings of an interval between break lines at most.
    max_halvings: u32,
    /// Intervals of a side at most.
    max_intervals: usize,
    /// Share of the chord error that is left for one direction at least where the other one bends too.
    min_share: f64,
    /// Error of the longest step that keeps the limits, over itself.
    step_error: f64,
}

const SETTINGS: ProfileSettings = ProfileSettings {
    across: 7,
    max_breaks: 24,
    places: [1.0 / 8.0, 0.5, 7.0 / 8.0],
    max_ratio: 1.25,
    min_rows: 0.5,
    max_halvings: 12,
    max_intervals: 1 << 14,
    min_share: 0.5,
    step_error: 0.01,
};

/// What limits demand of the rows along one direction of a map.
pub(super) struct RowProfile {
    /// Ends of intervals as shares of the length of a side, from 0 to 1.
    stops: Vec<f64>,
    /// Second derivative by that share over the chord error, and turn by that share over the angle, in each interval.
    bends: Vec<Bend>,
    /// Length of the longest row, model units.
    longest: f64,
}

/// How a place is bent along a direction, over what limits allow.
#[derive(Clone, Copy, Debug, Default)]
struct Bend {
    /// The second derivative by the parameter.
    second: f64,
    /// What a cell as long as the step across is twisted by a step of the parameter.
    twist: f64,
    /// The turn of the normal by the parameter.
    turn: f64,
}

impl Bend {
    /// The larger of each.
    fn max(self, other: Self) -> Self {
        Self { second: self.second.max(other.second), twist: self.twist.max(other.twist), turn: self.turn.max(other.turn) }
    }

    /// Rows over a step of the parameter, all of it bent like this.
    fn rows(self, step: f64) -> f64 {
        // Steps h for which s h² ∕ 8 + t h = 1.
        (0.5 * self.twist + (0.25 * self.twist * self.twist + self.second / 8.0).sqrt()).max(self.turn) * step
    }
}

/// One direction of a mapped face, with the sides along it.
pub(super) struct RowDirection<'a> {
    evaluator: Evaluator<'a>,
    limits: &'a Limits,
    /// 0: rows follow each other along u, 1: along v.
    direction: usize,
    /// Sides along the direction; a pole has the map of the other one.
    sides: [SideMap<'a>; 2],
    /// Values of the other parameter at which bends are taken: the first and the last are those of the sides.
    across: Vec<f64>,
    /// Step of the other parameter that the size allows.
    step_across: f64,
}

impl<'a> RowDirection<'a> {
    /// Of a face with four sides, `None` where both sides along the direction are poles.
    pub(super) fn new(input: &'a Input, evaluator: Evaluator<'a>, limits: &'a Limits, face: &Face, direction: usize) -> Option<Self> {
        let used = |k: usize| !face.sides[k].uses.is_empty();
        let [first, second] = [direction, direction + 2];
        let (a, b) = match (used(first), used(second)) {
            (true, true) => (first, second),
            (true, false) => (first, first),
            (false, true) => (second, second),
            (false, false) => return None,
        };
        let patch = &input.model.patches[face.patch.index()];
        let (low, high) = if direction == 0 { patch.v } else { patch.u };
        let breaks = evaluator.surface().breaks();
        let breaks = if direction == 0 { breaks.1 } else { breaks.0 };
        let mut across: Vec<f64> = (0..=SETTINGS.across).map(|k| low + (high - low) * k as f64 / SETTINGS.across as f64).collect();
        let mut lines: Vec<f64> = breaks.into_iter().filter(|x| *x > low && *x < high).collect();
        if lines.len() <= SETTINGS.max_breaks && !lines.is_empty() {
            lines.insert(0, low);
            lines.push(high);
            across.extend(lines.windows(2).map(|w| 0.5 * (w[0] + w[1])));
            across.sort_by(f64::total_cmp);
        }
        let length = face.sides[1 - direction].length.max(face.sides[3 - direction].length);
        let step_across = (high - low) / (length / face.size.0).max(1.0);
        Some(Self {
            evaluator,
            limits,
            direction,
            sides: [SideMap::new(input, face, a), SideMap::new(input, face, b)],
            across,
            step_across,
        })
    }

    /// The demand at every place.
    pub(super) fn profile(&self) -> RowProfile {
        let mut profile = RowProfile { stops: vec![0.0], bends: Vec::new(), longest: 0.0 };
        let mut lengths = vec![0.0; self.across.len()];
        let stops = self.stops();
        for w in stops.windows(2) {
            let mut open = vec![(w[0], w[1], SETTINGS.max_halvings)];
            while let Some((a, b, left)) = open.pop() {
                job::poll();
                let (bend, even, steps) = self.interval(a, b);
                let halved = bend.rows(b - a) > SETTINGS.min_rows && !even;
                if left > 0 && halved && profile.bends.len() + open.len() < SETTINGS.max_intervals {
                    let middle = 0.5 * (a + b);
                    open.extend([(middle, b, left - 1), (a, middle, left - 1)]);
                    continue;
                }
                profile.stops.push(b);
                profile.bends.push(bend);
                lengths.iter_mut().zip(steps).for_each(|(sum, step)| *sum += step);
            }
        }
        profile.longest = lengths.into_iter().fold(0.0, f64::max);
        profile
    }

    /// Shares of the sides where break lines meet one of them, with both ends.
    fn stops(&self) -> Vec<f64> {
        let breaks = self.evaluator.surface().breaks();
        let lines = if self.direction == 0 { breaks.0 } else { breaks.1 };
        let mut stops: Vec<f64> = self.sides.iter().flat_map(|side| lines.iter().map(|x| side.share(*x))).collect();
        stops.retain(|f| *f > 0.0 && *f < 1.0);
        stops.extend([0.0, 1.0]);
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|b, a| *b - *a <= WHOLE_NUMBER);
        // The last stop is the end itself.
        if let Some(last) = stops.last_mut() {
            *last = 1.0;
        }
        stops
    }

    /// The largest bend in an interval, whether it is the same all over it, and the lengths of the lines across which bends are taken.
    fn interval(&self, a: f64, b: f64) -> (Bend, bool, Vec<f64>) {
        let ends = [0, 1].map(|k| [a, b].map(|f| self.sides[k].parameter(f)));
        let (from, to) = (self.across[0], self.across[self.across.len() - 1]);
        let mut found = [Bend::default(); SETTINGS.places.len()];
        let mut lengths = Vec::with_capacity(self.across.len());
        for (k, other) in self.across.iter().enumerate() {
            work::spend(1);
            let y = (other - from) / (to - from);
            let mix = |end: usize| ends[0][end] + (ends[1][end] - ends[0][end]) * y;
            let (low, high) = (mix(0), mix(1));
            let on_side = k == 0 || k + 1 == self.across.len();
            for (place, most) in SETTINGS.places.iter().zip(&mut found) {
                let own = low + (high - low) * place;
                let jet = if self.direction == 0 { self.evaluator.jet(own, *other) } else { exchanged(&self.evaluator.jet(*other, own)) };
                *most = most.max(self.bend(&jet, (high - low) / (b - a), on_side));
                if *place == 0.5 {
                    lengths.push(jet.du.length() * (high - low).abs());
                }
            }
        }
        let rows = found.map(|bend| bend.rows(1.0));
        let (least, most) = (rows.into_iter().fold(f64::INFINITY, f64::min), rows.into_iter().fold(0.0, f64::max));
        (found.into_iter().fold(Bend::default(), Bend::max), most <= SETTINGS.max_ratio * least, lengths)
    }

    /// The bend at a place whose jet has u along the direction, `rate` times as fast as shares of a side.
    fn bend(&self, jet: &Jet2, rate: f64, on_side: bool) -> Bend {
        let across = jet.du.cross(jet.dv);
        let area = across.length();
        let (tangent, normal) = (jet.du.normalize_or_zero(), across.normalize_or_zero());
        let mut bend = Bend::default();
        if let Some(chord) = self.limits.chord {
            let [along, twist, other] = [jet.duu, jet.duv, jet.dvv].map(|second| second.dot(normal).abs());
            // Both directions share what a twist demands: cells that are nothing but twisted are squares.
            let by_twist = (4.0 * chord * jet.du.length() / (twist * jet.dv.length())).sqrt();
            let step_across = self.step_across.min((8.0 * chord / other).sqrt()).min(by_twist);
            let left = (chord - other * step_across * step_across / 8.0).max(SETTINGS.min_share * chord);
            bend.second = along / left;
            bend.twist = twist * step_across * rate.abs() / (4.0 * left);
            if on_side {
                bend.second = bend.second.max(aside(jet.duu, tangent) / chord);
            }
            bend.second *= rate * rate;
        }
        if let Some(angle) = self.limits.angle {
            let change = jet.duu.cross(jet.dv) + jet.du.cross(jet.duv);
            let turn = if area > 0.0 { aside(change, normal) / area } else { 0.0 };
            let speed = jet.du.length();
            let curve = if on_side && speed > 0.0 { aside(jet.duu, tangent) / speed } else { 0.0 };
            bend.turn = turn.max(curve) * rate.abs() / angle;
        }
        if bend.rows(1.0).is_finite() { bend } else { Bend::default() }
    }
}

/// Length of a vector without its part along a unit vector.
fn aside(vector: DVec3, unit: DVec3) -> f64 {
    (vector - unit * vector.dot(unit)).length()
}

/// A jet with u and v exchanged.
fn exchanged(jet: &Jet2) -> Jet2 {
    Jet2 { du: jet.dv, dv: jet.du, duu: jet.dvv, dvv: jet.duu, ..*jet }
}

impl RowProfile {
    /// Length of the longest row, model units.
    pub(super) fn longest(&self) -> f64 {
        self.longest
    }

    /// The longest steps in each interval that keep the limits, as shares of the side, `most` at most.
    pub(super) fn longest_steps(&self, most: f64) -> Vec<f64> {
        let sums = Sums::new(self);
        let middle = |w: &[f64]| sums.longest_step(0.5 * (w[0] + w[1]), most.min(1.0)).min(most);
        self.stops.windows(2).map(middle).collect()
    }

    /// Steps as shares of the side: as long as in each interval, and growing by no more than `slope` over the way from each to the next,
    /// over the ends too where rows go round a `ring`.
    pub(super) fn spacing(&self, longest: &[f64], slope: f64, is_ring: bool) -> BorderSpacing {
        let n = longest.len();
        let width = |k: usize| self.stops[k + 1] - self.stops[k];
        let mut ends: Vec<f64> = (0..=n).map(|k| longest[k.saturating_sub(1)].min(longest[k.min(n - 1)])).collect();
        // Twice: what grows over the ends of a ring goes on from there.
        for _ in 0..2 {
            if is_ring {
                let both = ends[0].min(ends[n]);
                (ends[0], ends[n]) = (both, both);
            }
            for k in 0..n {
                ends[k + 1] = ends[k + 1].min(ends[k] + slope * width(k));
            }
            for k in (0..n).rev() {
                ends[k] = ends[k].min(ends[k + 1] + slope * width(k));
            }
        }
        let mut spacing = BorderSpacing { at: vec![0.0], lengths: vec![ends[0]], why: Vec::new() };
        for k in 0..n {
            let (from, to) = ((self.stops[k], ends[k]), (self.stops[k + 1], ends[k + 1]));
            let peak = (0.5 * (from.1 + to.1 + slope * (to.0 - from.0))).min(longest[k]);
            let (up, down) = (from.0 + (peak - from.1) / slope, to.0 - (peak - to.1) / slope);
            for (at, length) in [(up, peak), (down, peak), to] {
                spacing.grow_to(at.min(to.0), length);
            }
        }
        spacing
    }
}

/// Sums over the intervals of a profile up to the beginning of each.
struct Sums<'a> {
    profile: &'a RowProfile,
    /// Of second derivatives.
    seconds: Vec<f64>,
    /// Of second derivatives by their places.
    moments: Vec<f64>,
    twists: Vec<f64>,
    turns: Vec<f64>,
}

impl<'a> Sums<'a> {
    fn new(profile: &'a RowProfile) -> Self {
        let [mut seconds, mut moments, mut twists, mut turns] = [0; 4].map(|_| vec![0.0]);
        for (k, (w, bend)) in profile.stops.windows(2).zip(&profile.bends).enumerate() {
            let width = w[1] - w[0];
            seconds.push(seconds[k] + bend.second * width);
            moments.push(moments[k] + bend.second * width * 0.5 * (w[0] + w[1]));
            twists.push(twists[k] + bend.twist * width);
            turns.push(turns[k] + bend.turn * width);
        }
        Self { profile, seconds, moments, twists, turns }
    }

    /// Sums of second derivatives, of these by their places, of twists and of turns up to a place.
    fn up_to(&self, at: f64) -> [f64; 4] {
        let stops = &self.profile.stops;
        let k = stops.partition_point(|stop| *stop <= at).clamp(1, stops.len() - 1) - 1;
        let (bend, width) = (self.profile.bends[k], at - stops[k]);
        let middle = 0.5 * (stops[k] + at);
        [
            self.seconds[k] + bend.second * width,
            self.moments[k] + bend.second * width * middle,
            self.twists[k] + bend.twist * width,
            self.turns[k] + bend.turn * width,
        ]
    }

    /// What a step about a place is off its chord in its middle, with the twist of its cells, and what it turns, over what limits allow:
    /// the larger of both. Off its chord it is ½ ∫ min(x − a, b − x) s(x) dx by the second derivative s between the ends a and b.
    fn of_step(&self, about: f64, length: f64) -> f64 {
        let middle = about.clamp(0.5 * length, 1.0 - 0.5 * length);
        let (a, b) = (middle - 0.5 * length, middle + 0.5 * length);
        let [from, half, to] = [a, middle, b].map(|at| self.up_to(at));
        let rising = half[1] - from[1] - a * (half[0] - from[0]);
        let falling = b * (to[0] - half[0]) - (to[1] - half[1]);
        (0.5 * (rising + falling) + to[2] - from[2]).max(to[3] - from[3])
    }

    /// The longest step about a place that keeps the limits, `most` at most.
    fn longest_step(&self, about: f64, most: f64) -> f64 {
        let (mut low, mut high) = (0.0, most);
        if self.of_step(about, most) <= 1.0 {
            return most;
        }
        while high - low > SETTINGS.step_error * high {
            let length = 0.5 * (low + high);
            if self.of_step(about, length) <= 1.0 {
                low = length
            } else {
                high = length
            }
            if high <= f64::MIN_POSITIVE {
                break;
            }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(stops: &[f64], seconds: &[f64]) -> RowProfile {
        let bend = |second: &f64| Bend { second: *second, ..Bend::default() };
        RowProfile { stops: stops.to_vec(), bends: seconds.iter().map(bend).collect(), longest: 1.0 }
    }

    #[test]
    fn steps_are_as_long_as_a_constant_bend_allows_at_the_ends_too() {
        // s h² ∕ 8 = 1.
        let found = profile(&[0.0, 0.01, 0.5, 1.0], &[800.0; 3]).longest_steps(0.4);
        assert!(found.iter().all(|step| (step - 0.1).abs() < 0.002), "{found:?}");
    }

    #[test]
    fn a_rounding_that_is_smaller_than_the_limit_is_cut_off() {
        // A turn of 40 in all at one place: h ∕ 4 · 40 = 1, while the bend alone allows steps of 4.5e-5.
        let found = profile(&[0.0, 0.5, 0.5 + 1e-8, 1.0], &[0.0, 40.0 / 1e-8, 0.0]).longest_steps(0.4);
        assert!((found[1] - 0.1).abs() < 0.002, "{found:?}");
    }

    #[test]
    fn the_turn_over_a_step_is_no_more_than_the_angle() {
        let bend = Bend { turn: 50.0, ..Bend::default() };
        let bends = vec![Bend::default(), bend, Bend::default()];
        let found = RowProfile { stops: vec![0.0, 0.4, 0.6, 1.0], bends, longest: 1.0 }.longest_steps(0.5);
        assert!((found[1] - 0.02).abs() < 0.001, "{found:?}");
    }

    #[test]
    fn lengths_grow_from_bends_and_over_the_ends_of_a_ring() {
        let stops = [0.0, 0.1, 1.0];
        let bent = profile(&stops, &[8.0 / 1e-4, 0.0]);
        let longest = bent.longest_steps(0.2);
        for (is_ring, last) in [(false, 0.2), (true, 0.01)] {
            let spacing = bent.spacing(&longest, 0.3, is_ring);
            assert!((spacing.length_at(0.05) - 0.01).abs() < 1e-3);
            assert!((spacing.length_at(1.0) - last).abs() < 1e-3, "{}", spacing.length_at(1.0));
            assert!(spacing.at.windows(2).all(|w| w[0] < w[1]));
            let slope = |k: usize| (spacing.lengths[k + 1] - spacing.lengths[k]) / (spacing.at[k + 1] - spacing.at[k]);
            assert!((0..spacing.at.len() - 1).all(|k| slope(k).abs() < 0.3 + 1e-9));
        }
    }
}
