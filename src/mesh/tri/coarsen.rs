//! Fewer triangles for the same limits: nodes are taken out for as long as the triangles that close the gap keep them.
//!
//! A node goes when some triangulation of its rim keeps the limits by their certified bounds; what costs least goes first, by
//! a heap of costs of which those near a change are found again when their turn comes. When none goes any more, two neighbours
//! become one node where some place between them keeps the limits, edges are flipped to where the bounds of their two triangles
//! are smaller, nodes are moved towards those of their triangles that have the larger bounds, and nodes beside what changed are tried
//! again. Triangles come out long where the surface bends one way only (decimation [Schroeder, Zarge & Lorensen 1992] with the bound
//! of `deviation/triangle.rs` in place of a distance of points). At last neighbours are joined whose bounds are too large at first, where moving the
//! nodes round them brings these below the limit.

pub mod relax;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::outline::area2;
use crate::mesh::tri::fill::{self, Filling, fill};
use crate::mesh::tri::shape::{Star, quality};
use crate::mesh::tri::triangulation::{Patch, Ring, Triangulation};

/// How far three nodes of a triangulation are from the limits as a triangle: 1 is just kept.
pub type Bound<'a> = dyn Fn(&Triangulation, [u32; 3]) -> f64 + 'a;

/// Whether an edge between two nodes may be as long as it is.
pub type Allowed<'a> = dyn Fn(&Triangulation, u32, u32) -> bool + 'a;

/// Rounds of taking out and flipping at most.
const ROUNDS: usize = 8;
/// Passes in which pairs are joined whose bounds are too large before the nodes round them are moved.
const RELAXED_ROUNDS: usize = 2;
/// A round that takes out a smaller share of the nodes is the last one.
const MIN_REMOVED_SHARE: f64 = 0.002;
/// Least quality of a triangle that is made: long ones are meant, needles are not.
const LEAST: f64 = 0.01;
/// A flip must lower the sum of the squares of two bounds to this share: none goes to and fro.
const GAIN: f64 = 0.98;
/// Places between two nodes at which one in place of both is tried.
const BETWEEN: [f64; 3] = [0.5, 0.25, 0.75];
/// Nodes taken out between two questions whether to go on.
const WATCH: usize = 1024;

/// What thinning asks.
pub struct Thinner<'a> {
    /// Bounds against the limits.
    pub bound: &'a Bound<'a>,
    /// Lengths.
    pub allowed: &'a Allowed<'a>,
    /// The point of a place of the chart.
    pub point: &'a dyn Fn(DVec2) -> DVec3,
}

/// What is known of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    /// Nothing, or something changed beside it.
    Nothing,
    /// The cost of taking it out, as things are.
    Cost(f64),
    /// It cannot go, as things were.
    Stays,
}

/// A thinning under way.
struct Thinning<'a> {
    ask: &'a Thinner<'a>,
    triangulation: &'a mut Triangulation,
    /// By node.
    known: Vec<Known>,
    /// By triangle, with its corners: bounds that were found.
    loads: Vec<([u32; 3], f64)>,
    /// Costs as their bits, which are in order for what is not negative, and nodes.
    heap: BinaryHeap<Reverse<(u64, u32)>>,
    changes: Changes,
    ring: Ring,
    patch: Patch,
}

/// When the triangles at each node changed last: what was tried in vain is tried again only where something is different.
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

impl Thinner<'_> {
    /// Takes out nodes until hardly one can go.
    pub fn thin(&self, triangulation: &mut Triangulation, job: &Job) -> Result<()> {
        let n = triangulation.p.len();
        let first = triangulation.fixed;
        let mut thinning = Thinning {
            ask: self,
            triangulation,
            known: vec![Known::Nothing; n],
            loads: Vec::new(),
            heap: (first..n as u32).map(|node| Reverse((0, node))).collect(),
            changes: Changes { of_node: vec![0; n], ..Changes::default() },
            ring: Ring::default(),
            patch: Patch::default(),
        };
        for _ in 0..ROUNDS {
            let mut gone = thinning.take_out(job)?;
            gone += thinning.join(job)?;
            thinning.flip();
            thinning.relax(job)?;
            if gone as f64 <= MIN_REMOVED_SHARE * n as f64 {
                break;
            }
        }
        for _ in 0..RELAXED_ROUNDS {
            if thinning.join_relaxed(job)? == 0 {
                break;
            }
            thinning.take_out(job)?;
            thinning.relax(job)?;
        }
        Ok(())
    }
}

