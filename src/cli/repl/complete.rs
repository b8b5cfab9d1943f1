//! What could stand at the cursor: commands, keywords, names, fields, functions, arguments, files.

use std::path::{Path, PathBuf};

use rustyline::completion::Pair;

use crate::base::limits;
use crate::lang::assist::{EditedScript, Function, Known};
use crate::lang::syntax::keywords::written;
use crate::session::disk::read_limited;
use crate::session::notebook::{COMMANDS, Notebook};

/// Most files offered.
const FILES: usize = 200;

/// What is known of a session while a line is typed.
#[derive(Default)]
pub struct Session {
    /// The script as it stands.
    text: String,
    /// Names with their keywords.
    names: Vec<(String, &'static str)>,
    /// What the last run showed of them.
    known: Known,
    /// The file that it began with.
    script: Option<PathBuf>,
}

impl Session {
    pub fn of(notebook: &Notebook) -> Self {
        let symbols = || notebook.symbols().iter().filter_map(|s| Some((s.name.clone()?, s)));
        Self {
            text: notebook.text().to_owned(),
            names: symbols().map(|(name, s)| (name, written(s.keyword))).collect(),
            known: symbols().map(|(name, s)| (name, s.shape.clone())).collect(),
            script: notebook.script().map(Path::to_owned),
        }
    }

    fn folder(&self) -> &Path {
        self.script.as_deref().and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    /// The session with a line behind it, handed to `work` with the first byte of that line.
    fn with<T>(&self, line: &str, work: impl FnOnce(&EditedScript<'_>, usize) -> T) -> T {
        let text = format!("{}{line}", self.text);
        let path = self.folder().join("session.loft").to_string_lossy().into_owned();
        work(&EditedScript { text: &text, path: &path, open: &module, known: &self.known, session: true }, self.text.len())
    }

    /// The call that a line ends in.
    pub fn call(&self, line: &str) -> Option<Function> {
        self.with(line, |script, start| Some(script.call(start + line.len())?.0))
    }
}

/// A module on the disk: its path and text.
fn module(from: &str, written: &str) -> Option<(String, String)> {
    let path = Path::new(from).parent()?.join(written).canonicalize().ok()?;
    let text = String::from_utf8(read_limited(&path, limits::SOURCE_BYTES).ok()?).ok()?;
    Some((path.to_string_lossy().into_owned(), text))
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

/// The start of what is replaced and what it may be replaced by, in a session: commands too.
pub fn candidates(before: &str, session: &Session) -> (usize, Vec<Pair>) {
    let named = |(start, names): (usize, Vec<String>)| (start, names.into_iter().map(|name| pair(&name, name.clone())).collect());
    if let Some(word) = before.trim_start().strip_prefix(':')
        && !word.contains(char::is_whitespace)
    {
        let start = before.len() - word.len();
        let fits = COMMANDS.iter().filter(|c| c.word.starts_with(word));
        return (start, fits.map(|c| pair(&format!("{} ", c.word), format!(":{} {}  {}", c.word, c.takes, c.docs))).collect());
    }
    let is_file_command = [":load ", ":save "].iter().find(|c| before.trim_start().starts_with(*c));
    if let Some(start) = is_file_command.map(|c| before.find(c).unwrap_or(0) + c.len()) {
        return named(files(before, start, Path::new(".")));
    }
    if before.trim_start().starts_with(':') {
        // What a command speaks of may be a path: `:show ribs[0].length`.
        let argument = before.find(char::is_whitespace).map_or(before.len(), |at| at + 1);
        if before[argument..].contains(['.', '(']) {
            let (start, found) = of_script(&before[argument..], session);
            return (argument + start, found);
        }
        let start = word_start(before);
        let fits = session.names.iter().filter(|(name, _)| name.starts_with(&before[start..]));
        return (start, fits.map(|(name, keyword)| pair(name, format!("{name}  {keyword}"))).collect());
    }
    of_script(before, session)
}

/// What may stand at the end of a line of a script.
fn of_script(before: &str, session: &Session) -> (usize, Vec<Pair>) {
    let named = |(start, names): (usize, Vec<String>)| (start, names.into_iter().map(|name| pair(&name, name.clone())).collect());
    let (from, offer) = session.with(before, |script, start| (start, script.complete(script.text.len())));
    let start = offer.start.saturating_sub(from);
    if offer.file {
        return named(files(before, start, session.folder()));
    }
    let shown = |text: &str, about: &str| {
        let label = text.trim_end_matches(['(', ' ', ':']);
        if about.starts_with(label) { about.to_owned() } else { format!("{label}  {about}") }
    };
    (start, offer.candidates.iter().map(|c| pair(&c.text, shown(&c.text, &c.about))).collect())
}

/// Files and folders whose names begin as written.
pub fn files(before: &str, start: usize, home: &Path) -> (usize, Vec<String>) {
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
    (start + folder.len(), names)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offered(before: &str) -> Vec<String> {
        let names = [("south", "curve"), ("span", "param")].map(|(name, keyword)| (name.to_owned(), keyword)).into();
        let text = "curve south = line((0, 0, 0), (1, 0, 0))\nparam span = 40m in 20m to 80m\n".to_owned();
        let session = Session { text, names, ..Session::default() };
        candidates(before, &session).1.into_iter().map(|p| p.replacement).collect()
    }

    #[test]
    fn what_fits_is_offered() {
        let has = |before: &str, word: &str| assert!(offered(before).iter().any(|o| o == word), "{before}: {:?}", offered(before));
        has(":no", "nodes ");
        has(":show so", "south");
        has(":show south.le", "length");
        has("curve a = li", "line(");
        has("let x = so", "south");
        has("so", "south");
        has("south.le", "length");
        has("sur", "surface");
        has("surface s = coons(south, repa", "reparam: ");
        has("import \"Car", "Cargo.toml");
        has("mesh m of s { el", "elements: ");
        has("mesh m of s { elements: ", "quads");
        assert!(offered("south.len").iter().all(|o| !o.starts_with("span")));
        assert!(offered("linspace(0, 1").is_empty() && !offered("0..").contains(&"length".to_owned()));
    }
}
