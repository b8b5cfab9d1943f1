//! Edges of nets whose poles were made points: they end at the poles that the file has, and run along the borders that it has.

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::geometry::closest;
use crate::geometry::shapes::nurbs::weighted;
use crate::io::cad::control_nets::{borders, spline};
use crate::io::cad::defect::Defect;
use crate::io::cad::elementary_surface::Ground;
use crate::model::Body;

/// Tolerances within which a vertex is a pole, and a seam the edge of a net: control points of a circle stand on a square round it.
const REACH: f64 = 2.0;

/// Places along an edge that are compared with a border.
const PLACES: usize = 8;

/// Vertices and borders as the file has them.
#[derive(Debug)]
pub struct FileBorders {
    /// Vertices of the body, at poles where those are.
    pub vertices: Vec<DVec3>,
    /// Whether each vertex is at a pole.
    moved: Vec<bool>,
    /// Of each edge: the borders of the nets that it may run along.
    borders: Vec<Vec<Curve>>,
}

impl FileBorders {
    /// Where the faces of a body have poles that were made points.
    pub fn new(body: &Body, grounds: &[Ground], tolerance: &Tolerance) -> Self {
        let room = REACH * tolerance.point;
        let mut placed =
            Self { vertices: body.vertices.clone(), moved: vec![false; body.vertices.len()], borders: vec![Vec::new(); body.edges.len()] };
        for (face, ground) in body.faces.iter().zip(grounds) {
            let Ground::Net(net, _, poles) = ground else { continue };
            if poles.is_empty() {
                continue;
            }
            for (edge, _) in face.loops.iter().flatten() {
                let (first, last) = body.edges[*edge].ends;
                for vertex in [first, last] {
                    if let Some(pole) = poles.iter().find(|pole| pole.distance(body.vertices[vertex]) <= room) {
                        (placed.vertices[vertex], placed.moved[vertex]) = (*pole, true);
                    }
                }
            }
            let around: Vec<Curve> = borders(net).into_iter().map(|border| border.curve).collect();
            for (edge, _) in face.loops.iter().flatten() {
                placed.borders[*edge].extend(around.iter().cloned());
            }
        }
        placed
    }

    /// The curve of an edge between these vertices.
    pub fn curve(&self, edge: usize, ends: (usize, usize), own: Curve, tolerance: &Tolerance) -> Result<Curve, Defect> {
        let (start, end) = (self.vertices[ends.0], self.vertices[ends.1]);
        let (a, b) = own.domain();
        let places: Vec<DVec3> = (1..PLACES).map(|k| own.point(a + (b - a) * k as f64 / PLACES as f64)).collect();
        let room = REACH * tolerance.point;
        for border in &self.borders[edge] {
            let [a, b] = [start, end].map(|p| closest(border, p));
            let is_near = |p: &DVec3| closest(border, *p).distance <= room;
            if a.distance.max(b.distance) <= room && a.t != b.t && places.iter().all(is_near) {
                let part = border.part(a.t.min(b.t), a.t.max(b.t));
                return Ok(if a.t < b.t { part } else { part.reversed() });
            }
        }
        let moved = [(ends.0, start), (ends.1, end)].map(|(vertex, at)| self.moved[vertex].then_some(at));
        if moved == [None, None] {
            return Ok(own);
        }
        let whole = own.to_nurbs(tolerance)?;
        let (a, b) = whole.domain();
        let mut curve = whole.part(a, b);
        let last = curve.poles.len() - 1;
        for (k, at) in [0, last].into_iter().zip(moved) {
            curve.poles[k] = at.map_or(curve.poles[k], |at| weighted(at, curve.poles[k].w));
        }
        Ok(spline(curve, own.origin()))
    }
}
