//! How a curve bends: where it begins to bend the other way, how sharply, and how much in all.

use glam::DVec3;

use crate::base::job;
use crate::base::math;
use crate::base::quadrature::kronrod;
use crate::base::tolerance::{NEAREST, NUDGE};
use crate::network::Chain;
use crate::surface::data::breaks::chain_breaks;

/// Places in each span between knots at which the curvature is looked at.
const PLACES: usize = 24;
/// Curvature less than this share of the largest one is none.
const NOTHING: f64 = 1.0 / 8192.0;
/// Halvings that narrow an inflection down.
const ROUNDS: usize = 48;
/// How often a span is halved for an integral.
const DEPTH: usize = 12;

/// The vector from a place towards the centre of curvature, as long as the curvature, 1/model unit.
fn curvature(chain: &Chain, f: f64) -> DVec3 {
    // Fractions are shares of the length: the second derivative has no part along the curve.
    chain.jet(f).d2 / (chain.length() * chain.length())
}

fn spans(chain: &Chain) -> Vec<f64> {
    [vec![0.0], chain_breaks(chain), vec![1.0]].concat()
}

/// Whether the tangent goes on from one place to another one, which is the same or the start of a closed curve.
fn goes_on(chain: &Chain, before: f64, after: f64) -> bool {
    math::angle_between(chain.jet_before(before).d1, chain.jet(after).d1) <= NUDGE
}

/// Places with their curvature, in order, in runs between corners.
fn sampled(chain: &Chain) -> Vec<Vec<(f64, DVec3)>> {
    let mut runs: Vec<Vec<(f64, DVec3)>> = Vec::new();
    for w in spans(chain).windows(2) {
        let inside = (0..PLACES).map(|k| w[0] + (w[1] - w[0]) * (k as f64 + 0.5) / PLACES as f64);
        let own = inside.map(|f| (f, curvature(chain, f)));
        match runs.last_mut().filter(|_| goes_on(chain, w[0], w[0])) {
            Some(run) => run.extend(own),
            None => runs.push(own.collect()),
        }
    }
    let closed = chain.start().distance(chain.end()) <= NEAREST * chain.length();
    if closed && goes_on(chain, 1.0, 0.0) {
        // The last run goes on in the first one, at places after 1.
        let over: Vec<(f64, DVec3)> = runs[0].iter().map(|(f, k)| (f + 1.0, *k)).collect();
        let whole = runs.len() == 1;
        if let Some(last) = runs.last_mut() {
            last.extend(over);
        }
        if !whole {
            runs.remove(0);
        }
    }
    runs
}

/// The largest curvature of a curve; 0 of one that is a point, or straight but for rounding.
pub fn largest_curvature(chain: &Chain) -> f64 {
    largest(chain, &sampled(chain))
}

fn largest(chain: &Chain, samples: &[Vec<(f64, DVec3)>]) -> f64 {
    let most = samples.iter().flatten().map(|(_, k)| k.length()).fold(0.0, f64::max);
    let point = chain.length() <= NEAREST * chain.start().abs().max_element();
    if point || most * chain.length() <= NEAREST { 0.0 } else { most }
}

/// Fractions at which a curve begins to bend the other way, ascending; corners are none. A straight part between two bends has its middle.
pub fn inflections(chain: &Chain) -> Vec<f64> {
    inflections_above(chain, NOTHING * largest_curvature(chain))
}

/// Those where it bends by more than a curvature before and after.
pub fn inflections_above(chain: &Chain, least: f64) -> Vec<f64> {
    let samples = sampled(chain);
    if largest(chain, &samples) == 0.0 {
        return Vec::new();
    }
    let at = |f: f64| curvature(chain, if f > 1.0 { f - 1.0 } else { f });
    let narrowed = |w: &[(f64, DVec3)]| {
        let (way, mut low, mut high) = (w[0].1.normalize_or_zero(), w[0].0, w[1].0);
        for _ in 0..ROUNDS {
            let middle = 0.5 * (low + high);
            let along = at(middle).dot(way);
            if along > least {
                low = middle;
            } else if along < -least {
                high = middle;
            } else {
                return middle;
            }
        }
        0.5 * (low + high)
    };
    let mut found = Vec::new();
    for run in samples {
        let bent: Vec<(f64, DVec3)> = run.into_iter().filter(|(_, k)| k.length() > least).collect();
        found.extend(bent.windows(2).filter(|w| w[0].1.dot(w[1].1) < 0.0).map(narrowed).map(|f| if f >= 1.0 { f - 1.0 } else { f }));
    }
    found.sort_by(f64::total_cmp);
    // Those of a closed curve without corners are found on both turns.
    found.dedup_by(|b, a| *b - *a <= NEAREST);
    found
}

