//! Writes IGES 5.3: curves, surfaces and their groups by name.
//!
//! | thing | entity |
//! |---|---|
//! | point | 116 |
//! | line | 110 |
//! | arc of a circle | 100, placed by a 124 unless it runs counter-clockwise about z |
//! | any other curve | 126 |
//! | curves in a row | 102 |
//! | surface | 128 |
//! | surface inside loops | 144, 142 over a 128 |
//! | shell or group | 402 form 7 |
//! | name, colour | 406 form 15, 314 |

use std::io::{self, Write};
use std::sync::Arc;

use glam::{BVec3, DAffine3, DMat3, DVec3};

use super::sheet::{Role, Sheet, Values, counted, real};
use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::tolerance::{EPSILON, NUDGE, PARALLEL, Tolerance};
use crate::geometry::arc::EllipticArc;
use crate::geometry::curve::Shape;
use crate::geometry::nurbs::projected;
use crate::geometry::{Curve, Kind, Nurbs, build};
use crate::io::cad::base::Base;
use crate::io::cad::carry::carried;
use crate::io::cad::compose::{composed, fitted};
use crate::io::cad::damage::{Damage, damage};
use crate::io::deck::Loss;
use crate::network::Chain;
use crate::surface::{Domain, NetForm, NurbsSurface, Off, Side, Surface};

/// One thing to write.
#[derive(Clone, Debug)]
pub enum Shown {
    /// A point, model units.
    Point(DVec3),
    /// A curve.
    Curve(Chain),
    /// A surface.
    Surface(Surface),
}

/// Things with their names; those under one group name become a group.
#[derive(Clone, Debug)]
pub struct Thing {
    /// Name as declared, empty for none.
    pub name: String,
    /// The shell or group it belongs to, empty for none.
    pub group: String,
    /// Red, green and blue from 0 to 1, where it has a colour.
    pub color: Option<[f64; 3]>,
    /// What it is.
    pub shown: Shown,
}

/// Unit and accuracy of a file.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Name of the file's unit as scripts have it.
    pub unit: &'static str,
    /// Model units in one unit of the file.
    pub model: f64,
    /// Of the model: surfaces that are no B-splines are within it.
    pub tolerance: Tolerance,
}

/// Flag and name of the units that scripts know.
const UNITS: &[(&str, i64, &str)] =
    &[("um", 9, "UM"), ("mm", 2, "MM"), ("cm", 10, "CM"), ("m", 6, "M"), ("km", 7, "KM"), ("in", 1, "INCH"), ("ft", 4, "FT")];

/// Makes the file of things; fails for a thing that the format or the tolerance cannot hold, with its name.
pub fn sheet(things: &[Thing], scale: &Scale) -> Result<Sheet, String> {
    let mut maker = Maker { sheet: Sheet::default(), scale, off: 0.0, sampled: false };
    maker.sheet.keep(things.iter().flat_map(|thing| [thing.name.as_str(), thing.group.as_str()]));
    let mut groups: Vec<(&str, Vec<u32>)> = Vec::new();
    for thing in things {
        job::look();
        let made = match &thing.shown {
            Shown::Point(p) => Ok(maker.sheet.add(116, 0, Role::Free, Values::new().point(*p / scale.model).int(0))),
            Shown::Curve(chain) => chain.to_curve().map_err(Damage::from).and_then(|curve| maker.curve(&curve, Role::Free, true)),
            Shown::Surface(surface) => maker.surface(surface),
        };
        let d = made.map_err(|Damage(why)| if thing.name.is_empty() { why } else { format!("`{}`: {why}", thing.name) })?;
        if !thing.name.is_empty() {
            maker.sheet.name(d, &thing.name);
        }
        if let Some(rgb) = thing.color {
            maker.sheet.paint(d, rgb);
        }
        if thing.group.is_empty() {
            continue;
        }
        match groups.iter_mut().find(|g| g.0 == thing.group) {
            Some(group) => group.1.push(d),
            None => groups.push((&thing.group, vec![d])),
        }
    }
    for (name, members) in groups {
        let d = maker.sheet.add(402, 7, Role::Free, Values::new().int(members.len() as u32).ints(members));
        maker.sheet.name(d, name);
    }
    if maker.off > 0.0 {
        let how = if maker.sampled { ", as sampled" } else { "" };
        maker.sheet.remark(format!(
            "Surfaces that are no B-splines are off by at most {:.2e} {}{how}",
            maker.off / scale.model,
            scale.unit
        ));
    }
    Ok(maker.sheet)
}

