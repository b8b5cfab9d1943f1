//! The loops of a face of a file, known before its surface is made.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::math;
use crate::io::cad::border::{Border, reach};
use crate::surface::swept::revolve::Axis;

/// Places along each curve of a loop.
const SAMPLES: usize = 32;

/// The loops of a face and the box around them.
#[derive(Clone, Copy, Debug)]
pub struct FaceLoops<'l> {
    /// The box around the loops, model units.
    pub reach: Box3,
    loops: &'l [Vec<Border>],
    /// Vertices that bound it by themselves.
    pub vertices: &'l [DVec3],
}

impl<'l> FaceLoops<'l> {
    /// No loops.
    pub const NONE: FaceLoops<'static> = FaceLoops { reach: Box3::EMPTY, loops: &[], vertices: &[] };

    /// The loops of a face, and the vertices that bound it by themselves.
    pub fn of(loops: &'l [Vec<Border>], vertices: &'l [DVec3]) -> Self {
        Self { reach: reach(loops), loops, vertices }
    }

    /// The same for a surface at a distance from the one on which the loops lie.
    pub fn beside(self, distance: f64) -> Self {
        let by = DVec3::splat(distance.abs());
        let reach = if self.reach.is_empty() { self.reach } else { Box3 { min: self.reach.min - by, max: self.reach.max + by } };
        Self { reach, ..self }
    }

    /// Points of one loop in their order, model units.
    fn points_of(border: &[Border]) -> impl Iterator<Item = DVec3> {
        border.iter().flat_map(|b| {
            let (t0, t1) = b.space.domain();
            (0..SAMPLES).map(move |k| b.space.point(t0 + (t1 - t0) * k as f64 / SAMPLES as f64))
        })
    }

    /// Points of all loops.
    pub fn points(&self) -> impl Iterator<Item = DVec3> {
        self.loops.iter().flat_map(|border| Self::points_of(border))
    }

    /// Whether the loops together wind about an axis: of a cone the apex then lies inside them.
    pub fn wind_about(&self, axis: &Axis) -> bool {
        let first = math::any_normal(axis.direction);
        let second = axis.direction.cross(first);
        let turn = |border: &Vec<Border>| {
            let flat: Vec<(f64, f64)> =
                Self::points_of(border).map(|p| ((p - axis.about).dot(first), (p - axis.about).dot(second))).collect();
            let step = |k: usize| {
                let ((a, b), (c, d)) = (flat[k], flat[(k + 1) % flat.len()]);
                math::atan2(a * d - b * c, a * c + b * d)
            };
            (0..flat.len()).map(step).sum::<f64>()
        };
        self.loops.iter().map(turn).sum::<f64>().abs() > std::f64::consts::PI
    }
}
