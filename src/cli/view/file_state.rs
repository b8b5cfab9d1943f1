//! One file as it was seen last, and whether it has changed since.
//!
//! A change is told when the file has been the same for two looks a few milliseconds apart, so that a save in pieces is not read half-way.
//! Editors also empty a file before they fill it, or move it away and write a new one: a file that is empty or missing gets more time. A
//! writer that pauses for longer is told twice; the second time stands.

use std::fs::{self, File, Metadata};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// How long a file must stay the same.
const SETTLED: Duration = Duration::from_millis(3);

/// How long a file must be empty when it was not before.
const EMPTIED: Duration = Duration::from_millis(100);

/// How long a file must be missing.
const MISSING: Duration = Duration::from_millis(200);

/// How long after a change the content is compared as well: two changes within one tick of the file system's clock look alike.
const TICK: Duration = Duration::from_millis(100);

/// The same for file systems that keep whole seconds.
const COARSE_TICK: Duration = Duration::from_millis(2500);

/// A file larger than this is known by size and times alone.
const MOST_COMPARED: u64 = 16 << 20;

/// Bytes that are read of a file.
const MOST_READ: u64 = 64 << 20;

/// What a look at a file found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Look {
    /// Nothing new.
    Same,
    /// It is changing; to be looked at again in a few milliseconds.
    Unsettled,
    /// New content; `None` where the file is gone or cannot be read.
    Changed(Option<Vec<u8>>),
}

/// What a file system tells of a file without reading it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Stamp {
    length: u64,
    modified: Option<SystemTime>,
    /// Device, number, and time of the last change of name or owner; zeros where the system does not tell.
    identity: [i64; 4],
}

/// A file that is watched.
#[derive(Clone, Debug)]
pub struct FileState {
    path: PathBuf,
    stamp: Option<Stamp>,
    /// Of the content; `None` where there is no file.
    digest: Option<u64>,
    /// A stamp that is not known yet, and since when it has been seen.
    unsettled: Option<(Option<Stamp>, Instant)>,
    /// Until when the stamp alone is not believed.
    doubt: Instant,
}

impl FileState {
    /// A file of which nothing is known: the first look that finds one tells its content.
    pub fn unknown(path: &Path) -> Self {
        Self { path: path.to_owned(), stamp: None, digest: None, unsettled: None, doubt: Instant::now() }
    }

    /// A file as it is now.
    pub fn now(path: &Path) -> Self {
        let stamp = Stamp::of(path);
        let digest = read(path).map(|bytes| digest(&bytes, stamp.as_ref()));
        Self { path: path.to_owned(), stamp, digest, unsettled: None, doubt: Instant::now() + tick(stamp) }
    }

    /// The file's name as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// There was a file when it was looked at last.
    pub fn is_there(&self) -> bool {
        self.digest.is_some()
    }

    /// It was written or renamed at that time or later, as far as the clocks tell.
    pub fn is_newer_than(&self, time: SystemTime) -> bool {
        let Some(stamp) = self.stamp else { return false };
        let [.., seconds, nanoseconds] = stamp.identity;
        let named = Duration::new(u64::try_from(seconds).unwrap_or(0), u32::try_from(nanoseconds).unwrap_or(0));
        let latest = stamp.modified.max(SystemTime::UNIX_EPOCH.checked_add(named));
        // The clock of the file system is behind by a tick.
        latest.and_then(|latest| latest.checked_add(Duration::from_millis(20))).is_some_and(|latest| latest >= time)
    }

    /// Looks at the file.
    pub fn look(&mut self, now: Instant) -> Look {
        let stamp = Stamp::of(&self.path);
        if stamp == self.stamp && (now >= self.doubt || !self.is_other()) {
            self.unsettled = None;
            return Look::Same;
        }
        let since = match self.unsettled {
            Some((seen, since)) if seen == stamp => since,
            _ => {
                self.unsettled = Some((stamp, now));
                return Look::Unsettled;
            }
        };
        let patience = match stamp {
            None => MISSING,
            Some(stamp) if stamp.length == 0 && self.stamp.is_some_and(|before| before.length > 0) => EMPTIED,
            Some(_) => SETTLED,
        };
        if now.duration_since(since) < patience {
            return Look::Unsettled;
        }
        let bytes = read(&self.path);
        if Stamp::of(&self.path) != stamp {
            return Look::Unsettled;
        }
        let digest = bytes.as_ref().map(|bytes| digest(bytes, stamp.as_ref()));
        let same = digest == self.digest;
        *self = Self { path: std::mem::take(&mut self.path), stamp, digest, unsettled: None, doubt: now + tick(stamp) };
        if same { Look::Same } else { Look::Changed(bytes) }
    }

    /// The content differs although the stamp does not.
    fn is_other(&self) -> bool {
        let small = self.stamp.is_some_and(|stamp| stamp.length <= MOST_COMPARED);
        small && read(&self.path).map(|bytes| digest(&bytes, self.stamp.as_ref())) != self.digest
    }
}

impl Stamp {
    fn of(path: &Path) -> Option<Self> {
        let about = fs::metadata(path).ok()?;
        Some(Self { length: about.len(), modified: about.modified().ok(), identity: identity(&about) })
    }
}

#[cfg(unix)]
fn identity(about: &Metadata) -> [i64; 4] {
    use std::os::unix::fs::MetadataExt;
    [about.dev().cast_signed(), about.ino().cast_signed(), about.ctime(), about.ctime_nsec()]
}

#[cfg(not(unix))]
fn identity(_: &Metadata) -> [i64; 4] {
    [0; 4]
}

/// How long another change may have the same times.
fn tick(stamp: Option<Stamp>) -> Duration {
    let time = stamp.and_then(|stamp| stamp.modified?.duration_since(SystemTime::UNIX_EPOCH).ok());
    if time.is_some_and(|time| time.subsec_nanos() == 0) { COARSE_TICK } else { TICK }
}

fn read(path: &Path) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(MOST_READ).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

fn digest(bytes: &[u8], stamp: Option<&Stamp>) -> u64 {
    let mut hasher = DefaultHasher::new();
    if bytes.len() as u64 > MOST_COMPARED {
        stamp.hash(&mut hasher);
    } else {
        bytes.hash(&mut hasher);
    }
    hasher.finish()
}
