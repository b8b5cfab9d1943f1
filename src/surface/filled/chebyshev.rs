//! Polynomials of two variables up to a total degree, as products of Chebyshev polynomials over a rectangle.

use glam::DVec2;

/// The basis of polynomials of two variables.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    middle: DVec2,
    half: DVec2,
    degree: usize,
}

/// Values of one variable: the functions and three derivatives.
type Line = Vec<[f64; 4]>;

fn line(degree: usize, x: f64, rate: f64) -> Line {
    let mut out: Line = vec![[1.0, 0.0, 0.0, 0.0], [x, 1.0, 0.0, 0.0]];
    for k in 2..=degree {
        let (a, b) = (out[k - 1], out[k - 2]);
        out.push(std::array::from_fn(|d| {
            let lower = if d == 0 { 0.0 } else { 2.0 * d as f64 * a[d - 1] };
            2.0 * x * a[d] + lower - b[d]
        }));
    }
    for f in &mut out {
        let mut power = 1.0;
        for d in &mut f[1..] {
            power *= rate;
            *d *= power;
        }
    }
    out
}

impl Basis {
    /// Over the box of some places, a little wider.
    pub fn over(places: &[DVec2], degree: usize) -> Self {
        const WIDER: f64 = 1.02;
        let low = places.iter().fold(DVec2::INFINITY, |a, p| a.min(*p));
        let high = places.iter().fold(DVec2::NEG_INFINITY, |a, p| a.max(*p));
        Self { middle: 0.5 * (low + high), half: 0.5 * WIDER * (high - low), degree }
    }

    /// How many functions.
    pub fn len(&self) -> usize {
        (self.degree + 1) * (self.degree + 2) / 2
    }

    /// Its values at a place.
    pub fn at(&self, place: DVec2) -> Values {
        let q = (place - self.middle) / self.half;
        let (x, y) = (line(self.degree, q.x, 1.0 / self.half.x), line(self.degree, q.y, 1.0 / self.half.y));
        Values { x, y, degree: self.degree }
    }
}

/// All functions of a basis at one place.
#[derive(Clone, Debug)]
pub struct Values {
    x: Line,
    y: Line,
    degree: usize,
}

impl Values {
    /// Derivatives of all functions, `a` times by x and `b` times by y, by ascending total degree.
    pub fn derivative(&self, a: usize, b: usize) -> Vec<f64> {
        let of = |total: usize| (0..=total).map(move |j| self.x[total - j][a] * self.y[j][b]);
        (0..=self.degree).flat_map(of).collect()
    }
}
