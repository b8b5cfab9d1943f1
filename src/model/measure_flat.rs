//! Integrals over flat faces, from their borders by Green's theorem.

use glam::DVec3;

use super::measure_quadrature::{Integrand, MAX_DEPTH, ORDERS, Sums, add, small};
use crate::base::quadrature::gauss_legendre;
use crate::base::{job, math};
use crate::network::Chain;
use crate::surface::{Domain, Jet2, Side, Surface};

/// One loop of a boundary in walking order, each chain with the fractions it is run between.
pub type Boundary = Vec<(Chain, f64, f64)>;

/// The loops that bound a flat surface.
pub fn boundary(surface: &Surface) -> Vec<Boundary> {
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
pub fn gaps(walk: &Boundary) -> impl Iterator<Item = (DVec3, DVec3)> {
    let ends = |k: usize| {
        let ((before, _, end), (after, start, _)) = (&walk[k], &walk[(k + 1) % walk.len()]);
        (before.point(*end), after.point(*start))
    };
    (0..walk.len()).map(ends).filter(|(a, b)| a != b)
}

/// A run of a boundary: its chain by number, and the fractions it is run between.
pub type ChainRun = (usize, f64, f64);

/// Runs of the chains between the places at which they are less than smooth.
pub fn runs(walk: &Boundary) -> Vec<ChainRun> {
    let of_chain = |(k, (chain, from, to)): (usize, &(Chain, f64, f64))| {
        let mut stops = crate::surface::chain_breaks(chain);
        stops.insert(0, 0.0);
        stops.push(1.0);
        if from > to {
            stops.reverse();
        }
        stops.windows(2).map(|w| (k, w[0], w[1])).collect::<Vec<_>>()
    };
    walk.iter().enumerate().flat_map(of_chain).collect()
}

/// A flat face with its frame.
struct FlatFace {
    walk: Boundary,
    origin: DVec3,
    /// Unit vectors in the plane, their cross product the normal.
    eu: DVec3,
    ev: DVec3,
    /// The rule from the line through the origin along `ev`.
    inner: Vec<(f64, f64)>,
}

impl FlatFace {
    /// `None` where the boundary has no area.
    fn new(walk: Boundary, runs: &[ChainRun], rule: &[(f64, f64)]) -> Option<Self> {
        let origin = walk.first().map(|(chain, from, _)| chain.point(*from))?;
        // The area vector says where the plane is and which side is up.
        let vector = runs.iter().fold(DVec3::ZERO, |sum, &(k, a, b)| {
            rule.iter().fold(sum, |sum, (x, w)| {
                let jet = walk[k].0.jet(0.5 * (a + b) + 0.5 * (b - a) * x);
                sum + (jet.p - origin).cross(jet.d1) * (0.25 * (b - a) * w)
            })
        });
        let normal = math::unit(vector, 0.0)?;
        let eu = math::any_normal(normal);
        Some(Self { walk, origin, eu, ev: normal.cross(eu), inner: gauss_legendre(ORDERS[0]) })
    }

    /// F = ∫ f da from the line through the origin: ∬ f da db = ∮ F db.
    fn along<const N: usize>(&self, p: DVec3, f: &impl Fn(&Jet2) -> Sums<N>) -> Sums<N> {
        let (a, foot) = ((p - self.origin).dot(self.eu), p - self.eu * (p - self.origin).dot(self.eu));
        self.inner.iter().fold([0.0; N], |sum, (x, w)| {
            let jet = Jet2 { p: foot + self.eu * (0.5 * a * (1.0 + x)), du: self.eu, dv: self.ev, ..Jet2::default() };
            let value = f(&jet);
            std::array::from_fn(|i| sum[i] + 0.5 * a * w * value[i])
        })
    }

    /// F db along a run.
    fn round<const N: usize>(&self, rule: &[(f64, f64)], (k, a, b): ChainRun, f: &impl Fn(&Jet2) -> Sums<N>) -> Sums<N> {
        self.steps(rule, (k, a, b), f, |x| x)
    }

    /// The sum of the absolute values of F db along a run.
    fn size<const N: usize>(&self, rule: &[(f64, f64)], (k, a, b): ChainRun, f: &impl Fn(&Jet2) -> Sums<N>) -> Sums<N> {
        self.steps(rule, (k, a, b), f, f64::abs)
    }

    fn steps<const N: usize>(
        &self,
        rule: &[(f64, f64)],
        (k, a, b): ChainRun,
        f: &impl Fn(&Jet2) -> Sums<N>,
        each: impl Fn(f64) -> f64,
    ) -> Sums<N> {
        rule.iter().fold([0.0; N], |sum, (x, w)| {
            let jet = self.walk[k].0.jet(0.5 * (a + b) + 0.5 * (b - a) * x);
            let (value, step) = (self.along(jet.p, f), 0.5 * (b - a) * w * jet.d1.dot(self.ev));
            std::array::from_fn(|i| sum[i] + each(step * value[i]))
        })
    }
}

/// The integral of N polynomials (up to degree seven in the coordinates) over a flat face, from its boundary by Green's theorem,
/// with estimated errors: `accuracy` is relative to the sums of their sizes.
///
/// The functions get jets with unit derivatives in the plane, their cross product the surface's normal.
pub fn flat_integral<const N: usize>(
    surface: &Surface,
    accuracy: f64,
    integrand: Integrand<impl Fn(&Jet2) -> Sums<N>, impl Fn(&Jet2) -> Sums<N>>,
) -> (Sums<N>, Sums<N>) {
    let loops = boundary(surface);
    let gaps: Vec<(DVec3, DVec3)> = loops.iter().flat_map(gaps).collect();
    let walk = loops.concat();
    let rules = [gauss_legendre(ORDERS[2]), gauss_legendre(ORDERS[3])];
    let runs = runs(&walk);
    let Some(face) = FlatFace::new(walk, &runs, &rules[1]) else { return ([0.0; N], [0.0; N]) };
    let scale = runs.iter().fold([0.0; N], |scale: Sums<N>, run| {
        let size = face.size(&rules[0], *run, integrand.size);
        std::array::from_fn(|i| scale[i] + size[i])
    });
    let share = accuracy / runs.len() as f64;
    let (mut sum, mut error) = ([0.0; N], [0.0; N]);
    // A border that is not closed bounds an area that depends on where it is seen from: straight steps close it.
    for (a, b) in gaps {
        for (x, w) in &rules[0] {
            let (value, step) = (face.along(a.midpoint(b) + (b - a) * (0.5 * x), integrand.value), 0.5 * w * (b - a).dot(face.ev));
            (0..N).for_each(|i| sum[i] += step * value[i]);
        }
    }
    let mut open: Vec<(ChainRun, u32)> = runs.iter().rev().map(|run| (*run, 0)).collect();
    while let Some((run, depth)) = open.pop() {
        job::poll();
        let (rough, value) = (face.round(&rules[0], run, integrand.value), face.round(&rules[1], run, integrand.value));
        let apart: Sums<N> = std::array::from_fn(|i| (value[i] - rough[i]).abs());
        if depth == MAX_DEPTH || small(&apart, &scale.map(|s| share * s)) {
            add(&mut sum, &value);
            add(&mut error, &apart);
        } else {
            let middle = 0.5 * (run.1 + run.2);
            open.push(((run.0, middle, run.2), depth + 1));
            open.push(((run.0, run.1, middle), depth + 1));
        }
    }
    (sum, error)
}
