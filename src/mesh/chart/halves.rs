//! A border of which every second node is left out: the border of cells that are halved afterwards.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::mesh::chart::outline::Outline;

/// A border with that of its cells.
#[derive(Clone, Debug, Default)]
pub struct Halves {
    /// Points of all nodes.
    pub p: Vec<DVec3>,
    /// Their places in the chart.
    pub xy: Vec<DVec2>,
    /// The border of the cells.
    pub outline: Outline,
    /// The place of each of its nodes in the whole border.
    pub of: Vec<u32>,
    /// Numbers of the nodes of the cells' border in the mesh.
    ids: Vec<u32>,
    /// Edges of the cells' border, lower node first, with the node in the middle of each.
    mids: Vec<([u32; 2], u32)>,
}

impl Halves {
    /// The border itself: its edges are not halved.
    pub fn whole(outline: &Outline, ids: &[u32]) -> Self {
        Self {
            p: outline.p.clone(),
            xy: outline.xy.clone(),
            outline: outline.clone(),
            of: (0..outline.p.len() as u32).collect(),
            ids: ids.to_vec(),
            mids: Vec::new(),
        }
    }

    /// Two edges at a time; `middle` gives the places of nodes that are in the middle of two, `ids` are numbers in the mesh.
    ///
    /// `None` where edges at a middle node do not follow each other.
    pub fn new(outline: &Outline, ids: &[u32], middle: impl Fn(u32) -> bool) -> Option<Self> {
        let of: Vec<u32> = (0..outline.p.len() as u32).filter(|n| !middle(*n)).collect();
        let mut place = vec![NONE; outline.p.len()];
        of.iter().enumerate().for_each(|(k, n)| place[*n as usize] = k as u32);
        let (loops, mut mids) = halved(&outline.loops, &place)?;
        let (lines, inner) = halved(&outline.lines, &place)?;
        mids.extend(inner);
        mids.sort_unstable();
        Some(Self {
            p: outline.p.clone(),
            xy: outline.xy.clone(),
            outline: Outline {
                xy: of.iter().map(|n| outline.xy[*n as usize]).collect(),
                p: of.iter().map(|n| outline.p[*n as usize]).collect(),
                loops,
                lines,
            },
            ids: of.iter().map(|n| ids[*n as usize]).collect(),
            of,
            mids,
        })
    }

    /// The node in the middle of an edge of the cells' border; [`NONE`] where there is none.
    pub fn mid(&self, a: u32, b: u32) -> u32 {
        let key = [a.min(b), a.max(b)];
        self.mids.binary_search_by_key(&key, |m| m.0).map_or(NONE, |k| self.mids[k].1)
    }

    /// The number in the mesh of a node of the cells' border; [`NONE`] of inner nodes.
    pub fn id(&self, n: u32) -> u32 {
        self.ids.get(n as usize).copied().unwrap_or(NONE)
    }
}

/// Edges and the nodes in their middles.
type Halved = (Vec<[u32; 2]>, Vec<([u32; 2], u32)>);

/// Every two edges that meet in a node without a place as one, where the first of them is.
pub(crate) fn halved(edges: &[[u32; 2]], place: &[u32]) -> Option<Halved> {
    // Edges into and out of each middle node; one that is run twice has two of each.
    let mut at: Vec<(Vec<usize>, Vec<usize>)> = vec![Default::default(); place.len()];
    for (k, [a, b]) in edges.iter().enumerate() {
        job::poll();
        at[*b as usize].0.push(k);
        at[*a as usize].1.push(k);
    }
    let mut done = vec![false; edges.len()];
    let (mut found, mut mids) = (Vec::new(), Vec::new());
    for (k, [a, b]) in edges.iter().enumerate() {
        job::poll();
        if done[k] {
            continue;
        }
        let mid = match [*a, *b].map(|n| place[n as usize] == NONE) {
            [false, false] => {
                found.push([place[*a as usize], place[*b as usize]]);
                continue;
            }
            [true, true] => return None,
            [true, false] => *a,
            [false, true] => *b,
        };
        let (into, out) = &at[mid as usize];
        // The way back along the same edge comes last.
        let other = if mid == *b {
            let open = out.iter().filter(|o| !done[**o]);
            open.min_by_key(|o| edges[**o][1] == *a)
        } else {
            let open = into.iter().filter(|o| !done[**o]);
            open.min_by_key(|o| edges[**o][0] == *b)
        };
        let other = *other?;
        let edge = if mid == *b { [*a, edges[other][1]] } else { [edges[other][0], *b] }.map(|n| place[n as usize]);
        (!edge.contains(&NONE) && edge[0] != edge[1]).then_some(())?;
        (done[k], done[other]) = (true, true);
        mids.push(([edge[0].min(edge[1]), edge[0].max(edge[1])], mid));
        found.push(edge);
    }
    Some((found, mids))
}

/// Where there is no node, face or side.
pub const NONE: u32 = u32::MAX;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_joined_two_by_two_whichever_way_they_run() {
        let place = [0, NONE, 1, NONE];
        let joined = (vec![[0, 1], [1, 0]], vec![([0, 1], 1), ([0, 1], 3)]);
        assert_eq!(halved(&[[0, 1], [1, 2], [2, 3], [3, 0]], &place), Some(joined));
        assert_eq!(halved(&[[1, 0], [2, 1]], &place), Some((vec![[1, 0]], vec![([0, 1], 1)])));
        // An edge that is a point in space stays.
        assert_eq!(halved(&[[0, 2]], &place), Some((vec![[0, 1]], vec![])));
        assert_eq!(halved(&[[0, 1], [2, 3]], &place), None);
    }
}
