//! Results on disk: one file each, named by the key of what it was made from.
//!
//! ```text
//! mesh-0123456789abcdef0123456789abcdef.kept
//!   "loftkept", format, key, length of the rest, checksum of the rest, the rest
//! ```
//!
//! Files are written under a temporary name and renamed, so that several processes may use one folder. A file that is
//! not exactly what was written is no file: the result is made anew and takes its place.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use super::staging::Staging;
use crate::base::bytes::{self, bytes_of};
use crate::base::digest::{Digest, StableHasher};
use crate::base::limits::CACHE_BYTES;
use crate::mesh::cache::reuse::Shelf;

const MAGIC: [u8; 8] = *b"loftkept";
/// One more whenever the bytes of a result change their meaning; older files are never read.
const FORMAT: u32 = 2;
const ENDING: &str = ".kept";

/// What a file begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FileHeader {
    magic: [u8; 8],
    format: u32,
    key: u128,
    length: u64,
    checksum: u128,
}

crate::plain!(FileHeader { magic, format, key, length, checksum });

/// Bytes of a [`FileHeader`].
const HEAD: usize = 8 + 4 + 16 + 8 + 16;

/// A folder of results.
#[derive(Debug)]
pub struct Cache {
    folder: PathBuf,
    limit: u64,
    staging: Staging,
    state: Mutex<CacheState>,
}

#[derive(Debug, Default)]
struct CacheState {
    found: usize,
    written: bool,
    trouble: Option<String>,
    reported: bool,
}

impl Cache {
    /// The results in a folder, which is made when there is none. What goes wrong is kept for [`Cache::trouble`]; without
    /// a usable folder every result is made anew.
    pub fn new(folder: &Path) -> Self {
        Self::with_limit(folder, CACHE_BYTES)
    }

    fn with_limit(folder: &Path, limit: u64) -> Self {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let cache = Self { folder, limit, staging: Staging::default(), state: Mutex::default() };
        if let Err(error) = fs::create_dir_all(&cache.folder) {
            cache.complain(&error);
        }
        cache
    }

    fn state(&self) -> MutexGuard<'_, CacheState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn complain(&self, error: &io::Error) {
        self.state().trouble.get_or_insert_with(|| super::disk::plain(error));
    }

    /// Results that were read so far.
    pub fn found(&self) -> usize {
        self.state().found
    }

    /// Why nothing can be kept there, in the system's words; reported once.
    pub fn trouble(&self) -> Option<String> {
        let mut state = self.state();
        let trouble = state.trouble.clone().filter(|_| !state.reported);
        state.reported |= trouble.is_some();
        trouble
    }

    fn place(&self, kind: &str, key: Digest) -> PathBuf {
        self.folder.join(format!("{kind}-{:032x}{ENDING}", key.0))
    }

    /// The result of a kind under a key, when it is there and `read` can make something of it.
    pub fn get<T>(&self, kind: &str, key: Digest, read: impl FnOnce(&[u8]) -> Option<T>) -> Option<T> {
        let place = self.place(kind, key);
        let found = read(&self.body(&place, key, checksum_of(kind))?)?;
        self.state().found += 1;
        // What is used stays longest; a folder that may only be read has no use for that.
        let _ = File::options().write(true).open(&place).and_then(|file| file.set_modified(SystemTime::now()));
        Some(found)
    }

    /// The bytes behind the head, when the file is whole and is this one.
    fn body(&self, place: &Path, key: Digest, checksum: impl Fn(&[u8]) -> u128) -> Option<Vec<u8>> {
        let about = fs::metadata(place).ok().filter(fs::Metadata::is_file)?;
        let length = about.len().checked_sub(HEAD as u64).filter(|n| *n <= self.limit)?;
        let mut file = File::open(place).ok()?;
        let mut head = [0; HEAD];
        file.read_exact(&mut head).ok()?;
        let head: FileHeader = bytes::read(&head)?;
        if (head.magic, head.format, head.key, head.length) != (MAGIC, FORMAT, key.0, length) {
            return None;
        }
        let mut body = Vec::with_capacity(usize::try_from(length).ok()?);
        file.take(length + 1).read_to_end(&mut body).ok()?;
        (body.len() as u64 == length && checksum(&body) == head.checksum).then_some(body)
    }

    /// Keeps a result. One that is larger than a quarter of the folder's room is not kept.
    pub fn put(&self, kind: &str, key: Digest, body: &[u8]) {
        if body.len() as u64 > self.limit / 4 || self.state().trouble.is_some() {
            return;
        }
        let head = FileHeader { magic: MAGIC, format: FORMAT, key: key.0, length: body.len() as u64, checksum: checksum_of(kind)(body) };
        let written = self.staging.write(&self.place(kind, key), &mut |out| {
            out.write_all(&bytes_of(&head))?;
            out.write_all(body)
        });
        match written.and_then(|_| self.staging.commit()) {
            Ok(_) => self.state().written = true,
            Err(error) => self.complain(&error),
        }
    }

    /// Makes room at the end of a run: while the files are too many bytes, those not used for longest go.
    pub fn tidy(&self) {
        if !std::mem::take(&mut self.state().written) {
            return;
        }
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        let mut files: Vec<(SystemTime, PathBuf, u64)> = Vec::new();
        for entry in entries.flatten() {
            if is_ours(&entry.file_name().to_string_lossy())
                && let Ok(about) = entry.metadata()
                && about.is_file()
            {
                files.push((about.modified().unwrap_or(SystemTime::UNIX_EPOCH), entry.path(), about.len()));
            }
        }
        let mut bytes: u64 = files.iter().map(|f| f.2).sum();
        files.sort();
        for (_, path, length) in files {
            if bytes <= self.limit {
                break;
            }
            // Another process may have been faster.
            let _ = fs::remove_file(path);
            bytes -= length;
        }
    }
}

