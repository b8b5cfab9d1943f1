//! Points at even arc lengths on curves, as many on each, so that the splines through them keep to the curves [P3 §4].

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::job;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::spline::{Ends, Spacing, open_slopes, through};
use crate::geometry::shapes::nurbs::Nurbs;
use crate::network::Chain;
use crate::surface::faults::DeviationFault;

/// Points on one curve at most.
pub const MOST: usize = 2000;
/// How much faster than by one the number grows.
const GROWTH: f64 = 1.25;
/// Places in each span that are looked at.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
/// Share of its arc that the chord of a span has at least, where these places are enough.
const LEAST_CHORD: f64 = 0.8;
/// Steps to the nearest point of the spline.
const STEPS: usize = 4;

/// A curve with the fractions of its ends and kinks.
struct Border<'a> {
    chain: &'a Chain,
    corners: Vec<f64>,
}

/// The largest deviation of a spline from its curve, and where on the curve.
#[derive(Clone, Copy)]
struct Worst {
    off: f64,
    at: DVec3,
}

/// Equally many points on each of some curves: the fewest, `least` or more, with which the cubic splines through them are within `within`
/// of the curves. Kinks are among the points; between ends and kinks points are at equal arc lengths, and a spline of chord lengths with
/// Bessel ends is meant. Spans are looked at in three places.
///
/// Fails with E654 where 2000 points are not enough.
pub fn even_points(chains: &[Chain], within: f64, least: usize, tolerance: &Tolerance) -> Result<Vec<Vec<DVec3>>> {
    let borders: Vec<Border> = chains.iter().map(|chain| Border { chain, corners: corners(chain, tolerance) }).collect();
    let fewest = borders.iter().map(|b| b.corners.len()).fold(least.max(2), usize::max);
    let holds = |count: usize| borders.iter().all(|b| b.worst(count).off <= within);
    // The largest number known to be too small, and one that will do.
    let (mut low, mut high) = (fewest - 1, fewest);
    while !holds(high) {
        if high >= MOST {
            let found = borders.iter().map(|b| (b.chain, b.worst(high)));
            let worst = found.reduce(|a, b| if b.1.off > a.1.off { b } else { a });
            let (of, off, at) = worst.map_or((Default::default(), 0.0, DVec3::ZERO), |(chain, w)| (chain.origin(), w.off, w.at));
            return Err(DeviationFault::BorderNotResolved { border: of, off, at, within, points: high }.into());
        }
        low = high;
        high = ((high as f64 * GROWTH).ceil() as usize).min(MOST);
    }
    while high - low > 1 {
        let middle = low.midpoint(high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(borders.iter().map(|b| b.runs(high).concat_points()).collect())
}

/// The ends and the kinks of a curve, as ascending fractions.
fn corners(chain: &Chain, tolerance: &Tolerance) -> Vec<f64> {
    let kinks = chain.kinks(tolerance).into_iter().filter(|f| *f > 0.0 && *f < 1.0);
    let mut all: Vec<f64> = [0.0].into_iter().chain(kinks).chain([1.0]).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Points of a curve from corner to corner, with their fractions; neighbours share the corner.
struct Runs(Vec<Vec<(f64, DVec3)>>);

impl Runs {
    fn concat_points(&self) -> Vec<DVec3> {
        let inner = self.0.iter().flat_map(|run| run.iter().take(run.len() - 1));
        let last = self.0.last().and_then(|run| run.last());
        inner.chain(last).map(|place| place.1).collect()
    }
}

impl Border<'_> {
    /// `count` points, one or more spans from corner to corner, the others to the run with the longest spans, the first of several.
    fn runs(&self, count: usize) -> Runs {
        let lengths: Vec<f64> = self.corners.windows(2).map(|f| f[1] - f[0]).collect();
        let free = count - 1 - lengths.len();
        let mut spans: Vec<usize> = lengths.iter().map(|length| 1 + (length * free as f64).floor() as usize).collect();
        for _ in spans.iter().sum::<usize>()..count - 1 {
            let longest = (0..spans.len()).reduce(|a, b| {
                let length = |k: usize| lengths[k] / spans[k] as f64;
                if length(b) > length(a) { b } else { a }
            });
            if let Some(k) = longest {
                spans[k] += 1;
            }
        }
        let run = |k: usize| {
            let (from, to) = (self.corners[k], self.corners[k + 1]);
            let place = |i: usize| if i == spans[k] { to } else { from + (to - from) * (i as f64 / spans[k] as f64) };
            (0..=spans[k]).map(|i| (place(i), self.chain.point(place(i)))).collect()
        };
        Runs((0..spans.len()).map(run).collect())
    }

    /// The largest deviation of the splines through `count` points.
    fn worst(&self, count: usize) -> Worst {
        let mut worst = Worst { off: 0.0, at: self.chain.start() };
        for run in &self.runs(count).0 {
            job::poll();
            let points: Vec<DVec3> = run.iter().map(|place| place.1).collect();
            let spans = Spacing::Chord.spans(&points);
            if spans.contains(&0.0) {
                // Points that are one: no spline goes through them.
                return Worst { off: f64::INFINITY, at: points[0] };
            }
            let ends = [Ends::Bessel.first(&points, &spans), Ends::Bessel.last(&points, &spans)];
            let spline = through(&points, &spans, &open_slopes(&points, &spans, ends));
            let mut from = 0.0;
            for (pair, span) in run.windows(2).zip(&spans) {
                // A curve much longer than its chord may pass through all the places by chance: what its length allows counts then.
                let arc = (pair[1].0 - pair[0].0) * self.chain.length();
                if *span < LEAST_CHORD * arc {
                    let bound = 0.5 * (arc * arc - span * span).sqrt();
                    if bound > worst.off {
                        worst = Worst { off: bound, at: self.chain.point(0.5 * (pair[0].0 + pair[1].0)) };
                    }
                }
                for share in PLACES {
                    let p = self.chain.point(pair[0].0 + (pair[1].0 - pair[0].0) * share);
                    let off = distance(&spline, p, (from, from + span), share);
                    if off > worst.off {
                        worst = Worst { off, at: p };
                    }
                }
                from += span;
            }
        }
        worst
    }
}

/// The distance of a point from a span of a spline, from a share of the span on.
fn distance(spline: &Nurbs, p: DVec3, (from, to): (f64, f64), share: f64) -> f64 {
    let mut t = from + (to - from) * share;
    let mut best = spline.jet(t).p.distance(p);
    for _ in 0..STEPS {
        let jet = spline.jet(t);
        let speed = jet.d1.length_squared();
        if speed == 0.0 {
            break;
        }
        t = (t + (p - jet.p).dot(jet.d1) / speed).clamp(from, to);
        best = best.min(spline.jet(t).p.distance(p));
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build;

    /// Two points of a helix, and what lies a quarter between them, are on one line after whole turns.
    #[test]
    fn turns_are_not_passed_over() {
        let tolerance = Tolerance::new(1e-4, 0.1);
        let coil = |turns: f64| Chain::of_curve(&build::helix(DVec3::ZERO, DVec3::Z, DVec3::X, 0.3, turns, Origin::NONE).unwrap());
        assert!(even_points(&[coil(4.0)], 1e-3, 2, &tolerance).unwrap()[0].len() > 30);
        assert!(even_points(&[coil(2000.0)], 1e-3, 2, &tolerance).is_err());
    }

    #[test]
    fn corners_are_kept_and_counts_are_equal() {
        let tolerance = Tolerance::new(1e-4, 0.1);
        let corner = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 3.0, 0.0)];
        let bent = build::polyline(&corner, false, Origin::NONE).unwrap();
        let arc = build::arc_through(DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0), Origin::NONE).unwrap();
        let chains = [Chain::of_curve(&bent), Chain::of_curve(&arc)];
        let found = even_points(&chains, 1e-4, 2, &tolerance).unwrap();
        assert_eq!(found[0].len(), found[1].len());
        assert!(found[0].contains(&DVec3::X));
        assert!(found[1].len() > 8 && found[1].len() < 40, "{}", found[1].len());
    }
}
