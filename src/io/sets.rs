//! Sets of a mesh as a file names them, and who belongs to which.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::deck::{Loss, Options, Renamed};
use super::romanize::in_ascii;
use crate::base::job;
use crate::mesh::{FaceRange, Group, Mesh};

/// Which names a format takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Naming {
    /// Any text without blanks and quotes.
    Free,
    /// ASCII letters, digits and `_`, a letter first, at most 80, case ignored (INP, BDF); other scripts in Latin letters.
    Strict,
}

/// A set under the name that the file uses.
pub struct Set<'a> {
    /// Name in the file, unique there.
    pub name: String,
    /// What it holds.
    pub group: Cow<'a, Group>,
}

/// Longest name of a strict format.
const LONGEST: usize = 80;

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
fn own_names(mesh: &Mesh) -> Vec<&str> {
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
            job::look();
            kind.nodes(mesh, *element as usize, |node| {
                nodes.insert(node);
            });
        }
    }
    group.nodes = nodes.into_iter().collect();
    group
}

/// Gives each name of the model one name in the file.
pub struct Names {
    naming: Naming,
    taken: BTreeSet<String>,
    /// Names that need no change, by what tells them apart in the file: no other name gets one of these.
    kept: BTreeMap<String, String>,
    /// Renamings so far.
    pub losses: Vec<Loss>,
}

impl Names {
    /// No names yet.
    pub fn new(naming: Naming) -> Self {
        Self { naming, taken: BTreeSet::new(), kept: BTreeMap::new(), losses: Vec::new() }
    }

    /// Names that will be given for the sets and ranges of a mesh: those that the file can have as they are stay so.
    pub fn of_mesh(naming: Naming, mesh: &Mesh) -> Self {
        let mut names = Self::new(naming);
        for name in mesh.groups.iter().map(|group| &group.name).chain(mesh.faces.iter().map(|face| &face.name)) {
            if names.wanted(name) == *name {
                names.kept.entry(names.key(name)).or_insert_with(|| name.clone());
            }
        }
        names
    }

    /// The name as the file could have it, whatever others there are.
    fn wanted(&self, name: &str) -> String {
        let plain = plain(name);
        let mut wanted: String = match self.naming {
            Naming::Free => plain.chars().map(|c| if c.is_whitespace() || c.is_control() || c == '"' { '_' } else { c }).collect(),
            Naming::Strict => in_ascii(&plain).chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).take(LONGEST).collect(),
        };
        if wanted.is_empty() || (self.naming == Naming::Strict && !wanted.starts_with(|c: char| c.is_ascii_alphabetic())) {
            wanted.insert(0, 's');
            wanted = wanted.chars().take(LONGEST).collect();
        }
        wanted
    }

    /// Whether a name of the file is left for this name of the model.
    fn is_free(&self, given: &str, name: &str) -> bool {
        let key = self.key(given);
        !self.taken.contains(&key) && self.kept.get(&key).is_none_or(|owner| owner == name)
    }

    /// A unique name in the file; `ribs[3]` becomes `ribs_3` everywhere.
    pub fn give(&mut self, name: &str) -> String {
        let (plain, wanted) = (plain(name), self.wanted(name));
        let mut given = wanted.clone();
        let mut k = 2;
        while !self.is_free(&given, name) {
            let suffix = format!("_{k}");
            let room = if self.naming == Naming::Strict { LONGEST - suffix.len() } else { usize::MAX };
            given = wanted.chars().take(room).chain(suffix.chars()).collect();
            k += 1;
        }
        self.taken.insert(self.key(&given));
        if given != name {
            self.losses.push(Loss::Renamed(Renamed { from: name.to_owned(), to: given.clone(), family: given == plain }));
        }
        given
    }

    /// Lines for a comment of the file, each behind `mark`: which sets have other names in the model.
    pub fn comments(&self, mark: &str) -> String {
        let renamed = |loss: &Loss| match loss {
            Loss::Renamed(renamed) => Some(format!("{mark} set {}: {}\n", renamed.to, in_comment(&renamed.from))),
            _ => None,
        };
        self.losses.iter().filter_map(renamed).collect()
    }

    fn key(&self, name: &str) -> String {
        if self.naming == Naming::Strict { name.to_ascii_uppercase() } else { name.to_owned() }
    }
}

