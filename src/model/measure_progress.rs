//! When an integral is done that is found by halving cells.

use super::measure_quadrature::Sums;
use crate::base::tolerance::MEASURE_ROUNDING;

/// Errors that fall by less than this from one size of cells to the next do not fall, and so often in a row that they never will.
const STALLED: f64 = 0.9;
const STALLS: u32 = 2;

/// How the errors of an integral fall from one size of cells to the next.
pub struct Progress<const N: usize> {
    accuracy: f64,
    scale: Sums<N>,
    before: f64,
    stalls: u32,
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
