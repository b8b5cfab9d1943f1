//! In how many pieces a mesh is.

use crate::base::job;
use crate::mesh::data::mesh::Mesh;
use crate::model::glue::join;

impl Mesh {
    /// Number of parts that share no node with each other: elements joined by nodes are one part, and a node that is an element of
    /// its own is one where no other element has it.
    pub fn parts(&self) -> usize {
        let mut parent: Vec<usize> = (0..self.nodes.len()).collect();
        let mut used = vec![false; self.nodes.len()];
        let mut one = |corners: &[u32]| {
            for pair in corners.windows(2) {
                join(&mut parent, pair[0] as usize, pair[1] as usize);
            }
            corners.iter().for_each(|n| used[*n as usize] = true);
        };
        self.lines.iter().for_each(|e| one(e));
        job::looking(&self.triangles).for_each(|e| one(e));
        job::looking(&self.quads).for_each(|e| one(e));
        self.points.iter().for_each(|n| one(&[*n]));
        (0..self.nodes.len()).filter(|n| used[*n] && parent[*n] == *n).count()
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
