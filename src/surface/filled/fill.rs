//! Holes of any number of sides, closed.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::FillFault;
use crate::surface::filled::beside::{FaceJet, NamedFace};
use crate::surface::filled::field::solved;
use crate::surface::filled::hole::sides;
use crate::surface::filled::net::{PatchNet, net};
use crate::surface::filled::patch::{Patch, patches};
use crate::surface::filled::ribbon::Ribbons;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Places of an inner curve that a surface passes.
const INNER_PLACES: usize = 16;
/// Angle between tangent planes that is as good as none, radians.
const TOLD_ANGLE: f64 = std::f64::consts::PI / 18_000.0;
/// Difference of curvatures that is as good as none.
const TOLD_BEND: f64 = 0.01;

/// What a hole is filled by.
#[derive(Clone, Debug)]
pub struct Filling {
    /// Faces that the surface continues.
    pub to: Vec<Surface>,
    /// 0: borders alone; 1: tangent planes of the faces; 2: their curvatures too.
    pub order: usize,
    /// Points that it passes.
    pub points: Vec<DVec3>,
    /// Curves that it passes.
    pub curves: Vec<Chain>,
}

/// A surface that closes the hole inside some borders, one patch at each corner round a centre, in the order of the walk that begins with
/// the first border; where corners are flat or turn back one at each side, and after those what is inside them. Warnings too (W681, W682).
///
/// Fails with E502 where the borders do not close, E680 for a face that lies along none of them, E683 where they cross as seen along the
/// direction in which the surface is a height over a plane.
pub fn fill(borders: &[Chain], filling: &Filling, origin: Origin, tolerance: &Tolerance) -> Result<(Vec<Surface>, Vec<Fault>)> {
    let sides = sides(borders, origin, tolerance)?;
    let faces = filling.to.iter().map(NamedFace::new).collect();
    let ribbons = Ribbons::new(sides, faces, filling.order, tolerance);
    if let Some(n) = ribbons.idle() {
        return Err(FillFault::NotBeside { fill: origin, face: filling.to[n].origin(), place: n }.into());
    }
    let Some(parts) = patches(&ribbons) else {
        let sides = ribbons.sides.len();
        return Err(FillFault::Folds { fill: origin, normal: ribbons.plane.normal, sides }.into());
    };
    let mut notes = corner_notes(&ribbons, origin);
    let on_curve = |c: &Chain| (0..=INNER_PLACES).map(|k| c.point(k as f64 / INNER_PLACES as f64)).collect::<Vec<_>>();
    let inner: Vec<DVec3> =
        filling.points.iter().copied().chain(filling.curves.iter().flat_map(on_curve)).map(|p| ribbons.plane.local(p)).collect();
    let field = solved(&ribbons, &parts, &inner);
    let one = |patch: &Patch| (*patch, net(&PatchNet { ribbons: &ribbons, field: &field, patch: *patch }, tolerance));
    let nets: Vec<(Patch, NurbsSurface)> = parts.iter().map(one).collect();
    let (angle, bend) = missed(&ribbons, &nets);
    if notes.is_empty() && (angle > TOLD_ANGLE || bend > TOLD_BEND) {
        notes.push(FillFault::Misses { fill: origin, angle, bend }.into());
    }
    Ok((nets.into_iter().map(|(_, net)| net.surface(SurfaceKind::Fill, origin, tolerance)).collect(), notes))
}

/// The largest angle between nets and the faces beside them, radians, and the largest difference of curvatures across borders, as a share.
fn missed(ribbons: &Ribbons, nets: &[(Patch, NurbsSurface)]) -> (f64, f64) {
    const PLACES: usize = 12;
    /// Curvature, over the size of the hole, below which differences count as of this one.
    const FLAT: f64 = 0.05;
    let (mut angle, mut bend) = (0.0_f64, 0.0_f64);
    for (patch, net) in nets {
        let edges = [patch.bottom.map(|part| (part, true)), patch.left.map(|part| (part, false))];
        for (part, along) in edges.into_iter().flatten() {
            for t in (0..PLACES).map(|k| (k as f64 + 0.5) / PLACES as f64) {
                let place = ribbons.place(part.side, part.fraction(t));
                let (Some(face), Some((first, _))) = (place.face, place.across) else { continue };
                let (u, v) = if along { (t, 0.0) } else { (0.0, t) };
                let Some(own) = FaceJet::new(&net.jet(u, v, (OneSided::After, OneSided::After)), &ribbons.plane) else { continue };
                let own = if own.normal.dot(face.normal) < 0.0 { own.turned() } else { own };
                angle = angle.max(math::angle_between(own.normal, face.normal));
                if ribbons.order > 1 {
                    let asked = face.bend(first);
                    bend = bend.max((own.bend(first) - asked).abs() / asked.abs().max(FLAT * first.length_squared()));
                }
            }
        }
    }
    (angle, bend)
}

/// W681 where what lies beside a hole cannot be continued at a corner.
fn corner_notes(ribbons: &Ribbons, origin: Origin) -> Vec<Fault> {
    let n = ribbons.sides.len();
    let mut notes = Vec::new();
    for k in 0..n {
        let (before, after) = (ribbons.place((k + n - 1) % n, 1.0), ribbons.place(k, 0.0));
        let faces = [before.face, after.face].map(|f| f.map(|f| f.normal));
        let between = match faces {
            [Some(a), Some(b)] => math::angle_between(a, b),
            _ => 0.0,
        };
        let off = |normal: DVec3, along: DVec3| (0.5 * std::f64::consts::PI - math::angle_between(normal, along)).abs();
        let each = faces.iter().flatten().flat_map(|n| [before.d1, after.d1].map(|d| off(*n, d)));
        let angle = each.fold(between, f64::max);
        if angle > TOLD_ANGLE {
            notes.push(FillFault::Corner { fill: origin, at: ribbons.plane.global(after.p), angle }.into());
        }
    }
    notes
}