/// Writes a file; `name` stands in its head. Returns what the format has no place for.
pub fn write(sheet: &Sheet, name: &str, scale: &Scale, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let (_, flag, unit) = UNITS.iter().find(|u| u.0 == scale.unit).copied().unwrap_or(("", 3, scale.unit));
    let file = real(scale.tolerance.point / scale.model);
    let program = concat!("loft ", env!("CARGO_PKG_VERSION"));
    // The same input gives the same bytes: no clock.
    let date = "15H20000101.000000";
    let plain = |text: &str| text.to_owned();
    let head = [counted(name), counted(name), counted(program), counted(program)];
    let mut global = vec![plain("1H,"), plain("1H;")];
    global.extend(head);
    global.extend(["32", "308", "15", "308", "15"].map(plain));
    global.extend([
        counted(name),
        plain("1."),
        flag.to_string(),
        counted(unit),
        plain("1"),
        plain("1."),
        plain(date),
        file,
        real(sheet.largest()),
    ]);
    global.extend([String::new(), String::new(), plain("11"), plain("0"), plain(date)]);
    sheet.write(&global, out)?;
    Ok(sheet.renamed())
}

struct Maker<'s> {
    sheet: Sheet,
    scale: &'s Scale,
    /// How far nets are from their surfaces at most, model units, and whether all that is known of one are samples.
    off: f64,
    sampled: bool,
}

