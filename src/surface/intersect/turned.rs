//! Intersects a flat face with any face of revolution whose profile lies in a half plane through the axis: by the two sides of each
//! place of the profile.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::solve::bracketed;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::{Curve, Kind, Motion};
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::intersect::extrusions::{HalfSpace, directed, kept, sides, stops};
use crate::surface::intersect::planes::{Flat, Lines, on_both};
use crate::surface::intersect::turned_branch;
use crate::surface::intersect::turned_spans::{Found, Section};
use crate::surface::intersect::with_surfaces;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::between;
use crate::surface::shapes::sweep::Path;

/// A profile that leaves a half plane, or a plane that leaves the axis or the way across it, by this share of the tolerance is in it.
const WITHIN: f64 = 1.0 / 64.0;

/// A face of revolution.
struct Turned {
    profile: Chain,
    /// The profile in the frame of the axis: x away from it, z along it.
    meridian: Chain,
    about: DVec3,
    /// Unit direction of the axis, about which it is turned in the positive sense.
    axis: DVec3,
    /// Unit direction from the axis to the profile.
    reference: DVec3,
    /// The whole angle, radians.
    angle: f64,
    /// The largest distance from the axis.
    size: f64,
}

/// Returns the curves in which a flat face and a face of revolution meet, and the points where they only touch. Circles and copies of the
/// profile are exact, other curves are within a quarter of the tolerance.
///
/// Curves end at the borders of the face of revolution, and of the flat face where that is a parallelogram; loops are left to the caller.
/// `None` for other faces, for a profile that leaves the half plane through the axis, and for a plane that contains a piece of the face.
///
/// Faces know their loops in (u, v); one at most is unbounded. Fails where a curve that meets a plane does.
pub(crate) fn flat_and_turned(faces: [&Surface; 2], boxes: [Box3; 2], origin: Origin, tolerance: &Tolerance) -> Result<Option<Lines>> {
    for (flat, other) in [(0, 1), (1, 0)] {
        let Some(turned) = Turned::of(faces[other], tolerance)? else { continue };
        let Some(plane) = Flat::of(faces[flat], boxes[other]) else { continue };
        let Some(found) = turned.section(&plane, origin, tolerance)? else { return Ok(None) };
        let sides = sides(faces[flat], &plane);
        let mut lines = Lines { touches: on_both(found.touches, faces, tolerance), ..Lines::default() };
        for curve in found.curves {
            let chain = Chain::of_curve(&curve);
            let Some(intervals) = kept(&chain, &sides, tolerance)? else { return Ok(None) };
            for (from, to) in intervals {
                if (to - from) * chain.length() > tolerance.point {
                    lines.curves.push(directed(part(&chain, (from, to), origin, tolerance)?, faces, &plane, flat == 0));
                }
            }
        }
        return Ok(Some(lines));
    }
    Ok(None)
}

/// A part of a chain as a curve.
fn part(chain: &Chain, (from, to): (f64, f64), origin: Origin, tolerance: &Tolerance) -> Result<Curve> {
    let whole = (from, to) == (0.0, 1.0);
    Ok(if whole { chain.to_curve()? } else { chain.slice(from, to, tolerance)?.to_curve()? }.with_origin(origin))
}

impl Turned {
    fn of(face: &Surface, tolerance: &Tolerance) -> Result<Option<Self>> {
        let Shape::Sweep(sweep) = &face.parts().shape else { return Ok(None) };
        let (Rail::Chain { chain, map, .. }, Path::Turn { about, axis, angle }) = (sweep.profile(), sweep.path()) else { return Ok(None) };
        let (axis, angle) = (axis * angle.signum(), angle.abs());
        let profile = between(chain, map.value(0.0), map.value(1.0), tolerance)?;
        let out = |f: f64| (profile.point(f) - about).reject_from_normalized(axis);
        let farthest = [0.0, 0.5, 1.0].map(out).into_iter().fold(DVec3::ZERO, |a, b| if b.length() > a.length() { b } else { a });
        let Some(reference) = farthest.try_normalize() else { return Ok(None) };
        let frame = DMat3::from_cols(reference, axis.cross(reference), axis).transpose();
        let meridian = profile.moved(&Motion::rigid(frame, about, DVec3::ZERO));
        let bounds = meridian.bbox();
        if bounds.min.y.abs().max(bounds.max.y.abs()) > WITHIN * tolerance.point {
            return Ok(None);
        }
        Ok(Some(Self { profile, meridian, about, axis, reference, angle, size: bounds.max.x }))
    }

