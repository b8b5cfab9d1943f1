//! Integrals over trimmed surfaces, from their borders by Green's theorem in (u, v).

use glam::DVec2;

use super::measure_below::{Below, crossings};
use super::measure_progress::{Part, Progress};
use super::measure_quadrature::{Integrand, Sums, add, small};
use super::measure_strips::{Rules, Strips};
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::base::work::{self, Budget};
use crate::network::Chain;
use crate::surface::{Domain, Evaluator, Jet2, Side, Surface, chain_breaks};

/// Points of the rules along a border, the first pair for runs between breaks only, and across the surface.
const ALONG: [[usize; 2]; 2] = [[4, 6], [8, 12]];
const ACROSS: usize = 12;
/// Points of the rule that the one across has to agree with, and to which share of the accuracy asked for.
const CHECKED: (usize, f64) = (8, 0.1);
/// Integrals across begin at one of so many even steps over the box of the borders.
const BASES: f64 = 32.0;
/// Borders may leave the box of the places that are known of them by this share of its size.
const ROOM: f64 = 1.0 / 64.0;
/// Where between two values of u a function's size is looked at: no places that are special for anything.
const SIZED: [f64; 3] = [0.13, 0.46, 0.89];
/// Units of work that a place of a scattered surface takes beside the one of a curve: the triangle that holds it has to be found.
const DEAR: u64 = 3;
/// A run of a border is halved at most so often.
const MAX_DEPTH: u32 = 14;
/// Runs of borders examined in all.
const MOST_RUNS: usize = 1 << 13;

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

/// The result of a rule over a run.
struct Met<const N: usize> {
    /// ∫ F dv.
    sum: Sums<N>,
    /// ∫ dv.
    rise: f64,
    /// About ∫ |F dv|, where that was asked for.
    size: Sums<N>,
    /// The box of its places in (u, v).
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
    strips: Strips<N>,
    /// The plane below which alone the surface counts.
    below: Option<Below>,
}