impl Maker<'_> {
    /// A curve in space, scaled; or in (u, v), as it is.
    fn curve(&mut self, curve: &Curve, role: Role, scaled: bool) -> Result<u32, Damage> {
        if let Some(composite) = curve.composite() {
            let inner = if role == Role::InUv { Role::InUv } else { Role::Part };
            let pieces = composite.pieces.iter().map(|piece| self.curve(piece, inner, scaled)).collect::<Result<Vec<u32>, Damage>>()?;
            return Ok(self.sheet.add(102, 0, role, Values::new().int(pieces.len() as u32).ints(pieces)));
        }
        let scale = if scaled { self.scale.model } else { 1.0 };
        match curve.shape() {
            Shape::Line(a, b) => Ok(self.sheet.add(110, 0, role, Values::new().point(*a / scale).point(*b / scale))),
            Shape::Arc(arc) if arc.radius.is_some() && scaled => Ok(self.arc(arc, role)),
            _ => {
                let nurbs = curve.to_nurbs(&self.scale.tolerance)?;
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
            return self.sheet.add(100, 0, role, Values::new().real(center.z).reals(pairs));
        }
        let (x, y) = (arc.u.normalize_or_zero(), arc.v.normalize_or_zero());
        let frame = [x, y, x.cross(y)];
        let origin = (arc.center / scale).to_array();
        let rows = (0..3).flat_map(|k| [frame[0][k], frame[1][k], frame[2][k], origin[k]]);
        let matrix = self.sheet.add(124, 0, Role::Free, Values::new().reals(rows));
        let radius = arc.u.length() / scale;
        let (sin, cos) = crate::base::math::sin_cos(arc.sweep);
        let end = if whole { [radius, 0.0] } else { [radius * cos, radius * sin] };
        let d = self.sheet.add(100, 0, role, Values::new().reals([0.0, 0.0, 0.0, radius, 0.0]).reals(end));
        self.sheet.place(d, matrix);
        d
    }

    fn surface(&mut self, surface: &Surface) -> Result<u32, Damage> {
        match surface.to_net(&self.scale.tolerance)? {
            Some(form) => Ok(self.form(&form, Role::Free)),
            None if surface.domain() == Domain::Loop => self.bordered(surface),
            None => Err(damage("IGES has no place for a plane without a border")),
        }
    }

    fn form(&mut self, form: &NetForm, role: Role) -> u32 {
        self.off = self.off.max(form.off.distance());
        self.sampled |= matches!(form.off, Off::Sampled(_));
        self.net(&form.net, role)
    }

    fn net(&mut self, net: &NurbsSurface, role: Role) -> u32 {
        let closed = (0..2).map(|across| i64::from(is_closed(net, across == 1, &self.scale.tolerance))).collect::<Vec<_>>();
        let polynomial = net.poles.iter().all(|q| q.w == net.poles[0].w);
        let last = |n: usize| n as i64 - 1;
        let ends = |knots: &[f64]| [knots[0], knots[knots.len() - 1]];
        let range = [ends(&net.knots.0), ends(&net.knots.1)].concat();
        let values = Values::new().int(last(net.counts.0)).int(last(net.counts.1)).int(net.degree.0 as i64).int(net.degree.1 as i64);
        let values = values.int(closed[0]).int(closed[1]).int(i64::from(polynomial)).int(0).int(0);
        let values = values.reals(net.knots.0.iter().copied()).reals(net.knots.1.iter().copied());
        let values = values.reals(net.poles.iter().map(|q| q.w));
        let values = net.poles.iter().fold(values, |values, q| values.point(projected(*q) / self.scale.model));
        self.sheet.add(128, 0, role, values.reals(range))
    }

    /// A surface inside loops: its net, and each loop in (u, v) and in space.
    fn bordered(&mut self, surface: &Surface) -> Result<u32, Damage> {
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
            let uvs = in_uv.iter().map(|c| self.curve(c, Role::InUv, false)).collect::<Result<Vec<u32>, Damage>>()?;
            let mut row = |list: Vec<u32>, role| match list.len() as u32 {
                0 => 0,
                n => self.sheet.add(102, 0, role, Values::new().int(n).ints(list)),
            };
            let (uv, space) = (row(uvs, Role::InUv), row(spaces, Role::Part));
            let preferred = if uv == 0 { 2 } else { 3 };
            borders.push(self.sheet.add(142, 0, Role::InUv, Values::new().int(1).ints([base, uv, space]).int(preferred)));
        }
        let [outer, holes @ ..] = borders.as_slice() else { return Err(damage("it has no border")) };
        let values = Values::new().int(base).int(1).int(holes.len() as u32).int(*outer).ints(holes.iter().copied());
        Ok(self.sheet.add(144, 0, Role::Free, values))
    }

    /// A loop moved by whole turns to where the net has its parameters; none of it where it runs over a seam.
    fn within_net(&self, mut loop_of: Vec<Curve>) -> Result<Vec<Curve>, Damage> {
        let bounds = loop_of.iter().map(Curve::bbox).fold(Box3::EMPTY, Box3::union);
        let by = -(bounds.min + DVec3::splat(NUDGE)).floor();
        let moved = bounds.max + by;
        if moved.x > 1.0 + NUDGE || moved.y > 1.0 + NUDGE {
            return Ok(Vec::new());
        }
        if by.x != 0.0 || by.y != 0.0 {
            let m = DAffine3::from_translation(DVec3::new(by.x, by.y, 0.0));
            loop_of = loop_of.iter().map(|c| carried(c, &m, &self.scale.tolerance)).collect::<Result<_, Damage>>()?;
        }
        Ok(loop_of)
    }

    /// The net of a plane over the box of its border.
    fn plane(&mut self, surface: &Surface) -> Result<u32, Damage> {
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
    fn border(&self, surface: &Surface, ground: Option<&Base>, k: usize) -> Result<(Curve, Option<Curve>), Damage> {
        let tolerance = &self.scale.tolerance;
        let origin = surface.origin();
        let over_net = |(u, v): (f64, f64)| match surface.ground() {
            Domain::Triangle => DVec3::new(if v < 1.0 { u / (1.0 - v) } else { 0.0 }, v, 0.0),
            _ => DVec3::new(u, v, 0.0),
        };
        let lost = || damage("a side of its border has no course in (u, v)");
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
            return Ok((carried(&part, &frame.inverse(), tolerance)?, Some(part)));
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

/// Whether the first and the last line of control points are one, in u or in v.
fn is_closed(net: &NurbsSurface, in_v: bool, tolerance: &Tolerance) -> bool {
    let (nu, nv) = net.counts;
    let pairs: Vec<(usize, usize)> =
        if in_v { (0..nu).map(|i| (i, (nv - 1) * nu + i)).collect() } else { (0..nv).map(|j| (j * nu, j * nu + nu - 1)).collect() };
    pairs.iter().all(|(a, b)| tolerance.same_point(projected(net.poles[*a]), projected(net.poles[*b])))
}

fn spline(c: &Nurbs, scale: f64) -> Values {
    let points: Vec<DVec3> = (0..c.poles.len()).map(|i| c.pole(i) / scale).collect();
    let normal = plane_of(&points);
    let closed = points[0] == points[points.len() - 1];
    let values = Values::new().int(points.len() as i64 - 1).int(c.degree as i64);
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
