//! Coarsening: nodes are removed for as long as the triangles that close the gap keep the limits.
//!
//! A node is removed when some triangulation of its rim keeps the limits by their certified bounds; the one of the least cost first, by
//! a heap of costs of which those near a change are computed again when they are due. When none can be removed any more, two neighbours
//! become one node where some place between them keeps the limits, edges are flipped to where the bounds of their two triangles
//! are smaller, nodes are moved towards those of their triangles that have the larger bounds, and nodes beside what changed are tried
//! again. Triangles come out long where the surface bends one way only (decimation [Schroeder, Zarge & Lorensen 1992] with the bound
//! of `deviation/triangle.rs` in place of a distance of points). At last neighbours are joined whose bounds are
//! too large at first, where moving the nodes round them brings these below the limit.

pub mod relax;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::outline::area2;
use crate::mesh::tri::fill::{self, Filling, fill};
use crate::mesh::tri::optimize_settings::COARSEN;
use crate::mesh::tri::shape::{Star, quality};
use crate::mesh::tri::triangulation::{Patch, Ring, Triangulation};

/// The bound of three nodes as a triangle over the limits, which are kept up to 1.
pub type TriangleRatio<'a> = dyn Fn(&Triangulation, [u32; 3]) -> f64 + 'a;

/// Whether an edge between two nodes may be as long as it is.
pub type Allowed<'a> = dyn Fn(&Triangulation, u32, u32) -> bool + 'a;

/// The conditions of a coarsening.
pub struct Coarsener<'a> {
    /// Bounds over the limits.
    pub bound: &'a TriangleRatio<'a>,
    /// Lengths.
    pub allowed: &'a Allowed<'a>,
    /// The point of a place of the chart.
    pub point: &'a dyn Fn(DVec2) -> DVec3,
}

/// The cost of the removal of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
enum RemovalCost {
    /// Not computed since the last change beside it.
    Unknown,
    /// The worst ratio of the triangles in its place.
    Cost(f64),
    /// It cannot be removed.
    Impossible,
}

/// A coarsening at work.
struct Coarsening<'a> {
    conditions: &'a Coarsener<'a>,
    triangulation: &'a mut Triangulation,
    /// By node.
    removal: Vec<RemovalCost>,
    /// By triangle, with its corners: bounds that were found.
    ratios: Vec<([u32; 3], f64)>,
    /// Costs as their bits, which are in order for what is not negative, and nodes.
    heap: BinaryHeap<Reverse<(u64, u32)>>,
    changes: Changes,
    ring: Ring,
    patch: Patch,
}

/// When the triangles at each node changed last: what failed is tried again only where something changed.
#[derive(Default)]
struct Changes {
    /// Changes so far.
    now: usize,
    /// By node: the change after which its triangles are as they are.
    of_node: Vec<usize>,
    /// Changes before the last pass over all pairs, over all edges, over all nodes and over all pairs again
    /// began; `None` before the first one.
    joined: Option<usize>,
    flipped: Option<usize>,
    moved: Option<usize>,
    joined_relaxed: Option<usize>,
}

impl Changes {
    fn mark(&mut self, nodes: &[u32]) {
        self.now += 1;
        nodes.iter().for_each(|n| self.of_node[*n as usize] = self.now);
    }

    /// Whether the triangles at some of these nodes changed since a pass began.
    fn since(&self, pass: Option<usize>, nodes: &[u32]) -> bool {
        pass.is_none_or(|before| nodes.iter().any(|n| self.of_node[*n as usize] > before))
    }
}

impl Coarsener<'_> {
    /// Removes nodes until hardly one can be removed.
    pub fn coarsen(&self, triangulation: &mut Triangulation, job: &Job) -> Result<()> {
        let n = triangulation.p.len();
        let first = triangulation.fixed;
        let mut coarsening = Coarsening {
            conditions: self,
            triangulation,
            removal: vec![RemovalCost::Unknown; n],
            ratios: Vec::new(),
            heap: (first..n as u32).map(|node| Reverse((0, node))).collect(),
            changes: Changes { of_node: vec![0; n], ..Changes::default() },
            ring: Ring::default(),
            patch: Patch::default(),
        };
        for _ in 0..COARSEN.max_rounds {
            let mut removed = coarsening.remove_nodes(job)?;
            removed += coarsening.join(job)?;
            coarsening.flip();
            coarsening.relax(job)?;
            if removed as f64 <= COARSEN.min_removed_share * n as f64 {
                break;
            }
        }
        for _ in 0..COARSEN.max_relaxed_rounds {
            if coarsening.join_relaxed(job)? == 0 {
                break;
            }
            coarsening.remove_nodes(job)?;
            coarsening.relax(job)?;
        }
        Ok(())
    }
}

