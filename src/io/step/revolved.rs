//! Surfaces of revolution: a whole turn of a curve, of a line or conic without ends the stretch beside which the face lies.

use glam::DVec3;

use crate::base::math;
use crate::base::tolerance::PARALLEL;
use crate::geometry::Curve;
use crate::geometry::construct::build;
use crate::io::cad::base_surface::{BEYOND, Base};
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face::Face;
use crate::io::cad::face_loops::FaceLoops;
use crate::io::cad::revolution_profile::Clear;
use crate::io::step::conics::Endless;
use crate::io::step::curves::Course;
use crate::io::step::reader::Step;
use crate::surface::swept::revolve::Axis;

const TURN: f64 = std::f64::consts::TAU;

impl Step<'_> {
    /// A curve turned about an axis, the surface #`k`.
    pub fn revolved(&mut self, k: u32, of: &Course, axis: &Axis, loops: &FaceLoops) -> Result<Base, Defect> {
        let profile = match of {
            Course::Endless(Endless::Line(p, d)) => self.turned_line((*p, *d), axis, loops)?,
            Course::Endless(conic) if conic.closes() => conic.part(0.0, TURN, self.origin)?,
            Course::Endless(conic) => self.turned_conic(conic, axis, loops)?,
            Course::Bounded(curve) => curve.clone(),
        };
        self.clear_of_axis(k, Base::Turned { axis: *axis, profile, angles: (0.0, TURN), first: None }, loops)
    }

    /// The surface #`k`, of a profile that crosses its axis the part that is meant; a guess is reported.
    pub fn clear_of_axis(&mut self, k: u32, base: Base, loops: &FaceLoops) -> Result<Base, Defect> {
        let Clear { base, also, doubt } = base.clear_of_axis(loops, self.slack(), &self.tolerance)?;
        if let Some(doubt) = doubt {
            self.warn(k, doubt);
        }
        self.also = also;
        Ok(base)
    }

    /// All of a surface that nothing bounds, made in the reach of `around`.
    pub fn whole(&mut self, base: &Base, around: &FaceLoops) -> Result<Face, Defect> {
        let surface = base.surface(&base.reach(around), self.origin, &self.tolerance)?;
        let mut face = Face::whole(base, surface, &self.tolerance);
        for other in std::mem::take(&mut self.also) {
            face.also.push(other.surface(&other.reach(around), self.origin, &self.tolerance)?);
        }
        Ok(face)
    }

    /// The part of a line that is turned: a little longer than what lies on it. One that meets the axis makes two cones; the one beside
    /// the box is meant, up to its apex where the loops run round it.
    fn turned_line(&self, (p, d): (DVec3, DVec3), axis: &Axis, loops: &FaceLoops) -> Result<Curve, Defect> {
        let d = math::unit(d, 0.0).ok_or_else(|| defect("its line has no direction"))?;
        let rise = d.dot(axis.direction);
        if rise.abs() <= PARALLEL {
            return Err(defect("its line turns in an infinite plane"));
        }
        if loops.reach.is_empty() {
            return Err(defect("its line has no ends"));
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

    /// The part of a conic without ends that is turned: a little longer than what lies on it.
    fn turned_conic(&self, conic: &Endless, axis: &Axis, loops: &FaceLoops) -> Result<Curve, Defect> {
        if loops.reach.is_empty() {
            return Err(defect("its conic has no ends"));
        }
        let out = |p: DVec3| (p - axis.about).reject_from_normalized(axis.direction);
        let sides = [-1.0, 0.0, 1.0].map(|t| out(conic.point(t)));
        let far = sides.into_iter().fold(DVec3::ZERO, |most, v| if v.length() > most.length() { v } else { most });
        let side = math::unit(far, 0.0).ok_or_else(|| defect("its conic lies in its axis"))?;
        // What lies on it is turned back into its plane, on either side of the axis.
        let turned = |p: DVec3| {
            let foot = axis.about + axis.direction * (p - axis.about).dot(axis.direction);
            let by = side * out(p).length();
            [foot + by, foot - by]
        };
        let (a, b) = Self::range(conic, loops.points().flat_map(turned));
        conic.part(a, b, self.origin)
    }
}
