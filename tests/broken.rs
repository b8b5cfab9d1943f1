//! Broken scripts: each reports what is wrong, at the right place, all in one run, and none panics.
//!
//! A line of `tests/broken/*.loft` that is wrong ends in `// error: E501 "some words"`: the foremost label of a report
//! with this code begins on this line, and its message, labels or help hold these words. Several may stand on one line;
//! `// error:` and `// warning:` and `// note:` mean the same, the letter of the code tells. A comment
//! `// error below: …` speaks of the next line. Every error has to be announced; warnings and notes may stay unsaid.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

use lofting::base::fault::Severity;
use lofting::lang::diag::diagnostic::{Diagnostic, Sources};
use lofting::lang::diag::render::{render, render_all};
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;

use crate::support::script;

/// A script and its text.
type Key = (PathBuf, String);

/// What scripts report, by path and text: several tests look at the same ones.
static REPORTED: Mutex<BTreeMap<Key, Arc<OnceLock<Reported>>>> = Mutex::new(BTreeMap::new());

type Reported = (Vec<Diagnostic>, Sources);

/// What a script reports when it is checked; a panic is a report as well, E999. Each text is checked once.
fn reports(path: &Path, text: &str) -> Reported {
    let all = || REPORTED.lock().expect("no test panics here");
    let once = all().entry((path.to_owned(), text.to_owned())).or_default().clone();
    once.get_or_init(|| reported(path, text)).clone()
}

fn reported(path: &Path, text: &str) -> Reported {
    let name = path.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned());
    let disk = Disk::new(Some(path), None, &[], Outputs::Counted).expect("the folder of the script exists");
    match guarded(|| script::outcome(&name, text.as_bytes(), &[], &disk)) {
        Ok(outcome) => (outcome.diagnostics, outcome.sources),
        Err(bug) => (vec![Diagnostic::without_place("E999", bug.what)], Sources::default()),
    }
}

/// One announced report: line from 1, code, words.
#[derive(Debug, Clone, PartialEq)]
struct Announced {
    line: usize,
    code: String,
    words: String,
}

fn announced(text: &str) -> Vec<Announced> {
    let mut all = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let Some(at) = ["// error", "// warning", "// note"].iter().filter_map(|w| line.find(w)).min() else { continue };
        let below = line[at..].split(':').next().unwrap_or("").contains("below");
        let mut rest = &line[at..];
        while let Some((code_at, quote)) = find_code(rest) {
            let code = rest[code_at..code_at + 4].to_owned();
            let words = rest[quote + 1..].split('"').next().unwrap_or("").to_owned();
            rest = &rest[quote + 2 + words.len()..];
            all.push(Announced { line: number + 1 + usize::from(below), code, words });
        }
    }
    all
}

/// Where the next `E501 "` begins and where its quote stands.
fn find_code(text: &str) -> Option<(usize, usize)> {
    let bytes = text.as_bytes();
    (0..bytes.len().saturating_sub(5)).find_map(|at| {
        let code = matches!(bytes[at], b'E' | b'W' | b'N') && bytes[at + 1..at + 4].iter().all(u8::is_ascii_digit);
        (code && &text[at + 4..at + 6] == " \"").then_some((at, at + 5))
    })
}

/// Whether a report is the announced one.
fn fits(announced: &Announced, found: &Diagnostic, sources: &Sources) -> bool {
    let line = found.labels.first().and_then(|l| sources.place(l.file, l.span.start)).map_or(1, |p| p.line);
    let says = found.message.contains(&announced.words)
        || found.labels.iter().any(|l| l.text.contains(&announced.words))
        || found.help.iter().chain(&found.notes).any(|h| h.contains(&announced.words));
    found.code.0 == announced.code && line == announced.line && says
}

/// Everything that is wrong with the reports of one script.
fn differences(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).expect("a broken script can be read");
    let (found, sources) = reports(path, &text);
    let mut wanted = announced(&text);
    let mut said = Vec::new();
    if wanted.is_empty() {
        said.push("announces nothing".to_owned());
    }
    for report in &found {
        for label in &report.labels {
            let length = sources.get(label.file).map_or(0, |f| f.text.len());
            if label.span.start > label.span.end || label.span.end as usize > length {
                said.push(format!("{}: a label outside the text: {:?}", report.code.0, label.span));
            }
        }
        match wanted.iter().position(|w| fits(w, report, &sources)) {
            Some(at) => {
                wanted.remove(at);
            }
            None if report.severity() == Severity::Error => {
                said.push(format!("not announced:\n{}", render(report, &sources, false)));
            }
            None => {}
        }
    }
    said.extend(wanted.iter().map(|w| format!("line {}: {} \"{}\" was not reported", w.line, w.code, w.words)));
    said.into_iter().map(|s| format!("{}: {s}", path.display())).collect()
}

