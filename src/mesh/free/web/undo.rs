//! Part of a web as it was: to try a change and take it back.

use glam::{DVec2, DVec3};

use super::Web;
use crate::base::triangulate_points::NO_TRIANGLE;

/// Free places that one change may take.
const DEEP: usize = 8;

/// Some triangles with their neighbours and nodes, as they are.
#[derive(Clone, Debug, Default)]
pub struct Before {
    triangles: Vec<(u32, [u32; 3], [u32; 3], u8)>,
    nodes: Vec<(u32, DVec3, DVec2, f64, u32)>,
    /// Numbers of triangles and nodes.
    len: (usize, usize),
    /// Free places of triangles and nodes: how many, and the last of them.
    free: [(usize, Vec<u32>); 2],
}

fn last(free: &[u32]) -> (usize, Vec<u32>) {
    (free.len(), free[free.len().saturating_sub(DEEP)..].to_vec())
}

fn put_back(free: &mut Vec<u32>, (len, last): &(usize, Vec<u32>)) {
    free.truncate(len - last.len());
    free.extend(last);
}

impl Web {
    /// All that one flip or patch inside some triangles can change, and moves of their nodes.
    pub fn before(&self, some: &[u32]) -> Before {
        let beyond = some.iter().flat_map(|t| self.across[*t as usize]).filter(|t| *t != NO_TRIANGLE);
        let mut all: Vec<u32> = some.iter().copied().chain(beyond).collect();
        all.sort_unstable();
        all.dedup();
        let mut nodes: Vec<u32> = all.iter().flat_map(|t| self.tri[*t as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let triangle = |t: u32| (t, self.tri[t as usize], self.across[t as usize], self.locked[t as usize]);
        let node = |n: u32| {
            let k = n as usize;
            (n, self.p[k], self.xy[k], self.size[k], self.at[k])
        };
        Before {
            triangles: all.into_iter().map(triangle).collect(),
            nodes: nodes.into_iter().map(node).collect(),
            len: (self.tri.len(), self.p.len()),
            free: [last(&self.free_tri), last(&self.free_node)],
        }
    }

    /// All as it was.
    pub fn put_back(&mut self, before: &Before) {
        let (triangles, nodes) = before.len;
        self.tri.truncate(triangles);
        self.across.truncate(triangles);
        self.locked.truncate(triangles);
        self.stamp.truncate(triangles);
        self.p.truncate(nodes);
        self.xy.truncate(nodes);
        self.size.truncate(nodes);
        self.at.truncate(nodes);
        put_back(&mut self.free_tri, &before.free[0]);
        put_back(&mut self.free_node, &before.free[1]);
        for t in &before.free[0].1 {
            self.tri[*t as usize] = [0; 3];
            self.across[*t as usize] = [NO_TRIANGLE; 3];
        }
        for n in &before.free[1].1 {
            self.at[*n as usize] = NO_TRIANGLE;
        }
        for &(t, tri, across, locked) in &before.triangles {
            let t = t as usize;
            (self.tri[t], self.across[t], self.locked[t]) = (tri, across, locked);
        }
        for &(n, p, xy, size, at) in &before.nodes {
            let n = n as usize;
            (self.p[n], self.xy[n], self.size[n], self.at[n]) = (p, xy, size, at);
        }
    }
}
