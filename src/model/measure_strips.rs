//! Integrals along u over the strips between breaks in v: how they are cut so that a rule is exact enough, and a table of them.
//!
//! Both are found from rows at the nodes of a strip. Cells along u are halved until two rules agree there; the integral up to the
//! end of each cell is then told by a few Chebyshev terms in v, or the strip is halved. What is left open is stated.

use std::f64::consts::PI;

use glam::DVec2;

use super::measure_quadrature::{Sums, add, small};
use crate::base::job;
use crate::base::math;
use crate::base::quadrature::{RUNNING, chebyshev};

/// A strip is halved at most so often, all together so many times.
const HALVINGS: (u32, usize) = (6, 64);
/// A cell along u is halved at most so often, those of a strip together so many times.
const CELL_HALVINGS: (u32, usize) = (16, 256);

/// Value of N functions and their size, not negative.
pub type Sized<const N: usize> = (Sums<N>, Sums<N>);

/// How rows are integrated.
#[derive(Clone, Copy)]
pub struct Rules<'a> {
    /// Points and weights over −1…1.
    pub coarse: &'a [(f64, f64)],
    /// The same, of the rule that is used.
    pub fine: &'a [(f64, f64)],
    /// What both may differ by, of the largest sum of sizes of a row.
    pub accuracy: f64,
}

/// The strips between two values of v.
pub struct Strips<const N: usize> {
    strips: Vec<Strip<N>>,
    /// What the integrals are off by at most in all, by the estimates of the rules.
    error: Sums<N>,
}

struct Strip<const N: usize> {
    v: (f64, f64),
    us: Vec<f64>,
    /// Chebyshev terms by v of the integrals from the first of the cells' ends to each; none where a few terms do not tell them.
    running: Vec<[[f64; RUNNING]; N]>,
}

/// A cell that is not done: its ends, what the coarse rule makes of it at each node where that is known, and how often it was halved.
type OpenCell<const N: usize> = ((f64, f64), Option<[Sized<N>; RUNNING]>, u32);

/// What is known of a strip at its nodes.
struct Rows<const N: usize> {
    us: Vec<f64>,
    /// Integrals over each cell at each node.
    cells: Vec<[Sums<N>; RUNNING]>,
    /// The largest sum of sizes of a row.
    most: Sums<N>,
    /// The largest difference of the rules that is left.
    open: Sums<N>,
}

impl<const N: usize> Strips<N> {
    /// Strips between ascending values of v, in each of them cells between ascending values of u, ends included. Cells are cut further
    /// where the rules differ, strips where the table of a few terms would not tell the integrals.
    pub fn new((us, vs): (&[f64], &[f64]), rules: Rules, tabled: bool, value: &impl Fn(f64, f64) -> Sized<N>) -> Self {
        let mut found = Self { strips: Vec::with_capacity(vs.len()), error: [0.0; N] };
        let mut open: Vec<((f64, f64), u32)> = vs.windows(2).rev().map(|w| ((w[0], w[1]), 0)).collect();
        let mut halvings = 0;
        while let Some((v, depth)) = open.pop() {
            let rows = Rows::new(us, v, rules, value);
            let running = if tabled { rows.running() } else { Vec::new() };
            let told = is_told(&running, rules.accuracy, &rows.most);
            if !told && depth < HALVINGS.0 && halvings < HALVINGS.1 {
                halvings += 1;
                let middle = 0.5 * (v.0 + v.1);
                open.extend([((middle, v.1), depth + 1), ((v.0, middle), depth + 1)]);
                continue;
            }
            add(&mut found.error, &rows.open.map(|open| 2.0 * open * (v.1 - v.0)));
            found.strips.push(Strip { v, us: rows.us, running: if told { running } else { Vec::new() } });
        }
        found
    }

    /// The same as they are given, without a table.
    pub fn plain((us, vs): (&[f64], &[f64])) -> Self {
        let strip = |w: &[f64]| Strip { v: (w[0], w[1]), us: us.to_vec(), running: Vec::new() };
        Self { strips: vs.windows(2).map(strip).collect(), error: [0.0; N] }
    }

    /// What integrals over a surface are off by at most because rows are, by the estimates of the rules.
    pub fn error(&self) -> Sums<N> {
        self.error
    }

