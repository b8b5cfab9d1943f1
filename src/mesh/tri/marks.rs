//! The marks 0, 1 and 2 at the corners of a cell that a loop crosses [Jeong & Park 2000, §3.1.2].
//!
//! Travelling along a loop with what is kept on the right, at each crossing of a side the corner at its right end is 2, and
//! the one at the right end of the opposite side one more unless it is 2. Corners with 2 are kept. The marks see nothing of a
//! loop inside one cell, and lose kept corners where a loop leaves by the side it came in by: what is kept is decided by the
//! winding, and the summary of the mesh has the number of corners at which the marks agree.

use glam::DVec2;

use crate::base::predicates::orient;

/// Corners of a box: lower left, lower right, upper right, upper left.
pub fn corners((low, high): (DVec2, DVec2)) -> [DVec2; 4] {
    [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
}

/// The marks of a box in the order of [`corners`], by the segments of loops with what is kept on their right.
pub fn marks(cell: (DVec2, DVec2), segments: impl Iterator<Item = [DVec2; 2]>) -> [u8; 4] {
    let at = corners(cell);
    let mut marks = [0_u8; 4];
    for [a, b] in segments {
        for side in 0..4 {
            let (c, d) = (side, (side + 1) % 4);
            // A point on the line counts to the left of it, so that no crossing counts twice.
            let left = |o: DVec2, to: DVec2, p: DVec2| orient(o, to, p) >= 0.0;
            if left(at[c], at[d], a) == left(at[c], at[d], b) || left(a, b, at[c]) == left(a, b, at[d]) {
                continue;
            }
            let right = if left(a, b, at[c]) { d } else { c };
            // The ends of the opposite side that face these.
            let beyond = if right == c { (side + 3) % 4 } else { (side + 2) % 4 };
            marks[right] = 2;
            marks[beyond] = (marks[beyond] + 1).min(2);
        }
    }
    marks
}
