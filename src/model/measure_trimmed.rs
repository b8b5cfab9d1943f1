//! Integrals over trimmed surfaces, from their borders by Green's theorem in (u, v).

use glam::DVec2;

use super::measure_below::{Below, crossings};
use super::measure_quadrature::{Integrand, Sums, add};
use super::measure_strips::Strips;
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::base::tolerance::EPSILON;
use crate::base::work;
use crate::network::Chain;
use crate::surface::{Evaluator, Jet2, Side, Surface, chain_breaks};

/// Points of the rules along a border, the first pair for runs between breaks only, and across the surface.
const ALONG: [[usize; 2]; 2] = [[4, 6], [8, 12]];
const ACROSS: usize = 12;
/// Where between two values of u a function's size is looked at: no places that are special for anything.
const SIZED: [f64; 3] = [0.13, 0.46, 0.89];
/// Units of work that a place of a scattered surface takes beside the one of a curve: the triangle that holds it has to be found.
const DEAR: u64 = 3;
/// A run of a border is halved at most so often.
const MAX_DEPTH: u32 = 14;

/// A border: the chain that carries it, or a line in (u, v).
enum Way {
    Chain(usize, Chain, f64, f64),
    Line((f64, f64), (f64, f64)),
}

/// A run of a border between two shares of it.
#[derive(Clone, Copy)]
struct Run {
    border: usize,
    t: (f64, f64),
    depth: u32,
}

/// What a rule makes of a run: the sum, where asked for about that of what is added up regardless of sign, and the box of its places in (u, v).
struct Met<const N: usize> {
    sum: Sums<N>,
    size: Sums<N>,
    within: (DVec2, DVec2),
}

/// Whether one of some values, ascending, lies between two.
fn parts(breaks: &[f64], low: f64, high: f64) -> bool {
    breaks.partition_point(|b| *b <= low) < breaks.partition_point(|b| *b < high)
}

/// What the integral over a trimmed surface is made from: ∬ f du dv = ∮ F dv with F = ∫ f du from a base of each loop.
struct Green<'a, const N: usize, F, S> {
    integrand: Integrand<'a, F, S>,
    evaluator: Evaluator<'a>,
    /// Units of work of one evaluation.
    cost: u64,
    /// Borders with the u their integrals along u begin at.
    ways: Vec<(f64, Way)>,
    /// Where the surface is less than analytic.
    breaks: (Vec<f64>, Vec<f64>),
    closed_v: bool,
    /// The rule along u.
    across: Vec<(f64, f64)>,
    strips: Option<Strips<N>>,
    /// The plane below which alone the surface counts.
    below: Option<Below>,
}

