//! Moved profiles of revolutions: they begin and end on the axis where the profile does, and stay on their side of it.

use glam::DVec3;

use crate::base::fault::{LengthRange, Result, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::geometry::construct::build::line;
use crate::network::{Chain, meet};
use crate::surface::swept::revolve::Axis;

/// Places at which the distance from the axis is looked at.
const PLACES: usize = 64;

/// An offset of a profile as the profile of a revolution. Where an end of the profile is on the axis, the offset is cut off there or
/// runs on straight to it.
///
/// Fails with E306 where the distance takes it over the axis.
pub(crate) fn beside_axis(profile: &Curve, moved: &Chain, axis: &Axis, distance: f64, tolerance: &Tolerance) -> Result<Chain> {
    let out = |p: DVec3| (p - axis.about).reject_from_normalized(axis.direction);
    let far =
        profile.points_along(PLACES).into_iter().map(out).fold(DVec3::ZERO, |most, p| if p.length() > most.length() { p } else { most });
    let Some(outward) = math::unit(far, 0.0) else { return Ok(moved.clone()) };
    let on_axis = |p: DVec3| out(p).length() <= tolerance.point;
    let mut made = moved.clone();
    for (last, end) in [(false, profile.start()), (true, profile.end())] {
        if on_axis(end) {
            made = to_axis(&made, last, axis, outward, tolerance)?;
        }
    }
    let lowest = (0..=PLACES).map(|k| made.point(k as f64 / PLACES as f64));
    let lowest = lowest.min_by(|p, q| out(*p).dot(outward).total_cmp(&out(*q).dot(outward)));
    if let Some(p) = lowest.filter(|p| out(*p).dot(outward) < -tolerance.point) {
        // The place of the profile that it is beside, and how far the axis is from there.
        let foot = crate::geometry::closest(profile, p).point;
        let radius = out(foot).length() / ((out(foot) - out(p)).length() / distance.abs());
        let range = LengthRange::BelowRadius(radius, Some(foot));
        return Err(ValueFault::LengthOutside { argument: "distance", found: distance, range }.into());
    }
    Ok(made)
}

/// A chain that ends on the axis: cut there, or longer by a straight line.
fn to_axis(chain: &Chain, last: bool, axis: &Axis, outward: DVec3, tolerance: &Tolerance) -> Result<Chain> {
    let end = if last { chain.end() } else { chain.start() };
    let height = (end - axis.about).dot(outward);
    if height.abs() <= tolerance.point {
        return Ok(chain.clone());
    }
    if height < 0.0 {
        let (middle, reach) = (axis.direction.dot(end - axis.about), 2.0 * chain.bbox().diagonal());
        let at = |x: f64| axis.about + axis.direction * x;
        let straight = Chain::of_curve(&line(at(middle - reach), at(middle + reach), Origin::NONE)?);
        let hits = meet(chain, &straight, tolerance)?;
        let first = hits.iter().map(|hit| hit.fa).reduce(if last { f64::max } else { f64::min });
        return match (first, last) {
            (Some(f), true) => chain.slice(0.0, f, tolerance),
            (Some(f), false) => chain.slice(f, 1.0, tolerance),
            (None, _) => Ok(chain.clone()),
        };
    }
    let tangent = if last { chain.jet_before(1.0).d1 } else { -chain.jet(0.0).d1 };
    let slope = -tangent.dot(outward);
    if slope <= tolerance.angle * tangent.length() {
        return Ok(chain.clone());
    }
    let tip = end + tangent * (height / slope);
    let more = Chain::of_curve(&line(end, tip, chain.origin())?);
    if last {
        Chain::join(&[chain.clone(), more], chain.origin(), tolerance)
    } else {
        Chain::join(&[more.reversed(), chain.clone()], chain.origin(), tolerance)
    }
}
