//! The language, chapter by chapter: every `loft` fence of `tests/spec`, the README and the guide is run and must say
//! what its comments expect.
//!
//! `// => 40mm` after a declaration is its value as text; `// error: E602 "share no node"` (or `warning:`, `note:`) is a
//! report with a label on that line whose sentence holds the quoted words. A report that nothing
//! expects fails, and so does an expectation that nothing meets. A fence ```` ```csv offsets.csv ```` (any word, then a
//! name) is a file beside the fences that follow it.

use std::path::{Path, PathBuf};

use lofting::base::fault::Severity;
use lofting::base::job::Job;
use lofting::io::Memory;
use lofting::lang::diag::diagnostic::{Diagnostic, FileId, Label};
use lofting::lang::diag::render::render_all;
use lofting::lang::eval::context::Cx;
use lofting::lang::eval::machine::on_big_stack;
use lofting::lang::eval::std as words;
use lofting::lang::eval::std::Builtin;
use lofting::lang::run::phases::Entry;
use lofting::lang::values::value::ModuleId;
use lofting::session::stages::Stages;

/// What a line of a script expects.
#[derive(Debug, PartialEq)]
enum Expected {
    Value(String),
    Report { severity: Severity, code: String, words: String },
}

/// The expectation in a line's comment.
fn expectation(line: &str) -> Option<Expected> {
    if let Some((_, text)) = line.rsplit_once("// => ") {
        return Some(Expected::Value(text.trim().to_owned()));
    }
    let (_, comment) = line.rsplit_once("// ")?;
    let (word, rest) = comment.split_once(": ")?;
    let severity = match word {
        "error" => Severity::Error,
        "warning" => Severity::Warning,
        "note" => Severity::Note,
        _ => return None,
    };
    let (code, words) = rest.trim().split_once(' ').unwrap_or((rest.trim(), ""));
    Some(Expected::Report { severity, code: code.to_owned(), words: words.trim_matches('"').to_owned() })
}

/// The name that a line declares.
fn declared(line: &str) -> Option<&str> {
    let mut words = line.split_whitespace();
    let keyword = words.next()?;
    let name = if keyword == "modeling" { words.nth(1)? } else { words.next()? };
    name.split([':', '=']).next()
}

/// Runs a script and compares; the text says what differs.
fn check(script: &str, files: &Memory) -> Result<(), String> {
    let job = Job::new();
    on_big_stack(|| {
        let clock = || 0.0;
        let stages = Stages::new(&clock);
        let mut cx = Cx::new(files, &stages, &job);
        cx.load(Entry { name: "spec.loft", path: "spec.loft", text: script.into(), sets: &[], row: None });
        cx.evaluate_all();
        let _ = cx.model(ModuleId::MAIN);
        for (_, mesh) in cx.mesh_values() {
            let _ = cx.mesh(&mesh);
        }
        let found = cx.finish();
        let mut wrong = Vec::new();
        let mut met = vec![false; found.len()];
        for (i, line) in script.lines().enumerate() {
            match expectation(line) {
                None => {}
                Some(Expected::Value(text)) => {
                    let name = declared(line).unwrap_or("");
                    let value = cx.value_of(name).map(|v| cx.show_inside(&v));
                    if value.as_deref() != Some(&text) {
                        wrong.push(format!("line {}: `{name}` is {}, expected {text}", i + 1, value.unwrap_or("undefined".into())));
                    }
                }
                Some(Expected::Report { severity, code, words }) => {
                    let fits = |d: &Diagnostic| {
                        let on_line = |l: &Label| {
                            l.file == FileId(0) && cx.program.sources.place(l.file, l.span.start).is_some_and(|p| p.line == i + 1)
                        };
                        d.severity() == severity && d.code.0 == code && d.message.contains(&words) && d.labels.iter().any(on_line)
                    };
                    match (0..found.len()).find(|k| !met[*k] && fits(&found[*k])) {
                        Some(k) => met[k] = true,
                        None => wrong.push(format!("line {}: no {code} \"{words}\"", i + 1)),
                    }
                }
            }
        }
        let unmet: Vec<Diagnostic> =
            found.iter().zip(&met).filter(|(d, met)| !**met && d.severity() != Severity::Note).map(|(d, _)| d.clone()).collect();
        if !unmet.is_empty() {
            wrong.push(format!("nobody expects\n{}", render_all(&unmet, &cx.program.sources, false)));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
    })
}

/// Fences of a text: info words, first line of the content, content.
fn fences(text: &str) -> Vec<(String, usize, String)> {
    let mut out: Vec<(String, usize, String)> = Vec::new();
    let mut open: Option<(String, usize, String, String)> = None;
    for (i, line) in text.lines().enumerate() {
        let trimmed = line.trim_start();
        match &mut open {
            None if trimmed.starts_with("```") => {
                let ticks: String = trimmed.chars().take_while(|c| *c == '`').collect();
                open = Some((trimmed[ticks.len()..].trim().to_owned(), i + 2, String::new(), ticks));
            }
            None => {}
            Some((info, first, content, ticks)) => {
                if trimmed.trim_end() == ticks {
                    out.push((std::mem::take(info), *first, std::mem::take(content)));
                    open = None;
                } else {
                    content.push_str(line);
                    content.push('\n');
                }
            }
        }
    }
    out
}

/// Checks all fences of a file; what is wrong is appended.
fn check_file(path: &Path, wrong: &mut Vec<String>) -> usize {
    let text = std::fs::read_to_string(path).expect("a file of the repository");
    let (mut files, mut n) = (Memory::new(), 0);
    for (info, first, content) in fences(&text) {
        match info.split_once(' ') {
            Some((_, name)) => files = files.with(name.trim(), content),
            None if info == "loft" => {
                n += 1;
                if let Err(what) = check(&content, &files) {
                    wrong.push(format!("{}:{first}\n{what}", path.display()));
                }
            }
            None => {}
        }
    }
    n
}

fn markdown(folder: &Path, out: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.sort();
    for path in paths {
        // The pages of codes show what is broken; they have a test of their own.
        if path.is_dir() && !path.ends_with("codes") {
            markdown(&path, out);
        } else if path.extension().is_some_and(|e| e == "md") {
            out.push(path);
        }
    }
}

fn assert_clean(wrong: &[String]) {
    assert!(wrong.is_empty(), "{} blocks differ\n\n{}", wrong.len(), wrong.join("\n\n"));
}

#[test]
fn the_specification_holds() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    markdown(&root.join("tests/spec"), &mut paths);
    let mut wrong = Vec::new();
    let n: usize = paths.iter().map(|p| check_file(p, &mut wrong)).sum();
    assert_clean(&wrong);
    assert!(n > 50, "only {n} blocks were found");
}