/// ∫κ² ds of a curve without its corners, 1/model unit.
pub fn bending(chain: &Chain) -> f64 {
    fn part(chain: &Chain, from: f64, to: f64, (allowed, left): (f64, usize)) -> f64 {
        job::poll();
        let panel = kronrod(from, to, |f| curvature(chain, f).length_squared());
        if left == 0 || panel.error <= allowed {
            return panel.integral;
        }
        let middle = 0.5 * (from + to);
        part(chain, from, middle, (0.5 * allowed, left - 1)) + part(chain, middle, to, (0.5 * allowed, left - 1))
    }
    let most = largest_curvature(chain);
    if most == 0.0 {
        return 0.0;
    }
    let spans = spans(chain);
    let rough: f64 = spans.windows(2).map(|w| kronrod(w[0], w[1], |f| curvature(chain, f).length_squared()).integral).sum();
    spans.windows(2).map(|w| part(chain, w[0], w[1], (NEAREST * rough * (w[1] - w[0]), DEPTH))).sum::<f64>() * chain.length()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::base::origin::Origin;
    use crate::base::tolerance::Tolerance;
    use crate::geometry::construct::build;

    #[test]
    fn a_circle_bends_evenly_and_a_cubic_once_the_other_way() {
        let circle = Chain::of_curve(&build::circle(DVec3::ZERO, 4.0, DVec3::Z, Origin::NONE).unwrap());
        assert!(inflections(&circle).is_empty());
        assert!((bending(&circle) - 2.0 * PI / 4.0).abs() < 1e-12);
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, -2.0), (3.0, 0.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let wave = Chain::of_curve(&build::bezier(&points, None, Origin::NONE).unwrap());
        let found = inflections(&wave);
        assert!(found.len() == 1 && (found[0] - 0.5).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_straight_part_between_two_bends_is_one_inflection_in_its_middle() {
        let tolerance = Tolerance::new(1e-6, 10.0);
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let pieces = [
            build::arc_through(at(0.0, 0.0), at(2.0, 0.0), at(1.0, 1.0), Origin::NONE).unwrap(),
            build::line(at(2.0, 0.0), at(2.0, -3.0), Origin::NONE).unwrap(),
            build::arc_through(at(2.0, -3.0), at(4.0, -3.0), at(3.0, -4.0), Origin::NONE).unwrap(),
        ];
        let chains: Vec<Chain> = pieces.iter().map(Chain::of_curve).collect();
        let chain = Chain::join(&chains, Origin::NONE, &tolerance).unwrap();
        let found = inflections(&chain);
        assert!(found.len() == 1 && (chain.point(found[0]).x - 2.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_corner_is_no_inflection_and_hides_none() {
        let tolerance = Tolerance::new(1e-6, 10.0);
        let arch = |x: f64, up: f64| {
            let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
            Chain::of_curve(&build::arc_through(at(x, 0.0), at(x + 2.0, 0.0), at(x + 1.0, up), Origin::NONE).unwrap())
        };
        // Two arches side by side: at the corner between them the curvature turns, but both bend the same way.
        let row = Chain::join(&[arch(0.0, 0.5), arch(2.0, 0.5)], Origin::NONE, &tolerance).unwrap();
        assert!(inflections(&row).is_empty());
        let wave = Chain::join(&[arch(0.0, 1.0), arch(2.0, -1.0)], Origin::NONE, &tolerance).unwrap();
        assert_eq!(inflections(&wave).len(), 1);
    }

    #[test]
    fn a_closed_curve_has_as_many_wherever_it_begins() {
        // A figure of eight.
        let at = |k: usize| {
            let t = 2.0 * PI * k as f64 / 16.0;
            DVec3::new(crate::base::math::sin(2.0 * t), crate::base::math::sin(t), 0.0)
        };
        let ends = crate::geometry::construct::spline::Ends::Natural;
        let settings = crate::geometry::construct::spline::Spline { start: ends, end: ends, closed: true };
        let begun = |first: usize| {
            let points: Vec<DVec3> = (0..16).map(|k| at((k + first) % 16)).collect();
            inflections(&Chain::of_curve(&crate::geometry::construct::spline::spline(&points, &settings, Origin::NONE).unwrap())).len()
        };
        let counts: Vec<usize> = (0..16).map(begun).collect();
        assert!(counts[0] >= 2 && counts.iter().all(|n| *n == counts[0] && n.is_multiple_of(2)), "{counts:?}");
    }

    #[test]
    fn what_is_straight_but_for_rounding_bends_nowhere() {
        let points: Vec<DVec3> = (0..60).map(|k| DVec3::new(1.1, 0.7, 0.3) * f64::from(k)).collect();
        let ends = crate::geometry::construct::spline::Ends::Natural;
        let settings = crate::geometry::construct::spline::Spline { start: ends, end: ends, closed: false };
        let chain = Chain::of_curve(&crate::geometry::construct::spline::spline(&points, &settings, Origin::NONE).unwrap());
        assert_eq!((bending(&chain), inflections(&chain).len(), largest_curvature(&chain)), (0.0, 0, 0.0));
    }
}
