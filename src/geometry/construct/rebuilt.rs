//! Curves built from points, with their ends elsewhere.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::geometry::construct::build;
use crate::geometry::construct::build::{Ends, Spline};
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::kind::Kind;

impl Curve {
    /// Whether [`Curve::with_ends`] can build it anew: it is made from points and open.
    pub fn has_movable_ends(&self, tolerance: &Tolerance) -> bool {
        let kind = matches!(self.kind(), Kind::Line | Kind::Polyline | Kind::Spline | Kind::Bezier | Kind::Bspline | Kind::Nurbs);
        let shape = matches!(self.shape(), Shape::Line(..) | Shape::Nurbs(_));
        (kind && shape || self.through().is_some()) && !self.is_closed(tolerance)
    }

    /// The curve built anew with other ends: a spline interpolates again, an arc goes through the same inner point, of others
    /// the end points move.
    ///
    /// Kind and origin stay. A curve without movable ends stays as it is.
    pub fn with_ends(&self, start: DVec3, end: DVec3) -> Result<Self> {
        if let Some(through) = self.through() {
            return build::arc_through(start, end, through, self.origin());
        }
        match (self.kind(), self.shape()) {
            (Kind::Line, _) => build::line(start, end, self.origin()),
            (Kind::Spline, Shape::Nurbs(net)) => {
                // The points it interpolates stand at its distinct knots.
                let (first, last) = net.domain();
                let mut knots: Vec<f64> = net.knots.iter().copied().filter(|t| *t >= first && *t <= last).collect();
                knots.dedup();
                let mut points: Vec<DVec3> = knots.iter().map(|t| self.point(*t)).collect();
                if let [a, .., b] = points.as_mut_slice() {
                    (*a, *b) = (start, end);
                }
                let ends = |t: f64| {
                    let jet = self.jet(t);
                    let natural = jet.d2.length() <= PARALLEL * jet.d1.length_squared() / self.length();
                    if natural { Ends::Natural } else { Ends::Clamped(jet.d1) }
                };
                build::spline(&points, &Spline { start: ends(first), end: ends(last), closed: false }, self.origin())
            }
            (Kind::Polyline | Kind::Bezier | Kind::Bspline | Kind::Nurbs, Shape::Nurbs(net)) => {
                let mut net = net.as_ref().clone();
                if let [a, .., b] = net.poles.as_mut_slice() {
                    *a = (start * a.w).extend(a.w);
                    *b = (end * b.w).extend(b.w);
                }
                Ok(Self::new(Shape::Nurbs(Arc::new(net)), self.kind(), self.origin()))
            }
            _ => Ok(self.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;

    #[test]
    fn an_arc_through_three_points_keeps_its_inner_point() {
        let (a, b, through) = (DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.5, 0.6, 0.0));
        let tolerance = Tolerance::new(1e-6, 1.0);
        let arc = build::arc_through(a, b, through, Origin::NONE).unwrap();
        for curve in [arc.clone(), arc.reversed(), arc.with_origin(Origin(3))] {
            assert!(curve.has_movable_ends(&tolerance));
            let moved = curve.with_ends(curve.start() + DVec3::Y * 0.01, curve.end()).unwrap();
            assert!(moved.start().distance(curve.start() + DVec3::Y * 0.01) < 1e-15 && moved.end().distance(curve.end()) < 1e-12);
            assert!(crate::geometry::query::closest::closest(&moved, through).distance < 1e-12);
        }
        let about = build::arc_center(DVec3::ZERO, DVec3::X, 1.0, DVec3::Z, Origin::NONE).unwrap();
        assert!(!about.has_movable_ends(&tolerance) && !arc.part(0.0, 0.5).has_movable_ends(&tolerance));
    }

    #[test]
    fn a_spline_interpolates_again() {
        let points = [DVec3::ZERO, DVec3::new(1.0, 0.5, 0.0), DVec3::new(2.0, 0.0, 0.0)];
        let natural = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
        let curve = build::spline(&points, &natural, Origin::NONE).unwrap();
        let end = DVec3::new(2.0, 0.001, 0.0);
        let moved = curve.with_ends(points[0], end).unwrap();
        let wanted = build::spline(&[points[0], points[1], end], &natural, Origin::NONE).unwrap();
        for k in 0..=10 {
            let at = |c: &Curve| c.point(c.param_at_length(c.length() * f64::from(k) / 10.0));
            assert!(at(&moved).distance(at(&wanted)) < 1e-12, "{k}");
        }
    }
}