impl Coarsening<'_> {
    /// Removes nodes, cheapest first; how many.
    fn remove_nodes(&mut self, job: &Job) -> Result<usize> {
        let mut removed = 0_usize;
        while let Some(Reverse((_, node))) = self.heap.pop() {
            let k = node as usize;
            if self.triangulation.at[k] == NO_TRIANGLE || self.removal[k] == RemovalCost::Impossible {
                continue;
            }
            let Some(filling) = self.filling(node) else {
                self.removal[k] = RemovalCost::Impossible;
                continue;
            };
            // A node whose cost has risen goes back into the heap.
            if self.removal[k] != RemovalCost::Cost(filling.ratio) {
                self.removal[k] = RemovalCost::Cost(filling.ratio);
                let next = self.heap.peek().map_or(u64::MAX, |Reverse((bits, _))| *bits);
                if filling.ratio.to_bits() > next {
                    self.heap.push(Reverse((filling.ratio.to_bits(), node)));
                    continue;
                }
            }
            self.triangulation.refill(&self.patch, &filling.triangles);
            self.changes.mark(&self.patch.rim);
            for n in self.patch.rim.clone() {
                // Removals that were impossible stay so until a flip.
                if self.removal[n as usize] != RemovalCost::Impossible {
                    self.removal[n as usize] = RemovalCost::Unknown;
                }
            }
            removed += 1;
            if removed.is_multiple_of(COARSEN.nodes_per_check) {
                job.go_on()?;
            }
        }
        Ok(removed)
    }

    /// The cheapest triangles in place of those at a node; `patch` is then what they replace.
    fn filling(&mut self, node: u32) -> Option<Filling> {
        self.triangulation.ring(node, &mut self.ring);
        if !self.ring.closed || self.ring.tri.len() > fill::MAX_NODES {
            return None;
        }
        self.triangulation.patch(&self.ring.tri, &mut self.patch)?;
        let rim = &self.patch.rim;
        let triangulation = &*self.triangulation;
        let at: Vec<DVec2> = rim.iter().map(|n| triangulation.xy[*n as usize]).collect();
        let p: Vec<DVec3> = rim.iter().map(|n| triangulation.p[*n as usize]).collect();
        let n = rim.len();
        let ratio = |c: [usize; 3]| {
            let far = |i: usize, j: usize| j - i == 1 || j - i == n - 1 || (self.conditions.allowed)(triangulation, rim[i], rim[j]);
            if quality(p[c[0]], p[c[1]], p[c[2]]) < COARSEN.min_quality || !(far(c[0], c[1]) && far(c[1], c[2]) && far(c[0], c[2])) {
                return f64::INFINITY;
            }
            (self.conditions.bound)(triangulation, c.map(|i| rim[i]))
        };
        fill(&at, &p, 1.0, &ratio)
    }

    /// Makes one node of two neighbours where some place between them keeps the limits; how many pairs.
    fn join(&mut self, job: &Job) -> Result<usize> {
        let mut removed = 0_usize;
        let last = self.changes.joined.replace(self.changes.now);
        for t in 0..self.triangulation.tri.len() as u32 {
            for k in 0..3 {
                let c = self.triangulation.tri[t as usize];
                let (a, b) = (c[(k + 1) % 3], c[(k + 2) % 3]);
                let is_open = self.triangulation.alive(t) && self.triangulation.fixed <= a && a < b && self.changes.since(last, &[a, b]);
                if is_open && self.join_one(a, b) {
                    removed += 1;
                    break;
                }
            }
            if (t as usize).is_multiple_of(COARSEN.nodes_per_check) {
                job.go_on()?;
            }
        }
        Ok(removed)
    }

    /// Makes one node of two neighbours where possible; whether it did.
    fn join_one(&mut self, a: u32, b: u32) -> bool {
        let Some(star) = self.star_of_both(a, b, 1.0) else { return false };
        let k = a as usize;
        let size = self.triangulation.size[k];
        self.triangulation.restar(&self.patch, Some(a), &star, size);
        // Ratios found with this node at another place are void.
        self.triangulation.ring(a, &mut self.ring);
        for t in &self.ring.tri {
            if let Some(ratio) = self.ratios.get_mut(*t as usize) {
                ratio.0 = [0; 3];
            }
        }
        self.changes.mark(&self.patch.rim);
        self.changes.mark(&[a]);
        for n in self.patch.rim.iter().copied().chain([a]).filter(|n| *n >= self.triangulation.fixed) {
            self.removal[n as usize] = RemovalCost::Unknown;
            self.heap.push(Reverse((0, n)));
        }
        true
    }

    /// Where one node in place of two neighbours has the least bounds, less than a limit; `patch` is then what its star replaces.
    fn star_of_both(&mut self, a: u32, b: u32, limit: f64) -> Option<Star> {
        self.triangulation.ring(a, &mut self.ring);
        let mut around = self.ring.tri.clone();
        self.triangulation.ring(b, &mut self.ring);
        around.extend(self.ring.tri.iter().filter(|t| !self.triangulation.tri[**t as usize].contains(&a)));
        self.triangulation.patch(&around, &mut self.patch)?;
        let (k, other) = (a as usize, b as usize);
        let old = (self.triangulation.xy[k], self.triangulation.p[k]);
        let mut best: Option<(f64, Star)> = None;
        for share in COARSEN.merge_places {
            let xy = old.0.lerp(self.triangulation.xy[other], share);
            (self.triangulation.xy[k], self.triangulation.p[k]) = (xy, (self.conditions.point)(xy));
            if let Some(ratio) = self.star(a, best.map_or(limit, |b| b.0)) {
                best = Some((ratio, Star { p: self.triangulation.p[k], xy, worst: 0.0 }));
            }
        }
        (self.triangulation.xy[k], self.triangulation.p[k]) = old;
        best.map(|best| best.1)
    }

    /// The worst bound of the triangles from a node to the rim of the patch, where it is less than a limit.
    fn star(&self, node: u32, most: f64) -> Option<f64> {
        let rim = &self.patch.rim;
        (0..rim.len()).try_fold(0.0_f64, |worst, i| {
            let c = [node, rim[i], rim[(i + 1) % rim.len()]];
            if !(self.conditions.allowed)(self.triangulation, c[0], c[1]) {
                return None;
            }
            self.less(c, most).map(|ratio| worst.max(ratio))
        })
    }

    /// The bound of a triangle of the triangulation.
    fn ratio(&mut self, t: u32) -> f64 {
        let c = self.triangulation.tri[t as usize];
        self.ratios.resize(self.triangulation.tri.len(), ([0; 3], 0.0));
        if self.ratios[t as usize].0 != c {
            self.ratios[t as usize] = (c, (self.conditions.bound)(self.triangulation, c));
        }
        self.ratios[t as usize].1
    }

    /// The bound of a triangle that may be made, less than a limit; `None` where it may not.
    fn less(&self, c: [u32; 3], limit: f64) -> Option<f64> {
        let [x, y, z] = c.map(|n| self.triangulation.xy[n as usize]);
        let [a, b, d] = c.map(|n| self.triangulation.p[n as usize]);
        if area2(x, y, z) <= 0.0 || quality(a, b, d) < COARSEN.min_quality {
            return None;
        }
        Some((self.conditions.bound)(self.triangulation, c)).filter(|bound| *bound < limit)
    }

    /// Flips edges where the bounds of the two triangles get smaller; the removal of nodes beside them is tried again.
    fn flip(&mut self) {
        let mut left = 4 * self.triangulation.tri.len();
        let last = self.changes.flipped.replace(self.changes.now);
        let mut open: Vec<u32> = (0..self.triangulation.tri.len() as u32).filter(|t| self.triangulation.alive(*t)).collect();
        while let Some(t) = open.pop() {
            for k in 0..3 {
                let other = self.triangulation.across[t as usize][k];
                if left == 0 || other == NO_TRIANGLE || self.triangulation.locked[t as usize] >> k & 1 == 1 {
                    continue;
                }
                let c = self.triangulation.tri[t as usize];
                let (a, b, d) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
                let Some(tip) = self.triangulation.tri[other as usize].into_iter().find(|n| *n != b && *n != d) else { continue };
                if !self.changes.since(last, &[a, b, d, tip]) || !(self.conditions.allowed)(self.triangulation, a, tip) {
                    continue;
                }
                let (one, two) = (self.ratio(t), self.ratio(other));
                let before = one * one + two * two;
                let Some((first, second)) = self.less([a, b, tip], 1.0).zip(self.less([a, tip, d], 1.0)) else { continue };
                if first * first + second * second > COARSEN.max_gain_ratio * before {
                    continue;
                }
                left -= 1;
                self.triangulation.flip(t, k);
                self.ratios[t as usize] = (self.triangulation.tri[t as usize], first);
                self.ratios[other as usize] = (self.triangulation.tri[other as usize], second);
                self.changes.mark(&[a, b, d, tip]);
                for n in [a, b, d, tip] {
                    if n >= self.triangulation.fixed && self.removal[n as usize] == RemovalCost::Impossible {
                        self.removal[n as usize] = RemovalCost::Unknown;
                        self.heap.push(Reverse((0, n)));
                    }
                }
                open.extend([t, other]);
                break;
            }
        }
        if left == 0 {
            self.changes.flipped = last;
        }
    }
}
