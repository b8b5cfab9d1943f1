//! What offsets need to know of a surface: which keep their kind with moved profiles, which have creases or tips, where they fold.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, POLE_STEP, Tolerance};
use crate::geometry::construct::build;
use crate::geometry::{Curve, height_over};
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::unit_normal;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::{SurfaceFault, WallFault};
use crate::surface::offset::boundary::whole;
use crate::surface::offset::revolved_profile::beside_axis;
use crate::surface::rails::side::Side;
use crate::surface::shapes::sweep::Path;
use crate::surface::swept::extrude::extrude;
use crate::surface::swept::revolve::{Axis, revolve};

/// Samples in each direction of a cell in which folds are sought.
const SAMPLES: usize = 16;
/// Whether the offsets of a surface have exact borders as it has: planes, and sweeps along their normals.
pub(crate) fn is_exact(surface: &Surface, tolerance: &Tolerance) -> Result<bool> {
    let named = |k: usize| matches!(surface.side(k), Side::Chain { .. } | Side::Pole(_));
    let flat = || level(surface, tolerance).is_some();
    Ok((0..surface.n_sides()).all(named) && (flat() || surface.parts().trim.is_none() && swept_by(surface)?.is_some()))
}

/// E670 where the normals of a surface jump: along a crease, or round a tip.
pub(crate) fn rough(below: &Surface, of: Origin, origin: Origin, tolerance: &Tolerance) -> Result<()> {
    if matches!(below.parts().shape, Shape::Scatter(_)) {
        return Err(WallFault::Pieces { offset: origin, surface: of }.into());
    }
    if let Some((at, angle)) = crease(below, tolerance) {
        return Err(WallFault::Creased { offset: origin, surface: of, at, angle }.into());
    }
    match tip(below, tolerance) {
        Some(at) if swept_by(below)?.is_none() => Err(WallFault::Tip { offset: origin, surface: of, at }.into()),
        _ => Ok(()),
    }
}

/// Where the normals on both sides of a line of a surface differ most, by more than the tolerance's angle.
fn crease(surface: &Surface, tolerance: &Tolerance) -> Option<(DVec3, f64)> {
    const ALONG: usize = 17;
    let places = || (0..ALONG).map(|k| (k as f64 + 0.5) / ALONG as f64);
    let (us, vs) = surface.kinks();
    let in_u = us.iter().flat_map(|u| places().map(move |v| (*u, v, true)));
    let in_v = vs.iter().flat_map(|v| places().map(move |u| (u, *v, false)));
    let jump = |(u, v, across_u): (f64, f64, bool)| {
        let sides = |side: OneSided| if across_u { (side, OneSided::After) } else { (OneSided::After, side) };
        let normal = |side: OneSided| surface.normal_one_sided(u, v, sides(side));
        (surface.point(u, v), math::angle_between(normal(OneSided::Before), normal(OneSided::After)))
    };
    let most = in_u.chain(in_v).map(jump).fold((DVec3::ZERO, 0.0), |most, next| if next.1 > most.1 { next } else { most });
    (most.1 > tolerance.angle).then_some(most)
}

/// A pole round which the normals do not come together: the tip of a cone.
fn tip(surface: &Surface, tolerance: &Tolerance) -> Option<DVec3> {
    const AROUND: usize = 16;
    const NEARER: f64 = 0.125;
    if surface.domain() != Domain::Square {
        return None;
    }
    let place = |k: usize, along: f64, inward: f64| match k {
        0 => (along, inward),
        1 => (1.0 - inward, along),
        2 => (along, 1.0 - inward),
        _ => (inward, along),
    };
    (0..4).find_map(|k| {
        let Side::Pole(p) = surface.side(k) else { return None };
        let ((u, v), side) = (place(k, 0.5, 0.0), (OneSided::After, OneSided::After));
        let upright = surface.normal_one_sided(u, v, side);
        let most_off = |inward: f64| {
            let normal = |i: usize| {
                let (u, v) = place(k, (i as f64 + 0.5) / AROUND as f64, inward);
                math::angle_between(surface.normal(u, v), upright)
            };
            (0..AROUND).map(normal).fold(0.0, f64::max)
        };
        let (far, near) = (most_off(POLE_STEP), most_off(NEARER * POLE_STEP));
        (near > tolerance.angle && near > 0.5 * far).then_some(p)
    })
}

/// The normal of a surface that is a plane, trimmed or not, up to rounding.
pub(crate) fn level(surface: &Surface, tolerance: &Tolerance) -> Option<DVec3> {
    const ALONG: usize = 9;
    if surface.kind() == SurfaceKind::Plane || surface.is_flat() {
        // Away from the borders, where a triangle has its poles.
        return math::unit(surface.untrimmed().normal(0.25, 0.25), 0.0);
    }
    let ground = surface.untrimmed();
    if ground.domain() == Domain::Triangle {
        // Within the triangle; a plane is one in its middle already.
        let at = |k: usize| k as f64 / (ALONG - 1) as f64;
        let mut places = (0..ALONG).flat_map(|j| (0..ALONG - j).map(move |i| (i, j))).map(|(i, j)| ground.point(at(i), at(j)));
        let normal = math::unit(ground.normal(0.25, 0.25), 0.0)?;
        let foot = ground.point(0.25, 0.25);
        return places.all(|p| (p - foot).dot(normal).abs() <= tolerance.rounding).then_some(normal);
    }
    if ground.domain() != Domain::Square {
        return None;
    }
    let normal = math::unit(ground.normal(0.5, 0.5), 0.0)?;
    let foot = ground.point(0.0, 0.0);
    let flat = |us: &[f64], vs: &[f64]| {
        let mut points = vec![DVec3::ZERO; us.len() * vs.len()];
        ground.grid(us, vs, &mut points);
        points.iter().all(|p| (*p - foot).dot(normal).abs() <= tolerance.rounding)
    };
    // All over it, and then in each of its pieces: a short one may be bent.
    let (us, vs) = ground.breaks();
    let places = |breaks: &[f64]| -> Vec<f64> {
        let stops = [&[0.0], breaks, &[1.0]].concat();
        let piece = |w: &[f64]| (0..ALONG).map(|k| w[0] + (w[1] - w[0]) * (k as f64 / (ALONG - 1) as f64)).collect::<Vec<_>>();
        stops.windows(2).flat_map(piece).collect()
    };
    let everywhere = places(&[]);
    let pieces = || us.is_empty() && vs.is_empty() || flat(&places(&us), &places(&vs));
    (flat(&everywhere, &everywhere) && pieces()).then_some(normal)
}