fn scripts(folder: &str, ending: &str) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).expect("the folder can be listed").flatten().map(|e| e.path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == ending));
    paths.sort();
    paths
}

#[test]
fn broken_scripts_say_what_is_wrong() {
    let paths = scripts("tests/broken", "loft");
    let found: Vec<String> = paths.iter().flat_map(|p| differences(p)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The fenced block of a page that begins with this line.
fn fences<'a>(page: &'a str, kind: &str) -> Vec<&'a str> {
    let open = format!("```{kind}\n");
    let mut rest = page;
    let mut all = Vec::new();
    while let Some(at) = rest.find(&open) {
        let body = &rest[at + open.len()..];
        let end = body.find("```").unwrap_or(body.len());
        all.push(&body[..end]);
        rest = &body[end..];
    }
    all
}

/// Codes whose pages show no script: no small one leads there, or what leads there is no script.
const WITHOUT_SCRIPT: &[&str] = &[
    "E110", "E409", "E410", "E413", "E505", "E506", "E510", "W606", "W607", "W614", "N615", "E616", "E714", "E715", "E808", "W726", "W810",
    "E811", "W814", "E815", "E902", "E904", "E999",
];

/// Every page shows a broken script, exactly what is said about it, and a repaired script without errors.
/// `LOFT_ACCEPT=1` writes the messages into the pages.
#[test]
fn pages_of_codes_are_true() {
    let accept = std::env::var_os("LOFT_ACCEPT").is_some();
    let mut wrong = Vec::new();
    for info in lofting::lang::diag::codes::CODES.iter().filter(|c| c.since.is_some() && !WITHOUT_SCRIPT.contains(&c.code)) {
        let path = PathBuf::from(format!("docs/codes/{}.md", info.code));
        let page = fs::read_to_string(&path).expect("a page can be read");
        if let Err(said) = check_page(info.code, &path, &page, accept) {
            wrong.push(format!("{}: {said}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Writes the data files of a page into a folder of its own; the path is that of its script.
fn folder_of_page(code: &str, page: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pages").join(code);
    fs::create_dir_all(&folder).expect("a folder can be made");
    for block in page.split("```data ").skip(1) {
        let (name, rest) = block.split_once('\n').expect("a data block has a name");
        fs::write(folder.join(name), rest.split("```").next().unwrap_or("")).expect("a data file can be written");
    }
    folder.join("model.loft")
}

fn check_page(code: &str, path: &Path, page: &str, accept: bool) -> Result<(), String> {
    let [broken, repaired] = fences(page, "loft")[..] else { return Err("no broken and repaired script".to_owned()) };
    let model = folder_of_page(code, page);
    fs::write(&model, broken).expect("a script can be written");
    let (found, sources) = reports(&model, broken);
    let shown = render_all(&found, &sources, false);
    if !found.iter().any(|d| d.code.0 == code) {
        return Err(format!("the broken script reports\n{shown}"));
    }
    let message = fences(page, "text");
    if message.first().is_none_or(|m| *m != shown) {
        if !accept {
            return Err(format!("the message is\n{shown}"));
        }
        let old = message.first().map_or(String::new(), |m| format!("```text\n{m}```"));
        fs::write(path, page.replacen(&old, &format!("```text\n{shown}```"), 1)).expect("a page can be written");
    }
    let (found, sources) = reports(&model, repaired);
    let again: Vec<Diagnostic> = found.into_iter().filter(|d| d.severity() == Severity::Error || d.code.0 == code).collect();
    if again.is_empty() { Ok(()) } else { Err(format!("the repaired script reports\n{}", render_all(&again, &sources, false))) }
}

/// Codes whose page offers something to type.
const FIXED: &[&str] = &[
    "E101", "E102", "E103", "E104", "E105", "E106", "E107", "E108", "E201", "E202", "E212", "E214", "E219", "W220", "E221", "E303", "E305",
    "E403", "E405", "E407", "E412", "E414", "E415", "E418", "E501", "E502", "E508", "W514", "E621", "E623", "E655", "E663", "W701", "E702",
    "E703", "E704", "W706", "E801", "E805",
];

/// What is offered on a page is typed, and then the report is gone and no error is new.
#[test]
fn fixes_of_pages_remove_their_reports() {
    let (mut fixed, mut wrong) = (Vec::new(), Vec::new());
    for info in lofting::lang::diag::codes::CODES.iter().filter(|c| c.since.is_some() && !WITHOUT_SCRIPT.contains(&c.code)) {
        let page = fs::read_to_string(format!("docs/codes/{}.md", info.code)).expect("a page can be read");
        let model = folder_of_page(info.code, &page).with_file_name("fixed.loft");
        let (offered, said) = fixed_one_by_one(&model, fences(&page, "loft")[0], true);
        wrong.extend(said);
        if offered.iter().any(|code| code == info.code) {
            fixed.push(info.code);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(fixed, FIXED);
}

/// The same for scripts with many mistakes: what a repair brings to light was hidden behind it. A mistake of the grammar is
/// hidden only behind a bracket, string or comment without end.
#[test]
fn fixes_of_broken_scripts_remove_their_reports() {
    let mut wrong = Vec::new();
    let mut fixes = 0;
    for path in scripts("tests/broken", "loft") {
        let text = fs::read_to_string(&path).expect("a broken script can be read");
        let (offered, said) = fixed_one_by_one(&path, &text, false);
        fixes += offered.len();
        wrong.extend(said);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(fixes > 90, "{fixes} fixes were offered");
}

/// Help that shows code and replaces nothing: the code is an example, or something to add whose place is the user's to choose.
const EXAMPLES: &[(&str, &str)] = &[
    // Signatures.
    ("E211", "`trim("),
    ("E301", "`"),
    ("E302", "`"),
    // What is to be chosen.
    ("E417", "take a part of it"),
    ("E417", "cut a little off before"),
    ("E509", "`meet(a, b)` lists"),
    ("E603", "take the run with one of the two meetings"),
    ("E622", "leave that stretch out"),
    ("E634", "draw this guide as far"),
    ("E635", "take the run of it that goes one way"),
    ("E636", "take the runs before and after it"),
    ("E641", "draw both through one point"),
    ("E658", "bound one of them"),
    ("E659", "a curve divides a surface when"),
    ("E666", "trim one of them by the border of the other"),
    ("E666", "`mesh "),
    ("E502", "both are closed: `outer:"),
    ("E201", "for example"),
    // General forms, and two units in one value, which are fixed only together.
    ("E102", "functions need no import"),
    ("E102", "what is allowed is written"),
    ("E102", "in a ratio `%` directly follows"),
    ("E102", "a unit directly follows its number: `8mm`"),
];

/// Whether a stretch in backquotes of a help is code to be typed: nothing in it is left open, and it is not a name of the script.
fn is_typed(code: &str, script: &str) -> bool {
    let words = code.trim_end_matches(':');
    !code.contains('…') && !script.contains(words) && code.chars().any(|c| c.is_ascii_digit() || matches!(c, '(' | '[' | '{' | '+' | '='))
}

/// Every help that shows code which may stand in the place of something has it as a fix, so that the tests above type it.
#[test]
fn help_that_shows_code_is_a_fix() {
    let mut wrong = Vec::new();
    let mut texts: Vec<(PathBuf, String)> = Vec::new();
    for info in lofting::lang::diag::codes::CODES.iter().filter(|c| c.since.is_some() && !WITHOUT_SCRIPT.contains(&c.code)) {
        let page = fs::read_to_string(format!("docs/codes/{}.md", info.code)).expect("a page can be read");
        texts.push((folder_of_page(info.code, &page).with_file_name("help.loft"), fences(&page, "loft")[0].to_owned()));
    }
    texts.extend(
        scripts("tests/broken", "loft").into_iter().map(|p| (p.clone(), fs::read_to_string(p).expect("a broken script can be read"))),
    );
    for (path, text) in &texts {
        // The words that a script announces are not the script.
        let script: String = text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n");
        for report in reports(path, text).0.iter().filter(|r| r.fixes.is_empty() && r.severity() == Severity::Error) {
            let help = report.help.clone().unwrap_or_default();
            let shown = help.split('`').skip(1).step_by(2).find(|code| is_typed(code, &script));
            if let Some(code) = shown.filter(|_| !EXAMPLES.iter().any(|(c, begins)| *c == report.code.0 && help.starts_with(begins))) {
                wrong.push(format!("{}: {} shows `{code}` and replaces nothing: {help}", path.display(), report.code.0));
            }
        }
    }
    wrong.sort();
    wrong.dedup();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Applies each fix that is offered for a script, alone; the codes that had one, and what is wrong afterwards.
fn fixed_one_by_one(path: &Path, text: &str, whole: bool) -> (Vec<String>, Vec<String>) {
    let key = |d: &Diagnostic| (d.code.0, d.message.clone());
    let (mut offered, mut wrong) = (Vec::new(), Vec::new());
    let (found, _) = reports(path, text);
    let times = |all: &[Diagnostic], one: &Diagnostic| all.iter().filter(|d| key(d) == key(one)).map(|d| 1 + d.more).sum::<usize>();
    for diagnostic in &found {
        for fix in diagnostic.fixes.iter().filter(|f| f.file.index() == 0) {
            let Some(change) = fix.change(text) else {
                wrong.push(format!("{}: nothing comes of {fix:?} for {}", path.display(), diagnostic.message));
                continue;
            };
            offered.push(diagnostic.code.0.to_owned());
            let (start, end) = (change.span.start as usize, change.span.end as usize);
            let typed = format!("{}{}{}", &text[..start], change.text, &text[end..]);
            let (after, sources) = reports(path, &typed);
            let new = |d: &&Diagnostic| {
                d.severity() == Severity::Error
                    && !found.iter().any(|old| old.code == d.code)
                    && (whole || d.code.0.starts_with("E1") && !["E101", "E103", "E104"].contains(&diagnostic.code.0))
            };
            let stays = times(&after, diagnostic) >= times(&found, diagnostic);
            if let Some(worse) = after.iter().find(|d| stays && key(d) == key(diagnostic)).or_else(|| after.iter().find(new)) {
                let line = typed[..start].lines().count().max(1) - 1;
                let line = typed.lines().nth(line).unwrap_or("");
                wrong.push(format!(
                    "{}: {} after {} ({:?})\n{line}\n{}",
                    path.display(),
                    diagnostic.code.0,
                    change.title,
                    fix.edit,
                    render(worse, &sources, false)
                ));
            }
        }
    }
    (offered, wrong)
}

/// Every code that the sources name is in the table, and so is every page.
#[test]
fn every_code_is_in_the_table() {
    fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
        for path in fs::read_dir(folder).expect("a folder of sources").flatten().map(|e| e.path()) {
            // What the page is built with may lie beside it.
            let is_ours = !path.ends_with("node_modules");
            if path.is_dir() && is_ours {
                sources(&path, found)
            } else if is_ours {
                found.push(path)
            }
        }
    }
    let known = |code: &str| lofting::lang::diag::codes::CODES.iter().any(|c| c.code == code);
    let mut files = Vec::new();
    sources(Path::new("src"), &mut files);
    files.sort();
    let mut named: Vec<String> = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).expect("a source can be read");
        // What tests make up does not count.
        let text = text.split("#[cfg(test)]").next().unwrap_or("");
        for piece in text.split('"').skip(1).filter(|p| p.len() == 4 && p.is_ascii()) {
            if ["E", "W", "N"].contains(&&piece[..1]) && piece[1..].bytes().all(|b| b.is_ascii_digit()) {
                assert!(known(piece), "{} names {piece}", path.display());
                named.push(piece.to_owned());
            }
        }
    }
    for path in scripts("docs/codes", "md") {
        let code = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        assert!(known(&code), "{} is a page without a code", path.display());
    }
    for info in lofting::lang::diag::codes::CODES {
        // E902 is what `loft test` says of a golden, in other words.
        let times = named.iter().filter(|n| *n == info.code).count() + usize::from(info.code == "E902");
        assert!(times > usize::from(info.since.is_some()), "{} is in the table and never reported", info.code);
    }
}

#[test]
fn announcements_are_read() {
    let text = "let a = b // error: E201 \"b\" E202 \"c d\"\n// error below: E101 \"x\"\nlet y\nlet z // W220 \"no\"\n";
    let read: Vec<(usize, String, String)> = announced(text).into_iter().map(|a| (a.line, a.code, a.words)).collect();
    let wanted = [(1, "E201", "b"), (1, "E202", "c d"), (3, "E101", "x")];
    assert_eq!(read, wanted.map(|(l, c, w)| (l, c.to_owned(), w.to_owned())));
}
