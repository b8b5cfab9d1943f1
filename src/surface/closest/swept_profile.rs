//! Nearest points of swept surfaces: one of a profile extruded or turned about an axis is that of its profile, seen along
//! the way. Curves find theirs by bounds, so that no other sheet of the surface is taken however near it lies.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::base::math::atan2;
use crate::base::tolerance::ROUNDING_SHARE;
use crate::geometry::Curve;
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::query::closest::closest as closest_on_curve;
use crate::geometry::shapes::nurbs::projected;
use crate::network::{Chain, Run};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::shapes::sweep::Path;

/// The profile of a swept surface, where the nearest point of the surface follows from the nearest one of a plane curve.
#[derive(Clone, Debug)]
pub(crate) struct SweptProfile {
    chain: Chain,
    way: SweptWay,
    /// v runs against the profile.
    is_flipped: bool,
}

#[derive(Clone, Debug)]
enum SweptWay {
    /// Along a vector: each run's curve as it is seen along it, all in the plane through the origin.
    Straight { by: DVec3, direction: DVec3, seen: Vec<Curve>, is_across: bool },
    /// About an axis: the profile lies in the half plane from the axis along the unit vector `out`.
    Turn { about: DVec3, axis: DVec3, out: DVec3, angle: f64 },
}

impl SweptProfile {
    /// The profile of an untrimmed surface; `None` where it is not swept, or its profile is not seen as a plane curve of simple kind.
    pub fn of(whole: &Surface) -> Option<Self> {
        let Shape::Sweep(sweep) = &whole.parts().shape else { return None };
        let chain = sweep.profile().chain()?.clone();
        let way = match sweep.path() {
            Path::Straight { by } => {
                let direction = by.normalize();
                let whole = |run: &Run| run.s0.min(run.s1) <= 0.0 && run.s0.max(run.s1) >= run.curve.length();
                if !chain.runs().iter().all(whole) {
                    return None;
                }
                let seen = chain.runs().iter().map(|run| projected_along(&run.curve, direction)).collect::<Option<Vec<Curve>>>()?;
                let heights = || framing(&chain).into_iter().flatten().map(|p| (p - chain.start()).dot(direction).abs());
                let is_across = heights().fold(0.0, f64::max) <= ROUNDING_SHARE * chain.bbox().diagonal();
                SweptWay::Straight { by, direction, seen, is_across }
            }
            Path::Turn { about, axis, angle } => SweptWay::Turn { about, axis, out: half_plane(&chain, about, axis)?, angle },
        };
        Some(Self { chain, way, is_flipped: whole.parts().flipped })
    }

    /// (u, v) of the nearest point; `None` where the surface ends before the plane that holds the point.
    pub fn at(&self, p: DVec3) -> Option<(f64, f64)> {
        let (u, v) = self.along_profile(p)?;
        Some((u, if self.is_flipped { 1.0 - v } else { v }))
    }

    /// The same with v as the profile's fraction.
    fn along_profile(&self, p: DVec3) -> Option<(f64, f64)> {
        match &self.way {
            SweptWay::Straight { by, direction, seen, is_across } => {
                let (v, foot) = self.nearest_seen(seen, p - *direction * direction.dot(p));
                let u = (p - foot).dot(*by) / by.length_squared();
                (*is_across || (0.0..=1.0).contains(&u)).then(|| (u.clamp(0.0, 1.0), v))
            }
            SweptWay::Turn { about, axis, out, angle } => {
                let arm = p - *about;
                let along = *axis * axis.dot(arm);
                let (x, y) = (arm.dot(*out), arm.dot(axis.cross(*out)));
                let radius = (x * x + y * y).sqrt();
                let turn = if radius > 0.0 { atan2(y, x) * angle.signum() } else { 0.0 };
                let u = if turn < 0.0 { turn + TAU } else { turn } / angle.abs();
                let is_whole = angle.abs() == TAU;
                if !is_whole && u > 1.0 {
                    return None;
                }
                let v = self.chain.closest(*about + along + *out * radius).0;
                // A point on the seam is at its start.
                Some((if is_whole && u >= 1.0 - ROUNDING_SHARE { 0.0 } else { u }, v))
            }
        }
    }

    /// Fraction and point of the profile whose image is nearest to a point of the plane.
    fn nearest_seen(&self, seen: &[Curve], q: DVec3) -> (f64, DVec3) {
        let mut best = (0.0, self.chain.start(), f64::INFINITY);
        for (k, (run, seen)) in self.chain.runs().iter().zip(seen).enumerate() {
            let found = closest_on_curve(seen, q);
            if found.distance < best.2 {
                best = (self.chain.fraction(k, run.curve.length_at(found.t)), run.curve.point(found.t), found.distance);
            }
        }
        (best.0, best.1)
    }
}

/// The projection of a curve along a unit direction into the plane through the origin, with its own parameter; `None` where that is no
/// curve of the same kind.
fn projected_along(curve: &Curve, direction: DVec3) -> Option<Curve> {
    let flat = |p: DVec3| p - direction * direction.dot(p);
    curve.mapped(flat, flat)
}

/// Points in whose planes and lines the curves of a chain lie: control points, ends, and those of the frames of arcs.
fn framing(chain: &Chain) -> Option<Vec<DVec3>> {
    let mut points = Vec::new();
    for run in chain.runs() {
        match run.curve.shape() {
            CurveShape::Line(a, b) => points.extend([*a, *b]),
            CurveShape::Arc(arc) => points.extend([arc.center, arc.center + arc.u, arc.center + arc.v]),
            CurveShape::Nurbs(c) => points.extend(c.poles.iter().map(|q| projected(*q))),
            _ => return None,
        }
    }
    Some(points)
}

/// The unit vector from the axis along the half plane that a profile lies in, which keeps clear of the axis but for its ends.
fn half_plane(chain: &Chain, about: DVec3, axis: DVec3) -> Option<DVec3> {
    let arm = |p: DVec3| (p - about).reject_from_normalized(axis);
    let places = [0.0, 0.25, 0.5, 0.75, 1.0].map(|f| arm(chain.point(f)));
    let farthest = places.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
    let out = farthest.try_normalize()?;
    let across = axis.cross(out);
    let framing = framing(chain)?;
    let size = framing.iter().map(|p| arm(*p).length()).fold(0.0, f64::max);
    framing.iter().all(|p| arm(*p).dot(across).abs() <= ROUNDING_SHARE * size).then_some(out)
}
