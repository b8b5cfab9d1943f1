//! Curves of one parameter as splines that share their breaks, bounded from the curves everywhere.
//!
//! Breaks go where the error is largest: each round gives a span as many parts as the root of its error over the allowed
//! one says, of the order of the degree plus 1 [de Boor 1978, chapter XII]. What samples pass is then bounded: about the middle
//! of an interval of half width h the difference e is at most |e| + h |e′| there plus ½ h² times the range of e″.

use glam::DVec3;

use crate::base::range::Interval3;
use crate::base::tolerance::NUDGE;
use crate::base::{job, math, par};
use crate::geometry::Jet;
use crate::surface::analysis::as_net::splines::{Breaks, Hermite};
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;

/// What steers the fit of splines with common breaks.
struct Fitting {
    /// Places in a span at which splines are compared with their curves.
    places: [f64; 5],
    /// Share of what is allowed that samples may be off: the rest is room for the bound.
    sampled_share: f64,
    /// Rounds that place breaks anew.
    max_rounds: usize,
    /// Rounds that go all the way to what errors ask for; later ones go
    /// `damping` of it, as errors jump where breaks pass places at which derivatives do.
    undamped_rounds: usize,
    /// Share of the way that later rounds go.
    damping: f64,
    /// A span is parted into so many at most by one round; at least a quarter of one stays.
    max_parts: f64,
    /// Share of spans that each round adds: errors of neighbours are never quite equal.
    added_share: f64,
    /// Spans at most.
    max_spans: usize,
    /// Intervals of a span in which a spline is bounded, at most.
    max_intervals: usize,
    /// Width of a span, as a share of the whole, at which one knot more at a jump begins to pay.
    narrow_share: f64,
    /// Times what is allowed: what a jump does over such a span where one knot more pays.
    jump_factor: f64,
}

const FIT: Fitting = Fitting {
    places: [0.1, 0.3, 0.5, 0.7, 0.9],
    sampled_share: 0.8,
    max_rounds: 12,
    undamped_rounds: 4,
    damping: 0.6,
    max_parts: 4.0,
    added_share: 0.01,
    max_spans: 1 << 12,
    max_intervals: 1 << 11,
    narrow_share: 1.0 / 64.0,
    jump_factor: 16.0,
};

/// A curve under the surface's parameter.
pub trait Target: Sync {
    /// Point and derivatives, from the given side.
    fn jet(&self, x: f64, side: OneSided) -> Jet;
    /// Bounds between two parameters.
    fn line(&self, x0: f64, x1: f64) -> Line;
    /// Parameters of its corners, ends left out.
    fn corners(&self) -> Vec<f64>;
    /// Parameters at which it is less than smooth, ends left out, ascending.
    fn breaks(&self) -> Vec<f64>;
}

/// Curves with splines near them.
pub struct Fitted {
    /// The breaks of all.
    pub breaks: Breaks,
    /// One per curve.
    pub splines: Vec<Hermite<DVec3>>,
    /// No spline is farther from its curve than this at any parameter, model units.
    pub off: f64,
}

/// Curves that get splines.
pub struct Family<'a> {
    /// The curves.
    pub targets: Vec<Box<dyn Target + 'a>>,
    /// How far a spline may be from its curve, model units.
    pub allowed: f64,
}

