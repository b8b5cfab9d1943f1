//! Surface entities as surfaces of the model, with the parameters that the file gives them.

use glam::{DVec3, DVec4};

use crate::base::bbox::Box3;
use crate::base::math;
use crate::base::tolerance::{EPSILON, NEAR_MISS, NUDGE, PARALLEL};
use crate::geometry::shapes::nurbs::weighted;
use crate::io::cad::base_surface::Base;
use crate::io::cad::border::{Border, reach};
use crate::io::cad::control_nets::trimmed_net;
use crate::io::cad::curves::check_weights;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face;
use crate::io::iges::curves::{CurveRequest, bernstein};
use crate::io::iges::entity_data::{Data, NetData, Pointer};
use crate::io::iges::entity_table::{EntityTable, NESTED};
use crate::surface::NurbsSurface;
use crate::surface::swept::revolve::Axis;

impl EntityTable {
    /// The surface that a pointer means, its matrix included.
    pub fn base(&mut self, d: Pointer, depth: usize) -> Result<Base, Defect> {
        if depth > NESTED {
            return Err(defect("surfaces are nested too deep"));
        }
        let k = self.place(d)?;
        let matrix = self.placement(self.entries[k].transform)?;
        let data = std::mem::replace(&mut self.decoded[k].data, Data::Busy);
        let made = self.base_of(d, &data, depth);
        self.decoded[k].data = data;
        let base = match matrix {
            Some(m) => made?.transformed(&m, &self.tolerance)?,
            None => made?,
        };
        Ok(base)
    }

    fn base_of(&mut self, d: Pointer, data: &Data, depth: usize) -> Result<Base, Defect> {
        let scale = self.scale;
        match data {
            Data::Net(net) => {
                self.copy(net.points.len())?;
                self.net(net)
            }
            Data::Patches { u, v, patches, dummies } => self.patches(d, u, v, patches, *dummies),
            Data::Plane { coefficients: [a, b, c, far], .. } => {
                let normal = DVec3::new(*a, *b, *c);
                let size = normal.length();
                let unit = math::unit(normal, 0.0).ok_or_else(|| defect("its normal has no length"))?;
                let first = math::any_normal(unit);
                Ok(Base::Plane(unit * (far / size * scale), first, unit.cross(first)))
            }
            Data::Ruled { rails, crossed, by_length } => {
                let [a, b] = [self.curve(rails[0], CurveRequest::SPACE)?, self.curve(rails[1], CurveRequest::SPACE)?];
                let b = if *crossed { b.reversed() } else { b };
                Ok(Base::Ruled { rails: [a, b], by_length: *by_length })
            }
            Data::Revolution { axis, profile, start, end } => {
                let line = self.curve(*axis, CurveRequest::SPACE)?;
                let (about, to) = (line.start(), line.end());
                let direction = math::unit(to - about, 0.0).ok_or_else(|| defect("its axis has no length"))?;
                let first = match self.data(*profile)? {
                    Data::Arc { center, start, .. } => {
                        let angle = math::atan2(start[1] - center[1], start[0] - center[0]);
                        Some(if angle < 0.0 { angle + std::f64::consts::TAU } else { angle })
                    }
                    _ => None,
                };
                let profile = self.curve(*profile, CurveRequest::SPACE)?;
                Ok(Base::Turned { axis: Axis { about, direction }, profile, angles: angles(*start, *end)?, first })
            }
            Data::Tabulated { profile, end } => {
                let profile = self.curve(*profile, CurveRequest::SPACE)?;
                let by = *end * scale - profile.start();
                if by.length() <= self.tolerance.rounding {
                    return Err(defect("it has no curve to sweep"));
                }
                Ok(Base::Swept { profile, by })
            }
            Data::OffsetSurface { indicator, distance, base } => self.beside(d, *indicator, distance * scale, *base, depth),
            Data::PlaneSurface { at, normal, reference } => {
                let (at, normal) = (self.point(*at)?, self.direction(*normal)?);
                let first = self.reference(*reference, normal)?;
                Ok(Base::Plane(at, first, normal.cross(first)))
            }
            Data::Round { kind, at, axis, sizes, reference } => {
                let about = self.point(*at)?;
                let direction = if *axis == 0 { DVec3::Z } else { self.direction(*axis)? };
                let reference = self.reference(*reference, direction)?;
                self.round(*kind, Axis { about, direction }, reference, *sizes)
            }
            Data::Damaged => Err(defect(format!("{} is damaged", self.label(d)))),
            Data::Busy => Err(defect(format!("{} is made of itself", self.label(d)))),
            _ => Err(defect(format!("{} is not a surface", self.label(d)))),
        }
    }

