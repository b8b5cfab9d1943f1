//! Closed skins point out of the material: outwards, and a skin inside another one, round a cavity, into the cavity.

use glam::DVec3;

use super::measure;
use super::shells::ShellRequest;
use super::sides::Component;
use super::topology::{Model, SurfaceId};
use crate::base::bbox::Box3;
use crate::base::fault::{CutFault, Fault, SurfaceFault, Touching};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::build::line;
use crate::network::Chain;
use crate::surface::Surface;
use crate::surface::meet::{with_curve, with_surfaces};

/// Points of a skin that are tried before it counts as not inside another one: those on that one do not tell.
const POINTS: usize = 16;
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
    pub(super) fn turn_outwards(&self, components: &mut [Component], tolerance: &Tolerance) {
        let mut skins: Vec<Skin> = components.iter().map(|c| self.skin(c)).collect();
        for skin in &mut skins {
            if measure::points_inwards(&skin.faces) == Some(true) {
                skin.turn();
            }
        }
        let depths: Vec<usize> =
            (0..skins.len()).map(|k| (0..skins.len()).filter(|j| *j != k && skins[*j].holds(&skins[k], tolerance)).count()).collect();
        for ((skin, component), depth) in skins.iter().zip(components).zip(depths) {
            let inwards = depth % 2 == 1;
            component.faces.iter_mut().zip(&skin.faces).for_each(|(face, (_, other))| face.1 = *other != inwards);
        }
    }

    /// W667 for each two skins of a shell that touch, cross or lie on each other.
    pub(super) fn tell_touching(&self, request: &ShellRequest, skins: &[Component], tolerance: &Tolerance, sink: &mut Vec<Fault>) {
        let surface = |id: SurfaceId| &self.surfaces[id.index()].surface;
        for (k, skin) in skins.iter().enumerate() {
            for other in &skins[k + 1..] {
                let pairs = skin.faces.iter().flat_map(|(a, _)| other.faces.iter().map(move |(b, _)| (*a, *b)));
                let near = |(a, b): &(SurfaceId, SurfaceId)| surface(*a).hull().touches(&surface(*b).hull(), tolerance.point);
                let found = pairs.filter(near).filter_map(|(a, b)| Some((a, b, touching(surface(a), surface(b), tolerance)?)));
                let found: Vec<_> = found.collect();
                // That they cover each other says more than that they cross.
                let covers = found.iter().position(|(_, _, (how, _))| *how == Touching::Overlap);
                if let Some(&(a, b, (how, at))) = found.get(covers.unwrap_or(0)) {
                    let names = (self.surfaces[a.index()].name.clone(), self.surfaces[b.index()].name.clone());
                    let (a, b) = (surface(a).origin(), surface(b).origin());
                    sink.push(SurfaceFault::FacesTouch { within: request.origin, a, b, names, how, at, imprint: request.branches }.into());
                }
            }
        }
    }

    fn skin(&self, component: &Component) -> Skin {
        let surface = |id: SurfaceId| self.surfaces[id.index()].surface.clone();
        let faces: Vec<(Surface, bool)> = component.faces.iter().map(|(id, other)| (surface(*id), *other)).collect();
        let hull = faces.iter().fold(Box3::EMPTY, |all, (s, _)| all.union(s.hull()));
        let patches: Vec<_> = component.faces.iter().flat_map(|(id, _)| self.patches_of(*id)).collect();
        let points = patches.iter().map(|p| self.loop_of(*p).at(0.37).1).take(POINTS).collect();
        Skin { faces, hull, points }
    }
}

/// How two faces touch that share no edge, and where.
fn touching(a: &Surface, b: &Surface, tolerance: &Tolerance) -> Option<(Touching, DVec3)> {
    match with_surfaces(std::slice::from_ref(a), std::slice::from_ref(b), Origin::NONE, tolerance) {
        Ok(common) => common.curves.first().map(|c| (Touching::Meeting, c.point(0.5))),
        Err(Fault::Cut(fault)) => match *fault {
            CutFault::RunAlong { at, .. } => Some((Touching::Overlap, at)),
            _ => None,
        },
        Err(_) => None,
    }
}

/// Faces that close.
struct Skin {
    faces: Vec<(Surface, bool)>,
    hull: Box3,
    /// Some points on its faces.
    points: Vec<DVec3>,
}

impl Skin {
    fn turn(&mut self) {
        self.faces.iter_mut().for_each(|(_, other)| *other = !*other);
    }

    /// Whether another skin, which does not cross this one, lies inside this one, which points outwards.
    fn holds(&self, other: &Self, tolerance: &Tolerance) -> bool {
        // A skin inside this one has no point outside its box.
        if !other.points.iter().all(|p| self.hull.distance_squared(*p) == 0.0) {
            return false;
        }
        other.points.iter().find_map(|p| self.has_inside(*p, tolerance)).unwrap_or(false)
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
                job::look();
                let normal = surface.normal(hit.uv.0, hit.uv.1);
                let sine = way.dot(normal) * if *other { -1.0 } else { 1.0 };
                if hit.shared_to.is_some() || sine.abs() < CROSSES {
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
