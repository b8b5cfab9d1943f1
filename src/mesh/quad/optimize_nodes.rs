//! Nodes moved to where the worst of the elements round them is best.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::work;
use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::net::Net;
use crate::mesh::quad::settings::SMOOTHING;
use crate::mesh::quad::smooth::{NodePosition, Smoother};

/// The quality of some faces of a net together.
pub type Score<'a> = dyn Fn(&Net, &[u32]) -> f64 + 'a;

impl Smoother<'_> {
    /// Moves corners of elements below `wanted` to where the worst element round them is best, the worst ones first, for so
    /// many rounds at most.
    pub fn repair(&mut self, wanted: f64, rounds: usize, job: &Job) -> Result<()> {
        // Nodes round which nothing moved since they were tried: they would stay where they are once more.
        let mut tried = vec![false; self.net.p.len()];
        let least = self.least();
        for _ in 0..rounds {
            let changed = |f: &usize| self.net.corners(*f).iter().any(|n| self.fresh[*n as usize]);
            let quality = (0..self.net.face.len()).filter(changed).map(|f| (self.quality(f), f));
            let mut bad: Vec<(f64, usize)> = quality.filter(|(q, _)| *q < wanted).collect();
            bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut gained = false;
            for (_, f) in bad {
                job.go_on()?;
                for n in self.net.face[f] {
                    if n == NONE || n < self.net.fixed || tried[n as usize] || self.quality(f) >= wanted {
                        continue;
                    }
                    let before = self.net.xy[n as usize];
                    gained |= self.climb(n as usize, &least, f64::INFINITY);
                    tried[n as usize] = true;
                    if self.net.xy[n as usize] != before {
                        let round = self.faces(n as usize).iter().flat_map(|f| self.net.corners(*f as usize));
                        round.for_each(|n| tried[*n as usize] = false);
                    }
                }
            }
            if !gained {
                break;
            }
        }
        Ok(())
    }

    /// Searches round a node for the place where the `score` of the faces round it is largest, or `enough`; whether it moved.
    pub fn climb(&mut self, node: usize, score: &Score, enough: f64) -> bool {
        work::spend(SMOOTHING.search_work);
        let size = self.mean_side(node);
        let start = score(self.net, self.faces(node));
        let (mut best, mut place) = (start, self.place(node));
        let mut reach = SMOOTHING.search_steps.end;
        while reach > SMOOTHING.search_steps.start && best < enough {
            let (ahead, aside) = self.frame(node, place);
            let (mut found, short) = (false, self.shortest(node).min(SMOOTHING.min_side * size));
            for (x, y) in EIGHT {
                let trial = self.foot(node, place.p + (ahead * x + aside * y) * (reach * size));
                self.put(node, trial);
                let now = score(self.net, self.faces(node));
                if now > best + SMOOTHING.min_gain * reach && self.shortest(node) >= short {
                    (best, place, found) = (now, trial, true);
                    break;
                }
            }
            self.put(node, place);
            if !found {
                reach *= 0.5;
            }
        }
        if best > start + SMOOTHING.min_gain {
            self.settle(node);
        }
        best > start + SMOOTHING.min_gain
    }

    /// Two directions along the surface, the first towards a neighbour.
    fn frame(&self, node: usize, place: NodePosition) -> (DVec3, DVec3) {
        let normal = if place.normal == DVec3::ZERO { DVec3::Z } else { place.normal };
        let c = self.faces(node).first().map_or(&[][..], |f| self.net.corners(*f as usize));
        let next = c.iter().position(|c| *c as usize == node).map_or(node, |k| c[(k + 1) % c.len()] as usize);
        let ahead = (self.net.p[next] - place.p).reject_from_normalized(normal).try_normalize();
        let ahead = ahead.unwrap_or_else(|| normal.any_orthonormal_vector());
        (ahead, normal.cross(ahead))
    }

    /// Mean length of the sides round a node.
    fn mean_side(&self, node: usize) -> f64 {
        let (mut sum, mut n) = (0.0, 0.0);
        for f in self.faces(node) {
            let c = self.net.corners(*f as usize);
            if let Some(k) = c.iter().position(|c| *c as usize == node) {
                sum += self.net.p[node].distance(self.net.p[c[(k + 1) % c.len()] as usize]);
                n += 1.0;
            }
        }
        sum / n
    }
}

/// Directions of a search.
const EIGHT: [(f64, f64); 8] = {
    const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [
        (1.0, 0.0),
        (-1.0, 0.0),
        (0.0, 1.0),
        (0.0, -1.0),
        (DIAGONAL, DIAGONAL),
        (-DIAGONAL, -DIAGONAL),
        (DIAGONAL, -DIAGONAL),
        (-DIAGONAL, DIAGONAL),
    ]
};
