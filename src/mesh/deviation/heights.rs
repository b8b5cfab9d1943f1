//! Heights of a surface over a plane at a grid of places of a triangle, and the parts of the triangle between them.

use glam::{DVec2, DVec3};

use crate::surface::Evaluator;

/// A plane through a point with a unit normal.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    /// The point.
    pub on: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
}

/// Heights by steps from the first corner towards the second and the third.
pub(super) struct Heights([[f64; Heights::PARTS + 1]; Heights::PARTS + 1]);

impl Heights {
    /// Parts along each side.
    pub const PARTS: usize = 4;

    /// Places other than the corners, those where heights are mostly large first: the middles of the sides.
    const PLACES: [(usize, usize); 12] = [(2, 0), (0, 2), (2, 2), (1, 1), (2, 1), (1, 2), (1, 0), (3, 0), (0, 1), (0, 3), (3, 1), (1, 3)];

    /// Those of a surface over a triangle of (u, v), of which the corners are known; or, where one is more than `wanted`, one as large.
    pub fn of(evaluator: Evaluator, uv: [DVec2; 3], corners: [f64; 3], plane: Plane, wanted: f64) -> Result<Self, f64> {
        let mut heights = [[0.0; Self::PARTS + 1]; Self::PARTS + 1];
        (heights[0][0], heights[Self::PARTS][0], heights[0][Self::PARTS]) = (corners[0], corners[1], corners[2]);
        let mut seen = 0.0_f64;
        for (k, (i, j)) in Self::PLACES.into_iter().enumerate() {
            let at = Self::place(uv, (i, j));
            heights[i][j] = (evaluator.point(at.x, at.y) - plane.on).dot(plane.normal);
            seen = seen.max(heights[i][j].abs());
            // The larger one of the middles says how much smaller a triangle has to be.
            if seen > wanted && k >= 2 {
                return Err(seen);
            }
        }
        Ok(Self(heights))
    }

    fn place(uv: [DVec2; 3], (i, j): (usize, usize)) -> DVec2 {
        let share = |k: usize| k as f64 / Self::PARTS as f64;
        uv[0] + (uv[1] - uv[0]) * share(i) + (uv[2] - uv[0]) * share(j)
    }

    /// The parts between the places, each with the heights of its corners.
    pub fn parts(&self, uv: [DVec2; 3]) -> impl Iterator<Item = ([DVec2; 3], [f64; 3])> + '_ {
        let all = (0..Self::PARTS).flat_map(|i| (0..Self::PARTS - i).map(move |j| (i, j)));
        let both = all.flat_map(|(i, j)| {
            let upright = Some([(i, j), (i + 1, j), (i, j + 1)]);
            let inverted = (i + j + 1 < Self::PARTS).then_some([(i + 1, j + 1), (i, j + 1), (i + 1, j)]);
            upright.into_iter().chain(inverted)
        });
        both.map(move |places| (places.map(|place| Self::place(uv, place)), places.map(|(i, j)| self.0[i][j])))
    }
}
