//! A convex cell from its corners and the nodes on its sides to triangles.

use glam::{DVec2, DVec3};

use crate::mesh::chart::outline::is_left;

/// Largest number of nodes round a cell whose triangulations are searched.
pub const MAX_NODES: usize = 12;
/// Ratio of errors that count as equal: then the larger least angle is better.
const EQUAL_ERROR_RATIO: f64 = 0.99;

/// The triangles of a cell, by the places of their corners in its polygon, and the worst error among them.
#[derive(Clone, Debug, PartialEq)]
pub struct Filling {
    /// Corners, counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
    /// The worst error over the limit.
    pub ratio: f64,
}

/// The quality of some triangles: their worst error over the limit, and the largest cosine of an angle.
#[derive(Clone, Copy, Debug)]
struct FillingQuality {
    ratio: f64,
    sharpest: f64,
}

impl FillingQuality {
    const BEST: Self = Self { ratio: 0.0, sharpest: -1.0 };

    fn and(self, other: Self) -> Self {
        Self { ratio: self.ratio.max(other.ratio), sharpest: self.sharpest.max(other.sharpest) }
    }

    fn beats(&self, other: &Self) -> bool {
        if self.ratio < EQUAL_ERROR_RATIO * other.ratio {
            return true;
        }
        other.ratio >= EQUAL_ERROR_RATIO * self.ratio && self.sharpest < other.sharpest
    }
}

/// The triangulation of a polygon, counter-clockwise, whose worst error `ratio` is least, and of those the one with the largest
/// least angle (by dynamic programming [Klincsek 1980]). Triangles with an error above `most` are left out.
///
/// `None` where there is none.
pub fn fill(at: &[DVec2], p: &[DVec3], most: f64, ratio: &dyn Fn([usize; 3]) -> f64) -> Option<Filling> {
    let n = at.len();
    if !(3..=MAX_NODES).contains(&n) {
        return None;
    }
    let mut best: Vec<Option<(FillingQuality, usize)>> = vec![None; n * n];
    for i in 0..n - 1 {
        best[i * n + i + 1] = Some((FillingQuality::BEST, i));
    }
    for reach in 2..n {
        for i in 0..n - reach {
            let k = i + reach;
            for j in i + 1..k {
                let (Some(a), Some(b)) = (best[i * n + j], best[j * n + k]) else { continue };
                if !is_left(at[i], at[j], at[k]) {
                    continue;
                }
                // The parts beside it alone exceed the best error.
                let least = a.0.ratio.max(b.0.ratio);
                if best[i * n + k].is_some_and(|(known, _)| known.ratio < EQUAL_ERROR_RATIO * least) {
                    continue;
                }
                let error = ratio([i, j, k]);
                if error > most {
                    continue;
                }
                let all = FillingQuality { ratio: error, sharpest: sharpest(p[i], p[j], p[k]) }.and(a.0).and(b.0);
                if best[i * n + k].is_none_or(|(known, _)| all.beats(&known)) {
                    best[i * n + k] = Some((all, j));
                }
            }
        }
    }
    let quality = best[n - 1]?.0;
    let mut triangles = Vec::with_capacity(n - 2);
    let mut open = vec![(0, n - 1)];
    while let Some((i, k)) = open.pop() {
        if k == i + 1 {
            continue;
        }
        let (_, j) = best[i * n + k]?;
        triangles.push([i, j, k]);
        open.extend([(i, j), (j, k)]);
    }
    Some(Filling { triangles, ratio: quality.ratio })
}

/// The largest cosine of an angle; 1 for what has no area.
fn sharpest(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let at = |o: DVec3, p: DVec3, q: DVec3| (p - o).normalize_or(DVec3::X).dot((q - o).normalize_or(DVec3::X));
    at(a, b, c).max(at(b, c, a)).max(at(c, a, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(at: &[(f64, f64)], ratio: impl Fn([usize; 3]) -> f64) -> Filling {
        let at: Vec<DVec2> = at.iter().map(|p| DVec2::from(*p)).collect();
        let p: Vec<DVec3> = at.iter().map(|p| p.extend(0.0)).collect();
        fill(&at, &p, f64::INFINITY, &ratio).unwrap()
    }

    #[test]
    fn the_diagonal_with_the_smaller_error_and_then_the_larger_angle() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        for worse in [[0, 1, 2], [0, 1, 3]] {
            let found = filled(&square, |t| if t == worse { 2.0 } else { 1.0 });
            assert!(found.ratio == 1.0 && !found.triangles.contains(&worse), "{found:?}");
        }
        let kite = [(0.0, 0.0), (4.0, -1.0), (8.0, 0.0), (4.0, 1.0)];
        assert!(filled(&kite, |_| 0.5).triangles.contains(&[0, 1, 3]));
    }

    #[test]
    fn a_node_on_a_side_is_one_triangle_more_and_none_is_flat() {
        let found = filled(&[(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], |_| 0.0);
        assert_eq!(found.triangles.len(), 3);
        assert!(!found.triangles.contains(&[0, 1, 2]));
        let line: Vec<DVec2> = (0..3).map(|k| DVec2::new(f64::from(k), 0.0)).collect();
        assert_eq!(fill(&line, &[DVec3::ZERO; 3], f64::INFINITY, &|_| 0.0), None);
    }
}