    /// The offset of a surface; `side` says on which side a distance above 0 is, in the middle of its parameters.
    fn beside(&mut self, d: Pointer, side: DVec3, distance: f64, of: Pointer, depth: usize) -> Result<Base, Defect> {
        let base = self.base(of, depth + 1)?;
        let upright = base.upright(&Box3::EMPTY, self.origin, &self.tolerance)?;
        let distance = if upright.dot(side) < 0.0 { -distance } else { distance };
        if let Data::Round { kind: kind @ (196 | 198), at, axis, sizes: [a, b], reference } = *self.data(of)? {
            // The normals of spheres and tubes look away from their middle.
            let grown = |size: f64| size + distance / self.scale;
            let sizes = if kind == 196 { [grown(a), b] } else { [a, grown(b)] };
            if sizes[usize::from(kind == 198)] <= 0.0 {
                return Err(defect("its offset turns it inside out"));
            }
            let matrix = self.placement(self.entry(of).map_or(0, |e| e.transform))?;
            let base = self.base_of(of, &Data::Round { kind, at, axis, sizes, reference }, depth + 1)?;
            return matrix.map_or(Ok(base.clone()), |m| base.transformed(&m, &self.tolerance));
        }
        let (base, folds) = base.beside(distance, &Box3::EMPTY, self.origin, &self.tolerance)?;
        if folds {
            self.warn(d, "it folds over where its surface bends more tightly than its distance");
        }
        Ok(base)
    }

    /// The base of a face on an offset: on its other side where only there it has the borders.
    pub(super) fn sided(&mut self, d: Pointer, base: Base, loops: &[Vec<Border>]) -> Result<Base, Defect> {
        let k = self.place(d)?;
        let Data::OffsetSurface { indicator, .. } = self.decoded[k].data else { return Ok(base) };
        let reach = reach(loops);
        let off = |table: &Self, base: &Base| {
            Ok::<f64, Defect>(face::off(&base.surface(&reach, table.origin, &table.tolerance)?, loops).distance)
        };
        let here = off(self, &base)?;
        if here <= NEAR_MISS * self.slack() {
            return Ok(base);
        }
        self.turn(k, -indicator);
        let other = self.base(d, 0);
        match other {
            Ok(other) if off(self, &other)? < here * NUDGE.sqrt() => {
                self.warn(d, "its borders are on its other side, which is used");
                Ok(other)
            }
            _ => {
                self.turn(k, indicator);
                Ok(base)
            }
        }
    }

    fn turn(&mut self, k: usize, side: DVec3) {
        if let Data::OffsetSurface { indicator, .. } = &mut self.decoded[k].data {
            *indicator = side;
        }
    }

    fn net(&self, data: &NetData) -> Result<Base, Defect> {
        check_weights(&data.weights)?;
        let poles: Vec<DVec4> = data.points.iter().zip(&data.weights).map(|(p, w)| weighted(*p * self.scale, *w)).collect();
        let net = NurbsSurface { degree: data.degree, knots: data.knots.clone(), poles, counts: data.counts };
        Ok(Base::Net(trimmed_net(net, data.range)?, data.range))
    }

