//! The files of a run that is started from Rust: in memory, in a folder, or both.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::io::{FileError, Files, Memory};
use crate::session::disk::Disk;
use crate::session::store::{Outputs, Store};

/// Files in memory come before those of the folder; outputs go to a folder, or stay in memory.
pub struct Place {
    /// Given files.
    pub memory: Memory,
    /// The folder of the script; none for a script that reads memory alone.
    pub folder: Option<Disk>,
    /// The folder of outputs; none keeps them in memory.
    pub out: Option<Disk>,
    written: Mutex<BTreeMap<String, Vec<u8>>>,
    read: Mutex<BTreeSet<String>>,
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Place {
    pub fn new(memory: Memory, folder: Option<Disk>, out: Option<Disk>) -> Self {
        Self { memory, folder, out, written: Mutex::default(), read: Mutex::default() }
    }

    /// The outputs that were kept, by path.
    pub fn into_written(self) -> BTreeMap<String, Vec<u8>> {
        self.written.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// A resolved name as files in memory have it.
    fn inside(&self, resolved: &str) -> String {
        self.folder.as_ref().map_or_else(|| resolved.to_owned(), |folder| folder.shown(resolved))
    }
}

impl Files for Place {
    fn resolve(&self, from: &str, path: &str) -> Result<String, FileError> {
        match (self.memory.resolve(&self.inside(from), path), &self.folder) {
            (Ok(name), _) => Ok(name),
            (Err(_), Some(folder)) => folder.resolve(from, path),
            (Err(error), None) => Err(error),
        }
    }

    fn read(&self, resolved: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        match (&self.folder, self.memory.get(resolved)) {
            (Some(folder), None) => folder.read(resolved, limit),
            _ => {
                locked(&self.read).insert(resolved.to_lowercase());
                self.memory.read(resolved, limit)
            }
        }
    }

    fn write(&self, path: &str, fill: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>) -> Result<u64, FileError> {
        if let Some(out) = &self.out {
            return out.write(path, fill);
        }
        self.file_of(path).ok_or(FileError::Outside)?;
        let mut bytes = Vec::new();
        fill(&mut bytes).map_err(|error| FileError::Other(error.to_string()))?;
        let size = bytes.len() as u64;
        locked(&self.written).insert(path.to_owned(), bytes);
        Ok(size)
    }
}

impl Store for Place {
    fn outputs(&self) -> Outputs {
        Outputs::Written
    }

    fn script_name(&self, shown: &str) -> String {
        self.folder.as_ref().map_or_else(|| shown.to_owned(), |folder| folder.script_name(shown))
    }

    fn file_of(&self, path: &str) -> Option<String> {
        match &self.out {
            Some(out) => out.file_of(path),
            None => below(path),
        }
    }

    fn files_read(&self) -> BTreeSet<String> {
        let mut read = self.folder.as_ref().map(Disk::files_read).unwrap_or_default();
        if self.out.is_none() {
            read.extend(locked(&self.read).iter().cloned());
        }
        read
    }

    fn shown_place(&self, path: &str) -> String {
        self.out.as_ref().map_or_else(|| path.to_owned(), |out| out.shown_place(path))
    }

    fn commit(&self) -> io::Result<()> {
        self.out.as_ref().map_or(Ok(()), Disk::commit)
    }

    fn discard(&self) {
        if let Some(out) = &self.out {
            out.discard();
        }
        locked(&self.written).clear();
    }
}

/// The path without `.` and `..`, letter case aside; `None` for one that is absolute, empty or leads outside.
fn below(path: &str) -> Option<String> {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.split(['/', '\\']) {
        match part {
            "" if parts.is_empty() => return None,
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/").to_lowercase())
}
