//! Triangles that know their neighbours, and the one change everything else is made of: a patch of them made anew round
//! one node.

use glam::{DVec2, DVec3};

use super::outline::area2;
use super::shape::{Star, quality};
use crate::base::tolerance::PARALLEL;
use crate::base::triangulate_points::{NO_TRIANGLE, Triangles};

/// A triangulation on a surface: border nodes first, which never move, then inner ones.
#[derive(Clone, Debug, Default)]
pub struct Web {
    /// Points.
    pub p: Vec<DVec3>,
    /// Their places in the chart.
    pub xy: Vec<DVec2>,
    /// Wanted lengths.
    pub size: Vec<f64>,
    /// Number of border nodes.
    pub fixed: u32,
    /// Corners, counter-clockwise in the chart; a dead triangle has three times the same.
    pub tri: Vec<[u32; 3]>,
    /// Triangle across the side opposite each corner.
    pub across: Vec<[u32; 3]>,
    /// Bit k: the side opposite corner k may not change.
    pub locked: Vec<u8>,
    /// One triangle at each node; [`NO_TRIANGLE`] when it has none.
    pub at: Vec<u32>,
    free_tri: Vec<u32>,
    free_node: Vec<u32>,
    stamp: Vec<u32>,
    turn: u32,
}

/// Triangles at a node, and the nodes round it.
#[derive(Clone, Debug, Default)]
pub struct Ring {
    /// Triangles, counter-clockwise.
    pub tri: Vec<u32>,
    /// Nodes, counter-clockwise; of an open fan one more than triangles.
    pub node: Vec<u32>,
    /// All the way round.
    pub closed: bool,
}

/// A patch of triangles to be made anew: what is in it and what is round it.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    /// Triangles in it.
    pub tri: Vec<u32>,
    /// Nodes round it, counter-clockwise.
    pub rim: Vec<u32>,
    /// The triangle beyond each side of the rim (from node k to the next one), and whether the side is locked.
    beyond: Vec<(u32, bool)>,
    /// Nodes inside it.
    pub inner: Vec<u32>,
}

impl Web {
    /// From triangles of which the kept ones are marked, over border and inner nodes.
    pub fn new(p: Vec<DVec3>, xy: Vec<DVec2>, size: Vec<f64>, fixed: u32, all: &Triangles, kept: &[bool]) -> Self {
        let mut number = vec![NO_TRIANGLE; kept.len()];
        let mut next = 0;
        for (slot, _) in number.iter_mut().zip(kept).filter(|(_, kept)| **kept) {
            *slot = next;
            next += 1;
        }
        let n = next as usize;
        let mut web = Self { at: vec![NO_TRIANGLE; p.len()], p, xy, size, fixed, ..Self::default() };
        web.tri.reserve_exact(n);
        web.across.reserve_exact(n);
        web.locked.reserve_exact(n);
        for k in (0..kept.len()).filter(|k| kept[*k]) {
            let across = all.across[k].map(|t| if t == NO_TRIANGLE { t } else { number[t as usize] });
            let open = (0..3).filter(|c| across[*c] == NO_TRIANGLE).fold(0, |bits, c| bits | 1 << c);
            for c in all.corners[k] {
                web.at[c as usize] = web.tri.len() as u32;
            }
            web.tri.push(all.corners[k]);
            web.across.push(across);
            web.locked.push(all.given[k] | open);
        }
        web.stamp = vec![0; n];
        web
    }

    /// Whether a triangle is there.
    pub fn alive(&self, t: u32) -> bool {
        let [a, b, _] = self.tri[t as usize];
        a != b
    }

    /// Place of a node in a triangle.
    fn corner(&self, t: u32, node: u32) -> usize {
        let c = self.tri[t as usize];
        if c[0] == node {
            0
        } else if c[1] == node {
            1
        } else {
            2
        }
    }

    /// Which side of `t` lies against triangle `other`.
    fn side_to(&self, t: u32, other: u32) -> usize {
        let a = self.across[t as usize];
        if a[0] == other {
            0
        } else if a[1] == other {
            1
        } else {
            2
        }
    }

    /// Quality of a triangle.
    pub fn quality(&self, t: u32) -> f64 {
        let [a, b, c] = self.tri[t as usize].map(|n| self.p[n as usize]);
        quality(a, b, c)
    }

    /// Twice the area of a triangle in the chart.
    pub fn chart_area(&self, t: u32) -> f64 {
        let [a, b, c] = self.tri[t as usize].map(|n| self.xy[n as usize]);
        area2(a, b, c)
    }

