//! Polynomials of two variables up to a total degree, as products of Chebyshev polynomials over a rectangle.

use glam::{DVec2, DVec3};

/// Largest degree.
pub const MOST: usize = 24;

/// The basis of polynomials of two variables.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    middle: DVec2,
    half: DVec2,
    degree: usize,
}

/// Most derivatives that are taken, and the function itself.
pub const DERIVATIVES: usize = 7;

/// Values of one variable: the functions and their derivatives.
type Line = Vec<[f64; DERIVATIVES]>;

fn line(degree: usize, x: f64, rate: f64) -> Line {
    let mut out: Line = vec![[0.0; DERIVATIVES]; 2];
    (out[0][0], out[1][0], out[1][1]) = (1.0, x, 1.0);
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

    /// The sum of its functions times some coefficients.
    pub fn sum(&self, place: DVec2, coefficients: &[DVec3]) -> DVec3 {
        let q = (place - self.middle) / self.half;
        let mut values = [[0.0; 2]; MOST + 1];
        (values[0], values[1]) = ([1.0; 2], [q.x, q.y]);
        for k in 2..=self.degree {
            values[k] = [0, 1].map(|a| 2.0 * [q.x, q.y][a] * values[k - 1][a] - values[k - 2][a]);
        }
        let (mut sum, mut next) = (DVec3::ZERO, coefficients.iter());
        for total in 0..=self.degree {
            for j in 0..=total {
                let Some(c) = next.next() else { return sum };
                sum += *c * (values[total - j][0] * values[j][1]);
            }
        }
        sum
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
