//! Splines of degree 3 or 5 over breaks that a family of curves shares: from values and derivatives to control points.
//!
//! Between two breaks at which derivatives are given a spline goes through a value at each break: the complete spline, which has
//! the least square of its bend (degree 3) or of its third derivative (degree 5) of all curves through them [de Boor 1978].

use std::ops::{Add, Mul, Sub};

/// What values and derivatives are made of.
pub trait Linear: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {}
impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>> Linear for T {}

/// Most derivatives of a piece, the value included.
const ORDERS: usize = 6;

/// Breaks from 0 to 1 with how many derivatives go on across each, degree − 1 at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Breaks {
    /// 3 or 5.
    pub degree: usize,
    /// Ascending, 0 and 1 included.
    pub at: Vec<f64>,
    /// One per break; of the ends it is not read.
    pub smooth: Vec<usize>,
}

/// Values, slopes and bends at breaks: of the piece that ends there and of the one that begins.
#[derive(Clone, Debug)]
pub struct Hermite<T> {
    /// Values.
    pub value: Vec<T>,
    /// First derivatives.
    pub slope: Vec<[T; 2]>,
    /// Second derivatives; of degree 3 they follow from the rest and are not read.
    pub bend: Vec<[T; 2]>,
}

impl Breaks {
    /// Nothing inside.
    pub fn none(degree: usize) -> Self {
        Self { degree, at: vec![0.0, 1.0], smooth: vec![0; 2] }
    }

    /// Puts a break, or lets fewer derivatives go on at the one that stands within a distance.
    pub fn put(&mut self, x: f64, smooth: usize, within: f64) {
        let smooth = smooth.min(self.degree - 1);
        let k = self.at.partition_point(|y| *y < x - within);
        if self.at.get(k).is_some_and(|y| *y <= x + within) {
            self.smooth[k] = self.smooth[k].min(smooth);
        } else {
            self.at.insert(k, x);
            self.smooth.insert(k, smooth);
        }
    }

    /// How many spans there are.
    pub fn spans(&self) -> usize {
        self.at.len() - 1
    }

    /// Whether derivatives at break `k` are given: at the ends, and where not all go on.
    pub fn is_given(&self, k: usize) -> bool {
        k == 0 || k == self.spans() || self.smooth[k] + 1 < self.degree
    }

    /// How many control points there are.
    pub fn poles(&self) -> usize {
        self.vector().len() - self.degree - 1
    }

    /// All knots, clamped.
    pub fn vector(&self) -> Vec<f64> {
        let last = self.spans();
        let times = |k: usize| if k == 0 || k == last { self.degree + 1 } else { self.degree - self.smooth[k] };
        self.at.iter().enumerate().flat_map(|(k, x)| std::iter::repeat_n(*x, times(k))).collect()
    }

    /// All derivatives of the piece in span `k` at its end, the last or the first, up to the degree.
    fn derivatives<T: Linear>(&self, of: &Hermite<T>, k: usize, last: bool) -> [T; ORDERS] {
        let h = self.at[k + 1] - self.at[k];
        let rise = (of.value[k + 1] - of.value[k]) * (1.0 / h);
        let (m, n) = (of.slope[k][1], of.slope[k + 1][0]);
        // About the end asked for, the other end is behind: the step is negative and the ends change places.
        let (value, near, far, h) = if last { (of.value[k + 1], n, m, -h) } else { (of.value[k], m, n, h) };
        let zero = value * 0.0;
        if self.degree == 3 {
            let bend = (rise * 6.0 - near * 4.0 - far * 2.0) * (1.0 / h);
            let third = (near + far - rise * 2.0) * (6.0 / (h * h));
            return [value, near, bend, third, zero, zero];
        }
        let (p, q) = if last { (of.bend[k + 1][0], of.bend[k][1]) } else { (of.bend[k][1], of.bend[k + 1][0]) };
        let (h2, h3, h4) = (h * h, h * h * h, h * h * h * h);
        let third = (rise * 60.0 - near * 36.0 - far * 24.0) * (1.0 / h2) + (q * 3.0 - p * 9.0) * (1.0 / h);
        let fourth = (near * 192.0 + far * 168.0 - rise * 360.0) * (1.0 / h3) + (p * 36.0 - q * 24.0) * (1.0 / h2);
        let fifth = (rise * 2.0 - near - far) * (360.0 / h4) + (q - p) * (60.0 / h3);
        [value, near, p, third, fourth, fifth]
    }

