//! A body that floats: its outside as faces or triangles, made ready once for any water plane.

use glam::DVec3;

use super::cut::CuttingPlane;
use super::face::{Face, Way};
use super::fault::FloatFault;
use super::flat::wet_of_flat;
use super::sides::Side;
use super::sums::{WHOLE, Wet, wet_densities, wet_of_whole};
use super::triangles::Triangles;
use super::water::Water;
use super::wet_cells::{Scale, WetRules, wet_of_cell};
use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::{EPSILON, FLOAT_ALONG, FLOAT_CLOSED, FLOAT_TRIMMED};
use crate::base::work;
use crate::model::measure::{self, Below};
use crate::surface::{Jet2, Surface};

/// An edge of one face alone, as points along it.
#[derive(Clone, Debug)]
pub struct FreeEdge {
    /// The surface.
    pub of: Origin,
    /// Points along it, model units.
    pub points: Vec<DVec3>,
}

/// A body made ready.
#[derive(Clone, Debug)]
pub struct Body {
    /// What made it.
    pub origin: Origin,
    /// Its faces.
    pub faces: Vec<Face>,
    /// Its triangles, where it is a mesh.
    pub triangles: Triangles,
    /// A box that holds it.
    pub bounds: Box3,
    /// Whether it stands for itself and its mirror image at y = 0.
    pub mirrored: bool,
    /// Edges of one face alone that do not lie in the plane of symmetry.
    pub free: Vec<FreeEdge>,
    /// Distance below which points are one, model units.
    pub tolerance: f64,
    about: DVec3,
    /// Area of the outside, of one side where it is mirrored.
    area: f64,
    /// Whether all normals point inwards.
    inwards: bool,
}

impl Body {
    /// A body of faces, `true` using the other side of a surface; one open on one side of y = 0 stands for both sides.
    pub fn of_faces(origin: Origin, surfaces: &[(Surface, bool)], free: Vec<FreeEdge>, tolerance: f64) -> Result<Self> {
        let bounds = surfaces.iter().fold(Box3::EMPTY, |all, (surface, _)| all.union(measure::bounds(std::slice::from_ref(surface))));
        let (about, reach) = (bounds.center(), 0.5 * bounds.diagonal());
        // A measure fails no model: what its cells take is bounded, and charged to nobody.
        let faces = work::uncharged(|| par::map(surfaces.len(), |k| Face::new(&surfaces[k].0, surfaces[k].1, about, reach)));
        Self { origin, faces, triangles: Triangles::default(), bounds, mirrored: false, free, tolerance, about, area: 0.0, inwards: false }
            .turned_outwards()
    }

    /// A body of triangles.
    pub fn of_triangles(origin: Origin, nodes: Vec<DVec3>, corners: Vec<[u32; 3]>, free: Vec<FreeEdge>, tolerance: f64) -> Result<Self> {
        let used = corners.iter().flatten().map(|k| nodes[*k as usize]);
        let bounds = Box3::of(used);
        let triangles = Triangles::new(nodes, corners, bounds.center());
        let about = bounds.center();
        Self { origin, faces: Vec::new(), triangles, bounds, mirrored: false, free, tolerance, about, area: 0.0, inwards: false }
            .turned_outwards()
    }

    fn turned_outwards(mut self) -> Result<Self> {
        let on_plane = |p: &DVec3| p.y.abs() <= self.tolerance;
        self.mirrored = Side::only(&self.bounds, self.tolerance).is_some() && self.free.iter().any(|edge| edge.points.iter().all(on_plane));
        if self.mirrored {
            self.free.retain(|edge| !edge.points.iter().all(|p| p.y.abs() <= self.tolerance));
        }
        self.area = self.faces.iter().flat_map(|face| &face.cells).map(|cell| cell.sums[0]).sum::<f64>() + self.triangles.whole()[0];
        let volume = self.signed_volume();
        let size = self.bounds.max - self.bounds.min;
        if volume.abs() <= EPSILON.sqrt() * size.x * size.y * size.z || !volume.is_finite() {
            return Err(FloatFault::NoInside { body: self.origin }.into());
        }
        self.inwards = volume < 0.0;
        Ok(self)
    }

    /// Largest distances from the origin of a water plane along its axes.
    pub fn scale(&self, water: &Water) -> Scale {
        let most = self.bounds.corners().into_iter().map(|p| water.local(p).abs()).fold(DVec3::ZERO, DVec3::max);
        Scale { area: self.area, reach: most.to_array() }
    }

    /// Whether all its normals point inwards.
    pub fn turned_inwards(&self) -> bool {
        self.inwards
    }

    /// Volume up to its highest point, cubic model units; of a mirrored body of both sides.
    pub fn whole_volume(&self) -> f64 {
        self.signed_volume().abs()
    }

