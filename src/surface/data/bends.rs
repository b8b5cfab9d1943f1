//! How a curve bends: where it begins to bend the other way, how sharply, and how much in all.

use glam::DVec3;

use crate::base::quadrature::kronrod;
use crate::base::tolerance::NEAREST;
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

/// Places with their curvature, in order.
fn sampled(chain: &Chain) -> Vec<(f64, DVec3)> {
    let inside = |w: &[f64]| {
        let (from, to) = (w[0], w[1]);
        (0..PLACES).map(move |k| from + (to - from) * (k as f64 + 0.5) / PLACES as f64).collect::<Vec<f64>>()
    };
    spans(chain).windows(2).flat_map(inside).map(|f| (f, curvature(chain, f))).collect()
}

fn largest(samples: &[(f64, DVec3)]) -> f64 {
    samples.iter().map(|(_, k)| k.length()).fold(0.0, f64::max)
}

/// The least radius of the bends of a curve, model units; infinite where it is straight.
pub fn least_radius(chain: &Chain) -> f64 {
    largest(&sampled(chain)).recip()
}

/// Fractions at which a curve begins to bend the other way, ascending; corners are none. A straight part between two bends has its middle.
pub fn inflections(chain: &Chain) -> Vec<f64> {
    inflections_above(chain, NOTHING)
}

/// Those where it bends by more than a share of its largest curvature before and after.
pub fn inflections_above(chain: &Chain, share: f64) -> Vec<f64> {
    let samples = sampled(chain);
    let most = largest(&samples);
    // A curve that is a point, or straight but for rounding, bends nowhere.
    if most * chain.length() <= NEAREST || chain.length() <= NEAREST * chain.start().abs().max_element() {
        return Vec::new();
    }
    let bent: Vec<(f64, DVec3)> = samples.into_iter().filter(|(_, k)| k.length() > share * most).collect();
    let turned = bent.windows(2).filter(|w| w[0].1.dot(w[1].1) < 0.0);
    let narrowed = |w: &[(f64, DVec3)]| {
        let (way, mut low, mut high) = (w[0].1, w[0].0, w[1].0);
        for _ in 0..ROUNDS {
            let middle = 0.5 * (low + high);
            let along = curvature(chain, middle).dot(way);
            if along > NOTHING * most * way.length() {
                low = middle;
            } else if along < -NOTHING * most * way.length() {
                high = middle;
            } else {
                return middle;
            }
        }
        0.5 * (low + high)
    };
    turned.map(narrowed).collect()
}

/// ∫κ² ds of a curve without its corners, 1/model unit.
pub fn bending(chain: &Chain) -> f64 {
    fn part(chain: &Chain, from: f64, to: f64, left: usize) -> f64 {
        let panel = kronrod(from, to, |f| curvature(chain, f).length_squared());
        if left == 0 || panel.error <= NEAREST * panel.integral {
            return panel.integral;
        }
        let middle = 0.5 * (from + to);
        part(chain, from, middle, left - 1) + part(chain, middle, to, left - 1)
    }
    spans(chain).windows(2).map(|w| part(chain, w[0], w[1], DEPTH)).sum::<f64>() * chain.length()
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
    fn a_straight_part_between_two_bends_is_one_inflection_and_a_corner_none() {
        let tolerance = Tolerance::new(1e-6, 10.0);
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let pieces = [
            build::arc_through(at(0.0, 0.0), at(2.0, 0.0), at(1.0, 1.0), Origin::NONE).unwrap(),
            build::line(at(2.0, 0.0), at(2.0, -3.0), Origin::NONE).unwrap(),
            build::arc_through(at(2.0, -3.0), at(4.0, -3.0), at(3.0, -4.0), Origin::NONE).unwrap(),
        ];
        let chains: Vec<Chain> = pieces.iter().map(Chain::of_curve).collect();
        let found = inflections(&Chain::join(&chains, Origin::NONE, &tolerance).unwrap());
        assert_eq!(found.len(), 1);
        let corner = build::polyline(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(2.0, 1.0)], false, Origin::NONE).unwrap();
        assert!(inflections(&Chain::of_curve(&corner)).is_empty());
    }
}