    /// Value and all derivatives in span `k`, about its nearer end.
    pub fn jet<T: Linear>(&self, of: &Hermite<T>, k: usize, x: f64) -> [T; ORDERS] {
        let last = x - self.at[k] > self.at[k + 1] - x;
        let t = x - self.at[k + usize::from(last)];
        let mut d = self.derivatives(of, k, last);
        for r in 0..self.degree {
            let sum = (r..=self.degree).rev().fold(d[r] * 0.0, |sum, s| d[s] + sum * (t / (s + 1 - r) as f64));
            d[r] = sum;
        }
        d
    }

    /// The control points: polar forms of the pieces at so many neighbouring knots as the degree is.
    pub fn control<T: Linear>(&self, of: &Hermite<T>) -> Vec<T> {
        let knots = self.vector();
        let p = self.degree;
        let mut k = 0;
        let pole = |i: usize| {
            let x = knots[i + p.div_ceil(2)];
            while self.at[k] < x {
                k += 1;
            }
            // A piece next to the middle knot on which the basis function is not zero.
            let d = if knots[i + p + 1] > x { self.derivatives(of, k, false) } else { self.derivatives(of, k - 1, true) };
            // Elementary symmetric functions of the knots about it.
            let mut e = [0.0; ORDERS];
            e[0] = 1.0;
            for knot in &knots[i + 1..=i + p] {
                for r in (1..=p).rev() {
                    e[r] += e[r - 1] * (knot - x);
                }
            }
            // f^(r) / r! over the binomial coefficient (p, r) is f^(r) (p − r)! / p!.
            let (mut sum, mut by) = (d[0], 1.0);
            for r in 1..=p {
                by /= (p + 1 - r) as f64;
                sum = sum + d[r] * (e[r] * by);
            }
            sum
        };
        (0..self.poles()).map(pole).collect()
    }

    /// Finds derivatives at the breaks at which none are given, so that all go on across them.
    pub fn complete<T: Linear>(&self, of: &mut Hermite<T>) {
        let mut from = 0;
        for to in 1..=self.spans() {
            if self.is_given(to) {
                if self.degree == 3 {
                    self.complete_cubic(of, from, to)
                } else {
                    self.complete_quintic(of, from, to)
                }
                from = to;
            }
        }
    }

    fn step(&self, k: usize) -> f64 {
        self.at[k + 1] - self.at[k]
    }

    fn complete_cubic<T: Linear>(&self, of: &mut Hermite<T>, from: usize, to: usize) {
        // Elimination downwards, then back; the slopes at both ends are known.
        let mut done: Vec<(f64, T)> = vec![(0.0, of.slope[from][1])];
        for k in from + 1..to {
            let (a, b) = (self.step(k - 1), self.step(k));
            let right = (of.value[k] - of.value[k - 1]) * (3.0 * b / a) + (of.value[k + 1] - of.value[k]) * (3.0 * a / b);
            let (share, before) = done[k - from - 1];
            let pivot = 2.0 * (a + b) - b * share;
            done.push((a / pivot, (right - before * b) * (1.0 / pivot)));
        }
        let mut next = of.slope[to][0];
        for k in (from + 1..to).rev() {
            let (share, own) = done[k - from];
            next = own - next * share;
            of.slope[k] = [next; 2];
        }
    }

