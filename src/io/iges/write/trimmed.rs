//! A surface by itself: all of it, or the part inside its loops, which no other surface shares.

use std::sync::Arc;

use glam::{BVec3, DAffine3, DMat3, DVec3};

use crate::base::bbox::Box3;
use crate::base::tolerance::NUDGE;
use crate::geometry::construct::build;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind};
use crate::io::cad::base_surface::Base;
use crate::io::cad::curve_on_surface::{composed, fitted};
use crate::io::cad::curves::transformed;
use crate::io::cad::defect::{Defect, defect};
use crate::io::iges::entity_writer::{EntityValues, Role};
use crate::io::iges::write::file_builder::FileBuilder;
use crate::surface::{Domain, NurbsSurface, Side, Surface};

impl FileBuilder<'_> {
    /// A surface as it goes out by itself.
    pub(super) fn surface(&mut self, surface: &Surface) -> Result<u32, Defect> {
        match surface.to_net(&self.scale.tolerance)? {
            Some(form) => Ok(self.form(&form, Role::Free)),
            None if surface.domain() == Domain::Loop => self.bordered(surface),
            None => Err(defect("IGES has no place for a plane without a border")),
        }
    }

    /// A surface inside loops: its net, and each loop in (u, v) and in space.
    pub(super) fn bordered(&mut self, surface: &Surface) -> Result<u32, Defect> {
        let ground = surface.ground_net(&self.scale.tolerance)?;
        let base = match &ground {
            Some(form) => self.form(form, Role::Part),
            None => self.plane(surface)?,
        };
        let ground = ground.map(|form| Base::Net(form.net, [0.0, 1.0, 0.0, 1.0]));
        let (mut first, mut borders) = (0, Vec::new());
        for n in surface.loops() {
            let (mut in_uv, mut spaces) = (Vec::new(), Vec::new());
            for k in first..first + n {
                let (uv, in_space) = self.border(surface, ground.as_ref(), k)?;
                in_uv.push(uv);
                spaces.extend(in_space.map(|c| self.curve(&c, Role::Part, true)).transpose()?);
            }
            first += n;
            let in_uv = if surface.is_flat() { in_uv } else { self.within_net(in_uv)? };
            let uvs = in_uv.iter().map(|c| self.curve(c, Role::InUv, false)).collect::<Result<Vec<u32>, Defect>>()?;
            let mut row = |list: Vec<u32>, role| match list.len() as u32 {
                0 => 0,
                n => self.sheet.add(102, 0, role, EntityValues::new().int(n).ints(list)),
            };
            let (uv, space) = (row(uvs, Role::InUv), row(spaces, Role::Part));
            let preferred = if uv == 0 { 2 } else { 3 };
            borders.push(self.sheet.add(142, 0, Role::InUv, EntityValues::new().int(1).ints([base, uv, space]).int(preferred)));
        }
        let [outer, holes @ ..] = borders.as_slice() else { return Err(defect("it has no border")) };
        let values = EntityValues::new().int(base).int(1).int(holes.len() as u32).int(*outer).ints(holes.iter().copied());
        Ok(self.sheet.add(144, 0, Role::Free, values))
    }

    /// A loop moved by whole turns to where the net has its parameters; none of it where it runs over a seam.
    fn within_net(&self, mut loop_of: Vec<Curve>) -> Result<Vec<Curve>, Defect> {
        let bounds = loop_of.iter().map(Curve::bbox).fold(Box3::EMPTY, Box3::union);
        let by = -(bounds.min + DVec3::splat(NUDGE)).floor();
        let moved = bounds.max + by;
        if moved.x > 1.0 + NUDGE || moved.y > 1.0 + NUDGE {
            return Ok(Vec::new());
        }
        if by.x != 0.0 || by.y != 0.0 {
            let m = DAffine3::from_translation(DVec3::new(by.x, by.y, 0.0));
            loop_of = loop_of.iter().map(|c| transformed(c, &m, &self.scale.tolerance)).collect::<Result<_, Defect>>()?;
        }
        Ok(loop_of)
    }

    /// The net of a plane over the box of its border.
    fn plane(&mut self, surface: &Surface) -> Result<u32, Defect> {
        let jet = surface.jet(0.0, 0.0);
        let mut reach = Box3::EMPTY;
        for k in 0..surface.n_sides() {
            let Side::Chain { chain, .. } = surface.side(k) else { continue };
            let bounds = chain.bbox();
            let corners = (0..8).map(|c| DVec3::select(BVec3::new(c & 1 > 0, c & 2 > 0, c & 4 > 0), bounds.min, bounds.max));
            reach = corners.filter_map(|p| surface.flat_uv(p)).fold(reach, |reach, (u, v)| reach.with(DVec3::new(u, v, 0.0)));
        }
        let at = |u: f64, v: f64| (jet.p + jet.du * u + jet.dv * v).extend(1.0);
        let (low, high) = (reach.min, reach.max);
        let poles = vec![at(low.x, low.y), at(high.x, low.y), at(low.x, high.y), at(high.x, high.y)];
        let knots = (vec![low.x, low.x, high.x, high.x], vec![low.y, low.y, high.y, high.y]);
        Ok(self.net(&NurbsSurface { degree: (1, 1), knots, poles, counts: (2, 2) }, Role::Part))
    }

    /// One side in the (u, v) of the net and in space, in the loop's direction; no curve in space along a pole.
    fn border(&self, surface: &Surface, ground: Option<&Base>, k: usize) -> Result<(Curve, Option<Curve>), Defect> {
        let tolerance = &self.scale.tolerance;
        let origin = surface.origin();
        let over_net = |(u, v): (f64, f64)| match surface.ground() {
            Domain::Triangle => DVec3::new(if v < 1.0 { u / (1.0 - v) } else { 0.0 }, v, 0.0),
            _ => DVec3::new(u, v, 0.0),
        };
        let lost = || defect("a side of its border has no course in (u, v)");
        let Side::Chain { chain, from, to } = surface.side(k) else {
            let (a, b) = surface.border_line(k).ok_or_else(lost)?;
            let line = build::line(over_net(a), over_net(b), origin)?;
            let space = ground.map(|net| composed(net, &line, tolerance, origin)).transpose()?.flatten();
            return Ok((line, space));
        };
        let part = chain.slice(from.min(to), from.max(to), tolerance)?.to_curve()?;
        let part = if from > to { part.reversed() } else { part };
        if surface.is_flat() {
            let jet = surface.jet(0.0, 0.0);
            let frame = DAffine3::from_mat3_translation(DMat3::from_cols(jet.du, jet.dv, jet.du.cross(jet.dv)), jet.p);
            return Ok((transformed(&part, &frame.inverse(), tolerance)?, Some(part)));
        }
        let length = part.length();
        let place = |t: f64| {
            let share = part.length_at(t) / length;
            surface.border_place(k, from + (to - from) * share).map(over_net).ok_or_else(lost)
        };
        let at = |p: DVec3| match surface.ground() {
            Domain::Triangle => surface.point(p.x * (1.0 - p.y), p.y),
            _ => surface.point(p.x, p.y),
        };
        let in_uv = fitted(&part.knots(), tolerance, &place, &at)?;
        Ok((Curve::new(Shape::Nurbs(Arc::new(in_uv)), Kind::Spline, origin), Some(part)))
    }
}