impl Family<'_> {
    /// Splines over breaks that hold the given ones, of the degree that needs fewer control points; fails with a parameter about
    /// which too many would be needed.
    pub fn fitted(&self, fixed: [Breaks; 2]) -> Result<Fitted, f64> {
        let jumps = self.jumps();
        let mut best: Result<(Breaks, Spreading), f64> = Err(0.0);
        // Where third derivatives jump a knot of its own may cost more than narrow spans beside it.
        for (fixed, orders) in fixed.iter().flat_map(|fixed| [(fixed, 2), (fixed, 3)]) {
            let spreading = Spreading { family: self, fixed: with_jumps(fixed, &jumps, orders) };
            if best.as_ref().is_ok_and(|best| spreading.fixed.poles() >= best.0.poles()) {
                continue;
            }
            let placed = spreading.placed();
            best = match (best, placed) {
                (Ok(best), Ok(next)) if next.poles() >= best.0.poles() => Ok(best),
                (_, Ok(next)) => Ok((next, spreading)),
                (Err(_), Err(at)) => Err(at),
                (best, Err(_)) => best,
            };
        }
        best.and_then(|(breaks, spreading)| spreading.bounded(breaks))
    }

    /// Parameters at which derivatives jump by more than splines could follow, with how many go on.
    fn jumps(&self) -> Vec<(f64, usize)> {
        let each = par::map(self.targets.len(), |c| {
            let target = &self.targets[c];
            let corners = target.corners().into_iter().map(|x| (x, 0));
            let breaks = target.breaks();
            let wide = |k: usize| {
                let (low, high) = (if k == 0 { 0.0 } else { breaks[k - 1] }, breaks.get(k + 1).copied().unwrap_or(1.0));
                (0.25 * (breaks[k] - low).min(high - breaks[k])).clamp(NUDGE, FIT.narrow_share * FIT.narrow_share)
            };
            let jump = |k: usize| {
                let x = breaks[k];
                let (a, b, h) = (target.jet(x, OneSided::Before), target.jet(x, OneSided::After), wide(k));
                let next = (b.d2 - target.jet((x + h).min(1.0), OneSided::Before).d2) * (-1.0 / h);
                let last = (a.d2 - target.jet((x - h).max(0.0), OneSided::After).d2) * (1.0 / h);
                let limit = |order: i32| FIT.jump_factor * self.allowed / math::powi(FIT.narrow_share, order);
                let over = [a.d1.distance(b.d1) > limit(1), a.d2.distance(b.d2) > limit(2), next.distance(last) > limit(3)];
                over.iter().position(|over| *over).map(|order| (x, order))
            };
            corners.chain((0..breaks.len()).filter_map(jump)).collect::<Vec<(f64, usize)>>()
        });
        let mut all = each.concat();
        // Corners first: what lies beside one by rounding joins it.
        all.sort_by(|a, b| a.1.cmp(&b.1).then(a.0.total_cmp(&b.0)));
        all
    }
}

/// Breaks and, where derivatives jump, others across which as many go on: for jumps of an order below the given one.
fn with_jumps(fixed: &Breaks, jumps: &[(f64, usize)], orders: usize) -> Breaks {
    let mut fixed = fixed.clone();
    for (x, smooth) in jumps.iter().filter(|jump| jump.1 < orders) {
        fixed.put(*x, *smooth, if *smooth < 2 { NUDGE * FIT.narrow_share } else { NUDGE });
    }
    fixed
}

/// Breaks of one degree in the making.
struct Spreading<'f, 'a> {
    family: &'f Family<'a>,
    fixed: Breaks,
}

impl Spreading<'_, '_> {
    /// Splines whose distance is bounded; spans that are too wide are halved.
    fn bounded(&self, mut breaks: Breaks) -> Result<Fitted, f64> {
        loop {
            let splines = self.splines(&breaks);
            let off = self.off(&breaks, &splines);
            let wide: Vec<usize> = (0..off.len()).filter(|k| off[*k] > FIT.sampled_share * self.family.allowed).collect();
            if !wide.is_empty() {
                breaks = halved(breaks, &wide)?;
                continue;
            }
            let bounds = par::map(splines.len() * breaks.spans(), |n| {
                let (c, k) = (n / breaks.spans(), n % breaks.spans());
                self.bound(c, &breaks, &splines[c], k)
            });
            let most = |k: usize| bounds.iter().skip(k).step_by(breaks.spans()).copied().fold(0.0, f64::max);
            let wide: Vec<usize> = (0..breaks.spans()).filter(|k| most(*k) > self.family.allowed).collect();
            if wide.is_empty() {
                let off = bounds.into_iter().fold(0.0, f64::max);
                return Ok(Fitted { breaks, splines, off });
            }
            breaks = halved(breaks, &wide)?;
        }
    }

    /// Breaks at which samples are near enough, or nearly so.
    fn placed(&self) -> Result<Breaks, f64> {
        let mut breaks = self.fixed.clone();
        let mut best: Option<Breaks> = None;
        for round in 0..FIT.max_rounds {
            job::poll();
            let off = self.off(&breaks, &self.splines(&breaks));
            let allowed = FIT.sampled_share * self.family.allowed;
            let fits = off.iter().all(|off| *off <= allowed);
            let fewer = best.as_ref().is_none_or(|best| breaks.at.len() < best.at.len());
            if fits && fewer {
                best = Some(breaks.clone());
            } else if fits || best.is_some() {
                break;
            }
            let root = if round < FIT.undamped_rounds { 1.0 } else { FIT.damping } / (breaks.degree + 1) as f64;
            let parts: Vec<f64> = off.iter().map(|off| math::pow(off / allowed, root).clamp(1.0 / FIT.max_parts, FIT.max_parts)).collect();
            breaks = self.enclosure(&breaks, &parts, 1.0 + FIT.added_share * round as f64);
            if breaks.spans() > FIT.max_spans {
                let worst = (0..off.len()).max_by(|a, b| off[*a].total_cmp(&off[*b])).unwrap_or(0);
                return Err(worst as f64 / off.len() as f64);
            }
        }
        Ok(best.unwrap_or(breaks))
    }

