//! What a sound mesh is, as far as its arrays show: of every mesh, whether it was made, loaded from a store or read from a file.
//! Conditions on the elements of its faces are checked by `verify::face_check`, for every face when it is made.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::base::job;
use crate::mesh::data::mesh::{FaceRange, Group, Mesh};

/// What is wrong, in a sentence.
type Checked = Result<(), String>;

/// A corner node and the next one, the lower one first.
type Edge = (u32, u32);

impl Mesh {
    /// Nodes are somewhere, elements have nodes that are there and none twice, mid nodes belong to one edge each, elements to one
    /// face each, sets are in order. Of a mesh that was made and not read: each node belongs to something, no edge to more than two
    /// elements of a face, and sets have names of their own.
    pub fn check(&self) -> Checked {
        if let Some(n) = self.nodes.iter().position(|p| !p.is_finite()) {
            return Err(format!("node {n} is nowhere"));
        }
        self.check_elements()?;
        self.check_mids()?;
        self.check_faces()?;
        self.groups.iter().try_for_each(|group| self.check_group(group))?;
        if self.geometries.0.is_empty() { Ok(()) } else { self.check_made() }
    }

    /// Corner nodes of each line, triangle and quad.
    fn elements(&self) -> impl Iterator<Item = &[u32]> {
        let (lines, triangles) = (self.lines.iter().map(|c| c.as_slice()), self.triangles.iter().map(|c| c.as_slice()));
        lines.chain(triangles).chain(self.quads.iter().map(|c| c.as_slice()))
    }

    /// Mid nodes of the same.
    fn mids(&self) -> impl Iterator<Item = &[u32]> {
        let (lines, triangles) = (self.line_mids.iter().map(std::slice::from_ref), self.triangle_mids.iter().map(|c| c.as_slice()));
        lines.chain(triangles).chain(self.quad_mids.iter().map(|c| c.as_slice()))
    }

    fn check_elements(&self) -> Checked {
        for corners in job::looking(self.elements()) {
            if let Some(n) = corners.iter().find(|n| **n as usize >= self.nodes.len()) {
                return Err(format!("an element has the node {n}, which is not there"));
            }
            if (1..corners.len()).any(|k| corners[..k].contains(&corners[k])) {
                return Err(format!("an element has the node {} twice, or another one", corners[0]));
            }
        }
        let there = self.points.iter().all(|n| (*n as usize) < self.nodes.len());
        if there { Ok(()) } else { Err("a point is a node that is not there".to_owned()) }
    }

    fn check_mids(&self) -> Checked {
        let (mids, elements) = (
            [self.line_mids.len(), self.triangle_mids.len(), self.quad_mids.len()],
            [self.lines.len(), self.triangles.len(), self.quads.len()],
        );
        if !matches!((self.order, mids == elements, mids == [0; 3]), (1, _, true) | (2, true, _)) {
            return Err(format!("a mesh of order {} has {mids:?} mid nodes of {elements:?} elements", self.order));
        }
        let corners = self.corner_count() as u32;
        if let Some(n) = self.elements().flatten().chain(&self.points).find(|n| **n >= corners) {
            return Err(format!("the corner node {n} comes after a mid node"));
        }
        let (mut of_edge, mut of_mid): (BTreeMap<Edge, u32>, BTreeMap<u32, Edge>) = (BTreeMap::new(), BTreeMap::new());
        for (corners_of, mids_of) in job::looking(self.elements().zip(self.mids())) {
            for (k, mid) in mids_of.iter().enumerate() {
                let (a, b) = (corners_of[k], corners_of[(k + 1) % corners_of.len()]);
                let edge = (a.min(b), a.max(b));
                if *mid as usize >= self.nodes.len() {
                    return Err(format!("the mid node {mid} is not there"));
                }
                if *of_edge.entry(edge).or_insert(*mid) != *mid || *of_mid.entry(*mid).or_insert(edge) != edge {
                    return Err(format!("the mid node {mid} is of two edges, or not the only one of its edge"));
                }
            }
        }
        Ok(())
    }

