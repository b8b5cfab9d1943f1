//! Results kept on disk change nothing but the time: cold, warm, after edits, and with files that were damaged.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use lofting::base::job::Job;
use lofting::session::cache::Cache;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;
use lofting::session::json::report_text;
use lofting::session::kept::Kept;
use lofting::session::run::{Again, Outcome, Task, run, run_again};

use crate::support::long::{quarter, root, sample, scripts};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cache-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// One mesh of every shape that a file has to hold, with rules that decide nothing.
const SHAPES: &str = "units m
curve south = line((0, 0, 0), (4, 0, 0))
curve east = arc((4, 0, 0), (4, 3, 0), through: (4.5, 1.5, 0.5))
curve north = line((4, 3, 0), (0, 3, 0))
curve west = line((0, 3, 0), (0, 0, 0))
surface roof = coons(south, east, north, west)
curve fore = line((0, 0, 0), (2, -3, 0))
curve aft = line((2, -3, 0), (4, 0, 0))
surface beak = coons(south, aft, fore)
point tip = (2, 5, 3)
curve left = line((0, 3, 0), tip)
curve right = line((4, 3, 0), tip)
surface cone = coons(north, left, right, pole: tip)
point lone = (9, 9, 9)
group rim of roof, beak, east
mesh plain of roof, beak, cone, west, lone { size: 0.4 }
mesh second of roof, beak { size: 0.5  elements: quads  order: 2 }
mesh apart of roof, beak { size: 0.6  conforming: false }
mesh ruled_twice of roof {
  size: 0.5
  on south { count: 9 }
  on south { count: 7 }
  on aft { size: 0.1 }
}
export plain to \"plain.vtu\"
export second to \"second.inp\"
";

/// All that a run says and writes, and how many results came from the cache.
struct Found {
    said: String,
    files: Vec<(String, Vec<u8>)>,
    from_cache: usize,
    meshes: usize,
}

/// One process: it knows nothing but what the folder holds.
fn process(script: &Path, text: &str, out: &Path, cache: Option<&Path>) -> Found {
    let disk = Disk::new(Some(script), Some(out), &[root().to_owned()], Outputs::Written).unwrap();
    let (job, clock) = (Job::default(), || 0.0);
    let task = Task {
        name: "model.loft",
        text: text.as_bytes(),
        shared: None,
        sets: &[],
        row: None,
        strict: false,
        keep_going: true,
        full: true,
        curves: true,
        picture: None,
        clock: &clock,
    };
    let outcome: Outcome = match cache {
        Some(cache) => {
            let mut kept = Kept::on(Some(Arc::new(Cache::new(cache))));
            guarded(|| run_again(&task, &disk, &job, Again { kept: &mut kept, light: false, look: &mut |_| {}, shaped: None })).unwrap()
        }
        None => guarded(|| run(&task, &disk, &job)).unwrap(),
    };
    let mut files: Vec<(String, Vec<u8>)> =
        outcome.report.outputs.iter().map(|o| (o.path.clone(), fs::read(out.join(&o.path)).unwrap())).collect();
    files.sort();
    let (report, drawn, notes) = (report_text(&outcome.report), outcome.drawn(false, true), outcome.notes.join("\n"));
    Found { said: format!("{report}\n{drawn}\n{notes}"), files, from_cache: outcome.from_cache, meshes: outcome.meshes.len() }
}

fn same(cold: &Found, warm: &Found, what: &str) {
    if let Some((a, b)) = cold.said.lines().zip(warm.said.lines()).find(|(a, b)| a != b) {
        panic!("{what}\nwithout: {a}\nwith:    {b}");
    }
    assert_eq!(cold.said.len(), warm.said.len(), "{what}");
    assert!(cold.files == warm.files, "{what}: files differ");
}

fn files_of(cache: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(cache).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    files
}

/// Numbers without a pattern, the same in every run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

/// Damages each file in one of the ways in which files break.
fn damage(cache: &Path, dice: &mut Dice) {
    for file in files_of(cache) {
        let whole = fs::read(&file).unwrap();
        // One that is empty since it was damaged before, and not read again.
        if whole.is_empty() {
            continue;
        }
        let mut bytes = whole.clone();
        let at = dice.below(bytes.len());
        match dice.below(5) {
            0 => bytes.truncate(at),
            1 => bytes[at] ^= 1 << dice.below(8),
            2 => bytes[at..].fill(0),
            3 => bytes.extend_from_within(at..),
            _ => bytes = b"something else altogether".to_vec(),
        }
        // What was zero before is not damaged by zeros.
        if bytes == whole {
            bytes.truncate(at);
        }
        fs::write(&file, bytes).unwrap();
    }
}