    /// The same, negative where normals point inwards; of a body whose top is open that is the volume up to the plane of the top.
    fn signed_volume(&self) -> f64 {
        let top = Water::at(DVec3::new(self.about.x, 0.0, self.bounds.max.z), 0.0, 0.0);
        let of = |sums: &[f64; WHOLE]| wet_of_whole(sums, self.about, &top)[4];
        let faces: f64 = self.faces.iter().flat_map(|face| &face.cells).map(|cell| of(&cell.sums)).sum();
        let one_side = faces + of(&self.triangles.whole());
        if self.mirrored { 2.0 * one_side } else { one_side }
    }

    /// Heights up to this count as none.
    pub fn none(&self) -> f64 {
        EPSILON * self.bounds.diagonal()
    }

    /// The integrals below a water plane; fails with E656 where an edge of one face alone, or what else is open, lies below it.
    pub fn wet(&self, water: &Water) -> Result<Wet> {
        self.refuse_open(water)?;
        let wet = self.wet_anyhow(water);
        let apart = (wet.volume() - wet.volume_along()).abs();
        let length = 0.5 * (self.bounds.max - self.bounds.min).length();
        if apart > FLOAT_CLOSED * wet.wetted() * length || wet.flux_along().abs() > FLOAT_CLOSED * wet.wetted() {
            return Err(FloatFault::Open { body: self.origin, off: apart, volume: wet.volume() }.into());
        }
        Ok(wet)
    }

    /// The same, whether or not it is open there: a search looks at positions that are not the one found.
    pub fn wet_anyhow(&self, water: &Water) -> Wet {
        let sums = work::uncharged(|| self.sums(water));
        if self.inwards { sums.turned() } else { sums }
    }

    fn refuse_open(&self, water: &Water) -> Result<()> {
        let lowest = |edge: &FreeEdge| {
            let images = edge.points.iter().flat_map(|p| [*p, if self.mirrored { DVec3::new(p.x, -p.y, p.z) } else { *p }]);
            images.map(|p| (water.height(p), p)).min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let mut below: Vec<(Origin, DVec3, f64)> = Vec::new();
        for edge in &self.free {
            if let Some((height, at)) = lowest(edge).filter(|(height, _)| *height < -self.tolerance) {
                below.push((edge.of, at, -height));
            }
        }
        below.sort_by(|a, b| b.2.total_cmp(&a.2));
        let under = self.bounds.corners().into_iter().all(|p| water.height(p) < 0.0);
        if below.is_empty() { Ok(()) } else { Err(FloatFault::OpenBelow { body: self.origin, edges: below, under }.into()) }
    }

    /// Sums below a plane of the faces as they are turned, of both sides where it is mirrored.
    fn sums(&self, water: &Water) -> Wet {
        let own = self.own_sums(water);
        if !self.mirrored {
            return own;
        }
        if water.up.y == 0.0 {
            return own.with_mirror_image();
        }
        let mut both = own;
        let other = self.own_sums(&water.mirrored());
        both.add(&other.sums, &other.errors);
        both
    }

    fn own_sums(&self, water: &Water) -> Wet {
        let (scale, rules) = (self.scale(water), WetRules::new());
        let plane = self.plane(water.up, water.up.dot(water.origin));
        let mut wet = Wet::default();
        for face in &self.faces {
            self.add_face(face, water, plane, &scale, &rules, &mut wet);
        }
        self.triangles.add_wet(water, self.about, plane.none, &mut wet);
        wet
    }

    /// A plane to cut its faces by.
    pub fn plane(&self, normal: DVec3, distance: f64) -> CuttingPlane {
        CuttingPlane { normal, distance, none: self.none(), along: FLOAT_ALONG * self.bounds.diagonal() }
    }

    fn add_face(&self, face: &Face, water: &Water, plane: CuttingPlane, scale: &Scale, rules: &WetRules, to: &mut Wet) {
        for cell in &face.cells {
            let (low, high) = plane.heights(cell);
            if low >= -plane.none {
                continue;
            }
            if high <= plane.none {
                to.add(&wet_of_whole(&cell.sums, self.about, water), &scale.sizes(cell.error));
                continue;
            }
            let below = Below { normal: plane.normal, distance: plane.distance };
            match face.way {
                Way::Cells => wet_of_cell(face, cell.rect, water, plane, scale, rules, to),
                Way::Flat => wet_of_flat(face, water, below, scale, rules, to),
                Way::Rows => {
                    let density = |jet: &Jet2, arm: DVec3| wet_densities(water, self.about + arm, jet.du.cross(jet.dv) * face.sign);
                    let (sums, errors) = measure::trimmed_below(face.prepared.surface(), self.about, below, FLOAT_TRIMMED, &density);
                    to.add(&sums, &errors);
                }
            }
        }
    }
}