/// A profile with the unit normal of its plane.
pub(crate) struct Profile {
    curve: Curve,
    normal: DVec3,
    /// 1 where the normals of the surface are to the left of the profile, else −1.
    side: f64,
}

/// The profile of a sweep that lies in a plane which holds the normals; none for other surfaces.
pub(crate) fn swept_by(surface: &Surface) -> Result<Option<(Profile, Path)>> {
    let Shape::Sweep(sweep) = &surface.parts().shape else { return Ok(None) };
    let Some(chain) = sweep.profile().chain() else { return Ok(None) };
    let curve = chain.to_curve()?;
    let size = curve.bbox().diagonal();
    let Some(normal) = plane_of(&curve, sweep.path(), size) else { return Ok(None) };
    if height_over(&curve, normal) > NUDGE * size {
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
    Ok((side.abs() >= 1.0 - NUDGE).then(|| (Profile { curve, normal, side: side.signum() }, sweep.path())))
}

/// The parts of a face between its creases: of an untrimmed sweep those of its profile; E670 for others with creases.
pub(crate) fn parts_of(surface: &Surface, origin: Origin, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    let below = whole(surface, tolerance);
    let (us, vs) = below.kinks();
    if us.is_empty() && vs.is_empty() || level(surface, tolerance).is_some() {
        return Ok(vec![surface.clone()]);
    }
    let parts = surface.parts();
    let (Shape::Sweep(sweep), None) = (&parts.shape, &parts.trim) else {
        rough(&below, surface.origin(), origin, tolerance)?;
        return Ok(vec![surface.clone()]);
    };
    let Some(chain) = sweep.profile().chain() else { return Ok(vec![surface.clone()]) };
    let mut stops = chain.kinks(tolerance);
    let round = chain.is_closed(tolerance) && stops.first() == Some(&0.0);
    stops.retain(|f| *f > 0.0 && *f < 1.0);
    let ends: Vec<(f64, f64)> = if chain.is_closed(tolerance) && !round {
        (0..stops.len()).map(|k| (stops[k], stops[(k + 1) % stops.len()])).collect()
    } else {
        let stops = [vec![0.0], stops, vec![1.0]].concat();
        stops.windows(2).map(|w| (w[0], w[1])).collect()
    };
    let part = |(from, to): (f64, f64)| -> Result<Surface> {
        let piece = chain.slice(from, to, tolerance)?;
        let made = match sweep.path() {
            Path::Straight { by } => extrude(&piece, by, surface.origin(), tolerance)?,
            Path::Turn { about, axis, angle } => revolve(&piece, &Axis { about, direction: axis }, angle, surface.origin(), tolerance)?,
        };
        Ok(if parts.flipped { made.flipped() } else { made })
    };
    ends.into_iter().map(part).collect()
}

/// The offset of a sweep whose profile lies in a plane that holds its normals; none for other surfaces.
pub(crate) fn swept(surface: &Surface, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let Some((profile, path)) = swept_by(surface)? else { return Ok(None) };
    let moved = moved_profile(&profile, path, distance, origin, tolerance)?;
    let made = match path {
        Path::Straight { by } => extrude(&moved, by, origin, tolerance)?,
        Path::Turn { about, axis, angle } => revolve(&moved, &Axis { about, direction: axis }, angle, origin, tolerance)?,
    };
    Ok(Some(if surface.parts().flipped { made.flipped() } else { made }))
}

/// The profile of the offset of a sweep.
pub(crate) fn moved_profile(profile: &Profile, path: Path, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<Chain> {
    let moved = if distance == 0.0 {
        profile.curve.clone()
    } else {
        build::offset(&profile.curve, distance * profile.side, profile.normal, origin)?
    };
    let moved = Chain::of_curve(&moved);
    match path {
        Path::Straight { .. } => Ok(moved),
        Path::Turn { about, axis, .. } => beside_axis(&profile.curve, &moved, &Axis { about, direction: axis }, distance, tolerance),
    }
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
pub(crate) fn folds(base: &Surface, distance: f64, origin: Origin) -> Vec<Fault> {
    let (us, vs) = base.breaks();
    let places = |inner: &[f64]| {
        let stops = [&[0.0], inner, &[1.0]].concat();
        let within = stops.windows(2).flat_map(|w| {
            let at = |k: usize| w[0] + (w[1] - w[0]) * k as f64 / SAMPLES as f64;
            (0..=SAMPLES).map(move |k| if k == SAMPLES { (w[1], OneSided::Before) } else { (at(k), OneSided::After) }).collect::<Vec<_>>()
        });
        within.collect::<Vec<_>>()
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
