//! Rational B-spline curves: evaluation by de Boor's algorithm on the stack.

use glam::{DVec3, DVec4};

use super::curve::Jet;
use super::motion::Motion;
use crate::base::bbox::Box3;

/// Highest degree; evaluation works on arrays of this size.
pub const MAX_DEGREE: usize = 9;

/// C(t) = Σ wᵢ Pᵢ Nᵢ(t) / Σ wᵢ Nᵢ(t).
#[derive(Clone, Debug, PartialEq)]
pub struct Nurbs {
    /// Degree, 1…9.
    pub degree: usize,
    /// Knots, not decreasing, `poles.len() + degree + 1` of them.
    pub knots: Vec<f64>,
    /// Poles in homogeneous form (wx, wy, wz, w).
    pub poles: Vec<DVec4>,
    /// Whether all weights are equal.
    pub polynomial: bool,
}

/// The pole `p` with weight `w` in homogeneous form.
pub fn weighted(p: DVec3, w: f64) -> DVec4 {
    (p * w).extend(w)
}

/// The point that a homogeneous pole stands for.
pub fn projected(q: DVec4) -> DVec3 {
    q.truncate() / q.w
}

impl Nurbs {
    /// From homogeneous poles; the caller keeps the counts and the order of knots.
    pub fn new(degree: usize, knots: Vec<f64>, poles: Vec<DVec4>) -> Self {
        let polynomial = poles.windows(2).all(|q| q[0].w == q[1].w);
        Self { degree, knots, poles, polynomial }
    }

