//! Which models have a golden: scripts with a `.golden` beside them.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// How a script and its golden stand to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestState {
    /// Both are there.
    Both,
    /// The script was named and has no golden yet.
    NoGolden,
    /// The golden has no script any more.
    NoScript,
}

/// One model under test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Test {
    /// The script as the user would write it; what results and filters speak of.
    pub name: String,
    /// The script.
    pub script: PathBuf,
    /// Its golden.
    pub golden: PathBuf,
    /// Which of them exist.
    pub state: TestState,
}

impl Test {
    fn of(script: PathBuf) -> Self {
        let golden = script.with_extension("golden");
        let state = match (script.is_file(), golden.is_file()) {
            (true, false) => TestState::NoGolden,
            (false, true) => TestState::NoScript,
            _ => TestState::Both,
        };
        Self { name: script.to_string_lossy().replace('\\', "/"), script, golden, state }
    }

    /// Folder of the stored copies of compared files.
    pub fn stored(&self) -> PathBuf {
        self.script.with_extension("golden.d")
    }
}

/// The tests below some paths, each once, in order of the paths and then of names. The error is a sentence.
///
/// A folder stands for all `.golden` below it, hidden folders and stored copies aside; a file for itself.
pub fn discover(paths: &[PathBuf]) -> Result<Vec<Test>, String> {
    let mut tests: Vec<Test> = Vec::new();
    let mut seen: BTreeMap<PathBuf, ()> = BTreeMap::new();
    for path in paths {
        let found =
            if path.is_dir() { below(path).map_err(|e| format!("cannot list {}: {e}", path.display()))? } else { vec![named(path)?] };
        for test in found {
            let folder = test.script.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned()).join(test.script.file_name().unwrap_or_default());
            if seen.insert(real, ()).is_none() {
                tests.push(test);
            }
        }
    }
    Ok(tests)
}

/// A file that was named: a script or a golden, one of which must exist.
fn named(path: &Path) -> Result<Test, String> {
    let known = path.extension().is_some_and(|e| e == "loft" || e == "golden");
    let test = Test::of(path.with_extension("loft"));
    if !known {
        let what = if path.exists() { "it is neither a script (.loft) nor a golden file nor a folder" } else { "there is no such file" };
        return Err(format!("cannot test {:?}: {what}", path.display().to_string()));
    }
    if !test.script.is_file() && !test.golden.is_file() {
        return Err(format!("cannot test {:?}: there is no such file", path.display().to_string()));
    }
    Ok(test)
}

/// The tests of a folder and those below it.
fn below(folder: &Path) -> io::Result<Vec<Test>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        // `./a.loft` reads worse than `a.loft`.
        let shown = if folder == Path::new(".") { PathBuf::new() } else { folder.clone() };
        for entry in fs::read_dir(&folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let Some(text) = name.to_str() else { continue };
            if text.starts_with('.') {
                continue;
            }
            // A link to a folder is not followed: it could lead back here.
            if entry.file_type()?.is_dir() {
                if !text.ends_with(".golden.d") {
                    folders.push(shown.join(text));
                }
            } else if text.ends_with(".golden") {
                found.push(Test::of(shown.join(text).with_extension("loft")));
            }
        }
    }
    found.sort_by(|a, b| a.script.cmp(&b.script));
    Ok(found)
}
