//! Files that a script writes.

use std::path::{Path, PathBuf};

/// A file that a script exports: in memory, or in the folder that was named for outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    pub(super) path: String,
    pub(super) size: u64,
    pub(super) bytes: Option<Vec<u8>>,
    pub(super) file: Option<PathBuf>,
}

impl Output {
    /// Its path as the script writes it.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Its size, bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Its bytes, where it is in memory.
    pub fn bytes(&self) -> Option<&[u8]> {
        self.bytes.as_deref()
    }

    /// Its text, where it is in memory and UTF-8.
    pub fn text(&self) -> Option<&str> {
        self.bytes().and_then(|bytes| std::str::from_utf8(bytes).ok())
    }

    /// Where it stands, where it is on disk.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }
}