    /// Third and fourth derivatives go on: two equations for slope and bend at each break, both ends known.
    fn complete_quintic<T: Linear>(&self, of: &mut Hermite<T>, from: usize, to: usize) {
        // Slope and bend at a break are its pair less its block times those at the next one. Bends count times a step, so that
        // all unknowns are slopes in size.
        let unit = self.step(from);
        let mut done: Vec<(Matrix2, [T; 2])> = vec![([[0.0; 2]; 2], [of.slope[from][1], of.bend[from][1] * unit])];
        for k in from + 1..to {
            let (a, b) = (self.step(k - 1), self.step(k));
            let (left, right) = ((of.value[k] - of.value[k - 1]) * (1.0 / a), (of.value[k + 1] - of.value[k]) * (1.0 / b));
            // Rows: third derivatives times a b, fourth ones times (a b)^(3/2).
            let (s, g) = (a * b, (a * b).sqrt());
            let (a2, b2, a3, b3) = (s / (a * a), s / (b * b), s * g / (a * a * a), s * g / (b * b * b));
            let (a1, b1, a4, b4) = (s / (a * unit), s / (b * unit), s * g / (a * a * unit), s * g / (b * b * unit));
            let low = [[-24.0 * a2, -3.0 * a1], [-168.0 * a3, -24.0 * a4]];
            let mid = [[36.0 * (b2 - a2), 9.0 * (a1 + b1)], [-192.0 * (a3 + b3), 36.0 * (a4 - b4)]];
            let high = [[24.0 * b2, -3.0 * b1], [-168.0 * b3, 24.0 * b4]];
            let mut known = [right * (60.0 * b2) - left * (60.0 * a2), left * (-360.0 * a3) - right * (360.0 * b3)];
            let (block, before) = &done[k - from - 1];
            let mut pivot = mid;
            for r in 0..2 {
                known[r] = known[r] - before[0] * low[r][0] - before[1] * low[r][1];
                for c in 0..2 {
                    pivot[r][c] -= low[r][0] * block[0][c] + low[r][1] * block[1][c];
                }
            }
            let back = inverse(pivot);
            let block = [0, 1].map(|r| [0, 1].map(|c| back[r][0] * high[0][c] + back[r][1] * high[1][c]));
            done.push((block, [0, 1].map(|r| known[0] * back[r][0] + known[1] * back[r][1])));
        }
        let mut next = [of.slope[to][0], of.bend[to][0] * unit];
        for k in (from + 1..to).rev() {
            let (block, own) = &done[k - from];
            next = [0, 1].map(|r| own[r] - next[0] * block[r][0] - next[1] * block[r][1]);
            of.slope[k] = [next[0]; 2];
            of.bend[k] = [next[1] * (1.0 / unit); 2];
        }
    }
}

/// Two rows of two.
type Matrix2 = [[f64; 2]; 2];

fn inverse(m: Matrix2) -> Matrix2 {
    let by = 1.0 / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
    [[m[1][1] * by, -m[0][1] * by], [-m[1][0] * by, m[0][0] * by]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::powi;

    /// A polynomial of the degree is met whatever the breaks, with all derivatives and its own polar forms.
    #[test]
    fn polynomials_are_reproduced_and_control_points_are_theirs() {
        for degree in [3, 5] {
            let coefficients = [1.0, -2.0, 3.0, -5.0, 4.0, 7.0];
            let f = |x: f64, order: usize| -> f64 {
                (order..=degree)
                    .map(|r| coefficients[r] * (0..order).map(|s| (r - s) as f64).product::<f64>() * powi(x, (r - order) as i32))
                    .sum()
            };
            let mut breaks = Breaks::none(degree);
            for (x, smooth) in [(0.3, 9), (0.31, 9), (0.4, 1), (0.5, 0), (0.6, 2), (0.9, 9), (0.95, 9), (0.3, 9)] {
                breaks.put(x, smooth, 0.0);
            }
            let twice = |order: usize| breaks.at.iter().map(|x| [f(*x, order); 2]).collect::<Vec<_>>();
            let mut of = Hermite { value: breaks.at.iter().map(|x| f(*x, 0)).collect(), slope: twice(1), bend: twice(2) };
            for k in (0..breaks.at.len()).filter(|k| !breaks.is_given(*k)) {
                (of.slope[k], of.bend[k]) = ([7.0; 2], [7.0; 2]);
            }
            breaks.complete(&mut of);
            for (k, w) in breaks.at.windows(2).enumerate() {
                for x in [0.1, 0.5, 0.8].map(|s| w[0] + s * (w[1] - w[0])) {
                    let jet = breaks.jet(&of, k, x);
                    for (order, near) in [(0, 1e-13), (1, 1e-12), (2, 1e-9), (3, 1e-7)] {
                        assert!((jet[order] - f(x, order)).abs() < near, "{degree} {x} {order}: {} {}", jet[order], f(x, order));
                    }
                }
            }
            let knots = breaks.vector();
            for (i, pole) in breaks.control(&of).into_iter().enumerate() {
                let own = &knots[i + 1..=i + degree];
                // Symmetric multilinear form: the mean over the choices of so many of the knots.
                let mut e = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                own.iter().for_each(|t| (1..=degree).rev().for_each(|r| e[r] += e[r - 1] * t));
                let binomial = crate::geometry::shapes::bounds::binomial;
                let polar: f64 = (0..=degree).map(|r| coefficients[r] * e[r] / binomial(degree, r)).sum();
                assert!((pole - polar).abs() < 1e-11, "{degree} {i}: {pole} {polar}");
            }
        }
    }
}
