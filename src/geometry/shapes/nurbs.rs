//! Rational B-spline curves: evaluation by de Boor's algorithm on the stack.

use glam::{DVec3, DVec4};

use crate::base::bbox::Box3;
use crate::base::solve::Linear;
use crate::geometry::data::jet::Jet;
use crate::geometry::data::motion::Motion;

/// Highest degree.
pub const MAX_DEGREE: usize = 25;
/// Up to this degree evaluation works on small arrays: most curves and surfaces are below it.
pub const COMMON_DEGREE: usize = 9;

/// C(t) = Σ wᵢ Pᵢ Nᵢ(t) / Σ wᵢ Nᵢ(t).
#[derive(Clone, Debug, PartialEq)]
pub struct Nurbs {
    /// Degree, 1…25.
    pub degree: usize,
    /// Knots, not decreasing, `poles.len() + degree + 1` of them.
    pub knots: Vec<f64>,
    /// Poles in homogeneous form (wx, wy, wz, w).
    pub poles: Vec<DVec4>,
    /// Whether all weights are equal.
    pub polynomial: bool,
}

crate::content!(Nurbs { degree, knots, poles, polynomial });

/// The pole `p` with weight `w` in homogeneous form.
pub fn weighted(p: DVec3, w: f64) -> DVec4 {
    (p * w).extend(w)
}

/// The point that a homogeneous pole stands for.
pub fn projected(q: DVec4) -> DVec3 {
    q.truncate() / q.w
}

#[inline]
fn mix<V: Linear>(a: V, b: V, share: f64) -> V {
    a * (1.0 - share) + b * share
}

/// De Boor's scheme over the 2p knots `x` around the span, with value and first two derivatives at its end.
///
/// Level r combines neighbours j − 1 and j over the knots x[j-1]…x[j+p-r]. The last three and two points are values
/// of the blossom, and their divided differences are the derivatives.
#[inline(always)]
fn de_boor<V: Linear>(d: &mut [V], x: &[f64], t: f64) -> [V; 3] {
    let p = d.len() - 1;
    let last = 1.0 / (x[p] - x[p - 1]);
    let end = (t - x[p - 1]) * last;
    // Knots do not decrease: where these are equal, so are all on either side of the span.
    let bezier = x[0] == x[p - 1] && x[p] == x[2 * p - 1];
    // Divided as the others are: `end` may differ in the last bit.
    let even = (t - x[p - 1]) / (x[p] - x[p - 1]);
    for r in 1..p.saturating_sub(1) {
        for j in (r..=p).rev() {
            let (low, high) = (x[j - 1], x[j + p - r]);
            d[j] = mix(d[j - 1], d[j], if bezier { even } else { (t - low) / (high - low) });
        }
    }
    if p == 1 {
        let slope = d[1] - d[0];
        return [mix(d[0], d[1], end), slope * last, slope * 0.0];
    }
    let (before, after) = if bezier { (last, last) } else { (1.0 / (x[p] - x[p - 2]), 1.0 / (x[p + 1] - x[p - 1])) };
    let (first, second) = ((d[p - 1] - d[p - 2]) * before, (d[p] - d[p - 1]) * after);
    let (a, b) = (d[p - 2] + first * (t - x[p - 2]), d[p - 1] + second * (t - x[p - 1]));
    let degree = p as f64;
    [mix(a, b, end), (b - a) * (last * degree), (second - first) * (last * degree * (degree - 1.0))]
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
        if first == last {
            return first;
        }
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
        // The commonest degrees have loops of fixed length.
        match self.degree {
            2 => self.jet_on::<3>(2, k, t),
            3 => self.jet_on::<4>(3, k, t),
            p if p <= COMMON_DEGREE => self.jet_on::<{ COMMON_DEGREE + 1 }>(p, k, t),
            p => self.jet_on::<{ MAX_DEGREE + 1 }>(p, k, t),
        }
    }

    /// The same by arrays of N poles, more than the degree p.
    #[inline(always)]
    fn jet_on<const N: usize>(&self, p: usize, k: usize, t: f64) -> Jet {
        let (poles, x) = (&self.poles[k - p..=k], &self.knots[k + 1 - p..=k + p]);
        if self.polynomial {
            let w = 1.0 / poles[0].w;
            let mut d = [DVec3::ZERO; N];
            for (d, q) in d.iter_mut().zip(poles) {
                *d = q.truncate();
            }
            let [p, d1, d2] = de_boor(&mut d[..=p], x, t);
            return if w == 1.0 { Jet { p, d1, d2 } } else { Jet { p: p * w, d1: d1 * w, d2: d2 * w } };
        }
        let mut d = [DVec4::ZERO; N];
        d[..=p].copy_from_slice(poles);
        let [a, d1, d2] = de_boor(&mut d[..=p], x, t);
        let w = 1.0 / a.w;
        let p = a.truncate() * w;
        let v = (d1.truncate() - p * d1.w) * w;
        Jet { p, d1: v, d2: (d2.truncate() - v * (2.0 * d1.w) - p * d2.w) * w }
    }

    /// Third derivative of the span that follows `t`.
    pub fn third(&self, t: f64) -> DVec3 {
        let k = self.span(t);
        let Jet { p, d1: v1, d2: v2 } = self.jet_in(k, t);
        let [w1, w2, a3] = [1, 2, 3].map(|order| self.homogeneous_derivative(k, t, order));
        (a3.truncate() - v2 * (3.0 * w1.w) - v1 * (3.0 * w2.w) - p * a3.w) / self.homogeneous_derivative(k, t, 0).w
    }

    /// Derivative of the homogeneous curve: a blossom with differences in the last `order` levels of de Boor's scheme.
    fn homogeneous_derivative(&self, k: usize, t: f64, order: usize) -> DVec4 {
        let p = self.degree;
        if order > p {
            return DVec4::ZERO;
        }
        let mut d = [DVec4::ZERO; MAX_DEGREE + 1];
        d[..=p].copy_from_slice(&self.poles[k - p..=k]);
        let mut factor = 1.0;
        for r in 1..=p {
            if r > p - order {
                factor *= (2 * p + 1 - order - r) as f64;
            }
            for j in (r..=p).rev() {
                let (low, high) = (self.knots[k - p + j], self.knots[k + 1 + j - r]);
                d[j] = if r > p - order { (d[j] - d[j - 1]) / (high - low) } else { mix(d[j - 1], d[j], (t - low) / (high - low)) };
            }
        }
        d[p] * factor
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
