//! Lines of points and their fairness: integrals of squared derivatives by divided differences, and solves with their matrix.

use glam::DVec3;

/// Least order of a derivative whose square is integrated.
pub const LEAST_ORDER: usize = 2;
/// The largest one.
pub const MOST_ORDER: usize = 4;

/// Coefficients of one difference, of the points from its first one on.
type Stencil = [f64; MOST_ORDER + 1];
/// A row of a symmetric band matrix: on the diagonal, then 1, 2, … before it.
type Band = [f64; MOST_ORDER + 1];

/// Lines over points in rows, all of one direction, with the differences that are taken of them.
///
/// The energy of a line is half the sum of h·|d|², d a derivative as a divided difference over parameters whose mean step is 1 and h
/// the length of parameter that it stands for; so it is a length squared.
pub struct Lines {
    /// From a point to the next one of its line, and from a line to the next one.
    strides: (usize, usize),
    /// Points of a line, and lines.
    counts: (usize, usize),
    /// With the root of h, at the first of their points; zeros where none starts.
    stencils: Vec<Stencil>,
    /// Points of each; 0 where there is none.
    lengths: Vec<u8>,
    matrix: Vec<Band>,
    /// The largest order of a difference.
    width: usize,
    /// Of the matrix divided by a number, plus 1: LDLᵀ, first the inverse of D of all points, then of all what is one before, …
    factor: [Vec<f64>; MOST_ORDER + 1],
}

impl Lines {
    /// Lines over points in rows: along the rows or across them. No differences yet.
    pub fn new((columns, rows): (usize, usize), along: bool) -> Self {
        let n = columns * rows;
        let (strides, counts) = if along { ((1, columns), (columns, rows)) } else { ((columns, 1), (rows, columns)) };
        let zero = [0.0; MOST_ORDER + 1];
        let factor = zero.map(|_| vec![0.0; n]);
        Self { strides, counts, stencils: vec![zero; n], lengths: vec![0; n], matrix: vec![zero; n], width: 0, factor }
    }

    /// Takes differences of one piece of a line, its first point at `from`, over the steps of its parameters: of the order, or of
    /// that which its points leave, at least the second.
    pub fn take(&mut self, line: usize, from: usize, steps: &[f64], order: usize) {
        let order = order.min(steps.len());
        if order < LEAST_ORDER {
            return;
        }
        self.width = self.width.max(order);
        for i in 0..=steps.len() - order {
            let over = &steps[i..i + order];
            let mut stencil = differences(over);
            let share = (over.iter().sum::<f64>() / order as f64).sqrt();
            stencil.iter_mut().for_each(|c| *c *= share);
            let place = |k: usize| line * self.strides.1 + (from + i + k) * self.strides.0;
            self.stencils[place(0)] = stencil;
            self.lengths[place(0)] = order as u8 + 1;
            for k in 0..=order {
                for l in 0..=k {
                    self.matrix[place(k)][k - l] += stencil[k] * stencil[l];
                }
            }
        }
    }

    /// Twice the energy: the sum of the squares of all differences.
    pub fn energy(&self, points: &[DVec3]) -> f64 {
        let step = self.strides.0;
        let all = self.stencils.iter().zip(&self.lengths).enumerate().filter(|(_, (_, n))| **n > 0);
        all.map(|(p, (c, n))| (0..usize::from(*n)).map(|k| points[p + k * step] * c[k]).sum::<DVec3>().length_squared()).sum()
    }

    /// Adds the gradient of the energy.
    pub fn add_gradient(&self, points: &[DVec3], to: &mut [DVec3]) {
        let step = self.strides.0;
        for (p, (c, n)) in self.stencils.iter().zip(&self.lengths).enumerate() {
            let n = usize::from(*n);
            let d: DVec3 = (0..n).map(|k| points[p + k * step] * c[k]).sum();
            for k in 0..n {
                to[p + k * step] += d * c[k];
            }
        }
    }

    /// The sum of squares of the coefficients that reach a point.
    pub fn stiffness_at(&self, point: usize) -> f64 {
        self.matrix[point][0]
    }

    /// The largest such sum.
    pub fn stiffness(&self) -> f64 {
        self.matrix.iter().map(|band| band[0]).fold(0.0, f64::max)
    }

    /// How many differences are taken.
    pub fn differences(&self) -> usize {
        self.lengths.iter().filter(|n| **n > 0).count()
    }

