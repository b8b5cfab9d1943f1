//! Intersects a flat face with a sphere, a cylinder or a cone of revolution in closed form: circles and ellipses.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::{Curve, Kind};
use crate::network::Chain;
use crate::surface::analysis::elementary::Form;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::intersect::extrusions::{HalfSpace, directed, kept, sides, stops};
use crate::surface::intersect::planes::{Flat, Lines, on_both};
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::between;
use crate::surface::shapes::sweep::Path;

/// Nearer than so many tolerances to a plane that only touches, a section is left to the search.
const TOUCHING: f64 = 16.0;
/// Sine of the least angle between a plane and the lines of a cone that it cuts in an ellipse.
const LEAST_SINE: f64 = 1.0 / 1024.0;

/// A face of revolution whose plane sections are ellipses.
struct Revolved {
    form: Form,
    about: DVec3,
    /// Unit direction of the axis, about which it is turned in the positive sense.
    axis: DVec3,
    /// Unit direction from the axis to where it begins.
    reference: DVec3,
    /// What bounds it: planes across its axis, first, and through it.
    spaces: Vec<HalfSpace>,
    ends: usize,
}

/// Returns the curves in which the plane of a flat face meets a sphere, a cylinder or a cone, cut at parallelograms and at the borders of the
/// face of revolution but not at loops, and points where they touch. `None` for other faces, planes along the lines of the face, and what
/// nearly touches.
///
/// Faces know their loops in (u, v); one at most is unbounded. Fails where a curve that meets a plane does.
pub(crate) fn flat_and_revolved(faces: [&Surface; 2], boxes: [Box3; 2], origin: Origin, tolerance: &Tolerance) -> Result<Option<Lines>> {
    for (flat, other) in [(0, 1), (1, 0)] {
        let Some(revolved) = Revolved::of(faces[other], tolerance)? else { continue };
        let Some(plane) = Flat::of(faces[flat], boxes[other]) else { continue };
        let Some(whole) = revolved.section(&plane, boxes[other].diagonal(), tolerance) else { return Ok(None) };
        let mut found = Lines::default();
        let Some(arc) = whole else { return Ok(Some(found)) };
        let curve = Curve::new(CurveShape::Arc(Box::new(revolved.begun(arc, tolerance))), Kind::Meet, origin);
        let chain = Chain::of_curve(&curve);
        let ends = revolved.ends;
        let spaces: Vec<HalfSpace> = revolved.spaces.into_iter().chain(sides(faces[flat], &plane)).collect();
        let Some(intervals) = kept(&chain, &spaces, tolerance)? else { return Ok(None) };
        for (from, to) in &intervals {
            let whole = (*from, *to) == (0.0, 1.0);
            let part = if whole { curve.clone() } else { chain.slice(*from, *to, tolerance)?.to_curve()?.with_origin(origin) };
            if part.length() > tolerance.point {
                found.curves.push(directed(part, faces, &plane, flat == 0));
            }
        }
        let near = tolerance.point / chain.length();
        let lone = |f: &f64| !intervals.iter().any(|(from, to)| (from - near..=to + near).contains(f));
        for end in &spaces[..ends] {
            let Some(stops) = stops(&chain, end, tolerance)? else { return Ok(None) };
            found.touches.extend(stops.iter().filter(|f| lone(f)).map(|f| chain.point(*f)));
        }
        found.touches = on_both(found.touches, faces, tolerance);
        return Ok(Some(found));
    }
    Ok(None)
}

impl Revolved {
    fn of(face: &Surface, tolerance: &Tolerance) -> Result<Option<Self>> {
        let Shape::Sweep(sweep) = &face.parts().shape else { return Ok(None) };
        let (Rail::Chain { chain, map, .. }, Path::Turn { about, axis, angle }) = (sweep.profile(), sweep.path()) else { return Ok(None) };
        let Some(found) = face.elementary((0.0, 1.0), tolerance) else { return Ok(None) };
        if !matches!(found.form, Form::Sphere { .. } | Form::Cylinder { .. } | Form::Cone { .. }) {
            return Ok(None);
        }
        let (axis, angle, reference) = (axis * angle.signum(), angle.abs(), found.reference);
        let profile = between(chain, map.value(0.0), map.value(1.0), tolerance)?;
        let height = |p: DVec3| axis.dot(p - about);
        let radius = |p: DVec3| (p - about).reject_from_normalized(axis).length();
        let (p, q) = (profile.start(), profile.end());
        let mut spaces = Vec::new();
        for (end, other) in [(p, q), (q, p)] {
            if radius(end) > tolerance.point {
                let inward = if height(other) > height(end) { axis } else { -axis };
                spaces.push(HalfSpace { inward, height: inward.dot(end) });
            }
        }
        let ends = spaces.len();
        if angle < TAU * (1.0 - EPSILON) {
            if angle > PI {
                return Ok(None);
            }
            let (sine, cosine) = math::sin_cos(angle);
            let across = axis.cross(reference);
            for inward in [across, reference * sine - across * cosine] {
                spaces.push(HalfSpace { inward, height: inward.dot(about) });
            }
        }
        Ok(Some(Self { form: found.form, about, axis, reference, spaces, ends }))
    }

