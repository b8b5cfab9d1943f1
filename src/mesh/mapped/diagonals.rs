//! The better diagonal of each cell of a grid.

use glam::DVec3;

use crate::base::par;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::mapped::grid::{Grid, GridIds};
use crate::surface::Surface;

/// By what diagonals are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiagonalRule {
    /// Distance from the surface below which both diagonals of a cell are as near, model units.
    pub even: f64,
    /// Bends have a limit.
    pub limited: bool,
}

/// For each cell whether the diagonal from (i + 1, j) to (i, j + 1) is the better one.
///
/// The better diagonal has its middle nearer to the surface; where both are as near, or that one has an angle below 30° and bends have no
/// limit, the one with the larger least angle; else the one from (i, j). Where a border turns back along itself diagonals end at the turn: from the
/// node before it, which is the one after it, they would be one edge twice.
pub fn diagonals(grid: &Grid, frame: &GridIds, surface: &Surface, nodes: &(dyn Fn(u32) -> DVec3 + Sync), rule: DiagonalRule) -> Vec<bool> {
    let (nu, nv) = grid.size();
    let mut other = vec![false; nu * nv];
    par::chunks_mut(&mut other, nu, |j, row| {
        let centers = grid.centers(surface, j);
        let line = |j: usize| (0..=nu).map(|i| nodes(frame.node(i, j))).collect::<Vec<DVec3>>();
        let (below, above) = (line(j), line(j + 1));
        for (i, slot) in row.iter_mut().enumerate() {
            let corners = [below[i], below[i + 1], above[i + 1], above[i]];
            *slot = prefers_other(&corners, centers[i], rule);
        }
    });
    debug_assert_eq!(other.len(), nu * nv);
    for (side, row) in frame.sides.iter().enumerate() {
        for before in (2..row.len()).map(|k| k - 2).filter(|k| row[*k] == row[k + 2] && row[*k] != row[k + 1]) {
            // Cells before and after the turn, and whether that is an end of their other diagonal.
            let (cells, others) = match side {
                0 => ([before, before + 1], [true, false]),
                1 => ([before, before + 1].map(|j| j * nu + nu - 1), [false, true]),
                2 => ([before, before + 1].map(|i| (nv - 1) * nu + i), [false, true]),
                _ => ([before, before + 1].map(|j| j * nu), [true, false]),
            };
            cells.into_iter().zip(others).for_each(|(cell, through)| other[cell] = through);
        }
    }
    other
}

fn prefers_other(&[a, b, c, d]: &[DVec3; 4], center: DVec3, DiagonalRule { even, limited }: DiagonalRule) -> bool {
    let normal = (c - a).cross(d - b).normalize_or_zero();
    let off = |p: DVec3, q: DVec3| ((p + q) * 0.5 - center).dot(normal).abs();
    let (first, second) = (off(a, c), off(b, d));
    let nearer = ((first - second).abs() > even).then_some(second < first);
    if let Some(other) = nearer.filter(|_| limited) {
        return other;
    }
    let sharpest = |other: bool| {
        let [s, t] = if other { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
        least_cosine(s[0], s[1], s[2]).max(least_cosine(t[0], t[1], t[2]))
    };
    match nearer {
        Some(other) if sharpest(other) <= SHARP_COSINE => other,
        _ => sharpest(true) < sharpest(false) - WHOLE_NUMBER,
    }
}

/// Cosine of 30°: an angle below that is not taken for a diagonal that is nearer to the surface.
const SHARP_COSINE: f64 = 0.866_025_403_784_438_6;

/// Cosine of the smallest angle of a triangle: the largest of the three.
fn least_cosine(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (ab, bc, ca) = ((b - a).normalize_or_zero(), (c - b).normalize_or_zero(), (a - c).normalize_or_zero());
    (-ca.dot(ab)).max(-ab.dot(bc)).max(-bc.dot(ca))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: DiagonalRule = DiagonalRule { even: 1e-12, limited: true };

    #[test]
    fn the_better_diagonal_is_nearer_to_the_surface() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 1.0), DVec3::Y];
        assert!(prefers_other(&corners, DVec3::new(0.5, 0.5, 0.0), RULE), "a ridge between b and d lies low");
        assert!(!prefers_other(&corners, DVec3::new(0.5, 0.5, 0.5), RULE));
        let flat = [DVec3::ZERO, DVec3::X, DVec3::new(3.0, 1.0, 0.0), DVec3::Y];
        assert!(prefers_other(&flat, DVec3::new(1.0, 0.5, 0.0), RULE), "the shorter diagonal has the larger least angle");
        // The long diagonal is nearer to the surface, with angles of 18°.
        let bent = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.1)];
        let center = DVec3::new(1.0, 0.5, 0.0);
        assert!(!prefers_other(&bent, center, RULE) && prefers_other(&bent, center, DiagonalRule { limited: false, ..RULE }));
    }
}