    /// Decomposes the matrix divided by `stiffness`, plus 1.
    pub fn decompose(&mut self, stiffness: f64) {
        let step = self.strides.0;
        for line in 0..self.counts.1 {
            for k in 0..self.counts.0 {
                let (p, width) = (line * self.strides.1 + k * step, self.width.min(k));
                let mut row = self.matrix[p].map(|a| a / stiffness);
                row[0] += 1.0;
                // Before it, from the farthest on: L·D first, then L.
                for d in (1..=width).rev() {
                    for e in d + 1..=width {
                        row[d] -= row[e] * self.factor[e - d][p - d * step];
                    }
                }
                for d in 1..=width {
                    let whole = row[d];
                    row[d] *= self.factor[0][p - d * step];
                    row[0] -= whole * row[d];
                }
                row[0] = 1.0 / row[0];
                self.factor.iter_mut().zip(row).for_each(|(all, x)| all[p] = x);
            }
        }
    }

    /// Solves with what was decomposed, in place: all x, then all y, then all z.
    pub fn solve(&self, x: &mut [f64]) {
        let n = self.matrix.len();
        if self.strides.0 > 1 {
            x.chunks_exact_mut(n).for_each(|x| self.solve_columns(x));
            return;
        }
        let points = self.counts.0;
        let (x, rest) = x.split_at_mut(n);
        let (y, z) = rest.split_at_mut(n);
        let rows = x.chunks_exact_mut(points).zip(y.chunks_exact_mut(points)).zip(z.chunks_exact_mut(points));
        for (k, ((x, y), z)) in rows.enumerate() {
            solve_row([x, y, z], self.factor.each_ref().map(|all| &all[k * points..(k + 1) * points]));
        }
    }

    fn solve_columns(&self, x: &mut [f64]) {
        let (points, step) = (self.counts.0, self.strides.0);
        for k in 1..points {
            let (before, own) = x.split_at_mut(k * step);
            for d in 1..=self.width.min(k) {
                subtract(&mut own[..step], &before[(k - d) * step..], &self.factor[d][k * step..]);
            }
        }
        for k in (0..points).rev() {
            let (own, after) = x[k * step..].split_at_mut(step);
            own.iter_mut().zip(&self.factor[0][k * step..]).for_each(|(x, f)| *x *= f);
            for d in 1..=self.width.min(points - 1 - k) {
                subtract(own, &after[(d - 1) * step..], &self.factor[d][(k + d) * step..]);
            }
        }
    }
}

/// Takes products from numbers.
fn subtract(from: &mut [f64], a: &[f64], b: &[f64]) {
    from.iter_mut().zip(a).zip(b).for_each(|((x, a), b)| *x -= a * b);
}

/// Solves along one row, the three coordinates side by side: a step of one does not wait for those of the others.
fn solve_row([x, y, z]: [&mut [f64]; 3], [f0, f1, f2, f3, f4]: [&[f64]; MOST_ORDER + 1]) {
    // The four points before, or behind, the nearest one first.
    let [mut a, mut b, mut c, mut d] = [[0.0; 3]; MOST_ORDER];
    let points = x.iter_mut().zip(y.iter_mut()).zip(z.iter_mut());
    for (((((x, y), z), f1), f2), (f3, f4)) in points.zip(f1).zip(f2).zip(f3.iter().zip(f4)) {
        let own = [*x, *y, *z];
        let next = [0, 1, 2].map(|i| own[i] - (d[i] * f4 + c[i] * f3 + b[i] * f2) - a[i] * f1);
        [*x, *y, *z] = next;
        (a, b, c, d) = (next, a, b, c);
    }
    [a, b, c, d] = [[0.0; 3]; MOST_ORDER];
    // What the points behind take: the factors stand at these.
    let (mut s, mut t, mut u, mut v) = ([0.0; MOST_ORDER], [0.0; MOST_ORDER], [0.0; MOST_ORDER], [0.0; MOST_ORDER]);
    let points = x.iter_mut().zip(y.iter_mut()).zip(z.iter_mut());
    for (((((x, y), z), f0), (f1, f2)), (f3, f4)) in points.zip(f0).zip(f1.iter().zip(f2)).zip(f3.iter().zip(f4)).rev() {
        let own = [*x, *y, *z];
        let next = [0, 1, 2].map(|i| own[i] * f0 - (d[i] * v[3] + c[i] * u[2] + b[i] * t[1]) - a[i] * s[0]);
        [*x, *y, *z] = next;
        (a, b, c, d) = (next, a, b, c);
        (s, t, u, v) = ([*f1, *f2, *f3, *f4], s, t, u);
    }
}

/// Coefficients of the derivative of an order over as many steps: the factorial times a divided difference.
pub fn differences(steps: &[f64]) -> Stencil {
    let mut at = [0.0; MOST_ORDER + 1];
    for (k, step) in steps.iter().enumerate() {
        at[k + 1] = at[k] + step;
    }
    let factorial: f64 = (1..=steps.len()).map(|k| k as f64).product();
    let mut stencil = [0.0; MOST_ORDER + 1];
    for (k, c) in stencil.iter_mut().enumerate().take(steps.len() + 1) {
        *c = factorial / (0..=steps.len()).filter(|l| *l != k).map(|l| at[k] - at[l]).product::<f64>();
    }
    stencil
}
