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
        let nodes = self.nodes_of(&all);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::triangulate_points::points;
    use crate::mesh::free::shape::Star;
    use crate::mesh::free::web::{Patch, Ring};

    /// A square of 6 × 6 nodes, the border first.
    fn web() -> Web {
        let place = |k: usize| DVec2::new((k % 6) as f64 + 0.1 * (k * k % 7) as f64, (k / 6) as f64 + 0.1 * (k * k % 5) as f64);
        let on_border = |k: &usize| k.is_multiple_of(6) || k % 6 == 5 || k / 6 == 0 || k / 6 == 5;
        let (border, inner): (Vec<usize>, Vec<usize>) = (0..36).partition(on_border);
        let xy: Vec<DVec2> = border.iter().chain(&inner).map(|k| place(*k)).collect();
        let all = points(&xy, &[]).unwrap();
        let p = xy.iter().map(|p| p.extend(0.0)).collect();
        Web::new(p, xy, vec![1.0; 36], border.len() as u32, &all, &vec![true; all.corners.len()])
    }

    /// All that counts: places in the lists that are free hold nothing.
    fn told(web: &Web) -> String {
        let live: Vec<_> =
            (0..web.tri.len()).filter(|t| web.alive(*t as u32)).map(|t| (t, web.tri[t], web.across[t], web.locked[t])).collect();
        let used: Vec<_> =
            (0..web.p.len()).filter(|n| web.at[*n] != NO_TRIANGLE).map(|n| (n, web.at[n], web.p[n], web.xy[n], web.size[n])).collect();
        format!("{live:?} {used:?} {:?} {:?} {} {}", web.free_tri, web.free_node, web.tri.len(), web.p.len())
    }

    fn takes_back(web: &mut Web, some: &[u32], change: impl FnOnce(&mut Web)) {
        let (as_it_was, before) = (told(web), web.before(some));
        change(web);
        assert_ne!(told(web), as_it_was);
        web.put_back(&before);
        assert_eq!(told(web), as_it_was);
    }

    #[test]
    fn every_change_is_taken_back() {
        let (mut web, mut patch, mut ring, mut tried) = (web(), Patch::default(), Ring::default(), [0; 3]);
        // The second time with free places.
        for round in 0..2 {
            for t in (0..web.tri.len() as u32).filter(|t| web.alive(*t)).collect::<Vec<_>>() {
                for k in (0..3).filter(|k| web.locked[t as usize] >> k & 1 == 0).collect::<Vec<_>>() {
                    let pair = [t, web.across[t as usize][k]];
                    takes_back(&mut web, &pair, |web| web.flip(t, k));
                    if web.patch(&pair, &mut patch).is_some() {
                        let star = Star { xy: DVec2::ONE, p: DVec3::ONE, worst: 1.0 };
                        takes_back(&mut web, &pair, |web| _ = web.restar(&patch, None, &star, 0.5));
                        tried[0] += 1;
                    }
                }
                for node in web.tri[t as usize].into_iter().filter(|n| web.is_free(*n)).collect::<Vec<_>>() {
                    web.ring(node, &mut ring);
                    assert!(web.patch(&ring.tri, &mut patch).is_some());
                    takes_back(&mut web, &ring.tri, |web| {
                        web.refan(&patch, 0);
                        web.p[patch.rim[1] as usize] = DVec3::ONE;
                    });
                    tried[1 + round] += 1;
                }
            }
            if round == 0 {
                web.ring(web.fixed, &mut ring);
                web.patch(&ring.tri, &mut patch).unwrap();
                web.refan(&patch, 0);
            }
        }
        assert!(tried.iter().all(|n| *n > 20), "{tried:?}");
    }
}
