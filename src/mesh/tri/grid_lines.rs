//! Ascending lines of a grid at any distances, found by place.

/// At least three lines, ascending.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    /// Where.
    pub at: Vec<f64>,
    /// The last line that is not beyond the start of each of some equal parts of the whole, and of the end.
    first: Vec<u32>,
    /// Parts for a unit of length.
    parts: f64,
}

impl Lines {
    pub fn new(at: Vec<f64>) -> Self {
        let n = 2 * at.len();
        let (low, whole) = (at[0], at[at.len() - 1] - at[0]);
        let last = |x: f64| at.partition_point(|line| *line <= x).max(1) as u32 - 1;
        let first = (0..=n).map(|k| last(low + whole * (k as f64 / n as f64))).collect();
        Self { first, parts: n as f64 / whole, at }
    }

    /// The gap between two lines that holds a place, the first or last one beyond the ends, and the share of the gap before the place, 0…1.
    pub fn place(&self, x: f64) -> (usize, f64) {
        let part = (((x - self.at[0]) * self.parts).max(0.0) as usize).min(self.first.len() - 2);
        // A place at the end of a part may be counted to the next by rounding: the share is held.
        let (from, to) = (self.first[part] as usize, self.first[part + 1] as usize);
        let beyond = self.at[from + 1..=to].partition_point(|line| *line <= x);
        let k = (from + beyond).min(self.at.len() - 2);
        let share = (x - self.at[k]) / (self.at[k + 1] - self.at[k]);
        // Lines may fall together where the whole has no width.
        (k, if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) })
    }

    /// These and others.
    pub fn and(&self, others: Vec<f64>) -> Self {
        let mut at = [self.at.as_slice(), &others].concat();
        at.sort_by(f64::total_cmp);
        Self::new(at)
    }

    /// The number of each line of a finer grid in this one, where it is one of it.
    pub fn indices_in(&self, finer: &Self) -> Vec<Option<usize>> {
        let index = |x: &f64| {
            let k = self.at.partition_point(|line| line < x);
            (self.at.get(k) == Some(x)).then_some(k)
        };
        finer.at.iter().map(index).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found_between_lines_at_any_distances() {
        let mut at: Vec<f64> = (0..=40).map(|k| 2.0 + 1.0 / (1_u64 << k) as f64).collect();
        at.extend((0..=7).map(|k| f64::from(k) * 0.25));
        at.sort_by(f64::total_cmp);
        let lines = Lines::new(at.clone());
        let middles = at.windows(2).map(|w| w[0].midpoint(w[1]));
        for x in at.iter().copied().chain(middles) {
            let (k, share) = lines.place(x);
            let found = at[k] + share * (at[k + 1] - at[k]);
            assert!(at[k] <= x && x <= at[k + 1] && (found - x).abs() < 1e-15, "{x}: {k} {share}");
        }
        assert_eq!((lines.place(-1.0), lines.place(9.0)), ((0, 0.0), (at.len() - 2, 1.0)));
    }

    #[test]
    fn lines_keep_their_numbers_among_more() {
        let lines = Lines::new(vec![0.0, 1.0, 3.0]);
        let more = lines.and(vec![2.0, 0.5]);
        assert_eq!(more.at, [0.0, 0.5, 1.0, 2.0, 3.0]);
        assert_eq!(lines.indices_in(&more), [Some(0), None, Some(1), None, Some(2)]);
    }
}
