//! Surfaces of revolution: a whole turn of a curve, of one that crosses the axis the part beside which the face lies.

use glam::DVec3;

use super::conics::Endless;
use super::curves::Course;
use super::reader::Step;
use crate::base::math;
use crate::base::tolerance::PARALLEL;
use crate::geometry::{Curve, build};
use crate::io::cad::base::{BEYOND, Base};
use crate::io::cad::damage::{Damage, damage};
use crate::io::cad::face_loops::FaceLoops;
use crate::surface::revolve::Axis;

const TURN: f64 = std::f64::consts::TAU;
/// Steps along a conic between which it crosses the axis at most once.
const STEPS: usize = 64;
/// Where a closed conic is looked along from: no place where files let curves cross an axis.
const FIRST: f64 = 0.0137 * TURN;
/// Halvings of a step that has a crossing.
const HALVINGS: usize = 60;

impl Step<'_> {
    /// A curve turned about an axis.
    pub fn revolved(&mut self, of: &Course, axis: &Axis, loops: &FaceLoops) -> Result<Base, Damage> {
        let profile = match of {
            Course::Endless(Endless::Line(p, d)) => self.turned_line((*p, *d), axis, loops)?,
            Course::Endless(conic) => self.turned_conic(conic, axis, loops)?,
            Course::Bounded(curve) => curve.clone(),
        };
        Ok(Base::Turned { axis: *axis, profile, angles: (0.0, TURN), first: None })
    }

    /// The stretch of a line that is turned: a little longer than what lies on it. One that meets the axis makes two cones; the one beside
    /// the box is meant, up to its apex where the loops run round it.
    fn turned_line(&self, (p, d): (DVec3, DVec3), axis: &Axis, loops: &FaceLoops) -> Result<Curve, Damage> {
        let d = math::unit(d, 0.0).ok_or_else(|| damage("its line has no direction"))?;
        let rise = d.dot(axis.direction);
        if rise.abs() <= PARALLEL {
            return Err(damage("its line turns in a plane without end"));
        }
        if loops.reach.is_empty() {
            return Err(damage("its line has no ends"));
        }
        let (low, high) = loops.reach.stretch(axis.about, axis.direction);
        let room = BEYOND * (high - low).max(loops.reach.diagonal() * BEYOND);
        let at = |h: f64| (h - (p - axis.about).dot(axis.direction)) / rise;
        let (a, b) = (at(low - room), at(high + room));
        let (mut a, mut b) = (a.min(b), a.max(b));
        let (foot, across) = ((p - axis.about).reject_from_normalized(axis.direction), d.reject_from_normalized(axis.direction));
        let meets = -foot.dot(across) / across.length_squared();
        if meets.is_finite() && (foot + across * meets).length() <= self.tolerance.rounding {
            let is_inside = a < meets && meets < b;
            if is_inside || loops.wind_about(axis) {
                if 0.5 * (a + b) > meets { a = meets } else { b = meets }
            }
        }
        Ok(build::line(p + d * a, p + d * b, self.origin)?)
    }

    /// The stretch of a conic that is turned: all of it near what lies on it or, of one that crosses the axis, the part that the loops
    /// lie beside. Of several parts beside which they lie the one along which a loop runs is meant, else the one that runs up the axis, so
    /// that the normals point away from it.
    fn turned_conic(&self, conic: &Endless, axis: &Axis, loops: &FaceLoops) -> Result<Curve, Damage> {
        let (a, b) = if conic.closes() { (FIRST, FIRST + TURN) } else { Self::range(conic, &loops.reach) };
        let side = farthest(conic, (a, b), axis);
        let crossings = self.crossings(conic, (a, b), (axis, side));
        let (Some(first), Some(last)) = (crossings.first(), crossings.last()) else {
            return if conic.closes() { conic.part(0.0, TURN, self.origin) } else { conic.part(a, b, self.origin) };
        };
        let mut parts: Vec<(f64, f64)> = crossings.windows(2).map(|w| (w[0], w[1])).collect();
        if conic.closes() {
            parts.push((*last, first + TURN));
        } else {
            parts.extend([(a, *first), (*last, b)]);
        }
        // Distance of a point from a part, as it is and turned into the plane of the conic on either side of the axis.
        let off = |p: DVec3, part: (f64, f64)| {
            let t = conic.parameter(p);
            let t = if conic.closes() && t < part.0 { t + TURN } else { t };
            conic.point(t.clamp(part.0, part.1)).distance(p)
        };
        let turned = |p: DVec3, part: (f64, f64)| {
            let along = axis.direction * (p - axis.about).dot(axis.direction);
            let out = (p - axis.about).reject_from_normalized(axis.direction).length();
            off(axis.about + along + side * out, part).min(off(axis.about + along - side * out, part))
        };
        let (slack, points) = (self.slack(), loops.points().collect::<Vec<DVec3>>());
        let rate = |part: &(f64, f64)| {
            let (mut sum, mut beside) = (0.0, 0);
            for &p in &points {
                sum += turned(p, *part);
                beside += usize::from(off(p, *part) <= slack);
            }
            (sum, beside, *part)
        };
        let rated: Vec<(f64, usize, (f64, f64))> = parts.iter().map(rate).collect();
        let least = rated.iter().map(|r| r.0).fold(f64::INFINITY, f64::min);
        let room = slack * points.len() as f64;
        let runs_up = |part: (f64, f64)| (conic.point(part.1) - conic.point(part.0)).dot(axis.direction) > 0.0;
        let best = rated.iter().rev().filter(|r| r.0 <= least + room).max_by_key(|r| (r.1, runs_up(r.2)));
        let (t0, t1) = best.map_or((a, b), |r| r.2);
        conic.part(t0, t1, self.origin)
    }

    /// Parameters at which a conic crosses an axis that lies in its plane, ascending; `side` points from the axis into that plane.
    fn crossings(&self, conic: &Endless, range: (f64, f64), (axis, side): (&Axis, DVec3)) -> Vec<f64> {
        let height = |t: f64| (conic.point(t) - axis.about).dot(side);
        let mut found = Vec::new();
        for w in places(range).collect::<Vec<f64>>().windows(2) {
            let (mut low, mut high) = (w[0], w[1]);
            let is_up = height(low) >= 0.0;
            if is_up == (height(high) >= 0.0) {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if (height(middle) >= 0.0) == is_up { low = middle } else { high = middle }
            }
            let at = conic.point(high) - axis.about;
            if at.reject_from_normalized(axis.direction).length() <= self.slack() {
                found.push(high);
            }
        }
        found
    }
}

/// Places along a conic, its ends included.
fn places((a, b): (f64, f64)) -> impl Iterator<Item = f64> {
    (0..=STEPS).map(move |k| a + (b - a) * k as f64 / STEPS as f64)
}

/// Unit vector from an axis to where a conic is farthest from it.
fn farthest(conic: &Endless, range: (f64, f64), axis: &Axis) -> DVec3 {
    let out = |t: f64| (conic.point(t) - axis.about).reject_from_normalized(axis.direction);
    let most = places(range).map(out).fold(DVec3::ZERO, |most, v| if v.length() > most.length() { v } else { most });
    most.normalize_or_zero()
}
