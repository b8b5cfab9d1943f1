//! C2 cubics nearest to data in the sense of least squares: basis, normal equations and their solution.

use glam::DVec3;

use crate::base::tolerance::EPSILON;

/// Degree of what is fitted.
pub const DEGREE: usize = 3;

/// Cubic B-splines over breaks x₀ < … < xₘ, simple inside; periodic when closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Cubics {
    /// The breaks.
    pub breaks: Vec<f64>,
    /// Whether the end joins the start, twice continuously differentiable.
    pub closed: bool,
}

impl Cubics {
    /// How many poles there are: m + 3, or m when closed.
    pub fn poles(&self) -> usize {
        self.breaks.len() - 1 + if self.closed { 0 } else { DEGREE }
    }

    /// All knots: clamped, or one period continued to either side.
    pub fn knots(&self) -> Vec<f64> {
        let (x, m) = (&self.breaks, self.breaks.len() - 1);
        if !self.closed {
            let ends = |t: f64| std::iter::repeat_n(t, DEGREE);
            return ends(x[0]).chain(x.iter().copied()).chain(ends(x[m])).collect();
        }
        let period = x[m] - x[0];
        let at = |i: isize| x[i.rem_euclid(m as isize) as usize] + period * i.div_euclid(m as isize) as f64;
        (-(DEGREE as isize)..=(m + DEGREE) as isize).map(at).collect()
    }

    /// The first of the four poles that reach a parameter, and their shares.
    pub fn shares(&self, knots: &[f64], t: f64) -> (usize, [f64; DEGREE + 1]) {
        let m = self.breaks.len() - 1;
        let span = self.breaks[1..m].partition_point(|x| *x <= t);
        let mut n = [0.0; DEGREE + 1];
        n[0] = 1.0;
        for p in 1..=DEGREE {
            let mut rest = 0.0;
            for r in 0..p {
                let (low, high) = (knots[span + DEGREE + 1 + r - p], knots[span + DEGREE + 1 + r]);
                let share = n[r] / (high - low);
                n[r] = rest + (high - t) * share;
                rest = (t - low) * share;
            }
            n[p] = rest;
        }
        (span, n)
    }
}

/// The least-squares problem of some cubics at some parameters, factored once for many data.
///
/// An open one goes through the first and the last datum.
pub struct Problem {
    rows: Vec<(usize, [f64; DEGREE + 1])>,
    /// Poles that are sought: all but the two ends of an open one.
    free: (usize, usize),
    poles: usize,
    factor: Vec<Vec<f64>>,
    from: Vec<usize>,
}

impl Problem {
    /// None where the data do not settle every pole.
    pub fn new(cubics: &Cubics, parameters: &[f64]) -> Option<Self> {
        let (knots, poles) = (cubics.knots(), cubics.poles());
        let rows: Vec<_> = parameters.iter().map(|t| cubics.shares(&knots, *t)).collect();
        let free = if cubics.closed { (0, poles) } else { (1, poles - 1) };
        let inner = if cubics.closed { rows.len() } else { rows.len().saturating_sub(2) };
        if inner < free.1 - free.0 {
            return None;
        }
        let mut problem = Self { rows, free, poles, factor: Vec::new(), from: Vec::new() };
        problem.gather();
        problem.decompose().then_some(problem)
    }

    fn places(&self, row: &(usize, [f64; DEGREE + 1])) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let (first, shares, poles) = (row.0, row.1, self.poles);
        (0..=DEGREE).map(move |k| ((first + k) % poles, shares[k]))
    }

    /// The normal matrix below its diagonal, each row from its first entry on.
    fn gather(&mut self) {
        let (low, high) = self.free;
        let n = high - low;
        self.from = (0..n).collect();
        for row in &self.rows {
            let taken: Vec<usize> = self.places(row).map(|(i, _)| i).filter(|i| (low..high).contains(i)).map(|i| i - low).collect();
            let least = taken.iter().copied().min().unwrap_or(0);
            taken.iter().for_each(|i| self.from[*i] = self.from[*i].min(least));
        }
        let mut factor: Vec<Vec<f64>> = (0..n).map(|i| vec![0.0; i + 1 - self.from[i]]).collect();
        for row in &self.rows {
            for (i, a) in self.places(row).filter(|(i, _)| (low..high).contains(i)) {
                for (k, b) in self.places(row).filter(|(k, _)| (low..high).contains(k) && *k <= i) {
                    factor[i - low][k - low - self.from[i - low]] += a * b;
                }
            }
        }
        self.factor = factor;
    }

    /// Cholesky's decomposition inside the envelope; false where the matrix is singular.
    fn decompose(&mut self) -> bool {
        for i in 0..self.factor.len() {
            let (done, rest) = self.factor.split_at_mut(i);
            let (row, start) = (&mut rest[0], self.from[i]);
            let whole = row[i - start];
            for k in start..i {
                let first = start.max(self.from[k]);
                let sum: f64 = (first..k).map(|j| row[j - start] * done[k][j - self.from[k]]).sum();
                row[k - start] = (row[k - start] - sum) / done[k][k - self.from[k]];
            }
            let rest = whole - row[..i - start].iter().map(|x| x * x).sum::<f64>();
            if rest <= EPSILON.sqrt() * EPSILON.sqrt().sqrt() * whole {
                return false;
            }
            row[i - start] = rest.sqrt();
        }
        true
    }

    /// The poles nearest to these data, one a parameter.
    pub fn solve(&self, data: &[DVec3]) -> Vec<DVec3> {
        let (low, high) = self.free;
        let mut poles = vec![DVec3::ZERO; self.poles];
        if low > 0 {
            (poles[0], poles[high]) = (data[0], data[data.len() - 1]);
        }
        let mut right = vec![DVec3::ZERO; high - low];
        for (row, p) in self.rows.iter().zip(data) {
            let known: DVec3 = self.places(row).filter(|(i, _)| !(low..high).contains(i)).map(|(i, a)| poles[i] * a).sum();
            for (i, a) in self.places(row).filter(|(i, _)| (low..high).contains(i)) {
                right[i - low] += (*p - known) * a;
            }
        }
        for i in 0..right.len() {
            let start = self.from[i];
            let sum: DVec3 = (start..i).map(|k| right[k] * self.factor[i][k - start]).sum();
            right[i] = (right[i] - sum) / self.factor[i][i - start];
        }
        for i in (0..right.len()).rev() {
            let start = self.from[i];
            right[i] /= self.factor[i][i - start];
            for k in start..i {
                let part = right[i] * self.factor[i][k - start];
                right[k] -= part;
            }
        }
        poles[low..high].copy_from_slice(&right);
        poles
    }
}
