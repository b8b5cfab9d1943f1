//! Lines of constant u or v that have no exact form, as cubics within a tolerance.
//!
//! Each cubic has the line's ends and derivatives. What it is off is bounded, not sampled: about the middle of an interval
//! of half width h the difference e is at most |e| + h |e′| there plus ½ h² times the range of e″, which is the surface's
//! range of second derivatives less the cubic's (`docs/notes/bounds.md`).

use std::sync::Arc;

use crate::base::fault::Result;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::range::Interval3;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::geometry::curves::curve::Shape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::{Curve, Jet, Kind, Nurbs};
use crate::surface::analysis::iso_line::IsoLine;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;

/// Share of the tolerance that a fit may be off, so that what is compared with it is not at the limit.
const SHARE: f64 = 0.25;
/// Cubics at most.
const MOST_PIECES: usize = 1 << 14;
/// Intervals in which one cubic is looked at, at most.
const INTERVALS: usize = 64;

/// A line with what it is fitted to.
struct LineFit<'a> {
    surface: &'a Surface,
    line: IsoLine,
    allowed: f64,
}

/// The line as a curve that is nowhere farther from it than a quarter of the tolerance.
///
/// Fails with E401 where the line is one point, E413 where nothing is known of its bend (a cusp below).
pub(crate) fn fitted(surface: &Surface, line: IsoLine, origin: Origin, tolerance: &Tolerance) -> Result<Curve> {
    let fit = LineFit { surface, line, allowed: SHARE * tolerance.point };
    let end = if surface.domain() == Domain::Triangle { 1.0 - line.value() } else { 1.0 };
    let (us, vs) = surface.breaks();
    let inner = if matches!(line, IsoLine::U(_)) { vs } else { us };
    let inside = inner.into_iter().filter(|t| *t > tolerance.parameter && *t < end - tolerance.parameter);
    let stops: Vec<f64> = std::iter::once(0.0).chain(inside).chain(std::iter::once(end)).collect();
    let mut pieces = Vec::new();
    for w in stops.windows(2).filter(|w| w[0] < w[1]) {
        let mut open = vec![(w[0], w[1])];
        while let Some((a, b)) = open.pop() {
            job::poll();
            let cubic = fit.cubic(a, b);
            if fit.holds(&cubic, a, b) {
                pieces.push(cubic);
            } else if pieces.len() + open.len() > MOST_PIECES || b - a < NUDGE * (w[1] - w[0]) {
                let at = fit.jet(a, OneSided::After).p;
                return Err(CurveFault::NotConverged { of: origin, what: "the line on the surface".to_owned(), at }.into());
            } else {
                let middle = 0.5 * (a + b);
                open.push((middle, b));
                open.push((a, middle));
            }
        }
    }
    let zero = |length: f64| CurveFault::ZeroLength { of: origin, length, tolerance: tolerance.point };
    if pieces.is_empty() {
        return Err(zero(0.0).into());
    }
    let curve = Curve::new(Shape::Nurbs(Arc::new(Nurbs::joined(&pieces))), Kind::Iso, origin);
    let length = curve.length();
    if length <= tolerance.point { Err(zero(length).into()) } else { Ok(curve) }
}

impl LineFit<'_> {
    /// Point and derivatives of the line, from the given side.
    fn jet(&self, t: f64, side: OneSided) -> Jet {
        let (u, v) = self.line.at(t);
        match self.line {
            IsoLine::U(_) => {
                let jet = self.surface.jet_one_sided(u, v, (OneSided::After, side));
                Jet { p: jet.p, d1: jet.dv, d2: jet.dvv }
            }
            IsoLine::V(_) => {
                let jet = self.surface.jet_one_sided(u, v, (side, OneSided::After));
                Jet { p: jet.p, d1: jet.du, d2: jet.duu }
            }
        }
    }

    /// The cubic with the line's ends and derivatives.
    fn cubic(&self, a: f64, b: f64) -> Nurbs {
        let (from, to, h) = (self.jet(a, OneSided::After), self.jet(b, OneSided::Before), b - a);
        let poles = [from.p, from.p + from.d1 * (h / 3.0), to.p - to.d1 * (h / 3.0), to.p];
        Nurbs::bezier(a, b, poles.iter().map(|p| p.extend(1.0)).collect())
    }

    /// Whether the cubic is nowhere farther from the line than allowed.
    fn holds(&self, cubic: &Nurbs, a: f64, b: f64) -> bool {
        let mut open = vec![(a, b)];
        let mut seen = 0;
        while let Some((a, b)) = open.pop() {
            job::poll();
            let (middle, h) = (0.5 * (a + b), 0.5 * (b - a));
            let (f, c) = (self.jet(middle, OneSided::After), cubic.jet(middle));
            let (off, slope) = (f.p.distance(c.p), f.d1.distance(c.d1));
            // The second derivative of a cubic lies between those at the ends.
            let bend = self.bend(a, b) - Interval3::of([cubic.jet(a).d2, cubic.jet(b).d2]);
            let most = if bend.is_unbounded() { f64::INFINITY } else { off + h * slope + 0.5 * h * h * bend.reach() };
            if most <= self.allowed {
                continue;
            }
            seen += 1;
            if off > self.allowed || seen + open.len() > INTERVALS {
                return false;
            }
            open.push((middle, b));
            open.push((a, middle));
        }
        true
    }

    /// The range of the line's second derivative.
    fn bend(&self, a: f64, b: f64) -> Interval3 {
        match self.line {
            IsoLine::U(u) => self.surface.enclosure((u, u), (a, b)).dvv,
            IsoLine::V(v) => self.surface.enclosure((a, b), (v, v)).duu,
        }
    }
}