impl<'a, const N: usize, F, S> Green<'a, N, F, S>
where
    F: Fn(&Jet2) -> Sums<N>,
    S: Fn(&Jet2) -> Sums<N>,
{
    fn new(evaluator: Evaluator<'a>, accuracy: f64, integrand: Integrand<'a, F, S>, below: Option<Below>) -> Self {
        let surface = evaluator.surface();
        let (breaks, closed, outlines) = (surface.breaks(), surface.closed(), surface.outlines());
        let extent = |points: &mut dyn Iterator<Item = DVec2>| {
            points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
        };
        let (low, high) = extent(&mut outlines.iter().flatten().copied());
        // From the middle of each loop; round a closed loop any start serves.
        let step = (high.x - low.x) / BASES;
        let base = |outline: &Vec<DVec2>| {
            let (left, right) = extent(&mut outline.iter().copied());
            if step > 0.0 { low.x + step * ((0.5 * (left.x + right.x) - low.x) / step).round() } else { 0.0 }
        };
        let bases: Vec<f64> = outlines.iter().zip(surface.loops()).flat_map(|(o, n)| std::iter::repeat_n(base(o), n)).collect();
        let us = cuts(&breaks.0, (low.x, high.x), closed.0, &bases);
        let vs = cuts(&breaks.1, (low.y, high.y), closed.1, &[]);
        let across = gauss_legendre(ACROSS);
        let cost = if surface.is_scattered() { DEAR } else { 0 };
        let value = |u: f64, v: f64| {
            let jet = first_jet(evaluator, cost, u, v);
            ((integrand.value)(&jet), (integrand.size)(&jet))
        };
        let rules = Rules { coarse: &gauss_legendre(CHECKED.0), fine: &across, accuracy: CHECKED.1 * accuracy };
        // A triangle's rows are not all as long.
        let is_triangle = surface.ground() == Domain::Triangle;
        let strips = if is_triangle { Strips::plain((&us, &vs)) } else { Strips::new((&us, &vs), rules, below.is_none(), &value) };
        Self { integrand, evaluator, cost, ways: ways(evaluator, &bases), breaks, closed_v: closed.1, strips, across, below }
    }

    /// Point and first derivatives: nothing here takes second ones, which are left out.
    fn jet(&self, u: f64, v: f64) -> Jet2 {
        first_jet(self.evaluator, self.cost, u, v)
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
        self.strips.from(base, at, |low, high| self.part(low, high, at.y))
    }

    /// The runs of all borders between their stops.
    fn runs(&self) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for (border, (_, way)) in self.ways.iter().enumerate() {
            let mut stops = way.stops(&self.breaks.1, self.closed_v);
            if let Some(plane) = self.below {
                let place = |t: f64| way.at(self.evaluator, t).0;
                plane.add_stops(&mut stops, |t| self.evaluator.point(place(t).x, place(t).y));
            }
            runs.extend(stops.windows(2).map(|w| Run { border, t: (w[0], w[1]), depth: 0 }));
        }
        runs
    }

    /// F dv along a run by a rule, with its size if that is wanted.
    fn along(&self, run: &Run, rule: &[(f64, f64)], wanted: bool) -> Met<N> {
        let (mut sum, mut rise, mut size) = ([0.0; N], 0.0, [0.0; N]);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (x, w) in rule {
            let half = 0.5 * (run.t.1 - run.t.0);
            let t = 0.5 * (run.t.0 + run.t.1) + half * x;
            let (base, way) = (self.ways[run.border].0, &self.ways[run.border].1);
            let (at, dv) = way.at(self.evaluator, t);
            (low, high) = (low.min(at), high.max(at));
            if dv == 0.0 {
                continue;
            }
            rise += half * w * dv;
            for (i, value) in self.along_u(base, at).into_iter().enumerate() {
                sum[i] += half * w * dv * value;
            }
            // Round a closed surface what is added up may come to nothing: its size is that of what is added.
            for x in SIZED.iter().filter(|_| wanted) {
                let value = (self.integrand.size)(&self.jet(base + (at.x - base) * x, at.y));
                (0..N).for_each(|i| size[i] += (half * w * dv * (at.x - base) * value[i]).abs() / SIZED.len() as f64);
            }
        }
        Met { sum, rise, size, within: (low, high) }
    }

    /// The part of the integral over a run that a rule misses near a kink line. There the foot of a curve beside the surface may leap over the
    /// line, or stay on it, and v changes by another amount than ∫ dv: the part is F times the difference.
    fn leap(&self, run: &Run, met: &Met<N>) -> Option<Sums<N>> {
        let kinks = self.evaluator.surface().kinks().1;
        let (base, way) = &self.ways[run.border];
        let Way::Chain(..) = way else { return None };
        if kinks.is_empty() {
            return None;
        }
        let [from, to] = [run.t.0, run.t.1].map(|t| way.at(self.evaluator, t).0);
        let missed = to.y - from.y - met.rise;
        let missed = if self.closed_v { missed - missed.round() } else { missed };
        let (low, high) = (met.within.0.y.min(from.y).min(to.y), met.within.1.y.max(from.y).max(to.y));
        let is_beside = |kink: f64| {
            let (low, high) = (low - missed.abs(), high + missed.abs());
            // The first copy of the line, by whole turns, that is not below.
            let kink = if self.closed_v { kink + (low - kink).ceil() } else { kink };
            kink >= low && kink <= high
        };
        kinks.iter().any(|kink| is_beside(*kink)).then(|| self.along_u(*base, from.midpoint(to)).map(|value| value * missed))
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
/// By Green's theorem from its borders, cut where the surface is less than analytic and halved until two rules agree, as the rows
/// from a border across are; with a plane of what lies below it alone.
pub fn trimmed_integral<const N: usize>(
    surface: &Surface,
    accuracy: f64,
    integrand: Integrand<impl Fn(&Jet2) -> Sums<N>, impl Fn(&Jet2) -> Sums<N>>,
    below: Option<Below>,
    meter: &Budget,
) -> (Sums<N>, Sums<N>) {
    let prepared = surface.prepared();
    let green = Green::new(prepared.evaluator(), accuracy, integrand, below);
    let rules = ALONG.map(|pair| pair.map(gauss_legendre));
    let open: Vec<(Run, Met<N>)> = green.runs().into_iter().map(|run| (run, green.along(&run, &rules[0][0], true))).collect();
    let scale = open.iter().fold([0.0; N], |sum: Sums<N>, (_, met)| std::array::from_fn(|i| sum[i] + met.size[i]));
    let limit = scale.map(|scale| accuracy * scale / open.len().max(1) as f64);
    let apart = |a: &Sums<N>, b: &Sums<N>| -> Sums<N> { std::array::from_fn(|i| (a[i] - b[i]).abs()) };
    let measure = |(run, met): &(Run, Met<N>)| {
        job::poll();
        let few = green.is_even(met.within).then(|| {
            let more = green.along(run, &rules[0][1], false);
            let apart = apart(&more.sum, &met.sum);
            (more, apart)
        });
        let (more, mut apart) = few.filter(|(_, off)| small(off, &limit)).unwrap_or_else(|| {
            let more = green.along(run, &rules[1][1], false);
            let apart = apart(&more.sum, &green.along(run, &rules[1][0], false).sum);
            (more, apart)
        });
        let (mut value, last) = (more.sum, run.depth >= MAX_DEPTH);
        if let Some(leap) = green.leap(run, &more) {
            // A leap stays as it is however short the run: the shortest one takes it in.
            if last {
                add(&mut value, &leap);
            } else {
                add(&mut apart, &leap.map(f64::abs));
            }
        }
        Part { value, apart, limit, last }
    };
    let halves = |(run, _): (Run, Met<N>)| {
        let middle = 0.5 * (run.t.0 + run.t.1);
        [(run.t.0, middle), (middle, run.t.1)].map(|t| {
            let half = Run { t, depth: run.depth + 1, ..run };
            (half, green.along(&half, &rules[0][0], false))
        })
    };
    let most = MOST_RUNS.max(4 * open.len());
    let (sum, mut error) = Progress::new(accuracy, scale).sum(open, (most, 2), meter, measure, halves);
    add(&mut error, &green.strips.error());
    (sum, error)
}

/// Point and first derivatives at the cost of so many units of work: nothing here takes second ones, which are left out.
fn first_jet(evaluator: Evaluator, cost: u64, u: f64, v: f64) -> Jet2 {
    work::spend(cost);
    let [p, du, dv] = evaluator.tangents(u, v);
    Jet2 { p, du, dv, ..Jet2::default() }
}

/// Where what lies between two values of a parameter is cut: at breaks, which repeat where the surface closes, as its seam does, at the
/// ends of a box with some room, and at other values.
fn cuts(breaks: &[f64], (low, high): (f64, f64), closed: bool, also: &[f64]) -> Vec<f64> {
    let (low, high) = if low < high { (low, high) } else { (0.0, 1.0) };
    let room = ROOM * (high - low);
    let (low, high) = if closed { (low - room, high + room) } else { ((low - room).max(0.0), (high + room).min(1.0)) };
    let turns = if closed { low.floor() as i64..=high.ceil() as i64 } else { 0..=0 };
    let inner = turns.flat_map(|n| breaks.iter().copied().chain([0.0]).map(move |x| x + n as f64)).chain(also.iter().copied());
    let mut stops: Vec<f64> = inner.filter(|x| *x > low && *x < high).chain([low, high]).collect();
    stops.sort_by(f64::total_cmp);
    stops.dedup();
    stops
}

/// The borders of a trimmed surface and the steps from the end of each to the start of the next, which meet within a tolerance only, each
/// with the base of its loop: an integral over a loop that is not closed depends on where its base is.
fn ways(evaluator: Evaluator, bases: &[f64]) -> Vec<(f64, Way)> {
    /// Ends farther apart in (u, v) are no ends at one place.
    const APART: f64 = 0.1;
    let surface = evaluator.surface();
    let mut all = Vec::new();
    let mut first = 0;
    for n in surface.loops() {
        let of_loop: Vec<Option<Way>> = (first..first + n).map(|k| Way::of(surface, k)).collect();
        let end = |k: usize, t: f64| of_loop[k].as_ref().map(|way| way.at(evaluator, t).0);
        let step = |k: usize| {
            let (from, to) = (end(k, 1.0)?, end((k + 1) % n, 0.0)?);
            (from != to && (to - from).abs().max_element() < APART).then(|| Way::Line(from.into(), to.into()))
        };
        let steps: Vec<Way> = (0..n).filter_map(step).collect();
        all.extend(of_loop.into_iter().flatten().chain(steps).map(|way| (bases[first], way)));
        first += n;
    }
    all
}

/// Places in (u, v) at which the borders of a trimmed surface cross a plane.
pub fn border_crossings(surface: &Surface, below: Below) -> Vec<DVec2> {
    let (evaluator, breaks, closed) = (surface.evaluator(), surface.breaks().1, surface.closed().1);
    let mut found = Vec::new();
    for way in (0..surface.n_sides()).filter_map(|k| Way::of(surface, k)) {
        let place = |t: f64| way.at(evaluator, t).0;
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
    fn at(&self, evaluator: Evaluator, t: f64) -> (DVec2, f64) {
        match self {
            Self::Line(a, b) => (DVec2::new(a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t), b.1 - a.1),
            Self::Chain(side, chain, from, to) => {
                let f = from + (to - from) * t;
                let on = chain.jet(f);
                let uv = evaluator.border_place_of(*side, f, on.p).unwrap_or_default();
                let jet = evaluator.jet(uv.0, uv.1);
                let d = on.d1 * (to - from);
                // The foot of a point that is beside the surface moves as the surface bends there.
                let off = jet.p - on.p;
                let (e, g) = (jet.du.length_squared() + off.dot(jet.duu), jet.dv.length_squared() + off.dot(jet.dvv));
                let m = jet.du.dot(jet.dv) + off.dot(jet.duv);
                let dv = (e * jet.dv.dot(d) - m * jet.du.dot(d)) / (e * g - m * m);
                (uv.into(), if dv.is_finite() { dv } else { 0.0 })
            }
        }
    }
}