impl<'a, const N: usize, F, S> Green<'a, N, F, S>
where
    F: Fn(&Jet2) -> Sums<N>,
    S: Fn(&Jet2) -> Sums<N>,
{
    fn new(evaluator: Evaluator<'a>, integrand: Integrand<'a, F, S>, below: Option<Below>) -> Self {
        let surface = evaluator.surface();
        let outlines = surface.outlines();
        // From the middle of each loop; round a closed loop any start serves.
        let middle = |outline: &Vec<DVec2>| {
            let (low, high) = outline.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.x), h.max(p.x)));
            0.5 * (low + high)
        };
        let bases: Vec<f64> = outlines.iter().zip(surface.loops()).flat_map(|(o, n)| std::iter::repeat_n(middle(o), n)).collect();
        let mut made = Self {
            integrand,
            evaluator,
            cost: if surface.is_scattered() { DEAR } else { 0 },
            ways: (0..surface.n_sides()).filter_map(|k| Some((bases[k], Way::of(surface, k)?))).collect(),
            breaks: surface.breaks(),
            closed_v: surface.closed().1,
            across: gauss_legendre(ACROSS),
            strips: None,
            below,
        };
        if below.is_none() && outlines.iter().flatten().all(|p| (-EPSILON..=1.0 + EPSILON).contains(&p.x)) {
            made.strips = Strips::new((&made.breaks.0, &made.breaks.1), &made.across, &|u, v| (made.integrand.value)(&made.jet(u, v)));
        }
        made
    }

    /// Point and first derivatives: nothing here takes second ones, which are left out.
    fn jet(&self, u: f64, v: f64) -> Jet2 {
        work::spend(self.cost);
        let [p, du, dv] = self.evaluator.tangents(u, v);
        Jet2 { p, du, dv, ..Jet2::default() }
    }

    /// ∫ f du between two places without a break, of what counts.
    fn part(&self, low: f64, high: f64, v: f64) -> Sums<N> {
        let Some(plane) = self.below else { return self.smooth_part(low, high, v) };
        let mut sum = [0.0; N];
        let stops = crossings(self.evaluator.surface(), plane, (low, high), v);
        for w in stops.windows(2) {
            if plane.height(self.evaluator.point(0.5 * (w[0] + w[1]), v)) < 0.0 {
                add(&mut sum, &self.smooth_part(w[0], w[1], v));
            }
        }
        sum
    }

    fn smooth_part(&self, low: f64, high: f64, v: f64) -> Sums<N> {
        let mut sum = [0.0; N];
        for (x, w) in &self.across {
            job::poll();
            let u = 0.5 * (low + high) + 0.5 * (high - low) * x;
            let value = (self.integrand.value)(&self.jet(u, v));
            (0..N).for_each(|i| sum[i] += 0.5 * (high - low) * w * value[i]);
        }
        sum
    }

    /// F: ∫ f du from a base.
    fn along_u(&self, base: f64, at: DVec2) -> Sums<N> {
        if let Some(strips) = &self.strips {
            // The table holds one turn: where a border runs over the seam it is the same a turn away.
            let turn = if self.closed_v && !(0.0..=1.0).contains(&at.y) { at.y.floor() } else { 0.0 };
            return strips.from(strips.nearest(base), at - DVec2::new(0.0, turn), |low, high| self.part(low, high, at.y));
        }
        let mut sum = [0.0; N];
        let (first, last) = (base.min(at.x), base.max(at.x));
        let sign = if at.x < base { -1.0 } else { 1.0 };
        let mut low = first;
        // Breaks repeat where the surface closes and a border runs over its seam.
        let whole = (first.floor() as i64..=last.ceil() as i64).flat_map(|n| {
            let n = n as f64;
            self.breaks.0.iter().map(move |b| b + n).chain([n])
        });
        let mut stops: Vec<f64> = whole.filter(|u| *u > first && *u < last).collect();
        stops.sort_by(f64::total_cmp);
        stops.push(last);
        for high in stops {
            let own = self.part(low, high, at.y);
            (0..N).for_each(|i| sum[i] += sign * own[i]);
            low = high;
        }
        sum
    }

    /// The runs of all borders between their stops.
    fn runs(&self) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for (border, (_, way)) in self.ways.iter().enumerate() {
            let mut stops = way.stops(&self.breaks.1, self.closed_v);
            if let Some(plane) = self.below {
                let place = |t: f64| way.at(self.evaluator, &|u, v| self.jet(u, v), t).0;
                plane.add_stops(&mut stops, |t| self.evaluator.point(place(t).x, place(t).y));
            }
            runs.extend(stops.windows(2).map(|w| Run { border, t: (w[0], w[1]), depth: 0 }));
        }
        runs.reverse();
        runs
    }

    /// F dv along a run by a rule, with its size if that is wanted.
    fn along(&self, run: &Run, rule: &[(f64, f64)], wanted: bool) -> Met<N> {
        let (mut sum, mut size) = ([0.0; N], [0.0; N]);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (x, w) in rule {
            let half = 0.5 * (run.t.1 - run.t.0);
            let t = 0.5 * (run.t.0 + run.t.1) + half * x;
            let (base, way) = (self.ways[run.border].0, &self.ways[run.border].1);
            let (at, dv) = way.at(self.evaluator, &|u, v| self.jet(u, v), t);
            (low, high) = (low.min(at), high.max(at));
            if dv == 0.0 {
                continue;
            }
            for (i, value) in self.along_u(base, at).into_iter().enumerate() {
                sum[i] += half * w * dv * value;
            }
            // Round a closed surface what is added up may come to nothing: its size is that of what is added.
            for x in SIZED.iter().filter(|_| wanted) {
                let value = (self.integrand.size)(&self.jet(base + (at.x - base) * x, at.y));
                (0..N).for_each(|i| size[i] += (half * w * dv * (at.x - base) * value[i]).abs() / SIZED.len() as f64);
            }
        }
        Met { sum, size, within: (low, high) }
    }

    /// Whether no break lies between the places of a run: few points then tell as much as many.
    fn is_even(&self, (low, high): (DVec2, DVec2)) -> bool {
        if self.below.is_some() {
            return false;
        }
        let alone = |breaks: &[f64], low: f64, high: f64| breaks.is_empty() || low >= 0.0 && high <= 1.0 && !parts(breaks, low, high);
        alone(&self.breaks.0, low.x, high.x) && alone(&self.breaks.1, low.y, high.y)
    }
}

