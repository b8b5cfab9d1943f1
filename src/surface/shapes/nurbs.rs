//! Rational tensor-product B-spline surfaces, evaluated on the stack.

use glam::{DVec3, DVec4};

use crate::base::bbox::Box3;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::geometry::shapes::nurbs::{COMMON_DEGREE, MAX_DEGREE, projected, weighted};
use crate::geometry::{Motion, Nurbs};
use crate::surface::data::breaks::{distinct_inner, tidy};
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;

/// S(u, v) = Σ w_ij P_ij N_i(u) M_j(v) / Σ w_ij N_i(u) M_j(v) over 0 ≤ u, v ≤ 1.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsSurface {
    /// Degree in u and v, 1…9.
    pub degree: (usize, usize),
    /// Knots in u and v, clamped, from 0 to 1.
    pub knots: (Vec<f64>, Vec<f64>),
    /// Homogeneous poles (wx, wy, wz, w), u fastest.
    pub poles: Vec<DVec4>,
    /// Poles along u and along v.
    pub counts: (usize, usize),
}

crate::content!(NurbsSurface { degree, knots, poles, counts });

/// Values and two derivatives of the basis functions that do not vanish on one span.
pub(super) struct Basis<const N: usize> {
    pub first: usize,
    n: usize,
    values: [[f64; 3]; N],
}

/// Functions of one span up to the degree that most surfaces keep to, and up to any.
pub(super) const COMMON: usize = COMMON_DEGREE + 1;
pub(super) const MOST: usize = MAX_DEGREE + 1;

impl<const N: usize> Basis<N> {
    pub fn values(&self) -> &[[f64; 3]] {
        &self.values[..self.n]
    }
}

/// How often a knot stands in a vector of knots, which ascends.
pub(crate) fn multiplicity(knots: &[f64], knot: f64) -> usize {
    knots.partition_point(|k| *k <= knot + EPSILON) - knots.partition_point(|k| *k < knot - EPSILON)
}

/// The basis at a parameter [Piegl & Tiller 1997, A2.2 and eq. 2.9].
pub(super) fn basis<const N: usize>(knots: &[f64], degree: usize, t: f64, side: OneSided) -> Basis<N> {
    let (low, high) = (degree, knots.len() - degree - 2);
    let inner = &knots[low + 1..=high];
    let reached = |k: &f64| if side == OneSided::Before { *k < t - EPSILON } else { *k <= t + EPSILON };
    let span = low + inner.partition_point(reached);
    let mut values = [[0.0; 3]; N];
    let round = &knots[span + 1 - degree..=span + degree];
    // Loops of known length are unrolled.
    match degree {
        1 => fill::<2>(round, t, &mut values),
        2 => fill::<3>(round, t, &mut values),
        3 => fill::<4>(round, t, &mut values),
        4 => fill::<5>(round, t, &mut values),
        5 => fill::<6>(round, t, &mut values),
        6 => fill::<7>(round, t, &mut values),
        7 => fill::<8>(round, t, &mut values),
        8 => fill::<9>(round, t, &mut values),
        9 => fill::<10>(round, t, &mut values),
        _ => fill_to::<MOST>(degree, round, t, &mut values),
    }
    Basis { first: span - degree, n: degree + 1, values }
}

/// The N functions of degree N − 1 with two derivatives, by the 2 (N − 1) knots round the span.
#[inline]
fn fill<const N: usize>(knots: &[f64], t: f64, values: &mut [[f64; 3]]) {
    fill_to::<N>(N - 1, knots, t, values);
}