    /// The straight segment.
    pub fn line(a: DVec3, b: DVec3) -> Self {
        Self { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], poles: vec![a.extend(1.0), b.extend(1.0)], polynomial: true }
    }

    /// One Bézier piece over `t0…t1`.
    pub fn bezier(t0: f64, t1: f64, poles: Vec<DVec4>) -> Self {
        let degree = poles.len() - 1;
        let knots = [vec![t0; degree + 1], vec![t1; degree + 1]].concat();
        Self::new(degree, knots, poles)
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.poles.len()])
    }

    /// Pole `i` as a point.
    pub fn pole(&self, i: usize) -> DVec3 {
        projected(self.poles[i])
    }

    /// Index k of the non-empty span with x_k ≤ t < x_{k+1}; parameters outside the domain go to its ends.
    pub fn span(&self, t: f64) -> usize {
        let (first, last) = (self.degree, self.poles.len() - 1);
        let inner = &self.knots[first + 1..=last];
        let mut k = first + inner.partition_point(|x| *x <= t);
        // At the end of the domain, and beyond, the last span that is not empty.
        while k > first && self.knots[k] == self.knots[k + 1] {
            k -= 1;
        }
        k
    }

    /// Index k of the non-empty span with x_k < t ≤ x_{k+1}: the one before a knot.
    pub fn span_before(&self, t: f64) -> usize {
        let (first, last) = (self.degree, self.poles.len() - 1);
        let inner = &self.knots[first + 1..=last];
        let mut k = first + inner.partition_point(|x| *x < t);
        while k < last && self.knots[k] == self.knots[k + 1] {
            k += 1;
        }
        k
    }

    /// Point and derivatives; at a knot those of the span that follows, at the last one of the span before.
    pub fn jet(&self, t: f64) -> Jet {
        self.jet_in(self.span(t), t)
    }

    /// Point and derivatives of the polynomial piece of span `k`, also outside it.
    pub fn jet_in(&self, k: usize, t: f64) -> Jet {
        let [a, d1, d2, _] = self.homogeneous::<2>(k, t);
        if self.polynomial {
            let w = 1.0 / a.w;
            return Jet { p: a.truncate() * w, d1: d1.truncate() * w, d2: d2.truncate() * w };
        }
        let w = 1.0 / a.w;
        let p = a.truncate() * w;
        let v = (d1.truncate() - p * d1.w) * w;
        Jet { p, d1: v, d2: (d2.truncate() - v * (2.0 * d1.w) - p * d2.w) * w }
    }

    /// Third derivative of the span that follows `t`.
    pub fn third(&self, t: f64) -> DVec3 {
        let k = self.span(t);
        let [a, d1, d2, d3] = self.homogeneous::<3>(k, t);
        let Jet { p, d1: v1, d2: v2 } = self.jet_in(k, t);
        (d3.truncate() - v2 * (3.0 * d1.w) - v1 * (3.0 * d2.w) - p * d3.w) / a.w
    }

    /// Value and derivatives up to order `N` ≤ 3 of the homogeneous curve.
    ///
    /// De Boor's scheme is run to N levels before its end; the N + 1 points left are values of the blossom, whose
    /// divided differences are the derivatives.
    fn homogeneous<const N: usize>(&self, k: usize, t: f64) -> [DVec4; 4] {
        let p = self.degree;
        let x = &self.knots[k + 1 - p..=k + p];
        let mut d = [DVec4::ZERO; MAX_DEGREE + 1];
        d[..=p].copy_from_slice(&self.poles[k - p..=k]);
        // Level r combines points j-1 and j over the knots x[j-1]…x[j+p-r] (counted in the local window).
        let order = N.min(p);
        for r in 1..=p - order {
            for j in (r..=p).rev() {
                let (low, high) = (x[j - 1], x[j + p - r]);
                let a = (t - low) / (high - low);
                d[j] = d[j - 1] * (1.0 - a) + d[j] * a;
            }
        }
        let mut out = [DVec4::ZERO; 4];
        let mut factor = 1.0;
        // `q` holds the derivative of the order reached so far at the last levels.
        let base = p - order;
        let mut q = [DVec4::ZERO; 4];
        q[..=order].copy_from_slice(&d[base..=p]);
        let mut values = q;
        for r in base + 1..=p {
            // Differences first (they need the old points), from the highest order down.
            let level = r - base;
            for j in (level..=order).rev() {
                let i = base + j;
                let (low, high) = (x[i - 1], x[i + p - r]);
                let a = (t - low) / (high - low);
                values[j] = values[j - 1] * (1.0 - a) + values[j] * a;
            }
        }
        out[0] = values[order];
        // Derivative of order n: n differences over the levels p-n+1…p after p-n blends.
        for n in 1..=order {
            factor *= (p + 1 - n) as f64;
            let mut e = q;
            for r in base + 1..=p {
                let blend = r <= p - n;
                for j in (r - base..=order).rev() {
                    let i = base + j;
                    let (low, high) = (x[i - 1], x[i + p - r]);
                    e[j] = if blend {
                        let a = (t - low) / (high - low);
                        e[j - 1] * (1.0 - a) + e[j] * a
                    } else {
                        (e[j] - e[j - 1]) / (high - low)
                    };
                }
            }
            out[n] = e[order] * factor;
        }
        out
    }

    /// The symmetric multi-affine form (blossom) of span `k`'s piece at `degree` arguments.
    pub fn blossom(&self, k: usize, arguments: &[f64]) -> DVec4 {
        let p = self.degree;
        let mut d = [DVec4::ZERO; MAX_DEGREE + 1];
        d[..=p].copy_from_slice(&self.poles[k - p..=k]);
        for (r, t) in (1..=p).zip(arguments) {
            for j in (r..=p).rev() {
                let i = k - p + j;
                let (low, high) = (self.knots[i], self.knots[i + p + 1 - r]);
                let a = (t - low) / (high - low);
                d[j] = d[j - 1] * (1.0 - a) + d[j] * a;
            }
        }
        d[p]
    }

    /// Distinct knots of the domain, ends included, with their multiplicity.
    pub fn breaks(&self) -> Vec<(f64, usize)> {
        let (a, b) = self.domain();
        let mut breaks: Vec<(f64, usize)> = Vec::new();
        for &x in self.knots.iter().filter(|x| (a..=b).contains(*x)) {
            match breaks.last_mut() {
                Some((last, times)) if *last == x => *times += 1,
                _ => breaks.push((x, 1)),
            }
        }
        breaks
    }

    /// Box of the poles; with positive weights it holds the curve.
    pub fn bbox(&self) -> Box3 {
        Box3::of((0..self.poles.len()).map(|i| self.pole(i)))
    }

    /// The run backwards over the same domain.
    pub fn reversed(&self) -> Self {
        let (a, b) = self.domain();
        Self {
            degree: self.degree,
            knots: self
                .knots
                .iter()
                .rev()
                .map(|x| {
                    if *x == a {
                        b
                    } else if *x == b {
                        a
                    } else {
                        a + (b - x)
                    }
                })
                .collect(),
            poles: self.poles.iter().rev().copied().collect(),
            polynomial: self.polynomial,
        }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let poles = self.poles.iter().map(|q| (motion.vector(q.truncate()) + motion.point(DVec3::ZERO) * q.w).extend(q.w)).collect();
        Self { poles, knots: self.knots.clone(), ..*self }
    }
}
