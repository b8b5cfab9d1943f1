//! Long sides shortened at the cost of their neighbours.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::math::angle_between;
use crate::mesh::quad::net::Net;
use crate::mesh::quad::settings::SMOOTHING;
use crate::mesh::quad::smooth::Smoother;

/// Lengths of sides over what is allowed.
pub struct Sides<'a> {
    /// Of the side between two nodes.
    pub over: &'a dyn Fn(&Net, usize, usize) -> f64,
    /// Length up to which a side is allowed anywhere, model units; 0 where none is known.
    pub always: f64,
}

impl Smoother<'_> {
    /// Shortens long sides at the cost of their neighbours: nodes move towards those they are too far from, while elements keep a least
    /// quality.
    pub fn even_out(&mut self, sides: &Sides, rounds: usize, job: &Job) -> Result<()> {
        self.active.copy_from_slice(&self.fresh);
        for _ in 0..rounds {
            let mut moved = false;
            for node in self.net.fixed as usize..self.net.p.len() {
                if node % SMOOTHING.nodes_per_check == 0 {
                    job.go_on()?;
                }
                if std::mem::take(&mut self.active[node])
                    && self.has_longer(node, SMOOTHING.max_side_ratio * sides.always)
                    && self.pull(node, sides)
                {
                    moved = true;
                    self.settle(node);
                }
            }
            if !moved {
                break;
            }
        }
        Ok(())
    }

    /// Ends of the sides at a node.
    pub(super) fn neighbours(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        self.faces(node).iter().filter_map(move |f| {
            let c = self.net.corners(*f as usize);
            c.iter().position(|c| *c as usize == node).map(|k| c[(k + 1) % c.len()] as usize)
        })
    }

    /// Sum of the angles of the faces at a node, radians.
    pub(super) fn angle_round(&self, node: usize) -> f64 {
        let net = &*self.net;
        let angle = |f: &u32| {
            let c = net.corners(*f as usize);
            let k = c.iter().position(|n| *n as usize == node)?;
            let side = |i: usize| net.p[c[(k + i) % c.len()] as usize] - net.p[node];
            Some(angle_between(side(1), side(c.len() - 1)))
        };
        self.faces(node).iter().filter_map(angle).sum()
    }

    /// The shortest side at a node.
    pub(super) fn shortest(&self, node: usize) -> f64 {
        self.neighbours(node).map(|other| self.net.p[node].distance(self.net.p[other])).fold(f64::INFINITY, f64::min)
    }

    /// Whether a side at a node is longer than that.
    fn has_longer(&self, node: usize, length: f64) -> bool {
        self.neighbours(node).any(|other| self.net.p[node].distance_squared(self.net.p[other]) > length * length)
    }

    /// One move of a node with a long side.
    fn pull(&mut self, node: usize, sides: &Sides) -> bool {
        let tension = |net: &Net, other: usize| (sides.over)(net, node, other);
        let (mut sum, mut weights, mut most) = (DVec3::ZERO, 0.0, 0.0_f64);
        for other in self.neighbours(node) {
            let t = tension(self.net, other);
            let weight = t * t * t * t * t * t;
            most = most.max(t);
            sum += self.net.p[other] * weight;
            weights += weight;
        }
        if most <= SMOOTHING.max_side_ratio {
            return false;
        }
        let strain =
            |this: &Self| this.neighbours(node).map(|other| tension(this.net, other)).map(|t| t * t * t * t * t * t * t * t).sum::<f64>();
        let (start, before, worst) = (self.place(node), strain(self), self.worst(node));
        let short = self.shortest(node).min(SMOOTHING.min_side * self.net.size[node]);
        let mut step = sum / weights - start.p;
        for _ in 0..3 {
            let place = self.foot(node, start.p + step);
            self.put(node, place);
            if strain(self) < before * (1.0 - SMOOTHING.min_gain)
                && self.worst(node) >= worst.min(SMOOTHING.min_evened_quality)
                && self.shortest(node) >= short
            {
                return true;
            }
            step *= 0.5;
        }
        self.put(node, start);
        false
    }
}
