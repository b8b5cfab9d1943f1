//! Integrals over surfaces: Gauss–Legendre products of rising order, cell by cell, halved where that is not enough.

use super::measure_progress::{Part, Progress};
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::base::tolerance::{EPSILON, NUDGE};
use crate::base::work::Budget;
use crate::surface::{Domain, Jet2, Surface};

/// Orders of the rules tried one after the other on a cell.
pub(super) const ORDERS: [usize; 4] = [4, 7, 11, 16];
/// The same where the first division has many cells, each of which is little.
const ORDERS_OF_MANY: [usize; 5] = [3, 5, 7, 11, 16];
/// A cell is halved at most so often in each direction.
pub(super) const MAX_DEPTH: u32 = 12;
/// Cells examined in all.
const MOST_CELLS: usize = 1 << 14;
/// A rule that differs from the one before by more than this share of what that differed by shows that the function is not smooth.
const SMOOTH: f64 = 0.25;
/// Cells of a first division above which their errors may be as large as they are.
const MANY: usize = 1 << 13;
/// Cells that a rule looks at, at most, for each one that needs it.
const SPARSE: usize = 4;
/// Points evaluated at once in the first division: what a row and a column share is then evaluated once for all of them.
const BATCH: usize = 1 << 15;

/// Sums of N functions.
pub type Sums<const N: usize> = [f64; N];

/// N functions of the jet of a surface, and what their values are compared with: sizes that no cancelling makes small.
#[derive(Clone, Copy)]
pub struct Integrand<'a, F, S> {
    /// The functions.
    pub value: &'a F,
    /// Their sizes, not negative.
    pub size: &'a S,
}

/// Low and high of one parameter.
type Span = (f64, f64);

/// A rectangle of the unit square.
#[derive(Clone, Copy)]
struct Cell {
    x: (f64, f64),
    y: (f64, f64),
    depth: u32,
}

impl Cell {
    /// Its four halves in both directions.
    fn quarters(self) -> [Self; 4] {
        let (x, y) = (0.5 * (self.x.0 + self.x.1), 0.5 * (self.y.0 + self.y.1));
        let (left, right, below, above) = ((self.x.0, x), (x, self.x.1), (self.y.0, y), (y, self.y.1));
        [(left, below), (right, below), (left, above), (right, above)].map(|(x, y)| Self { x, y, depth: self.depth + 1 })
    }
}

/// Low and high of x and of y.
pub type Rectangle = ((f64, f64), (f64, f64));
/// All of the unit square.
pub const WHOLE: Rectangle = ((0.0, 1.0), (0.0, 1.0));

/// The integral of N functions of the jet over a rectangle of the unit square of a surface, with estimated errors.
///
/// A cell is done when two orders differ by no more than `accuracy` of the integrals of their sizes, shared
/// out by the cells of the first division, once more by their size where these are many; errors are sums of these differences (of the
/// lower order: on the safe side).
pub fn integral<const N: usize>(
    surface: &Surface,
    within: Rectangle,
    accuracy: f64,
    integrand: Integrand<impl Fn(&Jet2) -> Sums<N>, impl Fn(&Jet2) -> Sums<N>>,
    meter: &Budget,
) -> (Sums<N>, Sums<N>) {
    let ((us, vs), kinks) = (surface.breaks(), surface.kinks());
    // A triangle's lines do not follow the square.
    let us = if surface.domain() == Domain::Triangle { Vec::new() } else { us };
    let (us, vs) = (spans(apart(us, kinks.0), within.0), spans(apart(vs, kinks.1), within.1));
    let open: Vec<Cell> = vs.iter().flat_map(|y| us.iter().map(|x| Cell { x: *x, y: *y, depth: 0 })).collect();
    let orders = if open.len() > MANY { &ORDERS_OF_MANY[..] } else { &ORDERS[..] };
    let rules: Vec<Vec<(f64, f64)>> = orders.iter().map(|&n| gauss_legendre(n)).collect();
    let share = accuracy / open.len() as f64;
    let first = products(surface, (&us, &vs), &rules[0], integrand.value);
    let second = products(surface, (&us, &vs), &rules[1], integrand.value);
    let sizes = products(surface, (&us, &vs), &rules[0], integrand.size);
    let scale = sizes.iter().fold([0.0; N], |sum, size| std::array::from_fn(|i| sum[i] + size[i]));
    // Of many cells the large ones hold nearly everything: they get a share as large.
    let own = if open.len() > MANY { accuracy } else { 0.0 };
    let allowed: Vec<Sums<N>> = sizes.iter().map(|size| std::array::from_fn(|i| share * scale[i] + own * size[i])).collect();
    let mut known: Vec<Vec<Sums<N>>> = first.into_iter().zip(second).map(|(a, b)| vec![a, b]).collect();
    for rule in &rules[2..] {
        sharpen(surface, (&us, &vs), rule, integrand.value, &mut known, &allowed);
    }
    // Where the first division has many cells each of them may still be halved.
    let most = MOST_CELLS.max(2 * open.len());
    let open: Vec<(Cell, Vec<Sums<N>>, Sums<N>)> =
        open.into_iter().zip(known).zip(allowed).map(|((cell, known), limit)| (cell, known, limit)).collect();
    let measure = |(cell, start, limit): &(Cell, Vec<Sums<N>>, Sums<N>)| {
        job::poll();
        let (value, apart) = measured(&rules, start, limit, |k| product(surface, cell, &rules[k], integrand.value));
        Part { value, apart, limit: *limit, last: cell.depth >= MAX_DEPTH }
    };
    let halves = |(cell, _, limit): (Cell, Vec<Sums<N>>, Sums<N>)| {
        let limit = std::array::from_fn(|i| share * scale[i] + 0.25 * (limit[i] - share * scale[i]));
        cell.quarters().map(|quarter| (quarter, Vec::new(), limit))
    };
    Progress::new(accuracy, scale).sum(open, (most, 4), meter, measure, halves)
}

