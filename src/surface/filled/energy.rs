//! The bending of a field over a hole, as a sum of squares.

use glam::DVec2;

use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::surface::filled::chebyshev::Basis;
use crate::surface::filled::householder::factor;
use crate::surface::filled::patch::{EdgePlace, Kite};
use crate::surface::filled::ribbon::Ribbons;

/// Weights of the squares of second and third derivatives.
#[derive(Clone, Copy, Debug)]
pub struct EnergyWeights {
    pub second: f64,
    pub third: f64,
}

/// Places of quadrature with their weights, over all kites of a hole.
pub fn quadrature(ribbons: &Ribbons, kites: &[Kite], points: usize) -> Vec<(DVec2, f64)> {
    let rule = gauss_legendre(points);
    // The rule is over −1…1.
    let rule: Vec<(f64, f64)> = rule.into_iter().map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w)).collect();
    let mut out = Vec::new();
    for kite in kites {
        let [bottom, left] = [kite.bottom, kite.left].map(|half| rule.iter().map(|(t, _)| half.flat(ribbons, *t)).collect::<Vec<EdgePlace>>());
        for (a, (_, wa)) in bottom.iter().zip(&rule) {
            for (b, (_, wb)) in left.iter().zip(&rule) {
                let [place, du, dv] = kite.map(a, b);
                out.push((place, du.perp_dot(dv).abs() * wa * wb));
            }
        }
    }
    out
}

/// Rows whose squares add up to the bending of a field with given coefficients.
pub fn bending(basis: &Basis, places: &[(DVec2, f64)], weights: &EnergyWeights) -> Vec<Vec<f64>> {
    let n = basis.len();
    let mut matrix = vec![0.0; n * n];
    const TERMS: [(usize, usize, f64); 7] =
        [(2, 0, 1.0), (1, 1, 2.0), (0, 2, 1.0), (3, 0, 1.0), (2, 1, 3.0), (1, 2, 3.0), (0, 3, 1.0)];
    for (place, area) in places {
        job::poll();
        let values = basis.at(*place);
        for (a, b, times) in TERMS {
            let weight = area * times * if a + b == 2 { weights.second } else { weights.third };
            if weight == 0.0 {
                continue;
            }
            let row = values.derivative(a, b);
            for (k, x) in row.iter().enumerate() {
                let factor = x * weight;
                if factor != 0.0 {
                    matrix[k * n + k..(k + 1) * n].iter_mut().zip(&row[k..]).for_each(|(sum, y)| *sum += factor * y);
                }
            }
        }
    }
    factor(&matrix, n)
}
