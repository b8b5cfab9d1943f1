//! The surfaces and curves that the elements of a mesh are of, under the names of a file.

use std::collections::BTreeMap;

use crate::io::files::loss::Loss;
use crate::io::files::names::Naming;
use crate::io::mesh_files::elements::Kind;
use crate::io::mesh_files::sets::{Set, own_names, sets};
use crate::mesh::Mesh;

/// Surfaces and curves with all their patches.
pub(crate) struct Regions<'a> {
    /// Names in the model, in the order of the mesh; the name of the mesh for elements of no surface or curve, which come last.
    pub names: Vec<&'a str>,
    /// For each kind the region of each element, as an index into `names`.
    of: Vec<(Kind, Vec<u32>)>,
}

/// An element of no range.
const NONE: u32 = u32::MAX;

impl<'a> Regions<'a> {
    /// Those that have elements of some kinds.
    pub(crate) fn new(mesh: &'a Mesh, kinds: &[Kind]) -> Self {
        let mut names: Vec<&str> = Vec::new();
        let mut numbers: BTreeMap<&str, u32> = BTreeMap::new();
        let mut of: Vec<(Kind, Vec<u32>)> = kinds.iter().map(|kind| (*kind, vec![NONE; kind.count(mesh)])).collect();
        for face in &mesh.faces {
            for (kind, own) in &mut of {
                let range = kind.of_face(face);
                let end = (range.end as usize).min(own.len());
                let range = (range.start as usize).min(end)..end;
                if !range.is_empty() {
                    let number = *numbers.entry(&face.name).or_insert_with(|| {
                        names.push(&face.name);
                        names.len() as u32 - 1
                    });
                    own[range].fill(number);
                }
            }
        }
        let rest = names.len() as u32;
        if of.iter().any(|(_, own)| own.contains(&NONE)) {
            names.push(&mesh.name);
            of.iter_mut().flat_map(|(_, own)| own).filter(|number| **number == NONE).for_each(|number| *number = rest);
        }
        Self { names, of }
    }

    /// The region of each element of a kind; empty for a kind that was not asked for.
    pub(crate) fn of(&self, kind: Kind) -> &[u32] {
        self.of.iter().find(|(known, _)| *known == kind).map_or(&[], |(_, own)| own)
    }
}

/// The sets of a mesh with the names that a file of JSON or XML has for them, and for each name of the model that of the file.
pub(crate) fn named_sets(mesh: &Mesh) -> (Vec<Set<'_>>, BTreeMap<&str, String>, Vec<Loss>) {
    let (sets, losses) = sets(mesh, Naming::Quoted);
    let names = mesh.groups.iter().map(|group| group.name.as_str()).chain(own_names(mesh));
    let given = names.zip(&sets).map(|(name, set)| (name, set.name.clone())).collect();
    (sets, given, losses)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::mesh_files::elements::KINDS;
    use crate::mesh::FaceRange;

    #[test]
    fn patches_of_a_surface_are_one_region_and_the_rest_is_another() {
        let face = |name: &str, triangles| FaceRange { name: name.into(), triangles, quads: 0..0, lines: 0..0 };
        let faces = vec![face("a", 0..1), face("b", 1..2), face("a", 2..3)];
        let mesh = Mesh { name: "m".into(), triangles: vec![[0, 1, 2]; 4], faces, ..Mesh::default() };
        let regions = Regions::new(&mesh, &KINDS);
        assert_eq!((regions.names.as_slice(), regions.of(Kind::Triangle)), (["a", "b", "m"].as_slice(), [0, 1, 0, 2].as_slice()));
        assert!(regions.of(Kind::Quad).is_empty());
    }
}
