//! Curve entities as curves of the model, exactly, and the stretches of them that edges and trims name.

use std::sync::Arc;

use glam::DVec3;

use crate::base::tolerance::NEAR_MISS;
use crate::geometry::closest;
use crate::geometry::construct::build;
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind};
use crate::io::cad::curves::{check_reach, check_weights, ordered};
use crate::io::cad::defect::{Defect, defect};
use crate::io::step::conics::Endless;
use crate::io::step::parameters::{ParameterValue, Row};
use crate::io::step::reader::{NESTED, Step};
use crate::io::step::splines::Knotted;

/// What a piece of a curve takes from what may be copied.
const PIECE: usize = 16;
const TURN: f64 = std::f64::consts::TAU;

/// A curve of the file.
#[derive(Clone, Debug)]
pub enum Course {
    /// Without ends.
    Endless(Endless),
    /// With ends.
    Bounded(Curve),
}

impl Step<'_> {
    /// The curve that an entity is.
    pub fn course(&mut self, k: u32, depth: usize) -> Result<Course, Defect> {
        if depth > NESTED {
            return Err(defect("curves are nested too deep, or are made of themselves"));
        }
        let file = self.file;
        let row = file.parameters(k);
        // The outermost says where to look; a long row of them says nothing more.
        let inside = |why: Defect, k: u32, step: &Self| if depth > 0 { why } else { defect(format!("{}: {}", step.label(k), why.0)) };
        let course = match file.name(k) {
            _ if file.is_complex(k) => self.complex(k, depth)?,
            b"LINE" => Course::Endless(Endless::Line(self.point(row.entity(1)?)?, self.vector(row.entity(2)?)?)),
            b"CIRCLE" | b"ELLIPSE" | b"HYPERBOLA" | b"PARABOLA" => Course::Endless(self.conic(k)?),
            b"POLYLINE" => {
                let points = row.entities(1)?.into_iter().map(|p| self.point(p)).collect::<Result<Vec<DVec3>, Defect>>()?;
                Course::Bounded(self.polyline(points)?)
            }
            b"TRIMMED_CURVE" => {
                let base = row.entity(1)?;
                let of = self.course(base, depth + 1).map_err(|why| inside(why, base, self))?;
                Course::Bounded(self.trimmed(&of, row)?)
            }
            b"COMPOSITE_CURVE" | b"COMPOSITE_CURVE_ON_SURFACE" | b"OUTER_BOUNDARY_CURVE" | b"BOUNDARY_CURVE" => {
                Course::Bounded(self.composite(row.entities(1)?, depth)?)
            }
            b"SURFACE_CURVE" | b"SEAM_CURVE" | b"INTERSECTION_CURVE" | b"BOUNDED_SURFACE_CURVE" => {
                self.course(row.entity(1)?, depth + 1)?
            }
            b"OFFSET_CURVE_3D" => {
                let Course::Bounded(of) = self.course(row.entity(1)?, depth + 1)? else {
                    return Err(defect("it is the offset of an infinite curve"));
                };
                Course::Bounded(build::offset(&of, row.number(2)? * self.scale, self.direction(row.entity(4)?)?, self.origin)?)
            }
            b"B_SPLINE_CURVE_WITH_KNOTS" | b"BEZIER_CURVE" | b"UNIFORM_CURVE" | b"QUASI_UNIFORM_CURVE" => Course::Bounded(self.spline(k)?),
            _ => return Err(defect(format!("{} is not a curve that can be read", self.label(k)))),
        };
        if let Course::Bounded(curve) = &course {
            check_reach([curve.bbox().min, curve.bbox().max])?;
        }
        Ok(course)
    }

    fn complex(&mut self, k: u32, depth: usize) -> Result<Course, Defect> {
        if self.file.under(k, b"B_SPLINE_CURVE").is_some() {
            return Ok(Course::Bounded(self.spline(k)?));
        }
        if let Some(row) = self.file.under(k, b"SURFACE_CURVE") {
            return self.course(row.entity(0)?, depth + 1);
        }
        if let Some(row) = self.file.under(k, b"COMPOSITE_CURVE") {
            return Ok(Course::Bounded(self.composite(row.entities(0)?, depth)?));
        }
        Err(defect(format!("{} is not a curve that can be read", self.label(k))))
    }

    /// The curve that an entity is, with ends: all of an ellipse.
    pub fn bounded(&mut self, k: u32, depth: usize) -> Result<Curve, Defect> {
        match self.course(k, depth)? {
            Course::Bounded(curve) => Ok(curve),
            Course::Endless(of) if of.closes() => of.part(0.0, TURN, self.origin),
            Course::Endless(_) => Err(defect("it has no ends")),
        }
    }

    fn conic(&mut self, k: u32) -> Result<Endless, Defect> {
        let row = self.file.parameters(k);
        let frame = self.frame(row.entity(1)?)?;
        let length = |n: usize| -> Result<f64, Defect> {
            let x = row.number(n)? * self.scale;
            if x > 0.0 { Ok(x) } else { Err(defect("its radius is not above 0")) }
        };
        let a = length(2)?;
        Ok(match self.file.name(k) {
            b"CIRCLE" => Endless::Ellipse(frame.at, frame.x * a, frame.y * a),
            b"ELLIPSE" => Endless::Ellipse(frame.at, frame.x * a, frame.y * length(3)?),
            b"HYPERBOLA" => Endless::Hyperbola(frame.at, frame.x * a, frame.y * length(3)?),
            _ => Endless::Parabola(frame.at, frame.x * a, frame.y * a),
        })
    }

    /// A line through points; those in a row that are one count once.
    pub fn polyline(&self, mut points: Vec<DVec3>) -> Result<Curve, Defect> {
        points.dedup();
        match points.as_slice() {
            [a, b] => Ok(build::line(*a, *b, self.origin)?),
            _ => Ok(build::polyline(&points, false, self.origin)?),
        }
    }

    fn spline(&mut self, k: u32) -> Result<Curve, Defect> {
        let Knotted { degree, knots, points, weights } = crate::io::step::splines::curve(self, k)?;
        if let ([a, b], true) = (points.as_slice(), weights.windows(2).all(|w| w[0] == w[1])) {
            return Ok(build::line(*a, *b, self.origin)?);
        }
        check_weights(&weights)?;
        Ok(build::nurbs(&points, &weights, &knots, degree, self.origin)?)
    }

    fn composite(&mut self, segments: Vec<u32>, depth: usize) -> Result<Curve, Defect> {
        let mut pieces = Vec::with_capacity(segments.len());
        for segment in segments {
            let row = self.file.parameters(segment);
            let parent = row.entity(2)?;
            let curve = self.bounded(parent, depth + 1);
            let curve = curve.map_err(|why| if depth > 0 { why } else { defect(format!("{}: {}", self.label(parent), why.0)) })?;
            let curve = if row.flag(1, true) { curve } else { curve.reversed() };
            self.spend(PIECE * curve.composite().map_or(1, |c| c.pieces.len()))?;
            pieces.extend(curve.composite().map_or_else(|| vec![curve.clone()], |c| c.pieces.clone()));
        }
        ordered(&mut pieces, self.slack());
        match pieces.as_slice() {
            [] => Err(defect("it has no pieces")),
            [one] => Ok(one.clone()),
            _ => Ok(Curve::new(Shape::Composite(Arc::new(Composite::new(pieces))), Kind::Composite, self.origin)),
        }
    }

    /// What a trim says: a parameter of the file and a point.
    fn trim(&self, value: Option<ParameterValue>) -> (Option<f64>, Option<DVec3>) {
        let Some(list) = value.and_then(ParameterValue::list) else { return (None, None) };
        let number = list.values().find_map(|v| if v.entity().is_err() { v.number().ok() } else { None });
        let point = list.values().find_map(|v| v.entity().ok()).and_then(|p| self.point(p).ok());
        (number, point)
    }

    /// The stretch of a curve between two trims.
    fn trimmed(&self, of: &Course, row: Row) -> Result<Curve, Defect> {
        let (first, last) = (self.trim(row.get(2)), self.trim(row.get(3)));
        let ahead = row.flag(4, true);
        let by_points = row.get(5).and_then(ParameterValue::word) == Some(b"CARTESIAN");
        let numbers = first.0.zip(last.0);
        let points = first.1.zip(last.1);
        match (numbers, points) {
            (Some((a, b)), points) if !(by_points && points.is_some()) => match of {
                Course::Endless(endless) => {
                    let unit = match endless {
                        Endless::Ellipse(..) => self.units.radians,
                        _ => 1.0,
                    };
                    let (a, b) = if ahead { (a * unit, b * unit) } else { (b * unit, a * unit) };
                    let b = if endless.closes() { after(a, b) } else { b };
                    let curve = if a <= b { endless.part(a, b, self.origin)? } else { endless.part(b, a, self.origin)?.reversed() };
                    Ok(if ahead { curve } else { curve.reversed() })
                }
                Course::Bounded(curve) => {
                    let (t0, t1) = curve.domain();
                    let part = match curve.shape() {
                        Shape::Nurbs(_) if a.min(b) < t1 && t0 < a.max(b) => curve.part(a.min(b).max(t0), a.max(b).min(t1)),
                        _ => curve.clone(),
                    };
                    Ok(if ahead == (a < b) { part } else { part.reversed() })
                }
            },
            (_, Some((a, b))) => self.between(of, [a, b], ahead, a.distance(b) <= self.slack()),
            _ => Err(defect("its trims cannot be read")),
        }
    }

    /// The stretch of a curve from one point of it to another, in its direction or against it; all of it where they are one.
    pub fn between(&self, of: &Course, [start, end]: [DVec3; 2], ahead: bool, closed: bool) -> Result<Curve, Defect> {
        let (from, to) = if ahead { (start, end) } else { (end, start) };
        let made = match of {
            Course::Endless(endless) => {
                let (a, b) = (endless.parameter(from), endless.parameter(to));
                if closed && !endless.closes() {
                    return Err(defect("its ends coincide"));
                }
                let b = match endless.closes() {
                    true if closed => a + TURN,
                    true => after(a, b),
                    false => b,
                };
                // A curve that runs the other way than it is said to.
                if a <= b { endless.part(a, b, self.origin)? } else { endless.part(b, a, self.origin)?.reversed() }
            }
            Course::Bounded(curve) => self.stretch(curve, from, to, closed)?,
        };
        Ok(if ahead { made } else { made.reversed() })
    }

    fn stretch(&self, curve: &Curve, from: DVec3, to: DVec3, closed: bool) -> Result<Curve, Defect> {
        let room = self.slack();
        let (t0, t1) = curve.domain();
        let near = |a: DVec3, b: DVec3| a.distance(b) <= room;
        let comes_back = near(curve.start(), curve.end());
        let whole = near(curve.start(), from) && near(curve.end(), to);
        if whole && (closed || !near(from, to)) {
            return Ok(curve.clone());
        }
        // An end at the joint of a closed curve is its start or its end.
        let place = |p: DVec3, first: bool| match (near(curve.start(), p), near(curve.end(), p)) {
            (true, true) => Some(if first { t0 } else { t1 }),
            (true, false) => Some(t0),
            (false, true) => Some(t1),
            _ => {
                let found = closest(curve, p);
                (found.distance <= NEAR_MISS * room).then_some(found.t)
            }
        };
        let (Some(a), Some(b)) = (place(from, true), place(to, false)) else { return Ok(curve.clone()) };
        if a < b && !(closed && comes_back) {
            return Ok(curve.part(a, b));
        }
        if comes_back {
            if a <= t0 || b >= t1 || a >= t1 || b <= t0 {
                let (a, b) = (if a >= t1 { t0 } else { a }, if b <= t0 { t1 } else { b });
                return Ok(if a < b { curve.part(a, b) } else { curve.clone() });
            }
            let pieces = vec![curve.part(a, t1), curve.part(t0, b)];
            return Ok(Curve::new(Shape::Composite(Arc::new(Composite::new(pieces))), Kind::Composite, self.origin));
        }
        // It runs the other way than it is said to.
        if b < a { Ok(curve.part(b, a).reversed()) } else { Ok(curve.clone()) }
    }

    /// The curve of an edge from its first vertex to its last one; made once.
    pub fn edge(&mut self, k: u32) -> Result<Curve, Defect> {
        if let Some(made) = self.edges.get(&k) {
            return made.clone();
        }
        let made = self.make_edge(k);
        self.edges.insert(k, made.clone());
        made
    }

    fn make_edge(&mut self, k: u32) -> Result<Curve, Defect> {
        let row = self.file.parameters(k);
        match self.file.name(k) {
            b"EDGE_CURVE" => {
                let (first, last, geometry) = (row.entity(1)?, row.entity(2)?, row.entity(3)?);
                let ends = [self.vertex(first)?, self.vertex(last)?];
                let closed = first == last || ends[0] == ends[1];
                let of = self.course(geometry, 0).map_err(|Defect(why)| defect(format!("{}: {why}", self.label(geometry))))?;
                self.between(&of, ends, row.flag(4, true), closed)
            }
            b"ORIENTED_EDGE" => Err(defect("an oriented edge is given where a plain edge is expected")),
            b"SUBEDGE" => self.edge_between(row.entity(3)?, [row.entity(1)?, row.entity(2)?]),
            b"EDGE" => {
                let ends = [self.vertex(row.entity(1)?)?, self.vertex(row.entity(2)?)?];
                Ok(build::line(ends[0], ends[1], self.origin)?)
            }
            _ => Err(defect(format!("{} is not an edge", self.label(k)))),
        }
    }

    fn edge_between(&mut self, parent: u32, [first, last]: [u32; 2]) -> Result<Curve, Defect> {
        if self.file.name(parent) != b"EDGE_CURVE" {
            return Err(defect(format!("{} is not an edge with a curve", self.label(parent))));
        }
        let ends = [self.vertex(first)?, self.vertex(last)?];
        let whole = self.edge(parent)?;
        self.between(&Course::Bounded(whole), ends, true, false)
    }
}

/// The angle of `b` above `a`, by a turn at most.
fn after(a: f64, b: f64) -> f64 {
    let sweep = (b - a) - ((b - a) / TURN).floor() * TURN;
    a + if sweep > 0.0 { sweep } else { TURN }
}
