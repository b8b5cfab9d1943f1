//! Which of two ways neighbouring rings run: transported from one to the other along the curves that cross both.
//!
//! A ring that at most two curves cross is split by them into two arcs of equal standing. Which arc of the next ring goes
//! on which follows from the vectors from one arc to the other, transported along the crossing curves without turning about
//! them. Places in space would not do: a profile that winds about its guide has its upper side below within half a turn.

use glam::DVec3;

use super::chain::Chain;
use super::flow_detection::{Passage, Ring};
use crate::base::math;
use crate::base::tolerance::Tolerance;

/// Places on an arc at which the vectors are compared.
const SAMPLES: usize = 8;
/// Steps in which a vector is transported along a curve.
const STEPS: usize = 64;

/// Whether two neighbouring rings run the same way; the answer is the same with the two exchanged and each turned round.
pub fn same_way(chains: &[Chain], a: &Ring, b: &Ring, tolerance: &Tolerance) -> bool {
    let (from, to) = (across(&chains[a.curve], &a.passages), across(&chains[b.curve], &b.passages));
    let likeness = |p: &Passage, q: &Passage| -> f64 {
        let transport = Transport::new(&chains[p.by], (p.there, q.there), tolerance);
        from.iter().zip(&to).map(|(x, y)| transport.vector(*x).dot(*y)).sum()
    };
    a.passages.iter().zip(&b.passages).map(|(p, q)| likeness(p, q)).sum::<f64>() >= 0.0
}

/// The vectors from the arc that begins a ring to the one that ends it, at equal shares of both, from the first passage on.
fn across(ring: &Chain, passages: &[Passage]) -> Vec<DVec3> {
    let start = passages.first().map_or(0.0, |p| p.at);
    let first = passages.get(1).map_or(0.5, |p| (p.at - start).rem_euclid(1.0));
    let at = |f: f64| ring.point((start + f).rem_euclid(1.0));
    let shares = (1..SAMPLES).map(|i| i as f64 / SAMPLES as f64);
    shares.map(|x| at(1.0 - (1.0 - first) * x) - at(first * x)).collect()
}

/// Carrying of vectors along a curve by the least rotations that turn tangent into tangent.
struct Transport(Vec<(DVec3, DVec3)>);

impl Transport {
    /// Along the curve between two fractions; over the shorter part of a closed one.
    fn new(chain: &Chain, (from, to): (f64, f64), tolerance: &Tolerance) -> Self {
        let straight = to - from;
        let by = if chain.is_closed(tolerance) && straight.abs() > 0.5 { straight - straight.signum() } else { straight };
        let middles = (0..STEPS).map(|k| (from + by * (k as f64 + 0.5) / STEPS as f64).rem_euclid(1.0));
        let tangents: Vec<DVec3> = middles.filter_map(|f| math::unit(chain.jet(f).d1, 0.0)).collect();
        Self(tangents.windows(2).map(|w| (w[0], w[1])).collect())
    }

    fn vector(&self, v: DVec3) -> DVec3 {
        self.0.iter().fold(v, |v, &(a, b)| {
            let (axis, cosine) = (a.cross(b), a.dot(b));
            // Tangents that turn round in one step say nothing of an axis.
            if cosine <= -0.5 { v } else { v * cosine + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine)) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build;

    /// Flat rings on an arc in the plane x = 0, the second one turned by 150° about its normal.
    #[test]
    fn rings_on_a_bent_guide_keep_their_upper_side() {
        let line = |points: &[DVec3]| Chain::of_curve(&build::polyline(points, false, Origin::NONE).unwrap());
        let radial = |degrees: f64, r: f64, x: f64| {
            let (s, c) = math::sin_cos(degrees.to_radians());
            DVec3::new(x, r * c, r * s)
        };
        let guide = |x: f64| line(&(0..=15).map(|k| radial(10.0 * f64::from(k), 5.0, x)).collect::<Vec<_>>());
        let ring = |degrees: f64, way: f64| {
            line(&[
                radial(degrees, 5.0, 0.0),
                radial(degrees, 5.0 + 0.2 * way, 1.0),
                radial(degrees, 5.0, 2.0),
                radial(degrees, 5.0 - 0.2 * way, 1.0),
                radial(degrees, 5.0, 0.0),
            ])
        };
        let tolerance = Tolerance::new(1e-6, 10.0);
        let passages = |there: f64| vec![Passage { at: 0.0, by: 2, there }, Passage { at: 0.5, by: 3, there }];
        let of = |curve: usize, there: f64| Ring { curve, passages: passages(there) };
        for (way, same) in [(1.0, true), (-1.0, false)] {
            let chains = [ring(0.0, 1.0), ring(150.0, way), guide(0.0), guide(2.0)];
            let (a, b) = (of(0, 0.0), of(1, 1.0));
            assert_eq!(same_way(&chains, &a, &b, &tolerance), same);
            assert_eq!(same_way(&chains, &b, &a, &tolerance), same);
        }
    }
}
