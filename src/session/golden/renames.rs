//! Names that changed between two runs while what they name did not.

use std::collections::{BTreeMap, BTreeSet};

use super::line::Line;
use super::quote::{is_name, tokens};
use super::values::Value;
use super::words::{Kind, fields_of};

/// What is called otherwise now.
#[derive(Clone, Debug, Default)]
pub struct Renames {
    /// Declared names without indices: as they were and as they are.
    declared: BTreeMap<String, String>,
    /// Names inside the script (of `let`, parameters, members), as diagnostics quote them.
    local: BTreeMap<String, String>,
    back: BTreeMap<String, String>,
    /// Names of lines, old and new: these are not taken for local ones.
    known: BTreeSet<String>,
    /// Names that the new script uses.
    used: BTreeSet<String>,
}

/// A name without its indices.
fn base(name: &str) -> &str {
    name.split('[').next().unwrap_or(name)
}

impl Renames {
    /// None yet, between lines of these names, the new ones of a script that uses these names.
    pub fn between(old: &[Line], new: &[Line], used: &BTreeSet<String>) -> Self {
        let named = old.iter().chain(new).filter(|line| !line.unnamed && !line.is_diagnostic());
        Self { known: named.map(|line| base(&line.name).to_owned()).collect(), used: used.clone(), ..Self::default() }
    }

    /// Notes that a name became another one.
    pub fn note(&mut self, old: &str, new: &str) {
        if old[base(old).len()..] == new[base(new).len()..] {
            self.declared.entry(base(old).to_owned()).or_insert_with(|| base(new).to_owned());
        }
    }

    /// A text with the names of today.
    fn today(&self, text: &str) -> String {
        let mut out = String::new();
        let mut word = String::new();
        let flush = |word: &mut String, out: &mut String| {
            out.push_str(self.declared.get(word.as_str()).map_or(word.as_str(), String::as_str));
            word.clear();
        };
        for c in text.chars() {
            if c.is_alphanumeric() || c == '_' {
                word.push(c);
            } else {
                flush(&mut word, &mut out);
                out.push(c);
            }
        }
        flush(&mut word, &mut out);
        out
    }

    /// An old line with the names of today.
    pub fn of_today(&self, line: &Line) -> Line {
        let mut line = line.clone();
        if self.declared.is_empty() {
            return line;
        }
        if matches!(line.kind.as_str(), "set" | "settings") {
            line.name = self.today(&line.name);
        }
        for (word, value) in &mut line.pairs {
            match value {
                Value::Groups(groups) => groups.iter_mut().for_each(|group| group.0 = self.today(&group.0)),
                Value::Word(text) if matches!(*word, "of" | "zoom") => *text = self.today(text),
                _ => {}
            }
        }
        line
    }

    /// Whether two diagnostics say the same: layout aside, with the names of today, and unless they are errors under other
    /// names of what has no line of its own.
    pub fn same_diagnostic(&mut self, old: &Line, new: &Line) -> bool {
        let plain = |line: &Line| -> Vec<Value> {
            let fields = fields_of(&line.kind).filter(|f| f.kind != Kind::Source);
            fields.filter_map(|f| line.get(f.word).cloned()).collect()
        };
        let at = |line: &Line| if let Some(Value::Word(at)) = line.get("at") { at.clone() } else { String::new() };
        if old.kind != new.kind || plain(old) != plain(new) {
            return false;
        }
        let before = self.clone();
        let lenient = !old.kind.starts_with('E');
        let (one, other): (Vec<&str>, Vec<&str>) = (old.name.split('`').collect(), new.name.split('`').collect());
        let part = |renames: &mut Self, (k, (a, b)): (usize, (&&str, &&str))| match k % 2 {
            0 => a == b,
            _ => renames.same_source(a, b, lenient),
        };
        let same = one.len() == other.len()
            && one.iter().zip(&other).enumerate().all(|pair| part(self, pair))
            && self.same_source(&at(old), &at(new), lenient);
        if !same {
            *self = before;
        }
        same
    }

    /// Whether two stretches of source say the same: layout aside, with the names of today.
    pub fn same_words(&mut self, old: &str, new: &str) -> bool {
        let before = self.clone();
        let same = self.same_source(old, new, true);
        if !same {
            *self = before;
        }
        same
    }

    fn same_source(&mut self, old: &str, new: &str, lenient: bool) -> bool {
        let (one, other) = (tokens(old), tokens(new));
        one.len() == other.len() && one.iter().zip(other).all(|(a, b)| self.same_token(a, &b, lenient))
    }

    fn same_token(&mut self, old: &str, new: &str, lenient: bool) -> bool {
        if self.declared.get(old).map_or(old, String::as_str) == new {
            return true;
        }
        let free = |name: &str| is_name(name) && !self.known.contains(name);
        if !lenient || !free(old) || !free(new) || self.used.contains(old) || !self.used.contains(new) {
            return false;
        }
        let (there, back) = (self.local.get(old), self.back.get(new));
        match (there, back) {
            (Some(there), Some(back)) => there == new && back == old,
            (None, None) => {
                self.local.insert(old.to_owned(), new.to_owned());
                self.back.insert(new.to_owned(), old.to_owned());
                true
            }
            _ => false,
        }
    }
}
