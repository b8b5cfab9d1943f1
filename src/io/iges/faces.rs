//! Trimmed surfaces of a file: which surface, and which curves are its loops.

use glam::DVec3;

use crate::base::job;
use crate::base::tolerance::{NEAR_MISS, NUDGE};
use crate::geometry::Curve;
use crate::geometry::closest;
use crate::io::cad::base_surface::Base;
use crate::io::cad::border::{Border, backwards, pieces};
use crate::io::cad::curve_on_surface::composed;
use crate::io::cad::curves::transformed;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face::{Face, Known};
use crate::io::cad::face_loops::FaceLoops;
use crate::io::cad::inside_point::inside;
use crate::io::cad::revolution_profile::Clear;
use crate::io::iges::curves::CurveRequest;
use crate::io::iges::entity_data::{Data, EdgeData, LoopEdge, Pointer};
use crate::io::iges::entity_table::EntityTable;
use crate::surface::Surface;

/// Curves of a loop, and all that the file has of it in (u, v), those along poles too.
#[derive(Clone, Debug, Default)]
struct CurveRun {
    borders: Vec<Border>,
    outline: Option<Vec<Curve>>,
}

impl CurveRun {
    fn then(mut self, next: Self) -> Self {
        self.borders.extend(next.borders);
        self.outline = self.outline.zip(next.outline).map(|(mut a, b)| {
            a.extend(b);
            a
        });
        self
    }

    fn none() -> Self {
        Self { borders: Vec::new(), outline: Some(Vec::new()) }
    }
}

impl EntityTable {
    /// The face that a pointer means: a trimmed (144) or bounded (143) surface, a bordered plane (108), a face of a shell (510).
    pub fn face(&mut self, d: Pointer) -> Result<Face, Defect> {
        let k = self.place(d)?;
        let data = std::mem::replace(&mut self.decoded[k].data, Data::Busy);
        let made = match &data {
            Data::Trimmed { surface, outer, inner } => {
                let borders: Vec<Pointer> = outer.iter().chain(inner).copied().collect();
                self.walled(d, *surface, outer.is_some(), &borders)
            }
            Data::Bounded { surface, borders } => self.walled(d, *surface, !borders.is_empty(), borders),
            Data::Face { surface, has_outer, loops } => self.walled(d, *surface, *has_outer, loops),
            Data::Plane { border, .. } => {
                // The plane is its own base.
                let border = *border;
                self.decoded[k].data = data.clone();
                self.walled(d, d, true, &[border])
            }
            Data::Busy => Err(defect("it is made of itself")),
            _ => Err(defect("it is not a face")),
        };
        self.decoded[k].data = data;
        made
    }

    fn walled(&mut self, d: Pointer, surface: Pointer, has_outer: bool, borders: &[Pointer]) -> Result<Face, Defect> {
        let base = self.base(surface, 0).map_err(|Defect(why)| defect(format!("its surface at D{surface}: {why}")))?;
        let (mut loops, mut outlines) = (Vec::with_capacity(borders.len()), Vec::with_capacity(borders.len()));
        for (n, border) in borders.iter().enumerate() {
            job::poll();
            let made = self.loop_of(d, *border, &base);
            let made = made.map_err(|Defect(why)| defect(format!("its border at D{border}: {why}")))?;
            if made.borders.is_empty() {
                // Some systems leave an empty loop where a hole had shrunk to nothing.
                if has_outer && n > 0 {
                    continue;
                }
                return Err(defect(format!("its border at D{border}: it has no curves")));
            }
            loops.push(made.borders);
            outlines.push(made.outline);
        }
        let base = self.sided(surface, base, &loops)?;
        // What has no end of its own is bounded by its loops.
        let has_outer = has_outer || matches!(base, Base::Unbounded { .. } | Base::Plane(..));
        // Its (u, v) are those of the whole profile.
        let inside = if has_outer { inside(&base, &outlines) } else { None };
        let around = FaceLoops::of(&loops, &[]);
        let (base, _) = self.clear_of_axis(surface, base, &around)?;
        let surface = base.surface(&base.reach(&around), self.origin, &self.tolerance)?;
        self.settle(d, &base, &surface, &mut loops);
        let known = Known { has_outer, against: base.is_against(), inside, slack: self.slack() };
        Ok(Face::inside(&base, surface, loops, known, &self.tolerance))
    }

