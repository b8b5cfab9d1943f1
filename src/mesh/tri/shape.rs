//! Shapes of triangles, and the best place for a node inside a rim.

use glam::{DVec2, DVec3};

use crate::mesh::chart::outline::area2;
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::request::plan::TALL;
use crate::mesh::tri::optimize_settings::STAR_SEARCH;

/// Twice the ratio of inscribed to circumscribed radius: 1 for an equilateral triangle, 0 for a flat one.
pub fn quality(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let (x, y, z) = (bc.length(), ca.length(), ab.length());
    let square = ab.cross(ca).length_squared();
    // r = 2 A / (x + y + z), R = x y z / (4 A).
    let below = x * y * z * (x + y + z);
    if below > 0.0 { 4.0 * square / below } else { 0.0 }
}

/// A rim of nodes round a place to be found.
#[derive(Clone, Debug, Default)]
pub struct PatchRim {
    /// Points.
    p: Vec<DVec3>,
    /// Places in the chart.
    xy: Vec<DVec2>,
    /// Length of the side from each point to the next.
    sides: Vec<f64>,
    /// The quality of the triangle over each side at the last call of [`PatchRim::worst`].
    weighed: Vec<f64>,
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

impl PatchRim {
    /// Other nodes round it, with their places in the chart.
    pub fn fill(&mut self, nodes: impl Iterator<Item = (DVec3, DVec2)>) {
        self.p.clear();
        self.xy.clear();
        self.sides.clear();
        for (p, xy) in nodes {
            if let Some(last) = self.p.last() {
                self.sides.push(last.distance(p));
            }
            self.p.push(p);
            self.xy.push(xy);
        }
        if let (Some(first), Some(last)) = (self.p.first(), self.p.last()) {
            self.sides.push(last.distance(*first));
        }
        self.weighed.clear();
        self.weighed.resize(self.p.len(), 0.0);
    }

    /// Points round it.
    pub fn points(&self) -> &[DVec3] {
        &self.p
    }

    /// Their places in the chart.
    pub fn places(&self) -> &[DVec2] {
        &self.xy
    }

    /// Least quality of the star of a place; −1 where a triangle is turned over in the chart. Over a side whose ends are one point,
    /// as at a pole, there is no triangle in space.
    pub fn worst(&mut self, xy: DVec2, p: DVec3) -> f64 {
        let n = self.p.len();
        let (mut worst, mut turned) = (f64::INFINITY, false);
        let (mut before, mut far) = match self.p.last() {
            Some(last) => (n - 1, p.distance(*last)),
            None => return worst,
        };
        for i in 0..n {
            turned |= area2(xy, self.xy[before], self.xy[i]) <= 0.0;
            let (near, side) = (p.distance(self.p[i]), self.sides[before]);
            // As `quality`, of known lengths.
            let square = (self.p[before] - p).cross(self.p[i] - p).length_squared();
            let below = near * far * side * (near + far + side);
            let quality = if side == 0.0 {
                1.0
            } else if below > 0.0 {
                4.0 * square / below
            } else {
                0.0
            };
            let weighed = self.weigh(quality, far);
            self.weighed[before] = weighed;
            worst = worst.min(weighed);
            (before, far) = (i, near);
        }
        if turned { -1.0 } else { worst }
    }

    /// A quality with what an edge too long takes from it.
    fn weigh(&self, quality: f64, length: f64) -> f64 {
        if length > self.longest { quality * (self.longest / length) } else { quality }
    }