    /// The integral along u from a value that all strips are cut at to a place, `part` giving that from a value of u to another
    /// between which nothing is cut.
    pub fn from(&self, base: f64, at: DVec2, part: impl Fn(f64, f64) -> Sums<N>) -> Sums<N> {
        let k = self.strips.partition_point(|strip| strip.v.1 <= at.y).min(self.strips.len() - 1);
        let Strip { v, us, running } = &self.strips[k];
        let (first, last) = (nearest(us, base), nearest(us, at.x));
        let mut sum = part(us[last], at.x);
        if running.is_empty() || !(v.0..=v.1).contains(&at.y) {
            let (low, high) = (first.min(last), first.max(last));
            for w in us[low..=high].windows(2) {
                let (a, b) = if first < last { (w[0], w[1]) } else { (w[1], w[0]) };
                add(&mut sum, &part(a, b));
            }
        } else if first != last {
            let x = (2.0 * at.y - v.0 - v.1) / (v.1 - v.0);
            let whole = |i: usize, n: usize| chebyshev(&running[i][n], x).0;
            (0..N).for_each(|n| sum[n] += whole(last, n) - whole(first, n));
        }
        sum
    }
}

/// The place in an ascending list of the value nearest to one.
fn nearest(us: &[f64], u: f64) -> usize {
    let after = us.partition_point(|x| *x < u).clamp(1, us.len() - 1);
    if u - us[after - 1] < us[after] - u { after - 1 } else { after }
}

impl<const N: usize> Rows<N> {
    fn new(us: &[f64], v: (f64, f64), rules: Rules, value: &impl Fn(f64, f64) -> Sized<N>) -> Self {
        let places: [f64; RUNNING] = std::array::from_fn(|m| 0.5 * (v.0 + v.1) + 0.5 * (v.1 - v.0) * node(m));
        let coarse = |cell: (f64, f64)| places.map(|v| by_rule(cell, rules.coarse, &|u| value(u, v)));
        let first: Vec<[Sized<N>; RUNNING]> = us.windows(2).map(|w| coarse((w[0], w[1]))).collect();
        let mut most = [0.0_f64; N];
        for m in 0..RUNNING {
            let row = first.iter().fold([0.0; N], |sum: Sums<N>, cell| std::array::from_fn(|n| sum[n] + cell[m].1[n]));
            most = std::array::from_fn(|n| most[n].max(row[n]));
        }
        let limit = most.map(|most| rules.accuracy * most / first.len() as f64);
        let mut found = Self { us: vec![us[0]], cells: Vec::with_capacity(us.len()), most, open: [0.0; N] };
        let mut open: Vec<OpenCell<N>> = us.windows(2).zip(first).map(|(w, known)| ((w[0], w[1]), Some(known), 0)).rev().collect();
        let mut halvings = 0;
        while let Some((cell, known, depth)) = open.pop() {
            job::poll();
            let fine = places.map(|v| by_rule(cell, rules.fine, &|u| (value(u, v).0, [0.0; N])).0);
            let known = known.unwrap_or_else(|| coarse(cell));
            let apart: Sums<N> = std::array::from_fn(|n| (0..RUNNING).map(|m| (fine[m][n] - known[m].0[n]).abs()).fold(0.0, f64::max));
            let middle = 0.5 * (cell.0 + cell.1);
            if !small(&apart, &limit) && depth < CELL_HALVINGS.0 && halvings < CELL_HALVINGS.1 && cell.0 < middle && middle < cell.1 {
                halvings += 1;
                open.extend([((middle, cell.1), None, depth + 1), ((cell.0, middle), None, depth + 1)]);
            } else {
                add(&mut found.open, &apart);
                found.us.push(cell.1);
                found.cells.push(fine);
            }
        }
        found
    }

    /// Chebyshev terms by v of the integrals up to each end of a cell.
    fn running(&self) -> Vec<[[f64; RUNNING]; N]> {
        let mut sums = [[0.0; N]; RUNNING];
        let mut out = vec![[[0.0; RUNNING]; N]];
        for cell in &self.cells {
            sums.iter_mut().zip(cell).for_each(|(sum, own)| add(sum, own));
            out.push(std::array::from_fn(|n| terms(&|m| sums[m][n])));
        }
        out
    }
}

/// Whether the last terms are nothing beside the largest row.
fn is_told<const N: usize>(running: &[[[f64; RUNNING]; N]], accuracy: f64, most: &Sums<N>) -> bool {
    running.iter().all(|at| (0..N).all(|n| at[n][RUNNING - 1].abs() + at[n][RUNNING - 2].abs() <= accuracy * most[n]))
}