/// `ribs[3][1]` as `ribs_3_1`.
fn plain(name: &str) -> String {
    name.replace("][", "_").replace('[', "_").replace(']', "")
}

/// A name of the model in a comment: whole but for what would end the line, and cut where it is very long.
fn in_comment(name: &str) -> String {
    let one_line: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if one_line.chars().count() <= LONGEST {
        return one_line;
    }
    one_line.chars().take(LONGEST).chain("…".chars()).collect()
}

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

/// Kind of an element, in the order in which they are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Line elements.
    Line,
    /// Triangles.
    Triangle,
    /// Quads.
    Quad,
}

impl Kind {
    /// How many a mesh has.
    pub fn count(self, mesh: &Mesh) -> usize {
        match self {
            Self::Line => mesh.lines.len(),
            Self::Triangle => mesh.triangles.len(),
            Self::Quad => mesh.quads.len(),
        }
    }

    /// Those of a group.
    pub fn of_group(self, group: &Group) -> &[u32] {
        match self {
            Self::Line => &group.lines,
            Self::Triangle => &group.triangles,
            Self::Quad => &group.quads,
        }
    }

    /// Those of a surface or curve.
    pub fn of_face(self, face: &FaceRange) -> &Range<u32> {
        match self {
            Self::Line => &face.lines,
            Self::Triangle => &face.triangles,
            Self::Quad => &face.quads,
        }
    }

    /// Number of the first one in a file, from 1.
    pub fn first_number(self, mesh: &Mesh) -> u64 {
        let before = match self {
            Self::Line => 0,
            Self::Triangle => mesh.lines.len(),
            Self::Quad => mesh.lines.len() + mesh.triangles.len(),
        };
        before as u64 + 1
    }

    /// Nodes of the element at `index`: corners, then mid nodes.
    pub fn nodes(self, mesh: &Mesh, index: usize, mut each: impl FnMut(u32)) {
        let second = mesh.order == 2;
        match self {
            Self::Line => {
                mesh.lines[index].iter().for_each(|n| each(*n));
                if second {
                    each(mesh.line_mids[index]);
                }
            }
            Self::Triangle => {
                mesh.triangles[index].iter().for_each(|n| each(*n));
                if second {
                    mesh.triangle_mids[index].iter().for_each(|n| each(*n));
                }
            }
            Self::Quad => {
                mesh.quads[index].iter().for_each(|n| each(*n));
                if second {
                    mesh.quad_mids[index].iter().for_each(|n| each(*n));
                }
            }
        }
    }

    /// Nodes of one such element.
    pub fn nodes_each(self, order: u8) -> usize {
        let corners = match self {
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Quad => 4,
        };
        match (order, self) {
            (2, Self::Line) => 3,
            (2, _) => 2 * corners,
            _ => corners,
        }
    }
}

/// All kinds, in the order of their numbers.
pub const KINDS: [Kind; 3] = [Kind::Line, Kind::Triangle, Kind::Quad];

/// Numbers of a group's elements in a file, from 1, ascending.
pub fn element_numbers(mesh: &Mesh, group: &Group) -> Vec<u64> {
    KINDS
        .iter()
        .flat_map(|kind| {
            let first = kind.first_number(mesh);
            kind.of_group(group).iter().map(move |n| first + u64::from(*n))
        })
        .collect()
}

/// Runs of elements that lie in the same range and the same sets: what a file calls an entity or a section.
pub struct Part {
    /// Kind of its elements.
    pub kind: Kind,
    /// Index of the range in `mesh.faces`, or `None` for elements outside all of them.
    pub face: Option<usize>,
    /// Sets, as indices into those of [`sets`], ascending.
    pub sets: Vec<usize>,
    /// Elements, ascending.
    pub elements: Vec<u32>,
}

/// Parts of one kind, in the order of their first elements.
pub fn parts(mesh: &Mesh, kind: Kind) -> Vec<Part> {
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
            job::look();
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
        job::look();
        members[*class as usize].push(element as u32);
    }
    let mut parts: Vec<Part> = classes
        .into_iter()
        .zip(members)
        .filter(|(_, elements)| !elements.is_empty())
        .map(|((face, sets), elements)| Part { kind, face: (face != u32::MAX).then_some(face as usize), sets, elements })
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

#[cfg(test)]
mod tests {
    use super::*;

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
