//! How long tests run: a sample of the scripts and a few random cases in `cargo test`, all scripts and many cases in a long run
//! (`LOFT_LONG=1`, as in `.ci/run`).

use std::fs;
use std::path::{Path, PathBuf};

/// Whether this is a long run.
pub fn is_long() -> bool {
    std::env::var_os("LOFT_LONG").is_some()
}

/// How many random cases: what the variable says, else `many` in a long run and `few` in a short one.
pub fn count(variable: &str, few: usize, many: usize) -> usize {
    let asked = std::env::var(variable).ok().and_then(|n| n.parse().ok());
    asked.unwrap_or(if is_long() { many } else { few })
}

/// The project's folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All scripts below some folders of the project, by path from the project's folder, sorted.
pub fn scripts(folders: &[&str]) -> Vec<PathBuf> {
    let (mut open, mut found): (Vec<PathBuf>, Vec<PathBuf>) = (folders.iter().map(PathBuf::from).collect(), Vec::new());
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap().flatten() {
            let path = folder.join(entry.file_name());
            if entry.file_type().unwrap().is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "loft") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// One of four parts that a script belongs to, by a digest of its path, so that a new script leaves the others where they are; another
/// `round` parts them in another way.
pub fn quarter(path: &Path, round: u64) -> u64 {
    // FNV-1a, 64 bits.
    let bytes = path.to_string_lossy().replace('\\', "/").into_bytes();
    let digest = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3));
    (digest >> (32 - 4 * round)) % 4
}

/// About an eighth of the scripts in a short run, all of them in a long one.
pub fn sample(scripts: Vec<PathBuf>, part: u64) -> Vec<PathBuf> {
    let is_chosen = |path: &PathBuf| quarter(path, 0) == part && quarter(path, 2) < 2;
    scripts.into_iter().filter(|path| is_long() || is_chosen(path)).collect()
}
