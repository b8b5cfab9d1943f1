//! Sets of a mesh under the names that a file has for them.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use crate::base::job;
use crate::io::files::loss::Loss;
use crate::io::files::names::{Names, Naming};
use crate::io::mesh_files::elements::KINDS;
use crate::mesh::{FaceRange, Group, Mesh};

/// A set under the name that the file uses.
pub struct Set<'a> {
    /// Name in the file, unique there.
    pub name: String,
    /// What it holds.
    pub group: Cow<'a, Group>,
}

/// All sets of a mesh in order, then one for each range that has none (the line elements of a curve), with unique names and
/// each renaming that the model's author should hear of.
pub fn sets(mesh: &Mesh, naming: Naming) -> (Vec<Set<'_>>, Vec<Loss>) {
    let mut names = Names::of_mesh(naming, mesh);
    let mut sets: Vec<Set> = mesh.groups.iter().map(|group| Set { name: names.give(&group.name), group: Cow::Borrowed(group) }).collect();
    let mut ranges: BTreeMap<&str, Vec<&FaceRange>> = BTreeMap::new();
    mesh.faces.iter().for_each(|face| ranges.entry(&face.name).or_default().push(face));
    for name in own_names(mesh) {
        let group = of_ranges(mesh, name, ranges.remove(name).unwrap_or_default());
        sets.push(Set { name: names.give(name), group: Cow::Owned(group) });
    }
    (sets, names.losses)
}

/// Names of ranges that no group has, in order.
pub(crate) fn own_names(mesh: &Mesh) -> Vec<&str> {
    let mut known: BTreeSet<&str> = mesh.groups.iter().map(|group| group.name.as_str()).collect();
    mesh.faces.iter().map(|face| face.name.as_str()).filter(|name| known.insert(name)).collect()
}

/// The set of ranges that have one name.
fn of_ranges<'a>(mesh: &Mesh, name: &str, faces: impl IntoIterator<Item = &'a FaceRange>) -> Group {
    let mut group = Group { name: name.to_owned(), ..Group::default() };
    let mut nodes = BTreeSet::new();
    for face in faces {
        group.lines.extend(face.lines.clone());
        group.triangles.extend(face.triangles.clone());
        group.quads.extend(face.quads.clone());
    }
    for kind in KINDS {
        for element in kind.of_group(&group) {
            job::poll();
            kind.nodes(mesh, *element as usize, |node| {
                nodes.insert(node);
            });
        }
    }
    group.nodes = nodes.into_iter().collect();
    group
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files::loss::Renamed;

    #[test]
    fn names_in_a_strict_deck() {
        let mut names = Names::new(Naming::Strict);
        assert_eq!(names.give("ribs[3]"), "ribs_3");
        assert!(matches!(names.losses.as_slice(), [Loss::Renamed(Renamed { family: true, .. })]));
        assert_eq!(names.give("Ribs_3"), "Ribs_3_2");
        assert_eq!(names.give("지붕"), "jibung");
        assert_eq!(names.give("벽 north"), "byeok_north");
        assert_eq!(names.give("3d"), "s3d");
        assert_eq!(names.comments("**").lines().nth(2), Some("** set jibung: 지붕"));
        assert_eq!(names.give(&"x".repeat(90)).len(), 80);
        assert_eq!(names.give(&"x".repeat(91)), format!("{}_2", "x".repeat(78)));
        assert_eq!(names.losses.len(), 7);
        assert!(names.comments("$").lines().all(|line| line.starts_with("$ set ") && line.chars().count() < 180));
        assert_eq!(Names::new(Naming::Free).give("지붕"), "지붕");
        // A name that needs no change keeps its own, whoever comes first.
        let group = |name: &str| Group { name: name.into(), ..Group::default() };
        let mesh = Mesh { groups: ["지붕", "jibung", "Jibung"].map(group).to_vec(), ..Mesh::default() };
        let given: Vec<String> = sets(&mesh, Naming::Strict).0.into_iter().map(|set| set.name).collect();
        assert_eq!(given, ["jibung_2", "jibung", "Jibung_3"]);
    }
}
