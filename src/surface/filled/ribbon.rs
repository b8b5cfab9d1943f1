//! What the surface does along the borders of a hole: positions, and beside faces the derivatives across.

use glam::{DVec2, DVec3};

use crate::base::tolerance::Tolerance;
use crate::surface::filled::beside::{Along, FaceJet, NamedFace, face_jet};
use crate::surface::filled::hole::HoleSide;
use crate::surface::filled::plane::{HolePlane, area_vector};

/// Places along a side at which its shape is looked at.
const PLACES: usize = 32;
/// Least cosine between a normal and the direction along which heights over the plane are measured.
const STEEP: f64 = 0.25;
/// How far beside a border a face is looked for, as a share of the size of the hole.
const ASIDE: f64 = 1.0 / 1024.0;

/// A place of the border in the coordinates of the plane.
#[derive(Clone, Copy, Debug)]
pub struct BorderPlace {
    /// The point.
    pub p: DVec3,
    /// Its derivative along the side.
    pub d1: DVec3,
    /// The direction in the plane across the border into the hole.
    pub inward: DVec2,
    /// The face there.
    pub face: Option<FaceJet>,
    /// The first and second derivative of the surface by the distance inward.
    pub across: Option<(DVec3, DVec3)>,
}

/// The borders of a hole with what lies beside them.
#[derive(Debug)]
pub struct Ribbons<'a> {
    pub plane: HolePlane,
    pub sides: Vec<HoleSide>,
    pub along: Vec<Along>,
    faces: Vec<NamedFace>,
    /// 0: positions alone, 1: tangent planes, 2: curvatures too.
    pub order: usize,
    /// The surface is a height over the plane; else it leaves each border at a right angle to it.
    lifted: bool,
    tolerance: &'a Tolerance,
}

impl<'a> Ribbons<'a> {
    pub fn new(sides: Vec<HoleSide>, faces: Vec<NamedFace>, order: usize, tolerance: &'a Tolerance) -> Self {
        let points: Vec<DVec3> =
            sides.iter().flat_map(|s| (0..PLACES).map(|k| s.point(k as f64 / PLACES as f64)).collect::<Vec<_>>()).collect();
        let flat = area_vector(&points).normalize_or(DVec3::Z);
        let plane = HolePlane::new(&points, flat);
        let along: Vec<Along> = sides.iter().map(|s| Along::of(&s.chain, &faces, tolerance)).collect();
        let mut made = Self { plane, sides, along, faces, order, lifted: true, tolerance };
        if order > 0 && made.along.iter().any(Along::any) {
            made.tilt(&points);
        }
        made
    }

    /// Turns the plane across the mean of the faces' normals, where all of them are on one side of it.
    fn tilt(&mut self, points: &[DVec3]) {
        let flat = self.plane;
        let normals = |made: &Self| -> Vec<DVec3> {
            let each = (0..made.sides.len()).flat_map(|k| (0..=PLACES).map(move |n| (k, n as f64 / PLACES as f64)));
            each.filter_map(|(k, f)| made.place(k, f).face.map(|face| face.normal)).collect()
        };
        let least = |all: &[DVec3]| all.iter().map(|n| n.z).fold(f64::INFINITY, f64::min);
        let first = normals(self);
        let sum: DVec3 = first.iter().sum();
        let whole = self.along.iter().all(Along::all);
        let mean = sum.normalize_or(DVec3::Z);
        // Heights are measured along the mean of normals and the area vector; of steep faces along the area vector.
        let axis = if whole { mean } else { (mean + DVec3::Z).normalize_or(DVec3::Z) };
        let turned = flat.global(axis) - flat.global(DVec3::ZERO);
        self.plane = HolePlane::new(points, turned.normalize_or(flat.normal));
        if least(&normals(self)) < STEEP {
            self.plane = flat;
            self.lifted = least(&first) >= STEEP;
        }
    }

    /// Whether the surface is a height over the plane.
    pub fn is_lifted(&self) -> bool {
        self.lifted
    }

    /// Whether every side has faces.
    pub fn is_held(&self) -> bool {
        self.order > 0 && self.along.iter().all(Along::all)
    }

    /// Place and derivative along a side, in the plane.
    pub fn flat(&self, k: usize, f: f64) -> (DVec2, DVec2) {
        let jet = self.sides[k].jet(f);
        (self.plane.foot(jet.p), (self.plane.turned(jet.d1) / self.plane.scale).truncate())
    }

    /// All that is known at a fraction of a side.
    pub fn place(&self, k: usize, f: f64) -> BorderPlace {
        let jet = self.sides[k].jet(f);
        let (p, d1) = (self.plane.local(jet.p), self.plane.turned(jet.d1) / self.plane.scale);
        let inward = DVec2::new(-d1.y, d1.x).normalize_or_zero();
        let named = (self.order > 0).then(|| self.along[k].at(f)).flatten();
        let face = named.and_then(|n| face_jet(&self.faces[n], jet.p, &self.plane, self.tolerance));
        let bare = BorderPlace { p, d1, inward, face: None, across: None };
        let (Some(face), Some(n)) = (face, named) else { return bare };
        if self.lifted {
            let face = if face.normal.z < 0.0 { face.turned() } else { face };
            let slope = -face.normal.truncate().dot(inward) / face.normal.z.max(STEEP);
            let first = inward.extend(slope);
            let second = DVec3::Z * (face.bend(first) / face.normal.z.max(STEEP));
            return BorderPlace { face: Some(face), across: Some((first, second)), ..bare };
        }
        let tangent = d1.normalize_or_zero();
        let into = face.normal.cross(tangent);
        let face = if self.is_into(n, jet.p, into, inward) { face } else { face.turned() };
        let first = face.normal.cross(tangent).normalize_or_zero() * (d1.length() / d1.truncate().length().max(f64::MIN_POSITIVE));
        BorderPlace { across: Some((first, face.normal * face.bend(first))), face: Some(face), ..bare }
    }

    /// Whether a direction at a place of the border leaves the face there.
    fn is_into(&self, face: usize, p: DVec3, into: DVec3, inward: DVec2) -> bool {
        let aside = (self.plane.global(into) - self.plane.global(DVec3::ZERO)) * ASIDE;
        let (ahead, back) = (self.faces[face].distance(p + aside), self.faces[face].distance(p - aside));
        let (far, near) = (ahead.max(back), ahead.min(back));
        if far > 0.1 * aside.length() && near < 0.1 * far { ahead > back } else { into.truncate().dot(inward) >= 0.0 }
    }

    /// Faces that lie along no border.
    pub fn idle(&self) -> Option<usize> {
        (0..self.faces.len()).find(|n| !self.along.iter().any(|along| along.has(*n)))
    }
}
