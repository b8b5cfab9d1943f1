//! Surface entities as surfaces of the model. Their normals are those of the file.

use glam::{DVec3, DVec4};

use crate::base::math;
use crate::base::tolerance::{EPSILON, PARALLEL};
use crate::geometry::Curve;
use crate::geometry::shapes::nurbs::weighted;
use crate::io::cad::base_surface::{BEYOND, Base};
use crate::io::cad::control_nets::trimmed_net;
use crate::io::cad::curves::check_weights;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face_loops::FaceLoops;
use crate::io::step::conics::Endless;
use crate::io::step::curves::Course;
use crate::io::step::reader::{Frame, NESTED, Step};
use crate::io::step::splines::{self, Netted};
use crate::surface::NurbsSurface;
use crate::surface::swept::revolve::Axis;

impl Step<'_> {
    /// The surface that an entity is; one without ends reaches about as far as what lies on it.
    pub fn base(&mut self, k: u32, loops: &FaceLoops, depth: usize) -> Result<Base, Defect> {
        if depth > NESTED {
            return Err(defect("surfaces are nested too deep, or are made of themselves"));
        }
        let file = self.file;
        let row = file.parameters(k);
        let name = file.name(k);
        if file.under(k, b"B_SPLINE_SURFACE").is_some() || name.ends_with(b"_SURFACE_WITH_KNOTS") || is_knotless(name) {
            return self.net(k);
        }
        let length = |step: &Self, n: usize| Ok::<f64, Defect>(row.number(n)? * step.scale);
        match name {
            b"PLANE" => {
                let frame = self.frame(row.entity(1)?)?;
                Ok(Base::Plane(frame.at, frame.x, frame.y))
            }
            b"CYLINDRICAL_SURFACE" | b"CONICAL_SURFACE" => {
                let frame = self.frame(row.entity(1)?)?;
                let radius = length(self, 2)?;
                let slope = if name == b"CONICAL_SURFACE" { math::tan(row.number(3)? * self.units.radians) } else { 0.0 };
                if radius < 0.0 || (radius == 0.0 && slope == 0.0) {
                    return Err(defect("its radius must be above 0"));
                }
                self.clear_of_axis(k, Base::Unbounded { axis: axis(&frame), radius, slope, reference: frame.x }, loops)
            }
            b"SPHERICAL_SURFACE" => {
                let frame = self.frame(row.entity(1)?)?;
                let radius = length(self, 2)?;
                if radius <= 0.0 {
                    return Err(defect("its radius must be above 0"));
                }
                Base::sphere(&axis(&frame), radius, frame.x, self.origin)
            }
            b"TOROIDAL_SURFACE" | b"DEGENERATE_TOROIDAL_SURFACE" => {
                let frame = self.frame(row.entity(1)?)?;
                let outer = (name == b"DEGENERATE_TOROIDAL_SURFACE").then(|| row.flag(4, true));
                self.torus(k, &frame, [length(self, 2)?, length(self, 3)?], outer, loops)
            }
            b"SURFACE_OF_LINEAR_EXTRUSION" => {
                let of = self.course(row.entity(1)?, 0)?;
                let along = self.vector(row.entity(2)?)?;
                self.extruded(&of, along, loops)
            }
            b"SURFACE_OF_REVOLUTION" => {
                let of = self.course(row.entity(1)?, 0)?;
                let frame = self.frame(row.entity(2)?)?;
                self.revolved(k, &of, &axis(&frame), loops)
            }
            b"OFFSET_SURFACE" => self.beside(k, loops, depth),
            b"RECTANGULAR_TRIMMED_SURFACE" | b"CURVE_BOUNDED_SURFACE" | b"ORIENTED_SURFACE" | b"SURFACE_REPLICA" => {
                Err(defect(format!("{} is given where a whole surface is expected", self.label(k))))
            }
            _ => Err(defect(format!("{} is not a surface that can be read", self.label(k)))),
        }
    }

    /// The offset of a surface, along the normals of the file.
    fn beside(&mut self, k: u32, loops: &FaceLoops, depth: usize) -> Result<Base, Defect> {
        let row = self.file.parameters(k);
        let (of, distance) = (row.entity(1)?, row.number(2)? * self.scale);
        let inner = self.file.parameters(of);
        let grown = |radius: f64| if radius > 0.0 { Ok(radius) } else { Err(defect("its offset turns it inside out")) };
        match self.file.name(of) {
            b"SPHERICAL_SURFACE" => {
                let frame = self.frame(inner.entity(1)?)?;
                let radius = grown(inner.number(2)? * self.scale + distance)?;
                return Base::sphere(&axis(&frame), radius, frame.x, self.origin);
            }
            b"TOROIDAL_SURFACE" => {
                let frame = self.frame(inner.entity(1)?)?;
                let minor = grown(inner.number(3)? * self.scale + distance)?;
                return self.torus(k, &frame, [inner.number(2)? * self.scale, minor], None, loops);
            }
            _ => {}
        }
        if self.file.name(of) == b"RECTANGULAR_TRIMMED_SURFACE" && inner.flag(6, true) != inner.flag(7, true) {
            return Err(defect(format!("{} is turned over by one of its senses", self.label(of))));
        }
        let around = loops.beside(distance);
        let base = match self.file.name(of) {
            b"RECTANGULAR_TRIMMED_SURFACE" => self.within_parameters(of)?,
            _ => self.base(of, &around, depth + 1)?,
        };
        if !std::mem::take(&mut self.also).is_empty() {
            return Err(defect("its surface crosses its axis, and it is ambiguous which part is meant"));
        }
        let reach = base.reach(&around);
        let (base, folds) = base.beside(distance, &reach, self.origin, &self.tolerance)?;
        if folds {
            self.warn(k, "it folds over where its surface bends more tightly than its distance");
        }
        Ok(base)
    }

    fn net(&mut self, k: u32) -> Result<Base, Defect> {
        let Netted { degree, knots, points, weights } = splines::surface(self, k)?;
        let counts = (points.len(), points[0].len());
        let weight = |i: usize, j: usize| weights.as_ref().map_or(1.0, |w| w[i][j]);
        if let Some(weights) = &weights {
            check_weights(&weights.concat())?;
        }
        let poles: Vec<DVec4> =
            (0..counts.1).flat_map(|j| (0..counts.0).map(move |i| (i, j))).map(|(i, j)| weighted(points[i][j], weight(i, j))).collect();
        let range = [knots.0[degree.0], knots.0[counts.0], knots.1[degree.1], knots.1[counts.1]];
        Ok(Base::Net(trimmed_net(NurbsSurface { degree, knots, poles, counts }, range)?, range))
    }

    /// A torus; of one whose tube reaches over the axis the `outer` or the inner part, where the file says which.
    fn torus(&mut self, k: u32, frame: &Frame, radii: [f64; 2], outer: Option<bool>, loops: &FaceLoops) -> Result<Base, Defect> {
        let [major, minor] = radii;
        if !(major >= 0.0 && minor > 0.0) {
            return Err(defect("its radii must be above 0"));
        }
        let axis = axis(frame);
        if major > minor * (1.0 + EPSILON) {
            return Base::torus(&axis, [major, minor], frame.x, self.origin);
        }
        let Some(outer) = outer else {
            return self.clear_of_axis(k, Base::torus(&axis, radii, frame.x, self.origin)?, loops);
        };
        // The tube meets the axis where its angle is this one, either way.
        let meets = math::acos((-major / minor).clamp(-1.0, 1.0));
        let circle = Endless::Ellipse(frame.at + frame.x * major, frame.x * minor, frame.z * minor);
        let (a, b) = if outer { (-meets, meets) } else { (meets, std::f64::consts::TAU - meets) };
        if b - a <= PARALLEL {
            return Err(defect("nothing of it lies inside"));
        }
        Ok(Base::Round { axis, profile: circle.part(a, b, self.origin)? })
    }

    fn extruded(&mut self, of: &Course, along: DVec3, loops: &FaceLoops) -> Result<Base, Defect> {
        let direction = math::unit(along, 0.0).ok_or_else(|| defect("it has no curve to sweep"))?;
        if let Course::Endless(Endless::Line(p, d)) = of {
            let first = math::unit(*d, 0.0).ok_or_else(|| defect("its line has no direction"))?;
            let normal = math::unit(first.cross(direction), PARALLEL).ok_or_else(|| defect("its line is swept along itself"))?;
            return Ok(Base::Plane(*p, first, normal.cross(first)));
        }
        let reach = &loops.reach;
        if reach.is_empty() {
            return Err(defect("it is swept infinitely far"));
        }
        let profile = self.within(of, loops, direction)?;
        let (low, high) = reach.stretch(profile.start(), direction);
        // The profile itself reaches along the direction too.
        let own = profile.bbox();
        let (first, last) = own.stretch(profile.start(), direction);
        let (low, high) = (low - last.max(0.0), high - first.min(0.0));
        let room = BEYOND * (high - low);
        // The net has the direction first, the file the curve: from the far end back, so that normals are those of the file.
        let by = direction * -(high - low + 2.0 * room);
        let start = crate::geometry::Motion::translation(direction * (high + room));
        Ok(Base::Swept { profile: profile.moved(&start), by })
    }

    /// The parameters of an endless curve between points of its plane, with some room.
    pub fn range(of: &Endless, points: impl Iterator<Item = DVec3>) -> (f64, f64) {
        let (a, b) = points.map(|p| of.parameter(p)).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        let room = BEYOND * (b - a);
        (a - room, b + room)
    }

    /// The stretch of a curve that is swept along a unit direction to reach loops: all of one with ends.
    fn within(&mut self, of: &Course, loops: &FaceLoops, direction: DVec3) -> Result<Curve, Defect> {
        match of {
            Course::Bounded(curve) => Ok(curve.clone()),
            Course::Endless(endless) if endless.closes() => endless.part(0.0, std::f64::consts::TAU, self.origin),
            Course::Endless(endless) => {
                // Points are carried back along the direction into the plane of the curve.
                let (at, normal) = endless.plane();
                let slope = direction.dot(normal);
                if slope.abs() <= PARALLEL {
                    return Err(defect("its curve is swept in its own plane"));
                }
                let (a, b) = Self::range(endless, loops.points().map(|p| p - direction * ((p - at).dot(normal) / slope)));
                endless.part(a, b, self.origin)
            }
        }
    }
}

fn is_knotless(name: &[u8]) -> bool {
    matches!(name, b"BEZIER_SURFACE" | b"UNIFORM_SURFACE" | b"QUASI_UNIFORM_SURFACE")
}

fn axis(frame: &Frame) -> Axis {
    Axis { about: frame.at, direction: frame.z }
}
