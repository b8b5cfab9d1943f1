//! Small direct solvers and a safeguarded root finder.

use std::ops::{Add, Mul, Sub};

/// Solves A·x = b in place by elimination with row pivoting; `a` is row by row, `b.len()` squared entries.
///
/// Returns `false` when a pivot is zero, that is when A is singular. Meant for a few dozen unknowns.
pub fn dense(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs())).unwrap_or(k);
        if a[pivot * n + k] == 0.0 {
            return false;
        }
        for j in 0..n {
            a.swap(k * n + j, pivot * n + j);
        }
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            for j in k..n {
                a[i * n + j] -= factor * a[k * n + j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            b[k] -= a[k * n + j] * b[j];
        }
        b[k] /= a[k * n + k];
    }
    true
}

/// What a tridiagonal system may have on its right side: numbers or vectors.
pub trait Linear: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {}
impl<T: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>> Linear for T {}

/// One row of a tridiagonal matrix: below, on and above the diagonal.
pub type Row = [f64; 3];

/// Solves a tridiagonal system in place; rows must be diagonally dominant (then no pivoting is needed).
pub fn tridiagonal<T: Linear>(rows: &[Row], right: &mut [T]) {
    let n = right.len();
    let mut above = vec![0.0; n];
    for i in 0..n {
        let [below, mut on, up] = rows[i];
        if i > 0 {
            on -= below * above[i - 1];
            right[i] = right[i] - right[i - 1] * below;
        }
        above[i] = up / on;
        right[i] = right[i] * (1.0 / on);
    }
    for i in (0..n.saturating_sub(1)).rev() {
        right[i] = right[i] - right[i + 1] * above[i];
    }
}

/// Solves a periodic tridiagonal system of n ≥ 3 unknowns in place: row 0 has the last unknown below its diagonal and
/// row n − 1 the first above [Sherman & Morrison 1950].
pub fn cyclic<T: Linear>(rows: &[Row], right: &mut [T]) {
    let n = right.len();
    let (corner_low, corner_high) = (rows[0][0], rows[n - 1][2]);
    let gamma = -rows[0][1];
    let mut inner = rows.to_vec();
    inner[0][1] -= gamma;
    inner[n - 1][1] -= corner_low * corner_high / gamma;
    let mut correction = vec![0.0; n];
    correction[0] = gamma;
    correction[n - 1] = corner_high;
    tridiagonal(&inner, right);
    tridiagonal(&inner, &mut correction);
    let ratio = corner_low / gamma;
    let scale = 1.0 / (1.0 + correction[0] + ratio * correction[n - 1]);
    let factor = (right[0] + right[n - 1] * ratio) * scale;
    for (x, c) in right.iter_mut().zip(&correction) {
        *x = *x - factor * *c;
    }
}

/// Newton with a bracket [Press et al. 1992, rtsafe]: a root of `f` (value, derivative) between `low` and `high`, where it changes sign.
///
/// Steps that leave the bracket become bisections; ends when the step is below `accuracy` or after 100 rounds.
pub fn bracketed(low: f64, high: f64, accuracy: f64, mut f: impl FnMut(f64) -> (f64, f64)) -> f64 {
    let rising = f(high).0 >= f(low).0;
    bracketed_from((low, high), rising, 0.5 * (low + high), accuracy, f)
}

/// [`bracketed`] of a function known to rise or to fall, from a first guess.
pub fn bracketed_from(
    (mut low, mut high): (f64, f64),
    rising: bool,
    guess: f64,
    accuracy: f64,
    mut f: impl FnMut(f64) -> (f64, f64),
) -> f64 {
    let mut x = guess;
    for _ in 0..100 {
        let (value, slope) = f(x);
        if value == 0.0 {
            return x;
        }
        if (value > 0.0) == rising {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        let next = if newton > low.min(high) && newton < low.max(high) { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= accuracy {
            return next;
        }
        x = next;
    }
    x
}

/// Where an answer changes between `low`, where it is `first`, and `high`, by 60 halvings; `None` where there is no answer.
pub fn turn(mut low: f64, mut high: f64, first: bool, mut f: impl FnMut(f64) -> Option<bool>) -> Option<f64> {
    const HALVINGS: usize = 60;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if f(middle)? == first {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// Where a function with one minimum between `low` and `high` is least, by golden sections, to `accuracy` of the interval.
pub fn lowest(mut low: f64, mut high: f64, accuracy: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let enough = accuracy * (high - low);
    let (mut x, mut y) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fx, mut fy) = (f(x), f(y));
    for _ in 0..100 {
        if high - low <= enough {
            break;
        }
        if fx <= fy {
            (high, y, fy) = (y, x, fx);
            x = high - GOLDEN * (high - low);
            fx = f(x);
        } else {
            (low, x, fx) = (x, y, fy);
            y = low + GOLDEN * (high - low);
            fy = f(y);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dense_solves_and_sees_singular() {
        let a = [0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 2.0, 1.0, 0.0];
        let mut x = vec![5.0, 10.0, 8.0];
        assert!(dense(&mut a.clone(), &mut x));
        for (row, right) in a.chunks(3).zip([5.0, 10.0, 8.0]) {
            assert!((row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>() - right).abs() < 1e-14);
        }
        assert!(!dense(&mut [1.0, 2.0, 2.0, 4.0], &mut [1.0, 2.0]));
    }

    #[test]
    fn tridiagonal_and_cyclic_leave_no_residual() {
        let rows: Vec<Row> = (0..6).map(|i| [1.0 + f64::from(i), 9.0 + f64::from(i), 2.0]).collect();
        let right: Vec<f64> = (0..6).map(|i| f64::from(i * i) - 3.0).collect();
        for periodic in [false, true] {
            let mut x = right.clone();
            if periodic {
                cyclic(&rows, &mut x)
            } else {
                tridiagonal(&rows, &mut x)
            }
            for i in 0..6 {
                let before = if i > 0 {
                    x[i - 1]
                } else if periodic {
                    x[5]
                } else {
                    0.0
                };
                let after = if i < 5 {
                    x[i + 1]
                } else if periodic {
                    x[0]
                } else {
                    0.0
                };
                let sum = rows[i][0] * before + rows[i][1] * x[i] + rows[i][2] * after;
                assert!((sum - right[i]).abs() < 1e-13, "{periodic} {i}");
            }
        }
    }

    #[test]
    fn bracketed_root_is_found_where_newton_alone_runs_away() {
        let root = bracketed(-10.0, 30.0, 1e-15, |x| (libm::atan(x - 1.0), 1.0 / (1.0 + (x - 1.0) * (x - 1.0))));
        assert!((root - 1.0).abs() < 1e-14);
    }
}
