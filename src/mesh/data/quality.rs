//! Quality numbers of a mesh, by the definitions of the product's reference.

use glam::DVec3;

use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::base::{job, math, par};
use crate::mesh::data::mesh::{FaceRange, Mesh};

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

/// Quality of some elements as sums and extremes; joined in order, so that the bits do not depend on threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QualityTally {
    /// Number of elements.
    count: usize,
    /// Cosine of the smallest angle so far, and of the largest.
    cosines: (f64, f64),
    quality: (f64, f64),
    aspect: f64,
    area: f64,
}

impl QualityTally {
    const NONE: Self = Self { count: 0, cosines: (-1.0, 1.0), quality: (0.0, f64::INFINITY), aspect: 1.0, area: 0.0 };

    /// That of triangles and quads by their corners among `nodes`.
    pub fn of(triangles: &[[u32; 3]], quads: &[[u32; 4]], nodes: &[DVec3]) -> Self {
        let node = |n: u32| nodes[n as usize];
        let own = par::map(triangles.len().div_ceil(BATCH), |batch| {
            let mut tally = Self::NONE;
            triangles[batch * BATCH..].iter().take(BATCH).for_each(|t| tally.triangle(t.map(node)));
            tally
        });
        let others = par::map(quads.len().div_ceil(BATCH), |batch| {
            let mut tally = Self::NONE;
            quads[batch * BATCH..].iter().take(BATCH).for_each(|q| tally.quad(q.map(node)));
            tally
        });
        own.into_iter().chain(others).fold(Self::NONE, Self::with)
    }

    /// Cosine of the smallest corner angle; −1 without elements.
    pub fn largest_cosine(&self) -> f64 {
        self.cosines.0
    }

    fn with(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            cosines: (self.cosines.0.max(other.cosines.0), self.cosines.1.min(other.cosines.1)),
            quality: (self.quality.0 + other.quality.0, self.quality.1.min(other.quality.1)),
            aspect: self.aspect.max(other.aspect),
            area: self.area + other.area,
        }
    }

    /// Counts the cosines of the corners of an element, one after each side, by the lengths of its sides over one.
    fn corners<const N: usize>(&mut self, sides: &[DVec3; N], inverse: &[f64; N]) {
        for k in 0..N {
            let before = (k + N - 1) % N;
            let cosine = (-sides[before].dot(sides[k]) * (inverse[before] * inverse[k])).clamp(-1.0, 1.0);
            self.cosines = (self.cosines.0.max(cosine), self.cosines.1.min(cosine));
        }
    }

    fn aspect<const N: usize>(&mut self, lengths: &[f64; N], inverse: &[f64; N]) {
        let longest = lengths.iter().fold(0.0_f64, |m, l| m.max(*l));
        let least = inverse.iter().fold(f64::INFINITY, |m, i| m.min(*i));
        // A side without length has no inverse.
        self.aspect = self.aspect.max(if least > 0.0 { longest * inverse.iter().fold(0.0_f64, |m, i| m.max(*i)) } else { f64::MAX });
    }

    fn element(&mut self, quality: f64) {
        self.count += 1;
        self.quality = (self.quality.0 + quality, self.quality.1.min(quality));
    }

    fn triangle(&mut self, [a, b, c]: [DVec3; 3]) {
        let sides = [b - a, c - b, a - c];
        let lengths = sides.map(DVec3::length);
        let inverse = lengths.map(over_one);
        self.corners(&sides, &inverse);
        self.aspect(&lengths, &inverse);
        let double = sides[0].cross(sides[1]).length();
        self.area += 0.5 * double;
        // 2 r / R with r = 2 A / perimeter and R = product of sides / 4 A.
        let (sum, product) = (lengths.iter().sum::<f64>(), lengths.iter().product::<f64>());
        self.element(if product > 0.0 { 4.0 * double * double / (sum * product) } else { 0.0 });
    }

    fn quad(&mut self, p: [DVec3; 4]) {
        let sides = [p[1] - p[0], p[2] - p[1], p[3] - p[2], p[0] - p[3]];
        let lengths = sides.map(DVec3::length);
        let inverse = lengths.map(over_one);
        self.corners(&sides, &inverse);
        self.aspect(&lengths, &inverse);
        let normal = (p[2] - p[0]).cross(p[3] - p[1]);
        // Squares of the sines, with the sign of the corner: their order is that of the sines.
        let crosses = [sides[3].cross(sides[0]), sides[0].cross(sides[1]), sides[1].cross(sides[2]), sides[2].cross(sides[3])];
        let mut least = f64::INFINITY;
        for (k, cross) in crosses.iter().enumerate() {
            let share = inverse[(k + 3) % 4] * inverse[k];
            let square = cross.length_squared() * (share * share);
            least = least.min(if cross.dot(normal) < 0.0 { -square } else { square });
        }
        self.element(least.abs().sqrt().copysign(least));
        self.area += 0.5 * (crosses[1].length() + crosses[3].length());
    }
}

/// One over a length; nothing of no length.
fn over_one(length: f64) -> f64 {
    if length > 0.0 { 1.0 / length } else { 0.0 }
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
    /// Shape of the elements, by corner nodes; `None` for a mesh without triangles and quads. What is known of faces is not measured again.
    pub fn quality(&self) -> Option<Quality> {
        let count = self.triangles.len() + self.quads.len();
        if count == 0 {
            return None;
        }
        let known = self.geometries.0.iter().try_fold(QualityTally::NONE, |sum, face| Some(sum.with(face.quality?)));
        let all = known.filter(|known| known.count == count).unwrap_or_else(|| self.quality_by_face(count));
        Some(Quality {
            min_angle: math::acos(all.cosines.0),
            max_angle: math::acos(all.cosines.1),
            mean_quality: all.quality.0 / count as f64,
            min_quality: all.quality.1,
            max_aspect: all.aspect,
            area: all.area,
        })
    }

    /// Quality of all elements, `count` of them, added up as if that of each face were known.
    fn quality_by_face(&self, count: usize) -> QualityTally {
        let range = |range: &std::ops::Range<u32>| range.start as usize..range.end as usize;
        let of_face = |face: &FaceRange| {
            let (triangles, quads) = (self.triangles.get(range(&face.triangles)), self.quads.get(range(&face.quads)));
            QualityTally::of(triangles.unwrap_or_default(), quads.unwrap_or_default(), &self.nodes)
        };
        let faces = self.faces.iter().map(of_face).fold(QualityTally::NONE, QualityTally::with);
        if faces.count == count { faces } else { QualityTally::of(&self.triangles, &self.quads, &self.nodes) }
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

/// Sine of a corner of a half turn but for rounding, and the area of a quad without one over the product of its diagonals.
const STRAIGHT: f64 = PARALLEL;

/// Whether a quad has a corner of a half turn or more, or no area, but for rounding.
pub fn is_concave(p: [DVec3; 4]) -> bool {
    let normal = (p[2] - p[0]).cross(p[3] - p[1]);
    let is_straight = |k: usize| {
        let (ahead, back) = (p[(k + 1) % 4] - p[k], p[(k + 3) % 4] - p[k]);
        ahead.cross(back).dot(normal) <= STRAIGHT * ahead.length() * back.length() * normal.length()
    };
    has_no_area(p) || (0..4).any(is_straight)
}

/// Whether a quad has no area, but for rounding.
pub fn has_no_area(p: [DVec3; 4]) -> bool {
    let (a, b) = (p[2] - p[0], p[3] - p[1]);
    a.cross(b).length() <= STRAIGHT * a.length_squared().max(b.length_squared())
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
