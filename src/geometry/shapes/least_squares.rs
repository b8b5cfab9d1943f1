//! Splines of degree up to 3, with simple knots, nearest to data in the sense of least squares: basis, normal equations and their solution.

use glam::DVec3;

use crate::base::tolerance::EPSILON;

/// Largest degree of what is fitted.
pub const DEGREE: usize = 3;

/// B-splines over breaks x₀ < … < xₘ, simple inside; periodic when closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Cubics {
    /// The breaks.
    pub breaks: Vec<f64>,
    /// Whether the end joins the start, as smoothly as breaks are crossed.
    pub closed: bool,
    /// Degree, 1 to [`DEGREE`].
    pub degree: usize,
}

impl Cubics {
    /// How many poles there are: m + degree, or m when closed.
    pub fn poles(&self) -> usize {
        self.breaks.len() - 1 + if self.closed { 0 } else { self.degree }
    }

    /// All knots: clamped, or one period continued to either side.
    pub fn knots(&self) -> Vec<f64> {
        let (x, m, degree) = (&self.breaks, self.breaks.len() - 1, self.degree);
        if !self.closed {
            let ends = |t: f64| std::iter::repeat_n(t, degree);
            return ends(x[0]).chain(x.iter().copied()).chain(ends(x[m])).collect();
        }
        let period = x[m] - x[0];
        let at = |i: isize| x[i.rem_euclid(m as isize) as usize] + period * i.div_euclid(m as isize) as f64;
        (-(degree as isize)..=(m + degree) as isize).map(at).collect()
    }

    /// The first of the poles that reach a parameter, one more than the degree, and their shares.
    pub fn shares(&self, knots: &[f64], t: f64) -> (usize, [f64; DEGREE + 1]) {
        let m = self.breaks.len() - 1;
        let span = self.breaks[1..m].partition_point(|x| *x <= t);
        let mut n = [0.0; DEGREE + 1];
        n[0] = 1.0;
        let degree = self.degree;
        for p in 1..=degree {
            let mut rest = 0.0;
            for r in 0..p {
                let (low, high) = (knots[span + degree + 1 + r - p], knots[span + degree + 1 + r]);
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
    degree: usize,
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
        let mut problem = Self { rows, free, poles, degree: cubics.degree, factor: Vec::new(), from: Vec::new() };
        problem.gather();
        problem.decompose().then_some(problem)
    }

    fn places(&self, row: &(usize, [f64; DEGREE + 1])) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let (first, shares, poles) = (row.0, row.1, self.poles);
        (0..=self.degree).map(move |k| ((first + k) % poles, shares[k]))
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

    /// The same of many lines at once: `data` has for each parameter `width` numbers, the poles have as many each.
    pub fn solve_all(&self, data: &[f64], width: usize) -> Vec<f64> {
        let (low, high) = self.free;
        let mut poles = vec![0.0; self.poles * width];
        if low > 0 {
            poles[..width].copy_from_slice(&data[..width]);
            poles[high * width..].copy_from_slice(&data[data.len() - width..]);
        }
        let mut right = vec![0.0; (high - low) * width];
        for (row, p) in self.rows.iter().zip(data.chunks_exact(width)) {
            for (i, a) in self.places(row).filter(|(i, _)| (low..high).contains(i)) {
                let to = &mut right[(i - low) * width..][..width];
                add(to, p, a);
                for (k, b) in self.places(row).filter(|(k, _)| !(low..high).contains(k)) {
                    add(to, &poles[k * width..], -a * b);
                }
            }
        }
        for (i, factors) in self.factor.iter().enumerate() {
            let (done, rest) = right.split_at_mut(i * width);
            let (own, inner) = (&mut rest[..width], i - self.from[i]);
            for (f, other) in factors.iter().zip(done[self.from[i] * width..].chunks_exact(width)) {
                add(own, other, -f);
            }
            own.iter_mut().for_each(|x| *x /= factors[inner]);
        }
        for (i, factors) in self.factor.iter().enumerate().rev() {
            let (before, rest) = right.split_at_mut(i * width);
            let (own, inner) = (&mut rest[..width], i - self.from[i]);
            own.iter_mut().for_each(|x| *x /= factors[inner]);
            for (f, other) in factors.iter().zip(before[self.from[i] * width..].chunks_exact_mut(width)) {
                add(other, own, -f);
            }
        }
        poles[low * width..high * width].copy_from_slice(&right);
        poles
    }

    /// What lines with these poles have at a parameter, by its number; `width` numbers as in [`solve_all`](Self::solve_all).
    pub fn put(&self, parameter: usize, poles: &[f64], at: &mut [f64]) {
        at.fill(0.0);
        let width = at.len();
        self.places(&self.rows[parameter]).for_each(|(i, a)| add(at, &poles[i * width..], a));
    }
}

/// Adds a multiple.
fn add(to: &mut [f64], from: &[f64], by: f64) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += from * by);
}
