//! Faces beside a hole: which one lies along a place of its border, and what it does there.

use glam::DVec3;

use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::network::Chain;
use crate::surface::closest::foot::foot;
use crate::surface::closest::nearest::Nearest;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::{Jet2, unit_normal};
use crate::surface::filled::plane::HolePlane;

/// Places of a piece of a border at which faces are sought.
const PROBES: usize = 7;

/// A face that the surface continues.
#[derive(Debug)]
pub struct NamedFace {
    /// As it is.
    own: Nearest,
    /// Without its borders.
    whole: Nearest,
}

impl NamedFace {
    pub fn new(surface: &Surface) -> Self {
        Self { own: Nearest::new(surface), whole: Nearest::new(&surface.untrimmed()) }
    }

    /// Whether a point lies on it.
    pub fn holds(&self, p: DVec3, tolerance: &Tolerance) -> bool {
        self.own.at(p).distance <= tolerance.point
    }

    /// How far it is from a point.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.own.at(p).distance
    }

    /// Point and derivatives at the foot of a point; none where it is far from it.
    fn jet(&self, p: DVec3, near: f64) -> Option<Jet2> {
        let surface = self.whole.surface();
        let found = self.whole.at(p);
        let (uv, _) = foot(surface.evaluator(), p, found.uv.into());
        let jet = surface.jet(uv.x, uv.y);
        (jet.p.distance(p) <= near).then_some(jet)
    }
}

/// What a face does at a place of the border, in the coordinates of the hole's plane.
#[derive(Clone, Copy, Debug)]
pub struct FaceJet {
    /// Its unit normal, either way.
    pub normal: DVec3,
    jet: Jet2,
}

impl FaceJet {
    /// Of a jet in space; none where it is singular.
    pub fn new(jet: &Jet2, plane: &HolePlane) -> Option<Self> {
        let turned = |v: DVec3| plane.turned(v) / plane.scale;
        let jet = Jet2 {
            p: plane.local(jet.p),
            du: turned(jet.du),
            dv: turned(jet.dv),
            duu: turned(jet.duu),
            duv: turned(jet.duv),
            dvv: turned(jet.dvv),
        };
        Some(Self { normal: unit_normal(&jet)?, jet })
    }

    /// The same with its normal the other way.
    pub fn turned(self) -> Self {
        Self { normal: -self.normal, ..self }
    }

    /// The part along the normal of the second derivative of every curve on the face with this tangent.
    pub fn bend(&self, along: DVec3) -> f64 {
        let j = &self.jet;
        let (e, f, g) = (j.du.length_squared(), j.du.dot(j.dv), j.dv.length_squared());
        let det = e * g - f * f;
        if det <= PARALLEL * PARALLEL * e * g {
            return 0.0;
        }
        let (a, b) = (along.dot(j.du), along.dot(j.dv));
        let (x, y) = ((g * a - f * b) / det, (e * b - f * a) / det);
        (j.duu * (x * x) + j.duv * (2.0 * x * y) + j.dvv * (y * y)).dot(self.normal)
    }
}

/// Which face lies along each piece of a side.
#[derive(Clone, Debug, Default)]
pub struct Along {
    /// Ends of the pieces, fractions of the side.
    joints: Vec<f64>,
    /// Per piece and probe.
    faces: Vec<Option<usize>>,
}

impl Along {
    /// The first of the faces on which each place lies.
    pub fn of(chain: &Chain, faces: &[NamedFace], tolerance: &Tolerance) -> Self {
        let joints = chain.joints().to_vec();
        let mut found = Vec::new();
        for ends in joints.windows(2) {
            let mut last = None;
            for k in 0..PROBES {
                let p = chain.point(ends[0] + (ends[1] - ends[0]) * (k as f64 + 0.5) / PROBES as f64);
                let on = |n: &usize| faces[*n].holds(p, tolerance);
                last = last.filter(on).or_else(|| (0..faces.len()).find(on));
                found.push(last);
            }
        }
        Self { joints, faces: found }
    }

    /// The face at a fraction.
    pub fn at(&self, f: f64) -> Option<usize> {
        let last = self.joints.len() - 2;
        let k = self.joints[1..=last].partition_point(|j| *j <= f);
        let share = (f - self.joints[k]) / (self.joints[k + 1] - self.joints[k]);
        let probe = ((share * PROBES as f64).max(0.0) as usize).min(PROBES - 1);
        self.faces[k * PROBES + probe]
    }

    /// Whether there is a face anywhere.
    pub fn any(&self) -> bool {
        self.faces.iter().any(Option::is_some)
    }

    /// Whether there is a face everywhere.
    pub fn all(&self) -> bool {
        self.faces.iter().all(Option::is_some)
    }

    /// Whether a face lies along some of it.
    pub fn has(&self, face: usize) -> bool {
        self.faces.contains(&Some(face))
    }
}

/// What a face does at the foot of a point.
pub fn face_jet(face: &NamedFace, p: DVec3, plane: &HolePlane, tolerance: &Tolerance) -> Option<FaceJet> {
    FaceJet::new(&face.jet(p, 2.0 * tolerance.point)?, plane)
}