    /// Fixed breaks and others between them, so that spans get equal sums of parts.
    fn enclosure(&self, breaks: &Breaks, parts: &[f64], room: f64) -> Breaks {
        let mut out = self.fixed.clone();
        for ends in self.fixed.at.windows(2) {
            let first = breaks.at.partition_point(|x| *x < ends[0]);
            let last = breaks.at.partition_point(|x| *x < ends[1]);
            let whole: f64 = parts[first..last].iter().sum();
            let n = (whole * room).ceil().max(1.0);
            let (mut sum, mut next) = (0.0, 1.0);
            for (parts, span) in parts[first..last].iter().zip(breaks.at[first..].windows(2)) {
                while next < n && next * whole / n <= sum + parts {
                    let share = (next * whole / n - sum) / parts;
                    out.put(span[0] + share * (span[1] - span[0]), usize::MAX, 0.0);
                    next += 1.0;
                }
                sum += parts;
            }
        }
        out
    }

    /// The splines through the curves at the breaks.
    fn splines(&self, breaks: &Breaks) -> Vec<Hermite<DVec3>> {
        par::map(self.family.targets.len(), |c| {
            let target = &self.family.targets[c];
            let mut spline = Hermite { value: Vec::new(), slope: Vec::new(), bend: Vec::new() };
            for (k, x) in breaks.at.iter().enumerate() {
                let after = target.jet(*x, OneSided::After);
                let before = if breaks.is_given(k) { target.jet(*x, OneSided::Before) } else { after };
                spline.value.push(after.p);
                // What goes on has one value.
                let mean = |order: usize, a: DVec3, b: DVec3| if breaks.smooth[k] < order { [a, b] } else { [0.5 * (a + b); 2] };
                spline.slope.push(mean(1, before.d1, after.d1));
                spline.bend.push(mean(2, before.d2, after.d2));
            }
            breaks.complete(&mut spline);
            spline
        })
    }

    /// Largest sampled distance in each span.
    fn off(&self, breaks: &Breaks, splines: &[Hermite<DVec3>]) -> Vec<f64> {
        let each = par::map(splines.len(), |c| {
            let at = |k: usize, share: f64| {
                let x = breaks.at[k] + share * (breaks.at[k + 1] - breaks.at[k]);
                breaks.jet(&splines[c], k, x)[0].distance(self.family.targets[c].jet(x, OneSided::After).p)
            };
            (0..breaks.spans()).map(|k| FIT.places.map(|share| at(k, share)).into_iter().fold(0.0, f64::max)).collect::<Vec<f64>>()
        });
        (0..breaks.spans()).map(|k| each.iter().map(|off| off[k]).fold(0.0, f64::max)).collect()
    }

    /// Bound of the distance of a spline from its curve over a span; more than allowed where it may be more.
    fn bound(&self, c: usize, breaks: &Breaks, spline: &Hermite<DVec3>, k: usize) -> f64 {
        let mut open = vec![(breaks.at[k], breaks.at[k + 1])];
        let (mut seen, mut largest) = (0, 0.0_f64);
        while let Some((a, b)) = open.pop() {
            job::poll();
            let (middle, h) = (0.5 * (a + b), 0.5 * (b - a));
            let line = self.family.targets[c].line(a, b);
            let [p, slope, ..] = breaks.jet(spline, k, middle);
            let off = line.mid.p.distance(p);
            // A second derivative lies between those at the ends but for what it bends itself: linearly, of degree 5.
            let ends = [a, b].map(|x| breaks.jet(spline, k, x));
            let own = ends[0][4].abs().max(ends[1][4].abs()) * (0.5 * h * h);
            let bend = line.d2 - (Interval3::of(ends.map(|jet| jet[2])) + Interval3::around_zero(own));
            let most = if bend.is_unbounded() { f64::INFINITY } else { off + h * line.mid.d1.distance(slope) + 0.5 * h * h * bend.reach() };
            if most <= self.family.allowed {
                largest = largest.max(most);
                continue;
            }
            seen += 1;
            if off > self.family.allowed || seen + open.len() > FIT.max_intervals {
                return f64::INFINITY;
            }
            open.push((middle, b));
            open.push((a, middle));
        }
        largest
    }
}

/// These spans in two; the parameter of the first one where there would be too many.
fn halved(mut breaks: Breaks, spans: &[usize]) -> Result<Breaks, f64> {
    if breaks.spans() + spans.len() > FIT.max_spans {
        return Err(breaks.at[spans[0]]);
    }
    for k in spans.iter().rev() {
        let middle = 0.5 * (breaks.at[*k] + breaks.at[*k + 1]);
        breaks.at.insert(k + 1, middle);
        breaks.smooth.insert(k + 1, breaks.degree - 1);
    }
    Ok(breaks)
}
