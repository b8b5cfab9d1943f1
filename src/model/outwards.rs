//! Closed skins point out of the material: outwards, and a skin inside another one, round a cavity, into the cavity.

use crate::model::fault::ContactFault;
use glam::DVec3;

use super::measure;
use super::shells::ShellRequest;
use super::sides::Component;
use super::topology::{Model, SurfaceId};
use crate::base::bbox::Box3;
use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build::line;
use crate::geometry::data::fault::CurveFault;
use crate::model::fault::Touching;
use crate::network::Chain;
use crate::surface::Surface;
use crate::surface::faults::CrossingFault;
use crate::surface::intersect::with_curve::with_curve;
use crate::surface::intersect::with_surfaces::with_surfaces;

/// Points of a skin that are tried before it counts as not inside another one: those on that one do not tell.
const POINTS: usize = 16;
/// Where on the border of a face they are, as shares of its length.
const PLACES: [f64; 4] = [0.37, 0.71, 0.13, 0.89];
/// Directions, along no axis or diagonal, in which a point is looked from until two of them agree.
const WAYS: [DVec3; 6] = [
    DVec3::new(0.531, 0.617, 0.581),
    DVec3::new(-0.713, 0.337, 0.614),
    DVec3::new(0.412, -0.803, 0.431),
    DVec3::new(0.237, 0.471, -0.849),
    DVec3::new(-0.641, -0.529, -0.556),
    DVec3::new(0.877, -0.211, -0.431),
];
/// Sine of the angle between a line and a face from which on they cross and do not graze.
const CROSSES: f64 = 0.02;
/// Crossings nearer to each other than this many tolerances may be one that two faces share.
const APART: f64 = 16.0;

impl Model {
    /// Turns closed components so that they point out of the material. One that encloses nothing keeps its sides.
    ///
    /// Fails with E413 where it cannot be told whether one skin lies inside another one.
    pub(super) fn turn_outwards(&self, components: &mut [Component], tolerance: &Tolerance) -> Result<()> {
        let mut skins: Vec<ClosedSkin> = components.iter().map(|c| self.skin(c)).collect();
        for skin in &mut skins {
            if measure::points_inwards(&skin.faces) == Some(true) {
                skin.turn();
            }
        }
        for (k, (skin, component)) in skins.iter().zip(components).enumerate() {
            let mut inwards = false;
            for (_, other) in skins.iter().enumerate().filter(|(j, _)| *j != k) {
                inwards ^= other.holds(skin, tolerance)?;
            }
            component.faces.iter_mut().zip(&skin.faces).for_each(|(face, (_, other))| face.1 = *other != inwards);
        }
        Ok(())
    }

    /// W667 for each two skins of a shell that touch, cross or lie on each other.
    ///
    /// Fails with E413 where that cannot be told of any two of their faces.
    pub(super) fn report_touching(
        &self,
        request: &ShellRequest,
        skins: &[Component],
        tolerance: &Tolerance,
        sink: &mut Vec<Fault>,
    ) -> Result<()> {
        let surface = |id: SurfaceId| &self.surfaces[id.index()].surface;
        for (k, skin) in skins.iter().enumerate() {
            for other in &skins[k + 1..] {
                let pairs = skin.faces.iter().flat_map(|(a, _)| other.faces.iter().map(move |(b, _)| (*a, *b)));
                let near = |(a, b): &(SurfaceId, SurfaceId)| surface(*a).hull().touches(&surface(*b).hull(), tolerance.point);
                let (mut found, mut lost) = (Vec::new(), None);
                for (a, b) in pairs.filter(near) {
                    match touching(surface(a), surface(b), tolerance) {
                        Ok(how) => found.extend(how.map(|how| (a, b, how))),
                        Err(fault) => lost = lost.or(Some(fault)),
                    }
                }
                // That they touch is known where any two of their faces tell it.
                if let (true, Some(fault)) = (found.is_empty(), lost) {
                    return Err(fault);
                }
                // That they cover each other says more than that they cross.
                let covers = found.iter().position(|(_, _, (how, _))| *how == Touching::Overlap);
                if let Some(&(a, b, (how, at))) = found.get(covers.unwrap_or(0)) {
                    let names = (self.surfaces[a.index()].name.clone(), self.surfaces[b.index()].name.clone());
                    let (a, b) = (surface(a).origin(), surface(b).origin());
                    sink.push(ContactFault::FacesTouch { within: request.origin, a, b, names, how, at, imprint: request.branches }.into());
                }
            }
        }
        Ok(())
    }

