//! A run that is stopped leaves the old outputs or the new ones, never half of one.

#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::support::long::count;

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
        .filter(|p| p.is_file())
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
    leaves_nothing_half("int", "-INT", 130);
}

/// The signal of batch queues, of `timeout` and of service managers.
#[test]
fn a_run_that_is_told_to_end_leaves_nothing_half() {
    leaves_nothing_half("term", "-TERM", 143);
}

fn leaves_nothing_half(name: &str, signal: &str, stopped_with: i32) {
    let folder = folder(name);
    assert!(loft(&folder).status().unwrap().success());
    let whole = outputs(&folder);
    assert_eq!(whole.len(), 4);
    for name in ["a.stl", "b.inp", "c.obj", "d.vtu"] {
        fs::write(folder.join(name), "old").unwrap();
    }
    let mut stopped = 0;
    for millis in [5, 15, 30, 60, 90, 140, 200, 300, 450] {
        let status = stop_after(&folder, millis, signal);
        let found = outputs(&folder);
        assert_eq!(found.len(), 4, "temporary files stayed after {millis} ms: {:?}", found.iter().map(|f| &f.0).collect::<Vec<_>>());
        let old = found.iter().all(|f| f.1 == b"old");
        match status {
            Some(0) => assert!(found == whole, "a finished run left something else"),
            // The signal may come before the program has its handler; work that ends in time ends as interrupted.
            status if [None, Some(130), Some(stopped_with)].contains(&status) => {
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

/// How often each kind of run is killed.
fn kills() -> usize {
    count("LOFT_KILLS", 5, 100)
}

/// Starts a command and kills it at a moment chosen by `dice` within 1.2 times what a whole run takes.
fn kill(mut command: Command, whole: Duration, dice: &mut u64) {
    *dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    let mut child = command.spawn().unwrap();
    sleep(whole.mul_f64(1.2 * (*dice >> 33) as f64 / (1u64 << 31) as f64));
    child.kill().unwrap();
    child.wait().unwrap();
}

fn temporary(files: &[(String, Vec<u8>)]) -> Vec<&str> {
    files.iter().map(|f| f.0.as_str()).filter(|name| name.ends_with(".tmp")).collect()
}

#[test]
fn a_killed_run_leaves_whole_files_and_the_next_one_cleans_up() {
    let folder = folder("kill");
    let cached = || {
        let mut command = loft(&folder);
        command.args(["--cache", "kept"]);
        command
    };
    let begun = Instant::now();
    assert!(cached().status().unwrap().success());
    let took = begun.elapsed();
    let whole = outputs(&folder);
    let kept = outputs(&folder.join("kept"));
    assert_eq!((whole.len(), kept.len()), (4, 2));
    let (mut dice, mut left, mut torn) = (3, 0, 0);
    for round in 0..kills() {
        for (name, _) in &whole {
            fs::write(folder.join(name), "old").unwrap();
        }
        if round % 2 == 0 {
            fs::remove_dir_all(folder.join("kept")).unwrap();
        }
        kill(cached(), took, &mut dice);
        let found = outputs(&folder);
        for (name, bytes) in found.iter().filter(|f| !f.0.ends_with(".tmp")) {
            let new = &whole.iter().find(|w| w.0 == *name).unwrap().1;
            assert!(bytes == b"old" || bytes == new, "{name} is neither old nor new");
        }
        let found_kept = if folder.join("kept").exists() { outputs(&folder.join("kept")) } else { Vec::new() };
        for (name, bytes) in found_kept.iter().filter(|f| !f.0.ends_with(".tmp")) {
            let new = &kept.iter().find(|w| w.0 == *name).unwrap().1;
            assert!(bytes == new, "{name} is not whole");
        }
        left += temporary(&found).len() + temporary(&found_kept).len();
        torn += usize::from(found.iter().any(|f| f.1 == b"old"));
        assert!(cached().status().unwrap().success());
        assert!(outputs(&folder) == whole, "the next run leaves what a run leaves");
        // One that had nothing to write there leaves the folder of results as it is.
        let again = outputs(&folder.join("kept"));
        assert!(again.iter().filter(|f| !f.0.ends_with(".tmp")).eq(&kept), "the next run keeps what a run keeps");
    }
    assert!(torn > 0, "no run was caught");
    assert!(kills() < 50 || left > 0, "no run was caught while it wrote");
}

#[test]
fn a_killed_accept_leaves_whole_goldens() {
    let folder = folder("accept");
    let accept = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
        command.args(["test", "--accept", "model.loft"]).current_dir(&folder).stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    fs::write(folder.join("model.loft"), SCRIPT.replace("20mm", "60mm")).unwrap();
    let begun = Instant::now();
    assert!(accept().status().unwrap().success());
    let took = begun.elapsed();
    let new = fs::read(folder.join("model.golden")).unwrap();
    // A golden of the same model before somebody changed it.
    fs::write(folder.join("model.loft"), SCRIPT.replace("20mm", "70mm")).unwrap();
    assert!(accept().status().unwrap().success());
    let old = fs::read(folder.join("model.golden")).unwrap();
    assert!(old != new);
    fs::write(folder.join("model.loft"), SCRIPT.replace("20mm", "60mm")).unwrap();
    // What a killed run leaves, whether or not a kill below comes at the right moment; no process has this number.
    fs::write(folder.join(".model.golden.999999999-0.tmp"), "half").unwrap();
    let (mut dice, mut caught) = (5, 0);
    for _ in 0..kills() {
        fs::write(folder.join("model.golden"), &old).unwrap();
        kill(accept(), took, &mut dice);
        let found = fs::read(folder.join("model.golden")).unwrap();
        assert!(found == old || found == new, "the golden is neither old nor new");
        caught += usize::from(found == old);
    }
    assert!(caught > 0, "no run was caught");
    fs::write(folder.join("model.golden"), &old).unwrap();
    assert!(accept().status().unwrap().success());
    let names: Vec<String> = outputs(&folder).into_iter().map(|f| f.0).collect();
    assert_eq!(names, ["model.golden"], "the next run removes what a killed one left");
    assert!(fs::read(folder.join("model.golden")).unwrap() == new);
}

/// The script of a session that works for long, and the entry that does.
const LONG: &[(&str, &str)] = &[
    ("mesh m of roof { size: 8mm  method: delaunay }\nexport m to \"m.msh\"\npicture m to \"m.png\"\n", ":run"),
    ("mesh m of roof { size: 3mm  elements: quads  order: 2 }\nexport m to \"m.vtu\" { encoding: text }\npicture m to \"m.svg\"\n", ":run"),
    ("mesh m of roof { size: 16mm  elements: quads  method: delaunay }\n", ":mesh m"),
    ("", "sum([for i in 0..400000: distance(roof, (i * 0.1mm, 1, 1))])"),
    ("", "sum([for i in 0..1000: sum([for c in meet(roof, move(roof, by: (i * 0.1mm, 0.1, 0.02))): c.length])])"),
];

/// Starts a session, interrupts the entry after `wait` and waits for the answer to the next one; how long that took.
fn interrupted(folder: &Path, (script, entry): (&str, &str), wait: Duration) -> Option<Duration> {
    let model: String = SCRIPT.lines().take_while(|line| !line.starts_with("mesh")).map(|line| format!("{line}\n")).collect();
    fs::write(folder.join("long.loft"), format!("{model}{script}")).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_loft"));
    let mut child = child.arg("repl").current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    // Read as a whole before it is begun.
    child.stdin.take().unwrap().write_all(format!(":load long.loft\n{entry}\n20 + 22\n").as_bytes()).unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.next().is_some_and(|line| line.starts_with("long.loft: ")));
    sleep(wait);
    let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    let begun = Instant::now();
    let rest: Vec<String> = lines.collect();
    let took = begun.elapsed();
    child.wait().unwrap();
    assert_eq!(rest.last().map(String::as_str), Some("42"), "{entry} after {wait:?}: {rest:?}");
    rest.iter().any(|line| line.starts_with("interrupted; ")).then_some(took)
}

#[test]
fn a_session_comes_back_soon_whatever_it_does() {
    let folder = folder("session");
    let (mut dice, mut caught, mut worst) = (11_u64, vec![0; LONG.len()], (Duration::ZERO, String::new()));
    for round in 0..2 * LONG.len() {
        dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let (k, wait) = (round % LONG.len(), Duration::from_millis(100 + (dice >> 33) % 2_000));
        if let Some(took) = interrupted(&folder, LONG[k], wait) {
            caught[k] += 1;
            worst = worst.max((took, format!("{} after {wait:?}", LONG[k].1)));
        }
    }
    assert!(caught.iter().all(|n| *n > 0), "not every entry was caught: {caught:?}");
    // A second is wanted; other tests run beside this one.
    assert!(worst.0 < Duration::from_secs(8), "{worst:?}");
}

/// What a run on a terminal leaves on the screen, by the program that gives it one.
fn on_terminal(folder: &Path, interrupt: bool) -> String {
    let typed = folder.join("typed");
    let stop = if interrupt { "timeout -s INT 1 " } else { "" };
    let run = format!("stty cols 80; {stop}{} run model.loft", env!("CARGO_BIN_EXE_loft"));
    let mut command = Command::new("script");
    command.args(["-qec", &run, typed.to_str().unwrap()]).current_dir(folder).env_remove("CI").env("TERM", "xterm");
    command.stdin(Stdio::null()).stdout(Stdio::null()).status().unwrap();
    fs::read_to_string(typed).unwrap()
}

#[test]
fn progress_names_its_phase_and_leaves_nothing_behind() {
    if Command::new("script").arg("--version").stdout(Stdio::null()).status().is_err() {
        eprintln!("skipped: there is no `script` here to give a terminal");
        return;
    }
    let folder = folder("progress");
    fs::write(folder.join("model.loft"), SCRIPT.replace("20mm", "6mm")).unwrap();
    for interrupt in [false, true] {
        let screen = on_terminal(&folder, interrupt);
        // Which phases last long enough to be seen depends on the machine.
        let last = ["meshing fine (1 of 1)", "measuring", "writing "].iter().filter_map(|phase| screen.rfind(phase)).max();
        let last = last.unwrap_or_else(|| panic!("no phase: {screen:?}"));
        assert!(screen[last..].contains("\u{1b}[2K"), "the line is not erased: {screen:?}");
        assert!(screen.rfind("\u{1b}[?25h") >= screen.rfind("\u{1b}[?25l"), "no cursor: {screen:?}");
    }
}
