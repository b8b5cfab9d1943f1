//! Relaxation of the triangulation: nodes are moved so that the bounds of the triangles round them are more even, and joined where such
//! moves bring the bounds below the limit again.

use std::cmp::Reverse;

use glam::DVec2;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::base::work;
use crate::mesh::tri::coarsen::{Coarsening, RemovalCost};
use crate::mesh::tri::optimize_settings::COARSEN;

impl Coarsening<'_> {
    /// Moves nodes so that their triangles have more even bounds.
    pub(crate) fn relax(&mut self, job: &Job) -> Result<()> {
        let last = self.changes.moved.replace(self.changes.now);
        for node in self.triangulation.fixed..self.triangulation.p.len() as u32 {
            if self.triangulation.at[node as usize] != NO_TRIANGLE && self.changes.since(last, &[node]) && self.relax_node(node, 1.0) {
                self.triangulation.ring(node, &mut self.ring);
                let changed: Vec<u32> = self.ring.node.iter().copied().chain([node]).collect();
                self.requeue(&changed);
            }
            if (node as usize).is_multiple_of(COARSEN.nodes_per_check) {
                job.go_on()?;
            }
        }
        Ok(())
    }

    /// Moves a node where that lowers the sum of the fourth powers of the bounds of its triangles, all below a limit; whether it moved.
    fn relax_node(&mut self, node: u32, limit: f64) -> bool {
        self.triangulation.ring(node, &mut self.ring);
        let (k, around) = (node as usize, self.ring.tri.clone());
        if !self.ring.closed {
            return false;
        }
        let (mut mean, mut weights, mut before) = (DVec2::ZERO, 0.0, 0.0);
        for t in &around {
            let ratio = self.ratio(*t);
            mean += self.triangulation.tri[*t as usize].iter().map(|n| self.triangulation.xy[*n as usize]).sum::<DVec2>()
                * (ratio * ratio / 3.0);
            weights += ratio * ratio;
            before += ratio * ratio * ratio * ratio;
        }
        if !(before > 0.0 && before.is_finite()) {
            return false;
        }
        let old = (self.triangulation.xy[k], self.triangulation.p[k]);
        for share in COARSEN.move_shares {
            let xy = old.0.lerp(mean / weights, share);
            (self.triangulation.xy[k], self.triangulation.p[k]) = (xy, (self.conditions.point)(xy));
            let (mut ratios, mut sum) = (Vec::with_capacity(around.len()), 0.0);
            for t in &around {
                let c = self.triangulation.tri[*t as usize];
                let far = c.iter().all(|n| *n == node || (self.conditions.allowed)(self.triangulation, node, *n));
                let Some(ratio) = self.less(c, limit).filter(|_| far) else { break };
                sum += ratio * ratio * ratio * ratio;
                if sum > COARSEN.max_gain_ratio * before {
                    break;
                }
                ratios.push((*t, c, ratio));
            }
            if ratios.len() == around.len() {
                ratios.into_iter().for_each(|(t, c, ratio)| self.ratios[t as usize] = (c, ratio));
                return true;
            }
        }
        (self.triangulation.xy[k], self.triangulation.p[k]) = old;
        false
    }

    /// Marks nodes as changed and puts them into the queue again.
    fn requeue(&mut self, changed: &[u32]) {
        self.changes.mark(changed);
        for n in changed.iter().copied().filter(|n| *n >= self.triangulation.fixed && self.triangulation.at[*n as usize] != NO_TRIANGLE) {
            self.removal[n as usize] = RemovalCost::Unknown;
            self.heap.push(Reverse((0, n)));
        }
    }

    /// Makes one node of two neighbours where moves of the nodes round them bring the bounds below the limit again, within a work budget;
    /// how many pairs.
    pub(crate) fn join_relaxed(&mut self, job: &Job) -> Result<usize> {
        let mut joined = 0_usize;
        let last = self.changes.joined_relaxed.replace(self.changes.now);
        let (most, mut spent) = (COARSEN.relaxed_work * self.triangulation.tri.len() as u64, 0);
        for t in 0..self.triangulation.tri.len() as u32 {
            for k in 0..3 {
                let c = self.triangulation.tri[t as usize];
                let (a, b) = (c[(k + 1) % 3], c[(k + 2) % 3]);
                let is_open = self.triangulation.alive(t) && self.triangulation.fixed <= a && a < b && self.changes.since(last, &[a, b]);
                if !is_open {
                    continue;
                }
                let (is_joined, units) = work::measured(|| self.join_one_relaxed(a, b));
                spent += units;
                if is_joined {
                    joined += 1;
                    break;
                }
            }
            if spent > most {
                break;
            }
            if (t as usize).is_multiple_of(COARSEN.nodes_per_check) {
                job.go_on()?;
            }
        }
        Ok(joined)
    }

    fn join_one_relaxed(&mut self, a: u32, b: u32) -> bool {
        let Some(star) = self.star_of_both(a, b, COARSEN.max_start_ratio) else { return false };
        let patch = std::mem::take(&mut self.patch);
        let mut all = patch.tri.clone();
        for n in &patch.rim {
            self.triangulation.ring(*n, &mut self.ring);
            all.extend_from_slice(&self.ring.tri);
        }
        all.sort_unstable();
        all.dedup();
        let kept = self.triangulation.before(&all);
        let size = self.triangulation.size[a as usize];
        self.triangulation.restar(&patch, Some(a), &star, size);
        self.invalidate(&all);
        let free: Vec<u32> = std::iter::once(a).chain(patch.rim.iter().copied().filter(|n| *n >= self.triangulation.fixed)).collect();
        let mut worst = self.worst(&all);
        for _ in 0..COARSEN.max_sweeps {
            for n in &free {
                self.relax_node(*n, COARSEN.max_start_ratio);
            }
            let now = self.worst(&all);
            if now < 1.0 || now > COARSEN.max_sweep_gain_ratio * worst {
                worst = now;
                break;
            }
            worst = now;
        }
        self.patch = patch;
        if worst >= 1.0 {
            self.triangulation.put_back(&kept);
            self.invalidate(&all);
            return false;
        }
        let live: Vec<u32> = all.into_iter().filter(|t| self.triangulation.alive(*t)).collect();
        let changed = self.triangulation.nodes_of(&live);
        self.requeue(&changed);
        true
    }

    /// The largest bound of those of some triangles that are left.
    fn worst(&mut self, some: &[u32]) -> f64 {
        let mut worst = 0.0_f64;
        for t in some.iter().copied() {
            if self.triangulation.alive(t) {
                worst = worst.max(self.ratio(t));
            }
        }
        worst
    }

    /// Bounds of triangles whose nodes have moved are computed anew when needed.
    fn invalidate(&mut self, some: &[u32]) {
        for t in some {
            if let Some(ratio) = self.ratios.get_mut(*t as usize) {
                ratio.0 = [0; 3];
            }
        }
    }
}
