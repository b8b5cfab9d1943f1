//! Files on the disk: where scripts and data may be read from and outputs may go.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::similar::similar_names;
use super::staging::{Counted, Staging};
pub use super::store::Outputs;
use super::store::Store;
use crate::base::limits;
use crate::io::{FileError, Files};

/// Texts that stand in an editor, by resolved path: what is read instead of the files of these names.
pub type Unsaved = Arc<BTreeMap<PathBuf, Arc<str>>>;

/// The folders one run may use.
///
/// Reading is confined to the script's folder and below and to what `--allow` names, writing to the output folder;
/// links are resolved before the question is asked.
#[derive(Debug)]
pub struct Disk {
    home: PathBuf,
    shown_home: PathBuf,
    roots: Vec<PathBuf>,
    out: PathBuf,
    outputs: Outputs,
    staging: Staging,
    unsaved: Unsaved,
    /// Files that were read, links resolved.
    read: Mutex<BTreeSet<PathBuf>>,
    /// Files that were looked for and are not there.
    missing: Mutex<BTreeSet<PathBuf>>,
}

impl Disk {
    /// For the script at `script` (`None`: standard input, whose folder is the current one).
    ///
    /// `out` defaults to the script's folder; `allow` lists further folders or files that may be read.
    pub fn new(script: Option<&Path>, out: Option<&Path>, allow: &[PathBuf], outputs: Outputs) -> io::Result<Self> {
        let shown_home =
            script.and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_owned).unwrap_or_default();
        let near = if shown_home.as_os_str().is_empty() { Path::new(".") } else { &shown_home };
        // A script that is itself a link belongs to the folder it is named in.
        let home = near.canonicalize()?;
        let mut roots = vec![home.clone()];
        for path in allow {
            roots.push(path.canonicalize().map_err(|error| io::Error::new(error.kind(), format!("--allow {}: {error}", path.display())))?);
        }
        let out = std::path::absolute(out.unwrap_or(&home))?;
        Ok(Self {
            home,
            shown_home,
            roots,
            out,
            outputs,
            staging: Staging::default(),
            unsaved: Unsaved::default(),
            read: Mutex::default(),
            missing: Mutex::default(),
        })
    }

    /// The same folders with texts that are not saved.
    pub fn with_unsaved(self, unsaved: Unsaved) -> Self {
        Self { unsaved, ..self }
    }

    /// The same folders for one row of a table, whose outputs go to a folder of their own.
    pub fn with_subfolder(&self, name: &str) -> Self {
        Self {
            home: self.home.clone(),
            shown_home: self.shown_home.clone(),
            roots: self.roots.clone(),
            out: self.out.join(name),
            outputs: self.outputs,
            staging: Staging::default(),
            unsaved: self.unsaved.clone(),
            read: Mutex::default(),
            missing: Mutex::default(),
        }
    }

    /// The same, with files named as seen from the script's folder, wherever the program was started.
    pub fn seen_from_home(self) -> Self {
        Self { shown_home: PathBuf::new(), ..self }
    }

    /// The files that were read, links resolved, by path, and those that were looked for and not found: a run depends on both.
    pub fn paths_read(&self) -> Vec<PathBuf> {
        let all = |of: &Mutex<BTreeSet<PathBuf>>| of.lock().unwrap_or_else(PoisonError::into_inner).clone();
        all(&self.read).into_iter().chain(all(&self.missing)).collect()
    }

    /// The outputs that are staged; a clone can discard them from another thread.
    pub fn staging(&self) -> &Staging {
        &self.staging
    }

    /// A resolved name as the user would write it on the command line.
    pub fn shown(&self, resolved: &str) -> String {
        match Path::new(resolved).strip_prefix(&self.home) {
            Ok(inside) => self.shown_home.join(inside).to_string_lossy().into_owned(),
            Err(_) => resolved.to_owned(),
        }
    }

    /// Where an output may stand: inside the output folder, links resolved.
    fn place(&self, path: &str) -> Result<PathBuf, FileError> {
        let wanted = normal_form(&self.out.join(path)).ok_or(FileError::Outside)?;
        let out = normal_form(&self.out).ok_or(FileError::Outside)?;
        let inside = wanted.strip_prefix(&out).map_err(|_| FileError::Outside)?;
        if inside.as_os_str().is_empty() {
            return Err(FileError::Other("it names the output folder itself".to_owned()));
        }
        let (real_out, folder) = (existing_part(&out), existing_part(wanted.parent().unwrap_or(&out)));
        // While the output folder does not exist yet, nothing below it can be a link.
        if out.exists() && !folder.starts_with(real_out) {
            return Err(FileError::Outside);
        }
        Ok(wanted)
    }
}

