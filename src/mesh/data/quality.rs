//! Quality numbers of a mesh, by the definitions of the product's reference.

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::base::{job, math, par};
use crate::mesh::data::mesh::Mesh;

/// Elements that one thread measures at a time.
const BATCH: usize = 8192;

/// Shape of the elements of a mesh. Angles are corner angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Smallest corner angle.
    pub min_angle: f64,
    /// Largest corner angle.
    pub max_angle: f64,
    /// Mean of the elements' quality: of a triangle twice the ratio of inscribed to circumscribed radius, of a quad the
    /// least sine of its corners (negative when concave).
    pub mean_quality: f64,
    /// The least quality.
    pub min_quality: f64,
    /// Longest over shortest side of an element, the largest of all.
    pub max_aspect: f64,
    /// Sum of the elements' areas, model units squared; a quad as its two triangles.
    pub area: f64,
}

/// Sums over some elements; joined in order, so that the bits do not depend on threads.
#[derive(Clone, Copy)]
struct QualityTally {
    /// Cosine of the smallest angle so far, and of the largest.
    cosines: (f64, f64),
    quality: (f64, f64),
    aspect: f64,
    area: f64,
}

impl QualityTally {
    const NONE: Self = Self { cosines: (-1.0, 1.0), quality: (0.0, f64::INFINITY), aspect: 1.0, area: 0.0 };

    fn with(self, other: Self) -> Self {
        Self {
            cosines: (self.cosines.0.max(other.cosines.0), self.cosines.1.min(other.cosines.1)),
            quality: (self.quality.0 + other.quality.0, self.quality.1.min(other.quality.1)),
            aspect: self.aspect.max(other.aspect),
            area: self.area + other.area,
        }
    }

    fn corner(&mut self, before: DVec3, after: DVec3) {
        let cosine = (-before.dot(after)).clamp(-1.0, 1.0);
        self.cosines = (self.cosines.0.max(cosine), self.cosines.1.min(cosine));
    }

    fn sides(&mut self, lengths: &[f64]) {
        let longest = lengths.iter().fold(0.0_f64, |m, l| m.max(*l));
        let shortest = lengths.iter().fold(f64::INFINITY, |m, l| m.min(*l));
        self.aspect = self.aspect.max(if shortest > 0.0 { longest / shortest } else { f64::MAX });
    }

    fn element(&mut self, quality: f64) {
        self.quality = (self.quality.0 + quality, self.quality.1.min(quality));
    }

    fn triangle(&mut self, [a, b, c]: [DVec3; 3]) {
        let sides = [b - a, c - b, a - c];
        let lengths = sides.map(DVec3::length);
        let units = sides.map(DVec3::normalize_or_zero);
        (0..3).for_each(|k| self.corner(units[(k + 2) % 3], units[k]));
        self.sides(&lengths);
        let double = (b - a).cross(c - a).length();
        self.area += 0.5 * double;
        // 2 r / R with r = 2 A / perimeter and R = product of sides / 4 A.
        let (sum, product) = (lengths.iter().sum::<f64>(), lengths.iter().product::<f64>());
        self.element(if product > 0.0 { 4.0 * double * double / (sum * product) } else { 0.0 });
    }

    fn quad(&mut self, p: [DVec3; 4]) {
        let sides = [0, 1, 2, 3].map(|k| p[(k + 1) % 4] - p[k]);
        let units = sides.map(DVec3::normalize_or_zero);
        (0..4).for_each(|k| self.corner(units[(k + 3) % 4], units[k]));
        self.sides(&sides.map(DVec3::length));
        let normal = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
        let sine = |k: usize| {
            let cross = units[(k + 3) % 4].cross(units[k]);
            if cross.dot(normal) < 0.0 { -cross.length() } else { cross.length() }
        };
        self.element((0..4).map(sine).fold(f64::INFINITY, f64::min));
        self.area += 0.5 * ((p[1] - p[0]).cross(p[2] - p[0]).length() + (p[2] - p[0]).cross(p[3] - p[0]).length());
    }
}

/// The least corner angle of a triangle or quad, radians; a quad that is to be split, by the better of its diagonals.
pub fn least_angle(corners: &[DVec3], split: bool) -> f64 {
    let of = |part: &[DVec3]| {
        let n = part.len();
        let side = |k: usize| (part[(k + 1) % n] - part[k % n]).normalize_or_zero();
        math::acos((0..n).map(|k| -side(k).dot(side(k + n - 1))).fold(-1.0, f64::max).min(1.0))
    };
    match *corners {
        [a, b, c, d] if split => of(&[a, b, c]).min(of(&[a, c, d])).max(of(&[a, b, d]).min(of(&[b, c, d]))),
        [] | [_] | [_, _] => 0.0,
        ref all => of(all),
    }
}

/// Quality of one triangle or quad by its corners, as [`Quality::mean_quality`] counts it; 0 for anything else.
pub fn of_element(corners: &[DVec3]) -> f64 {
    let mut tally = QualityTally::NONE;
    match *corners {
        [a, b, c] => tally.triangle([a, b, c]),
        [a, b, c, d] => tally.quad([a, b, c, d]),
        _ => return 0.0,
    }
    tally.quality.1
}

