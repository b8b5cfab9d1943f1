//! Sides flipped for better triangles.

use glam::DVec3;

use crate::base::job;
use crate::base::tolerance::PARALLEL;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::outline::area2;
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::optimize_settings::REPAIR;

impl MeshOptimizer<'_> {
    /// Flips every free side whose opposite angles in space exceed a half turn together.
    pub fn flip_all(&mut self) {
        let moved = self.moved.take();
        let mut open = self.triangles_at(&moved);
        open.reverse();
        let mut left = 4 * self.triangulation.tri.len() + 64;
        while let Some(t) = open.pop() {
            job::poll();
            if !self.triangulation.alive(t) {
                continue;
            }
            for k in 0..3 {
                let other = self.triangulation.across[t as usize][k];
                if left > 0 && self.needs_flip(t, k) {
                    left -= 1;
                    self.triangulation.flip(t, k);
                    open.push(other);
                    open.push(t);
                    self.wake(t);
                    self.wake(other);
                    break;
                }
            }
        }
    }

    fn needs_flip(&self, t: u32, k: usize) -> bool {
        let Some(quad) = self.quad(t, k) else { return false };
        let [a, b, c, d] = quad.map(|n| self.triangulation.p[n as usize]);
        let cot = |tip: DVec3, x: DVec3, y: DVec3| {
            let (x, y) = (x - tip, y - tip);
            x.dot(y) / x.cross(y).length().max(f64::MIN_POSITIVE)
        };
        let [na, nb, nc, nd] = quad;
        let keeps = || !self.guards_moves || self.keeps([na, nb, nc], None) && self.keeps([na, nc, nd], None);
        cot(a, b, d) + cot(c, b, d) < -PARALLEL && self.convex(quad) && keeps()
    }

    /// Flips a side if the worse of the two triangles gets better; whether it did.
    pub(crate) fn flip_worse(&mut self, t: u32) -> bool {
        for k in 0..3 {
            let Some(quad) = self.quad(t, k) else { continue };
            if !self.convex(quad) {
                continue;
            }
            let [na, nb, nc, nd] = quad;
            let before = self.triangulation.shape([na, nb, nd]).min(self.triangulation.shape([nc, nd, nb]));
            let after = self.triangulation.shape([na, nb, nc]).min(self.triangulation.shape([na, nc, nd]));
            if after > before + REPAIR.min_gain && self.keeps([na, nb, nc], None) && self.keeps([na, nc, nd], None) {
                let other = self.triangulation.across[t as usize][k];
                self.triangulation.flip(t, k);
                self.wake(t);
                self.wake(other);
                return true;
            }
        }
        false
    }

    pub(crate) fn quad(&self, t: u32, k: usize) -> Option<[u32; 4]> {
        let triangulation = &self.triangulation;
        if triangulation.locked[t as usize] >> k & 1 == 1 {
            return None;
        }
        let other = triangulation.across[t as usize][k];
        if other == NO_TRIANGLE {
            return None;
        }
        let c = triangulation.tri[t as usize];
        let o = triangulation.tri[other as usize];
        let (a, b, d) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
        let tip = o.iter().copied().find(|n| *n != b && *n != d)?;
        Some([a, b, tip, d])
    }

    /// Whether the chart allows the flip.
    pub(crate) fn convex(&self, [a, b, c, d]: [u32; 4]) -> bool {
        let xy = |n: u32| self.triangulation.xy[n as usize];
        area2(xy(a), xy(b), xy(c)) > 0.0 && area2(xy(a), xy(c), xy(d)) > 0.0
    }
}
