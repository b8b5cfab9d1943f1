//! Mass properties: area, volume, centroid and inertia of surfaces and shells, and boxes.
//!
//! Everything is an integral over (u, v) to `MEASURE_ACCURACY` of the sum of absolute values, split where a surface is
//! less than analytic; volumes come from the divergence theorem over the faces of a closed shell. A plane is measured
//! by its boundary, exactly also where its map folds over.

use glam::{DMat3, DVec3};

pub use super::measure_below::Below;
use super::measure_cut_triangles::cut_triangles_integral;
use super::measure_flat::flat_integral;
use super::measure_quadrature::{Integrand, Rectangle, WHOLE, integral};
use super::measure_triangles::triangles_integral;
pub use super::measure_trimmed::border_crossings;
use super::measure_trimmed::trimmed_integral;
use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::par;
use crate::base::quadrature::integrate;
use crate::base::tolerance::{LEAST_SIZE, MEASURE_ACCURACY, SIGN_ACCURACY, TOLD_APART, Tolerance};
use crate::base::work;
use crate::network::Chain;
use crate::surface::faults::CutFault;
use crate::surface::{Domain, Jet2, Surface, SurfaceKind, bbox, boxed, chain_breaks};

/// A thin sheet of mass 1 per area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Area, square model units.
    pub area: f64,
    /// Centre of the area.
    pub centroid: DVec3,
    /// Inertia about the centroid: Σ (|r|² 1 − r rᵀ) over the area, model units to the fourth power.
    pub inertia: DMat3,
    /// Estimated error of the area, relative.
    pub error: f64,
}

/// A solid of mass 1 per volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Volume, cubic model units; positive when the normals point outwards.
    pub volume: f64,
    /// Centre of the volume.
    pub centroid: DVec3,
    /// Inertia about the centroid: Σ (|r|² 1 − r rᵀ) over the volume, model units to the fifth power.
    pub inertia: DMat3,
    /// Estimated error of the volume, relative.
    pub error: f64,
}

/// Area of one surface, square model units; 0 for an unbounded plane's (it has none).
pub fn area(surface: &Surface) -> f64 {
    area_within(surface).0
}

/// Areas of surfaces, each as [`area`] has it.
pub fn areas(surfaces: &[Surface]) -> Vec<f64> {
    par::map(surfaces.len(), |k| area(&surfaces[k]))
}

/// Areas of surfaces and the estimates of their errors, each as [`area_within`] has it.
pub fn areas_within(surfaces: &[Surface]) -> Vec<(f64, f64)> {
    par::map(surfaces.len(), |k| area_within(&surfaces[k]))
}

/// Area of one surface as [`area`] has it, and the estimate of its error, both square model units.
pub fn area_within(surface: &Surface) -> (f64, f64) {
    surface.area_once(|| {
        let (area, error) = over(surface, DVec3::ZERO, MEASURE_ACCURACY, &|jet, _| [jet.du.cross(jet.dv).length()]);
        (area[0], error[0])
    })
}

/// Fails with E721 where the areas of the parts into which curves divide a surface, each with its error, do not add up to its own, within
/// the errors of all and what vertices that are one within tolerances may take from each part, and a strip as wide as the tolerance along each cut, which is
/// within that of the surface.
pub fn adds_up(whole: &Surface, cuts: &[Chain], parts: &[(f64, f64)], tolerance: &Tolerance) -> Result<()> {
    /// Area about a vertex, in squares of the distance within which ends are one vertex, and share of the whole.
    const ROOM: (f64, f64) = (4.0, 1e3 * MEASURE_ACCURACY);
    let (own, error) = area_within(whole);
    let (sum, errors) = parts.iter().fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    let vertex = TOLD_APART * tolerance.point;
    let vertices = (whole.n_sides() + 2 * (cuts.len() + parts.len())) as f64;
    let strips = tolerance.point * cuts.iter().map(Chain::length).sum::<f64>();
    let room = ROOM.0 * vertices * vertex * vertex + strips + ROOM.1 * own + error + errors;
    if whole.domain() == Domain::Unbounded || (sum - own).abs() <= room {
        return Ok(());
    }
    let cuts = cuts.iter().map(Chain::origin).collect();
    Err(CutFault::PartsNotWhole { surface: whole.origin(), cuts, whole: own, parts: sum, tolerance: tolerance.point }.into())
}

/// Area of the part of a surface between two values of u and two of v, square model units; of a plane without a map and
/// of a triangle that of the whole.
pub fn area_between(surface: &Surface, part: Rectangle) -> f64 {
    if part == WHOLE || surface.domain() != Domain::Square {
        return area(surface);
    }
    let size = |jet: &Jet2| [jet.du.cross(jet.dv).length()];
    work::metered(|meter| integral(surface, part, MEASURE_ACCURACY, Integrand { value: &size, size: &size }, meter)).0[0]
}

