//! Makes offsets of plane curves: exact lines and arcs where they are, else curves that follow their base.
//!
//! At a corner the offset goes round on the outer side, at the same distance everywhere, and is cut back to where
//! both sides meet on the inner one. An arc inside the curve that is no larger than the distance leaves nothing: what lies beside it meets
//! as at a corner.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::{Fault, LengthRange, Result, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::solve;
use crate::base::tolerance::{NEAREST, NUDGE, PARALLEL, Tolerance};
use crate::geometry::construct::build::{arc_center, direction, finite};
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::curves::offset::Offset;
use crate::geometry::data::kind::Kind;
use crate::geometry::query::intersect::{Hit, intersect};
use crate::geometry::shapes::arc::EllipticArc;

/// Samples of the curvature between two knots; the largest is refined.
const CURVATURE_SAMPLES: usize = 32;

/// Offset of a plane curve by `distance` to the left seen against the vector `normal`.
pub fn offset(curve: &Curve, distance: f64, normal: DVec3, origin: Origin) -> Result<Curve> {
    finite(DVec3::splat(distance), "distance", origin)?;
    let normal = direction(normal, "normal", "with a length", origin)?;
    check_plane(curve, normal)?;
    let plan = OffsetPlan { distance, normal, origin };
    let pieces = smooth_pieces(curve);
    let joined = plan.joined(&pieces).map_err(|fault| plan.with_largest(fault, &pieces))?;
    let shape = match joined.as_slice() {
        [one] => one.shape().clone(),
        _ => Shape::Composite(Arc::new(Composite::new(joined))),
    };
    Ok(Curve::new(shape, Kind::Offset, origin))
}

/// The curve must lie in a plane with this normal.
fn check_plane(curve: &Curve, normal: DVec3) -> Result<()> {
    if let Shape::Composite(c) = curve.shape() {
        return c.pieces.iter().try_for_each(|piece| check_plane(piece, normal));
    }
    let out = height_over(curve, normal);
    if out <= NUDGE * curve.bbox().diagonal() {
        return Ok(());
    }
    Err(ValueFault::NotItsPlane { argument: "normal", by: out }.into())
}

/// How far the curve may leave the plane through its start with this unit normal; its whole size where that is not known in closed form.
pub(crate) fn height_over(curve: &Curve, normal: DVec3) -> f64 {
    let start = curve.start();
    let high = |p: DVec3| (p - start).dot(normal).abs();
    match curve.shape() {
        Shape::Line(_, b) => high(*b),
        Shape::Arc(arc) => arc.u.dot(normal).abs().max(arc.v.dot(normal).abs()),
        Shape::Nurbs(c) => (0..c.poles.len()).map(|i| high(c.pole(i))).fold(0.0, f64::max),
        Shape::Helix(_) => curve.bbox().diagonal(),
        Shape::Offset(o) => o.normal.cross(normal).length() * curve.bbox().diagonal(),
        Shape::Composite(c) => c.pieces.iter().map(|piece| high(piece.start()) + height_over(piece, normal)).fold(0.0, f64::max),
    }
}

/// The curve cut at its corners; straight pieces as lines.
pub(crate) fn smooth_pieces(curve: &Curve) -> Vec<Curve> {
    if let Some(c) = curve.composite() {
        return c.pieces.iter().flat_map(smooth_pieces).collect();
    }
    let (a, b) = curve.domain();
    let mut cuts = vec![a];
    cuts.extend(curve.inner_corners().into_iter().filter(|t| {
        let (arriving, leaving) = curve.directions(*t);
        math::angle_between(arriving, leaving) > NUDGE
    }));
    cuts.push(b);
    let straight = matches!(curve.shape(), Shape::Nurbs(c) if c.degree == 1);
    let piece = |t0: f64, t1: f64| match straight {
        true => Curve::new(Shape::Line(curve.point(t0), curve.point(t1)), Kind::Line, curve.origin()),
        false => curve.part(t0, t1),
    };
    cuts.windows(2).map(|t| piece(t[0], t[1])).collect()
}

/// A piece and its offset.
struct OffsetSide {
    base: Curve,
    curve: Curve,
    /// Pieces that vanish lie between it and the next one.
    gap: bool,
}

