//! Linear least squares by orthogonal transformations [Golub & Van Loan 2013, section 5.2].

use glam::DVec3;

use crate::base::tolerance::FILL_PIVOT;

/// Rows of a least squares problem whose right sides are vectors.
#[derive(Clone, Debug)]
pub struct Rows {
    width: usize,
    left: Vec<f64>,
    right: Vec<DVec3>,
}

impl Rows {
    /// Of a number of unknowns.
    pub fn new(width: usize) -> Self {
        Self { width, left: Vec::new(), right: Vec::new() }
    }

    /// One more row times a weight.
    pub fn push(&mut self, row: &[f64], right: DVec3, weight: f64) {
        self.left.extend(row.iter().map(|x| x * weight));
        self.right.push(right * weight);
    }

    /// The unknowns of least squares; those that no row decides are 0. Rows of large weight come first.
    pub fn solved(mut self) -> Vec<DVec3> {
        let n = self.width;
        while self.right.len() < n {
            self.push(&vec![0.0; n], DVec3::ZERO, 1.0);
        }
        for k in 0..n {
            self.reflect(k);
        }
        let mut out = vec![DVec3::ZERO; n];
        let largest = (0..n).map(|k| self.left[k * n + k].abs()).fold(0.0, f64::max);
        for k in (0..n).rev() {
            let row = &self.left[k * n..(k + 1) * n];
            let rest: DVec3 = (k + 1..n).map(|j| out[j] * row[j]).sum();
            if row[k].abs() > f64::EPSILON * largest {
                out[k] = (self.right[k] - rest) / row[k];
            }
        }
        out
    }

    /// Makes the entries of column `k` below the diagonal zero.
    fn reflect(&mut self, k: usize) {
        let (n, m) = (self.width, self.right.len());
        let norm = (k..m).map(|i| self.left[i * n + k] * self.left[i * n + k]).sum::<f64>().sqrt();
        if norm == 0.0 {
            return;
        }
        let first = self.left[k * n + k];
        let alpha = if first > 0.0 { -norm } else { norm };
        let mut mirror: Vec<f64> = (k..m).map(|i| self.left[i * n + k]).collect();
        mirror[0] -= alpha;
        let square: f64 = mirror.iter().map(|x| x * x).sum();
        if square == 0.0 {
            return;
        }
        let mut sums = vec![0.0; n - k];
        let mut right = DVec3::ZERO;
        for (h, i) in mirror.iter().zip(k..m) {
            if *h != 0.0 {
                sums.iter_mut().zip(&self.left[i * n + k..(i + 1) * n]).for_each(|(sum, a)| *sum += h * a);
                right += self.right[i] * *h;
            }
        }
        for (h, i) in mirror.iter().zip(k..m) {
            let factor = 2.0 * h / square;
            if factor != 0.0 {
                self.left[i * n + k..(i + 1) * n].iter_mut().zip(&sums).for_each(|(a, sum)| *a -= factor * sum);
                self.right[i] -= right * factor;
            }
        }
    }
}

/// Rows whose squares add up to a matrix that is not negative, `n` by `n`: its Cholesky factor, rows of zeros where nothing is left.
pub fn factor(matrix: &[f64], n: usize) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = vec![vec![0.0; n]; n];
    for k in 0..n {
        let left = |rows: &[Vec<f64>], j: usize| matrix[k * n + j] - (0..k).map(|i| rows[i][k] * rows[i][j]).sum::<f64>();
        let pivot = left(&rows, k);
        if pivot <= FILL_PIVOT * matrix[k * n + k] {
            continue;
        }
        let root = pivot.sqrt();
        let row: Vec<f64> = (0..n).map(|j| if j < k { 0.0 } else { left(&rows, j) / root }).collect();
        rows[k] = row;
    }
    rows
}
