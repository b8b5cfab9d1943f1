//! Integrals over flat faces, from their borders by Green's theorem.

use glam::DVec3;

use super::measure_quadrature::{MAX_DEPTH, ORDERS, Sums, small};
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::network::Chain;
use crate::surface::{Domain, Jet2, Side, Surface};

/// One loop of a boundary in walking order, each chain with the fractions it is run between.
type Boundary = Vec<(Chain, f64, f64)>;

/// The loops that bound a flat surface.
fn boundary(surface: &Surface) -> Vec<Boundary> {
    let side = |k: usize| match surface.side(k) {
        // Sides run with ascending u or v: the walk takes the far ones backwards.
        Side::Chain { chain, from, to } if surface.domain() == Domain::Loop || k < 2 => Some((chain, from, to)),
        Side::Chain { chain, from, to } => Some((chain, to, from)),
        _ => None,
    };
    let mut first = 0;
    let loops = surface.loops().into_iter().map(|sides| {
        first += sides;
        (first - sides..first).filter_map(side).collect()
    });
    loops.collect()
}

/// The steps between the end of each chain of a loop and the start of the next, which meet within a tolerance only.
fn gaps(walk: &Boundary) -> impl Iterator<Item = (DVec3, DVec3)> {
    let ends = |k: usize| {
        let ((before, _, end), (after, start, _)) = (&walk[k], &walk[(k + 1) % walk.len()]);
        (before.point(*end), after.point(*start))
    };
    (0..walk.len()).map(ends).filter(|(a, b)| a != b)
}

/// The integral of N polynomials (up to degree seven in the coordinates) over a flat face, from its boundary by Green's theorem.
///
/// `f` gets jets with unit derivatives in the plane, their cross product the surface's normal.
pub fn flat_integral<const N: usize>(
    surface: &Surface,
    accuracy: f64,
    (f, sized): (&impl Fn(&Jet2) -> Sums<N>, &impl Fn(&Jet2) -> Sums<N>),
) -> (Sums<N>, Sums<N>) {
    let loops = boundary(surface);
    let gaps: Vec<(DVec3, DVec3)> = loops.iter().flat_map(gaps).collect();
    let walk = loops.concat();
    let Some(origin) = walk.first().map(|(chain, from, _)| chain.point(*from)) else { return ([0.0; N], [0.0; N]) };
    let rules = [gauss_legendre(ORDERS[2]), gauss_legendre(ORDERS[3])];
    let runs: Vec<(usize, f64, f64)> = walk
        .iter()
        .enumerate()
        .flat_map(|(k, (chain, from, to))| {
            let mut stops = crate::surface::chain_breaks(chain);
            stops.insert(0, 0.0);
            stops.push(1.0);
            if from > to {
                stops.reverse();
            }
            stops.windows(2).map(|w| (k, w[0], w[1])).collect::<Vec<_>>()
        })
        .collect();
    // The area vector says where the plane is and which side is up.
    let vector = |rule: &[(f64, f64)]| {
        runs.iter().fold(DVec3::ZERO, |sum, &(k, a, b)| {
            rule.iter().fold(sum, |sum, (x, w)| {
                let jet = walk[k].0.jet(0.5 * (a + b) + 0.5 * (b - a) * x);
                sum + (jet.p - origin).cross(jet.d1) * (0.25 * (b - a) * w)
            })
        })
    };
    let Some(normal) = crate::base::math::unit(vector(&rules[1]), 0.0) else { return ([0.0; N], [0.0; N]) };
    let eu = crate::base::math::any_normal(normal);
    let ev = normal.cross(eu);
    let inner = gauss_legendre(ORDERS[0]);
    // ∬ f da db = ∮ F db with F = ∫ f da from the origin's line.
    let along = |p: DVec3, f: &dyn Fn(&Jet2) -> Sums<N>| {
        let (a, foot) = ((p - origin).dot(eu), p - eu * (p - origin).dot(eu));
        inner.iter().fold([0.0; N], |sum, (x, w)| {
            let jet = Jet2 { p: foot + eu * (0.5 * a * (1.0 + x)), du: eu, dv: ev, ..Jet2::default() };
            let value = f(&jet);
            std::array::from_fn(|i| sum[i] + 0.5 * a * w * value[i])
        })
    };
    // The value along a run, or its size.
    let round = |rule: &[(f64, f64)], (k, a, b): (usize, f64, f64), size: bool| {
        rule.iter().fold([0.0; N], |sum, (x, w)| {
            let jet = walk[k].0.jet(0.5 * (a + b) + 0.5 * (b - a) * x);
            let (value, step) = (if size { along(jet.p, sized) } else { along(jet.p, f) }, 0.5 * (b - a) * w * jet.d1.dot(ev));
            std::array::from_fn(|i| sum[i] + if size { (step * value[i]).abs() } else { step * value[i] })
        })
    };
    let scale = runs.iter().fold([0.0; N], |scale: Sums<N>, run| {
        let size = round(&rules[0], *run, true);
        std::array::from_fn(|i| scale[i] + size[i])
    });
    let share = accuracy / runs.len() as f64;
    let (mut sum, mut error) = ([0.0; N], [0.0; N]);
    // A border that is not closed bounds an area that depends on where it is seen from: straight steps close it.
    for (a, b) in gaps {
        for (x, w) in &rules[0] {
            let (value, step) = (along(a.midpoint(b) + (b - a) * (0.5 * x), f), 0.5 * w * (b - a).dot(ev));
            (0..N).for_each(|i| sum[i] += step * value[i]);
        }
    }
    let mut open: Vec<((usize, f64, f64), u32)> = runs.iter().rev().map(|run| (*run, 0)).collect();
    while let Some((run, depth)) = open.pop() {
        job::poll();
        let (rough, value) = (round(&rules[0], run, false), round(&rules[1], run, false));
        let apart: Sums<N> = std::array::from_fn(|i| (value[i] - rough[i]).abs());
        if depth == MAX_DEPTH || small(&apart, &scale.map(|s| share * s)) {
            for i in 0..N {
                sum[i] += value[i];
                error[i] += apart[i];
            }
        } else {
            let middle = 0.5 * (run.1 + run.2);
            open.push(((run.0, middle, run.2), depth + 1));
            open.push(((run.0, run.1, middle), depth + 1));
        }
    }
    (sum, error)
}
