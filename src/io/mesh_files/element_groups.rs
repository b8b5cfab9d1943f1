//! Elements grouped by the surface or curve that they are of, and by the sets that hold them.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::base::job;
use crate::io::mesh_files::elements::Kind;
use crate::io::mesh_files::sets::own_names;
use crate::mesh::Mesh;

/// Runs of elements that lie in the same range and the same sets: what a file calls an entity or a section.
pub struct ElementGroup {
    /// Kind of its elements.
    pub kind: Kind,
    /// Index of the range in `mesh.faces`, or `None` for elements outside all of them.
    pub face: Option<usize>,
    /// Sets, as indices into those of [`sets`](crate::io::mesh_files::sets::sets), ascending.
    pub sets: Vec<usize>,
    /// Elements, ascending.
    pub elements: Vec<u32>,
}

/// Parts of one kind, in the order of their first elements.
pub fn parts(mesh: &Mesh, kind: Kind) -> Vec<ElementGroup> {
    let n = kind.count(mesh);
    if n == 0 {
        return Vec::new();
    }
    let mut face_of = vec![u32::MAX; n];
    for (f, face) in mesh.faces.iter().enumerate() {
        let range = kind.of_face(face);
        let range = range.start as usize..(range.end as usize).min(n);
        if !range.is_empty() {
            face_of[range].fill(f as u32);
        }
    }
    // Sets split the classes one after the other: a class is split by a set when only some of its elements are in it.
    let mut classes: Vec<(u32, Vec<usize>)> = Vec::new();
    let mut class_of = vec![0_u32; n];
    let mut index: BTreeMap<u32, u32> = BTreeMap::new();
    for (class, face) in class_of.iter_mut().zip(&face_of) {
        *class = *index.entry(*face).or_insert_with(|| {
            classes.push((*face, Vec::new()));
            classes.len() as u32 - 1
        });
    }
    for (s, group) in mesh.groups.iter().enumerate() {
        let mut moved: BTreeMap<u32, u32> = BTreeMap::new();
        for element in kind.of_group(group) {
            job::poll();
            let Some(class) = class_of.get_mut(*element as usize) else { continue };
            *class = *moved.entry(*class).or_insert_with(|| {
                let (face, mut sets) = classes[*class as usize].clone();
                sets.push(s);
                classes.push((face, sets));
                classes.len() as u32 - 1
            });
        }
    }
    let own = own_names(mesh);
    for (face, sets) in &mut classes {
        let name = mesh.faces.get(*face as usize).map(|face| face.name.as_str());
        sets.extend(own.iter().position(|own| Some(*own) == name).map(|k| mesh.groups.len() + k));
    }
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); classes.len()];
    for (element, class) in class_of.iter().enumerate() {
        job::poll();
        members[*class as usize].push(element as u32);
    }
    let mut parts: Vec<ElementGroup> = classes
        .into_iter()
        .zip(members)
        .filter(|(_, elements)| !elements.is_empty())
        .map(|((face, sets), elements)| ElementGroup { kind, face: (face != u32::MAX).then_some(face as usize), sets, elements })
        .collect();
    parts.sort_by_key(|part| part.elements[0]);
    parts
}

/// Consecutive elements of one surface or curve.
pub struct Run {
    /// Its name, or `None` for elements outside all ranges.
    pub name: Option<String>,
    /// Indices of the elements.
    pub elements: Range<usize>,
}

/// Runs of one kind in the order of their numbers; patches of one surface are one run.
pub fn runs(mesh: &Mesh, kind: Kind) -> Vec<Run> {
    let n = kind.count(mesh);
    let mut ranges: Vec<(usize, usize, &str)> = mesh
        .faces
        .iter()
        .map(|face| (kind.of_face(face), face.name.as_str()))
        .filter(|(range, _)| !range.is_empty())
        .map(|(range, name)| (range.start as usize, (range.end as usize).min(n), name))
        .collect();
    ranges.sort_by_key(|(start, ..)| *start);
    let mut runs: Vec<Run> = Vec::new();
    let mut push = |name: Option<&str>, elements: Range<usize>| match runs.last_mut() {
        _ if elements.is_empty() => {}
        Some(last) if last.name.as_deref() == name => last.elements.end = elements.end,
        _ => runs.push(Run { name: name.map(str::to_owned), elements }),
    };
    let mut at = 0;
    for (start, end, name) in ranges {
        push(None, at..start.max(at));
        push(Some(name), start.max(at)..end.max(at));
        at = at.max(end);
    }
    push(None, at..n);
    runs
}
