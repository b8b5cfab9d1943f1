//! Surfaces at a distance from another one, along its normals.
//!
//! Planes, extrusions across the plane of their profile and revolutions keep their kind, with moved profiles. What is left is a
//! bicubic net within the tolerance of S + d·n, whose first derivatives are exact at its knots.

use glam::DVec3;

use super::Jet2;
use super::core::{Domain, Surface, SurfaceKind, unit_normal};
use super::extrude::extrude;
use super::rail::Lean;
use super::revolve::{Axis, revolve};
use super::shape::Shape;
use super::sweep::Path;
use crate::base::fault::{Fault, Result, SurfaceFault, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::geometry::{Curve, Motion, build, height_over};
use crate::network::Chain;

/// Samples in each direction of a cell in which folds are sought.
const SAMPLES: usize = 16;
/// Share of the tolerance for a net below another one.
const BELOW: f64 = 0.25;

/// The surface at `distance` (model units, positive on the side of the normal), and W664 where it folds over.
///
/// Fails with E306 where a profile turns tighter than the distance, and with E230 for trimmed surfaces that are no planes and for
/// creased ones that are no sweeps.
pub fn offset(surface: &Surface, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    if distance == 0.0 {
        return Ok((surface.with_origin(origin), Vec::new()));
    }
    if let Some(normal) = level(surface, tolerance) {
        return Ok((surface.moved(&Motion::translation(normal * distance)).with_origin(origin), Vec::new()));
    }
    let later = |what: &str| Err(ValueFault::NotInThisVersion { what: format!("`offset` of {what}") }.into());
    if surface.kind() == SurfaceKind::Trim {
        return later("a trimmed surface that is no plane");
    }
    if let Some(exact) = swept(surface, distance, origin, tolerance)? {
        return Ok((exact, Vec::new()));
    }
    let (us, vs) = surface.kinks();
    if !us.is_empty() || !vs.is_empty() {
        return later("a surface with creases");
    }
    let square = match surface.domain() {
        Domain::Triangle => {
            let fine = Tolerance { point: BELOW * tolerance.point, ..*tolerance };
            surface.to_net(&fine)?.map(|form| form.net.surface(SurfaceKind::Nurbs, surface.origin(), tolerance))
        }
        _ => None,
    };
    let base = square.as_ref().unwrap_or(surface);
    let net = base.offset_net(distance, tolerance)?;
    Ok((net.surface(SurfaceKind::Offset, origin, tolerance), folds(base, distance, origin)))
}

/// The normal of a surface that is a plane, trimmed or not, up to rounding.
pub(super) fn level(surface: &Surface, tolerance: &Tolerance) -> Option<DVec3> {
    const ALONG: usize = 9;
    if surface.kind() == SurfaceKind::Plane || surface.is_flat() {
        // Away from the borders, where a triangle has its poles.
        return math::unit(surface.untrimmed().normal(0.25, 0.25), 0.0);
    }
    let ground = surface.untrimmed();
    if ground.domain() != Domain::Square {
        return None;
    }
    let places: Vec<f64> = (0..ALONG).map(|k| k as f64 / (ALONG - 1) as f64).collect();
    let mut points = vec![DVec3::ZERO; ALONG * ALONG];
    ground.grid(&places, &places, &mut points);
    let normal = math::unit(ground.normal(0.5, 0.5), 0.0)?;
    let within = |p: &DVec3| (*p - points[0]).dot(normal).abs() <= tolerance.rounding;
    points.iter().all(within).then_some(normal)
}

/// The offset of a sweep whose profile lies in a plane that holds its normals; none for other surfaces.
fn swept(surface: &Surface, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let Shape::Sweep(sweep) = &surface.parts().shape else { return Ok(None) };
    let Some(chain) = sweep.profile().chain() else { return Ok(None) };
    let profile = chain.to_curve()?;
    let size = profile.bbox().diagonal();
    let Some(normal) = plane_of(&profile, sweep.path(), size) else { return Ok(None) };
    if height_over(&profile, normal) > NUDGE * size {
        return Ok(None);
    }
    // Which side of the profile the normals are on, where they are clearest.
    let left = |f: f64| {
        let tangent = math::unit(chain.jet(f).d1, 0.0).unwrap_or_default();
        let v = if surface.parts().flipped { 1.0 - f } else { f };
        surface.normal(0.0, v).dot(normal.cross(tangent))
    };
    const PLACES: usize = 7;
    let sides = (0..PLACES).map(|k| left((k as f64 + 0.5) / PLACES as f64));
    let side = sides.fold(0.0, |most: f64, s| if s.abs() > most.abs() { s } else { most });
    if side.abs() < 1.0 - NUDGE {
        return Ok(None);
    }
    let moved = Chain::of_curve(&build::offset(&profile, distance * side.signum(), normal, origin)?);
    let made = match sweep.path() {
        Path::Straight { by } => extrude(&moved, by, origin, tolerance)?,
        Path::Turn { about, axis, angle } => revolve(&moved, &Axis { about, direction: axis }, angle, origin, tolerance)?,
    };
    Ok(Some(if surface.parts().flipped { made.flipped() } else { made }))
}

/// Unit normal of the plane in which the profile's normals would lie.
fn plane_of(profile: &Curve, path: Path, size: f64) -> Option<DVec3> {
    match path {
        Path::Straight { by } => math::unit(by, 0.0),
        Path::Turn { about, axis, .. } => {
            const ALONG: usize = 8;
            let out = |p: DVec3| (p - about).reject_from_normalized(axis);
            let places = profile.points_along(ALONG);
            let far = places.into_iter().map(out).fold(DVec3::ZERO, |most, p| if p.length() > most.length() { p } else { most });
            let normal = math::unit(axis.cross(far), 0.0)?;
            ((profile.start() - about).dot(normal).abs() <= NUDGE * size).then_some(normal)
        }
    }
}

/// Where the offset turns back over itself: some radius of curvature on its side is below the distance.
fn folds(base: &Surface, distance: f64, origin: Origin) -> Vec<Fault> {
    let (us, vs) = base.breaks();
    let places = |inner: &[f64]| {
        let stops = [&[0.0], inner, &[1.0]].concat();
        let within = stops.windows(2).flat_map(|w| (0..SAMPLES).map(move |k| w[0] + (w[1] - w[0]) * (k as f64 + 0.5) / SAMPLES as f64));
        within.map(|x| (x, Lean::After)).collect::<Vec<_>>()
    };
    let jets = base.jets(&places(&us), &places(&vs));
    let tightest = jets.iter().filter_map(|jet| {
        let (mean, apart) = jet.curvatures(unit_normal(jet)?);
        let bend = if distance > 0.0 { mean + apart } else { apart - mean };
        bend.is_finite().then_some((bend, jet.p))
    });
    let most = tightest.fold((0.0, DVec3::ZERO), |most, next| if next.0 > most.0 { next } else { most });
    if most.0 * distance.abs() <= 1.0 {
        return Vec::new();
    }
    vec![SurfaceFault::OffsetFolds { surface: origin, distance, largest: 1.0 / most.0, at: most.1 }.into()]
}

/// The jet at a distance: point, ∂u, ∂v and ∂uv; zero where a surface has no normal.
pub(super) fn beside(surface: &Surface, (u, v): ((f64, Lean), (f64, Lean)), distance: f64) -> Jet2 {
    let lean = (u.1, v.1);
    let step = |x: (f64, Lean)| if x.1 == Lean::After && x.0 + NUDGE <= 1.0 || x.0 < NUDGE { NUDGE } else { -NUDGE };
    let (du, dv) = (step(u), step(v));
    let jet = surface.jet_lean(u.0, v.0, lean);
    let normal = |u: f64, v: f64| surface.normal_lean(u, v, lean);
    let n = normal(u.0, v.0);
    let differences = || ((normal(u.0 + du, v.0) - n) / du, (normal(u.0, v.0 + dv) - n) / dv);
    let (nu, nv) = slopes(&jet).unwrap_or_else(differences);
    let beyond = slopes(&surface.jet_lean(u.0, v.0 + dv, lean)).map_or(nu, |next| next.0);
    Jet2 {
        p: jet.p + n * distance,
        du: jet.du + nu * distance,
        dv: jet.dv + nv * distance,
        duv: jet.duv + (beyond - nu) * (distance / dv),
        ..Jet2::default()
    }
}

/// ∂u and ∂v of the unit normal; none where it is singular.
pub(super) fn slopes(jet: &Jet2) -> Option<(DVec3, DVec3)> {
    let normal = unit_normal(jet)?;
    let length = jet.du.cross(jet.dv).length();
    let across = |w: DVec3| (w - normal * normal.dot(w)) / length;
    Some((across(jet.duu.cross(jet.dv) + jet.du.cross(jet.duv)), across(jet.duv.cross(jet.dv) + jet.du.cross(jet.dvv))))
}
