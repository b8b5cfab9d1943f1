//! How files come and go: one small trait, so that nothing below the session touches the disk.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::base::visible::steers;

/// What a file cannot be read for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileError {
    /// No such file; names of files beside it that look alike, best first.
    Missing {
        /// Names that could have been meant.
        similar: Vec<String>,
    },
    /// It lies outside the allowed folders.
    Outside,
    /// Larger than the limit, bytes.
    TooLarge(u64),
    /// Anything else, in the system's words.
    Other(String),
}

/// Why a path names no file on any system, in words: it holds what steers a terminal.
pub fn unfit_name(path: &str) -> Option<String> {
    let found = path.chars().find(|c| steers(*c))?;
    Some(format!("its name holds U+{:04X}, which steers whatever shows the name", found as u32))
}

/// Source of scripts and data, sink of outputs.
pub trait Files {
    /// A name that is equal for two paths that lead to the same file. `from` is the script that names it.
    fn resolve(&self, from: &str, path: &str) -> Result<String, FileError>;
    /// The bytes of a resolved file, at most `limit` of them.
    fn read(&self, resolved: &str, limit: u64) -> Result<Vec<u8>, FileError>;
    /// Writes a whole output or nothing: `fill` writes into a sink that becomes the file when all is well.
    fn write(&self, path: &str, fill: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>) -> Result<u64, FileError>;
}

/// Files in memory: what tests and editors use. Paths are taken as they are, `/` separated, relative to nothing.
#[derive(Debug, Default)]
pub struct Memory {
    files: Mutex<BTreeMap<String, Vec<u8>>>,
}

impl Memory {
    /// No files.
    pub fn new() -> Self {
        Self::default()
    }

    /// With one more file.
    pub fn with(self, path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.lock().insert(path.to_owned(), bytes.into());
        self
    }

    /// The bytes of a file, read or written.
    pub fn get(&self, path: &str) -> Option<Vec<u8>> {
        self.lock().get(path).cloned()
    }

    /// All paths in order.
    pub fn paths(&self) -> Vec<String> {
        self.lock().keys().cloned().collect()
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<String, Vec<u8>>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Files for Memory {
    fn resolve(&self, from: &str, path: &str) -> Result<String, FileError> {
        let mut parts: Vec<&str> = match from.rsplit_once('/') {
            Some((folder, _)) if !path.starts_with('/') => folder.split('/').collect(),
            _ => Vec::new(),
        };
        for part in path.split('/') {
            match part {
                "" | "." => {}
                ".." => {
                    parts.pop().ok_or(FileError::Outside)?;
                }
                part => parts.push(part),
            }
        }
        let name = parts.join("/");
        if self.lock().contains_key(&name) { Ok(name) } else { Err(FileError::Missing { similar: Vec::new() }) }
    }

    fn read(&self, resolved: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let bytes = self.get(resolved).ok_or(FileError::Missing { similar: Vec::new() })?;
        if bytes.len() as u64 > limit { Err(FileError::TooLarge(bytes.len() as u64)) } else { Ok(bytes) }
    }

    fn write(&self, path: &str, fill: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>) -> Result<u64, FileError> {
        let mut bytes = Vec::new();
        fill(&mut bytes).map_err(|e| FileError::Other(e.to_string()))?;
        let size = bytes.len() as u64;
        self.lock().insert(path.to_owned(), bytes);
        Ok(size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_resolves_reads_and_writes() {
        let files = Memory::new().with("a/main.loft", "x").with("a/data/offsets_bow.csv", "1,2");
        assert_eq!(files.resolve("a/main.loft", "data/../data/offsets_bow.csv").as_deref(), Ok("a/data/offsets_bow.csv"));
        assert_eq!(files.resolve("a/main.loft", "../../x"), Err(FileError::Outside));
        let missing = FileError::Missing { similar: Vec::new() };
        assert_eq!(files.resolve("a/main.loft", "data/bow_offsets.csv"), Err(missing));
        assert_eq!(files.read("a/main.loft", 0), Err(FileError::TooLarge(1)));
        assert_eq!(files.write("out", &mut |out| out.write_all(b"123")), Ok(3));
        assert_eq!(files.get("out").as_deref(), Some(b"123".as_slice()));
    }
}