impl Files for Disk {
    fn resolve(&self, from: &str, path: &str) -> Result<String, FileError> {
        let beside = Path::new(from).parent().filter(|folder| folder.is_absolute()).unwrap_or(&self.home);
        let wanted = beside.join(path);
        let real = match wanted.canonicalize() {
            Ok(real) => real,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                // A path that leads outside is not searched for names.
                let folder = normal_form(&wanted).and_then(|p| p.parent().map(existing_part));
                if !folder.is_some_and(|folder| self.allows(&folder)) {
                    return Err(FileError::Outside);
                }
                self.missing.lock().unwrap_or_else(PoisonError::into_inner).insert(wanted.clone());
                return Err(FileError::Missing { similar: similar_names(&wanted) });
            }
            Err(error) => return Err(FileError::Other(plain(&error))),
        };
        if !self.allows(&real) {
            return Err(FileError::Outside);
        }
        match real.to_str() {
            Some(text) => Ok(text.to_owned()),
            None => Err(FileError::Other("its path is not UTF-8".to_owned())),
        }
    }

    fn read(&self, resolved: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(PathBuf::from(resolved));
        match self.unsaved.get(Path::new(resolved)) {
            Some(text) if text.len() as u64 > limit => Err(FileError::TooLarge(text.len() as u64)),
            Some(text) => Ok(text.as_bytes().to_vec()),
            None => read_limited(Path::new(resolved), limit),
        }
    }

    fn write(&self, path: &str, fill: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>) -> Result<u64, FileError> {
        let place = self.place(path)?;
        let written = match self.outputs {
            Outputs::Written => self.staging.write(&place, fill),
            Outputs::Counted | Outputs::Skipped => {
                let mut sink = Counted { inner: io::sink(), bytes: 0 };
                fill(&mut sink).map(|()| sink.bytes)
            }
        };
        written.map_err(|error| FileError::Other(plain(&error)))
    }
}

impl Store for Disk {
    fn outputs(&self) -> Outputs {
        self.outputs
    }

    fn script_name(&self, shown: &str) -> String {
        let name = Path::new(shown).file_name().unwrap_or_default();
        self.home.join(name).to_string_lossy().into_owned()
    }

    fn file_of(&self, path: &str) -> Option<String> {
        self.place(path).ok().map(|place| same_file(&place))
    }

    fn files_read(&self) -> BTreeSet<String> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).iter().map(|path| same_file(path)).collect()
    }

    fn shown_place(&self, path: &str) -> String {
        let place = normal_form(&self.out.join(path)).unwrap_or_else(|| self.out.join(path));
        let here = std::env::current_dir().unwrap_or_default();
        let below = place.strip_prefix(&here).ok().map(Path::to_owned);
        // The folder of the script has its links resolved, the working directory may be named with some.
        let below = below.or_else(|| place.strip_prefix(here.canonicalize().ok()?).ok().map(Path::to_owned));
        below.unwrap_or(place).to_string_lossy().into_owned()
    }

    fn commit(&self) -> io::Result<()> {
        self.staging.commit().map(|_| ())
    }

    fn discard(&self) {
        self.staging.discard();
    }
}

impl Disk {
    fn allows(&self, real: &Path) -> bool {
        self.roots.iter().any(|root| real.starts_with(root))
    }
}

/// The whole of a regular file of at most `limit` bytes.
pub fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => FileError::Missing { similar: similar_names(path) },
        _ => FileError::Other(plain(&error)),
    };
    let about = fs::metadata(path).map_err(failed)?;
    if about.is_dir() {
        return Err(FileError::Other("it is a folder".to_owned()));
    }
    if !about.is_file() {
        return Err(FileError::Other("it is not a regular file".to_owned()));
    }
    if about.len() > limit {
        return Err(FileError::TooLarge(about.len()));
    }
    fill(Vec::with_capacity(about.len() as usize), File::open(path).map_err(failed)?, limit)
}

/// All bytes of a stream, at most `limit` of them.
pub fn read_stream(stream: impl Read, limit: u64) -> Result<Vec<u8>, FileError> {
    fill(Vec::new(), stream, limit)
}

fn fill(mut bytes: Vec<u8>, stream: impl Read, limit: u64) -> Result<Vec<u8>, FileError> {
    stream.take(limit + 1).read_to_end(&mut bytes).map_err(|error| FileError::Other(plain(&error)))?;
    if bytes.len() as u64 > limit { Err(FileError::TooLarge(bytes.len() as u64)) } else { Ok(bytes) }
}

/// Writes a file whole or not at all: under a temporary name first.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let staging = Staging::default();
    let place = std::path::absolute(path)?;
    staging.write(&place, &mut |out| out.write_all(bytes))?;
    staging.commit().map(|_| ()).map_err(|error| io::Error::other(error.to_string()))
}

/// Why a file cannot be read, in a few words.
pub fn words(error: &FileError) -> String {
    match error {
        FileError::Missing { similar } if similar.is_empty() => "there is no such file".to_owned(),
        FileError::Missing { similar } => format!("there is no such file; there is a {:?}", similar[0]),
        FileError::Outside => "it lies outside the allowed folders".to_owned(),
        FileError::TooLarge(bytes) => format!("it has {bytes} bytes, the limit is {}", limits::SOURCE_BYTES),
        FileError::Other(text) => text.clone(),
    }
}

/// The system's words without its number, in lower case.
pub fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// A name that is equal for two paths to one file: its folder without links, letter case aside.
pub(super) fn same_file(path: &Path) -> String {
    let folder = path.parent().map(existing_part).unwrap_or_default();
    folder.join(path.file_name().unwrap_or_default()).to_string_lossy().to_lowercase()
}

/// The path without `.` and `..`; `None` when it climbs above the root.
fn normal_form(path: &Path) -> Option<PathBuf> {
    let mut result = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                if !result.pop() {
                    return None;
                }
            }
            other => result.push(other),
        }
    }
    Some(result)
}

/// The real path of the longest leading part that exists, with the rest appended.
fn existing_part(path: &Path) -> PathBuf {
    for ancestor in path.ancestors() {
        if let Ok(real) = ancestor.canonicalize() {
            return match path.strip_prefix(ancestor) {
                Ok(rest) if !rest.as_os_str().is_empty() => real.join(rest),
                _ => real,
            };
        }
    }
    path.to_owned()
}
