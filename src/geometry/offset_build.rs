//! Makes offsets of plane curves: exact lines and arcs where they are, else curves that follow their base.

use glam::DVec3;

use super::arc::EllipticArc;
use super::curve::{Curve, Kind, Shape};
use super::offset::Offset;
use crate::base::fault::{CurveFault, Result, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::NUDGE;

/// Offset of a plane curve by `distance` to the left seen against the vector `normal`.
pub fn offset(curve: &Curve, distance: f64, normal: DVec3, origin: Origin) -> Result<Curve> {
    super::build::finite(DVec3::splat(distance), "distance", origin)?;
    super::build::finite(normal, "normal", origin)?;
    let Some(normal) = math::unit(normal, 0.0) else {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "normal", needed: "with a length" }.into());
    };
    let shape = match curve.shape() {
        Shape::Line(a, b) => {
            let by = normal.cross(*b - *a).normalize() * distance;
            Shape::Line(*a + by, *b + by)
        }
        Shape::Arc(arc) if arc.radius.is_some() => Shape::Arc(round(arc, distance, normal)?),
        _ => Shape::Offset(Box::new(Offset { base: curve.clone(), distance, normal })),
    };
    Ok(Curve::new(shape, Kind::Offset, origin))
}

fn round(arc: &EllipticArc, distance: f64, normal: DVec3) -> Result<EllipticArc> {
    let radius = arc.u.length();
    let turn = arc.u.cross(arc.v).dot(normal).signum();
    let new = radius - distance * turn;
    if new <= NUDGE * radius {
        return Err(ValueFault::OutsideRange {
            argument: "distance",
            found: distance.to_string(),
            range: format!("below the radius, {radius}"),
        }
        .into());
    }
    let scale = new / radius;
    Ok(EllipticArc { u: arc.u * scale, v: arc.v * scale, radius: Some(new), ..*arc })
}
