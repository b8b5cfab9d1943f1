//! Corners of curves, and the checks of a curve that need a tolerance.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::tolerance::{CUSP, NUDGE, Tolerance};
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::fault::CurveFault;
use crate::geometry::data::kind::Kind;

impl Curve {
    /// Directions (any length) in which the curve arrives at and leaves a parameter; at an end both are the same.
    pub fn directions(&self, t: f64) -> (DVec3, DVec3) {
        let (a, b) = self.domain();
        let least = CUSP * self.bbox().diagonal() / (b - a);
        let nudge = NUDGE * (b - a);
        let (before, after) = (self.jet_before(t), self.jet(t));
        let arriving = if before.d1.length() > least { before.d1 } else { self.point(t) - self.point((t - nudge).max(a)) };
        let leaving = if after.d1.length() > least { after.d1 } else { self.point((t + nudge).min(b)) - self.point(t) };
        match (t <= a, t >= b) {
            (true, _) => (leaving, leaving),
            (_, true) => (arriving, arriving),
            _ => (arriving, leaving),
        }
    }

    /// Parameters inside the domain where the direction jumps by more than the tolerance's angle, ascending;
    /// for a closed curve with a corner at its start the domain's first parameter is among them.
    pub fn kinks(&self, tolerance: &Tolerance) -> Vec<f64> {
        let (a, b) = self.domain();
        let mut kinks = self.inner_corners();
        kinks.retain(|t| {
            let (arriving, leaving) = self.directions(*t);
            tolerance.is_kink(arriving, leaving)
        });
        if self.is_closed(tolerance) && tolerance.is_kink(self.directions(b).1, self.directions(a).0) {
            kinks.insert(0, a);
        }
        kinks
    }

    /// Parameters strictly inside the domain where the direction may jump, ascending.
    pub(crate) fn inner_corners(&self) -> Vec<f64> {
        let (a, b) = self.domain();
        let mut corners = match self.shape() {
            Shape::Nurbs(c) => {
                let full = c.breaks().into_iter().filter(|(_, times)| *times >= c.degree).map(|(t, _)| t);
                let mut corners: Vec<f64> = full.collect();
                if c.degree > 1 {
                    corners.extend(&self.lengths().cusps);
                }
                corners
            }
            Shape::Composite(c) => {
                let inner = c.pieces.iter().enumerate().flat_map(|(i, p)| p.inner_corners().into_iter().map(move |t| (i, t)));
                inner.map(|(i, t)| c.common(i, t)).chain(c.breaks.iter().copied()).collect()
            }
            Shape::Line(..) | Shape::Arc(_) | Shape::Helix(_) | Shape::Offset(_) => Vec::new(),
        };
        corners.retain(|t| a < *t && *t < b);
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        corners
    }

    /// Checks that need a tolerance: length (E401), neighbouring points that are one (E403), accuracy of the length (E410).
    pub fn check(&self, tolerance: &Tolerance) -> Result<()> {
        if let Shape::Composite(c) = self.shape() {
            return c.pieces.iter().try_for_each(|piece| piece.check(tolerance));
        }
        let length = self.length();
        if length <= tolerance.point {
            return Err(CurveFault::ZeroLength { of: self.origin(), length, tolerance: tolerance.point }.into());
        }
        if let (Kind::Polyline | Kind::Spline, Shape::Nurbs(c)) = (self.kind(), self.shape()) {
            let points: Vec<DVec3> = c.breaks().into_iter().map(|(t, _)| self.point(t)).collect();
            if let Some(i) = points.windows(2).position(|p| tolerance.same_point(p[0], p[1])) {
                let (at, distance) = (points[i], points[i].distance(points[i + 1]));
                let (count, tolerance) = (points.len(), tolerance.point);
                return Err(CurveFault::DuplicatePoints { of: self.origin(), index: i, count, at, distance, tolerance }.into());
            }
        }
        match self.shape() {
            Shape::Nurbs(_) | Shape::Offset(_) => match self.lengths().stalled {
                Some(t) => Err(CurveFault::LengthStalled { of: self.origin(), t, at: self.point(t) }.into()),
                None => Ok(()),
            },
            _ => Ok(()),
        }
    }
}
