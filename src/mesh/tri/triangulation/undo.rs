//! Part of a triangulation as it was: to try a change and take it back.

use glam::{DVec2, DVec3};

use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::tri::triangulation::Triangulation;

/// Largest number of free places that one change uses.
const MAX_USED_PLACES: usize = 8;

/// Some triangles with their neighbours and nodes, as they are.
#[derive(Clone, Debug, Default)]
pub struct Before {
    triangles: Vec<(u32, [u32; 3], [u32; 3], u8)>,
    nodes: Vec<(u32, DVec3, DVec2, f64, u32)>,
    /// Fractions of border nodes that slide.
    along: Vec<(u32, f64)>,
    /// Numbers of triangles and nodes.
    len: (usize, usize),
    /// Free places of triangles and nodes.
    free: [FreePlaces; 2],
}

/// The end of a list of free places.
#[derive(Clone, Debug, Default)]
struct FreePlaces {
    /// Length of the list.
    len: usize,
    /// Its last places.
    last: Vec<u32>,
}

impl FreePlaces {
    fn of(list: &[u32]) -> Self {
        Self { len: list.len(), last: list[list.len().saturating_sub(MAX_USED_PLACES)..].to_vec() }
    }

    fn put_back(&self, list: &mut Vec<u32>) {
        list.truncate(self.len - self.last.len());
        list.extend(&self.last);
    }
}

impl Triangulation {
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
        let slid = |n: &u32| Some((*n, *self.along.get(*n as usize)?));
        Before {
            along: nodes.iter().filter_map(slid).collect(),
            triangles: all.into_iter().map(triangle).collect(),
            nodes: nodes.into_iter().map(node).collect(),
            len: (self.tri.len(), self.p.len()),
            free: [FreePlaces::of(&self.free_tri), FreePlaces::of(&self.free_node)],
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
        before.free[0].put_back(&mut self.free_tri);
        before.free[1].put_back(&mut self.free_node);
        for t in &before.free[0].last {
            self.tri[*t as usize] = [0; 3];
            self.across[*t as usize] = [NO_TRIANGLE; 3];
        }
        for n in &before.free[1].last {
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
        before.along.iter().for_each(|(n, fraction)| self.along[*n as usize] = *fraction);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::triangulate_points::points;
    use crate::mesh::tri::shape::Star;
    use crate::mesh::tri::triangulation::{Patch, Ring};

    /// A square of 6 × 6 nodes, the border first.
    fn triangulation() -> Triangulation {
        let place = |k: usize| DVec2::new((k % 6) as f64 + 0.1 * (k * k % 7) as f64, (k / 6) as f64 + 0.1 * (k * k % 5) as f64);
        let on_border = |k: &usize| k.is_multiple_of(6) || k % 6 == 5 || k / 6 == 0 || k / 6 == 5;
        let (border, inner): (Vec<usize>, Vec<usize>) = (0..36).partition(on_border);
        let xy: Vec<DVec2> = border.iter().chain(&inner).map(|k| place(*k)).collect();
        let all = points(&xy, &[]).unwrap();
        let p = xy.iter().map(|p| p.extend(0.0)).collect();
        Triangulation::new(p, xy, vec![1.0; 36], border.len() as u32, &all, &vec![true; all.corners.len()])
    }

    /// All that counts: places in the lists that are free hold nothing.
    fn told(triangulation: &Triangulation) -> String {
        let live: Vec<_> = (0..triangulation.tri.len())
            .filter(|t| triangulation.alive(*t as u32))
            .map(|t| (t, triangulation.tri[t], triangulation.across[t], triangulation.locked[t]))
            .collect();
        let used: Vec<_> = (0..triangulation.p.len())
            .filter(|n| triangulation.at[*n] != NO_TRIANGLE)
            .map(|n| (n, triangulation.at[n], triangulation.p[n], triangulation.xy[n], triangulation.size[n]))
            .collect();
        format!(
            "{live:?} {used:?} {:?} {:?} {} {}",
            triangulation.free_tri,
            triangulation.free_node,
            triangulation.tri.len(),
            triangulation.p.len()
        )
    }

    fn takes_back(triangulation: &mut Triangulation, some: &[u32], change: impl FnOnce(&mut Triangulation)) {
        let (as_it_was, before) = (told(triangulation), triangulation.before(some));
        change(triangulation);
        assert_ne!(told(triangulation), as_it_was);
        triangulation.put_back(&before);
        assert_eq!(told(triangulation), as_it_was);
    }

    #[test]
    fn every_change_is_taken_back() {
        let (mut triangulation, mut patch, mut ring, mut tried) = (triangulation(), Patch::default(), Ring::default(), [0; 3]);
        // The second time with free places.
        for round in 0..2 {
            for t in (0..triangulation.tri.len() as u32).filter(|t| triangulation.alive(*t)).collect::<Vec<_>>() {
                for k in (0..3).filter(|k| triangulation.locked[t as usize] >> k & 1 == 0).collect::<Vec<_>>() {
                    let pair = [t, triangulation.across[t as usize][k]];
                    takes_back(&mut triangulation, &pair, |triangulation| triangulation.flip(t, k));
                    if triangulation.patch(&pair, &mut patch).is_some() {
                        let star = Star { xy: DVec2::ONE, p: DVec3::ONE, worst: 1.0 };
                        takes_back(&mut triangulation, &pair, |triangulation| _ = triangulation.restar(&patch, None, &star, 0.5));
                        tried[0] += 1;
                    }
                }
                for node in triangulation.tri[t as usize].into_iter().filter(|n| triangulation.is_free(*n)).collect::<Vec<_>>() {
                    triangulation.ring(node, &mut ring);
                    assert!(triangulation.patch(&ring.tri, &mut patch).is_some());
                    takes_back(&mut triangulation, &ring.tri, |triangulation| {
                        triangulation.refan(&patch, 0);
                        triangulation.p[patch.rim[1] as usize] = DVec3::ONE;
                    });
                    tried[1 + round] += 1;
                }
            }
            if round == 0 {
                triangulation.ring(triangulation.fixed, &mut ring);
                triangulation.patch(&ring.tri, &mut patch).unwrap();
                triangulation.refan(&patch, 0);
            }
        }
        assert!(tried.iter().all(|n| *n > 20), "{tried:?}");
    }
}