    /// Bicubic patches as one net with threefold knots; on common borders the later patch counts.
    fn patches(&mut self, d: Pointer, u: &[f64], v: &[f64], patches: &[f64], dummies: bool) -> Result<Base, Defect> {
        let (m, n) = (u.len() - 1, v.len() - 1);
        let counts = (3 * m + 1, 3 * n + 1);
        self.copy(counts.0.saturating_mul(counts.1))?;
        let mut points: Vec<Option<DVec3>> = vec![None; counts.0 * counts.1];
        let mut gap = 0.0_f64;
        for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let first = 48 * (i * (n + usize::from(dummies)) + j);
            let c = |k: usize| DVec3::new(patches[first + k], patches[first + 16 + k], patches[first + 32 + k]) * self.scale;
            // Powers of u first, for each power of v.
            let rows = [0, 4, 8, 12].map(|k| bernstein([c(k), c(k + 1), c(k + 2), c(k + 3)], u[i + 1] - u[i]));
            for a in 0..4 {
                let column = bernstein([rows[0][a], rows[1][a], rows[2][a], rows[3][a]], v[j + 1] - v[j]);
                for (b, p) in column.into_iter().enumerate() {
                    let place = &mut points[(3 * j + b) * counts.0 + 3 * i + a];
                    gap = place.map_or(gap, |before| gap.max(before.distance(p)));
                    *place = Some(p);
                }
            }
        }
        if gap > self.slack() {
            let gap = self.length(gap);
            self.warn(d, format!("its patches are up to {gap} apart; they are joined"));
        }
        let knots = |x: &[f64]| {
            let ends = [x[0], x[x.len() - 1]];
            std::iter::once(ends[0]).chain(x.iter().flat_map(|t| [*t; 3])).chain(std::iter::once(ends[1])).collect::<Vec<f64>>()
        };
        let poles = points.into_iter().map(|p| p.unwrap_or_default().extend(1.0)).collect();
        let net = NurbsSurface { degree: (3, 3), knots: (knots(u), knots(v)), poles, counts };
        let range = [u[0], u[m], v[0], v[n]];
        Ok(Base::Net(trimmed_net(net, range)?, range))
    }

    fn point(&self, d: Pointer) -> Result<DVec3, Defect> {
        let Data::Point(p) = self.data(d)? else { return Err(defect(format!("{} is not a point", self.label(d)))) };
        let m = self.placement(self.entry(d).map_or(0, |e| e.transform))?;
        Ok(m.map_or(*p * self.scale, |m| m.transform_point3(*p * self.scale)))
    }

    fn direction(&self, d: Pointer) -> Result<DVec3, Defect> {
        let Data::Direction(v) = self.data(d)? else { return Err(defect(format!("{} is not a direction", self.label(d)))) };
        let m = self.placement(self.entry(d).map_or(0, |e| e.transform))?;
        math::unit(m.map_or(*v, |m| m.transform_vector3(*v)), 0.0).ok_or_else(|| defect("a direction has no length"))
    }

    /// The unit vector at right angles to an axis where parameters start; any, when the file gives none.
    fn reference(&self, d: Pointer, axis: DVec3) -> Result<DVec3, Defect> {
        if d == 0 {
            return Ok(math::any_normal(axis));
        }
        let v = self.direction(d)?;
        math::unit(v.reject_from_normalized(axis), PARALLEL).ok_or_else(|| defect("the reference direction runs along the axis"))
    }

    fn round(&self, kind: u32, axis: Axis, reference: DVec3, [a, b]: [f64; 2]) -> Result<Base, Defect> {
        let radius = a * self.scale;
        if radius < 0.0 || (radius == 0.0 && kind != 194) {
            return Err(defect("its radius must be above 0"));
        }
        match kind {
            192 => Ok(Base::Unbounded { axis, radius, slope: 0.0, reference }),
            194 => Ok(Base::Unbounded { axis, radius, slope: math::tan(b.to_radians()), reference }),
            196 => Base::sphere(&axis, radius, reference, self.origin),
            _ => Base::torus(&axis, [radius, b * self.scale], reference, self.origin),
        }
    }
}

/// First and last angle, at most one turn apart.
fn angles(start: f64, end: f64) -> Result<(f64, f64), Defect> {
    let turn = std::f64::consts::TAU;
    let end = if end <= start { end + turn } else { end };
    let sweep = end - start;
    if sweep <= 0.0 || sweep > turn * (1.0 + NUDGE) {
        return Err(defect(format!("its angles run from {start} to {end}, which is not part of a turn")));
    }
    Ok((start, if sweep > turn * (1.0 - EPSILON) { start + turn } else { end }))
}