    /// Faces take the elements one after the other, all of them.
    fn check_faces(&self) -> Checked {
        let follows = |of: fn(&FaceRange) -> &Range<u32>, count: usize| {
            let mut next = 0;
            for range in self.faces.iter().map(of).filter(|range| !range.is_empty()) {
                if range.start != next {
                    return false;
                }
                next = range.end;
            }
            next as usize == count
        };
        let all = follows(|f| &f.triangles, self.triangles.len())
            && follows(|f| &f.quads, self.quads.len())
            && follows(|f| &f.lines, self.lines.len());
        if !self.faces.is_empty() && !all {
            return Err("faces do not take all elements, one after the other".to_owned());
        }
        let faces = self.faces.iter().filter(|f| f.lines.is_empty()).count();
        let told = self.geometries.0.len();
        // A curve may have no element.
        if told == 0 || (self.faces.iter().filter(|f| !f.triangles.is_empty() || !f.quads.is_empty()).count()..=faces).contains(&told) {
            return Ok(());
        }
        Err(format!("{told} faces lie on surfaces, of {faces}"))
    }

    fn check_group(&self, group: &Group) -> Checked {
        let ascends = |list: &[u32], count: usize| list.is_sorted_by(|a, b| a < b) && list.last().is_none_or(|n| (*n as usize) < count);
        let fits = ascends(&group.nodes, self.nodes.len())
            && ascends(&group.lines, self.lines.len())
            && ascends(&group.triangles, self.triangles.len())
            && ascends(&group.quads, self.quads.len());
        if !fits {
            return Err(format!("the set {} is not in order, or holds what is not there", group.name));
        }
        let lines = group.lines.iter().flat_map(|k| self.lines[*k as usize]);
        let triangles = group.triangles.iter().flat_map(|k| self.triangles[*k as usize]);
        let quads = group.quads.iter().flat_map(|k| self.quads[*k as usize]);
        match lines.chain(triangles).chain(quads).find(|n| group.nodes.binary_search(n).is_err()) {
            Some(n) => Err(format!("the set {} has an element without its node {n}", group.name)),
            None => Ok(()),
        }
    }

