//! Outputs on their way: written under a temporary name beside their place, and renamed all together at the end.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::temporary_files::{remove_leftovers, temporary_name};
use crate::base::job;

/// Bytes gathered before the system is asked to write.
const BUFFER: usize = 1 << 18;

/// One output that is complete under its temporary name.
#[derive(Debug)]
struct Staged {
    temporary: PathBuf,
    place: PathBuf,
    finished: bool,
}

/// A finished output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placed {
    /// Where it stands now.
    pub path: PathBuf,
}

/// The outputs of one run. Cheap to clone; all clones speak of the same files.
///
/// What was staged and not committed is removed when the last clone goes, and by [`Staging::discard`] when the
/// program is told to stop at once.
#[derive(Clone, Debug, Default)]
pub struct Staging(Arc<Inner>);

#[derive(Debug, Default)]
struct Inner {
    files: Mutex<Vec<Staged>>,
    announced: AtomicU64,
    /// Folders where nothing is left of runs that were killed.
    swept: Mutex<BTreeSet<PathBuf>>,
}

impl Inner {
    fn files(&self) -> MutexGuard<'_, Vec<Staged>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn remove_all(&self) {
        for staged in self.files().drain(..) {
            // Nothing can be done about a temporary file that does not go.
            let _ = fs::remove_file(staged.temporary);
        }
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        self.remove_all();
    }
}

impl Staging {
    /// Writes one output under a temporary name in the folder of `place`; gives its size in bytes.
    ///
    /// A second output for the same place replaces the first.
    pub fn write(&self, place: &Path, fill: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>) -> io::Result<u64> {
        if place.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "there is a folder of this name"));
        }
        // A bare name has the empty path as its parent, which cannot be listed.
        let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(folder)?;
        if self.0.swept.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
            remove_leftovers(folder);
        }
        let temporary = self.announce(place, folder);
        let written = fill_file(&temporary, fill);
        let mut files = self.0.files();
        if written.is_ok() {
            files.iter_mut().filter(|staged| staged.temporary == temporary).for_each(|staged| staged.finished = true);
        } else {
            files.retain(|staged| staged.temporary != temporary);
            let _ = fs::remove_file(&temporary);
        }
        written
    }

    /// Chooses the temporary name and remembers it before the file exists, so that it can always be removed.
    fn announce(&self, place: &Path, folder: &Path) -> PathBuf {
        let number = self.0.announced.fetch_add(1, Ordering::Relaxed);
        let mut files = self.0.files();
        let name = place.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let temporary = folder.join(temporary_name(&name, number));
        files.push(Staged { temporary: temporary.clone(), place: place.to_owned(), finished: false });
        temporary
    }

    /// Gives all staged outputs their names, in the order of writing.
    pub fn commit(&self) -> io::Result<Vec<Placed>> {
        let mut files = self.0.files();
        let mut placed = Vec::new();
        for staged in files.drain(..).collect::<Vec<_>>() {
            if !staged.finished {
                let _ = fs::remove_file(&staged.temporary);
                continue;
            }
            if let Err(error) = fs::rename(&staged.temporary, &staged.place) {
                let _ = fs::remove_file(&staged.temporary);
                return Err(io::Error::new(error.kind(), format!("{}: {error}", staged.place.display())));
            }
            placed.push(Placed { path: staged.place });
        }
        Ok(placed)
    }

    /// Gives the files that are staged these permissions, as those they take the place of have.
    pub fn permit(&self, permissions: &fs::Permissions) -> io::Result<()> {
        self.0.files().iter().try_for_each(|staged| fs::set_permissions(&staged.temporary, permissions.clone()))
    }

    /// Removes everything that was not committed.
    pub fn discard(&self) {
        self.0.remove_all();
    }
}

fn fill_file(path: &Path, fill: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>) -> io::Result<u64> {
    let mut out = Counted { inner: BufWriter::with_capacity(BUFFER, File::create(path)?), bytes: 0 };
    fill(&mut out)?;
    out.flush()?;
    Ok(out.bytes)
}

/// Counts what goes through, and looks whether it still should.
pub(super) struct Counted<W> {
    pub(super) inner: W,
    pub(super) bytes: u64,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        job::poll();
        let n = self.inner.write(data)?;
        self.bytes += n as u64;
        Ok(n)
    }
    fn write_all(&mut self, data: &[u8]) -> io::Result<()> {
        job::poll();
        self.inner.write_all(data)?;
        self.bytes += data.len() as u64;
        Ok(())
    }
    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}
