//! `revolve`: a profile turned about an axis.

use glam::{DVec3, DVec4};

use crate::base::fault::{Fault, Result};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, NUDGE, Tolerance};
use crate::geometry::construct::build::{arc_center, circle_start, line};
use crate::geometry::data::fault::CurveFault;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::geometry::{Motion, Nurbs};
use crate::network::{Chain, meet};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::ProfileFault;
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::sweep::{Path, Sweep};
use crate::surface::swept::extrude::{kinked, sweeps_area, unit_knots};

/// A straight axis: a point and a unit direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// A point of it.
    pub about: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

/// The axis along a straight chain, from its start to its end; E621 with the largest distance when it is not straight.
pub fn axis_of(chain: &Chain, tolerance: &Tolerance) -> Result<Axis> {
    const SAMPLES: usize = 32;
    let (start, end) = (chain.start(), chain.end());
    let direction = math::unit(end - start, tolerance.point);
    let off_line = |p: DVec3| direction.map_or(p.distance(start), |d| (p - start).reject_from_normalized(d).length());
    let stops = [vec![0.0], chain_breaks(chain), vec![1.0]].concat();
    let samples = stops.windows(2).flat_map(|w| (0..=SAMPLES).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / SAMPLES as f64));
    let (mut off, mut at) = (0.0, start);
    for p in samples.map(|f| chain.point(f)) {
        if off_line(p) > off {
            (off, at) = (off_line(p), p);
        }
    }
    match direction {
        Some(direction) if off <= tolerance.point => Ok(Axis { about: start, direction }),
        _ => Err(ProfileFault::AxisNotStraight { axis: chain.origin(), off, at }.into()),
    }
}

/// Whether the profile comes back to itself within the tolerance; `short` is what the angle lacks of a turn, in radians: files write
/// angles with ten digits.
fn is_whole_turn(profile: &Chain, axis: &Axis, short: f64, tolerance: &Tolerance) -> bool {
    let turn = std::f64::consts::TAU;
    if short <= turn * EPSILON || short > turn * NUDGE {
        return short <= turn * EPSILON;
    }
    let bbox = profile.bbox();
    let farthest = (bbox.center() - axis.about).cross(axis.direction).length() + 0.5 * bbox.diagonal();
    short * farthest <= tolerance.point
}

/// The surface S(u, v) = o + Rot(a, u·angle)(profile(v) − o); angle in radians, at most one turn either way, and a whole one where
/// the profile comes back to itself within the tolerance.
///
/// Ends of the profile on the axis are poles; a whole turn closes in u with its seam at the profile. Fails with E411,
/// E412 for the angle, E622 when the profile runs in the axis, E623 when it meets it between its ends,
/// E624 where it is turned along itself.
pub fn revolve(profile: &Chain, axis: &Axis, angle: f64, origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let turn = std::f64::consts::TAU;
    if angle == 0.0 {
        return Err(CurveFault::ZeroAngle { of: origin, argument: "angle" }.into());
    }
    if angle.is_nan() || angle.abs() > turn * (1.0 + EPSILON) {
        return Err(CurveFault::AngleTooLarge { of: origin, argument: "angle", angle }.into());
    }
    let closed_u = is_whole_turn(profile, axis, turn - angle.abs(), tolerance);
    let angle = if closed_u { turn * angle.signum() } else { angle };
    clear_of_axis(profile, axis, tolerance)?;
    let (rail, kinks) = kinked(profile, tolerance);
    let closed_v = profile.is_closed(tolerance);
    let mut generated = Vec::new();
    let copy = if closed_u {
        profile.clone()
    } else {
        let copy = profile.moved(&Motion::rotation(axis.about, axis.direction, angle)).with_origin(origin);
        generated.push(copy.clone());
        copy
    };
    let mut path = |p: DVec3| -> Result<Border> {
        let foot = axis.about + axis.direction * axis.direction.dot(p - axis.about);
        if p.distance(foot) <= tolerance.point {
            return Ok(Border::straight(Side::Pole(foot)));
        }
        let up = axis.direction * angle.signum();
        let circle = if closed_u { circle_start(foot, p, up, origin)? } else { arc_center(foot, p, angle.abs(), up, origin)? };
        let chain = Chain::of_curve(&circle);
        generated.push(chain.clone());
        Ok(Border::chain(chain, false))
    };
    let first = path(profile.start())?;
    let last = if closed_v { first.clone() } else { path(profile.end())? };
    let poles = [&first, &last].iter().filter(|border| matches!(border.side, Side::Pole(_))).count();
    let surface = Surface::new(Parts {
        origin,
        kind: SurfaceKind::Revolve,
        flow: phrase(poles, (closed_u, closed_v)),
        domain: Domain::Square,
        closed: (closed_u, closed_v),
        borders: vec![first, Border::chain(copy, false), last, Border::chain(profile.clone(), false)],
        kinks: (Vec::new(), kinks),
        shape: Shape::Sweep(Sweep::new(rail, Path::Turn { about: axis.about, axis: axis.direction, angle })),
        chains: vec![profile.clone()],
        generated,
        trim: None,
        flipped: false,
    });
    sweeps_area(&surface, profile, tolerance)?;
    Ok(surface)
}

/// Checks that the profile touches the axis with its ends only.
fn clear_of_axis(profile: &Chain, axis: &Axis, tolerance: &Tolerance) -> Result<()> {
    let bounds = profile.bbox();
    let middle = axis.direction.dot(bounds.center() - axis.about);
    let reach = bounds.diagonal().max(tolerance.point) * 2.0;
    let at = |x: f64| axis.about + axis.direction * x;
    let straight = Chain::of_curve(&line(at(middle - reach), at(middle + reach), Origin::NONE)?);
    let closed = profile.is_closed(tolerance);
    for hit in meet(profile, &straight, tolerance)? {
        if let Some((end, _)) = hit.overlap_end {
            let to = profile.point(end);
            if hit.point.distance(to) > tolerance.point {
                return Err(ProfileFault::GeneratrixOnAxis { profile: profile.origin(), from: hit.point, to }.into());
            }
        }
        let from_end = hit.fa.min(1.0 - hit.fa) * profile.length();
        if from_end > tolerance.point || closed {
            return Err(Fault::from(ProfileFault::GeneratrixCrossesAxis { profile: profile.origin(), at: hit.point, fraction: hit.fa }));
        }
    }
    Ok(())
}

/// The exact net of a turned profile: arcs of at most 90° in u, the profile's degree in v.
pub fn net(profile: &Nurbs, axis: &Axis, angle: f64) -> NurbsSurface {
    // A unit arc says the weights and how far out its middle poles stand.
    let unit = EllipticArc::new(DVec3::ZERO, DVec3::X, DVec3::Y, angle.abs()).to_nurbs();
    let sign = angle.signum();
    let (nu, nv) = (unit.poles.len(), profile.poles.len());
    let mut poles = Vec::with_capacity(nu * nv);
    for q in &profile.poles {
        let p = projected(*q);
        let still = axis.direction * axis.direction.dot(p - axis.about);
        let (out, across) = (p - axis.about - still, axis.direction.cross(p - axis.about));
        poles.extend(unit.poles.iter().map(|arc: &DVec4| {
            let place = projected(*arc);
            weighted(axis.about + still + out * place.x + across * (sign * place.y), arc.w * q.w)
        }));
    }
    NurbsSurface { degree: (2, profile.degree), knots: (unit_knots(&unit), unit_knots(profile)), poles, counts: (nu, nv) }
}