    /// A surface of which the axis cuts the profile: the part that is meant, and others where nothing bounds it; a guess is reported.
    pub(super) fn clear_of_axis(&mut self, d: Pointer, base: Base, loops: &FaceLoops) -> Result<(Base, Vec<Base>), Defect> {
        let Clear { base, also, doubt } = base.clear_of_axis(loops, self.slack(), &self.tolerance)?;
        if let Some(doubt) = doubt {
            self.warn(d, doubt);
        }
        Ok((base, also))
    }

    /// The curves of a loop; (u, v) still in the file's parameters.
    fn loop_of(&mut self, face: Pointer, d: Pointer, base: &Base) -> Result<CurveRun, Defect> {
        let k = self.place(d)?;
        let data = std::mem::replace(&mut self.decoded[k].data, Data::Busy);
        let made = match &data {
            Data::CurveOnSurface { uv, space, .. } => self.on_surface(face, *uv, *space, base),
            Data::Boundary { curves, .. } => {
                let each = curves.iter().map(|c| {
                    let pieces = self.paired(face, c.space, &c.uv, base)?;
                    Ok(if c.reversed { CurveRun { borders: backwards(pieces.borders), ..pieces } } else { pieces })
                });
                each.collect::<Result<Vec<_>, Defect>>().map(|all| all.into_iter().fold(CurveRun::none(), CurveRun::then))
            }
            Data::Loop(edges) => self.edges(face, edges, base),
            // A plane's border may be a curve itself.
            Data::Damaged => Err(defect("it is damaged")),
            Data::Busy => Err(defect("it is made of itself")),
            _ => {
                self.decoded[k].data = data.clone();
                self.on_surface(face, 0, d, base)
            }
        };
        self.decoded[k].data = data;
        made
    }

    fn on_surface(&mut self, face: Pointer, uv: Pointer, space: Pointer, base: &Base) -> Result<CurveRun, Defect> {
        let uv = if uv == 0 { Vec::new() } else { vec![uv] };
        self.paired(face, space, &uv, base)
    }

    /// A curve in space with its curves in (u, v), piece by piece; where the first is missing or damaged the others make it.
    fn paired(&mut self, face: Pointer, space: Pointer, uv: &[Pointer], base: &Base) -> Result<CurveRun, Defect> {
        let in_uv: Result<Vec<Curve>, Defect> = uv.iter().map(|d| self.curve(*d, CurveRequest::UV)).collect();
        let in_uv = in_uv.map(|curves| curves.iter().flat_map(pieces).collect::<Vec<Curve>>());
        let outline = in_uv.as_ref().ok().filter(|curves| !curves.is_empty()).cloned();
        let in_space = if space == 0 { Err(defect("it has no curve in space")) } else { self.curve(space, CurveRequest::SPACE) };
        match (in_space, in_uv) {
            (Ok(curve), in_uv) => {
                let pieces = pieces(&curve);
                self.copy(pieces.len())?;
                let mut in_uv = in_uv.unwrap_or_default();
                if in_uv.len() > pieces.len() {
                    // A curve along a pole is one point in space.
                    in_uv.retain(|uv| !matches!(composed(base, uv, &self.tolerance, self.origin), Ok(None)));
                }
                let in_uv = if in_uv.len() == pieces.len() { in_uv } else { Vec::new() };
                let uv = in_uv.into_iter().map(Some).chain(std::iter::repeat(None));
                Ok(CurveRun { borders: pieces.into_iter().zip(uv).map(|(space, uv)| Border { space, uv }).collect(), outline })
            }
            (Err(Defect(why)), Ok(in_uv)) if !in_uv.is_empty() => {
                if space != 0 {
                    self.warn(face, format!("a curve of its border is rebuilt from its (u, v): {why}"));
                }
                let mut made = Vec::with_capacity(in_uv.len());
                for uv in in_uv {
                    self.copy(1)?;
                    // A curve along a pole is one point in space.
                    if let Some(space) = composed(base, &uv, &self.tolerance, self.origin)? {
                        made.push(Border { space, uv: Some(uv) });
                    }
                }
                Ok(CurveRun { borders: made, outline })
            }
            (Err(why), _) => Err(why),
        }
    }