    /// An upper bound of the worst quality of a star inside, where the rim lies in a plane: a corner falls into two angles of which one is at most
    /// half of it and the other at least, and the best triangle with an angle α has two sides alike beside it, 4 sin(α/2) (1 − sin(α/2)).
    /// On a bent surface it is a guess.
    pub fn ceiling(&self) -> f64 {
        let n = self.p.len();
        let mut ceiling = 1.0_f64;
        for b in 0..n {
            let (a, c) = (if b > 0 { b - 1 } else { n - 1 }, if b + 1 < n { b + 1 } else { 0 });
            // At a pole two places are one point.
            if self.sides[a] > 0.0 && self.sides[b] > 0.0 && area2(self.xy[a], self.xy[b], self.xy[c]) > 0.0 {
                let cosine = (self.p[a] - self.p[b]).dot(self.p[c] - self.p[b]) / (self.sides[a] * self.sides[b]);
                let half = (0.5 + 0.5 * cosine).max(0.0).sqrt();
                let quarter = (0.5 - 0.5 * half).max(0.0).sqrt();
                ceiling = ceiling.min(4.0 * quarter * (1.0 - quarter));
            }
        }
        ceiling
    }

    /// Mean of the rim.
    pub fn middle(&self) -> (DVec2, DVec3) {
        let n = self.p.len() as f64;
        (self.xy.iter().copied().sum::<DVec2>() / n, self.p.iter().copied().sum::<DVec3>() / n)
    }

    /// Climbs from a place to one where the worst triangle is as good as it can be. On the way the surface is approximated by its
    /// derivatives at the start; where that is too inaccurate, the search starts again from the end.
    pub fn best(&mut self, chart_surface: &dyn ParametricSurface, from: DVec2, p: DVec3) -> Star {
        let mut star = Star { p, xy: from, worst: self.worst(from, p) };
        for _ in 0..STAR_SEARCH.max_starts {
            let seen = self.climb(chart_surface, star);
            if seen.xy == star.xy {
                break;
            }
            let truly = |xy: DVec2| {
                let p = chart_surface.point(xy);
                Star { p, xy, worst: self.worst(xy, p) }
            };
            // Where it is no better, half the way may be.
            let places = [seen.xy, chart_surface.clamp(0.5 * (star.xy + seen.xy))].into_iter();
            let Some(there) = places.map(truly).find(|there| there.worst > star.worst) else { break };
            star = there;
            if (star.worst - seen.worst).abs() <= STAR_SEARCH.max_prediction_error {
                break;
            }
        }
        star
    }

    /// Steps towards the mean of the tips that the sides demand, weighted by how bad they are.
    fn climb(&mut self, chart_surface: &dyn ParametricSurface, mut star: Star) -> Star {
        let from = star.xy;
        let expansion = chart_surface.expansion(from);
        let mut spot = expansion.spot(DVec2::ZERO);
        let mut demand = self.demand(star.p);
        let mut share = 1.0;
        for _ in 0..STAR_SEARCH.max_steps {
            let step = demand * share;
            if step.length() < STAR_SEARCH.min_step * self.longest {
                break;
            }
            let Some(way) = spot.step(step) else { break };
            let xy = chart_surface.clamp(star.xy + way);
            let new = expansion.spot(xy - from);
            let worst = self.worst(xy, new.p);
            if worst > star.worst + STAR_SEARCH.min_gain {
                star = Star { p: new.p, xy, worst };
                (spot, demand) = (new, self.demand(new.p));
                share = f64::min(1.0, share * 1.5);
            } else {
                share *= 0.4;
            }
        }
        star
    }

    /// Where the sides want a place to go that was weighed just now: to the tips of their equilateral triangles, the worst
    /// sides more than others.
    pub fn demand(&self, p: DVec3) -> DVec3 {
        let n = self.p.len();
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for i in 0..n {
            let j = if i + 1 < n { i + 1 } else { 0 };
            let (a, b, length) = (self.p[i], self.p[j], self.sides[i]);
            if length == 0.0 {
                continue;
            }
            // Over the middle of the side, where the place is.
            let (side, middle) = (b - a, 0.5 * (a + b));
            let off = p - middle;
            let up = (off - side * (off.dot(side) / (length * length))).normalize_or_zero();
            let short = (1.0 - self.weighed[i]).max(0.0) + STAR_SEARCH.min_weight;
            let weight = short * short * short * short;
            sum += (middle + up * (TALL * length)) * weight;
            weights += weight;
        }
        sum / weights - p
    }
}
