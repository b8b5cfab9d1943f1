//! Runs along curves, of which chains are made.

use glam::DVec3;

use crate::geometry::Curve;

/// A run along one curve between two arc lengths; backwards when `s1 < s0`.
///
/// On a closed curve a run may pass the start: then `s1` exceeds the curve's length (or `s0` does, backwards).
#[derive(Clone, Debug)]
pub struct Run {
    /// The curve it lies on.
    pub curve: Curve,
    /// Arc length where the run begins.
    pub s0: f64,
    /// Arc length where it ends.
    pub s1: f64,
}

crate::content!(Run { curve, s0, s1 });

impl Run {
    /// Arc length of the run.
    pub fn length(&self) -> f64 {
        (self.s1 - self.s0).abs()
    }

    /// Whether it runs against its curve.
    pub fn is_backward(&self) -> bool {
        self.s1 < self.s0
    }

    /// Point at an arc length between `s0` and `s1`.
    pub fn point_at(&self, s: f64) -> DVec3 {
        self.curve.point(self.curve.param_at_length(self.wrapped(s, false)))
    }

    /// An arc length of the run as one inside 0…length; at the curve's start the one before it or after it.
    pub(super) fn wrapped(&self, s: f64, before: bool) -> f64 {
        let length = self.curve.length();
        // The end of an ordinary run stays; a run that goes on past the start continues at zero.
        if s > length || (s == length && !before && self.s0.max(self.s1) > length) { s - length } else { s }
    }

    /// The run backwards.
    pub fn reversed(&self) -> Self {
        Self { curve: self.curve.clone(), s0: self.s1, s1: self.s0 }
    }
}