/// The integrals over a cell by rules of rising order, the first of them known, until they are settled or show that the function is
/// not smooth there; and what the last two differ by.
fn measured<const N: usize>(
    rules: &[Vec<(f64, f64)>],
    known: &[Sums<N>],
    limit: &Sums<N>,
    by_rule: impl Fn(usize) -> Sums<N>,
) -> (Sums<N>, Sums<N>) {
    let value_of = |k: usize| known.get(k).copied().unwrap_or_else(|| by_rule(k));
    let (mut value, mut apart) = (value_of(0), [f64::INFINITY; N]);
    for k in 1..rules.len() {
        let (next, before) = (value_of(k), apart.map(|a| SMOOTH * a));
        apart = std::array::from_fn(|i| (next[i] - value[i]).abs());
        value = next;
        if small(&apart, limit) || (0..N).any(|i| apart[i] > limit[i].max(before[i])) {
            break;
        }
    }
    (value, apart)
}

pub(super) fn add<const N: usize>(sum: &mut Sums<N>, value: &Sums<N>) {
    (0..N).for_each(|i| sum[i] += value[i]);
}

pub(super) fn small<const N: usize>(apart: &Sums<N>, limit: &Sums<N>) -> bool {
    apart.iter().zip(limit).all(|(a, limit)| a <= limit)
}

/// Breaks far enough apart to tell one from the next; kinks stay where they are.
///
/// Beside a break that is no kink derivatives of the integrand jump at most: what is cut there moves the integral by the square of the
/// distance.
fn apart(breaks: Vec<f64>, kinks: &[f64]) -> Vec<f64> {
    let is_kink = |x: f64| kinks.iter().any(|k| (k - x).abs() <= EPSILON);
    let mut out: Vec<f64> = Vec::with_capacity(breaks.len());
    for x in breaks {
        match out.last_mut() {
            Some(last) if x - *last <= NUDGE && is_kink(x) && !is_kink(*last) => *last = x,
            Some(last) if x - *last <= NUDGE && !is_kink(x) => {}
            _ => out.push(x),
        }
    }
    out
}

/// The intervals between two ends and the stops inside.
fn spans(inner: Vec<f64>, (low, high): (f64, f64)) -> Vec<(f64, f64)> {
    let inner = inner.into_iter().filter(|x| *x > low && *x < high);
    let stops: Vec<f64> = std::iter::once(low).chain(inner).chain(std::iter::once(high)).collect();
    stops.windows(2).map(|w| (w[0], w[1])).collect()
}

/// What the last two rules differ by.
fn differences<const N: usize>(values: &[Sums<N>]) -> Sums<N> {
    let [.., a, b] = values else { return [f64::INFINITY; N] };
    std::array::from_fn(|i| (b[i] - a[i]).abs())
}