    /// The section of the whole form, which a plane may also miss; `None` where it has no ellipse or nearly touches. `size` is how far the
    /// face reaches.
    fn section(&self, plane: &Flat, size: f64, tolerance: &Tolerance) -> Option<Option<EllipticArc>> {
        let (n, near) = (plane.normal, TOUCHING * tolerance.point);
        match &self.form {
            Form::Sphere { axis, radius } => {
                let off = n.dot(axis.about - plane.p);
                if off.abs() > radius + tolerance.point {
                    return Some(None);
                }
                if radius - off.abs() <= near {
                    return None;
                }
                // The radius of the circle, without a difference of squares.
                let reach = ((radius - off) * (radius + off)).sqrt();
                let u = n.any_orthonormal_vector() * reach;
                Some(Some(EllipticArc::new(axis.about - n * off, u, n.cross(u), TAU)))
            }
            Form::Cylinder { axis, radius } => {
                let (k, rise) = (axis.direction, n.dot(axis.direction));
                if rise.abs() * size <= near {
                    return None;
                }
                let onto = |v: DVec3| v - k * (n.dot(v) / rise);
                let across = k.any_orthonormal_vector();
                let center = axis.about - k * (n.dot(axis.about - plane.p) / rise);
                Some(Some(EllipticArc::new(center, onto(across) * *radius, onto(k.cross(across)) * *radius, TAU)))
            }
            Form::Cone { axis, radius, angle } => {
                let (sine, cosine) = math::sin_cos(*angle);
                let k = axis.direction;
                let apex = axis.about - k * (radius * cosine / sine);
                let (rise, across) = (n.dot(k), n.reject_from_normalized(k));
                if rise.abs() * cosine - across.length() * sine <= LEAST_SINE {
                    return None;
                }
                let height = n.dot(plane.p - apex);
                if height.abs() <= near {
                    return None;
                }
                if height * rise < 0.0 {
                    return Some(None);
                }
                let way = square_way(across, k);
                let on_line = |side: f64| {
                    let line = k * cosine + way * (side * sine);
                    apex + line * (height / n.dot(line))
                };
                let (first, last) = (on_line(1.0), on_line(-1.0));
                let center = first.midpoint(last);
                // Across the plane of symmetry the ellipse is as wide as the cone at the height of its middle.
                let wide = k.dot(center - apex) * sine / cosine;
                let off = (center - apex).reject_from_normalized(k).length();
                let half = ((wide - off) * (wide + off)).sqrt();
                Some(Some(EllipticArc::new(center, (first - last) * 0.5, k.cross(way) * half, TAU)))
            }
            Form::Plane { .. } | Form::Torus { .. } => None,
        }
    }

    /// An ellipse begun where it passes the begin of the face or a pole, if it does.
    fn begun(&self, arc: EllipticArc, tolerance: &Tolerance) -> EllipticArc {
        let across = self.axis.cross(self.reference);
        let (a, b, c) = (across.dot(arc.u), across.dot(arc.v), across.dot(self.about - arc.center));
        let reach = math::hypot(a, b);
        if c.abs() >= reach {
            return arc;
        }
        let (first, half) = (math::atan2(b, a), math::acos(c / reach));
        let places = [first - half, first + half];
        let here = |t: &f64| self.reference.dot(arc.jet(*t).p - self.about) > -tolerance.point;
        places.into_iter().find(here).map_or(arc, |t| EllipticArc { sweep: TAU, ..arc.part(t, t + TAU) })
    }
}

/// The unit vector of what of a plane's normal is across an axis; any one where that is rounding, as of a plane square to it.
fn square_way(across: DVec3, axis: DVec3) -> DVec3 {
    if across.length() <= EPSILON {
        return axis.any_orthonormal_vector();
    }
    // A short vector has lost digits of its direction, and may lean along the axis.
    across.normalize().reject_from_normalized(axis).try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector())
}
