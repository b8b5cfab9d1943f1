//! Steps of rows along a direction of a map: as long as its bends allow, and growing from there.

use crate::mesh::size::border_spacing::BorderSpacing;

/// Error of the longest step that keeps the limits, over itself.
const STEP_ERROR: f64 = 0.01;

/// What limits demand of the rows along one direction of a map.
pub(super) struct RowProfile {
    /// Ends of intervals as shares of the length of a side, from 0 to 1.
    pub stops: Vec<f64>,
    /// Second derivative by that share over the chord error, and turn by that share over the angle, in each interval.
    pub bends: Vec<Bend>,
    /// Length of the longest row, model units.
    pub longest: f64,
}

/// How a place is bent along a direction, over what limits allow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bend {
    /// The second derivative by the parameter.
    pub second: f64,
    /// What a cell as long as the step across is twisted by a step of the parameter.
    pub twist: f64,
    /// The turn of the normal by the parameter.
    pub turn: f64,
}

impl Bend {
    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self { second: self.second.max(other.second), twist: self.twist.max(other.twist), turn: self.turn.max(other.turn) }
    }

    /// Rows over a step of the parameter, all of it bent like this.
    pub fn rows(self, step: f64) -> f64 {
        // Steps h for which s h² ∕ 8 + t h = 1.
        (0.5 * self.twist + (0.25 * self.twist * self.twist + self.second / 8.0).sqrt()).max(self.turn) * step
    }
}

impl RowProfile {
    /// The longest steps in each interval that keep the limits, as shares of the side, `most` at most.
    pub fn longest_steps(&self, most: f64) -> Vec<f64> {
        let sums = Sums::new(self);
        let middle = |w: &[f64]| sums.longest_step(0.5 * (w[0] + w[1]), most.min(1.0)).min(most);
        self.stops.windows(2).map(middle).collect()
    }

    /// Steps as shares of the side: as long as in each interval, and growing by no more than `slope` over the way from each to the next,
    /// over the ends too where rows go round a `ring`.
    pub fn spacing(&self, longest: &[f64], slope: f64, is_ring: bool) -> BorderSpacing {
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
            let peak = (0.5 * (from.1 + to.1 + slope * (to.0 - from.0))).min(longest[k]).max(from.1).max(to.1);
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
        while high - low > STEP_ERROR * high {
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
