//! The order of declarations decides nothing: the examples, shuffled, write the same files and report the same.
//!
//! One shuffle of each example, four in a long run; `LOFT_SHUFFLES` says how many.

use std::fs;
use std::path::{Path, PathBuf};

use lofting::base::job::Job;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;
use lofting::session::json::report_text;
use lofting::session::run::{Task, run};

use crate::support::long::count;

/// Pseudo-random numbers (SplitMix64 [Steele, Lea & Flood 2014]), the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) % n.max(1) as u64) as usize
    }
}

/// Words that begin a declaration which may stand anywhere.
const FREE: &[&str] = &["import", "param", "let", "fn", "point", "curve", "modeling", "surface", "shell", "mesh"];
/// Words of declarations that are listed in order of declaration, in reports and in files.
const LISTED: &[&str] = &["group", "check", "report", "export", "picture"];
/// Heads of a script.
const HEADS: &[&str] = &["units", "tolerance", "snap", "use"];

/// The declarations of a script with their words; comments go with what follows them.
fn declarations(text: &str) -> Vec<(String, String)> {
    let mut all: Vec<(String, String)> = Vec::new();
    let mut above = String::new();
    for line in text.lines() {
        let word = line.split(|c: char| !c.is_alphanumeric()).next().unwrap_or("");
        let begins = [FREE, LISTED, HEADS].iter().any(|words| words.contains(&word));
        above.push_str(line);
        above.push('\n');
        if begins {
            all.push((word.to_owned(), std::mem::take(&mut above)));
        } else if !line.starts_with("//")
            && !line.trim().is_empty()
            && let Some(last) = all.last_mut()
        {
            last.1.push_str(&std::mem::take(&mut above));
        }
    }
    all
}

/// The declarations in another order; those that are listed in order keep theirs among themselves.
fn shuffled(text: &str, random: &mut Random) -> String {
    let mut all = declarations(text);
    for k in (1..all.len()).rev() {
        all.swap(k, random.below(k + 1));
    }
    let is_listed = |word: &str| LISTED.contains(&word);
    let mut listed = declarations(text).into_iter().filter(|d| is_listed(&d.0));
    all.iter_mut().filter(|d| is_listed(&d.0)).zip(listed.by_ref()).for_each(|(place, next)| *place = next);
    all.into_iter().map(|d| d.1).collect()
}

/// A row of a report without the line that it speaks of.
fn without_line(row: &str) -> String {
    let row = row.trim().trim_end_matches(',');
    let mut out = String::new();
    let mut rest = row;
    while let Some(at) = rest.find("\"line\": ") {
        let after = at + "\"line\": ".len();
        out.push_str(&rest[..after]);
        rest = rest[after..].trim_start_matches(|c: char| c.is_ascii_digit());
    }
    out + rest
}

/// The files that a script writes, and the rows of its report in no order.
fn written(folder: &Path, text: &str) -> (Vec<(String, Vec<u8>)>, Vec<String>) {
    let out = folder.join("out");
    let disk = Disk::new(Some(&folder.join("model.loft")), Some(&out), &[], Outputs::Written).unwrap();
    let clock = || 0.0;
    let task = Task {
        name: "model.loft",
        text: text.as_bytes(),
        shared: None,
        sets: &[],
        strict: false,
        keep_going: false,
        full: true,
        curves: true,
        picture: None,
        row: None,
        clock: &clock,
    };
    let job = Job::new();
    let outcome = guarded(|| run(&task, &disk, &job)).unwrap();
    let mut files: Vec<(String, Vec<u8>)> =
        outcome.report.outputs.iter().map(|o| (o.path.clone(), fs::read(out.join(&o.path)).unwrap())).collect();
    files.sort();
    let mut rows: Vec<String> = report_text(&outcome.report).lines().map(without_line).collect();
    rows.sort();
    (files, rows)
}

fn examples() -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir("examples").unwrap().flatten().map(|e| e.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "loft"));
    // Surfaces and others ask for the same `let`.
    paths.push(PathBuf::from("tests/golden/surfaces/rims_of_others.loft"));
    paths.sort();
    paths
}

#[test]
fn shuffled_examples_write_and_report_the_same() {
    let shuffles = count("LOFT_SHUFFLES", 1, 4);
    let mut wrong = Vec::new();
    for path in examples() {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("order-{name}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("data")).unwrap();
        for entry in fs::read_dir("examples/data").unwrap().flatten() {
            fs::copy(entry.path(), folder.join("data").join(entry.file_name())).unwrap();
        }
        let base = fs::read_to_string(&path).unwrap();
        let (files, rows) = written(&folder, &base);
        assert!(rows.iter().any(|row| row.contains("\"ok\": true")), "{name}: {rows:?}");
        let mut random = Random(7);
        for k in 0..shuffles {
            let text = shuffled(&base, &mut random);
            assert_ne!(text, base);
            let (other_files, other_rows) = written(&folder, &text);
            for (file, other) in files.iter().zip(&other_files).filter(|(a, b)| a != b) {
                wrong.push(format!("{name}, shuffle {k}: {} is not {}", file.0, other.0));
            }
            if let Some((row, other)) = rows.iter().zip(&other_rows).find(|(a, b)| a != b) {
                wrong.push(format!("{name}, shuffle {k}:\n  {row}\n  {other}"));
            }
            assert_eq!((files.len(), rows.len()), (other_files.len(), other_rows.len()), "{name}, shuffle {k}");
        }
        let _ = fs::remove_dir_all(&folder);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