    fn check_made(&self) -> Checked {
        let names: BTreeSet<&str> = self.groups.iter().map(|group| group.name.as_str()).collect();
        if names.len() < self.groups.len() {
            return Err("two sets have one name".to_owned());
        }
        let mut used = vec![false; self.nodes.len()];
        self.elements().chain(self.mids()).flatten().chain(&self.points).for_each(|n| used[*n as usize] = true);
        if let Some(n) = used.iter().position(|used| !used) {
            return Err(format!("node {n} belongs to nothing"));
        }
        for face in &self.faces {
            let mut edges: Vec<Edge> = Vec::new();
            let range = |range: &Range<u32>| range.start as usize..range.end as usize;
            let triangles = self.triangles[range(&face.triangles)].iter().map(|c| c.as_slice());
            for corners in job::looking(triangles.chain(self.quads[range(&face.quads)].iter().map(|c| c.as_slice()))) {
                let ends = |k: usize| (corners[k], corners[(k + 1) % corners.len()]);
                edges.extend((0..corners.len()).map(ends).map(|(a, b)| (a.min(b), a.max(b))));
            }
            job::sort(&mut edges);
            if let Some(w) = edges.windows(3).find(|w| w[0] == w[2]) {
                return Err(format!("more than two elements of {} have the edge {:?}", face.name, w[0]));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Two triangles and a quad of two faces, a line along the quad and a point, with mid nodes.
    fn sample(order: u8) -> Mesh {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let mut mesh = Mesh {
            name: "m".to_owned(),
            order,
            nodes: vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0), at(2.0, 0.0), at(2.0, 1.0)],
            points: vec![0],
            lines: vec![[1, 4]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            quads: vec![[1, 4, 5, 2]],
            ..Mesh::default()
        };
        let face = |name: &str, triangles, quads, lines| FaceRange { name: name.to_owned(), triangles, quads, lines };
        mesh.faces = vec![face("a", 0..2, 0..0, 0..0), face("b", 2..2, 0..1, 0..0), face("c", 2..2, 1..1, 0..1)];
        let set = |name: &str, nodes: &[u32]| Group { name: name.to_owned(), nodes: nodes.to_vec(), ..Group::default() };
        mesh.groups = vec![
            Group { triangles: vec![0, 1], ..set("a", &[0, 1, 2, 3]) },
            Group { quads: vec![0], lines: vec![0], ..set("b", &[1, 2, 4, 5]) },
        ];
        if order == 2 {
            mesh.nodes.extend([at(0.5, 0.0), at(1.0, 0.5), at(0.5, 0.5), at(0.5, 1.0), at(0.0, 0.5)]);
            mesh.nodes.extend([at(1.5, 0.0), at(2.0, 0.5), at(1.5, 1.0)]);
            mesh.triangle_mids = vec![[6, 7, 8], [8, 9, 10]];
            mesh.quad_mids = vec![[11, 12, 13, 7]];
            mesh.line_mids = vec![11];
        }
        mesh
    }

    #[track_caller]
    fn is_told(order: u8, what: &str, damage: impl FnOnce(&mut Mesh)) {
        let mut mesh = sample(order);
        assert_eq!(mesh.check().and(mesh.check_made()), Ok(()));
        damage(&mut mesh);
        let told = mesh.check().and_then(|()| mesh.check_made()).unwrap_err();
        assert!(told.contains(what), "{told}");
    }

    #[test]
    fn each_condition_on_elements_is_seen_to_fail() {
        is_told(1, "node 3 is nowhere", |mesh| mesh.nodes[3].y = f64::NAN);
        is_told(1, "has the node 6", |mesh| mesh.triangles[1][2] = 6);
        is_told(1, "has the node 6", |mesh| mesh.quads[0][3] = 6);
        is_told(1, "has the node 6", |mesh| mesh.lines[0][1] = 6);
        is_told(1, "twice", |mesh| mesh.triangles[0][2] = 1);
        is_told(1, "twice", |mesh| mesh.quads[0][2] = 1);
        is_told(1, "a point is a node", |mesh| mesh.points.push(6));
    }

    #[test]
    fn each_condition_on_mid_nodes_is_seen_to_fail() {
        is_told(1, "a mesh of order 1 has", |mesh| mesh.line_mids.push(0));
        is_told(2, "a mesh of order 2 has", |mesh| _ = mesh.quad_mids.pop());
        is_told(1, "a mesh of order 3 has", |mesh| mesh.order = 3);
        is_told(2, "mid node 99 is not there", |mesh| mesh.triangle_mids[0][0] = 99);
        is_told(2, "comes after a mid node", |mesh| mesh.triangle_mids[0][0] = 5);
        is_told(2, "is of two edges", |mesh| mesh.triangle_mids[0][0] = 9);
        is_told(2, "is of two edges", |mesh| mesh.line_mids[0] = 6);
    }

    #[test]
    fn each_condition_on_faces_and_sets_is_seen_to_fail() {
        is_told(1, "faces do not take all", |mesh| mesh.faces[0].triangles = 0..1);
        is_told(1, "faces do not take all", |mesh| mesh.faces[1].quads = 0..2);
        is_told(1, "faces do not take all", |mesh| mesh.faces[2].lines = 0..0);
        is_told(1, "not in order", |mesh| mesh.groups[0].nodes.swap(0, 1));
        is_told(1, "not in order", |mesh| mesh.groups[0].triangles = vec![0, 0]);
        is_told(1, "not in order", |mesh| mesh.groups[1].quads[0] = 1);
        is_told(1, "without its node 3", |mesh| _ = mesh.groups[0].nodes.pop());
        is_told(1, "one name", |mesh| mesh.groups[1].name = "a".to_owned());
        is_told(1, "node 6 belongs to nothing", |mesh| mesh.nodes.push(DVec3::ONE));
        is_told(1, "more than two elements of a", |mesh| {
            mesh.triangles.push([0, 3, 2]);
            mesh.triangles.push([2, 0, 5]);
            mesh.faces.iter_mut().for_each(|f| f.triangles = 4..4);
            mesh.faces[0].triangles = 0..4;
        });
    }
    /// Writers that leave mid nodes out write the first nodes, as many as there are corners.
    #[test]
    fn meshes_one_after_the_other_keep_mid_nodes_after_all_corners() {
        for (one, other) in [(1, 1), (2, 2)].map(|(a, b)| (sample(a), sample(b))) {
            let mut both = one.clone();
            both.append(other.clone());
            both.groups.clear();
            assert_eq!(both.check().and(both.check_made()), Ok(()));
            assert_eq!(both.corner_count(), 12);
            let places = |mesh: &Mesh| {
                let all = mesh.elements().chain(mesh.mids()).flatten().chain(&mesh.points);
                all.map(|n| mesh.nodes[*n as usize].to_array().map(f64::to_bits)).collect::<Vec<_>>()
            };
            let mut wanted = [places(&one), places(&other)].concat();
            let mut found = places(&both);
            wanted.sort_unstable();
            found.sort_unstable();
            assert_eq!(found, wanted);
        }
    }
}
