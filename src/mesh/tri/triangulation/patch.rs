//! A patch of triangles made anew: as the star of a node, as a fan from its rim, or as given.

use glam::{DVec2, DVec3};

use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::tri::shape::Star;
use crate::mesh::tri::triangulation::Triangulation;

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
    /// Sides that are not in the rim yet: from, to, the triangle beyond, and whether it is locked.
    sides: Vec<(u32, u32, u32, bool)>,
}

impl Triangulation {
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
        let sides = &mut patch.sides;
        sides.clear();
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
}
