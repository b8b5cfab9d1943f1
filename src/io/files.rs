//! How files come and go: one small trait, so that nothing below the session touches the disk.

use std::io::Write;

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

/// Source of scripts and data, sink of outputs.
pub trait Files {
    /// A name that is equal for two paths that lead to the same file. `from` is the script that names it.
    fn resolve(&self, from: &str, path: &str) -> Result<String, FileError>;
    /// The bytes of a resolved file, at most `limit` of them.
    fn read(&self, resolved: &str, limit: u64) -> Result<Vec<u8>, FileError>;
    /// Writes a whole output or nothing: `fill` writes into a sink that becomes the file when all is well.
    fn write(&self, path: &str, fill: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>) -> Result<u64, FileError>;
}
