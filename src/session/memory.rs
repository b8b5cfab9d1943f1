//! Files that exist in memory only: for tests and for programs that embed the language.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Write};

use crate::io::{FileError, Files};

/// A flat folder in memory: scripts and data by name, and the outputs that were written.
#[derive(Debug, Default)]
pub struct Memory {
    files: BTreeMap<String, Vec<u8>>,
    written: RefCell<BTreeMap<String, Vec<u8>>>,
}

impl Memory {
    /// With these files.
    pub fn of<'a>(files: impl IntoIterator<Item = (&'a str, &'a [u8])>) -> Self {
        let files = files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect();
        Self { files, written: RefCell::default() }
    }

    /// The outputs by path.
    pub fn into_written(self) -> BTreeMap<String, Vec<u8>> {
        self.written.into_inner()
    }
}

impl Files for Memory {
    fn resolve(&self, _: &str, path: &str) -> Result<String, FileError> {
        if path.starts_with('/') || path.split('/').any(|part| part == "..") {
            return Err(FileError::Outside);
        }
        let name = path.trim_start_matches("./");
        if self.files.contains_key(name) { Ok(name.to_owned()) } else { Err(FileError::Missing { similar: Vec::new() }) }
    }

    fn read(&self, resolved: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let bytes = self.files.get(resolved).ok_or(FileError::Missing { similar: Vec::new() })?;
        if bytes.len() as u64 > limit { Err(FileError::TooLarge(bytes.len() as u64)) } else { Ok(bytes.clone()) }
    }

    fn write(&self, path: &str, fill: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>) -> Result<u64, FileError> {
        if path.starts_with('/') || path.split('/').any(|part| part == "..") {
            return Err(FileError::Outside);
        }
        let mut bytes = Vec::new();
        fill(&mut bytes).map_err(|error| FileError::Other(error.to_string()))?;
        let n = bytes.len() as u64;
        self.written.borrow_mut().insert(path.to_owned(), bytes);
        Ok(n)
    }
}
