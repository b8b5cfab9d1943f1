//! Faces: a surface and the loops of edges on it, each in its direction.

use glam::DVec3;

use crate::base::{job, math};
use crate::geometry::Curve;
use crate::geometry::construct::build;
use crate::io::cad::base_surface::Base;
use crate::io::cad::border::{Border, backwards, pieces};
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face::{Face, Known, least_area};
use crate::io::cad::face_loops::FaceLoops;
use crate::io::step::reader::{NESTED, Step};

impl Step<'_> {
    /// The face that an entity is, looking the other way where it is `turned`.
    pub fn face(&mut self, k: u32, turned: bool) -> Result<Face, Defect> {
        self.spanned = 0.0;
        let (mut k, mut turned) = (k, turned);
        for _ in 0..NESTED {
            match self.file.name(k) {
                b"ORIENTED_FACE" => {
                    let row = self.file.parameters(k);
                    turned ^= !row.flag(3, true);
                    k = row.entity(2)?;
                }
                b"SUBFACE" => return Err(defect(format!("{} is a part of a face", self.label(k)))),
                b"ADVANCED_FACE" | b"FACE_SURFACE" => {
                    let row = self.file.parameters(k);
                    let same = row.flag(3, true);
                    let surface = row.entity(2)?;
                    return self.bounded_face(&row.entities(1)?, Some(surface), same, turned);
                }
                b"FACE" => return self.bounded_face(&self.file.parameters(k).entities(1)?, None, true, turned),
                _ if self.file.under(k, b"FACE_SURFACE").is_some() => {
                    let (Some(own), Some(of)) = (self.file.under(k, b"FACE_SURFACE"), self.file.under(k, b"FACE")) else {
                        return Err(defect("it has no loops"));
                    };
                    return self.bounded_face(&of.entities(0)?, Some(own.entity(0)?), own.flag(1, true), turned);
                }
                _ => return Err(defect(format!("{} is not a face", self.label(k)))),
            }
        }
        Err(defect("faces are nested too deep, or are made of themselves"))
    }

    /// A face of bounds; one without a surface lies in the plane of its points.
    fn bounded_face(&mut self, bounds: &[u32], surface: Option<u32>, same: bool, turned: bool) -> Result<Face, Defect> {
        let mut loops: Vec<Vec<Border>> = Vec::with_capacity(bounds.len());
        let mut vertices = Vec::new();
        let mut outer = 0;
        for bound in bounds {
            job::poll();
            let row = self.file.parameters(*bound);
            let name = self.file.name(*bound);
            if !matches!(name, b"FACE_BOUND" | b"FACE_OUTER_BOUND") {
                return Err(defect(format!("{} is not a bound of a face", self.label(*bound))));
            }
            let made = self.loop_of(row.entity(1)?).map_err(|Defect(why)| defect(format!("its bound #{}: {why}", self.file.id(*bound))))?;
            if made.is_empty() {
                vertices.extend(self.vertex_of(row.entity(1)?));
                continue;
            }
            if name == b"FACE_OUTER_BOUND" {
                outer = loops.len();
            }
            loops.push(if row.flag(2, true) { made } else { backwards(made) });
        }
        if outer < loops.len() {
            loops[..=outer].rotate_right(1);
        }
        self.spanned = least_area(&loops.iter().collect::<Vec<_>>());
        let around = FaceLoops::of(&loops, &vertices);
        self.also = Vec::new();
        let base = match surface {
            Some(of) => self.base(of, &around, 0).map_err(|Defect(why)| defect(format!("its surface {}: {why}", self.label(of))))?,
            None => plane_of(loops.first().map_or(&[], Vec::as_slice))?,
        };
        let mut made = if loops.is_empty() {
            self.whole(&base, &around)?
        } else {
            let surface = base.surface(&base.reach(&around), self.origin, &self.tolerance)?;
            let known = Known { has_outer: true, against: !same, inside: None, slack: self.slack() };
            Face::inside(&base, surface, loops, known, &self.tolerance)
        };
        self.spanned = 0.0;
        made.against = !same;
        made.flipped = same == turned;
        Ok(made)
    }

    /// The point of a loop that is a vertex.
    fn vertex_of(&self, k: u32) -> Option<DVec3> {
        self.vertex(self.file.parameters(k).entity(1).ok()?).ok()
    }

    /// The curves of a loop; none for a vertex.
    fn loop_of(&mut self, k: u32) -> Result<Vec<Border>, Defect> {
        let row = self.file.parameters(k);
        let of = |curve: &Curve| pieces(curve).into_iter().map(|space| Border { space, uv: None }).collect::<Vec<Border>>();
        match self.file.name(k) {
            b"VERTEX_LOOP" => Ok(Vec::new()),
            b"POLY_LOOP" => {
                let points = row.entities(1)?.into_iter().map(|p| self.point(p)).collect::<Result<Vec<DVec3>, Defect>>()?;
                let n = points.len();
                let sides = (0..n).map(|i| (points[i], points[(i + 1) % n])).filter(|(a, b)| a != b);
                sides.map(|(a, b)| Ok(Border { space: build::line(a, b, self.origin)?, uv: None })).collect()
            }
            b"EDGE_LOOP" => {
                let mut borders = Vec::new();
                for oriented in row.entities(1)? {
                    borders.extend(self.used(oriented, &of)?);
                }
                Ok(borders)
            }
            _ if self.file.under(k, b"PATH").is_some() => {
                let edges = self.file.under(k, b"PATH").map_or(Ok(Vec::new()), |r| r.entities(0))?;
                let mut borders = Vec::new();
                for oriented in edges {
                    borders.extend(self.used(oriented, &of)?);
                }
                Ok(borders)
            }
            _ => Err(defect(format!("{} is not a loop", self.label(k)))),
        }
    }

    /// The curves of an edge in the direction of its loop.
    fn used(&mut self, oriented: u32, of: &dyn Fn(&Curve) -> Vec<Border>) -> Result<Vec<Border>, Defect> {
        let (mut k, mut ahead) = (oriented, true);
        for _ in 0..NESTED {
            if self.file.name(k) != b"ORIENTED_EDGE" {
                let curve = self.edge(k).map_err(|Defect(why)| defect(format!("its edge #{}: {why}", self.file.id(k))))?;
                self.spend(1)?;
                return Ok(if ahead { of(&curve) } else { backwards(of(&curve)) });
            }
            let row = self.file.parameters(k);
            ahead ^= !row.flag(4, true);
            k = row.entity(3)?;
        }
        Err(defect(format!("#{} is made of itself", self.file.id(oriented))))
    }

    /// A surface that entities of several kinds may be: whole, between parameters, or inside curves.
    pub fn sheet(&mut self, k: u32, depth: usize) -> Result<Face, Defect> {
        if depth > NESTED {
            return Err(defect("surfaces are nested too deep, or are made of themselves"));
        }
        let row = self.file.parameters(k);
        match self.file.name(k) {
            b"RECTANGULAR_TRIMMED_SURFACE" => self.rectangle(k),
            b"ORIENTED_SURFACE" => {
                let mut face = self.sheet(row.entity(1)?, depth + 1)?;
                face.flipped ^= !row.flag(2, true);
                Ok(face)
            }
            b"CURVE_BOUNDED_SURFACE" => {
                let mut loops = Vec::new();
                for boundary in row.entities(2)? {
                    let curve = self.bounded(boundary, 0)?;
                    loops.push(pieces(&curve).into_iter().map(|space| Border { space, uv: None }).collect::<Vec<Border>>());
                }
                let around = FaceLoops::of(&loops, &[]);
                let base = self.base(row.entity(1)?, &around, 0)?;
                let surface = base.surface(&base.reach(&around), self.origin, &self.tolerance)?;
                // What has no end of its own is bounded by its loops.
                let has_outer = !row.flag(3, false) || matches!(base, Base::Unbounded { .. } | Base::Plane(..));
                let known = Known { has_outer, against: false, inside: None, slack: self.slack() };
                Ok(Face::inside(&base, surface, loops, known, &self.tolerance))
            }
            _ => {
                self.also = Vec::new();
                let base = self.base(k, &FaceLoops::NONE, 0)?;
                self.whole(&base, &FaceLoops::NONE)
            }
        }
    }
}

/// The plane of a loop's points, which see it counter-clockwise.
fn plane_of(borders: &[Border]) -> Result<Base, Defect> {
    let at = borders.first().map_or(DVec3::ZERO, |b| b.space.start());
    let twice = |b: &Border| (b.space.start() - at).cross(b.space.end() - at);
    let normal = math::unit(borders.iter().map(twice).sum(), 0.0).ok_or_else(|| defect("its loop has no plane"))?;
    let first = math::any_normal(normal);
    Ok(Base::Plane(at, first, normal.cross(first)))
}
