//! `blend`: the surface that a ball leaves when it rolls along the edge of two surfaces and touches both.
//!
//! Its centre runs along the curve in which the offsets of both meet; its arcs end where it touches. Straight and round rolls are
//! extrusions and revolutions, exactly. Others are nets through arcs at stations, cubic between them in the direction of the roll.
//! Where a surface changes its curvature at once, so do the speeds of the points that touch: there a net has two stations in one place.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::data::fault::CurveFault;
use crate::network::Chain;
use crate::surface::core::plane;
use crate::surface::core::surface::Surface;
use crate::surface::faults::{BlendFault, NoBlend};
use crate::surface::intersect::with_surfaces::with_surfaces;
use crate::surface::rolling::ball::Ball;
use crate::surface::rolling::ball_surface::rolled;
use crate::surface::rolling::cut::cut_back;
use crate::surface::rolling::ends::ended;
use crate::surface::rolling::largest;

/// The rounding of the edge in which two surfaces meet: the first one cut back to it, the rounding, the second one cut back.
///
/// The rounding has u along the edge and v from the first surface to the second; its normal is on the side of the first one's.
/// Where a surface runs on beyond the edge, the part on the side of the point `keep` stays; without one the ball is on the side of the
/// other one's normal. Radius in model units, above 0.
///
/// Fails with E673 where the radius is too large, E674 where there is no one smooth edge or it ends inside a surface, E657 where
/// the surfaces run along each other.
pub fn rolling([a, b]: [&Surface; 2], radius: f64, keep: Option<DVec3>, origin: Origin, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    let edge = edge(a, b, origin, tolerance)?;
    let ball = Ball::new([a, b], edge, keep, tolerance)?;
    let made = |stations, radius: f64| -> Result<Vec<Surface>> {
        let roll = ended(&ball, rolled(&ball, radius, stations, origin)?, origin)?;
        let side = |k: usize| cut_back(&ball, k, &roll, origin);
        let (first, second) = (side(0)?.cut_from(std::slice::from_ref(a)), side(1)?.cut_from(std::slice::from_ref(b)));
        Ok(vec![first, roll.surface, second])
    };
    let is_made = |stations, radius: f64| made(stations, radius).is_ok();
    let stations = largest::stations(&ball, radius, origin, is_made)?;
    made(stations, radius).map_err(|fault| {
        // What is lost on the way may be too large for it.
        if let Some(CurveFault::NotConverged { at, .. }) = fault.of() {
            return largest::above_made(&ball, radius, *at, origin, is_made).unwrap_or(fault);
        }
        fault
    })
}

/// The one curve in which two surfaces meet; it may have no corners.
fn edge(a: &Surface, b: &Surface, origin: Origin, tolerance: &Tolerance) -> Result<Chain> {
    // Planes without a map: that of a plane face may have poles on the edge.
    let of = |s: &Surface| plane::unmapped(s, tolerance);
    let common = with_surfaces(&[of(a)?], &[of(b)?], origin, tolerance)?;
    let none = |why: NoBlend| BlendFault::NoEdge { a: a.origin(), b: b.origin(), why };
    let edge = match common.curves.as_slice() {
        [] => return Err(none(NoBlend::Apart { touch: common.touches.first().copied() }).into()),
        [one] => one.clone(),
        several => return Err(none(NoBlend::Several { middles: several.iter().map(|c| c.point(0.5)).collect() }).into()),
    };
    match edge.kinks(tolerance).first() {
        Some(f) => Err(none(NoBlend::Corner { at: edge.point(*f) }).into()),
        None => Ok(edge),
    }
}