/// The integral of N functions of the jet over a trimmed surface, with estimated errors: `accuracy` is relative to the sums of
/// their sizes.
///
/// By Green's theorem from its borders, cut where the surface is less than analytic and halved until two rules agree; with a plane of
/// what lies below it alone.
pub fn trimmed_integral<const N: usize>(
    surface: &Surface,
    accuracy: f64,
    integrand: Integrand<impl Fn(&Jet2) -> Sums<N>, impl Fn(&Jet2) -> Sums<N>>,
    below: Option<Below>,
) -> (Sums<N>, Sums<N>) {
    let prepared = surface.prepared();
    let green = Green::new(prepared.evaluator(), integrand, below);
    let rules = ALONG.map(|pair| pair.map(gauss_legendre));
    let runs = green.runs();
    let (mut scale, mut first) = ([0.0; N], Vec::with_capacity(runs.len()));
    for met in runs.iter().map(|run| green.along(run, &rules[0][0], true)) {
        (0..N).for_each(|i| scale[i] += met.size[i]);
        first.push(met);
    }
    let share = accuracy / runs.len().max(1) as f64;
    let apart = |a: &Sums<N>, b: &Sums<N>| -> Sums<N> { std::array::from_fn(|i| (a[i] - b[i]).abs()) };
    let settled = |apart: &Sums<N>| (0..N).all(|i| apart[i] <= share * scale[i]);
    let mut open: Vec<(Run, Met<N>)> = runs.into_iter().zip(first).collect();
    let (mut sum, mut error) = ([0.0; N], [0.0; N]);
    while let Some((next, met)) = open.pop() {
        job::poll();
        let few = green.is_even(met.within).then(|| {
            let value = green.along(&next, &rules[0][1], false).sum;
            (value, apart(&value, &met.sum))
        });
        let (value, off) = few.filter(|(_, off)| settled(off)).unwrap_or_else(|| {
            let value = green.along(&next, &rules[1][1], false).sum;
            (value, apart(&value, &green.along(&next, &rules[1][0], false).sum))
        });
        if next.depth == MAX_DEPTH || settled(&off) {
            add(&mut sum, &value);
            add(&mut error, &off);
        } else {
            let middle = 0.5 * (next.t.0 + next.t.1);
            let halves = [(middle, next.t.1), (next.t.0, middle)].map(|t| Run { t, depth: next.depth + 1, ..next });
            open.extend(halves.map(|half| (half, green.along(&half, &rules[0][0], false))));
        }
    }
    (sum, error)
}

/// Places in (u, v) at which the borders of a trimmed surface cross a plane.
pub fn border_crossings(surface: &Surface, below: Below) -> Vec<DVec2> {
    let (evaluator, breaks, closed) = (surface.evaluator(), surface.breaks().1, surface.closed().1);
    let mut found = Vec::new();
    for way in (0..surface.n_sides()).filter_map(|k| Way::of(surface, k)) {
        let place = |t: f64| way.at(evaluator, &|u, v| surface.jet(u, v), t).0;
        let ends = way.stops(&breaks, closed);
        let mut stops = ends.clone();
        below.add_stops(&mut stops, |t| evaluator.point(place(t).x, place(t).y));
        found.extend(stops.into_iter().filter(|t| !ends.contains(t)).map(place));
    }
    found
}

impl Way {
    /// A border of a surface; `None` for a pole, a seam and the like.
    fn of(surface: &Surface, k: usize) -> Option<Self> {
        match (surface.side(k), surface.border_line(k)) {
            (_, Some((a, b))) => Some(Self::Line(a, b)),
            (Side::Chain { chain, from, to }, None) => Some(Self::Chain(k, chain, from, to)),
            _ => None,
        }
    }

    /// Shares of the way at which it is less than smooth, ends included.
    fn stops(&self, breaks_v: &[f64], closed_v: bool) -> Vec<f64> {
        let mut stops = vec![0.0, 1.0];
        match self {
            Self::Chain(_, chain, from, to) => stops.extend(chain_breaks(chain).into_iter().map(|f| (f - from) / (to - from))),
            Self::Line(a, b) => {
                // Breaks repeat, and the seam is one, where the surface closes and the line runs over its seam.
                let turns = if closed_v { a.1.min(b.1).floor() as i64..=a.1.max(b.1).ceil() as i64 } else { 0..=0 };
                let seam = closed_v.then_some(0.0);
                let all = turns.flat_map(|n| breaks_v.iter().copied().chain(seam).map(move |v| v + n as f64));
                stops.extend(all.map(|v| (v - a.1) / (b.1 - a.1)).filter(|t| t.is_finite()));
            }
        }
        stops.retain(|t| (0.0..=1.0).contains(t));
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        stops
    }

    /// (u, v) at a share of the way, and dv by the share.
    fn at(&self, evaluator: Evaluator, jet: &impl Fn(f64, f64) -> Jet2, t: f64) -> (DVec2, f64) {
        match self {
            Self::Line(a, b) => (DVec2::new(a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t), b.1 - a.1),
            Self::Chain(side, chain, from, to) => {
                let f = from + (to - from) * t;
                let uv = evaluator.border_place(*side, f).unwrap_or_default();
                let jet = jet(uv.0, uv.1);
                let d = chain.jet(f).d1 * (to - from);
                let (e, g, m) = (jet.du.length_squared(), jet.dv.length_squared(), jet.du.dot(jet.dv));
                let dv = (e * jet.dv.dot(d) - m * jet.du.dot(d)) / (e * g - m * m);
                (uv.into(), if dv.is_finite() { dv } else { 0.0 })
            }
        }
    }
}
