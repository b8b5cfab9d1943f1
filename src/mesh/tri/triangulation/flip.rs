//! The diagonal of two triangles becomes the other one.

use crate::base::tolerance::PARALLEL;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::outline::{in_line, is_left};
use crate::mesh::tri::shape::quality;
use crate::mesh::tri::triangulation::Triangulation;

/// Whether a new side, and the triangles on both sides of it, are accepted.
type Accepted<'a> = dyn Fn(&Triangulation, [u32; 2], [[u32; 3]; 2]) -> bool + 'a;

impl Triangulation {
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

    /// Flips triangles whose corners lie on a straight line of the surface, or of the chart, across their longest side, where the chart
    /// allows it.
    pub fn lift_flat(&mut self) {
        const MAX_PASSES: usize = 8;
        for _ in 0..MAX_PASSES {
            let mut any = false;
            for t in 0..self.tri.len() as u32 {
                any |= self.alive(t) && (self.quality(t) < PARALLEL || self.is_in_line(t)) && self.lift(t);
            }
            if !any {
                return;
            }
        }
    }

    fn is_in_line(&self, t: u32) -> bool {
        let [a, b, c] = self.tri[t as usize].map(|n| self.xy[n as usize]);
        in_line(a, b, c)
    }

    fn lift(&mut self, t: u32) -> bool {
        let c = self.tri[t as usize];
        let (p, xy) = (|n: u32| self.p[n as usize], |n: u32| self.xy[n as usize]);
        // The border of a chart may be straight where that of the surface is not.
        let in_chart = self.quality(t) >= PARALLEL;
        let length = |k: &usize| {
            let (b, d) = (c[(k + 1) % 3], c[(k + 2) % 3]);
            if in_chart { xy(b).distance_squared(xy(d)) } else { p(b).distance_squared(p(d)) }
        };
        let Some(k) = (0..3).max_by(|i, j| length(i).total_cmp(&length(j))) else { return false };
        let other = self.across[t as usize][k];
        if other == NO_TRIANGLE || self.locked[t as usize] >> k & 1 == 1 {
            return false;
        }
        let (a, b, d) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
        let tip = self.tri[other as usize][self.side_to(other, t)];
        let convex = is_left(xy(a), xy(b), xy(tip)) && is_left(xy(a), xy(tip), xy(d));
        let worst = |x: [u32; 3], y: [u32; 3]| quality(p(x[0]), p(x[1]), p(x[2])).min(quality(p(y[0]), p(y[1]), p(y[2])));
        if !convex || !in_chart && worst([a, b, tip], [a, tip, d]) <= worst(c, [tip, d, b]) {
            return false;
        }
        self.flip(t, k);
        true
    }

    /// Flips sides of triangles below a quality where the worse of the two gets better by a twentieth, no side gets longer
    /// than the longest of both, and the new side with its two triangles is `accepted`.
    pub fn flip_sharp(&mut self, below: f64, accepted: &Accepted) {
        const MAX_PASSES: usize = 8;
        const MIN_GAIN_RATIO: f64 = 1.05;
        for _ in 0..MAX_PASSES {
            let mut any = false;
            for t in 0..self.tri.len() as u32 {
                if !self.alive(t) || self.quality(t) >= below {
                    continue;
                }
                let mut ways: Vec<(f64, usize)> =
                    (0..3).filter_map(|k| Some((self.gain(t, k)?, k))).filter(|w| w.0 > MIN_GAIN_RATIO).collect();
                ways.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
                let found = ways.into_iter().find(|(_, k)| {
                    let (a, b, d, tip) = self.round_side(t, *k);
                    accepted(self, [a, tip], [[a, b, tip], [a, tip, d]])
                });
                if let Some((_, k)) = found {
                    self.flip(t, k);
                    any = true;
                }
            }
            if !any {
                return;
            }
        }
    }

    /// The corner against side `k` of a triangle, its ends, and the corner beyond it.
    pub fn round_side(&self, t: u32, k: usize) -> (u32, u32, u32, u32) {
        let c = self.tri[t as usize];
        let other = self.across[t as usize][k];
        (c[k], c[(k + 1) % 3], c[(k + 2) % 3], self.tri[other as usize][self.side_to(other, t)])
    }

    /// How many times better the worse of two triangles gets by a flip of the side between them; `None` where the chart or a
    /// side that would be too long forbids it.
    fn gain(&self, t: u32, k: usize) -> Option<f64> {
        let other = self.across[t as usize][k];
        if other == NO_TRIANGLE || self.locked[t as usize] >> k & 1 == 1 {
            return None;
        }
        let (a, b, d, tip) = self.round_side(t, k);
        let (p, xy) = (|n: u32| self.p[n as usize], |n: u32| self.xy[n as usize]);
        let longest = [(a, b), (b, d), (d, a), (b, tip), (tip, d)].map(|(x, y)| p(x).distance(p(y))).into_iter().fold(0.0, f64::max);
        let convex = is_left(xy(a), xy(b), xy(tip)) && is_left(xy(a), xy(tip), xy(d));
        let of = |x: [u32; 3]| quality(p(x[0]), p(x[1]), p(x[2]));
        let (now, then) = (of([a, b, d]).min(of([tip, d, b])), of([a, b, tip]).min(of([a, tip, d])));
        (convex && p(a).distance(p(tip)) <= longest && then > now).then_some(then / now.max(f64::MIN_POSITIVE))
    }
}
