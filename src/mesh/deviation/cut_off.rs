//! Places of a surface that are far from all elements: the tips of folds that elements cut off.
//!
//! The distance from places of elements to the surface (`measure.rs`) does not see them: the elements beside a tip are near the surface on
//! both sides of it. Only elements that meet others at sharp angles are looked at.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::math::{self, angle_between};
use crate::mesh::deviation::point_triangle;
use crate::mesh::deviation::samples::beside_pole;
use crate::surface::{Evaluator, Surface};

/// What steers the search.
struct CutOffSettings {
    /// Boxes along u and v whose normals are bounded to tell that nothing is folded.
    boxes: usize,
    /// Largest angle of the normals of a surface without folds from their mean, radians: 60°.
    max_lean: f64,
    /// Cosine of the angle between elements at a node from which on they may cut off a fold: 60°.
    min_cosine: f32,
    /// Divisions of a side between places that are looked at.
    divisions: usize,
    /// Places that are compared with all elements, the farthest from their own first.
    max_places: usize,
}

const SETTINGS: CutOffSettings = CutOffSettings { boxes: 8, max_lean: 1.047, min_cosine: 0.5, divisions: 4, max_places: 64 };

/// Triangles (of quads their halves) of a face.
#[derive(Clone, Copy)]
pub struct FaceTriangles<'a> {
    /// (u, v) and numbers in the mesh of the nodes of the list.
    pub uv: &'a [(f64, f64)],
    pub ids: &'a [u32],
    /// Corners by their places in the list.
    pub halves: &'a [[usize; 3]],
    /// Nodes of the mesh.
    pub nodes: &'a [DVec3],
}

impl FaceTriangles<'_> {
    fn points(&self, half: [usize; 3]) -> [DVec3; 3] {
        half.map(|n| self.nodes[self.ids[n] as usize])
    }

    /// Largest distance of a place of the surface from all triangles, model units, where one is more than `least`.
    pub fn largest_cut_off(&self, evaluator: Evaluator, least: f64) -> Option<f64> {
        let mut far: Vec<(f64, DVec3)> = Vec::new();
        for half in self.sharp() {
            job::poll();
            let uv = beside_pole(evaluator, half.map(|n| self.uv[n])).map(DVec2::from);
            far.push(farthest_place(evaluator, uv, self.points(half)));
        }
        far.retain(|place| place.0 > least);
        far.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut most = least;
        for (own, place) in far.into_iter().take(SETTINGS.max_places) {
            if own > most {
                most = most.max(self.distance(place, most));
            }
        }
        (most > least).then_some(most)
    }

    /// Triangles that meet others at a sharp angle in a node.
    fn sharp(&self) -> Vec<[usize; 3]> {
        let up = |half: [usize; 3]| {
            let [a, b, c] = self.points(half);
            (b - a).cross(c - a).normalize_or_zero().as_vec3()
        };
        let mut first = vec![glam::Vec3::ZERO; self.ids.len()];
        let mut is_sharp = vec![false; self.ids.len()];
        for half in self.halves {
            job::poll();
            let own = up(*half);
            for n in half {
                if first[*n] == glam::Vec3::ZERO {
                    first[*n] = own;
                } else if own != glam::Vec3::ZERO {
                    is_sharp[*n] |= first[*n].dot(own) < SETTINGS.min_cosine;
                }
            }
        }
        self.halves.iter().filter(|half| half.iter().any(|n| is_sharp[*n])).copied().collect()
    }

    /// Distance of a place from the triangles, or something less than `enough`.
    fn distance(&self, place: DVec3, enough: f64) -> f64 {
        let mut nearest = f64::INFINITY;
        for half in self.halves {
            job::poll();
            let [a, b, c] = self.points(*half);
            let reach = a.distance_squared(b).max(a.distance_squared(c)).sqrt();
            if a.distance(place) - reach < nearest {
                nearest = nearest.min(point_triangle::distance([a, b, c], place));
                if nearest <= enough {
                    return nearest;
                }
            }
        }
        nearest
    }
}

/// How far the place of the surface over a triangle is from it that is farthest, by samples, model units, and where it is.
pub fn farthest_place(evaluator: Evaluator, uv: [DVec2; 3], p: [DVec3; 3]) -> (f64, DVec3) {
    let share = |k: usize| k as f64 / SETTINGS.divisions as f64;
    let places = (0..=SETTINGS.divisions).flat_map(|i| (0..=SETTINGS.divisions - i).map(move |j| (i, j)));
    let off = |(i, j): (usize, usize)| {
        let at = uv[0] + (uv[1] - uv[0]) * share(i) + (uv[2] - uv[0]) * share(j);
        let there = evaluator.point(at.x, at.y);
        (point_triangle::distance(p, there), there)
    };
    places.map(off).fold((0.0, p[0]), |most, off| if off.0 > most.0 { off } else { most })
}

/// Whether a surface may turn back on itself between two places of (u, v).
pub fn may_fold(surface: &Surface, (low, high): (DVec2, DVec2)) -> bool {
    if surface.is_flat() {
        return false;
    }
    let n = SETTINGS.boxes;
    let at = |k: usize, axis: usize| low[axis] + (high[axis] - low[axis]) * k as f64 / n as f64;
    let mut cones: Vec<(DVec3, f64)> = Vec::with_capacity(n * n);
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let around = surface.enclosure((at(i, 0), at(i + 1, 0)), (at(j, 1), at(j + 1, 1)));
        let normals = around.du.cross(&around.dv);
        let (center, radius) = (0.5 * (normals.low + normals.high), 0.5 * (normals.high - normals.low).length());
        let share = radius / center.length();
        if share.is_nan() || share >= 1.0 {
            return true;
        }
        cones.push((center.normalize_or_zero(), math::atan2(share, (1.0 - share * share).sqrt())));
    }
    let mean = cones.iter().map(|cone| cone.0).sum::<DVec3>();
    cones.iter().any(|(normal, half_angle)| angle_between(*normal, mean) + half_angle > SETTINGS.max_lean)
}
