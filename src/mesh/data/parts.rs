//! In how many pieces a mesh is.

use crate::base::job;
use crate::mesh::data::mesh::Mesh;

impl Mesh {
    /// Number of parts that share no node with each other: elements joined by nodes are one part, and a node that is an element of
    /// its own is one where no other element has it.
    pub fn parts(&self) -> usize {
        let mut parent = vec![UNUSED; self.nodes.len()];
        let mut roots = 0;
        let mut one = |corners: &[u32]| {
            let Some((first, others)) = corners.split_first() else { return };
            let mut root = first_of(&mut parent, *first);
            if root == UNUSED {
                (parent[*first as usize], root) = (*first, *first);
                roots += 1;
            }
            for other in others {
                let own = first_of(&mut parent, *other);
                if own == UNUSED {
                    parent[*other as usize] = root;
                } else if own != root {
                    let low = own.min(root);
                    parent[own.max(root) as usize] = low;
                    (root, roots) = (low, roots - 1);
                }
            }
        };
        self.lines.iter().for_each(|e| one(e));
        job::looking(&self.triangles).for_each(|e| one(e));
        job::looking(&self.quads).for_each(|e| one(e));
        self.points.iter().for_each(|n| one(&[*n]));
        roots
    }
}

/// A node that no element before has had.
const UNUSED: u32 = u32::MAX;

/// The first node of the part of a node, or [`UNUSED`]; halves the way there [Tarjan & van Leeuwen 1984].
fn first_of(parent: &mut [u32], mut n: u32) -> u32 {
    loop {
        let up = parent[n as usize];
        if up == n || up == UNUSED {
            return up;
        }
        let next = parent[up as usize];
        if next == up {
            return up;
        }
        parent[n as usize] = next;
        n = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn parts_are_joined_by_nodes_alone() {
        let nodes = (0..12).map(|k| DVec3::new(f64::from(k % 2), f64::from(k / 2), 0.0)).collect();
        let mut mesh = Mesh { nodes, order: 1, ..Mesh::default() };
        assert_eq!(mesh.parts(), 0);
        mesh.triangles = vec![[4, 5, 6], [0, 1, 2]];
        mesh.quads = vec![[8, 9, 10, 7]];
        assert_eq!(mesh.parts(), 3);
        mesh.lines = vec![[10, 6]];
        assert_eq!(mesh.parts(), 2);
        mesh.points = vec![0, 11];
        assert_eq!(mesh.parts(), 3);
    }
}
