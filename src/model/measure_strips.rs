//! Integrals along u from a table: a surface of many cells is integrated cell by cell once, not anew from every place of a border.
//!
//! Between two breaks in v the integral over whole cells is an analytic function of v, so that a few Chebyshev terms tell it.

use std::f64::consts::PI;

use glam::DVec2;

use super::measure_quadrature::Sums;
use crate::base::job;
use crate::base::math;
use crate::base::quadrature::{RUNNING, chebyshev};
use crate::base::tolerance::{EPSILON, MEASURE_ACCURACY};

/// Cells along u from which on a table is worth it.
const CELLS: usize = 3;

/// Running integrals of N functions along u, from 0 to each break, over each strip between two breaks in v.
pub struct Strips<const N: usize> {
    us: Vec<f64>,
    vs: Vec<f64>,
    /// Chebyshev terms by v: all breaks in u of a strip follow each other.
    running: Vec<[[f64; RUNNING]; N]>,
}

impl<const N: usize> Strips<N> {
    /// The table of a function of (u, v) with breaks, `rule` being points and weights over −1…1; `None` where it has few cells or
    /// the terms do not tell it to [`MEASURE_ACCURACY`].
    pub fn new((us, vs): (&[f64], &[f64]), rule: &[(f64, f64)], value: &impl Fn(f64, f64) -> Sums<N>) -> Option<Self> {
        let stops = |inner: &[f64]| {
            let inside = inner.iter().copied().filter(|x| *x > EPSILON && *x < 1.0 - EPSILON);
            std::iter::once(0.0).chain(inside).chain([1.0]).collect::<Vec<f64>>()
        };
        let (us, vs) = (stops(us), stops(vs));
        if us.len() <= CELLS {
            return None;
        }
        let mut running = Vec::with_capacity((vs.len() - 1) * us.len());
        for strip in vs.windows(2) {
            job::poll();
            let place = |m: usize| 0.5 * (strip[0] + strip[1]) + 0.5 * (strip[1] - strip[0]) * node(m);
            let rows: Vec<Vec<Sums<N>>> = (0..RUNNING).map(|m| sums_along(&us, rule, &|u| value(u, place(m)))).collect();
            running.extend((0..us.len()).map(|i| std::array::from_fn(|n| terms(&|m| rows[m][i][n]))));
        }
        let table = Self { us, vs, running };
        table.is_true().then_some(table)
    }

    /// Whether the last terms are nothing beside the largest integral of their function.
    fn is_true(&self) -> bool {
        (0..N).all(|n| {
            let terms = || self.running.iter().map(|at| &at[n]);
            let most = terms().flat_map(|c| c.iter()).fold(0.0_f64, |most, c| most.max(c.abs()));
            terms().all(|c| c[RUNNING - 1].abs() + c[RUNNING - 2].abs() <= MEASURE_ACCURACY * most)
        })
    }

    /// The break nearest to a value of u.
    pub fn nearest(&self, u: f64) -> usize {
        let after = self.us.partition_point(|x| *x < u).clamp(1, self.us.len() - 1);
        if u - self.us[after - 1] < self.us[after] - u { after - 1 } else { after }
    }

    /// The integral along u from a break to a place, `part` giving that from a value of u to another.
    pub fn from(&self, base: usize, at: DVec2, part: impl Fn(f64, f64) -> Sums<N>) -> Sums<N> {
        let j = self.vs.partition_point(|v| *v <= at.y).clamp(1, self.vs.len() - 1) - 1;
        let x = (2.0 * at.y - self.vs[j] - self.vs[j + 1]) / (self.vs[j + 1] - self.vs[j]);
        let last = self.nearest(at.x);
        let rest = part(self.us[last], at.x);
        if last == base {
            return rest;
        }
        let whole = |i: usize, n: usize| chebyshev(&self.running[j * self.us.len() + i][n], x).0;
        std::array::from_fn(|n| whole(last, n) - whole(base, n) + rest[n])
    }
}

/// Integrals from the first break to each.
fn sums_along<const N: usize>(us: &[f64], rule: &[(f64, f64)], value: &impl Fn(f64) -> Sums<N>) -> Vec<Sums<N>> {
    let mut sum = [0.0; N];
    let mut sums = vec![sum];
    for cell in us.windows(2) {
        let (middle, half) = (0.5 * (cell[0] + cell[1]), 0.5 * (cell[1] - cell[0]));
        for (x, w) in rule {
            let value = value(middle + half * x);
            (0..N).for_each(|n| sum[n] += half * w * value[n]);
        }
        sums.push(sum);
    }
    sums
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

    /// ∫ from 0 to u of (2 + u) e^v, which has breaks nowhere and is cut all the same.
    #[test]
    fn whole_cells_and_the_rest_make_the_integral() {
        let breaks = [0.25, 0.5, 0.75];
        let value = |u: f64, v: f64| [(2.0 + u) * math::exp(v)];
        let table = Strips::new((&breaks, &breaks), &gauss_legendre(12), &value).unwrap();
        let truth = |u: f64, v: f64| (2.0 * u + 0.5 * u * u) * math::exp(v);
        let part = |v: f64| move |a: f64, b: f64| [truth(b, v) - truth(a, v)];
        for base in 0..5 {
            for (u, v) in [(0.0, 0.0), (0.1, 0.26), (0.5, 0.5), (0.87, 0.99), (1.0, 1.0)] {
                let found = table.from(base, DVec2::new(u, v), part(v))[0];
                let wanted = truth(u, v) - truth(0.25 * base as f64, v);
                assert!((found - wanted).abs() < 1e-13, "{base} {u} {v}: {found} {wanted}");
            }
        }
    }

    /// A kink inside a strip is not told by a few terms.
    #[test]
    fn what_terms_do_not_tell_is_no_table() {
        let value = |_: f64, v: f64| [(v - 0.6).abs()];
        assert!(Strips::new((&[0.25, 0.5], &[0.5]), &gauss_legendre(12), &value).is_none());
    }
}
