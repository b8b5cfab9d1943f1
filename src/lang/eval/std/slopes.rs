//! Directions and curvatures of curves and surfaces at a place.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::base::tolerance::NUDGE;
use crate::builtins;
use crate::geometry::data::jet::Jet;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::network::fraction_of;
use crate::lang::eval::std::surfaces::checked_uv;
use crate::lang::values::conversions::{Direction, FromValue, Station};
use crate::lang::values::types::Ty;
use crate::lang::values::value::{Dim, Quantity, Record, Value};
use crate::network::Chain;
use crate::surface::{Nearest, Surface};

/// 1 / length.
const PER_LENGTH: Dim = Dim { length: -1, angle: 0, mass: 0 };

/// A place on a surface: a point, which stands for its foot, or u.
#[derive(Clone, Copy, Debug)]
pub enum SurfacePlace {
    /// A point, on the surface or beside it.
    Point(DVec3),
    /// u.
    U(f64),
}

impl FromValue for SurfacePlace {
    const TY: Ty = Ty::OneOf(&[Ty::Point, Ty::Quantity(Dim::NONE)]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Vector(p, _) | Value::Node(p) => Some(Self::Point(p)),
            Value::Number(q) => Some(Self::U(q.value)),
            _ => None,
        }
    }
}

/// u and v of a place that is given by a point or by both numbers.
fn place_of(surface: &Surface, place: SurfacePlace, v: Option<f64>, function: &'static str) -> Result<(f64, f64), Halt> {
    match (place, v) {
        (SurfacePlace::Point(p), None) => Ok(Nearest::new(surface).at(p).uv),
        (SurfacePlace::U(u), Some(v)) => checked_uv(surface, (u, "u"), (v, "v")),
        _ => Err(ValueFault::Missing { function, what: "a point, or u and v", example: "roof.normal(0.5, 0.5)" }.into()),
    }
}

/// Derivatives of a curve at a place; at a corner those after it, at the end those before.
fn jet_at(cx: &Cx, of: &Chain, at: Station) -> Result<Jet, Halt> {
    let f = fraction_of(cx, of, at, "at")?;
    Ok(if f >= 1.0 { of.jet_before(1.0) } else { of.jet(f) })
}

fn record<const N: usize>(cx: &mut Cx, fields: [(&str, Value); N]) -> Value {
    let keys = fields.iter().map(|(key, _)| cx.program.names.intern(key)).collect();
    Value::Record(Arc::new(Record { keys: Arc::new(keys), values: fields.map(|(_, value)| value).into(), row: false, part: None }))
}

builtins! {
    /// The unit direction of a curve at a place along it.
    ///
    /// The place is a fraction of its length or a length from its start; at a corner the direction is the one after it.
    /// ```loft
    /// curve bow = arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 2m))
    /// check angle(bow.tangent(50%), (1, 0, 0)) < 1e-9deg
    /// ```
    fn tangent(
        /// A curve.
        of: Chain,
        /// Fraction or length along it.
        at: Station,
    ) -> Direction = |cx, of, at| Ok(Direction(jet_at(cx, &of, at)?.d1.normalize_or_zero()));

    /// The moving frame of a curve at a place along it.
    ///
    /// A record of `point`, `tangent`, `normal`, `binormal` and `curvature`, 1 / radius. The normal is on the side to which the curve bends;
    /// where it is straight, across the tangent in the plane of it and the z axis (the x axis where it runs along z). The binormal is
    /// tangent × normal.
    /// ```loft
    /// curve bow = arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 2m))
    /// let f = bow.frame(50%)
    /// check angle(f.normal, (0, 0, -1)) < 1e-9deg
    /// check 1 / f.curvature == 2m within 1e-9%
    /// ```
    fn frame(
        /// A curve.
        of: Chain,
        /// Fraction or length along it.
        at: Station,
    ) -> Value = |cx, of, at| {
        let jet = jet_at(cx, &of, at)?;
        let tangent = jet.d1.normalize_or_zero();
        let bend = jet.d2.reject_from(jet.d1);
        let straight = bend.length() <= NUDGE * jet.d1.length();
        let up = if tangent.cross(DVec3::Z).length() > NUDGE { DVec3::Z } else { DVec3::X };
        let normal = if straight { up.reject_from(tangent) } else { bend }.normalize_or_zero();
        let direction = |d: DVec3| Value::Vector(d, Dim::NONE);
        let point = Value::Vector(jet.p, Dim::LENGTH);
        let curvature = Value::Number(Quantity::new(if straight { 0.0 } else { bend.length() / jet.d1.length_squared() }, PER_LENGTH));
        let directions = [("tangent", tangent), ("normal", normal), ("binormal", tangent.cross(normal))];
        let [tangent, normal, binormal] = directions.map(|(key, d)| (key, direction(d)));
        Ok(record(cx, [("point", point), tangent, normal, binormal, ("curvature", curvature)]))
    };

    /// The unit normal of a surface at u and v, or at the foot of a point.
    ///
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let n = wall.normal(0.5, 0.5)
    /// let there = wall.normal((1m, 5m, 1m))
    /// ```
    fn normal(
        /// A surface.
        of: Surface,
        /// A point, or u from 0 to 1.
        u: SurfacePlace,
        /// From 0 to 1.
        v: Option<f64>,
    ) -> Direction = |_, of, u, v| {
        let (u, v) = place_of(&of, u, v, "normal")?;
        Ok(Direction(of.normal(u, v)))
    };

    /// The curvatures of a surface at u and v, or at the foot of a point.
    ///
    /// A record of `most` and `least`, the principal curvatures, `mean` and `gauss`. A curvature is above 0 where the surface bends to the
    /// side of its normal.
    /// ```loft
    /// surface tube = extrude(circle(center: (0, 0, 0), radius: 2m), by: (0, 0, 3m))
    /// let k = curvatures(tube, 0.5, 0.5)
    /// check max(abs(k.most), abs(k.least)) == 1 / 2m within 1e-9%
    /// check k.gauss == 0 / 1m2 within 1e-9 / 1m2
    /// ```
    fn curvatures(
        /// A surface.
        of: Surface,
        /// A point, or u from 0 to 1.
        u: SurfacePlace,
        /// From 0 to 1.
        v: Option<f64>,
    ) -> Value = |cx, of, u, v| {
        let (u, v) = place_of(&of, u, v, "curvatures")?;
        let (mean, off) = of.jet(u, v).curvatures(of.normal(u, v));
        if !mean.is_finite() {
            let (found, range) = (format!("u {u}, v {v}"), "a place where the surface has a normal".to_owned());
            return Err(ValueFault::OutsideRange { argument: "u", found, range }.into());
        }
        let number = |value: f64, dim: Dim| Value::Number(Quantity::new(value, dim));
        let gauss = number(mean * mean - off * off, Dim { length: -2, ..PER_LENGTH });
        let one = |value: f64| number(value, PER_LENGTH);
        Ok(record(cx, [("most", one(mean + off)), ("least", one(mean - off)), ("mean", one(mean)), ("gauss", gauss)]))
    };
}
