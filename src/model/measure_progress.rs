//! Integrals that are found by halving: parts of one size after the other, until all together are exact enough.

use super::measure_quadrature::{Sums, add, small};
use crate::base::tolerance::MEASURE_ROUNDING;
use crate::base::work::Budget;

/// Errors that fall by less than this from one size of parts to the next do not fall, and so often in a row that they never will.
const STALLED: f64 = 0.9;
const STALLS: u32 = 2;
/// Units of work after which an integral is left as exact as it then is.
const WORK: u64 = 8_000_000;

/// How the errors of an integral fall from one size of parts to the next.
pub struct Progress<const N: usize> {
    accuracy: f64,
    scale: Sums<N>,
    before: f64,
    stalls: u32,
}

/// What a part comes to, by rules that differ by so much.
pub struct Part<const N: usize> {
    pub value: Sums<N>,
    pub apart: Sums<N>,
    /// What the rules may differ by, for the part to be done.
    pub limit: Sums<N>,
    /// It is not halved further.
    pub last: bool,
}

impl<const N: usize> Progress<N> {
    /// Before the first size; `scale` is what `accuracy` is relative to.
    pub fn new(accuracy: f64, scale: Sums<N>) -> Self {
        Self { accuracy, scale, before: f64::INFINITY, stalls: 0 }
    }

    /// Whether halving the rest is not needed for the accuracy, or no longer gains anything: what is left is rounding.
    pub fn is_over(&mut self, left: &Sums<N>) -> bool {
        let relative = |i: usize| if left[i] > 0.0 { left[i] / self.scale[i] } else { 0.0 };
        let now = (0..N).map(relative).fold(0.0, f64::max);
        self.stalls = if now > STALLED * self.before { self.stalls + 1 } else { 0 };
        self.before = now;
        now <= self.accuracy || self.stalls >= STALLS && now <= MEASURE_ROUNDING
    }

    /// The sums over parts that `halves` cuts in `pieces` each, and what they are off by; no more than `most` parts are looked at.
    ///
    /// Parts of one size come after those of another: where there are too many, what is left is of one size everywhere.
    pub fn sum<T, I: IntoIterator<Item = T>>(
        mut self,
        mut open: Vec<T>,
        (most, pieces): (usize, usize),
        meter: &Budget,
        mut measure: impl FnMut(&T) -> Part<N>,
        halves: impl Fn(T) -> I,
    ) -> (Sums<N>, Sums<N>) {
        let (mut sum, mut error, mut seen) = ([0.0; N], [0.0; N], 0);
        while !open.is_empty() {
            let mut rough = Vec::new();
            for part in open {
                let Part { value, apart, limit, last } = measure(&part);
                if small(&apart, &limit) || last {
                    add(&mut sum, &value);
                    add(&mut error, &apart);
                } else {
                    rough.push((part, value, apart));
                }
                seen += 1;
            }
            let left = rough.iter().fold(error, |all, (_, _, apart)| std::array::from_fn(|i| all[i] + apart[i]));
            if self.is_over(&left) || seen + pieces * rough.len() > most || meter.spent() > WORK {
                rough.iter().for_each(|(_, value, apart)| {
                    add(&mut sum, value);
                    add(&mut error, apart);
                });
                break;
            }
            open = rough.into_iter().flat_map(|(part, ..)| halves(part)).collect();
        }
        (sum, error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;

    fn rounds(accuracy: f64, error: impl Fn(i32) -> f64) -> i32 {
        let mut progress = Progress::new(accuracy, [0.0, 2.0]);
        (1..).find(|k| progress.is_over(&[0.0, error(*k)])).unwrap_or(0)
    }

    #[test]
    fn halving_ends_at_the_accuracy_or_where_only_rounding_is_left() {
        // Errors across a fold fall to a quarter.
        assert_eq!(rounds(1e-10, |k| 2.0 * math::powi(0.25, k)), 17);
        // Errors beside a line of infinite slope fall to 0.7.
        assert!(rounds(1e-10, |k| 2e-8 * math::powi(0.5, k).sqrt()) > 8);
        // Rounding stays what it is.
        assert_eq!(rounds(1e-10, |_| 1e-8), 3);
        assert_eq!(rounds(1e-10, |k| if k < 9 { 0.1 } else { 1e-8 }), 11);
        // What is not yet seen is no rounding, however long it stays.
        assert_eq!(rounds(1e-10, |k| if k < 40 { 1e-3 } else { 0.0 }), 40);
    }
}
