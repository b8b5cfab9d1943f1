//! The file of the script, where the page writes the defaults of params.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::model::Script;
use crate::cli::rewrite::rewrite;
use crate::session::view::write_back::with_default;

/// A script on the disk.
pub struct ScriptFile {
    path: PathBuf,
    /// One default is written after the other.
    writing: Mutex<()>,
}

impl ScriptFile {
    /// Of a path.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), writing: Mutex::default() }
    }
}

impl Script for ScriptFile {
    fn write(&self, name: &str, text: &str) -> Result<(), String> {
        let _alone = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
        let failed = |what: &str, error: std::io::Error| format!("cannot {what} {}: {error}", self.path.display());
        let script = fs::read_to_string(&self.path).map_err(|error| failed("read", error))?;
        rewrite(&self.path, &with_default(&script, name, text)?).map_err(|error| failed("write", error))
    }

    fn show(&self, _: &str, _: u32, _: u32) -> bool {
        // Editors open places by addresses of their own, which the page offers.
        false
    }
}
