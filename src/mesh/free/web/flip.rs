//! The diagonal of two triangles becomes the other one.

use super::Web;
use crate::base::tolerance::PARALLEL;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::free::outline::area2;
use crate::mesh::free::shape::quality;

impl Web {
    /// The diagonal of the two triangles at side `k` of `t` becomes the other one. Both must be there and unlocked.
    pub fn flip(&mut self, t: u32, k: usize) {
        let u = self.across[t as usize][k];
        let j = self.side_to(u, t);
        let (tt, uu) = (t as usize, u as usize);
        let (a, b, c) = (self.tri[tt][k], self.tri[tt][(k + 1) % 3], self.tri[tt][(k + 2) % 3]);
        let d = self.tri[uu][j];
        // t: a b c, u: d c b; they become a b d and a d c.
        let (ab, ca) = (self.across[tt][(k + 2) % 3], self.across[tt][(k + 1) % 3]);
        let (bd, dc) = (self.across[uu][(j + 1) % 3], self.across[uu][(j + 2) % 3]);
        let bit = |locked: u8, k: usize| locked >> (k % 3) & 1;
        let (lab, lca) = (bit(self.locked[tt], k + 2), bit(self.locked[tt], k + 1));
        let (lbd, ldc) = (bit(self.locked[uu], j + 1), bit(self.locked[uu], j + 2));
        self.tri[tt] = [a, b, d];
        self.across[tt] = [bd, u, ab];
        self.locked[tt] = lbd | lab << 2;
        self.tri[uu] = [a, d, c];
        self.across[uu] = [dc, ca, t];
        self.locked[uu] = ldc | lca << 1;
        if bd != NO_TRIANGLE {
            let s = self.side_to(bd, u);
            self.across[bd as usize][s] = t;
        }
        if ca != NO_TRIANGLE {
            let s = self.side_to(ca, t);
            self.across[ca as usize][s] = u;
        }
        self.at[a as usize] = t;
        self.at[b as usize] = t;
        self.at[c as usize] = u;
        self.at[d as usize] = t;
    }

    /// Flips triangles whose corners lie on a straight line of the surface across their longest side, where the chart allows it.
    pub fn lift_flat(&mut self) {
        const PASSES: usize = 8;
        for _ in 0..PASSES {
            let mut any = false;
            for t in 0..self.tri.len() as u32 {
                any |= self.alive(t) && self.quality(t) < PARALLEL && self.lift(t);
            }
            if !any {
                return;
            }
        }
    }

    fn lift(&mut self, t: u32) -> bool {
        let c = self.tri[t as usize];
        let p = |n: u32| self.p[n as usize];
        let length = |k: &usize| p(c[(k + 1) % 3]).distance_squared(p(c[(k + 2) % 3]));
        let Some(k) = (0..3).max_by(|i, j| length(i).total_cmp(&length(j))) else { return false };
        let other = self.across[t as usize][k];
        if other == NO_TRIANGLE || self.locked[t as usize] >> k & 1 == 1 {
            return false;
        }
        let (a, b, d) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
        let tip = self.tri[other as usize][self.side_to(other, t)];
        let xy = |n: u32| self.xy[n as usize];
        let convex = area2(xy(a), xy(b), xy(tip)) > 0.0 && area2(xy(a), xy(tip), xy(d)) > 0.0;
        let worst = |x: [u32; 3], y: [u32; 3]| quality(p(x[0]), p(x[1]), p(x[2])).min(quality(p(y[0]), p(y[1]), p(y[2])));
        if !convex || worst([a, b, tip], [a, tip, d]) <= worst(c, [tip, d, b]) {
            return false;
        }
        self.flip(t, k);
        true
    }
}
