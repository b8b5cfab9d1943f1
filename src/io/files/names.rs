//! Names that a format takes: each name of the model has one name in the file, and each change is reported.

use std::collections::{BTreeMap, BTreeSet};

use crate::io::files::loss::{Loss, Renamed};
use crate::io::files::romanize::in_ascii;
use crate::mesh::Mesh;

/// Which names a format takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Naming {
    /// Any text without blanks and quotes.
    Free,
    /// Any text without control characters, as strings of JSON and XML hold it (GLB, 3MF).
    Quoted,
    /// ASCII letters, digits and `_`, a letter first, at most 80, case ignored (INP, BDF); other scripts in Latin letters.
    Strict,
}

/// Longest name of a strict format.
const LONGEST: usize = 80;

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
            // XML 1.0 has no place for control characters and these two.
            Naming::Quoted => plain.chars().map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { '_' } else { c }).collect(),
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

/// A name in a comment of a deck.
pub(crate) fn ascii(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect()
}
