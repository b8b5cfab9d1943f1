//! Modeling curves: runs of curves one after the other under one arc-length parameter [Koh & Park 1990, §3.2].
//!
//! ```text
//!   Φ(f):  0 ───run 0─── t₁ ──run 1── t₂ ────run 2──── 1      tᵢ = length before run i / whole length
//! ```

use std::sync::Arc;

use glam::DVec3;

use super::enclosure::{self, ChainEnclosure};
pub use super::run::Run;
use super::slice;
use crate::base::bbox::Box3;
use crate::base::digest::{StableHash, StableHasher};
use crate::base::fault::Result;
use crate::base::inline_list::InlineList;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Jet, Motion};
use crate::network::fault::MeetingFault;

/// A chain of runs: what the language calls a modeling curve, and also any curve value there. Cheap to clone.
///
/// Fractions `f` in 0…1 are of its arc length.
#[derive(Clone, Debug)]
pub struct Chain(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    runs: InlineList<Run, 1>,
    /// `None` of one whole curve run forwards, as most chains are.
    table: Option<Box<RunTable>>,
    length: f64,
    origin: Origin,
}

/// What is worked out about the runs beforehand.
#[derive(Debug)]
struct RunTable {
    joints: Vec<f64>,
    /// Per run: signed arc length on its curve per unit of fraction.
    rates: Vec<f64>,
    /// Per straight run: first point and derivative by the fraction, so that rows of points cost a multiplication each.
    straight: Vec<Option<(DVec3, DVec3)>>,
}

impl StableHash for Chain {
    fn hash_into(&self, to: &mut StableHasher) {
        let Inner { runs, table: _, length, origin: _ } = &*self.0;
        runs.hash_into(to);
        self.joints().hash_into(to);
        length.hash_into(to);
    }
}

impl Chain {
    /// The whole of one curve.
    pub fn of_curve(curve: &Curve) -> Self {
        Self::of_runs([Run { curve: curve.clone(), s0: 0.0, s1: curve.length() }], curve.origin())
    }

    /// Runs in a row; the caller knows that each starts where the one before ends. There must be at least one.
    pub fn of_runs(runs: impl Into<InlineList<Run, 1>>, origin: Origin) -> Self {
        let runs = runs.into();
        let length: f64 = runs.iter().map(Run::length).sum();
        if whole(&runs).is_some() && length > 0.0 {
            return Self(Arc::new(Inner { runs, table: None, length, origin }));
        }
        let straight = |run: &Run| match run.curve.shape() {
            Shape::Line(a, b) => {
                let (whole, direction) = (run.curve.length(), *b - *a);
                let sign = if run.is_backward() { -1.0 } else { 1.0 };
                Some((*a + direction * (run.s0 / whole), direction * (sign * length / whole)))
            }
            _ => None,
        };
        let mut joints = Vec::with_capacity(runs.len() + 1);
        let mut before = 0.0;
        for run in &runs {
            joints.push(before / length);
            before += run.length();
        }
        joints.push(1.0);
        let rates = (0..runs.len()).map(|k| (runs[k].s1 - runs[k].s0) / (joints[k + 1] - joints[k])).collect();
        let table = RunTable { joints, rates, straight: runs.iter().map(straight).collect() };
        Self(Arc::new(Inner { runs, table: Some(Box::new(table)), length, origin }))
    }

    /// The curve when this is one whole curve run forwards.
    pub fn whole_curve(&self) -> Option<&Curve> {
        whole(&self.0.runs)
    }

    /// The runs in order.
    pub fn runs(&self) -> &[Run] {
        &self.0.runs
    }

    /// Fractions of the joints between runs, 0 and 1 included.
    pub fn joints(&self) -> &[f64] {
        self.0.table.as_ref().map_or(&[0.0, 1.0], |table| &table.joints)
    }