/// Centre of the length of a curve.
pub fn curve_centroid(chain: &Chain) -> DVec3 {
    const DEPTH: u32 = 24;
    let stops = [vec![0.0], chain_breaks(chain), vec![1.0]].concat();
    let (about, allowed) = (chain.point(0.5), MEASURE_ACCURACY * chain.length());
    let along =
        |k: usize| -> f64 { stops.windows(2).map(|w| integrate(w[0], w[1], 0.0, allowed, DEPTH, |f| (chain.point(f) - about)[k]).0).sum() };
    about + DVec3::new(along(0), along(1), along(2))
}

/// Area, centroid and inertia of surfaces taken together.
pub fn sheet(surfaces: &[Surface]) -> Sheet {
    let about = center(surfaces);
    let parts = par::map(surfaces.len(), |k| {
        over(&surfaces[k], about, MEASURE_ACCURACY, &|jet, r| {
            let a = jet.du.cross(jet.dv).length();
            [a, a * r.x, a * r.y, a * r.z, a * r.x * r.x, a * r.y * r.y, a * r.z * r.z, a * r.x * r.y, a * r.y * r.z, a * r.z * r.x]
        })
    });
    let (sum, error) = total(&parts);
    let (mass, centroid, inertia) = about_centroid(&sum, about);
    Sheet { area: mass, centroid, inertia, error: relative(error[0], mass) }
}

/// Volume, centroid and inertia of what surfaces enclose; `true` uses a surface's other side. Normals must point outwards.
///
/// Means what it says for closed shells only. With normals inwards the volume is negative, the rest the same.
pub fn solid(faces: &[(Surface, bool)]) -> Solid {
    let surfaces: Vec<Surface> = faces.iter().map(|(surface, other)| if *other { surface.flipped() } else { surface.clone() }).collect();
    let about = center(&surfaces);
    let parts = par::map(surfaces.len(), |k| {
        over(&surfaces[k], about, MEASURE_ACCURACY, &|jet, r| {
            // ∫ x² y dV = ½ ∮ … and so on: the divergence theorem with one primitive each.
            let n = jet.du.cross(jet.dv);
            let (x, y, z) = (r.x, r.y, r.z);
            [
                r.dot(n) / 3.0,
                x * x * n.x / 2.0,
                y * y * n.y / 2.0,
                z * z * n.z / 2.0,
                x * x * x * n.x / 3.0,
                y * y * y * n.y / 3.0,
                z * z * z * n.z / 3.0,
                x * x * y * n.x / 2.0,
                y * y * z * n.y / 2.0,
                z * z * x * n.z / 2.0,
            ]
        })
    });
    let (sum, error) = total(&parts);
    let (mass, centroid, inertia) = about_centroid(&sum, about);
    Solid { volume: mass, centroid, inertia, error: relative(error[0], mass) }
}

/// Whether the normals of a closed set of faces point into what they enclose, `true` using a surface's other side: the sign of
/// the integral that is its volume. `None` where that cannot be told from 0, as for a sheet folded onto itself.
pub fn points_inwards(faces: &[(Surface, bool)]) -> Option<bool> {
    /// A value is told from 0 where it is so many times its estimated error.
    const SURE: f64 = 10.0;
    let surfaces: Vec<Surface> = faces.iter().map(|(surface, _)| surface.clone()).collect();
    let about = center(&surfaces);
    // Bodies that are not thin are known from few places.
    [SIGN_ACCURACY, MEASURE_ACCURACY].into_iter().find_map(|accuracy| {
        let parts = par::map(surfaces.len(), |k| over(&surfaces[k], about, accuracy, &|jet, r| [r.dot(jet.du.cross(jet.dv))]));
        let (mut volume, mut error) = (0.0, 0.0);
        for ((_, other), (value, apart)) in faces.iter().zip(parts) {
            volume += if *other { -value[0] } else { value[0] };
            error += apart[0] + MEASURE_ACCURACY * value[0].abs();
        }
        (f64::abs(volume) > SURE * error).then_some(volume < 0.0)
    })
}

/// The smallest box along the axes that holds surfaces; infinite for an unbounded plane.
pub fn bounds(surfaces: &[Surface]) -> Box3 {
    par::map(surfaces.len(), |k| bbox(&surfaces[k])).into_iter().fold(Box3::EMPTY, Box3::union)
}

/// The same, and of the surfaces whose own box may be too large by more than a millionth of its diagonal the place in the list of the
/// one of which that is most, with by how much at most.
pub fn bounds_told(surfaces: &[Surface]) -> (Box3, Option<(usize, f64)>) {
    let all = par::map(surfaces.len(), |k| boxed(&surfaces[k]));
    let loose = all.iter().enumerate().filter_map(|(k, one)| one.loose().map(|by| (k, by)));
    let worst = loose.reduce(|worst, one| if one.1 > worst.1 { one } else { worst });
    (all.iter().fold(Box3::EMPTY, |around, one| around.union(one.bounds)), worst)
}