/// The functions of a degree below N with two derivatives.
#[inline]
fn fill_to<const N: usize>(degree: usize, knots: &[f64], t: f64, values: &mut [[f64; 3]]) {
    let mut rows = [[0.0; N]; N];
    rows[0][0] = 1.0;
    for p in 1..=degree {
        let below = rows[p - 1];
        for (r, &value) in below.iter().enumerate().take(p) {
            // N_{i,p-1} with i = r − p + degree (of these knots) feeds N_{i-1,p} and N_{i,p}.
            let i = degree + r - p;
            let share = value / (knots[i + p] - knots[i]);
            rows[p][r] += (knots[i + p] - t) * share;
            rows[p][r + 1] += (t - knots[i]) * share;
        }
    }
    // Derivatives of degree p from values of degree p − 1.
    let lower = |p: usize, from: &[f64; N]| {
        let mut out = [0.0; N];
        for (r, &value) in from.iter().enumerate().take(p) {
            let i = degree + r - p;
            let share = p as f64 * value / (knots[i + p] - knots[i]);
            out[r] -= share;
            out[r + 1] += share;
        }
        out
    };
    let first = lower(degree, &rows[degree - 1]);
    let second = if degree >= 2 { lower(degree, &lower(degree - 1, &rows[degree - 2])) } else { [0.0; N] };
    for r in 0..=degree {
        values[r] = [rows[degree][r], first[r], second[r]];
    }
}

/// A row of poles by a basis: value, first and second derivative.
fn along<const N: usize>(row: &[DVec4], values: &[[f64; 3]]) -> [DVec4; 3] {
    let mut part = [DVec4::ZERO; 3];
    for (q, x) in row[..N].iter().zip(&values[..N]) {
        for k in 0..3 {
            part[k] += *q * x[k];
        }
    }
    part
}

/// Homogeneous sums: value, ∂u, ∂v, ∂uu, ∂uv, ∂vv.
pub(crate) type Sums = [DVec4; 6];

/// The quotient rule up to order two.
pub(crate) fn quotient(a: &Sums) -> Jet2 {
    let (w, n) = (a.map(|q| q.w), a.map(|q| q.truncate()));
    let p = n[0] / w[0];
    let du = (n[1] - p * w[1]) / w[0];
    let dv = (n[2] - p * w[2]) / w[0];
    Jet2 {
        p,
        du,
        dv,
        duu: (n[3] - du * (2.0 * w[1]) - p * w[3]) / w[0],
        duv: (n[4] - du * w[2] - dv * w[1] - p * w[4]) / w[0],
        dvv: (n[5] - dv * (2.0 * w[2]) - p * w[5]) / w[0],
    }
}

impl NurbsSurface {
    /// Pole (i, j) in homogeneous form.
    pub fn pole(&self, i: usize, j: usize) -> DVec4 {
        self.poles[j * self.counts.0 + i]
    }

