//! Integrals over trimmed surfaces that are analytic over triangles of (u, v): whole triangles by their rule, those that a border
//! crosses by cones from their middles to the parts of the border in them and to the parts of their sides that are kept.

use glam::DVec2;

use super::cut_triangles::{Arc, Cut, Straight};
use super::measure_quadrature::Sums;
use super::measure_triangles::triangles_integral;
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::surface::{Jet2, Surface};

/// Points a direction of the rules compared.
const ORDERS: [usize; 2] = [7, 10];
/// Halvings of a part of a border at most.
const MAX_DEPTH: u32 = 14;

/// The integral of N functions of the jet over the kept part, with estimated errors: `accuracy` is relative to the sum of absolute
/// values. `None` where the border could not be followed from triangle to triangle.
pub(super) fn cut_triangles_integral<const N: usize>(
    surface: &Surface,
    accuracy: f64,
    f: &impl Fn(&Jet2) -> Sums<N>,
) -> Option<(Sums<N>, Sums<N>)> {
    let cut = Cut::new(surface)?;
    let rules = ORDERS.map(gauss_legendre);
    let mut sum = ([0.0; N], [0.0; N]);
    let mut add = |(value, error): (Sums<N>, Sums<N>), sign: f64| {
        for k in 0..N {
            sum.0[k] += sign * value[k];
            sum.1[k] += error[k];
        }
    };
    // Straight parts that turn the other way round their middle count the other way.
    let (left, right): (Vec<&Straight>, Vec<&Straight>) = cut.straight.iter().partition(|t| turn(t) >= 0.0);
    add(triangles_integral(surface, &left.into_iter().copied().collect::<Vec<_>>(), accuracy, f), 1.0);
    add(triangles_integral(surface, &right.into_iter().copied().collect::<Vec<_>>(), accuracy, f), -1.0);
    let cone = |arc: &Arc, rule: &[(f64, f64)]| -> (Sums<N>, Sums<N>) {
        job::poll();
        let (mut sum, mut size) = ([0.0; N], [0.0; N]);
        let half = 0.5 * (arc.t.1 - arc.t.0);
        for (t, wt) in rule {
            let (at, way) = cut.border.place(arc.border, 0.5 * (arc.t.0 + arc.t.1) + half * t);
            let area = half * wt * (at - arc.apex).perp_dot(way);
            for (x, wx) in rule {
                let x = 0.5 + 0.5 * x;
                let uv = arc.apex + (at - arc.apex) * x;
                for (k, value) in f(&surface.jet(uv.x, uv.y)).into_iter().enumerate() {
                    let own = 0.5 * wx * area * x * value;
                    sum[k] += own;
                    size[k] += own.abs();
                }
            }
        }
        (sum, size)
    };
    let first: Vec<(Sums<N>, Sums<N>)> = cut.arcs.iter().map(|arc| cone(arc, &rules[0])).collect();
    let mut scale: Sums<N> = sum.0.map(f64::abs);
    first.iter().for_each(|own| (0..N).for_each(|k| scale[k] += own.1[k]));
    let share = accuracy / cut.arcs.len().max(1) as f64;
    let mut open: Vec<(Arc, Sums<N>, u32)> = cut.arcs.iter().zip(first).rev().map(|(arc, own)| (*arc, own.0, 0)).collect();
    while let Some((arc, rough, depth)) = open.pop() {
        let fine = cone(&arc, &rules[1]).0;
        let apart: Sums<N> = std::array::from_fn(|k| (fine[k] - rough[k]).abs());
        if depth == MAX_DEPTH || (0..N).all(|k| apart[k] <= share * scale[k]) {
            (0..N).for_each(|k| {
                sum.0[k] += fine[k];
                sum.1[k] += apart[k];
            });
            continue;
        }
        let middle = 0.5 * (arc.t.0 + arc.t.1);
        let halves = [(arc.t.0, middle), (middle, arc.t.1)].map(|t| Arc { t, ..arc });
        open.extend(halves.map(|half| (half, cone(&half, &rules[0]).0, depth + 1)));
    }
    Some(sum)
}

fn turn([a, b, c]: &[DVec2; 3]) -> f64 {
    (*b - *a).perp_dot(*c - *a)
}
