//! Curves as IGES entities: lines, arcs, B-splines, and rows of them.

use glam::DVec3;

use crate::base::tolerance::{EPSILON, PARALLEL};
use crate::geometry::curves::curve::Shape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::{Curve, Nurbs};
use crate::io::cad::defect::Defect;
use crate::io::iges::entity_writer::{EntityValues, Role};
use crate::io::iges::write::file_builder::FileBuilder;

impl FileBuilder<'_> {
    /// A curve in space, scaled; or in (u, v), as it is.
    pub(super) fn curve(&mut self, curve: &Curve, role: Role, scaled: bool) -> Result<u32, Defect> {
        if let Some(composite) = curve.composite() {
            let inner = if role == Role::InUv { Role::InUv } else { Role::Part };
            let pieces = composite.pieces.iter().map(|piece| self.curve(piece, inner, scaled)).collect::<Result<Vec<u32>, Defect>>()?;
            return Ok(self.sheet.add(102, 0, role, EntityValues::new().int(pieces.len() as u32).ints(pieces)));
        }
        self.piece(curve, role, scaled)
    }

    /// One entity, of a curve in a row as well.
    pub(super) fn piece(&mut self, curve: &Curve, role: Role, scaled: bool) -> Result<u32, Defect> {
        let scale = if scaled { self.scale.model } else { 1.0 };
        match curve.shape() {
            Shape::Line(a, b) => Ok(self.sheet.add(110, 0, role, EntityValues::new().point(*a / scale).point(*b / scale))),
            Shape::Arc(arc) if arc.radius.is_some() && scaled => Ok(self.arc(arc, role)),
            Shape::Nurbs(c) if c.degree == 1 && c.poles.len() == 2 && c.polynomial => {
                Ok(self.sheet.add(110, 0, role, EntityValues::new().point(c.pole(0) / scale).point(c.pole(1) / scale)))
            }
            _ => {
                let nurbs = curve.to_nurbs(&self.scale.tolerance)?;
                // What is in (u, v) is as large as the numbers there.
                let nurbs = if scaled { nurbs.lean(self.scale.tolerance.rounding) } else { nurbs };
                Ok(self.sheet.add(126, 0, role, spline(&nurbs, scale)))
            }
        }
    }

    /// A circle's arc: where it is, when it runs counter-clockwise about z; else in its own frame.
    fn arc(&mut self, arc: &EllipticArc, role: Role) -> u32 {
        let scale = self.scale.model;
        let whole = arc.sweep >= std::f64::consts::TAU;
        let is_flat = arc.u.z == 0.0 && arc.v.z == 0.0 && arc.u.cross(arc.v).z > 0.0;
        if is_flat {
            let (center, start, end) = (arc.center / scale, arc.jet(0.0).p / scale, arc.jet(arc.sweep).p / scale);
            let end = if whole { start } else { end };
            let pairs = [center, start, end].into_iter().flat_map(|p| [p.x, p.y]);
            return self.sheet.add(100, 0, role, EntityValues::new().real(center.z).reals(pairs));
        }
        let (x, y) = (arc.u.normalize_or_zero(), arc.v.normalize_or_zero());
        let frame = [x, y, x.cross(y)];
        let origin = (arc.center / scale).to_array();
        let rows = (0..3).flat_map(|k| [frame[0][k], frame[1][k], frame[2][k], origin[k]]);
        let matrix = self.sheet.add(124, 0, Role::Free, EntityValues::new().reals(rows));
        let radius = arc.u.length() / scale;
        let (sin, cos) = crate::base::math::sin_cos(arc.sweep);
        let end = if whole { [radius, 0.0] } else { [radius * cos, radius * sin] };
        let d = self.sheet.add(100, 0, role, EntityValues::new().reals([0.0, 0.0, 0.0, radius, 0.0]).reals(end));
        self.sheet.place(d, matrix);
        d
    }
}

fn spline(c: &Nurbs, scale: f64) -> EntityValues {
    let points: Vec<DVec3> = (0..c.poles.len()).map(|i| c.pole(i) / scale).collect();
    let normal = plane_of(&points);
    let closed = points[0] == points[points.len() - 1];
    let values = EntityValues::new().int(points.len() as i64 - 1).int(c.degree as i64);
    let values = values.int(i64::from(normal.is_some())).int(i64::from(closed)).int(i64::from(c.polynomial)).int(0);
    let values = values.reals(c.knots.iter().copied()).reals(c.poles.iter().map(|q| q.w));
    let values = points.iter().fold(values, |values, p| values.point(*p));
    let (a, b) = c.domain();
    values.reals([a, b]).point(normal.unwrap_or_default())
}

/// The normal of the plane that points lie in; none where they do not, or lie on a line.
fn plane_of(points: &[DVec3]) -> Option<DVec3> {
    let arms = || points[1..].iter().map(|p| *p - points[0]);
    let longest = arms().fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
    let normal = arms().map(|b| longest.cross(b)).fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
    let normal = crate::base::math::unit(normal, PARALLEL * longest.length_squared())?;
    let flat = arms().all(|b| b.dot(normal).abs() <= EPSILON * (longest.length() + points[0].length()));
    flat.then_some(normal)
}