    /// Point and derivatives, from the given sides where they jump.
    pub fn jet(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> Jet2 {
        if self.is_common() { self.jet_on::<COMMON>(u, v, side) } else { self.jet_on::<MOST>(u, v, side) }
    }

    /// Whether evaluation keeps to small arrays.
    pub(super) fn is_common(&self) -> bool {
        self.degree.0.max(self.degree.1) <= COMMON_DEGREE
    }

    fn jet_on<const N: usize>(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> Jet2 {
        let a: Basis<N> = basis(&self.knots.0, self.degree.0, u, side.0);
        let b: Basis<N> = basis(&self.knots.1, self.degree.1, v, side.1);
        let mut sums = [DVec4::ZERO; 6];
        for (j, y) in b.values().iter().enumerate() {
            let row = &self.poles[(b.first + j) * self.counts.0 + a.first..][..a.n];
            let part = match a.n {
                2 => along::<2>(row, a.values()),
                3 => along::<3>(row, a.values()),
                4 => along::<4>(row, a.values()),
                _ => row.iter().zip(a.values()).fold([DVec4::ZERO; 3], |sum, (q, x)| [0, 1, 2].map(|k| sum[k] + *q * x[k])),
            };
            add(&mut sums, &part, y);
        }
        quotient(&sums)
    }

    /// The line of constant u (`at_u`) or v: the net contracted.
    pub fn iso(&self, at_u: bool, at: f64) -> Nurbs {
        let sum = |a: &Basis<MOST>, pole: &dyn Fn(usize) -> DVec4| {
            a.values().iter().enumerate().fold(DVec4::ZERO, |sum, (k, x)| sum + pole(a.first + k) * x[0])
        };
        if at_u {
            let a = basis(&self.knots.0, self.degree.0, at, OneSided::After);
            let poles = (0..self.counts.1).map(|j| sum(&a, &|i| self.pole(i, j))).collect();
            Nurbs::new(self.degree.1, self.knots.1.clone(), poles)
        } else {
            let b = basis(&self.knots.1, self.degree.1, at, OneSided::After);
            let poles = (0..self.counts.0).map(|i| sum(&b, &|j| self.pole(i, j))).collect();
            Nurbs::new(self.degree.0, self.knots.0.clone(), poles)
        }
    }

    /// Distinct knots inside, u and v.
    pub fn breaks(&self) -> (Vec<f64>, Vec<f64>) {
        let inner = |knots: &[f64], degree| tidy(distinct_inner(knots, degree), EPSILON);
        (inner(&self.knots.0, self.degree.0), inner(&self.knots.1, self.degree.1))
    }

    /// The box of the control points: holds the surface (weights are positive).
    pub fn hull(&self) -> Box3 {
        Box3::of(self.poles.iter().map(|q| projected(*q)))
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let poles = self.poles.iter().map(|q| weighted(motion.point(projected(*q)), q.w)).collect();
        Self { poles, ..self.clone() }
    }

    /// Knots at which the direction across them jumps by more than the tolerance's angle somewhere along the line.
    ///
    /// Only knots of multiplicity ≥ degree can; along the line the directions are compared at more places than the
    /// rational functions have free coefficients.
    pub(crate) fn kinks(&self, tolerance: &Tolerance) -> (Vec<f64>, Vec<f64>) {
        let (us, vs) = self.breaks();
        let along = |breaks: &[f64], degree: usize| -> Vec<f64> {
            let stops = [&[0.0], breaks, &[1.0]].concat();
            let n = 4 * degree + 1;
            stops.windows(2).flat_map(|w| (0..=n).map(|k| w[0] + (w[1] - w[0]) * k as f64 / n as f64).collect::<Vec<_>>()).collect()
        };
        let (along_u, along_v) = (along(&us, self.degree.0), along(&vs, self.degree.1));
        let turns = |a: DVec3, b: DVec3| a.length_squared() > 0.0 && b.length_squared() > 0.0 && tolerance.is_kink(a, b);
        let kink_u = us.iter().copied().filter(|&u| {
            multiplicity(&self.knots.0, u) >= self.degree.0
                && along_v.iter().any(|&v| {
                    let slope = |side| self.jet(u, v, (side, OneSided::After)).du;
                    turns(slope(OneSided::Before), slope(OneSided::After))
                })
        });
        let kink_v = vs.iter().copied().filter(|&v| {
            multiplicity(&self.knots.1, v) >= self.degree.1
                && along_u.iter().any(|&u| {
                    let slope = |side| self.jet(u, v, (OneSided::After, side)).dv;
                    turns(slope(OneSided::Before), slope(OneSided::After))
                })
        });
        (kink_u.collect(), kink_v.collect())
    }

    /// The border row or column on side k (v = 0, u = 1, v = 1, u = 0), ascending.
    pub(crate) fn border(&self, k: usize) -> Vec<DVec3> {
        let (nu, nv) = self.counts;
        let at = |i: usize, j: usize| projected(self.pole(i, j));
        match k {
            0 => (0..nu).map(|i| at(i, 0)).collect(),
            1 => (0..nv).map(|j| at(nu - 1, j)).collect(),
            2 => (0..nu).map(|i| at(i, nv - 1)).collect(),
            _ => (0..nv).map(|j| at(0, j)).collect(),
        }
    }
}

fn add(sums: &mut Sums, part: &[DVec4; 3], y: &[f64; 3]) {
    sums[0] += part[0] * y[0];
    sums[1] += part[1] * y[0];
    sums[2] += part[0] * y[1];
    sums[3] += part[2] * y[0];
    sums[4] += part[1] * y[1];
    sums[5] += part[0] * y[2];
}