    /// First point and derivative by the fraction of a straight run.
    #[inline]
    fn straight(&self, k: usize) -> Option<(DVec3, DVec3)> {
        match (&self.0.table, self.0.runs[k].curve.shape()) {
            (Some(table), _) => table.straight[k],
            (None, Shape::Line(a, b)) => Some((*a, *b - *a)),
            (None, _) => None,
        }
    }

    fn rate(&self, k: usize) -> f64 {
        self.0.table.as_ref().map_or(self.0.length, |table| table.rates[k])
    }

    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.0.length
    }

    /// Whether two chains run over the same parts of the same curves, made once and copied.
    pub fn is(&self, other: &Self) -> bool {
        let same = |(a, b): (&Run, &Run)| a.curve.is(&b.curve) && a.s0.to_bits() == b.s0.to_bits() && a.s1.to_bits() == b.s1.to_bits();
        Arc::ptr_eq(&self.0, &other.0)
            || (self.0.origin == other.0.origin
                && self.0.runs.len() == other.0.runs.len()
                && self.0.runs.iter().zip(&other.0.runs).all(same))
    }

    /// The expression that made it.
    pub fn origin(&self) -> Origin {
        self.0.origin
    }

    /// The same chain made by another expression; a whole curve takes it over.
    pub fn with_origin(&self, origin: Origin) -> Self {
        if let Some(curve) = self.whole_curve() {
            return Self::of_curve(&curve.with_origin(origin));
        }
        Self::of_runs(self.0.runs.clone(), origin)
    }

    /// The run that holds a fraction; at a joint the run that follows, or the one before.
    fn run_at(&self, f: f64, before: bool) -> usize {
        let inner = &self.joints()[1..self.0.runs.len()];
        if inner.is_empty() {
            0
        } else if before {
            inner.partition_point(|&joint| joint < f)
        } else {
            inner.partition_point(|&joint| joint <= f)
        }
    }

    /// Arc length on the curve of run `k` at a fraction, exact at the ends of the run.
    fn station(&self, k: usize, f: f64) -> f64 {
        let run = &self.0.runs[k];
        if f >= self.joints()[k + 1] {
            run.s1
        } else if f <= self.joints()[k] {
            run.s0
        } else {
            run.s0 + self.rate(k) * (f - self.joints()[k])
        }
    }

    /// Run and arc length on its curve at a fraction; at a joint those of the run that follows.
    pub fn locate(&self, f: f64) -> (usize, f64) {
        let k = self.run_at(f, false);
        (k, self.station(k, f))
    }

    /// Fraction of an arc length between the ends of run `k`.
    pub fn fraction(&self, k: usize, s: f64) -> f64 {
        let (run, joints) = (&self.0.runs[k], self.joints());
        if s == run.s1 {
            joints[k + 1]
        } else if s == run.s0 {
            joints[k]
        } else {
            (joints[k] + (s - run.s0) / self.rate(k)).clamp(joints[k], joints[k + 1])
        }
    }

    /// Point and derivatives with respect to the fraction; at a joint those of the run that follows (the last at 1).
    pub fn jet(&self, f: f64) -> Jet {
        self.jet_of_run(self.run_at(f, false), f, f >= 1.0)
    }

    /// Like [`Chain::jet`], at a joint or kink with the derivatives of what lies before it.
    pub fn jet_before(&self, f: f64) -> Jet {
        self.jet_of_run(self.run_at(f, true), f, f > 0.0)
    }

    fn jet_of_run(&self, k: usize, f: f64, before: bool) -> Jet {
        if let Some((p, d1)) = self.straight(k) {
            return Jet { p: p + d1 * (f - self.joints()[k]), d1, d2: DVec3::ZERO };
        }
        let run = &self.0.runs[k];
        // What lies before a place of the chain lies after it on a curve run backwards.
        let before_on_curve = before != run.is_backward();
        let s = run.wrapped(self.station(k, f), before_on_curve);
        let t = run.curve.param_at_length(s);
        let jet = if before_on_curve { run.curve.jet_before(t) } else { run.curve.jet(t) };
        let rate = if run.is_backward() { -self.0.length } else { self.0.length };
        by_length(&jet, rate, before_on_curve)
    }

    /// Point at a fraction.
    pub fn point(&self, f: f64) -> DVec3 {
        self.point_of_run(self.run_at(f, false), f)
    }

    fn point_of_run(&self, k: usize, f: f64) -> DVec3 {
        if let Some((p, d1)) = self.straight(k) {
            return p + d1 * (f.clamp(0.0, 1.0) - self.joints()[k]);
        }
        self.0.runs[k].point_at(self.station(k, f))
    }

    /// Points at ascending fractions; `out` is as long as `fs`. Does not allocate.
    pub fn points(&self, fs: &[f64], out: &mut [DVec3]) {
        let (mut k, last) = (0, self.0.runs.len() - 1);
        for (&f, p) in fs.iter().zip(out) {
            while k < last && f >= self.joints()[k + 1] {
                k += 1;
            }
            *p = self.point_of_run(k, f);
        }
    }

    /// Points and derivatives at ascending fractions, as [`Chain::jet`] gives them. Does not allocate.
    pub fn jets(&self, fs: &[f64], out: &mut [Jet]) {
        let (mut k, last) = (0, self.0.runs.len() - 1);
        for (&f, jet) in fs.iter().zip(out) {
            while k < last && f >= self.joints()[k + 1] {
                k += 1;
            }
            *jet = self.jet_of_run(k, f, f >= 1.0);
        }
    }

    /// First point.
    pub fn start(&self) -> DVec3 {
        let run = &self.0.runs[0];
        run.point_at(run.s0)
    }

    /// Last point.
    pub fn end(&self) -> DVec3 {
        let run = &self.0.runs[self.0.runs.len() - 1];
        run.point_at(run.s1)
    }

    /// Whether it ends where it starts.
    pub fn is_closed(&self, tolerance: &Tolerance) -> bool {
        self.0.length > tolerance.point && tolerance.same_point(self.start(), self.end())
    }

    /// The run backwards.
    pub fn reversed(&self) -> Self {
        Self::of_runs(self.0.runs.iter().rev().map(Run::reversed).collect::<Vec<_>>(), self.0.origin)
    }

    /// The run between two fractions; `f1 < f0` runs backwards, on a closed chain it walks forward past the start
    /// (and once around when the two are one place). E401 when nothing is left.
    pub fn slice(&self, f0: f64, f1: f64, tolerance: &Tolerance) -> Result<Self> {
        slice::slice(self, (f0, f1), tolerance)
    }

    /// Chains in a row; each must start where the one before ends, else E503 with both ends and the gap.
    ///
    /// A part that is run over twice is E504. There must be at least one part.
    pub fn join(parts: &[Self], origin: Origin, tolerance: &Tolerance) -> Result<Self> {
        slice::join(parts, origin, tolerance)
    }

    /// Fractions of slope discontinuities inside it, ascending (0 too for a closed chain with a corner there).
    pub fn kinks(&self, tolerance: &Tolerance) -> Vec<f64> {
        slice::kinks(self, tolerance)
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let mut runs: Vec<Run> = Vec::with_capacity(self.0.runs.len());
        for (k, run) in self.0.runs.iter().enumerate() {
            // Runs on one curve stay runs on one curve.
            let earlier = (0..k).find(|&j| same_curve(&self.0.runs[j].curve, &run.curve));
            let curve = earlier.map_or_else(|| run.curve.moved(motion), |j| runs[j].curve.clone());
            let (old, new) = (run.curve.length(), curve.length());
            let scaled = |s: f64| if s == old { new } else { s * (new / old) };
            runs.push(Run { s0: scaled(run.s0), s1: scaled(run.s1), curve });
        }
        Self::of_runs(runs, self.0.origin)
    }

    /// One curve with the same points: the curve itself, a part of it, or a composite.
    pub fn to_curve(&self) -> Result<Curve> {
        if let Some(curve) = self.whole_curve() {
            return Ok(curve.clone());
        }
        let mut pieces = Vec::with_capacity(self.0.runs.len());
        for run in &self.0.runs {
            pieces.extend(slice::pieces(run));
        }
        match pieces.as_slice() {
            [one] => Ok(one.with_origin(self.0.origin)),
            _ => build::composite(&pieces, self.0.origin),
        }
    }

    /// Bounds of the derivatives by the fraction between two fractions, `f0 < f1`.
    pub fn enclosure(&self, f0: f64, f1: f64) -> ChainEnclosure {
        enclosure::of_chain(self, f0, f1)
    }

    /// A box that holds the chain (of the whole curves it runs on where they are cut).
    pub fn bbox(&self) -> Box3 {
        self.0.runs.iter().fold(Box3::EMPTY, |bbox, run| bbox.union(run.curve.bbox()))
    }

    /// Nearest point of the chain: fraction, point, distance. Ties go to the smaller fraction.
    pub fn closest(&self, p: DVec3) -> (f64, DVec3, f64) {
        slice::closest(self, p)
    }

    /// Fraction of a point that lies on the chain within the tolerance, else E507 with the nearest point.
    pub fn fraction_at(&self, p: DVec3, tolerance: &Tolerance) -> Result<f64> {
        let (f, nearest, distance) = self.closest(p);
        if distance <= tolerance.point {
            return Ok(f);
        }
        Err(MeetingFault::PointOff { of: self.0.origin, point: p, nearest, tolerance: tolerance.point }.into())
    }
}

