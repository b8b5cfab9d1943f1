//! Input that is meant to eat the machine: each is refused by a clear error, at once and in little memory. `loft` runs as a
//! child here, so that a hang, an abort or a swollen heap is seen from outside.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// What any of these may hold at its peak.
const MEMORY_KB: u64 = 1 << 20;
/// Seconds that a refusal may take, here without optimisation beside other tests; a release build answers in one.
const SECONDS: u64 = if cfg!(debug_assertions) { 60 } else { 1 };

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile").join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The largest memory that a running process has held, kB; `None` where the system does not tell.
fn peak_kb(pid: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().trim_end_matches("kB").trim().parse().ok()
}

struct Ended {
    status: Option<i32>,
    err: String,
    seconds: f64,
    peak_kb: u64,
}

fn check(folder: &Path, script: &str) -> Ended {
    let err = folder.join(format!("{script}.err"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
    command.args(["check", script]).current_dir(folder).stdin(Stdio::null()).stdout(Stdio::null());
    let start = Instant::now();
    let mut child = command.stderr(fs::File::create(&err).unwrap()).spawn().unwrap();
    let mut peak = 0;
    let status = loop {
        peak = peak.max(peak_kb(child.id()).unwrap_or(0));
        if let Some(status) = child.try_wait().unwrap() {
            break status.code();
        }
        if start.elapsed().as_secs() > SECONDS || peak > MEMORY_KB {
            child.kill().unwrap();
            child.wait().unwrap();
            break None;
        }
        sleep(Duration::from_millis(2));
    };
    Ended { status, err: fs::read_to_string(err).unwrap(), seconds: start.elapsed().as_secs_f64(), peak_kb: peak }
}

/// What is wrong with the answer to a script: it must end with status 1 and this code, in few words, time and memory.
fn answer(folder: &Path, name: &str, text: &str, code: &str) -> Option<String> {
    let script = format!("{name}.loft");
    fs::write(folder.join(&script), text).unwrap();
    let ended = check(folder, &script);
    let said = ended.err.contains(&format!("{code} ×")) && !ended.err.contains("E999") && ended.err.len() < 100_000;
    let fine = ended.status == Some(1) && said && ended.peak_kb < MEMORY_KB && ended.seconds < SECONDS as f64;
    let shown: String = ended.err.chars().take(1000).collect();
    let measured = format!("status {:?}, {:.2} s, {} MB", ended.status, ended.seconds, ended.peak_kb >> 10);
    (!fine).then(|| format!("{name}: {code} wanted, {measured}\n{shown}"))
}

fn all(name: &str, cases: &[(&str, String, &str)]) {
    let folder = folder(name);
    let wrong: Vec<String> = cases.iter().filter_map(|(name, text, code)| answer(&folder, name, text, code)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn texts_without_end() {
    let of = |part: &str, n: usize| part.repeat(n);
    let cases = [
        ("brackets", format!("let a = {}", of("(", 100_000)), "E109"),
        ("lists", format!("let a = {}{}", of("[", 100_000), of("]", 100_000)), "E109"),
        ("blocks", format!("mesh m of {}", of("{", 100_000)), "E109"),
        ("large", of("let a = 1\n", 5_000_000), "E110"),
        ("comments", of("/*", 100_000), "E104"),
        ("strings", format!("let a = {}", of("\"{", 100_000)), "E103"),
        ("minus", format!("let a = {}1", of("-", 100_000)), "E109"),
        ("power", format!("let a = 2{}", of("^2", 100_000)), "E109"),
        ("chain", format!("let a = 1{}\n", of("+1", 1_000_000)), "E109"),
        ("fields", format!("let a = 1{}\n", of(".abs", 100_000)), "E109"),
        ("indices", format!("let a = b{}\n", of("[0]", 100_000)), "E109"),
    ];
    all("texts", &cases);
}

#[test]
fn numbers_beyond_sense() {
    let cases = [
        ("nan", "let a = nan\n".to_owned(), "E201"),
        ("infinite", "let a = 1e999\n".to_owned(), "E107"),
        ("digits", format!("let a = {}\n", "9".repeat(1_000_000)), "E107"),
        ("overflow", "let a = 1e308 * 10\n".to_owned(), "E408"),
        ("root", "let a = sqrt(-1)\n".to_owned(), "E306"),
        ("far", "curve c = line((0, 0, 0), (1e308m, 1e308m, 0))\n".to_owned(), "E408"),
        ("set", "units m\ncurve c = arc((0, 0), (1e40, 0), through: (1e-300, 1e40))\ncheck c.length < 0m\n".to_owned(), "E901"),
    ];
    all("numbers", &cases);
}

/// Forty lists, each holding the one before twice: small in memory, without end when walked.
fn doubled(last: &str) -> String {
    let rows: String = (0..40).map(|i| format!("let a{} = [a{i}, a{i}]\n", i + 1)).collect();
    format!("let a0 = [1]\n{rows}{last}\n")
}

#[test]
fn lists_without_end() {
    let many = ["a"; 100].join(", ");
    let cases = [
        ("family", "curve c for i in 0..1_000_000_000 = line((0, 0, 0), (1, i, 0))\n".to_owned(), "E217"),
        ("list", "let a = [for i in 0..100_000 for j in 0..100_000: i * j]\n".to_owned(), "E217"),
        ("range", "let a = sort(0..1_000_000_000_000)\n".to_owned(), "E217"),
        ("linspace", "let a = linspace(0, 1, 1_000_000_000)\n".to_owned(), "E217"),
        ("zip", "let a = zip(0..10_000_000, 0..10_000_000)\n".to_owned(), "E217"),
        ("points", "curve c = line((0, 0), (1, 0))\nlet p = c.points(1_000_000_000)\n".to_owned(), "E217"),
        ("flatten", format!("let a = linspace(0, 1, 1_000_000)\nlet b = flatten({many})\n"), "E217"),
        ("doubled", doubled("let b = flatten(a40)"), "E217"),
        ("group", doubled("group g of a40"), "E217"),
        ("equal", doubled("check a40 == a40"), "E217"),
        ("sorted", doubled("let b = sort([a40, a40])"), "E217"),
        ("shown", doubled("let b = \"{a40}\"\ncheck b == \"\""), "E901"),
        ("reported", doubled("report a40\ncheck 1 == 2"), "E901"),
        ("recursion", "fn f(n) = f(n + 1) + 1\nlet a = f(0)\n".to_owned(), "E216"),
    ];
    all("lists", &cases);
}

/// A bound that no text tells: refused when the lists held together are too many, not when memory is gone.
#[test]
fn lists_of_lists_fill_no_memory() {
    let cases = [
        ("nested", "let n = 100_000\nlet a = [for i in 0..n: [for j in 0..i: j]]\n".to_owned(), "E217"),
        ("linspaces", "let a = [for i in 0..1000: linspace(0, 1, 1_000_000)]\n".to_owned(), "E217"),
    ];
    all("held", &cases);
}

/// Meshes of more elements than one may have are refused before their borders are divided, at the setting that asks.
#[test]
fn meshes_without_end() {
    let disc = "curve c = circle(center: (0, 0, 0), radius: 1m)\nsurface s = plane([c])\npoint p = (100mm, 0, 0)\n";
    let strip = "curve c = polyline([(0, 0), (1m, 0), (1m, 10um), (0, 10um)], closed: true)\nsurface s = trim(plane(c), holes: [])\n";
    let tube = "curve c = circle(center: (0, 0, 0), radius: 1m)\nsurface s = extrude(c, by: (0, 0, 1m))\n";
    let square = "point p = (100mm, 0, 0)\nlet at = [(0, 0, 0), (1m, 0, 0), (1m, 1m, 0), (0, 1m, 0)]\n\
                  surface s = plane(line(at[0], at[1]), line(at[1], at[2]), line(at[2], at[3]), line(at[3], at[0]))\n";
    let cases = [
        (disc, "of s", "size: ", "1um", ""),
        (disc, "of s", "size: ", "10um", ""),
        (disc, "of s", "size: ", "1um", "  elements: quads"),
        (disc, "of s", "size: ", "10um", "  elements: quads"),
        (disc, "of s", "size: ", "10um", "  order: 2"),
        (disc, "of s", "size: ", "10um", "  method: isoline"),
        (disc, "of s", "size: ", "10um", "  method: display"),
        (disc, "of s", "size: ", "10um", "  method: quadtree"),
        (disc, "of s", "size: 100mm  chord_error: ", "1e-9mm", ""),
        (disc, "of s", "size: 100mm  chord_error: ", "1e-9mm", "  elements: quads"),
        (disc, "of s", "method: display  chord_error: ", "1e-9mm", ""),
        (disc, "of s", "size: 100mm  near p { size: ", "1um", "  radius: 1m }"),
        (disc, "of s", "size: 100mm  near p { size: ", "0.1mm", "  radius: 900mm }"),
        (disc, "of s", "size: 100mm  on c { size: ", "1e-9mm", " }"),
        (disc, "of s", "size: 100mm  on s { size: ", "10um", " }"),
        (disc, "of s", "size: 100mm  on c { count: ", "50_000_000", " }"),
        (disc, "of c", "size: ", "1e-9mm", ""),
        (disc, "of c", "size: 1m  chord_error: ", "1e-9mm", ""),
        (disc, "of c", "size: 1m  angle_error: ", "1e-6deg", ""),
        (disc, "of s", "size: 1m  angle_error: ", "1e-6deg", ""),
        (tube, "of s", "size: 1m  angle_error: ", "1e-6deg", ""),
        (strip, "of s", "size: ", "1e-6mm", ""),
        (strip, "of s", "size: ", "0.1um", ""),
        (tube, "of s", "size: ", "1um", ""),
        (tube, "of s", "size: ", "10um", "  method: delaunay"),
        (tube, "of s", "size: 100mm  chord_error: ", "1e-9mm", ""),
        (tube, "of s", "size: 100mm  method: isoline  chord_error: ", "1e-9mm", ""),
        (square, "of s", "size: ", "1um", ""),
        (square, "of s", "size: ", "10um", "  elements: quads"),
        (square, "of s", "size: 100mm  near p { size: ", "1e-9mm", " }"),
    ];
    let folder = folder("meshes");
    let mut wrong = Vec::new();
    for (k, (model, of, before, asks, after)) in cases.into_iter().enumerate() {
        let (name, start) = (format!("mesh{k}"), format!("mesh m {of} {{ {before}"));
        wrong.extend(answer(&folder, &name, &format!("{model}{start}{asks}{after} }}\n"), "E217"));
        let said = fs::read_to_string(folder.join(format!("{name}.loft.err"))).unwrap();
        let place = format!("[{name}.loft:{}:{}]", model.lines().count() + 1, start.len() + 1);
        if !said.contains(&place) {
            wrong.push(format!("{place} wanted\n{said}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_that_are_none() {
    let folder = folder("files");
    let junk: Vec<u8> = (0..4096u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    fs::write(folder.join("junk.csv"), junk).unwrap();
    fs::write(folder.join("b.loft"), "use \"a.loft\" as a\nlet x = 1\n").unwrap();
    #[cfg(unix)]
    for (name, to) in [("link.csv", "/etc/hostname"), ("zero.csv", "/dev/zero")] {
        let _ = fs::remove_file(folder.join(name));
        std::os::unix::fs::symlink(to, folder.join(name)).unwrap();
    }
    let cases = [
        ("a", "use \"b.loft\" as b\nlet y = 2\n".to_owned(), "E809"),
        ("self", "use \"self.loft\" as me\nlet y = 2\n".to_owned(), "E809"),
        ("binary", "import \"junk.csv\" as junk\n".to_owned(), "E803"),
        ("outside", "import \"../up.csv\" as up\n".to_owned(), "E802"),
        #[cfg(unix)]
        ("link", "import \"link.csv\" as out\n".to_owned(), "E802"),
        #[cfg(unix)]
        ("device", "import \"zero.csv\" as zero\n".to_owned(), "E802"),
    ];
    all("files", &cases);
}
