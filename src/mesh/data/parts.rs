//! In how many pieces a mesh is.

use crate::base::job;
use crate::mesh::data::mesh::Mesh;

impl Mesh {
    /// Number of parts that share no node with each other: elements joined by nodes are one part, and a node that is an element of
    /// its own is one where no other element has it.
    pub fn parts(&self) -> usize {
        let mut parent: Vec<u32> = (0..self.nodes.len() as u32).collect();
        let mut used = vec![false; self.nodes.len()];
        let mut one = |corners: &[u32]| {
            for pair in corners.windows(2) {
                join(&mut parent, pair[0], pair[1]);
            }
            corners.iter().for_each(|n| used[*n as usize] = true);
        };
        self.lines.iter().for_each(|e| one(e));
        job::looking(&self.triangles).for_each(|e| one(e));
        job::looking(&self.quads).for_each(|e| one(e));
        self.points.iter().for_each(|n| one(&[*n]));
        (0..self.nodes.len()).filter(|n| used[*n] && parent[*n] as usize == *n).count()
    }
}

/// The first node of a part; halves the way there [Tarjan & van Leeuwen 1984].
fn first_of(parent: &mut [u32], mut n: u32) -> u32 {
    while parent[n as usize] != n {
        parent[n as usize] = parent[parent[n as usize] as usize];
        n = parent[n as usize];
    }
    n
}

/// Makes the parts of two nodes one.
fn join(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (first_of(parent, a), first_of(parent, b));
    parent[a.max(b) as usize] = a.min(b);
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