    /// Whether the node is inside and may move.
    pub fn is_free(&self, node: u32) -> bool {
        node >= self.fixed
    }

    /// Triangles and nodes round a node, into `ring`.
    pub fn ring(&self, node: u32, ring: &mut Ring) {
        ring.tri.clear();
        ring.node.clear();
        ring.closed = false;
        let start = self.at[node as usize];
        if start == NO_TRIANGLE {
            return;
        }
        if self.turn_round(node, start, ring) {
            ring.closed = true;
            return;
        }
        // An open fan: again from its first triangle.
        let mut first = start;
        loop {
            let k = self.corner(first, node);
            // The side that begins at the node is opposite the corner after the next one.
            let before = self.across[first as usize][(k + 2) % 3];
            if before == NO_TRIANGLE {
                break;
            }
            first = before;
        }
        ring.tri.clear();
        ring.node.clear();
        self.turn_round(node, first, ring);
    }

    /// Counter-clockwise from a triangle on; whether that comes back to it.
    fn turn_round(&self, node: u32, first: u32, ring: &mut Ring) -> bool {
        let mut t = first;
        loop {
            let k = self.corner(t, node);
            ring.tri.push(t);
            ring.node.push(self.tri[t as usize][(k + 1) % 3]);
            let next = self.across[t as usize][(k + 1) % 3];
            if next == NO_TRIANGLE {
                ring.node.push(self.tri[t as usize][(k + 2) % 3]);
                return false;
            }
            if next == first {
                return true;
            }
            t = next;
        }
    }

    /// Whether two nodes, or what is the same point at another place of the chart, already have an edge other than between
    /// these places: one more would be the same edge in space.
    pub fn joined_elsewhere(&self, twins: &[Vec<u32>], a: u32, b: u32) -> bool {
        let places = |n: u32| std::iter::once(n).chain(twins.get(n as usize).into_iter().flatten().copied());
        if places(a).count() + places(b).count() == 2 {
            return false;
        }
        let mut ring = Ring::default();
        places(a).any(|x| {
            self.ring(x, &mut ring);
            places(b).any(|y| (x, y) != (a, b) && ring.node.contains(&y))
        })
    }

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

    /// What is round a set of triangles that hang together; `None` when that is not one simple loop, or a locked side or a
    /// border node is inside.
    pub fn patch(&mut self, tri: &[u32], patch: &mut Patch) -> Option<()> {
        self.turn += 1;
        let turn = self.turn;
        patch.tri.clear();
        patch.tri.extend_from_slice(tri);
        patch.rim.clear();
        patch.beyond.clear();
        patch.inner.clear();
        for t in tri {
            self.stamp[*t as usize] = turn;
        }
        let mut sides: Vec<(u32, u32, u32, bool)> = Vec::with_capacity(tri.len() + 2);
        for &t in tri {
            for k in 0..3 {
                let next = self.across[t as usize][k];
                let locked = self.locked[t as usize] >> k & 1 == 1;
                if next != NO_TRIANGLE && self.stamp[next as usize] == turn {
                    if locked {
                        return None;
                    }
                    continue;
                }
                let c = self.tri[t as usize];
                sides.push((c[(k + 1) % 3], c[(k + 2) % 3], next, locked));
            }
        }
        // In a disc of F triangles and S sides there are (F − S)/2 + 1 nodes inside.
        if tri.len() + 2 < sides.len() || (tri.len() + sides.len()) % 2 == 1 {
            return None;
        }
        let inside = (tri.len() + 2 - sides.len()) / 2;
        let (start, mut here) = (sides[0].0, sides[0].0);
        while !sides.is_empty() {
            let k = sides.iter().position(|s| s.0 == here)?;
            let (a, b, beyond, locked) = sides.swap_remove(k);
            if patch.rim.contains(&a) {
                return None;
            }
            patch.rim.push(a);
            patch.beyond.push((beyond, locked));
            here = b;
        }
        if here != start {
            return None;
        }
        for &t in tri {
            for n in self.tri[t as usize] {
                if !patch.rim.contains(&n) && !patch.inner.contains(&n) {
                    if !self.is_free(n) {
                        return None;
                    }
                    patch.inner.push(n);
                }
            }
        }
        // Two nodes round a patch leave nothing to fill.
        (patch.inner.len() == inside && patch.rim.len() > 2).then_some(())
    }