/// What all pieces share.
struct OffsetPlan {
    distance: f64,
    normal: DVec3,
    origin: Origin,
}

/// Halvings in the search of the largest distance that works.
const HALVINGS: u32 = 32;
/// Digits of the largest distance that works.
const DIGITS: i32 = 3;

impl OffsetPlan {
    /// The offset in pieces.
    fn joined(&self, pieces: &[Curve]) -> Result<Vec<Curve>> {
        self.join(self.sides(pieces.to_vec())?)
    }

    /// The fault of a distance that is too large with one that works on its side, about the largest.
    fn with_largest(&self, fault: Fault, pieces: &[Curve]) -> Fault {
        let Some(ValueFault::LengthOutside { found, range, .. }) = fault.of() else { return fault };
        let works = |distance: f64| Self { distance, ..*self }.joined(pieces).is_ok();
        let (mut low, mut high) = (0.0, self.distance);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if works(middle) { low = middle } else { high = middle }
        }
        let step = math::pow(10.0, math::log10(low.abs()).floor() + 1.0 - f64::from(DIGITS));
        let most = (low / step).trunc() * step;
        if !(most.is_finite() && works(most)) {
            return fault;
        }
        ValueFault::OffsetTooFar { found: *found, range: range.clone(), most }.into()
    }

    fn too_far(&self, range: LengthRange) -> Fault {
        ValueFault::LengthOutside { argument: "distance", found: self.distance, range }.into()
    }

    /// The offsets of pieces in a row, without those that vanish between others.
    fn sides(&self, pieces: Vec<Curve>) -> Result<Vec<OffsetSide>> {
        let ends = (pieces.first().map(Curve::start), pieces.last().map(Curve::end));
        let size = pieces.iter().map(|piece| piece.bbox().diagonal()).fold(0.0, f64::max);
        let closed = ends.0.zip(ends.1).is_some_and(|(from, to)| from.distance(to) <= NEAREST * size);
        let vanishes: Vec<bool> = pieces.iter().map(|piece| self.vanishes(piece)).collect();
        let last = pieces.len() - 1;
        let gone = |k: usize| vanishes[k] && (closed || k > 0 && k < last);
        let kept: Vec<usize> = (0..pieces.len()).filter(|k| !gone(*k)).collect();
        if kept.len() < 2 {
            let whole = |base: Curve| Ok(OffsetSide { curve: self.smooth(&base)?, base, gap: false });
            return pieces.into_iter().map(whole).collect();
        }
        let gap = |n: usize| (kept[n] + 1) % pieces.len() != kept[(n + 1) % kept.len()] && (n + 1 < kept.len() || closed);
        let side = |n: usize| Ok(OffsetSide { base: pieces[kept[n]].clone(), curve: self.smooth(&pieces[kept[n]])?, gap: gap(n) });
        (0..kept.len()).map(side).collect()
    }

    /// Whether nothing is left of an arc of a circle at this distance.
    fn vanishes(&self, piece: &Curve) -> bool {
        matches!(piece.shape(), Shape::Arc(arc) if arc.radius.is_some() && self.rounded(arc).is_none())
    }

    /// Offset of a piece without corners.
    fn smooth(&self, piece: &Curve) -> Result<Curve> {
        let shape = match piece.shape() {
            Shape::Line(a, b) => {
                let by = self.normal.cross(*b - *a).normalize() * self.distance;
                Shape::Line(*a + by, *b + by)
            }
            Shape::Arc(arc) if arc.radius.is_some() => Shape::Arc(Box::new(self.round(arc)?)),
            Shape::Offset(inner) => {
                let turned = inner.normal.dot(self.normal).signum();
                let distance = inner.distance + turned * self.distance;
                return OffsetPlan { distance, normal: inner.normal, origin: self.origin }.smooth(&inner.base);
            }
            _ => {
                self.check_radius(piece)?;
                Shape::Offset(Box::new(Offset { base: piece.clone(), distance: self.distance, normal: self.normal }))
            }
        };
        Ok(Curve::new(shape, Kind::Offset, self.origin))
    }

    fn round(&self, arc: &EllipticArc) -> Result<EllipticArc> {
        self.rounded(arc).ok_or_else(|| self.too_far(LengthRange::BelowRadius(arc.u.length(), None)))
    }

    /// The arc at the distance; `None` where its radius is not above that.
    fn rounded(&self, arc: &EllipticArc) -> Option<EllipticArc> {
        let radius = arc.u.length();
        let turn = arc.u.cross(arc.v).dot(self.normal).signum();
        let new = radius - self.distance * turn;
        let scale = new / radius;
        (new > PARALLEL * radius).then(|| EllipticArc { u: arc.u * scale, v: arc.v * scale, radius: Some(new), ..*arc })
    }

    /// The base must not turn tighter than the offset is far, on its side.
    fn check_radius(&self, base: &Curve) -> Result<()> {
        let curvature = |t: f64| {
            let j = base.jet(t);
            self.distance.signum() * j.d1.cross(j.d2).dot(self.normal) / (j.d1.length_squared() * j.d1.length())
        };
        for span in base.knots().windows(2) {
            let (a, h) = (span[0], (span[1] - span[0]) / CURVATURE_SAMPLES as f64);
            // Inside the span, as the curvature may jump at its ends.
            let at = |i: usize| a + h * (i as f64 + 0.5);
            let most = (0..CURVATURE_SAMPLES).max_by(|i, j| curvature(at(*i)).total_cmp(&curvature(at(*j)))).unwrap_or(0);
            let t = solve::lowest((at(most) - h).max(span[0]), (at(most) + h).min(span[1]), NUDGE, |t| -curvature(t));
            let tightest = curvature(t).max(curvature(at(most)));
            if tightest * self.distance.abs() >= 1.0 {
                return Err(self.too_far(LengthRange::BelowRadius(1.0 / tightest, Some(base.point(t)))));
            }
        }
        Ok(())
    }

    /// Rounds or cuts the corners between neighbouring sides.
    fn join(&self, sides: Vec<OffsetSide>) -> Result<Vec<Curve>> {
        let n = sides.len();
        let size = sides.iter().map(|side| side.base.bbox().diagonal()).fold(self.distance.abs(), f64::max);
        let tolerance = Tolerance::new(NEAREST * size, size);
        let closed = n > 1 && (sides[n - 1].gap || sides[n - 1].base.end().distance(sides[0].base.start()) <= tolerance.point);
        let mut ranges: Vec<(f64, f64)> = sides.iter().map(|side| side.curve.domain()).collect();
        let mut corners: Vec<Option<Curve>> = vec![None; n];
        for i in 0..if closed { n } else { n - 1 } {
            let k = (i + 1) % n;
            let (here, next) = (&sides[i], &sides[k]);
            let corner = here.base.end();
            let (before, after) = (here.base.directions(here.base.domain().1).0, next.base.directions(next.base.domain().0).1);
            let turn = math::atan2(before.cross(after).dot(self.normal), before.dot(after));
            if !here.gap && turn.abs() <= NUDGE {
                continue;
            }
            if !here.gap && turn * self.distance < 0.0 {
                corners[i] = Some(arc_center(corner, here.curve.end(), turn, self.normal, self.origin)?);
                continue;
            }
            let meeting = self.inner_meeting(&here.curve, &next.curve, &tolerance)?;
            let Some((ta, tb)) = meeting else {
                return Err(self.too_far(LengthRange::MeetsAtCorner(corner)));
            };
            ranges[i].1 = ta;
            ranges[k].0 = tb;
        }
        let mut out = Vec::new();
        for ((OffsetSide { curve, .. }, range), corner) in sides.iter().zip(ranges).zip(corners) {
            if range.0 >= range.1 {
                return Err(self.too_far(LengthRange::LeavesOfSide(curve.start(), curve.end())));
            }
            out.push(curve.part(range.0, range.1));
            out.extend(corner);
        }
        Ok(out)
    }

    /// Where two neighbouring sides meet on the inner side of their corner: last on the first, first on the second.
    fn inner_meeting(&self, a: &Curve, b: &Curve, tolerance: &Tolerance) -> Result<Option<(f64, f64)>> {
        let hits = intersect(a, b, tolerance)?;
        Ok(hits.iter().rev().find_map(|hit| match hit {
            Hit::Point { ta, tb, .. } => Some((*ta, *tb)),
            Hit::Overlap { .. } => None,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::closest;
    use crate::geometry::construct::build::*;
    use crate::geometry::construct::fillet::rounded_polyline;

    fn square() -> Curve {
        let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        polyline(&points, true, Origin::NONE).unwrap()
    }

    #[test]
    fn corners_are_cut_inside_and_rounded_outside() {
        let inside = offset(&square(), 0.5, DVec3::Z, Origin::NONE).unwrap();
        assert!((inside.length() - 12.0).abs() < 1e-9, "{}", inside.length());
        let outside = offset(&square(), -0.5, DVec3::Z, Origin::NONE).unwrap();
        assert!((outside.length() - (16.0 + std::f64::consts::PI)).abs() < 1e-12);
        assert!(outside.start().distance(outside.end()) < 1e-15 && inside.start().distance(inside.end()) < 1e-9);
        let fault = offset(&square(), 2.5, DVec3::Z, Origin::NONE).unwrap_err();
        assert_eq!(fault.code().0, "E306");
    }

    #[test]
    fn arcs_that_vanish_leave_the_corners_of_the_sharp_contour() {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let round = |radius: f64| rounded_polyline(&corners, true, (radius, "round"), Origin::NONE).unwrap();
        for (radius, distance) in [(0.5, 0.8), (1.0, 1.0 + 1e-6), (0.3, 1.9)] {
            let inner = offset(&round(radius), distance, DVec3::Z, Origin::NONE).unwrap();
            assert!((inner.length() - 4.0 * (4.0 - 2.0 * distance)).abs() < 1e-9, "{radius} {distance}: {}", inner.length());
        }
        assert_eq!(offset(&round(0.5), 2.1, DVec3::Z, Origin::NONE).unwrap_err().code().0, "E306");
    }

    #[test]
    fn every_point_is_at_the_distance() {
        let points = [(0.0, 0.0), (1.0, 1.0), (3.0, 1.5), (4.0, 0.0), (6.0, 0.5)].map(|(x, y)| DVec3::new(x, 0.0, y));
        let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
        let base = spline(&points, &settings, Origin::NONE).unwrap();
        for distance in [0.2, -0.2] {
            let curve = offset(&base, distance, DVec3::Y, Origin::NONE).unwrap();
            let (a, b) = curve.domain();
            for i in 0..=50 {
                let t = a + (b - a) * f64::from(i) / 50.0;
                assert!((closest(&base, curve.point(t)).distance - 0.2).abs() < 1e-9, "{distance} {t}");
                let h = 1e-6;
                if i > 0 && i < 50 {
                    let slope = (curve.point(t + h) - curve.point(t - h)) / (2.0 * h);
                    assert!(slope.distance(curve.jet(t).d1) < 1e-6);
                    let bend = (curve.jet(t + h).d1 - curve.jet(t - h).d1) / (2.0 * h);
                    assert!(bend.distance(curve.jet(t).d2) < 1e-3 * (1.0 + bend.length()), "{bend} {}", curve.jet(t).d2);
                }
            }
            let back = offset(&curve, -distance, DVec3::Y, Origin::NONE).unwrap();
            assert!(back.point(0.5 * (a + b)).distance(base.point(0.5 * (a + b))) < 1e-14);
        }
        let fault = offset(&base, 5.0, DVec3::Y, Origin::NONE).unwrap_err();
        assert_eq!(fault.code().0, "E306");
        assert_eq!(offset(&base, 0.1, DVec3::Z, Origin::NONE).unwrap_err().code().0, "E306");
    }

    #[test]
    fn arcs_stay_arcs() {
        let arc = arc_center(DVec3::ZERO, DVec3::X * 3.0, 1.0, DVec3::Z, Origin::NONE).unwrap();
        let inner = offset(&arc, 1.0, DVec3::Z, Origin::NONE).unwrap();
        assert!((inner.length() - 2.0).abs() < 1e-15 && matches!(inner.shape(), Shape::Arc(_)));
        assert!((offset(&arc, 1.0, -DVec3::Z, Origin::NONE).unwrap().length() - 4.0).abs() < 1e-15);
        assert!(offset(&arc, 3.0, DVec3::Z, Origin::NONE).is_err());
    }
}
