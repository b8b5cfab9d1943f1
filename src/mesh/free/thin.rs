//! Fewer triangles for the same limits: nodes are taken out for as long as the triangles that close the gap keep them.
//!
//! A node goes when the fan from one node of its rim keeps the limits by their certified bounds; what costs least goes
//! first, and between rounds edges are flipped to where the worse bound of their two triangles is smaller. Triangles
//! come out long where the surface bends one way only [decimation after Schroeder, Zarge & Lorensen 1992, with the bound
//! of `bound.rs` in place of a distance of points].

use super::outline::area2;
use super::shape::quality;
use super::web::{Patch, Ring, Web};
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::triangulate_points::NO_TRIANGLE;

/// How far three nodes of a web are from the limits as a triangle: 1 is just kept.
pub type Bound<'a> = dyn Fn(&Web, [u32; 3]) -> f64 + 'a;

/// Whether an edge between two nodes may be as long as it is.
pub type Allowed<'a> = dyn Fn(&Web, u32, u32) -> bool + 'a;

/// Rounds at most; each takes out what it can.
const ROUNDS: usize = 24;
/// Least quality of a triangle that is made: long ones are meant, needles are not.
const LEAST: f64 = 0.1;

/// What thinning asks.
pub struct Thinner<'a> {
    /// Bounds against the limits.
    pub bound: &'a Bound<'a>,
    /// Lengths.
    pub allowed: &'a Allowed<'a>,
}

/// A fan that closes the gap of a node: its cost and the rim's node it starts from.
type Fan = (f64, usize);

impl Thinner<'_> {
    /// Takes out nodes until none can go.
    pub fn thin(&self, web: &mut Web, job: &Job) -> Result<()> {
        let (mut ring, mut patch) = (Ring::default(), Patch::default());
        for _ in 0..ROUNDS {
            let mut order: Vec<(f64, u32)> = Vec::new();
            for node in web.fixed..web.p.len() as u32 {
                if let Some((cost, _)) = self.fan(web, node, (&mut ring, &mut patch)) {
                    order.push((cost, node));
                }
            }
            order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut gone = 0;
            for (_, node) in order {
                // Neighbours may have gone in between.
                if let Some((_, k)) = self.fan(web, node, (&mut ring, &mut patch)) {
                    web.refan(&patch, k);
                    gone += 1;
                }
            }
            self.flip(web);
            job.go_on()?;
            if gone == 0 {
                break;
            }
        }
        Ok(())
    }

    /// The cheapest fan in place of a node; `patch` is then what it replaces.
    fn fan(&self, web: &mut Web, node: u32, (ring, patch): (&mut Ring, &mut Patch)) -> Option<Fan> {
        if web.at[node as usize] == NO_TRIANGLE {
            return None;
        }
        web.ring(node, ring);
        if !ring.closed {
            return None;
        }
        let tri = std::mem::take(&mut ring.tri);
        let fits = web.patch(&tri, patch);
        ring.tri = tri;
        fits?;
        let n = patch.rim.len();
        let mut best: Option<Fan> = None;
        for k in 0..n {
            let most = best.map_or(1.0, |b| b.0);
            let cost = (1..n - 1).try_fold(0.0_f64, |cost, i| {
                let c = [patch.rim[k], patch.rim[(k + i) % n], patch.rim[(k + i + 1) % n]];
                let own = self.cost(web, c)?;
                // The side from the fan's start is new but for the first and the last one.
                (own < most && (i == 1 || (self.allowed)(web, c[0], c[1]))).then_some(cost.max(own))
            });
            if let Some(cost) = cost.filter(|cost| *cost < most) {
                best = Some((cost, k));
            }
        }
        best
    }

    /// The bound of a triangle that may be made; `None` where it may not.
    fn cost(&self, web: &Web, c: [u32; 3]) -> Option<f64> {
        let [x, y, z] = c.map(|n| web.xy[n as usize]);
        let [a, b, d] = c.map(|n| web.p[n as usize]);
        if area2(x, y, z) <= 0.0 || quality(a, b, d) < LEAST {
            return None;
        }
        Some((self.bound)(web, c)).filter(|bound| *bound <= 1.0)
    }

    /// Flips edges where the worse of the two bounds gets smaller.
    fn flip(&self, web: &mut Web) {
        let mut left = 4 * web.tri.len();
        let mut open: Vec<u32> = (0..web.tri.len() as u32).filter(|t| web.alive(*t)).collect();
        while let Some(t) = open.pop() {
            for k in 0..3 {
                let other = web.across[t as usize][k];
                if left == 0 || other == NO_TRIANGLE || web.locked[t as usize] >> k & 1 == 1 {
                    continue;
                }
                let c = web.tri[t as usize];
                let (a, b, d) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
                let Some(tip) = web.tri[other as usize].into_iter().find(|n| *n != b && *n != d) else { continue };
                let before = (self.bound)(web, [a, b, d]).max((self.bound)(web, [tip, d, b]));
                let after = self.cost(web, [a, b, tip]).zip(self.cost(web, [a, tip, d])).map(|(x, y)| x.max(y));
                if after.is_some_and(|after| after < GAIN * before) && (self.allowed)(web, a, tip) {
                    left -= 1;
                    web.flip(t, k);
                    open.extend([t, other]);
                    break;
                }
            }
        }
    }
}

/// A flip must lower the worse bound to this share: none goes to and fro.
const GAIN: f64 = 0.98;
