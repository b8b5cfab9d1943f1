//! Shapes of triangles, and the best place for a node inside a rim.

use glam::{DVec2, DVec3};

use super::ground::{Ground, foot};
use super::grow::TALL;
use super::outline::area2;

/// Twice the ratio of inscribed to circumscribed radius: 1 for an equilateral triangle, 0 for a flat one.
pub fn quality(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let (x, y, z) = (bc.length(), ca.length(), ab.length());
    let area2 = ab.cross(ca).length();
    // r = 2 A / (x + y + z), R = x y z / (4 A).
    let below = x * y * z * (x + y + z);
    if below > 0.0 { 4.0 * area2 * area2 / below } else { 0.0 }
}

/// A rim of nodes round a place to be found.
#[derive(Clone, Debug, Default)]
pub struct Rim {
    /// Points.
    pub p: Vec<DVec3>,
    /// Places in the chart.
    pub xy: Vec<DVec2>,
    /// Longest wanted edge to the place; longer ones count as worse.
    pub longest: f64,
}

/// A place inside a rim.
#[derive(Clone, Copy, Debug, Default)]
pub struct Star {
    /// The point.
    pub p: DVec3,
    /// Its place in the chart.
    pub xy: DVec2,
    /// The least quality of the triangles to the sides of the rim; negative where one is turned over.
    pub worst: f64,
}

/// Rounds of the search for the best place.
const ROUNDS: usize = 12;
/// Share of the wanted edge below which a step is not worth it.
const STILL: f64 = 0.002;
/// What the side of an equilateral triangle weighs.
const LEAST: f64 = 0.001;
/// Gain that a round must bring.
const GAIN: f64 = 0.0001;

impl Rim {
    /// Least quality of the star of a place.
    pub fn worst(&self, xy: DVec2, p: DVec3) -> f64 {
        let n = self.p.len();
        let mut worst = f64::INFINITY;
        for i in 0..n {
            let j = if i + 1 < n { i + 1 } else { 0 };
            if area2(xy, self.xy[i], self.xy[j]) <= 0.0 {
                return -1.0;
            }
            worst = worst.min(self.weigh(quality(p, self.p[i], self.p[j]), p.distance(self.p[i])));
        }
        worst
    }

    /// A quality with what an edge too long takes from it.
    fn weigh(&self, quality: f64, length: f64) -> f64 {
        if length > self.longest { quality * (self.longest / length) } else { quality }
    }

    /// Mean of the rim.
    pub fn middle(&self) -> (DVec2, DVec3) {
        let n = self.p.len() as f64;
        (self.xy.iter().copied().sum::<DVec2>() / n, self.p.iter().copied().sum::<DVec3>() / n)
    }

    /// Climbs from a place to one where the worst triangle is as good as it can be: towards the mean of the tips that the
    /// sides wish for, the worst ones first.
    pub fn best(&self, ground: &dyn Ground, from: DVec2, p: DVec3) -> Star {
        let mut star = Star { p, xy: from, worst: self.worst(from, p) };
        let n = self.p.len();
        let mut share = 1.0;
        for _ in 0..ROUNDS {
            let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
            for i in 0..n {
                let (a, b) = (self.p[i], self.p[(i + 1) % n]);
                let q = self.weigh(quality(star.p, a, b), star.p.distance(a));
                // The side's wished tip: over its middle, on the node's side.
                let side = b - a;
                let middle = 0.5 * (a + b);
                let up = (star.p - middle).reject_from(side).normalize_or_zero();
                let tip = middle + up * (TALL * side.length());
                let short = (1.0 - q).max(0.0) + LEAST;
                let weight = short * short * short * short;
                sum += tip * weight;
                weights += weight;
            }
            let wish = sum / weights - star.p;
            let step = wish * share;
            if step.length() < STILL * self.longest {
                break;
            }
            let (xy, p) = foot(ground, star.xy, star.p + step);
            let worst = self.worst(xy, p);
            if worst > star.worst + GAIN {
                star = Star { p, xy, worst };
                share = f64::min(1.0, share * 1.5);
            } else {
                share *= 0.4;
            }
        }
        star
    }
}
