//! What could stand at the cursor: commands, keywords, names, fields, functions, arguments, files.

use std::path::Path;

use rustyline::completion::Pair;

use crate::lang::std::{Builtin, builtins, fields};
use crate::lang::syntax::keywords::WORDS;
use crate::session::notebook::COMMANDS;

/// Most files offered.
const FILES: usize = 200;

/// A name of the session, with the keyword that declares it.
#[derive(Clone, Debug)]
pub struct Known {
    pub name: String,
    pub keyword: &'static str,
}

fn pair(replacement: &str, shown: String) -> Pair {
    Pair { display: shown, replacement: replacement.to_owned() }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Where the word at the end of `before` begins.
fn word_start(before: &str) -> usize {
    before.char_indices().rev().take_while(|(_, c)| is_word(*c)).last().map_or(before.len(), |(at, _)| at)
}

/// Whether the cursor is inside a string, and where its text begins.
fn open_text(before: &str) -> Option<usize> {
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    let mut open = None;
    let mut escaped = false;
    for (at, c) in before[line..].char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => open = if open.is_some() { None } else { Some(line + at + 1) },
            _ => {}
        }
    }
    open
}

/// The start of what is replaced and what it may be replaced by, in a session: commands too.
pub fn candidates(before: &str, known: &[Known]) -> (usize, Vec<Pair>) {
    let here = Path::new(".");
    if let Some(word) = before.trim_start().strip_prefix(':')
        && !word.contains(char::is_whitespace)
    {
        let start = before.len() - word.len();
        let fits = COMMANDS.iter().filter(|c| c.word.starts_with(word));
        return (start, fits.map(|c| pair(&format!("{} ", c.word), format!(":{} {}  {}", c.word, c.takes, c.docs))).collect());
    }
    let is_file_command = [":load ", ":save "].iter().find(|c| before.trim_start().starts_with(*c));
    if let Some(start) = is_file_command.map(|c| before.find(c).unwrap_or(0) + c.len()) {
        return files(before, start, here);
    }
    if before.trim_start().starts_with(':') {
        let start = word_start(before);
        let fits = known.iter().filter(|k| k.name.starts_with(&before[start..]));
        return (start, fits.map(|k| pair(&k.name, format!("{}  {}", k.name, k.keyword))).collect());
    }
    candidates_in_script(before, known, here)
}

/// The start of what is replaced and what it may be replaced by; files are named as seen from `folder`.
pub fn candidates_in_script(before: &str, known: &[Known], folder: &Path) -> (usize, Vec<Pair>) {
    if let Some(start) = open_text(before) {
        return files(before, start, folder);
    }
    let start = word_start(before);
    let word = &before[start..];
    let mut out: Vec<Pair> = Vec::new();
    if before[..start].ends_with('.') && !before[..start].ends_with("..") {
        out.extend(fields().filter(|f| f.name.starts_with(word)).map(|f| pair(f.name, format!("{}  {}", f.name, f.summary()))));
        let methods = builtins().filter(|b| b.name.starts_with(word) && !b.params.is_empty());
        out.extend(methods.map(|b| pair(&format!("{}(", b.name), b.signature())));
    } else {
        if let Some((builtin, _)) = call_at(before) {
            let arguments = builtin.params.iter().filter(|p| p.name.starts_with(word));
            out.extend(arguments.map(|p| pair(&format!("{}: ", p.name), format!("{}: {}", p.name, p.ty.signature()))));
        }
        let names = known.iter().filter(|k| k.name.starts_with(word));
        out.extend(names.map(|k| pair(&k.name, format!("{}  {}", k.name, k.keyword))));
        out.extend(WORDS.iter().filter(|w| w.word.starts_with(word)).map(|w| pair(w.word, w.word.to_owned())));
        out.extend(builtins().filter(|b| b.name.starts_with(word)).map(|b| pair(&format!("{}(", b.name), b.signature())));
    }
    out.sort_by(|a, b| a.replacement.cmp(&b.replacement));
    out.dedup_by(|a, b| a.replacement == b.replacement);
    (start, out)
}

/// The function whose brackets the cursor is in, and how many arguments stand before the one at the cursor.
pub fn call_at(before: &str) -> Option<(&'static Builtin, usize)> {
    let (mut depth, mut arguments) = (0usize, 0);
    for (at, c) in before.char_indices().rev() {
        match c {
            ')' | ']' | '}' => depth += 1,
            '(' | '[' | '{' if depth > 0 => depth -= 1,
            '(' | '[' | '{' => {
                let name = &before[word_start(&before[..at])..at];
                if c == '(' && !name.is_empty() {
                    return builtins().find(|b| b.name == name).map(|b| (b, arguments));
                }
                // A tuple or list is one argument of what is around it.
                arguments = 0;
            }
            ',' if depth == 0 => arguments += 1,
            _ => {}
        }
    }
    None
}

/// Files and folders whose names begin as written.
fn files(before: &str, start: usize, home: &Path) -> (usize, Vec<Pair>) {
    let written = &before[start..];
    let (folder, stem) = written.rfind('/').map_or(("", written), |at| (&written[..=at], &written[at + 1..]));
    let Ok(entries) = std::fs::read_dir(home.join(folder)) else {
        return (start, Vec::new());
    };
    let mut names: Vec<String> = entries
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let slash = if entry.path().is_dir() { "/" } else { "" };
            (name.starts_with(stem) && (!name.starts_with('.') || stem.starts_with('.'))).then(|| format!("{name}{slash}"))
        })
        .collect();
    names.sort();
    names.truncate(FILES);
    (start + folder.len(), names.into_iter().map(|name| pair(&name, name.clone())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offered(before: &str) -> Vec<String> {
        let known = [Known { name: "south".to_owned(), keyword: "curve" }, Known { name: "span".to_owned(), keyword: "param" }];
        candidates(before, &known).1.into_iter().map(|p| p.replacement).collect()
    }

    #[test]
    fn what_fits_is_offered() {
        let has = |before: &str, word: &str| assert!(offered(before).iter().any(|o| o == word), "{before}: {:?}", offered(before));
        has(":no", "nodes ");
        has(":show so", "south");
        has("curve a = li", "line(");
        has("let x = so", "south");
        has("south.le", "length");
        has("sur", "surface");
        has("surface s = coons(south, repa", "reparam: ");
        has("import \"Car", "Cargo.toml");
        assert!(offered("south.len").iter().all(|o| !o.starts_with("span")));
        assert!(offered("linspace(0, 1").is_empty() || !offered("0..").contains(&"length".to_owned()));
    }

    #[test]
    fn the_call_at_the_cursor_is_found() {
        assert_eq!(call_at("curve a = line((0, 0, 0), (1, 2").map(|(b, n)| (b.name, n)), Some(("line", 1)));
        assert_eq!(call_at("curve a = line((0, 0, 0)").map(|(b, n)| (b.name, n)), Some(("line", 0)));
        assert!(call_at("let a = [1, ").is_none());
    }
}
