//! The bending of a field over a hole, as a sum of squares.

use glam::DVec2;

use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::surface::filled::chebyshev::Basis;
use crate::surface::filled::householder::factor;
use crate::surface::filled::patch::{EdgePlace, Patch};
use crate::surface::filled::ribbon::Ribbons;

/// Places of quadrature with their weights, over all patches of a hole.
pub fn quadrature(ribbons: &Ribbons, patches: &[Patch], points: usize) -> Vec<(DVec2, f64)> {
    let rule = gauss_legendre(points);
    // The rule is over −1…1.
    let rule: Vec<(f64, f64)> = rule.into_iter().map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w)).collect();
    let mut out = Vec::new();
    for patch in patches {
        let bottom: Vec<EdgePlace> = rule.iter().map(|(t, _)| patch.on_bottom(ribbons, *t)).collect();
        let left: Vec<EdgePlace> = rule.iter().map(|(t, _)| patch.on_left(ribbons, *t)).collect();
        for (a, (_, wa)) in bottom.iter().zip(&rule) {
            for (b, (_, wb)) in left.iter().zip(&rule) {
                let [place, du, dv] = patch.map(a, b);
                out.push((place, du.perp_dot(dv).abs() * wa * wb));
            }
        }
    }
    out
}

/// Rows whose squares add up to the integral of the squares of all derivatives of some orders, each with its weight, of a field with given
/// coefficients.
pub fn bending(basis: &Basis, places: &[(DVec2, f64)], weights: &[(usize, f64)]) -> Vec<Vec<f64>> {
    let n = basis.len();
    let mut matrix = vec![0.0; n * n];
    let terms: Vec<(usize, usize, f64)> =
        weights.iter().flat_map(|&(order, weight)| (0..=order).map(move |b| (order - b, b, weight * choose(order, b)))).collect();
    for (place, area) in places {
        job::poll();
        let values = basis.at(*place);
        for (a, b, times) in &terms {
            let (a, b, weight) = (*a, *b, area * times);
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

/// Binomial coefficient.
fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |all, i| all * (n - i) as f64 / (i + 1) as f64)
}