    /// Replaces a patch by the star of a node: a node of the rim (`Star` holds the sides it does not touch), or one inside.
    ///
    /// `node` is the one inside to keep, or `None` for a new one. Returns it.
    pub fn restar(&mut self, patch: &Patch, node: Option<u32>, star: &Star, size: f64) -> u32 {
        let node = match node {
            Some(node) => node,
            None => self.new_node(),
        };
        (self.p[node as usize], self.xy[node as usize], self.size[node as usize]) = (star.p, star.xy, size);
        for n in &patch.inner {
            if *n != node {
                self.at[*n as usize] = NO_TRIANGLE;
                self.free_node.push(*n);
            }
        }
        let n = patch.rim.len();
        let sides: Vec<usize> = (0..n).collect();
        self.fan(patch, node, &sides);
        node
    }

    /// Replaces a patch by triangles over its rim, given by places in it and counter-clockwise; nodes inside go.
    pub fn refill(&mut self, patch: &Patch, triangles: &[[usize; 3]]) {
        for n in &patch.inner {
            self.at[*n as usize] = NO_TRIANGLE;
            self.free_node.push(*n);
        }
        let n = patch.rim.len();
        let mut slots = patch.tri.clone();
        while slots.len() < triangles.len() {
            slots.push(self.new_tri());
        }
        for dead in slots.drain(triangles.len()..) {
            self.tri[dead as usize] = [0; 3];
            self.across[dead as usize] = [NO_TRIANGLE; 3];
            self.free_tri.push(dead);
        }
        for (c, &t) in triangles.iter().zip(&slots) {
            self.tri[t as usize] = c.map(|i| patch.rim[i]);
            self.locked[t as usize] = 0;
            for k in 0..3 {
                let (from, to) = (c[(k + 1) % 3], c[(k + 2) % 3]);
                if to == (from + 1) % n {
                    let (beyond, locked) = patch.beyond[from];
                    self.across[t as usize][k] = beyond;
                    self.locked[t as usize] |= u8::from(locked) << k;
                    if beyond != NO_TRIANGLE {
                        self.join(beyond, patch.rim[to], patch.rim[from], t);
                    }
                } else {
                    let has = |other: &[usize; 3]| (0..3).any(|j| other[j] == to && other[(j + 1) % 3] == from);
                    self.across[t as usize][k] = triangles.iter().position(has).map_or(NO_TRIANGLE, |j| slots[j]);
                }
                self.at[patch.rim[c[k]] as usize] = t;
            }
        }
    }

    /// Replaces a patch without nodes inside by the fan of the node `k` of its rim.
    pub fn refan(&mut self, patch: &Patch, k: usize) {
        for n in &patch.inner {
            self.at[*n as usize] = NO_TRIANGLE;
            self.free_node.push(*n);
        }
        let n = patch.rim.len();
        let sides: Vec<usize> = (1..n - 1).map(|i| (k + i) % n).collect();
        self.fan(patch, patch.rim[k], &sides);
    }

    /// Triangles from a node to sides of the rim that follow each other.
    fn fan(&mut self, patch: &Patch, node: u32, sides: &[usize]) {
        let n = patch.rim.len();
        let mut slots = patch.tri.clone();
        while slots.len() < sides.len() {
            slots.push(self.new_tri());
        }
        for dead in slots.drain(sides.len()..) {
            self.tri[dead as usize] = [0; 3];
            self.across[dead as usize] = [NO_TRIANGLE; 3];
            self.free_tri.push(dead);
        }
        let round = sides.len() == n;
        let m = sides.len();
        for (i, &side) in sides.iter().enumerate() {
            let t = slots[i];
            let (a, b) = (patch.rim[side], patch.rim[(side + 1) % n]);
            let (beyond, locked) = patch.beyond[side];
            // The fan's first and last side lie on the rim when the node does.
            let (before, lock_before) = if i > 0 {
                (slots[i - 1], false)
            } else if round {
                (slots[m - 1], false)
            } else {
                patch.beyond[(side + n - 1) % n]
            };
            let (after, lock_after) = if i + 1 < m {
                (slots[i + 1], false)
            } else if round {
                (slots[0], false)
            } else {
                patch.beyond[(side + 1) % n]
            };
            self.tri[t as usize] = [node, a, b];
            self.across[t as usize] = [beyond, after, before];
            self.locked[t as usize] = u8::from(locked) | u8::from(lock_after) << 1 | u8::from(lock_before) << 2;
            for (other, from, to) in [
                (beyond, b, a),
                (if round || i + 1 < m { NO_TRIANGLE } else { after }, node, b),
                (if round || i > 0 { NO_TRIANGLE } else { before }, a, node),
            ] {
                if other != NO_TRIANGLE {
                    self.join(other, from, to, t);
                }
            }
            self.at[a as usize] = t;
            self.at[b as usize] = t;
        }
        self.at[node as usize] = slots[0];
    }

