//! Scripts with a few numbers or tokens changed at random: whatever they then ask for, `loft check` ends in time and memory with an
//! answer of its own, status 0, 1 or 2. `loft` runs as a child, so that a hang, an abort or a swollen heap is seen from outside;
//! meshes are limited to few elements and runs to some work, so that what is large and sound does not take the time.
//!
//! `LOFT_EDITS` says how many edits (a few dozen without it), `LOFT_EDITS_FROM` the number of the first, `LOFT_EDITS_SECONDS` the
//! processor time of each, `LOFT_EDITS_LOFT` which program is run (a release build in `.ci/run`).
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Edits without a word from outside.
const FEW: usize = 24;
/// Processor seconds of one run: of a release build, and of one without optimisation.
const SECONDS: u64 = if cfg!(debug_assertions) { 60 } else { 5 };
/// Memory of one run, kB.
const MEMORY_KB: u64 = 2 << 20;
/// Elements that a mesh may have.
const ELEMENTS: &str = "20000";
/// Evaluations that a run may take.
const WORK: &str = "10000000";
/// Edits that run at a time.
const AT_A_TIME: usize = 2;
/// Numbers that are put in place of others, and what is done to those that are there.
const VALUES: [&str; 6] = ["0", "1e-308", "1e9", "-1", "1e-6", "100000"];

/// Random numbers from a seed [Steele, Lea & Flood 2014].
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ x >> 31
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// Where tokens begin and end in a text.
type Places = Vec<(usize, usize)>;

/// Places of numbers (first) and of words, brackets and operators in a script, without comments and strings.
fn tokens(text: &str) -> (Places, Places) {
    let bytes = text.as_bytes();
    let (mut numbers, mut others, mut at) = (Vec::new(), Vec::new(), 0);
    let run = |from: usize, of: &dyn Fn(u8) -> bool| from + bytes[from..].iter().take_while(|b| of(**b)).count();
    while at < bytes.len() {
        let b = bytes[at];
        let end = match b {
            b'/' if bytes.get(at + 1) == Some(&b'/') => run(at, &|b| b != b'\n'),
            b'"' => (run(at + 1, &|b| b != b'"') + 1).min(bytes.len()),
            b'0'..=b'9' => run(at, &|b| b.is_ascii_digit() || b == b'.' || b == b'_'),
            _ if b.is_ascii_alphabetic() || b == b'_' => run(at, &|b| b.is_ascii_alphanumeric() || b == b'_'),
            _ => at + 1,
        };
        match b {
            b'0'..=b'9' => {
                let range = text[at..end].find("..").map_or(end, |k| at + k);
                numbers.push((at, range));
                at = range.max(at + 1);
                continue;
            }
            b'"' | b'/' => {}
            _ if !b.is_ascii_whitespace() && b.is_ascii() => others.push((at, end)),
            _ => {}
        }
        at = end;
    }
    (numbers, others)
}

/// One edit of a number: scaled, negated, zeroed, beyond sense, by a tolerance, or another number's value.
fn changed(draw: &mut Draw, number: &str, others: &[&str]) -> String {
    let value: f64 = number.replace('_', "").parse().unwrap_or(1.0);
    match draw.below(12) {
        0 => format!("{}", value * 10.0),
        1 => format!("{}", value * 0.1),
        2 => format!("(-{number})"),
        3 => format!("{}", value + 1e-5),
        4 => format!("{}", value - 1e-5),
        5 => format!("{}", value * (0.5 + draw.below(1000) as f64 / 1000.0)),
        6 | 7 => others[draw.below(others.len())].to_owned(),
        _ => VALUES[draw.below(VALUES.len())].to_owned(),
    }
}