    /// A loop of edges of a solid.
    fn edges(&mut self, face: Pointer, edges: &[LoopEdge], base: &Base) -> Result<CurveRun, Defect> {
        let mut made = CurveRun::none();
        for edge in edges.iter().filter(|e| !e.is_vertex) {
            let (list, index) = edge.edge;
            let Data::Edges(all) = self.data(list)? else {
                return Err(defect(format!("{} is not a list of edges", self.label(list))));
            };
            let found = index.checked_sub(1).and_then(|k| all.get(k)).copied();
            let found = found.ok_or_else(|| defect(format!("the list at D{list} has no edge {index}")))?;
            let mut pieces = self.paired(face, found.curve, &edge.uv, base)?;
            if let [one] = pieces.borders.as_mut_slice() {
                one.space = self.between(&found, &one.space);
            }
            made = made.then(if edge.reversed { CurveRun { borders: backwards(pieces.borders), ..pieces } } else { pieces });
        }
        Ok(made)
    }

    /// The part of an edge's curve between its vertices, which may be shorter than the curve.
    fn between(&mut self, edge: &EdgeData, curve: &Curve) -> Curve {
        let vertex = |(list, index): (Pointer, usize)| match self.data(list) {
            Ok(Data::Vertices(points)) => index.checked_sub(1).and_then(|k| points.get(k)).map(|p| *p * self.scale),
            _ => None,
        };
        let (Some(start), Some(end)) = (vertex(edge.start), vertex(edge.end)) else { return curve.clone() };
        let room = NEAR_MISS * self.slack();
        let near = |a: DVec3, b: DVec3| a.distance(b) <= room;
        let off = [start, end].map(|p| p.distance(curve.start()).min(p.distance(curve.end())));
        let off =
            if off.iter().all(|off| *off <= self.slack()) { 0.0 } else { closest(curve, start).distance.max(closest(curve, end).distance) };
        if off > self.slack() && self.vertex_off.is_none_or(|(worst, _)| off > worst) {
            self.vertex_off = Some((off, edge.curve));
        }
        if near(curve.start(), start) && near(curve.end(), end) {
            return curve.clone();
        }
        let (a, b) = (closest(curve, start), closest(curve, end));
        if a.distance <= room && b.distance <= room && a.t < b.t { curve.part(a.t, b.t) } else { curve.clone() }
    }

    /// Puts (u, v) into the parameters of the surface, and drops those that do not agree with the curve in space.
    fn settle(&mut self, d: Pointer, base: &Base, surface: &Surface, loops: &mut [Vec<Border>]) {
        let map = base.to_surface();
        let room = NEAR_MISS * self.slack().max(NUDGE * surface.hull().diagonal());
        let mut worst = 0.0_f64;
        for border in loops.iter_mut().flatten() {
            let moved = match (&map, &border.uv) {
                (Some(m), Some(uv)) => transformed(uv, m, &self.tolerance).ok(),
                _ => None,
            };
            border.uv = moved.filter(|uv| {
                let off = disagreement(surface, uv, &border.space);
                let agrees = off <= room;
                worst = if agrees { worst } else { worst.max(off) };
                agrees
            });
        }
        if worst > 0.0 {
            let worst = self.length(worst);
            self.warn(d, format!("curves of its border in (u, v) are up to {worst} off those in space, which are used"));
        }
    }
}

/// Largest distance of the ends of a curve in (u, v) from those of the curve in space, in the better direction.
fn disagreement(surface: &Surface, uv: &Curve, space: &Curve) -> f64 {
    let at = |p: DVec3| surface.point(p.x.clamp(0.0, 1.0), p.y.clamp(0.0, 1.0));
    let (a, b) = (at(uv.start()), at(uv.end()));
    let off = |c: DVec3, d: DVec3| a.distance(c).max(b.distance(d));
    off(space.start(), space.end()).min(off(space.end(), space.start()))
}
