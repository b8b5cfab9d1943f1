//! What formats leave out of a mesh: mid nodes, lines and points, names of sets.

use crate::io::files::loss::Loss;
use crate::io::mesh_files::deck::Options;
use crate::mesh::{Group, Mesh};

/// Names in backquotes with commas.
pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// The losses of a format that keeps corner nodes and faces: mid nodes, and line elements and points where it has no place for them.
pub fn left_out(mesh: &Mesh, lines: bool) -> Vec<Loss> {
    let mut losses = Vec::new();
    if mesh.order == 2 {
        losses.push(Loss::LeftOut("the mid nodes of elements of order 2".to_owned()));
    }
    if lines && !mesh.lines.is_empty() {
        losses.push(Loss::LeftOut(format!("the {} line elements", mesh.lines.len())));
    }
    if lines && !mesh.points.is_empty() {
        losses.push(Loss::LeftOut(format!("the {} points", mesh.points.len())));
    }
    losses
}

/// The losses of a format that does not keep the names of these sets, called `words`: a warning for groups that the script declares, a word
/// for the sets of surfaces and shells, none for a mesh of one surface.
pub fn names_lost(mesh: &Mesh, options: &Options, words: &str, lost: impl Fn(&Group) -> bool) -> Vec<Loss> {
    let lost: Vec<&str> = mesh.groups.iter().filter(|group| lost(group)).map(|group| group.name.as_str()).collect();
    let declared = |name: &str| options.groups.iter().any(|group| group == name);
    let (asked, own): (Vec<&str>, Vec<&str>) = lost.into_iter().partition(|name| declared(name));
    let mut losses = Vec::new();
    if !asked.is_empty() {
        losses.push(Loss::LeftOut(format!("{words} {}", listed(asked))));
    }
    if own.len() > 1 {
        losses.push(Loss::Unnamed(format!("the names of the sets {}", listed(own))));
    }
    losses
}
