//! Sessions as users have them: transcripts in `tests/repl/*.txt`, whose answers must be the same again.
//!
//! Lines that start with `> ` are entries, `. ` continues one, `//` is a comment; the rest is what was answered.
//! `LOFT_ACCEPT=1` writes the answers of now.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use lofting::cli::repl::transcript;

fn transcripts() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/repl");
    let mut found: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "txt")).collect();
    found.sort();
    assert!(!found.is_empty());
    found
}

#[test]
fn transcripts_are_answered_as_before() {
    let mut wrong = Vec::new();
    for path in transcripts() {
        let text = fs::read_to_string(&path).unwrap();
        let now = transcript(&text);
        if now == text {
            continue;
        }
        if std::env::var_os("LOFT_ACCEPT").is_some() {
            fs::write(&path, now).unwrap();
            continue;
        }
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let at = now.lines().zip(text.lines()).position(|(a, b)| a != b).unwrap_or(now.lines().count().min(text.lines().count()));
        wrong.push(format!("{name}:{}\n  was {:?}\n  now {:?}", at + 1, text.lines().nth(at), now.lines().nth(at)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn piped(input: &str) -> (String, String, Option<i32>) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_loft"))
        .arg("repl")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap(), output.status.code())
}

#[test]
fn a_pipe_is_a_session_without_prompt_and_colour() {
    let (out, err, status) = piped("curve a = line(\n  (0, 0, 0),\n  (3mm, 4mm, 0))\n\na.length\n:quit\nb.length\n");
    assert_eq!((out.as_str(), err.as_str(), status), ("curve a: line, 5 mm, 1 link\n5mm\n", "", Some(0)));
    let (out, _, status) = piped("let x = (1\nlet y = 2\ny\n");
    assert!(out.contains("E101") && out.ends_with("let y: 2\n2\n") && !out.contains('\u{1b}'), "{out}");
    assert_eq!(status, Some(1));
}

#[test]
fn what_is_saved_gives_the_same_model() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("repl-save");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let saved = folder.join("saved.loft");
    let session = format!(
        "units m\nparam n = 3 in 1 to 9\ncurve ribs for i in 0..n = line((i * 1m, 0, 0), (i * 1m, 2, 0))\n:set n=5\nlen(ribs)\n:save {}\n:load {}\nlen(ribs)\n",
        saved.display(),
        saved.display()
    );
    let (out, _, status) = piped(&session);
    assert_eq!(status, Some(0), "{out}");
    assert_eq!(out.lines().filter(|line| *line == "5").count(), 2, "{out}");
    assert!(fs::read_to_string(&saved).unwrap().contains("param n = 5 in 1 to 9"));
}

#[test]
fn hostile_entries_leave_the_session_alive() {
    let long = "(".repeat(100_000);
    let entries = [
        long.as_str(),
        "\u{0}\u{1b}[31m",
        "let = = =",
        ":",
        ":show",
        ":\u{65e5}",
        "let x = 1e308 * 1e308",
        "[for i in 0..1000000000: i]",
        "curve curve",
        "\"",
        "/*",
    ];
    let mut session = String::new();
    for entry in entries {
        session.push_str(entry);
        session.push_str("\nlet z = 7\n");
    }
    session.push_str("*/\nlet z = 8\nz\n");
    let (out, err, status) = piped(&session);
    assert!(out.trim_end().ends_with('8'), "{out}{err}");
    assert_eq!(status, Some(1));
}

#[test]
fn a_session_draws_and_reads_again() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("repl-draw");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let script = folder.join("roof.loft");
    fs::write(&script, "units m\ncurve a = line((0, 0, 0), (4, 0, 0))\nsurface s = extrude(a, by: (0, 3, 0))\n").unwrap();
    let (load, picture) = (format!(":load {}", script.display()), folder.join("s.png"));
    let (out, _, status) = piped(&format!("{load}\n:reload\n:render s {}\ncurve b = a\n:reload\nb\n", picture.display()));
    assert_eq!(status, Some(1), "{out}");
    assert!(out.contains("is read again: nothing changed") && out.contains("is read again: b removed"), "{out}");
    assert!(out.contains(&format!("{}: 1200 × 800 pixels, ", picture.display())), "{out}");
    assert_eq!(&fs::read(&picture).unwrap()[1..4], b"PNG");
    // What failed is not written.
    let saved = folder.join("saved.loft");
    piped(&format!("curve a = line((0, 0, 0), (1, 0, 0))\ncurve b = line(a.end, nowhere)\n:save {}\n", saved.display()));
    assert_eq!(fs::read_to_string(&saved).unwrap(), "curve a = line((0, 0, 0), (1, 0, 0))\n");
}