impl Mesh {
    /// Shape of the elements, by corner nodes; `None` for a mesh without triangles and quads.
    pub fn quality(&self) -> Option<Quality> {
        let count = self.triangles.len() + self.quads.len();
        if count == 0 {
            return None;
        }
        let node = |n: u32| self.nodes[n as usize];
        let triangles = par::map(self.triangles.len().div_ceil(BATCH), |batch| {
            let mut tally = QualityTally::NONE;
            self.triangles[batch * BATCH..].iter().take(BATCH).for_each(|t| tally.triangle(t.map(node)));
            tally
        });
        let quads = par::map(self.quads.len().div_ceil(BATCH), |batch| {
            let mut tally = QualityTally::NONE;
            self.quads[batch * BATCH..].iter().take(BATCH).for_each(|q| tally.quad(q.map(node)));
            tally
        });
        let all = triangles.into_iter().chain(quads).fold(QualityTally::NONE, QualityTally::with);
        Some(Quality {
            min_angle: math::acos(all.cosines.0),
            max_angle: math::acos(all.cosines.1),
            mean_quality: all.quality.0 / count as f64,
            min_quality: all.quality.1,
            max_aspect: all.aspect,
            area: all.area,
        })
    }

    /// Centre of the area of the elements, a quad as its two triangles; of a mesh of lines of their length, of loose nodes
    /// their mean. By corner nodes; `None` without nodes.
    pub fn centroid(&self) -> Option<DVec3> {
        let node = |n: u32| self.nodes[n as usize];
        let about = *self.nodes.first()?;
        let heavy = |[a, b, c]: [DVec3; 3]| (0.5 * (b - a).cross(c - a).length(), (a + b + c) / 3.0);
        let halves = |q: &[u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]].map(|t| heavy(t.map(node)));
        let faces = self.triangles.iter().map(|t| heavy(t.map(node))).chain(self.quads.iter().flat_map(halves));
        let lines = self.lines.iter().map(|l| (node(l[0]).distance(node(l[1])), 0.5 * (node(l[0]) + node(l[1]))));
        let center = |parts: &mut dyn Iterator<Item = (f64, DVec3)>| {
            let (mass, moment) =
                job::looking(parts).fold((0.0, DVec3::ZERO), |(mass, moment), (m, p)| (mass + m, moment + (p - about) * m));
            (mass > 0.0).then(|| about + moment / mass)
        };
        let nodes = self.nodes.iter().map(|p| (1.0, *p));
        center(&mut { faces }).or_else(|| center(&mut { lines })).or_else(|| center(&mut { nodes }))
    }

    /// Largest distance mesh–surface at 25 points a triangle (a quad as its two triangles), and of free borders from their curves at
    /// seven places a step, model units; `None` where the surfaces are not known (a mesh that was read) or there is no face.
    pub fn chord_error(&self, tolerance: &Tolerance) -> Option<f64> {
        self.chord_error_again(tolerance, None)
    }
}

/// Whether a quad has a corner of a half turn or more, or no area.
pub fn is_concave(p: [DVec3; 4]) -> bool {
    let normal = (p[2] - p[0]).cross(p[3] - p[1]);
    (0..4).any(|k| (p[(k + 1) % 4] - p[k]).cross(p[(k + 3) % 4] - p[k]).dot(normal) <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(nodes: &[[f64; 3]], triangles: &[[u32; 3]], quads: &[[u32; 4]]) -> Mesh {
        let nodes = nodes.iter().map(|n| DVec3::from_array(*n)).collect();
        Mesh { nodes, triangles: triangles.to_vec(), quads: quads.to_vec(), order: 1, ..Mesh::default() }
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-12, "{a} is not {b}");
    }

    #[test]
    fn equilateral_and_square_are_perfect() {
        let h = 3.0_f64.sqrt() / 2.0;
        let q = mesh(&[[0.; 3], [1., 0., 0.], [0.5, h, 0.]], &[[0, 1, 2]], &[]).quality().unwrap();
        close(q.min_quality, 1.0);
        close(q.min_angle, std::f64::consts::FRAC_PI_3);
        close(q.area, h / 2.0);
        let q = mesh(&[[0.; 3], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]], &[], &[[0, 1, 2, 3]]).quality().unwrap();
        close(q.min_quality, 1.0);
        close(q.max_angle, std::f64::consts::FRAC_PI_2);
        close(q.max_aspect, 1.0);
    }

    #[test]
    fn right_triangle_and_concave_quad() {
        let q = mesh(&[[0.; 3], [3., 0., 0.], [0., 4., 0.]], &[[0, 1, 2]], &[]).quality().unwrap();
        close(q.min_quality, 2.0 * 1.0 / 2.5);
        close(q.max_aspect, 5.0 / 3.0);
        let q = mesh(&[[0.; 3], [1., 0., 0.], [0.2, 0.2, 0.], [0., 1., 0.]], &[], &[[0, 1, 2, 3]]).quality().unwrap();
        assert!(q.min_quality < 0.0, "{}", q.min_quality);
    }
}
