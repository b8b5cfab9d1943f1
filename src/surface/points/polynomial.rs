//! Polynomial patches in powers: r(u, v) = Σ a_ij uⁱ vʲ in each coordinate [Yoo & Yoon 2000].

use glam::DVec3;

use crate::base::fault::{Result, ValueFault};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::shapes::bounds::binomial;
use crate::surface::core::surface::Surface;
use crate::surface::points::control_net::{self, Net};

/// The patch with these coefficients as a Bézier surface, the same but for rounding: `a[i][j]` belongs to uⁱ vʲ.
///
/// b_i = Σ_{k≤i} C(i, k) / C(n, k) a_k in both directions. E306 for rows of different length, no row or a degree above 25.
pub fn polynomial(a: &[Vec<DVec3>], origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    control_net::bezier(&Net { rows: &polynomial_net(a)?, weights: None }, origin, tolerance)
}

/// The control points of [`polynomial`], model units; fails as it does.
pub fn polynomial_net(a: &[Vec<DVec3>]) -> Result<Vec<Vec<DVec3>>> {
    let (n, m) = (a.len(), a.first().map_or(0, Vec::len));
    let fault = |found: String, range: &str| ValueFault::OutsideRange { argument: "x", found, range: range.to_owned() };
    if let Some(row) = a.iter().find(|row| row.len() != m) {
        return Err(fault(format!("a row of {} beside one of {m}", row.len()), "rows of one length").into());
    }
    if n < 2 || m < 2 {
        return Err(fault(format!("{n} × {m} coefficients"), "at least 2 × 2").into());
    }
    let along_u = bernstein(a);
    let turned: Vec<Vec<DVec3>> = (0..m).map(|j| along_u.iter().map(|row| row[j]).collect()).collect();
    Ok(bernstein(&turned))
}

/// Bézier rows of rows of coefficients of ascending powers.
fn bernstein(a: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
    let n = a.len() - 1;
    let row = |i: usize| {
        let at = |j: usize| (0..=i).map(|k| a[k][j] * (binomial(i, k) / binomial(n, k))).sum();
        (0..a[0].len()).map(at).collect()
    };
    (0..=n).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::powi;

    #[test]
    fn powers_become_the_known_control_points() {
        let column = |of: [f64; 4]| of.map(|x| vec![DVec3::splat(x)]).to_vec();
        let third = 1.0 / 3.0;
        for (power, wanted) in [
            ([1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0]),
            ([0.0, 1.0, 0.0, 0.0], [0.0, third, 2.0 * third, 1.0]),
            ([0.0, 0.0, 1.0, 0.0], [0.0, 0.0, third, 1.0]),
            ([0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]),
        ] {
            let found = bernstein(&column(power));
            assert!(found.iter().zip(wanted).all(|(b, w)| (b[0].x - w).abs() < 1e-15), "{power:?}: {found:?}");
        }
    }

    /// Orders that differ, all coefficients at work: value and derivatives against the sums themselves.
    #[test]
    fn the_surface_is_the_polynomial() {
        for (n, m) in [(2, 2), (4, 3), (3, 6), (10, 10)] {
            let coefficient = |i: usize, j: usize, c: usize| (((7 * i + 3 * j + 5 * c) % 11) as f64 - 5.0) / 8.0;
            let a: Vec<Vec<DVec3>> =
                (0..n).map(|i| (0..m).map(|j| DVec3::from_array([0, 1, 2].map(|c| coefficient(i, j, c)))).collect()).collect();
            let surface = polynomial(&a, Origin::NONE, &Tolerance::new(1e-9, 10.0)).unwrap();
            let power = |x: f64, k: usize| powi(x, k as i32);
            let slope = |x: f64, k: usize| if k == 0 { 0.0 } else { k as f64 * powi(x, k as i32 - 1) };
            for k in 0..=40 {
                let (u, v) = (f64::from(k) / 40.0, f64::from(k * 7 % 41) / 40.0);
                let sum = |x: &dyn Fn(f64, usize) -> f64, y: &dyn Fn(f64, usize) -> f64| {
                    (0..n).flat_map(|i| (0..m).map(move |j| (i, j))).map(|(i, j)| a[i][j] * (x(u, i) * y(v, j))).sum::<DVec3>()
                };
                let (jet, size) = (surface.jet(u, v), (n * m) as f64);
                assert!(jet.p.distance(sum(&power, &power)) <= 1e-14 * size, "{n} {m} {u} {v}");
                assert!(jet.du.distance(sum(&slope, &power)) <= 1e-13 * size, "{n} {m} {u} {v}");
                assert!(jet.dv.distance(sum(&power, &slope)) <= 1e-13 * size, "{n} {m} {u} {v}");
            }
        }
    }
}