#[test]
fn the_documentation_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = vec![root.join("README.md")];
    markdown(&root.join("docs"), &mut paths);
    let mut wrong = Vec::new();
    for path in paths {
        check_file(&path, &mut wrong);
    }
    assert_clean(&wrong);
}

fn all_words() -> impl Iterator<Item = &'static Builtin> {
    words::builtins().chain(words::fields())
}

#[test]
fn every_function_has_an_example_that_runs() {
    let files = Memory::new();
    let mut wrong = Vec::new();
    for builtin in all_words() {
        let examples: Vec<_> = fences(builtin.docs).into_iter().filter(|f| f.0 == "loft").collect();
        if examples.is_empty() && words::builtins().any(|b| std::ptr::eq(b, builtin)) {
            wrong.push(format!("`{}` has no example", builtin.name));
        }
        for (_, _, content) in examples {
            if let Err(what) = check(&content, &files) {
                wrong.push(format!("example of `{}`\n{what}", builtin.name));
            }
        }
    }
    assert_clean(&wrong);
}

#[test]
fn every_word_is_documented_once() {
    let mut wrong = Vec::new();
    let mut names: Vec<&str> = words::builtins().map(|b| b.name).collect();
    names.sort_unstable();
    wrong.extend(names.windows(2).filter(|w| w[0] == w[1]).map(|w| format!("`{}` is declared twice", w[0])));
    for builtin in all_words() {
        let name = builtin.name;
        if !name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_') {
            wrong.push(format!("`{name}` is not snake_case"));
        }
        if builtin.summary().is_empty() || builtin.summary().chars().count() >= 80 {
            wrong.push(format!("`{name}`: first sentence of {} characters", builtin.summary().chars().count()));
        }
        if builtin.params.len() > 63 {
            wrong.push(format!("`{name}` has too many parameters"));
        }
        for param in builtin.params {
            let is_field = words::fields().any(|f| std::ptr::eq(f, builtin));
            if param.docs.trim().is_empty() && !is_field {
                wrong.push(format!("`{name}`: `{}` has no docs", param.name));
            }
        }
    }
    assert_clean(&wrong);
}

#[test]
fn comments_of_lines_are_read() {
    let report = |severity, code: &str, words: &str| Some(Expected::Report { severity, code: code.into(), words: words.into() });
    assert_eq!(expectation("let a = 1 // => 1"), Some(Expected::Value("1".into())));
    assert_eq!(expectation("let a = b // error: E201 \"`b` is\""), report(Severity::Error, "E201", "`b` is"));
    assert_eq!(expectation("let a = b // warning: W220"), report(Severity::Warning, "W220", ""));
    assert_eq!(expectation("let a = 1 // a length: 3"), None);
    assert!(check("let a = 1 // => 2\n", &Memory::new()).is_err());
    assert!(check("let a = 1 // error: E201\n", &Memory::new()).is_err());
    assert!(check("let a = b\n", &Memory::new()).is_err());
}