/// A rule over an interval, of values and of their sizes.
fn by_rule<const N: usize>(cell: (f64, f64), rule: &[(f64, f64)], value: &impl Fn(f64) -> Sized<N>) -> Sized<N> {
    let (middle, half) = (0.5 * (cell.0 + cell.1), 0.5 * (cell.1 - cell.0));
    let mut sum = ([0.0; N], [0.0; N]);
    for (x, w) in rule {
        let (value, size) = value(middle + half * x);
        (0..N).for_each(|n| {
            sum.0[n] += half * w * value[n];
            sum.1[n] += half * w * size[n];
        });
    }
    sum
}

/// Places at which terms are found.
fn node(m: usize) -> f64 {
    math::cos(PI * (m as f64 + 0.5) / RUNNING as f64)
}

/// Chebyshev terms of a function known at the nodes.
fn terms(at: &impl Fn(usize) -> f64) -> [f64; RUNNING] {
    std::array::from_fn(|k| {
        let wave = |m: usize| math::cos(PI * k as f64 * (m as f64 + 0.5) / RUNNING as f64);
        let sum: f64 = (0..RUNNING).map(|m| at(m) * wave(m)).sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / RUNNING as f64
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::quadrature::gauss_legendre;

    fn strips(cuts: &[f64], value: &impl Fn(f64, f64) -> f64) -> Strips<1> {
        let (coarse, fine) = (gauss_legendre(8), gauss_legendre(12));
        let value = |u: f64, v: f64| ([value(u, v)], [value(u, v).abs()]);
        Strips::new((cuts, cuts), Rules { coarse: &coarse, fine: &fine, accuracy: 1e-11 }, true, &value)
    }

    /// ∫ from 0 to u of (2 + u) e^v, which has breaks nowhere and is cut all the same.
    #[test]
    fn whole_cells_and_the_rest_make_the_integral() {
        let cuts = [0.0, 0.25, 0.5, 0.75, 1.0];
        let table = strips(&cuts, &|u, v| (2.0 + u) * math::exp(v));
        let truth = |u: f64, v: f64| (2.0 * u + 0.5 * u * u) * math::exp(v);
        let part = |v: f64| move |a: f64, b: f64| [truth(b, v) - truth(a, v)];
        for base in cuts {
            for (u, v) in [(0.0, 0.0), (0.1, 0.26), (0.5, 0.5), (0.87, 0.99), (1.0, 1.0)] {
                let found = table.from(base, DVec2::new(u, v), part(v))[0];
                let wanted = truth(u, v) - truth(base, v);
                assert!((found - wanted).abs() < 1e-13, "{base} {u} {v}: {found} {wanted}");
            }
        }
    }

    /// The length of an ellipse of axes 1 : 20, which a rule of twelve points over a quarter misses by a hundredth.
    #[test]
    fn cells_are_halved_where_rules_do_not_agree() {
        let angle = |u: f64| 0.5 * PI * u;
        let speed = |u: f64, _: f64| 0.5 * PI * math::hypot(math::cos(angle(u)), 20.0 * math::sin(angle(u)));
        let table = strips(&[0.0, 1.0], &speed);
        let rule = gauss_legendre(12);
        let part = |a: f64, b: f64| by_rule((a, b), &rule, &|u| ([speed(u, 0.0)], [0.0])).0;
        // 20 E(1 − 1/400), by the arithmetic-geometric mean.
        let found = table.from(0.0, DVec2::new(1.0, 0.3), part)[0];
        assert!((found - 20.097_128_095_729_81).abs() < 1e-9, "{found}");
        assert!(table.error()[0] < 1e-8);
    }

    /// A kink inside a strip is told by a few terms nowhere near it, and directly there.
    #[test]
    fn what_terms_do_not_tell_is_integrated_anew() {
        let value = |_: f64, v: f64| (v - 0.6).abs();
        let table = strips(&[0.0, 0.5, 1.0], &value);
        for v in [0.1, 0.598, 0.6, 0.603, 0.9] {
            let found = table.from(0.0, DVec2::new(0.7, v), |a, b| [(b - a) * value(0.0, v)])[0];
            assert!((found - 0.7 * value(0.0, v)).abs() < 1e-10, "{v}: {found}");
        }
    }
}
