//! Another text in the place of a script.

use std::fs;
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

use super::interrupt;
use crate::session::staging::Staging;

/// Puts a text in place of a file, whole or not at all: permissions are kept, and a link goes on pointing to its file.
///
/// Fails where the file is not there, is write-protected or cannot be written.
pub fn rewrite(path: &Path, text: &str) -> Result<()> {
    let real = path.canonicalize()?;
    let permissions = fs::metadata(&real)?.permissions();
    if permissions.readonly() {
        return Err(Error::new(ErrorKind::PermissionDenied, "it may not be written"));
    }
    let staging = Staging::default();
    interrupt::protect(&staging);
    staging.write(&real, &mut |out| out.write_all(text.as_bytes()))?;
    staging.permit(&permissions)?;
    staging.commit().map(drop)
}
