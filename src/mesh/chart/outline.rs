//! The border of a face in its chart: nodes, edges between them, lines inside.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::PARALLEL;
use crate::base::triangulate_points::{NO_TRIANGLE, Triangles};

/// A border: nodes that are given and edges that must be there.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// Places in the chart.
    pub xy: Vec<DVec2>,
    /// Points in space; never evaluated again.
    pub p: Vec<DVec3>,
    /// Edges of the loops with the face on their left.
    pub loops: Vec<[u32; 2]>,
    /// Edges of lines inside the face.
    pub lines: Vec<[u32; 2]>,
}

impl Outline {
    /// All edges, loops first.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.loops.iter().chain(&self.lines).copied()
    }

    /// Edge `k` of [`Outline::edges`].
    pub fn edge(&self, k: u32) -> [u32; 2] {
        let k = k as usize;
        if k < self.loops.len() { self.loops[k] } else { self.lines[k - self.loops.len()] }
    }

    /// For each node the others that are the same point at another place of the chart: over a seam, at a pole.
    pub fn twins(&self) -> Vec<Vec<u32>> {
        let bits = |n: u32| self.p[n as usize].to_array().map(f64::to_bits);
        let mut order: Vec<u32> = (0..self.p.len() as u32).collect();
        order.sort_by_key(|n| (bits(*n), *n));
        let mut twins = vec![Vec::new(); self.p.len()];
        for same in order.chunk_by(|a, b| bits(*a) == bits(*b)) {
            for n in same {
                twins[*n as usize] = same.iter().copied().filter(|m| m != n).collect();
            }
        }
        twins
    }

    /// Area inside the loops in the chart, about that in space.
    pub fn area(&self) -> f64 {
        0.5 * self.loops.iter().map(|[a, b]| self.xy[*a as usize].perp_dot(self.xy[*b as usize])).sum::<f64>().abs()
    }

    /// Length of an edge in space.
    pub fn length(&self, [a, b]: [u32; 2]) -> f64 {
        self.p[a as usize].distance(self.p[b as usize])
    }
}

/// Twice the signed area of a triangle in the chart.
pub fn area2(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether three places of the chart lie on one line but for rounding.
pub fn in_line(a: DVec2, b: DVec2, c: DVec2) -> bool {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    area2(a, b, c).abs() <= PARALLEL * longest
}

/// Whether a triangle of the chart is counter-clockwise by more than rounding.
pub fn is_left(a: DVec2, b: DVec2, c: DVec2) -> bool {
    area2(a, b, c) > 0.0 && !in_line(a, b, c)
}

/// Whether two segments of the chart cross or touch.
pub fn cross(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let (s, t) = (area2(a, b, c), area2(a, b, d));
    let (u, v) = (area2(c, d, a), area2(c, d, b));
    s * t <= 0.0 && u * v <= 0.0
}

/// Triangles left of an odd number of loop edges: flooded from outside, each loop edge turning in and out.
pub(crate) fn inside(all: &Triangles, outline: &Outline) -> Vec<bool> {
    let mut loops: Vec<(u32, u32)> = outline.loops.iter().map(|e| (e[0].min(e[1]), e[0].max(e[1]))).collect();
    loops.sort_unstable();
    // An edge that is run twice (a slit) bounds nothing.
    let turns = |a: u32, b: u32| {
        let key = (a.min(b), a.max(b));
        let first = loops.partition_point(|e| *e < key);
        loops[first..].iter().take_while(|e| **e == key).count() % 2 == 1
    };
    let crosses = |t: usize, k: usize| all.given[t] >> k & 1 == 1 && turns(all.corners[t][(k + 1) % 3], all.corners[t][(k + 2) % 3]);
    let mut state = vec![2_u8; all.corners.len()];
    let mut open = Vec::new();
    for (t, across) in job::looking(all.across.iter().enumerate()) {
        if let Some(k) = across.iter().position(|next| *next == NO_TRIANGLE) {
            state[t] = u8::from(crosses(t, k));
            open.push(t);
        }
    }
    while let Some(t) = open.pop() {
        job::poll();
        for k in 0..3 {
            let next = all.across[t][k];
            if next != NO_TRIANGLE && state[next as usize] == 2 {
                state[next as usize] = state[t] ^ u8::from(crosses(t, k));
                open.push(next as usize);
            }
        }
    }
    state.into_iter().map(|s| s == 1).collect()
}