/// Adds the values of one more rule to the cells of the first division that are not done, where these fill most of the rows and
/// columns that they are in: curves are then evaluated once for all of them.
fn sharpen<const N: usize>(
    surface: &Surface,
    (us, vs): (&[Span], &[Span]),
    rule: &[(f64, f64)],
    f: &impl Fn(&Jet2) -> Sums<N>,
    known: &mut [Vec<Sums<N>>],
    allowed: &[Sums<N>],
) {
    let open: Vec<bool> = known.iter().zip(allowed).map(|(values, limit)| !small(&differences(values), limit)).collect();
    let rows: Vec<usize> = (0..vs.len()).filter(|j| open[j * us.len()..(j + 1) * us.len()].contains(&true)).collect();
    let columns: Vec<usize> = (0..us.len()).filter(|i| rows.iter().any(|j| open[j * us.len() + i])).collect();
    let count = open.iter().filter(|open| **open).count();
    if count < 2 || rows.len() * columns.len() > SPARSE * count {
        return;
    }
    let pick = |all: &[(f64, f64)], of: &[usize]| of.iter().map(|k| all[*k]).collect::<Vec<_>>();
    let values = products(surface, (&pick(us, &columns), &pick(vs, &rows)), rule, f);
    for (n, value) in values.into_iter().enumerate() {
        let cell = rows[n / columns.len()] * us.len() + columns[n % columns.len()];
        if open[cell] {
            known[cell].push(value);
        }
    }
}

/// [`product`] on each cell of intervals in x and y, x fastest.
fn products<const N: usize>(
    surface: &Surface,
    (us, vs): (&[Span], &[Span]),
    rule: &[(f64, f64)],
    f: &impl Fn(&Jet2) -> Sums<N>,
) -> Vec<Sums<N>> {
    let order = rule.len();
    let on = |spans: &[(f64, f64)]| -> Vec<f64> {
        spans.iter().flat_map(|(a, b)| rule.iter().map(move |(x, _)| 0.5 * (a + b) + 0.5 * (b - a) * x)).collect()
    };
    let (wide, high) = block(surface, (us.len(), vs.len()), BATCH / (order * order));
    let mut found = vec![[0.0; N]; us.len() * vs.len()];
    for (n, band) in vs.chunks(high).enumerate() {
        let ys = on(band);
        for (m, part) in us.chunks(wide).enumerate() {
            job::poll();
            let xs = on(part);
            let jets = surface.square_jets(&xs, &ys);
            for (j, y) in band.iter().enumerate() {
                for (i, x) in part.iter().enumerate() {
                    let area = 0.25 * (x.1 - x.0) * (y.1 - y.0);
                    let at = |k: usize| &jets[(j * order + k / order) * xs.len() + i * order + k % order];
                    found[(n * high + j) * us.len() + m * wide + i] = weighed((0..order * order).map(at), area, rule, f);
                }
            }
        }
    }
    found
}

/// Columns and rows of cells that are evaluated at once, about `most` cells: so many of each that the curves along both directions,
/// each evaluated once for a block, are evaluated the fewest times in all.
fn block(surface: &Surface, (us, vs): (usize, usize), most: usize) -> (usize, usize) {
    let (along_u, along_v) = surface.curves_of_a_point();
    let even = (most as f64 * along_u as f64 / along_v.max(1) as f64).sqrt() as usize;
    let high = if along_v == 0 { vs } else { even.max(most / us.max(1)) }.clamp(1, vs.max(1).min(most.max(1)));
    ((most / high).clamp(1, us.max(1)), high)
}

/// One rule on one cell.
fn product<const N: usize>(surface: &Surface, cell: &Cell, rule: &[(f64, f64)], f: &impl Fn(&Jet2) -> Sums<N>) -> Sums<N> {
    let on = |(a, b): (f64, f64)| rule.iter().map(|(x, _)| 0.5 * (a + b) + 0.5 * (b - a) * x).collect::<Vec<f64>>();
    let jets = surface.square_jets(&on(cell.x), &on(cell.y));
    let area = 0.25 * (cell.x.1 - cell.x.0) * (cell.y.1 - cell.y.0);
    weighed(jets.iter(), area, rule, f)
}

/// The integrals from the jets of a rule.
fn weighed<'a, const N: usize>(
    jets: impl Iterator<Item = &'a Jet2>,
    area: f64,
    rule: &[(f64, f64)],
    f: &impl Fn(&Jet2) -> Sums<N>,
) -> Sums<N> {
    let mut sum = [0.0; N];
    for (k, jet) in jets.enumerate() {
        let weight = area * rule[k % rule.len()].1 * rule[k / rule.len()].1;
        for (i, value) in f(jet).into_iter().enumerate() {
            sum[i] += weight * value;
        }
    }
    sum
}
