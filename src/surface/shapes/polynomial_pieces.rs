//! Polynomials Σ sᵏ cₖ(y) with vectors for coefficients: through Chebyshev points, evaluated, and bounded over boxes by their own
//! coefficients about the middle.

use std::sync::OnceLock;

use glam::DVec3;

use crate::base::math;

/// Coefficients of a piece in y.
pub(super) const N: usize = 10;
/// Most powers of s.
pub(super) const MOST_POWERS: usize = 8;

/// A polynomial in y, from −1 to 1.
pub(super) type Piece = [DVec3; N];

/// Second derivatives along a vector over a box: those in the middle and how far they may be from there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxBends {
    pub mid: [f64; 3],
    pub slack: [f64; 3],
}

impl BoxBends {
    /// What holds both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        let range = |k: usize| {
            let low = (self.mid[k] - self.slack[k]).min(other.mid[k] - other.slack[k]);
            let high = (self.mid[k] + self.slack[k]).max(other.mid[k] + other.slack[k]);
            (0.5 * (low + high), 0.5 * (high - low))
        };
        let ranges = [0, 1, 2].map(range);
        Self { mid: ranges.map(|r| r.0), slack: ranges.map(|r| r.1) }
    }
}

/// The Chebyshev points of a piece, ascending.
pub(super) fn chebyshev() -> &'static [f64; N] {
    static POINTS: OnceLock<[f64; N]> = OnceLock::new();
    POINTS.get_or_init(|| std::array::from_fn(|k| -math::cos(std::f64::consts::PI * (k as f64 + 0.5) / N as f64)))
}

/// For each power what the polynomial through values at some places has of each value.
pub(super) fn powers_of(places: &[f64]) -> Vec<Vec<f64>> {
    let n = places.len();
    let mut rows = vec![vec![0.0; n]; n];
    for (i, own) in places.iter().enumerate() {
        let mut product = vec![1.0];
        for (_, other) in places.iter().enumerate().filter(|(k, _)| *k != i) {
            let over = 1.0 / (own - other);
            let mut next = vec![0.0; product.len() + 1];
            for (k, c) in product.iter().enumerate() {
                next[k + 1] += c * over;
                next[k] -= c * over * other;
            }
            product = next;
        }
        rows.iter_mut().zip(product).for_each(|(row, c)| row[i] = c);
    }
    rows
}

/// The polynomial through points at the Chebyshev points of a piece.
pub(super) fn through(points: &[DVec3]) -> Piece {
    static ROWS: OnceLock<Vec<Vec<f64>>> = OnceLock::new();
    let rows = ROWS.get_or_init(|| powers_of(chebyshev()));
    // Rounding is that of the piece, not that of its distance from the origin.
    let base = points[N / 2];
    let mut piece: Piece = std::array::from_fn(|k| rows[k].iter().zip(points).map(|(by, p)| (*p - base) * *by).sum());
    piece[0] += base;
    piece
}

/// Σ sᵏ piece_k(y).
pub(super) fn value(pieces: &[Piece], s: f64, y: f64) -> DVec3 {
    pieces.iter().rev().fold(DVec3::ZERO, |sum, piece| sum * s + piece.iter().rev().fold(DVec3::ZERO, |p, c| p * y + *c))
}

/// Value, ∂s, ∂y, ∂ss, ∂sy, ∂yy of Σ sᵏ piece_k(y).
pub(super) fn summed(pieces: &[Piece], s: f64, y: f64) -> [DVec3; 6] {
    let mut sums = [DVec3::ZERO; 6];
    for piece in pieces.iter().rev() {
        let (mut value, mut slope, mut bend) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for c in piece.iter().rev() {
            bend = bend * y + slope;
            slope = slope * y + value;
            value = value * y + *c;
        }
        sums[3] = sums[3] * s + sums[1];
        sums[1] = sums[1] * s + sums[0];
        sums[0] = sums[0] * s + value;
        sums[4] = sums[4] * s + sums[2];
        sums[2] = sums[2] * s + slope;
        sums[5] = sums[5] * s + bend;
    }
    sums[3] *= 2.0;
    sums[5] *= 2.0;
    sums
}

/// Σ sᵏ yʲ c_kj along a vector, about a place.
pub(super) struct Shifted {
    rows: [[f64; N]; MOST_POWERS],
    count: usize,
}

impl Shifted {
    pub fn new(pieces: &[Piece], (s, y): (f64, f64), along: DVec3) -> Self {
        let mut rows = [[0.0; N]; MOST_POWERS];
        let count = pieces.len();
        for (row, piece) in rows.iter_mut().zip(pieces) {
            row.iter_mut().zip(piece).for_each(|(x, c)| *x = c.dot(along));
            for first in 0..N - 1 {
                for k in (first..N - 1).rev() {
                    row[k] += y * row[k + 1];
                }
            }
        }
        for first in 0..count.saturating_sub(1) {
            for k in (first..count - 1).rev() {
                let next = rows[k + 1];
                rows[k].iter_mut().zip(next).for_each(|(x, c)| *x += s * c);
            }
        }
        Self { rows, count }
    }

    /// ∂ss, ∂sy, ∂yy over ± half widths of s and y; derivatives are by `scale`.
    pub fn bends(&self, (hs, hy): (f64, f64), scale: (f64, f64)) -> BoxBends {
        let mut slack = [0.0; 3];
        let mut mid = [0.0; 3];
        let mut of_s = [1.0; MOST_POWERS];
        let mut of_y = [1.0; N];
        (1..MOST_POWERS).for_each(|k| of_s[k] = of_s[k - 1] * hs);
        (1..N).for_each(|k| of_y[k] = of_y[k - 1] * hy);
        for (k, row) in self.rows[..self.count].iter().enumerate() {
            for (j, c) in row.iter().enumerate() {
                let (kf, jf) = (k as f64, j as f64);
                if k >= 2 {
                    slack[0] += (kf * (kf - 1.0) * c).abs() * of_s[k - 2] * of_y[j];
                }
                if k >= 1 && j >= 1 {
                    slack[1] += (kf * jf * c).abs() * of_s[k - 1] * of_y[j - 1];
                }
                if j >= 2 {
                    slack[2] += (jf * (jf - 1.0) * c).abs() * of_s[k] * of_y[j - 2];
                }
            }
        }
        if self.count > 2 {
            mid[0] = 2.0 * self.rows[2][0];
        }
        if self.count > 1 {
            mid[1] = self.rows[1][1];
        }
        mid[2] = 2.0 * self.rows[0][2];
        let by = [scale.0 * scale.0, scale.0 * scale.1, scale.1 * scale.1];
        for k in 0..3 {
            slack[k] = (slack[k] - mid[k].abs()).max(0.0) * by[k];
            mid[k] *= by[k];
        }
        BoxBends { mid, slack }
    }
}