/// The script with its last number changed.
fn edited(text: &str) -> String {
    let mut text = text.to_owned();
    if let Some(at) = text.rfind(|c: char| c.is_ascii_digit()) {
        let next = if text[at..].starts_with('9') { "8" } else { "9" };
        text.replace_range(at..=at, next);
    }
    text
}

/// What a script goes through beside a cold and a warm run.
#[derive(Clone, Copy, PartialEq)]
enum Trial {
    Nothing,
    /// Lines moved, and a number changed.
    Edits,
    /// Damaged files.
    Damage,
    Both,
}

/// One script cold and warm, and what else is tried with it; how many meshes it has and how many results were found again.
fn one_script((script, text): &(PathBuf, String), trial: Trial, dice: &mut Dice) -> (usize, usize) {
    let part = |name: Option<&std::ffi::OsStr>| name.unwrap().to_string_lossy().into_owned();
    let name = format!("{}-{}", part(script.parent().and_then(Path::file_name)), part(script.file_stem()));
    let (out, cache) = (folder(&format!("out-{name}")), folder(&format!("kept-{name}")));
    let without = process(script, text, &out, None);
    let cold = process(script, text, &out, Some(&cache));
    same(&without, &cold, &format!("{name}, cold"));
    assert_eq!(cold.from_cache, 0, "{name}");
    let warm = process(script, text, &out, Some(&cache));
    same(&without, &warm, &format!("{name}, warm"));
    if matches!(trial, Trial::Edits | Trial::Both) {
        // Lines move, and with them every place that is told.
        let moved = format!("// A line above.\n{text}");
        same(&process(script, &moved, &out, None), &process(script, &moved, &out, Some(&cache)), &format!("{name}, moved"));
        let other = edited(text);
        same(&process(script, &other, &out, None), &process(script, &other, &out, Some(&cache)), &format!("{name}, edited"));
    }
    if matches!(trial, Trial::Damage | Trial::Both) {
        damage(&cache, dice);
        let damaged = process(script, text, &out, Some(&cache));
        same(&without, &damaged, &format!("{name}, damaged"));
        assert_eq!(damaged.from_cache, 0, "{name}: a damaged file was believed");
        let again = process(script, text, &out, Some(&cache));
        assert_eq!(again.from_cache, warm.from_cache, "{name}: what was damaged is written anew");
    }
    (without.meshes, warm.from_cache)
}

/// Scripts of the project (an eighth of them in a short run) and one with a mesh of every shape. A quarter of them is edited, and of
/// another quarter what is kept is damaged: an evaluation of all of them takes a minute.
#[test]
fn results_are_the_same_cold_warm_edited_and_damaged() {
    let chosen = sample(scripts(&["examples", "tests/golden"]), 3).into_iter().map(|path| root().join(path));
    let mut all: Vec<(PathBuf, String)> = chosen.map(|p| (p.clone(), fs::read_to_string(p).unwrap())).collect();
    all.push((root().join("tests/golden/shapes.loft"), SHAPES.to_owned()));
    let trial = |path: &Path| match path.strip_prefix(root()).map(|path| quarter(path, 1)) {
        _ if path.ends_with("shapes.loft") => Trial::Both,
        Ok(0) => Trial::Edits,
        Ok(1) => Trial::Damage,
        _ => Trial::Nothing,
    };
    let part = |parity: usize| {
        let mut dice = Dice(7 + parity as u64);
        let own = all.iter().skip(parity).step_by(2);
        own.map(|script| one_script(script, trial(&script.0), &mut dice)).fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1))
    };
    let (a, b) = std::thread::scope(|scope| {
        let other = scope.spawn(|| part(1));
        (part(0), other.join().unwrap())
    });
    let (meshes, found) = (a.0 + b.0, a.1 + b.1);
    // A mesh and its row in the report.
    assert!(meshes > 12 && found == 2 * meshes, "{found} results of {meshes} meshes were found");
}