/// A point near the surfaces, so that moments do not cancel.
fn center(surfaces: &[Surface]) -> DVec3 {
    let bounds = surfaces.iter().filter(|s| s.domain() != Domain::Unbounded).fold(Box3::EMPTY, |all, s| all.union(s.hull()));
    if bounds.is_empty() { DVec3::ZERO } else { bounds.center() }
}

/// The integral of `f(jet, p − about)` over a surface, with its error estimate.
pub fn over<const N: usize>(surface: &Surface, about: DVec3, accuracy: f64, f: &impl Fn(&Jet2, DVec3) -> [f64; N]) -> ([f64; N], [f64; N]) {
    let at = |jet: &Jet2| f(jet, jet.p - about);
    // Of a face in a plane of the coordinates some terms are nothing but rounding: a share of what they would be if the normal and
    // the way there had all components alike counts as their size.
    let sized = |jet: &Jet2| -> [f64; N] {
        let (value, most) = (at(jet), at_all(jet, jet.p - about, f));
        std::array::from_fn(|i| value[i].abs() + LEAST_SIZE * most[i].abs())
    };
    let integrand = Integrand { value: &at, size: &sized };
    work::metered(|meter| match (surface.domain(), surface.kind()) {
        (Domain::Unbounded, _) => ([0.0; N], [0.0; N]),
        (_, SurfaceKind::Plane) => flat_integral(surface, accuracy, integrand),
        (_, SurfaceKind::Scatter) => triangles_integral(surface, &surface.triangles(), accuracy, &at),
        _ if surface.is_flat() => flat_integral(surface, accuracy, integrand),
        (Domain::Loop, _) => {
            let patchwise = if surface.is_scattered() { cut_triangles_integral(surface, accuracy, &at) } else { None };
            patchwise.unwrap_or_else(|| trimmed_integral(surface, accuracy, integrand, None, meter))
        }
        _ => integral(surface, WHOLE, accuracy, integrand, meter),
    })
}

/// The integral of `f(jet, p − about)` over what lies below a plane of a trimmed surface that is not flat, with its error estimate.
pub fn trimmed_below<const N: usize>(
    surface: &Surface,
    about: DVec3,
    below: Below,
    accuracy: f64,
    f: &impl Fn(&Jet2, DVec3) -> [f64; N],
) -> ([f64; N], [f64; N]) {
    let at = |jet: &Jet2| f(jet, jet.p - about);
    let size = |jet: &Jet2| f(jet, jet.p - about).map(f64::abs);
    work::metered(|meter| trimmed_integral(surface, accuracy, Integrand { value: &at, size: &size }, Some(below), meter))
}

/// What f gives where the normal and the arm are as long as they are, along one diagonal.
fn at_all<const N: usize>(jet: &Jet2, arm: DVec3, f: &impl Fn(&Jet2, DVec3) -> [f64; N]) -> [f64; N] {
    let diagonal = DVec3::ONE.normalize();
    let eu = DVec3::new(1.0, -1.0, 0.0).normalize();
    let root = jet.du.cross(jet.dv).length().sqrt();
    f(&Jet2 { du: eu * root, dv: diagonal.cross(eu) * root, ..*jet }, diagonal * arm.length())
}

fn total(parts: &[([f64; 10], [f64; 10])]) -> ([f64; 10], [f64; 10]) {
    let mut sums = ([0.0; 10], [0.0; 10]);
    for (value, error) in parts {
        for k in 0..10 {
            sums.0[k] += value[k];
            sums.1[k] += error[k];
        }
    }
    sums
}

fn relative(error: f64, value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { error / value.abs() }
}

/// Mass, centroid and inertia about it from the moments 1, x, y, z, xx, yy, zz, xy, yz, zx about a point.
fn about_centroid(m: &[f64; 10], about: DVec3) -> (f64, DVec3, DMat3) {
    let mass = m[0];
    if mass == 0.0 {
        return (0.0, about, DMat3::ZERO);
    }
    let c = DVec3::new(m[1], m[2], m[3]) / mass;
    // Second moments about the centroid [Steiner].
    let (xx, yy, zz) = (m[4] - mass * c.x * c.x, m[5] - mass * c.y * c.y, m[6] - mass * c.z * c.z);
    let (xy, yz, zx) = (m[7] - mass * c.x * c.y, m[8] - mass * c.y * c.z, m[9] - mass * c.z * c.x);
    let inertia = DMat3::from_cols(DVec3::new(yy + zz, -xy, -zx), DVec3::new(-xy, xx + zz, -yz), DVec3::new(-zx, -yz, xx + yy));
    (mass, about + c, inertia)
}
