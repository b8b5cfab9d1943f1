//! Compared files: their stored copies beside the golden, and what differs.
//!
//! OBJ and STL are compared as geometry, other texts token by token, everything else byte by byte.

use std::fs;
use std::path::{Path, PathBuf};

use super::file::Compare;
use super::geometry::{self, Shape};
use super::tokens;
use crate::base::limits;
use crate::io::FileError;
use crate::lang::values::units::{convert, length_unit};
use crate::session::disk::read_limited;
use crate::session::report::OutputRow;
use crate::session::staging::Staging;

/// The files that a run wrote.
#[derive(Clone, Debug)]
pub struct CaseFiles {
    /// Where they are.
    pub folder: PathBuf,
    /// Their paths inside it.
    pub outputs: Vec<OutputRow>,
}

/// A compared file that is not as it was.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileChange {
    /// In words.
    pub text: String,
    /// There is no stored copy.
    pub missing: bool,
}

/// Compares what was written with the stored copies; what is as it was is left out.
pub fn compare(stored: &Path, written: &CaseFiles, compares: &[Compare]) -> Vec<FileChange> {
    let one = |c: &Compare| {
        let old = match read_limited(&stored.join(&c.file), limits::DATA_BYTES) {
            Ok(bytes) => bytes,
            Err(FileError::Missing { .. }) => {
                let text = format!("{}: there is no stored copy {}", c.file, stored.join(&c.file).display());
                return Some(FileChange { text, missing: true });
            }
            Err(error) => return Some(FileChange { text: format!("{}: cannot read the stored copy: {error:?}", c.file), missing: false }),
        };
        let text = match read(written, c) {
            Ok((new, unit)) => differs(c, &old, &new, unit)?,
            Err(text) => text,
        };
        Some(FileChange { text: format!("{}: {text}", c.file), missing: false })
    };
    compares.iter().filter_map(one).collect()
}

/// A file that was written, and the unit of its lengths; the error is a sentence.
fn read(written: &CaseFiles, c: &Compare) -> Result<(Vec<u8>, &'static str), String> {
    let Some(row) = written.outputs.iter().find(|row| Path::new(&row.path) == Path::new(&c.file)) else {
        let names: Vec<&str> = written.outputs.iter().map(|row| row.path.as_str()).collect();
        return Err(match names.as_slice() {
            [] => "the model writes nothing".to_owned(),
            names => format!("the model does not write it; it writes {}", names.join(", ")),
        });
    };
    let bytes = read_limited(&written.folder.join(&row.path), limits::DATA_BYTES).map_err(|error| format!("cannot read it: {error:?}"))?;
    Ok((bytes, row.unit))
}

/// What differs, in words.
fn differs(c: &Compare, old: &[u8], new: &[u8], unit: &str) -> Option<String> {
    if old == new {
        return None;
    }
    let within = match (c.unit, length_unit(unit)) {
        (Some(from), Some(to)) => convert(c.within, from, to, 1),
        _ => c.within,
    };
    let ending = Path::new(&c.file).extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let shapes = match ending.as_str() {
        "obj" => Some((Shape::from_obj(old), Shape::from_obj(new))),
        "stl" => Some((Shape::from_stl(old), Shape::from_stl(new))),
        _ => None,
    };
    match shapes {
        Some((Ok(old), Ok(new))) => geometry::differs(&old, &new, within, unit),
        Some((Err(at), _)) => Some(format!("the stored copy cannot be read: line {}: {}", at.line, at.what)),
        Some((_, Err(at))) => Some(format!("it cannot be read: line {}: {}", at.line, at.what)),
        None => match (tokens::text_of(old), tokens::text_of(new)) {
            (Some(a), Some(b)) => tokens::differs(a, b, within, matches!(ending.as_str(), "bdf" | "nas" | "dat")),
            _ => Some(bytes(old, new)),
        },
    }
}

fn bytes(old: &[u8], new: &[u8]) -> String {
    let at = old.iter().zip(new).position(|(a, b)| a != b).unwrap_or(old.len().min(new.len()));
    let lengths = if old.len() == new.len() { String::new() } else { format!("{} → {} bytes; ", old.len(), new.len()) };
    format!("{lengths}the first byte that differs is number {}", at + 1)
}

/// Stages new stored copies; whether any differs from the one that is there. The error is a sentence.
pub fn store(stored: &Path, written: &CaseFiles, compares: &[Compare], staging: &Staging) -> Result<bool, String> {
    let mut changed = false;
    for c in compares {
        let (bytes, _) = read(written, c).map_err(|text| format!("cannot store {:?}: {text}", c.file))?;
        let place = stored.join(&c.file);
        if fs::read(&place).is_ok_and(|old| old == bytes) {
            continue;
        }
        let put = staging.write(&place, &mut |out| out.write_all(&bytes));
        put.map_err(|error| format!("cannot write {}: {error}", place.display()))?;
        changed = true;
    }
    Ok(changed)
}

/// Stored files that no case compares, in order of their paths.
pub fn orphans(stored: &Path, cases: &[PathBuf], compares: &[Compare]) -> Vec<PathBuf> {
    let wanted: Vec<PathBuf> = cases.iter().flat_map(|case| compares.iter().map(move |c| stored.join(case).join(&c.file))).collect();
    let mut found = Vec::new();
    let mut folders = vec![stored.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if entry.file_name().to_string_lossy().starts_with('.') {
                continue;
            }
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                folders.push(path);
            } else if !wanted.contains(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
