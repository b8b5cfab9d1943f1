//! Integrals over surfaces that are analytic over triangles of (u, v): each triangle by a rule of its own.

use glam::DVec2;

use super::measure_quadrature::Sums;
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::surface::{Jet2, Surface};

/// Points a direction of the rules compared.
const ORDERS: [usize; 2] = [7, 10];
/// Halvings of both directions at most.
const MAX_DEPTH: u32 = 12;

/// The integral of N functions of the jet over the triangles, with estimated errors: `accuracy` is relative to the sum of absolute
/// values. A triangle whose rules differ is cut in four.
pub fn triangles_integral<const N: usize>(
    surface: &Surface,
    triangles: &[[DVec2; 3]],
    accuracy: f64,
    f: &impl Fn(&Jet2) -> Sums<N>,
) -> (Sums<N>, Sums<N>) {
    let rules = ORDERS.map(gauss_legendre);
    // The square (x, y) ↦ a + x (b − a) + x y (c − b) covers a triangle; its places keep off the sides.
    let over = |[a, b, c]: &[DVec2; 3], rule: &[(f64, f64)]| -> (Sums<N>, Sums<N>) {
        job::poll();
        let twice = (*b - *a).perp_dot(*c - *a).abs();
        let (mut sum, mut size) = ([0.0; N], [0.0; N]);
        for (x, wx) in rule {
            for (y, wy) in rule {
                let (x, y) = (0.5 + 0.5 * x, 0.5 + 0.5 * y);
                let at = *a + (*b - *a) * x + (*c - *b) * (x * y);
                let weight = 0.25 * wx * wy * twice * x;
                for (k, value) in f(&surface.jet(at.x, at.y)).into_iter().enumerate() {
                    sum[k] += weight * value;
                    size[k] += weight * value.abs();
                }
            }
        }
        (sum, size)
    };
    let first: Vec<(Sums<N>, Sums<N>)> = triangles.iter().map(|t| over(t, &rules[0])).collect();
    let scale: Sums<N> = first.iter().fold([0.0; N], |all, own| std::array::from_fn(|k| all[k] + own.1[k]));
    let share = accuracy / triangles.len().max(1) as f64;
    let (mut sum, mut error) = ([0.0; N], [0.0; N]);
    let mut open: Vec<([DVec2; 3], Sums<N>, u32)> = triangles.iter().zip(first).rev().map(|(t, own)| (*t, own.0, 0)).collect();
    while let Some((t, rough, depth)) = open.pop() {
        let fine = over(&t, &rules[1]).0;
        let apart: Sums<N> = std::array::from_fn(|k| (fine[k] - rough[k]).abs());
        if depth == MAX_DEPTH || (0..N).all(|k| apart[k] <= share * scale[k]) {
            (0..N).for_each(|k| {
                sum[k] += fine[k];
                error[k] += apart[k];
            });
            continue;
        }
        let [a, b, c] = t;
        let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        open.extend(parts.map(|part| (part, over(&part, &rules[0]).0, depth + 1)));
    }
    (sum, error)
}