    /// The side of `t` from one node to another lies against triangle `other`.
    fn join(&mut self, t: u32, from: u32, to: u32, other: u32) {
        let c = self.tri[t as usize];
        for k in 0..3 {
            if c[(k + 1) % 3] == from && c[(k + 2) % 3] == to {
                self.across[t as usize][k] = other;
            }
        }
    }

    fn new_node(&mut self) -> u32 {
        self.free_node.pop().unwrap_or_else(|| {
            self.p.push(DVec3::ZERO);
            self.xy.push(DVec2::ZERO);
            self.size.push(0.0);
            self.at.push(NO_TRIANGLE);
            self.p.len() as u32 - 1
        })
    }

    fn new_tri(&mut self) -> u32 {
        self.free_tri.pop().unwrap_or_else(|| {
            self.tri.push([0; 3]);
            self.across.push([NO_TRIANGLE; 3]);
            self.locked.push(0);
            self.stamp.push(0);
            self.tri.len() as u32 - 1
        })
    }

    /// Numbers without gaps: live triangles and used nodes in their order; border nodes keep theirs.
    pub fn compact(&mut self) {
        let mut number = vec![u32::MAX; self.p.len()];
        let mut next = 0;
        for n in 0..self.p.len() as u32 {
            if n < self.fixed || self.at[n as usize] != NO_TRIANGLE {
                number[n as usize] = next;
                let (from, to) = (n as usize, next as usize);
                (self.p[to], self.xy[to], self.size[to]) = (self.p[from], self.xy[from], self.size[from]);
                next += 1;
            }
        }
        self.p.truncate(next as usize);
        self.xy.truncate(next as usize);
        self.size.truncate(next as usize);
        let live: Vec<u32> = (0..self.tri.len() as u32).filter(|t| self.alive(*t)).collect();
        let mut place = vec![NO_TRIANGLE; self.tri.len()];
        live.iter().enumerate().for_each(|(k, t)| place[*t as usize] = k as u32);
        self.tri = live.iter().map(|t| self.tri[*t as usize].map(|n| number[n as usize])).collect();
        self.across = live.iter().map(|t| self.across[*t as usize].map(|o| if o == NO_TRIANGLE { o } else { place[o as usize] })).collect();
        self.locked = live.iter().map(|t| self.locked[*t as usize]).collect();
        self.stamp = vec![0; live.len()];
        self.turn = 0;
        self.at = vec![NO_TRIANGLE; self.p.len()];
        for (t, c) in self.tri.iter().enumerate() {
            c.iter().for_each(|n| self.at[*n as usize] = t as u32);
        }
        self.free_tri.clear();
        self.free_node.clear();
    }

    /// Neighbours know each other, corners turn the right way, every used node knows a triangle of its own.
    pub fn check(&self) -> Result<(), String> {
        for t in (0..self.tri.len() as u32).filter(|t| self.alive(*t)) {
            if self.chart_area(t) <= 0.0 {
                return Err(format!("triangle {t} is turned over"));
            }
            for k in 0..3 {
                let other = self.across[t as usize][k];
                let c = self.tri[t as usize];
                if other == NO_TRIANGLE {
                    continue;
                }
                let j = self.side_to(other, t);
                let d = self.tri[other as usize];
                if self.across[other as usize][j] != t || d[(j + 1) % 3] != c[(k + 2) % 3] || d[(j + 2) % 3] != c[(k + 1) % 3] {
                    return Err(format!("triangles {t} and {other} do not know each other"));
                }
                if self.locked[t as usize] >> k & 1 != self.locked[other as usize] >> j & 1 {
                    return Err(format!("triangles {t} and {other} differ about their side"));
                }
            }
            for n in self.tri[t as usize] {
                let own = self.at[n as usize];
                if own == NO_TRIANGLE || !self.tri[own as usize].contains(&n) {
                    return Err(format!("node {n} does not know its triangles"));
                }
            }
        }
        Ok(())
    }
}
