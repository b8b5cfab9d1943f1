//! Temporary names of outputs, and what killed runs left under such names.

use std::fs;
use std::path::Path;
use std::time::Duration;

/// Age at which a temporary file is of no run, whatever process has its number now.
const OLD: Duration = Duration::from_secs(7 * 24 * 3600);

/// The temporary name of an output: `.roof.stl.4711-0.tmp`, with the number of this process.
pub fn temporary_name(name: &str, number: u64) -> String {
    format!(".{name}.{}-{number}.tmp", std::process::id())
}

/// Removes what runs that were killed left in a folder: files with a [`temporary_name`] whose process is gone, or that are
/// a week old. Nothing else is touched, and what cannot be removed stays.
pub fn remove_leftovers(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let Some(process) = process_of(&entry.file_name().to_string_lossy()) else { continue };
        let Ok(about) = entry.metadata() else { continue };
        let old = about.modified().ok().and_then(|at| at.elapsed().ok()).is_some_and(|age| age > OLD);
        if about.is_file() && process != std::process::id() && (old || is_gone(process)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The process of a temporary name; `None` for names that are none of ours.
fn process_of(name: &str) -> Option<u32> {
    let (name, last) = name.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once('.')?;
    let (process, number) = last.split_once('-')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    (!name.is_empty() && digits(process) && digits(number)).then(|| process.parse().ok())?
}

/// Whether no process has the number; where the system does not say so in files, none is known to be gone.
fn is_gone(process: u32) -> bool {
    Path::new("/proc/self").exists() && !Path::new("/proc").join(process.to_string()).exists()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs::File;
    use std::time::SystemTime;

    #[test]
    fn only_what_killed_runs_left_goes() {
        let folder = std::env::temp_dir().join(format!("loft-sweep-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join(".folder.999999999-0.tmp")).unwrap();
        // No system gives a process this number.
        let gone = ".roof.stl.999999999-3.tmp";
        let alive = format!(".roof.stl.{}-0.tmp", std::os::unix::process::parent_id());
        let own = temporary_name("roof.stl", 1);
        let others =
            ["roof.stl", ".roof.stl.tmp", ".roof.stl.12a-0.tmp", ".999999999-0.tmp", "roof.999999999-0.tmp", ".a.999999999-0.tmp.bak"];
        for name in others.into_iter().chain([gone, alive.as_str(), own.as_str()]) {
            fs::write(folder.join(name), "x").unwrap();
        }
        remove_leftovers(&folder);
        let stands = |name: &str| folder.join(name).exists();
        assert!(others.into_iter().all(stands) && stands(".folder.999999999-0.tmp"));
        assert!(stands(&alive) && stands(&own));
        assert_eq!(stands(gone), !Path::new("/proc/self").exists());
        File::options().write(true).open(folder.join(&alive)).unwrap().set_modified(SystemTime::now() - 2 * OLD).unwrap();
        remove_leftovers(&folder);
        assert!(!stands(&alive), "a week old");
        fs::remove_dir_all(&folder).unwrap();
    }
}
