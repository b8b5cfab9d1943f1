//! Edges of the elements of a mesh, with how often elements run along them each way.

use std::collections::BTreeSet;

use crate::base::job;
use crate::mesh::data::mesh::Mesh;

/// An edge of triangles and quads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeUse {
    /// Its nodes, the lower one first.
    pub nodes: [u32; 2],
    /// Elements that run along it from the lower node to the higher one.
    pub forwards: u32,
    /// Elements that run along it from the higher node to the lower one.
    pub backwards: u32,
}

/// Sides of all elements by their lower nodes: a counting sort, in time and memory linear in the number of sides. The sides of as many
/// elements as a mesh may have (`base::limits::MESH_ELEMENTS_MOST`) are counted with 32 bits.
struct SidesByNode {
    /// Where the sides of each node begin.
    starts: Vec<u32>,
    /// The higher node of each side, doubled, plus 1 where the element runs from it; those of one node ascend.
    ends: Vec<u32>,
}

impl SidesByNode {
    fn new(mesh: &Mesh) -> Self {
        let mut starts = vec![0_u32; mesh.nodes.len() + 1];
        each_side(mesh, |a, b| starts[a.min(b) as usize + 1] += 1);
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut ends = vec![0_u32; starts[mesh.nodes.len()] as usize];
        // Afterwards each start is where the next one was: the list moves by one node.
        each_side(mesh, |a, b| {
            let next = &mut starts[a.min(b) as usize];
            ends[*next as usize] = 2 * a.max(b) + u32::from(a > b);
            *next += 1;
        });
        starts.copy_within(..mesh.nodes.len(), 1);
        starts[0] = 0;
        job::looking(starts.windows(2)).for_each(|w| ends[w[0] as usize..w[1] as usize].sort_unstable());
        Self { starts, ends }
    }

    fn edges(&self) -> impl Iterator<Item = EdgeUse> {
        let of_node = |(low, w): (usize, &[u32])| {
            let sides = &self.ends[w[0] as usize..w[1] as usize];
            sides.chunk_by(|a, b| a / 2 == b / 2).map(move |same| {
                let backwards = same.iter().filter(|side| *side % 2 == 1).count() as u32;
                EdgeUse { nodes: [low as u32, same[0] / 2], forwards: same.len() as u32 - backwards, backwards }
            })
        };
        job::looking(self.starts.windows(2)).enumerate().flat_map(of_node)
    }
}

/// Calls `side` with the two nodes of every side of every triangle and quad, as the element runs.
fn each_side(mesh: &Mesh, mut side: impl FnMut(u32, u32)) {
    job::looking(&mesh.triangles).for_each(|[a, b, c]| {
        side(*a, *b);
        side(*b, *c);
        side(*c, *a);
    });
    job::looking(&mesh.quads).for_each(|[a, b, c, d]| {
        side(*a, *b);
        side(*b, *c);
        side(*c, *d);
        side(*d, *a);
    });
}

impl Mesh {
    /// Whether each edge of the faces is used as often in one sense as in the other: a closed skin without gaps, which may touch itself along
    /// an edge, but has no element twice.
    pub fn is_watertight(&self) -> bool {
        if self.triangles.is_empty() && self.quads.is_empty() {
            return false;
        }
        // Each direction adds or subtracts a pseudo-random number drawn from the nodes: the sum is not zero where an edge is used once only.
        let mut left_over = 0_u64;
        each_side(self, |a, b| left_over = left_over.wrapping_add(signed(a, b)));
        let mut shared = BTreeSet::new();
        let is_even = |edge: EdgeUse| {
            if edge.forwards > 1 {
                shared.insert(edge.nodes);
            }
            edge.forwards == edge.backwards
        };
        left_over == 0 && SidesByNode::new(self).edges().all(is_even) && !self.has_twice(&shared)
    }

    /// Whether two elements at some edges have the same nodes.
    fn has_twice(&self, edges: &BTreeSet<[u32; 2]>) -> bool {
        let mut seen = BTreeSet::new();
        let mut is_again = |mut nodes: Vec<u32>| {
            let sides = nodes.iter().zip(nodes.iter().cycle().skip(1));
            let at_edge = sides.map(|(a, b)| [*a.min(b), *a.max(b)]).any(|edge| edges.contains(&edge));
            nodes.sort_unstable();
            at_edge && !seen.insert(nodes)
        };
        !edges.is_empty() && (self.triangles.iter().any(|t| is_again(t.to_vec())) || self.quads.iter().any(|q| is_again(q.to_vec())))
    }

    /// Lengths of all edges (of lines, triangles and quads), each once, model units, in the order of their nodes.
    pub fn edge_lengths(&self) -> Vec<f64> {
        let mut edges: Vec<[u32; 2]> = SidesByNode::new(self).edges().map(|edge| edge.nodes).collect();
        if !self.lines.is_empty() {
            edges.extend(self.lines.iter().map(|l| [l[0].min(l[1]), l[0].max(l[1])]));
            job::sort(&mut edges);
            edges.dedup();
        }
        job::looking(&edges).map(|[a, b]| self.nodes[*a as usize].distance(self.nodes[*b as usize])).collect()
    }
}

/// A pseudo-random number for an edge, negative (modulo 2^64) from its higher node to its lower one: sums of others equal it by chance only.
/// The finaliser of SplitMix [Steele, Lea & Flood 2014].
pub fn signed(from: u32, to: u32) -> u64 {
    let (low, high) = (from.min(to), from.max(to));
    let mut x = (u64::from(high) << 32 | u64::from(low)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    // Minus without a branch.
    let sign = u64::from(from > to).wrapping_neg();
    (x ^ sign).wrapping_sub(sign)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn tetrahedron(triangles: &[[u32; 3]]) -> Mesh {
        let nodes = [[0.; 3], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(DVec3::from_array).to_vec();
        Mesh { nodes, triangles: triangles.to_vec(), order: 1, ..Mesh::default() }
    }

    #[test]
    fn a_tetrahedron_is_watertight_until_a_face_is_turned_missing_or_there_twice() {
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        assert!(tetrahedron(&faces).is_watertight());
        assert!(!tetrahedron(&faces[1..]).is_watertight());
        let mut turned = faces;
        turned[0].swap(1, 2);
        assert!(!tetrahedron(&turned).is_watertight());
        let twice = [faces, faces].concat();
        assert!(!tetrahedron(&twice).is_watertight(), "the signed sum is nothing, the counts are two");
        assert_eq!(tetrahedron(&faces).edge_lengths().len(), 6);
        assert!(!tetrahedron(&[]).is_watertight());
    }

    #[test]
    fn edges_come_in_order_with_their_uses() {
        let mut mesh = tetrahedron(&[[2, 0, 1], [1, 0, 3]]);
        let found: Vec<_> = SidesByNode::new(&mesh).edges().map(|e| (e.nodes, e.forwards, e.backwards)).collect();
        assert_eq!(found, [([0, 1], 1, 1), ([0, 2], 0, 1), ([0, 3], 1, 0), ([1, 2], 1, 0), ([1, 3], 0, 1)]);
        mesh.lines = vec![[3, 2], [1, 0]];
        assert_eq!(mesh.edge_lengths().len(), 6);
    }
}