/// The curve that one run runs over as a whole, forwards.
fn whole(runs: &[Run]) -> Option<&Curve> {
    match runs {
        [run] if run.s0 == 0.0 && run.s1 == run.curve.length() => Some(&run.curve),
        _ => None,
    }
}

/// Whether two values are one curve: the same shape over the same domain, whoever made it.
pub fn same_curve(a: &Curve, b: &Curve) -> bool {
    match (a.shape(), b.shape()) {
        (Shape::Line(a0, a1), Shape::Line(b0, b1)) => a0 == b0 && a1 == b1,
        (Shape::Nurbs(a), Shape::Nurbs(b)) => Arc::ptr_eq(a, b) || a == b,
        (Shape::Composite(a), Shape::Composite(b)) if Arc::ptr_eq(a, b) => true,
        (Shape::Line(..) | Shape::Nurbs(_), _) | (_, Shape::Line(..) | Shape::Nurbs(_)) => false,
        // Of one kind over one domain, and equal to the last bit at three places.
        _ => {
            let (first, last) = a.domain();
            a.kind() == b.kind()
                && b.domain() == (first, last)
                && [0.0, 0.375, 1.0].into_iter().all(|x| a.point(first + (last - first) * x) == b.point(first + (last - first) * x))
        }
    }
}

/// Derivatives by arc length times `rate` from derivatives by the curve's own parameter.
///
/// With T = C′/|C′|: dC/ds = T, d²C/ds² = (C″ − T (T·C″)) / |C′|².
fn by_length(jet: &Jet, rate: f64, before: bool) -> Jet {
    let speed = jet.d1.length();
    if speed > 0.0 {
        let tangent = jet.d1 / speed;
        let bend = (jet.d2 - tangent * tangent.dot(jet.d2)) / (speed * speed);
        return Jet { p: jet.p, d1: tangent * rate, d2: bend * (rate * rate) };
    }
    // At a cusp the curve leaves along C″ and arrives against it.
    let leaving = jet.d2.normalize_or_zero();
    Jet { p: jet.p, d1: if before { -leaving } else { leaving } * rate, d2: DVec3::ZERO }
}