impl Shelf for Cache {
    fn face(&self, key: Digest) -> Option<Vec<u8>> {
        self.get("face", key, |bytes| Some(bytes.to_vec()))
    }

    fn put_face(&self, key: Digest, bytes: &[u8]) {
        self.put("face", key, bytes);
    }
}

/// The checksum of a body of a kind, so that a file of one kind does not pass for another.
fn checksum_of(kind: &str) -> impl Fn(&[u8]) -> u128 {
    move |body| StableHasher::new(kind).bytes(body).finish().0
}

/// Whether a file has a name of ours.
fn is_ours(name: &str) -> bool {
    let key = name.strip_suffix(ENDING).and_then(|name| name.rsplit_once('-'));
    key.is_some_and(|(kind, key)| !kind.is_empty() && key.len() == 32 && key.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f')))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("loft-cache-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    fn whole(cache: &Cache, key: Digest) -> Option<Vec<u8>> {
        cache.get("mesh", key, |body| Some(body.to_vec()))
    }

    #[test]
    fn a_file_that_is_not_what_was_written_is_no_file() {
        let folder = folder("torn");
        let cache = Cache::new(&folder);
        let (key, body) = (Digest(77), (0..=255).collect::<Vec<u8>>());
        assert_eq!(whole(&cache, key), None);
        cache.put("mesh", key, &body);
        assert_eq!(whole(&cache, key).as_ref(), Some(&body));
        assert_eq!((cache.found(), cache.trouble()), (1, None));
        let place = cache.place("mesh", key);
        let good = fs::read(&place).unwrap();
        for at in 0..good.len() {
            fs::write(&place, &good[..at]).unwrap();
            assert_eq!(whole(&cache, key), None, "cut at {at}");
            for bit in 0..8 {
                let mut bad = good.clone();
                bad[at] ^= 1 << bit;
                fs::write(&place, &bad).unwrap();
                assert_eq!(whole(&cache, key), None, "bit {bit} of byte {at}");
            }
        }
        fs::write(&place, [good.as_slice(), b"more"].concat()).unwrap();
        assert_eq!(whole(&cache, key), None);
        fs::write(&place, &good).unwrap();
        fs::rename(&place, cache.place("mesh", Digest(78))).unwrap();
        assert_eq!(whole(&cache, Digest(78)), None, "under another key");
        fs::rename(cache.place("mesh", Digest(78)), cache.place("row", key)).unwrap();
        assert_eq!(cache.get("row", key, |body| Some(body.to_vec())), None, "as another kind");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_was_not_used_for_longest_goes_first() {
        let folder = folder("room");
        let cache = Cache::with_limit(&folder, 1_000);
        fs::write(folder.join("notes-of-mine.txt"), vec![b'x'; 5_000]).unwrap();
        let old = |key: u128, seconds: u64| {
            let file = File::options().write(true).open(cache.place("mesh", Digest(key))).unwrap();
            file.set_modified(SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(seconds)).unwrap();
        };
        for key in 0..4 {
            cache.put("mesh", Digest(key), &[7; 200]);
            old(key, 1_000 + key as u64);
        }
        assert!(whole(&cache, Digest(0)).is_some(), "the oldest was used again");
        cache.put("mesh", Digest(4), &[7; 100]);
        cache.put("mesh", Digest(5), &[7; 300]);
        cache.tidy();
        let left: Vec<u128> = (0..6).filter(|key| cache.place("mesh", Digest(*key)).exists()).collect();
        assert_eq!(left, [0, 2, 3, 4], "300 bytes are more than a quarter; 1 was not used for longest");
        assert!(folder.join("notes-of-mine.txt").exists());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn trouble_is_told_once() {
        let file = folder("file");
        fs::write(&file, "a file").unwrap();
        let cache = Cache::new(&file.join("inside"));
        cache.put("mesh", Digest(1), b"x");
        assert!(cache.trouble().is_some());
        assert_eq!(cache.trouble(), None);
        fs::remove_file(&file).unwrap();
    }

    #[test]
    fn the_head_is_as_long_as_its_fields() {
        assert_eq!(bytes_of(&FileHeader { magic: MAGIC, format: 1, key: 2, length: 3, checksum: 4 }).len(), HEAD);
    }
}