fn loft(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_loft")).args(arguments).current_dir(root()).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn the_command_line_tells_what_was_found() {
    let folder = folder("cli");
    let cache = folder.join("made/here");
    let cache = cache.to_str().unwrap();
    let (status, cold, said) = loft(&["check", "examples/porch.loft", "--cache", cache, "--timings"]);
    assert!(status == 0 && said.contains("; 0 from the cache"), "{said}");
    let (status, warm, said) = loft(&["check", "examples/porch.loft", "--cache", cache, "--timings"]);
    assert!(status == 0 && said.contains("; 2 from the cache"), "{said}");
    assert_eq!(cold, warm);
    let (_, without, said) = loft(&["check", "examples/porch.loft", "--timings"]);
    assert!(!said.contains("cache"), "{said}");
    assert_eq!(cold, without);
}

#[test]
fn a_folder_that_cannot_be_used_is_told_once_and_costs_nothing() {
    let folder = folder("file");
    fs::write(folder.join("file"), "mine").unwrap();
    let place = folder.join("file/inside");
    let place = place.to_str().unwrap();
    let (status, with, said) = loft(&["check", "examples/porch.loft", "examples/canopy.loft", "--cache", place]);
    assert_eq!(said.matches("(--cache)").count(), 1, "{said}");
    let (expected, without, _) = loft(&["check", "examples/porch.loft", "examples/canopy.loft"]);
    assert_eq!((status, with), (expected, without));
    assert_eq!(fs::read(folder.join("file")).unwrap(), b"mine");
}

#[test]
fn two_processes_share_a_folder() {
    let folder = folder("two");
    let cache = folder.join("kept");
    let start = |n: usize| {
        let out = folder.join(n.to_string());
        Command::new(env!("CARGO_BIN_EXE_loft"))
            .args(["run", "examples/wing.loft", "-o", out.to_str().unwrap(), "--cache", cache.to_str().unwrap()])
            .current_dir(root())
            .output()
            .unwrap()
    };
    let outputs: Vec<_> = std::thread::scope(|scope| {
        let started: Vec<_> = (0..4).map(|n| scope.spawn(move || start(n))).collect();
        started.into_iter().map(|handle| handle.join().unwrap()).collect()
    });
    // What was written stands with its folder.
    let told = |n: usize| {
        let text = String::from_utf8_lossy(&outputs[n].stdout).into_owned();
        text.lines().map(|line| line.replace(&format!("/{n}/wing."), "/wing.").replace("  ", " ")).collect::<Vec<_>>()
    };
    assert!((1..outputs.len()).all(|n| told(n) == told(0) && outputs[n].status == outputs[0].status), "{:?}\n{:?}", told(0), told(1));
    assert!(files_of(&cache).iter().all(|file| file.extension().is_some_and(|e| e == "kept")), "temporary files stayed");
    for file in files_of(&folder.join("0")) {
        let name = file.file_name().unwrap();
        assert!((1..4).all(|n| fs::read(folder.join(n.to_string()).join(name)).unwrap() == fs::read(&file).unwrap()));
    }
}

/// A fine free face beside one that is edited.
const LOOSE: &str = "units m
curve rim = circle((0, 0, 0), 2, normal: (0, 0, 1))
surface lid = plane(rim)
surface wall = extrude(rim, (0, 0, 1.5))
mesh m of lid, wall { size: 60mm }
";

#[test]
fn free_faces_are_kept_on_disk_by_themselves() {
    let folder = folder("free");
    let (script, out, cache) = (folder.join("model.loft"), folder.join("out"), folder.join("kept"));
    let first = process(&script, LOOSE, &out, Some(&cache));
    assert_eq!(first.from_cache, 0);
    let faces = || files_of(&cache).iter().filter(|f| f.file_name().unwrap().to_string_lossy().starts_with("face-")).count();
    assert_eq!(faces(), 1, "{:?}", files_of(&cache));
    // Another process, another wall: the lid comes from the folder.
    let taller = LOOSE.replace("1.5", "1.7");
    let warm = process(&script, &taller, &out, Some(&cache));
    same(&process(&script, &taller, &out, None), &warm, "a taller wall");
    assert_eq!((warm.from_cache, faces()), (1, 1));
    let mut dice = Dice(5);
    for _ in 0..10 {
        damage(&cache, &mut dice);
        same(&process(&script, &taller, &out, None), &process(&script, &taller, &out, Some(&cache)), "damaged");
    }
}