impl Thinning<'_> {
    /// Takes out nodes, cheapest first; how many went.
    fn take_out(&mut self, job: &Job) -> Result<usize> {
        let mut gone = 0_usize;
        while let Some(Reverse((_, node))) = self.heap.pop() {
            let k = node as usize;
            if self.triangulation.at[k] == NO_TRIANGLE || self.known[k] == Known::Stays {
                continue;
            }
            let Some(filling) = self.filling(node) else {
                self.known[k] = Known::Stays;
                continue;
            };
            // What got dearer since it was put there waits for its turn.
            if self.known[k] != Known::Cost(filling.load) {
                self.known[k] = Known::Cost(filling.load);
                let next = self.heap.peek().map_or(u64::MAX, |Reverse((bits, _))| *bits);
                if filling.load.to_bits() > next {
                    self.heap.push(Reverse((filling.load.to_bits(), node)));
                    continue;
                }
            }
            self.triangulation.refill(&self.patch, &filling.triangles);
            self.changes.mark(&self.patch.rim);
            for n in self.patch.rim.clone() {
                // Those that stay do so for what is round them now as well, but for a flip.
                if self.known[n as usize] != Known::Stays {
                    self.known[n as usize] = Known::Nothing;
                }
            }
            gone += 1;
            if gone.is_multiple_of(WATCH) {
                job.go_on()?;
            }
        }
        Ok(gone)
    }

    /// The cheapest triangles in place of those at a node; `patch` is then what they replace.
    fn filling(&mut self, node: u32) -> Option<Filling> {
        self.triangulation.ring(node, &mut self.ring);
        if !self.ring.closed || self.ring.tri.len() > fill::MOST {
            return None;
        }
        self.triangulation.patch(&self.ring.tri, &mut self.patch)?;
        let rim = &self.patch.rim;
        let triangulation = &*self.triangulation;
        let at: Vec<DVec2> = rim.iter().map(|n| triangulation.xy[*n as usize]).collect();
        let p: Vec<DVec3> = rim.iter().map(|n| triangulation.p[*n as usize]).collect();
        let n = rim.len();
        let load = |c: [usize; 3]| {
            let far = |i: usize, j: usize| j - i == 1 || j - i == n - 1 || (self.ask.allowed)(triangulation, rim[i], rim[j]);
            if quality(p[c[0]], p[c[1]], p[c[2]]) < LEAST || !(far(c[0], c[1]) && far(c[1], c[2]) && far(c[0], c[2])) {
                return f64::INFINITY;
            }
            (self.ask.bound)(triangulation, c.map(|i| rim[i]))
        };
        fill(&at, &p, 1.0, &load)
    }

    /// Makes one node of two neighbours where some place between them keeps the limits; how many went.
    fn join(&mut self, job: &Job) -> Result<usize> {
        let mut gone = 0_usize;
        let last = self.changes.joined.replace(self.changes.now);
        for t in 0..self.triangulation.tri.len() as u32 {
            for k in 0..3 {
                let c = self.triangulation.tri[t as usize];
                let (a, b) = (c[(k + 1) % 3], c[(k + 2) % 3]);
                let is_open = self.triangulation.alive(t) && self.triangulation.fixed <= a && a < b && self.changes.since(last, &[a, b]);
                if is_open && self.join_one(a, b) {
                    gone += 1;
                    break;
                }
            }
            if (t as usize).is_multiple_of(WATCH) {
                job.go_on()?;
            }
        }
        Ok(gone)
    }

    /// Makes one node of two neighbours, or leaves them.
    fn join_one(&mut self, a: u32, b: u32) -> bool {
        let Some(star) = self.star_of_both(a, b, 1.0) else { return false };
        let k = a as usize;
        let size = self.triangulation.size[k];
        self.triangulation.restar(&self.patch, Some(a), &star, size);
        // Places count by themselves: what was found with this node at another one is void.
        self.triangulation.ring(a, &mut self.ring);
        for t in &self.ring.tri {
            if let Some(load) = self.loads.get_mut(*t as usize) {
                load.0 = [0; 3];
            }
        }
        self.changes.mark(&self.patch.rim);
        self.changes.mark(&[a]);
        for n in self.patch.rim.iter().copied().chain([a]).filter(|n| *n >= self.triangulation.fixed) {
            self.known[n as usize] = Known::Nothing;
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
        for share in BETWEEN {
            let xy = old.0.lerp(self.triangulation.xy[other], share);
            (self.triangulation.xy[k], self.triangulation.p[k]) = (xy, (self.ask.point)(xy));
            if let Some(load) = self.star(a, best.map_or(limit, |b| b.0)) {
                best = Some((load, Star { p: self.triangulation.p[k], xy, worst: 0.0 }));
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
            if !(self.ask.allowed)(self.triangulation, c[0], c[1]) {
                return None;
            }
            self.less(c, most).map(|load| worst.max(load))
        })
    }

    /// The bound of a triangle of the triangulation.
    fn load(&mut self, t: u32) -> f64 {
        let c = self.triangulation.tri[t as usize];
        self.loads.resize(self.triangulation.tri.len(), ([0; 3], 0.0));
        if self.loads[t as usize].0 != c {
            self.loads[t as usize] = (c, (self.ask.bound)(self.triangulation, c));
        }
        self.loads[t as usize].1
    }

    /// The bound of a triangle that may be made, less than a limit; `None` where it may not.
    fn less(&self, c: [u32; 3], limit: f64) -> Option<f64> {
        let [x, y, z] = c.map(|n| self.triangulation.xy[n as usize]);
        let [a, b, d] = c.map(|n| self.triangulation.p[n as usize]);
        if area2(x, y, z) <= 0.0 || quality(a, b, d) < LEAST {
            return None;
        }
        Some((self.ask.bound)(self.triangulation, c)).filter(|bound| *bound < limit)
    }

    /// Flips edges where the bounds of the two triangles get smaller; nodes beside them get another try.
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
                if !self.changes.since(last, &[a, b, d, tip]) || !(self.ask.allowed)(self.triangulation, a, tip) {
                    continue;
                }
                let (one, two) = (self.load(t), self.load(other));
                let before = one * one + two * two;
                let Some((first, second)) = self.less([a, b, tip], 1.0).zip(self.less([a, tip, d], 1.0)) else { continue };
                if first * first + second * second > GAIN * before {
                    continue;
                }
                left -= 1;
                self.triangulation.flip(t, k);
                self.loads[t as usize] = (self.triangulation.tri[t as usize], first);
                self.loads[other as usize] = (self.triangulation.tri[other as usize], second);
                self.changes.mark(&[a, b, d, tip]);
                for n in [a, b, d, tip] {
                    if n >= self.triangulation.fixed && self.known[n as usize] == Known::Stays {
                        self.known[n as usize] = Known::Nothing;
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
