//! `RECTANGULAR_TRIMMED_SURFACE`: the part of a surface between two u and two v.

use crate::base::math;
use crate::base::tolerance::{EPSILON, NUDGE};
use crate::geometry::construct::build;
use crate::geometry::{Curve, Motion};
use crate::io::cad::base_surface::Base;
use crate::io::cad::control_nets::trimmed_net;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face::Face;
use crate::io::cad::face_loops::FaceLoops;
use crate::io::step::conics::Endless;
use crate::io::step::curves::Course;
use crate::io::step::reader::Step;
use crate::surface::swept::revolve::Axis;

const TURN: f64 = std::f64::consts::TAU;

impl Step<'_> {
    /// A `RECTANGULAR_TRIMMED_SURFACE` as a face.
    pub fn rectangle(&mut self, k: u32) -> Result<Face, Defect> {
        let row = self.file.parameters(k);
        let base = self.within_parameters(k)?;
        let mut face = self.whole(&base, &FaceLoops::NONE)?;
        face.flipped = row.flag(6, true) != row.flag(7, true);
        Ok(face)
    }

    /// The basis surface of a `RECTANGULAR_TRIMMED_SURFACE` between its parameters, with its own normals.
    pub fn within_parameters(&mut self, k: u32) -> Result<Base, Defect> {
        let row = self.file.parameters(k);
        let [u0, u1, v0, v1] = [row.number(2)?, row.number(3)?, row.number(4)?, row.number(5)?];
        self.also = Vec::new();
        let base = self.between_parameters(row.entity(1)?, [u0, u1, v0, v1])?;
        self.clear_of_axis(k, base, &FaceLoops::NONE)
    }

    fn between_parameters(&mut self, k: u32, [u0, u1, v0, v1]: [f64; 4]) -> Result<Base, Defect> {
        let row = self.file.parameters(k);
        let (length, angle) = (self.scale, self.units.radians);
        let ordered = |a: f64, b: f64| (a.min(b), a.max(b));
        // Parameters in reverse order are swapped; a range of angles may cross the seam.
        let turn_range = |a: f64, b: f64| {
            let (a, b) = (a * angle, b * angle);
            let sweep = if b > a { b - a } else { b - a + TURN };
            if !(sweep > 0.0 && sweep <= TURN * (1.0 + NUDGE)) {
                return Err(defect(format!("its angles run from {a} to {b}, which is not part of a turn")));
            }
            Ok((a, if sweep >= TURN * (1.0 - EPSILON) { a + TURN } else { a + sweep }))
        };
        let whole = |angles: (f64, f64), axis: Axis, profile: Curve| Ok(Base::Turned { axis, profile, angles, first: None });
        match self.file.name(k) {
            b"PLANE" => {
                let frame = self.frame(row.entity(1)?)?;
                let ((u0, u1), (v0, v1)) = (ordered(u0 * length, u1 * length), ordered(v0 * length, v1 * length));
                // From the far end back, as below.
                let at = |u: f64| frame.at + frame.x * u + frame.y * v1;
                Ok(Base::Swept { profile: build::line(at(u0), at(u1), self.origin)?, by: frame.y * (v0 - v1) })
            }
            b"CYLINDRICAL_SURFACE" | b"CONICAL_SURFACE" => {
                let frame = self.frame(row.entity(1)?)?;
                let slope = if self.file.name(k) == b"CONICAL_SURFACE" { math::tan(row.number(3)? * angle) } else { 0.0 };
                let radius = row.number(2)? * length;
                let (v0, v1) = ordered(v0 * length, v1 * length);
                let at = |v: f64| frame.at + frame.z * v + frame.x * (radius + slope * v);
                whole(turn_range(u0, u1)?, Axis { about: frame.at, direction: frame.z }, build::line(at(v0), at(v1), self.origin)?)
            }
            b"SPHERICAL_SURFACE" | b"TOROIDAL_SURFACE" => {
                let frame = self.frame(row.entity(1)?)?;
                let is_sphere = self.file.name(k) == b"SPHERICAL_SURFACE";
                let (major, minor) = if is_sphere { (0.0, row.number(2)?) } else { (row.number(2)?, row.number(3)?) };
                let (major, minor) = (major * length, minor * length);
                let circle = Endless::Ellipse(frame.at + frame.x * major, frame.x * minor, frame.z * minor);
                let (v0, v1) = if is_sphere { ordered(v0 * angle, v1 * angle) } else { turn_range(v0, v1)? };
                whole(turn_range(u0, u1)?, Axis { about: frame.at, direction: frame.z }, circle.part(v0, v1, self.origin)?)
            }
            b"SURFACE_OF_LINEAR_EXTRUSION" => {
                let of = self.course(row.entity(1)?, 0)?;
                let by = self.vector(row.entity(2)?)?;
                let (v0, v1) = ordered(v0, v1);
                // The net has the direction first, the file the curve: from the far end back, so that normals are those of the file.
                let profile = self.part_of(&of, u0, u1)?.moved(&Motion::translation(by * v1));
                Ok(Base::Swept { profile, by: by * (v0 - v1) })
            }
            b"SURFACE_OF_REVOLUTION" => {
                let of = self.course(row.entity(1)?, 0)?;
                let frame = self.frame(row.entity(2)?)?;
                whole(turn_range(u0, u1)?, Axis { about: frame.at, direction: frame.z }, self.part_of(&of, v0, v1)?)
            }
            _ => match self.base(k, &FaceLoops::NONE, 0)? {
                Base::Net(net, [a, b, c, d]) if a.is_finite() => {
                    let ((u0, u1), (v0, v1)) = (ordered(u0, u1), ordered(v0, v1));
                    let share = |x: f64, a: f64, b: f64| ((x - a) / (b - a)).clamp(0.0, 1.0);
                    let range = [share(u0, a, b), share(u1, a, b), share(v0, c, d), share(v1, c, d)];
                    if range[0] >= range[1] || range[2] >= range[3] {
                        return Err(defect("nothing of its surface lies between its parameters"));
                    }
                    Ok(Base::Net(trimmed_net(net, range)?, [u0, u1, v0, v1]))
                }
                _ => Err(defect("its surface has no parameters that can be read")),
            },
        }
    }

    /// The part of a curve between two of the file's parameters.
    fn part_of(&mut self, of: &Course, a: f64, b: f64) -> Result<Curve, Defect> {
        match of {
            Course::Endless(endless) => {
                let unit = if endless.closes() { self.units.radians } else { 1.0 };
                let (a, b) = if endless.closes() && b < a { (a * unit, b * unit + TURN) } else { (a.min(b) * unit, a.max(b) * unit) };
                endless.part(a, b, self.origin)
            }
            Course::Bounded(curve) => {
                let (t0, t1) = curve.domain();
                let (a, b) = (a.min(b).max(t0), a.max(b).min(t1));
                Ok(if a < b { curve.part(a, b) } else { curve.clone() })
            }
        }
    }
}
