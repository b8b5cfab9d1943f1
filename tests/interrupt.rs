//! A run that is stopped leaves the old outputs or the new ones, never half of one.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

const SCRIPT: &str = "units m
curve south = line((0, 0, 0), (4, 0, 0))
curve north = arc((0, 3, 0), (4, 3, 0), through: (2, 3, 1))
curve west = line(south.start, north.start)
curve east = line(south.end, north.end)
surface roof = coons(south, east, north, west)
mesh fine of roof { size: 20mm }
export fine to \"a.stl\"
export fine to \"b.inp\"
export fine to \"c.obj\"
export fine to \"d.vtu\"
";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("interrupt-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("model.loft"), SCRIPT).unwrap();
    folder
}

fn loft(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
    command.args(["run", "model.loft"]).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Names and bytes of all files but the script.
fn outputs(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found: Vec<(String, Vec<u8>)> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.file_name().is_some_and(|n| n != "model.loft"))
        .map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&p).unwrap()))
        .collect();
    found.sort();
    found
}

fn stop_after(folder: &Path, millis: u64, signal: &str) -> Option<i32> {
    let mut child = loft(folder).spawn().unwrap();
    sleep(Duration::from_millis(millis));
    let _ = Command::new("kill").args([signal, &child.id().to_string()]).stderr(Stdio::null()).status();
    child.wait().unwrap().code()
}

#[test]
fn ctrl_c_ends_with_130_and_leaves_nothing_half() {
    let folder = folder("int");
    assert!(loft(&folder).status().unwrap().success());
    let whole = outputs(&folder);
    assert_eq!(whole.len(), 4);
    for name in ["a.stl", "b.inp", "c.obj", "d.vtu"] {
        fs::write(folder.join(name), "old").unwrap();
    }
    let mut stopped = 0;
    for millis in [5, 15, 30, 60, 90, 140, 200, 300, 450] {
        let status = stop_after(&folder, millis, "-INT");
        let found = outputs(&folder);
        assert_eq!(found.len(), 4, "temporary files stayed after {millis} ms: {:?}", found.iter().map(|f| &f.0).collect::<Vec<_>>());
        let old = found.iter().all(|f| f.1 == b"old");
        match status {
            Some(0) => assert!(found == whole, "a finished run left something else"),
            // The signal may come before the program has its handler.
            Some(130) | None => {
                assert!(old, "an interrupted run changed outputs after {millis} ms");
                stopped += 1;
            }
            other => panic!("status {other:?} after {millis} ms"),
        }
        if !old {
            for name in ["a.stl", "b.inp", "c.obj", "d.vtu"] {
                fs::write(folder.join(name), "old").unwrap();
            }
        }
    }
    assert!(stopped > 0, "no run was caught");
}

#[test]
fn a_killed_run_leaves_whole_files_only() {
    let folder = folder("kill");
    assert!(loft(&folder).status().unwrap().success());
    let whole = outputs(&folder);
    for millis in [20, 60, 120, 250] {
        for (name, _) in &whole {
            fs::write(folder.join(name), "old").unwrap();
        }
        stop_after(&folder, millis, "-KILL");
        for (name, bytes) in outputs(&folder) {
            let expected = whole.iter().find(|w| w.0 == name).map(|w| &w.1);
            // Under a name of an output stands the old file or the new one; what was on its way has a temporary name.
            assert!(expected.is_none_or(|new| bytes == b"old" || bytes == *new), "{name} is neither old nor new");
        }
    }
}