    /// Whether one closed component, which points outwards, has another one inside it; E413 where that cannot be told.
    pub(super) fn holds(&self, outer: &Component, inner: &Component, tolerance: &Tolerance) -> Result<bool> {
        self.skin(outer).holds(&self.skin(inner), tolerance)
    }

    fn skin(&self, component: &Component) -> ClosedSkin {
        let surface = |id: SurfaceId| self.surfaces[id.index()].surface.clone();
        let faces: Vec<(Surface, bool)> = component.faces.iter().map(|(id, other)| (surface(*id), *other)).collect();
        let hull = faces.iter().fold(Box3::EMPTY, |all, (s, _)| all.union(s.hull()));
        let patches: Vec<_> = component.faces.iter().flat_map(|(id, _)| self.patches_of(*id)).collect();
        let loops: Vec<_> = patches.iter().take(POINTS).map(|p| self.loop_of(*p)).collect();
        // A few faces are looked at in several places each.
        let points = PLACES.iter().flat_map(|f| loops.iter().map(|around| around.at(*f).1)).take(POINTS).collect();
        ClosedSkin { faces, hull, points }
    }
}

/// How two faces touch that share no edge, and where.
///
/// Fails with E413 when what they have in common was not found.
fn touching(a: &Surface, b: &Surface, tolerance: &Tolerance) -> Result<Option<(Touching, DVec3)>> {
    match with_surfaces(std::slice::from_ref(a), std::slice::from_ref(b), a.origin(), tolerance) {
        Ok(common) => {
            let at = common.curves.first().map(|c| c.point(0.5)).or(common.touches.first().copied());
            Ok(at.map(|at| (Touching::Meeting, at)))
        }
        Err(fault) => match fault.of() {
            Some(CrossingFault::RunAlong { at, .. }) => Ok(Some((Touching::Overlap, *at))),
            _ => Err(fault),
        },
    }
}

/// Faces that close.
struct ClosedSkin {
    faces: Vec<(Surface, bool)>,
    hull: Box3,
    /// Some points on its faces.
    points: Vec<DVec3>,
}

impl ClosedSkin {
    fn turn(&mut self) {
        self.faces.iter_mut().for_each(|(_, other)| *other = !*other);
    }

    /// Whether another skin, which does not cross this one, lies inside this one, which points outwards; E413 where no point of
    /// it tells.
    fn holds(&self, other: &Self, tolerance: &Tolerance) -> Result<bool> {
        // A skin inside this one has no point outside its box.
        if !other.points.iter().all(|p| self.hull.distance_squared(*p) == 0.0) {
            return Ok(false);
        }
        let inside = other.points.iter().find_map(|p| self.has_inside(*p, tolerance));
        inside.ok_or_else(|| {
            let of = other.faces.first().map_or(Origin::NONE, |(face, _)| face.origin());
            let at = other.points.first().copied().unwrap_or_default();
            CurveFault::NotConverged { of, what: "on which side of another closed skin this one lies".to_owned(), at }.into()
        })
    }

    /// Whether a point lies inside: two lines from it agree. `None` where it lies on the skin or too few lines cross it cleanly.
    fn has_inside(&self, p: DVec3, tolerance: &Tolerance) -> Option<bool> {
        let mut first = None;
        for way in WAYS {
            let Some(inside) = self.crossings(p, way, tolerance) else { continue };
            if first == Some(inside) {
                return Some(inside);
            }
            first = Some(inside);
        }
        None
    }

    /// Whether a ray from a point leaves once more than it enters; `None` where it grazes a face or passes near an edge.
    fn crossings(&self, p: DVec3, way: DVec3, tolerance: &Tolerance) -> Option<bool> {
        let long = 2.0 * self.hull.with(p).diagonal();
        let ray = Chain::of_curve(&line(p, p + way * long, Origin::NONE).ok()?);
        let mut places: Vec<f64> = Vec::new();
        let mut out = 0_i32;
        for (surface, other) in &self.faces {
            for hit in with_curve(&ray, std::slice::from_ref(surface), tolerance).ok()? {
                job::poll();
                let normal = surface.normal(hit.uv.0, hit.uv.1);
                let sine = way.dot(normal) * if *other { -1.0 } else { 1.0 };
                if hit.overlap_end.is_some() || sine.abs() < CROSSES {
                    return None;
                }
                places.push(hit.f * ray.length());
                out += if sine > 0.0 { 1 } else { -1 };
            }
        }
        places.push(0.0);
        places.sort_by(f64::total_cmp);
        let clean = places.windows(2).all(|w| w[1] - w[0] > APART * tolerance.point);
        match out {
            0 | 1 if clean => Some(out == 1),
            _ => None,
        }
    }
}