/// A script with one to three edits: of numbers most often, whole points moved onto others, two tokens swapped or one left out.
fn edited(draw: &mut Draw, text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..=draw.below(3) {
        let (numbers, others) = tokens(&text);
        let part = |(a, b): (usize, usize)| &text[a..b];
        let kind = draw.below(20);
        if kind == 0 && others.len() > 1 {
            let (one, other) = (draw.below(others.len()), draw.below(others.len()));
            let (first, last) = (others[one.min(other)], others[one.max(other)]);
            let between = if first == last { String::new() } else { format!("{}{}", &text[first.1..last.0], part(first)) };
            text = format!("{}{}{between}{}", &text[..first.0], part(last), &text[last.1..]);
        } else if kind == 1 && !others.is_empty() {
            let (from, to) = others[draw.below(others.len())];
            text = format!("{}{}", &text[..from], &text[to..]);
        } else if kind < 6 && numbers.len() >= 6 {
            // Three numbers in a row over three others: a point on another.
            let (from, to) = (draw.below(numbers.len() - 2), draw.below(numbers.len() - 2));
            let values: Vec<String> = (0..3).map(|k| part(numbers[from + k]).to_owned()).collect();
            for k in (0..3).rev() {
                let (a, b) = numbers[to + k];
                text.replace_range(a..b, &values[k]);
            }
        } else if !numbers.is_empty() {
            let all: Vec<&str> = numbers.iter().map(|n| part(*n)).collect();
            let (a, b) = numbers[draw.below(numbers.len())];
            let new = changed(draw, &text[a..b], &all);
            text = format!("{}{new}{}", &text[..a], &text[b..]);
        }
    }
    text
}

/// All scripts of a folder and those below it, in order.
fn scripts(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            scripts(&path, found);
        } else if path.extension().is_some_and(|e| e == "loft") {
            found.push(path);
        }
    }
}

/// Scripts with the seed of their edits, which is that of their name: the edits of one do not change when another one comes.
/// They come in order of their seeds, so that few edits are of scripts of all folders.
fn seeded(root: &Path, paths: Vec<PathBuf>) -> Vec<(PathBuf, u64)> {
    let seed = |path: &Path| {
        let name = path.strip_prefix(root).unwrap().to_string_lossy().into_owned();
        name.bytes().fold(0x10f7_u64, |seed, byte| Draw(seed ^ u64::from(byte)).next())
    };
    let mut seeds: Vec<(PathBuf, u64)> = paths.into_iter().map(|path| (path.clone(), seed(&path))).collect();
    seeds.sort_by_key(|(_, seed)| *seed);
    seeds
}

fn number_of(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(otherwise)
}

/// Runs a script from its own folder, so that what it imports is there; what is wrong with how that ended.
fn wrong(loft: &str, at: &Path, text: &str, seconds: u64) -> Option<String> {
    let limits =
        format!("ulimit -t {seconds}; ulimit -v {MEMORY_KB}; exec \"$0\" check --threads 1 --max-elements {ELEMENTS} --max-work {WORK} -");
    let mut command = Command::new("sh");
    command.args(["-c", &limits, loft]).current_dir(at).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut to = child.stdin.take().unwrap();
    let _ = std::io::Write::write_all(&mut to, text.as_bytes());
    drop(to);
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let fine = matches!(output.status.code(), Some(0..=2)) && !said.contains("E999");
    (!fine).then(|| format!("{}: {}", output.status, said.chars().take(600).collect::<String>()))
}

#[test]
fn random_edits_of_scripts_end() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    ["examples", "tests/acceptance", "tests/golden"].iter().for_each(|folder| scripts(&root.join(folder), &mut paths));
    let seeds = seeded(root, paths);
    let (edits, seconds) = (number_of("LOFT_EDITS", FEW as u64) as usize, number_of("LOFT_EDITS_SECONDS", SECONDS));
    let loft = std::env::var("LOFT_EDITS_LOFT").map_or(env!("CARGO_BIN_EXE_loft").to_owned(), |own| root.join(own).display().to_string());
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("edits");
    fs::create_dir_all(&kept).unwrap();
    let from = number_of("LOFT_EDITS_FROM", 0) as usize;
    let (next, found) = (AtomicUsize::new(from), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= from + edits {
                return;
            }
            let (path, seed) = &seeds[k % seeds.len()];
            let round = k / seeds.len();
            let text = edited(&mut Draw(seed.wrapping_add(round as u64)), &fs::read_to_string(path).unwrap());
            if let Some(wrong) = wrong(&loft, path.parent().unwrap(), &text, seconds) {
                let name = format!("{k}-{round}-{}", path.file_name().unwrap().to_string_lossy());
                fs::write(kept.join(&name), &text).unwrap();
                found.lock().unwrap().push(format!("edit {name}: {wrong}"));
            }
        }
    };
    std::thread::scope(|scope| (0..AT_A_TIME).for_each(|_| drop(scope.spawn(work))));
    let mut found = found.into_inner().unwrap();
    found.sort();
    assert!(found.is_empty(), "{} of {edits} edits, kept in {}:\n{}", found.len(), kept.display(), found.join("\n"));
}
