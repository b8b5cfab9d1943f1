//! Triangles that know their neighbours; they change by flips and by patches made anew.

pub mod check;
pub mod flip;
pub mod patch;
pub mod undo;

pub use crate::mesh::tri::triangulation::patch::Patch;

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::triangulate_points::{NO_TRIANGLE, Triangles};
use crate::mesh::chart::outline::area2;
use crate::mesh::tri::shape::quality;

/// A triangulation on a surface: border nodes first, which keep their place or slide along the border, then inner ones.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    /// Points.
    pub p: Vec<DVec3>,
    /// Their places in the chart.
    pub xy: Vec<DVec2>,
    /// Wanted lengths.
    pub size: Vec<f64>,
    /// Number of border nodes.
    pub fixed: u32,
    /// Where border nodes that slide are along their segments, as fractions of the length; empty where none does.
    pub along: Vec<f64>,
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

/// Triangles from which on their order in memory matters: below it a face lies in the cache.
const LARGE: usize = 1 << 15;

/// The kept triangles, those of a large face in the order of their first nodes: nodes that grew one after the other lie beside each
/// other, so that what is near is near in memory too.
fn by_nodes(all: &Triangles, kept: &[bool], nodes: usize) -> Vec<u32> {
    if kept.len() < LARGE {
        return (0..kept.len() as u32).filter(|t| kept[*t as usize]).collect();
    }
    let first = |t: usize| all.corners[t].into_iter().fold(u32::MAX, u32::min) as usize;
    let mut from = vec![0_u32; nodes + 1];
    (0..kept.len()).filter(|t| kept[*t]).for_each(|t| from[first(t) + 1] += 1);
    for k in job::looking(0..nodes) {
        from[k + 1] += from[k];
    }
    let mut order = vec![0; from[nodes] as usize];
    for t in (0..kept.len()).filter(|t| kept[*t]) {
        job::poll();
        let slot = &mut from[first(t)];
        order[*slot as usize] = t as u32;
        *slot += 1;
    }
    order
}

impl Triangulation {
    /// From triangles of which the kept ones are marked, over border and inner nodes.
    pub fn new(p: Vec<DVec3>, xy: Vec<DVec2>, size: Vec<f64>, fixed: u32, all: &Triangles, kept: &[bool]) -> Self {
        let order = by_nodes(all, kept, p.len());
        let n = order.len();
        let mut number = vec![NO_TRIANGLE; kept.len()];
        order.iter().enumerate().for_each(|(k, t)| number[*t as usize] = k as u32);
        let mut triangulation = Self { at: vec![NO_TRIANGLE; p.len()], p, xy, size, fixed, ..Self::default() };
        triangulation.tri.reserve_exact(n);
        triangulation.across.reserve_exact(n);
        triangulation.locked.reserve_exact(n);
        for k in order.into_iter().map(|k| k as usize) {
            job::poll();
            let across = all.across[k].map(|t| if t == NO_TRIANGLE { t } else { number[t as usize] });
            let open = (0..3).filter(|c| across[*c] == NO_TRIANGLE).fold(0, |bits, c| bits | 1 << c);
            for c in all.corners[k] {
                triangulation.at[c as usize] = triangulation.tri.len() as u32;
            }
            triangulation.tri.push(all.corners[k]);
            triangulation.across.push(across);
            triangulation.locked.push(all.given[k] | open);
        }
        triangulation.stamp = vec![0; n];
        triangulation
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

    /// Quality of what three nodes make; 1 where two of the border are one point, as at a pole: that is no triangle in space.
    pub fn shape(&self, corners: [u32; 3]) -> f64 {
        let [a, b, c] = corners.map(|n| self.p[n as usize]);
        let one = |i: usize, j: usize| {
            !self.is_free(corners[i]) && !self.is_free(corners[j]) && self.p[corners[i] as usize] == self.p[corners[j] as usize]
        };
        if one(0, 1) || one(1, 2) || one(2, 0) { 1.0 } else { quality(a, b, c) }
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

    /// The nodes of some triangles, ascending.
    pub fn nodes_of(&self, some: &[u32]) -> Vec<u32> {
        let mut nodes: Vec<u32> = some.iter().flat_map(|t| self.tri[*t as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
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
            // A triangulation that hangs together wrongly is found before it takes all memory.
            assert!(ring.tri.len() <= self.tri.len(), "triangles go round node {node} for ever");
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

    /// Numbers without gaps: live triangles and used nodes in their order; border nodes keep theirs.
    pub fn compact(&mut self) {
        let mut number = vec![u32::MAX; self.p.len()];
        let mut next = 0;
        for n in 0..self.p.len() as u32 {
            job::poll();
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
        let mut place = vec![NO_TRIANGLE; self.tri.len()];
        let mut live = 0;
        for t in job::looking(0..self.tri.len()) {
            if self.alive(t as u32) {
                place[t] = live as u32;
                (self.tri[live], self.across[live], self.locked[live]) = (self.tri[t], self.across[t], self.locked[t]);
                live += 1;
            }
        }
        self.tri.truncate(live);
        self.across.truncate(live);
        self.locked.truncate(live);
        self.tri.iter_mut().for_each(|c| *c = c.map(|n| number[n as usize]));
        self.across.iter_mut().for_each(|a| *a = a.map(|o| if o == NO_TRIANGLE { o } else { place[o as usize] }));
        self.stamp.clear();
        self.stamp.resize(live, 0);
        self.turn = 0;
        self.at.clear();
        self.at.resize(self.p.len(), NO_TRIANGLE);
        for (t, c) in job::looking(self.tri.iter().enumerate()) {
            c.iter().for_each(|n| self.at[*n as usize] = t as u32);
        }
        self.free_tri.clear();
        self.free_node.clear();
    }
}