    /// Where the whole plane meets it, cut at its borders.
    fn section(&self, plane: &Flat, origin: Origin, tolerance: &Tolerance) -> Result<Option<Found<Curve, DVec3>>> {
        let level = plane.normal.dot(plane.p - self.about);
        let along = plane.normal.dot(self.axis);
        let across = plane.normal.reject_from_normalized(self.axis);
        let slope = across.length();
        if slope * self.size <= WITHIN * tolerance.point {
            return self.circles(level / along, origin, tolerance);
        }
        // A short vector has lost digits of its direction, and may lean along the axis.
        let Some(way) = (across / slope).reject_from_normalized(self.axis).try_normalize() else { return Ok(None) };
        if along.abs() * self.meridian.bbox().diagonal() + level.abs() <= WITHIN * tolerance.point {
            return self.copies(self.axis.cross(way), origin, tolerance);
        }
        let section = Section::new(self.meridian.clone(), (along, slope, level), tolerance);
        let Some(spans) = section.spans(tolerance)? else { return Ok(None) };
        let aside = self.axis.cross(way);
        let placed = |(s, y): (f64, f64)| {
            let (x, z) = section.across_and_along(s);
            self.about + self.axis * z + way * x + aside * y
        };
        let lost = |at: DVec3| CurveFault::NotConverged { of: origin, what: "the curve in which the surfaces meet".to_owned(), at }.into();
        let mut found = Found::default();
        for span in &spans.curves {
            for side in [1.0, -1.0] {
                let Some(cubics) = turned_branch::fitted(&section, span, side, &placed, &lost, tolerance)? else { return Ok(None) };
                let Some(curve) = with_surfaces::curve(&cubics, origin, tolerance)? else { continue };
                let chain = Chain::of_curve(&curve);
                let Some(intervals) = self.within_turn(&chain, tolerance)? else { return Ok(None) };
                for interval in intervals.into_iter().filter(|(from, to)| (to - from) * chain.length() > tolerance.point) {
                    found.curves.push(part(&chain, interval, origin, tolerance)?);
                }
            }
        }
        let touches = spans.touches.iter().map(|v| placed((section.place(*v).s, 0.0)));
        found.touches = touches.filter(|p| self.holds(*p, tolerance)).collect();
        Ok(Some(found))
    }

    /// The angle of a point from the profile, 0…2π.
    fn turn(&self, p: DVec3) -> f64 {
        let arm = p - self.about;
        math::atan2(self.axis.cross(self.reference).dot(arm), self.reference.dot(arm)).rem_euclid(TAU)
    }

    /// Whether a point is at an angle of the face, within the tolerance.
    fn holds(&self, p: DVec3, tolerance: &Tolerance) -> bool {
        let (turn, room) = (self.turn(p), tolerance.point / self.size);
        turn <= self.angle + room || turn >= TAU - room
    }

    /// The intervals of a chain between the first and the last place of the turn; those of a whole turn end at its seam. `None` where it runs
    /// along a border.
    fn within_turn(&self, chain: &Chain, tolerance: &Tolerance) -> Result<Option<Vec<(f64, f64)>>> {
        let is_whole = self.angle >= TAU * (1.0 - EPSILON);
        let mut cuts = vec![0.0, 1.0];
        let borders = [0.0, self.angle];
        for turn in &borders[..if is_whole { 1 } else { 2 }] {
            let (sine, cosine) = math::sin_cos(*turn);
            let (out, across) = (self.reference, self.axis.cross(self.reference));
            let (out, inward) = (out * cosine + across * sine, across * cosine - out * sine);
            let border = HalfSpace { inward, height: inward.dot(self.about) };
            match stops(chain, &border, tolerance)? {
                Some(all) => cuts.extend(all.into_iter().filter(|f| out.dot(chain.point(*f) - self.about) > -tolerance.point)),
                None if is_whole => {}
                None => return Ok(None),
            }
        }
        cuts.sort_by(f64::total_cmp);
        let holds = |w: &&[f64]| is_whole || self.turn(chain.point(0.5 * (w[0] + w[1]))) < self.angle;
        Ok(Some(cuts.windows(2).filter(|w| w[1] > w[0]).filter(holds).map(|w| (w[0], w[1])).collect()))
    }

    /// Circles, where the plane is across the axis at a height. `None` where the profile touches the plane or ends in it.
    fn circles(&self, height: f64, origin: Origin, tolerance: &Tolerance) -> Result<Option<Found<Curve, DVec3>>> {
        let Some(places) = stops(&self.meridian, &HalfSpace { inward: DVec3::Z, height }, tolerance)? else { return Ok(None) };
        let closed = self.meridian.is_closed(tolerance);
        let near = tolerance.point / self.meridian.length();
        let above = |v: f64| self.meridian.point(v.rem_euclid(1.0)).z > height;
        let mut found = Found::default();
        for (k, v) in places.iter().enumerate() {
            if !closed && (*v <= near || *v >= 1.0 - near) {
                return Ok(None);
            }
            let wrapped = |k: usize, turns: f64| if closed { places[k] + turns } else { 0.5 + 0.5 * turns };
            let before = if k == 0 { wrapped(places.len() - 1, -1.0) } else { places[k - 1] };
            let after = if k + 1 == places.len() { wrapped(0, 1.0) } else { places[k + 1] };
            let (low, high) = (0.5 * (before + v), 0.5 * (v + after));
            if above(low) == above(high) {
                return Ok(None);
            }
            let v = bracketed(low, high, EPSILON, |v| {
                let jet = self.meridian.jet(v.rem_euclid(1.0));
                (jet.p.z - height, jet.d1.z)
            });
            let radius = self.meridian.point(v.rem_euclid(1.0)).x;
            let center = self.about + self.axis * height;
            if radius <= tolerance.point {
                found.touches.push(center);
                continue;
            }
            let arc = EllipticArc::new(center, self.reference * radius, self.axis.cross(self.reference) * radius, self.angle);
            found.curves.push(Curve::new(CurveShape::Arc(Box::new(arc)), Kind::Meet, origin));
        }
        Ok(Some(found))
    }

    /// The profile on both sides of the axis, where the plane runs through the axis along a unit vector.
    fn copies(&self, along: DVec3, origin: Origin, tolerance: &Tolerance) -> Result<Option<Found<Curve, DVec3>>> {
        let mut found = Found::default();
        for way in [along, -along] {
            if self.holds(self.about + way * self.size, tolerance) {
                let turned = Motion::rotation(self.about, self.axis, self.turn(self.about + way));
                found.curves.push(self.profile.moved(&turned).to_curve()?.with_origin(origin));
            }
        }
        Ok(Some(found))
    }
}
