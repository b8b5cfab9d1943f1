//! The structure of the sources: floors import only from lower floors, a crate is named in few files, files and functions stay short.

use std::fs;
use std::path::{Path, PathBuf};

/// Floors from the ground up; those in one row do not know each other.
const FLOORS: &[(&str, u8)] = &[
    ("base", 0),
    ("geometry", 1),
    ("network", 2),
    ("surface", 3),
    ("model", 4),
    ("mesh", 5),
    ("hydrostatics", 5),
    ("io", 6),
    ("draw", 6),
    ("lang", 7),
    ("session", 8),
    ("cli", 9),
    ("library", 9),
];

/// Rooms of a floor in their order: each imports only from rooms before it.
const ROOMS: &[(&str, &[&str])] = &[
    (
        "surface",
        &[
            "faults",
            "data",
            "rails",
            "shapes",
            "core",
            "closest",
            "trims",
            "points",
            "blended",
            "swept",
            "joined",
            "filled",
            "analysis",
            "intersect",
            "offset",
            "rolling",
        ],
    ),
    (
        "mesh",
        &[
            "request",
            "mapped",
            "data",
            "border",
            "chart",
            "deviation",
            "size",
            "divide",
            "tri",
            "quad",
            "face",
            "output",
            "verify",
            "report",
            "cache",
            "pipeline",
        ],
    ),
    ("io", &["files", "tables", "mesh_files", "curve_files", "formats", "cad", "iges", "step"]),
    ("geometry", &["data", "shapes", "curves", "query", "construct"]),
    ("lang", &["diag", "words", "syntax", "values", "eval", "incremental", "declare", "assist", "run", "fmt"]),
];

/// A crate and the files that may name it.
const DOORS: &[(&str, &[&str])] = &[
    ("spade", &["src/base/triangulate"]),
    ("rayon", &["src/base/par.rs"]),
    ("robust", &["src/base/"]),
    ("libm", &["src/base/"]),
    ("tobj", &["src/io/mesh_files/obj_read.rs"]),
    ("csv", &["src/io/tables/table_"]),
    ("ryu", &["src/base/text.rs"]),
    ("unicode_width", &["src/base/text.rs"]),
    ("unicode_script", &["src/lang/syntax/look_alikes.rs"]),
    ("unicode_security", &["src/lang/syntax/look_alikes.rs"]),
    ("png", &["src/draw/"]),
    ("zip", &["src/io/mesh_files/threemf.rs"]),
    ("pest", &["src/lang/syntax/"]),
    ("pest_derive", &["src/lang/syntax/"]),
    ("miette", &["src/lang/diag", "src/cli/"]),
    ("serde", &["src/io/tables/json.rs", "src/session/", "src/cli/"]),
    ("serde_json", &["src/io/tables/json.rs", "src/session/", "src/cli/"]),
    ("clap", &["src/cli/"]),
    ("clap_complete", &["src/cli/"]),
    ("indicatif", &["src/cli/"]),
    ("ctrlc", &["src/cli/"]),
    ("signal_hook", &["src/cli/"]),
    ("flate2", &["src/cli/view/"]),
    ("getrandom", &["src/cli/view/gate.rs"]),
];

/// What floors 0 to 7 never touch: the disk, the environment, the clock, threads of their own.
const OUTSIDE: &[&str] = &["std::fs", "std::env", "std::time", "println!", "eprintln!"];

/// Lines a floor may have, tests included; a higher number is a change of its own, with the reason.
const CEILINGS: &[(&str, usize)] = &[
    ("base", 5_000),
    ("geometry", 7_200),
    ("network", 5_150),
    ("surface", 37_800),
    ("model", 7_450),
    ("mesh", 35_100),
    ("hydrostatics", 2_300),
    ("io", 19_900),
    ("draw", 4_400),
    ("lang", 34_200),
    ("session", 14_300),
    ("cli", 8_100),
    ("library", 2_000),
];

const LONGEST_FILE: usize = 400;

const LONGEST_FUNCTION: usize = 80;

struct Source {
    path: String,
    floor: String,
    text: String,
}

fn sources() -> Vec<Source> {
    let mut files = Vec::new();
    collect(Path::new("src"), &mut files);
    files.sort();
    files
        .into_iter()
        .map(|file| {
            let path = file.to_string_lossy().replace('\\', "/");
            let floor = path.split('/').nth(1).unwrap_or_default().trim_end_matches(".rs").to_owned();
            Source { floor, text: fs::read_to_string(&file).expect("a source file can be read"), path }
        })
        .collect()
}

fn collect(dir: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(dir).expect("src can be listed").flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
}

fn level(floor: &str) -> Option<u8> {
    FLOORS.iter().find(|(name, _)| *name == floor).map(|(_, level)| *level)
}

/// The code of a line without its comment, and `None` from the first test module on.
fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let end = text.find("#[cfg(test)]").unwrap_or(text.len());
    text[..end].lines().enumerate().map(|(n, line)| (n + 1, line.split("//").next().unwrap_or("")))
}

fn words(line: &str, word: &str) -> bool {
    let boundary = |c: Option<char>| !c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    line.match_indices(word).any(|(at, _)| boundary(line[..at].chars().next_back()) && boundary(line[at + word.len()..].chars().next()))
}

fn report(what: &str, found: Vec<String>) {
    assert!(found.is_empty(), "{what}:\n{}", found.join("\n"));
}

#[test]
fn floors_import_only_downward() {
    let mut found = Vec::new();
    for source in sources() {
        let Some(here) = level(&source.floor) else { continue };
        for (number, line) in code_lines(&source.text) {
            for (name, there) in FLOORS {
                let climbs = *there > here || (*there == here && *name != source.floor);
                if climbs && (line.contains(&format!("crate::{name}::")) || line.contains(&format!("crate::{{{name}"))) {
                    found.push(format!("{}:{number}: {} imports {name}", source.path, source.floor));
                }
            }
        }
    }
    report("a floor imports only from floors below it", found);
}

#[test]
fn rooms_import_only_from_rooms_before_them() {
    let mut found = Vec::new();
    for (floor, rooms) in ROOMS {
        let place = |room: &str| rooms.iter().position(|name| *name == room);
        let start = format!("crate::{floor}::");
        for source in sources().iter().filter(|source| source.floor == *floor) {
            let room = source.path.split('/').nth(2).unwrap_or_default();
            if room.ends_with(".rs") {
                continue;
            }
            let Some(here) = place(room) else {
                found.push(format!("{}: {room} is no room of {floor}", source.path));
                continue;
            };
            for (number, line) in code_lines(&source.text) {
                for path in line.split(&start).skip(1) {
                    let named: Vec<&str> = path.trim_start_matches('{').split(|c: char| !c.is_alphanumeric() && c != '_').collect();
                    // Whatever the floor offers as a whole comes from its last room.
                    let climbs = named.first().is_some_and(|name| place(name).is_none_or(|there| there > here));
                    if climbs {
                        found.push(format!("{}:{number}: {room} imports {}", source.path, named[0]));
                    }
                }
                if line.contains("super::super::") {
                    found.push(format!("{}:{number}: paths between rooms begin with crate::{floor}", source.path));
                }
            }
        }
    }
    report("a room imports only from rooms before it", found);
}

#[test]
fn crates_stay_behind_their_doors() {
    let mut found = Vec::new();
    for source in sources() {
        for (number, line) in code_lines(&source.text) {
            for (name, doors) in DOORS {
                let named = line.contains(&format!("{name}::")) && words(line, name) || line.contains(&format!("use {name};"));
                let own_module = line.contains(&format!("::{name}::")) || line.contains(&format!("mod {name}"));
                if named && !own_module && !doors.iter().any(|door| source.path.starts_with(door)) {
                    found.push(format!("{}:{number}: {name}", source.path));
                }
            }
        }
    }
    report("a dependency is named in one place only", found);
}

#[test]
fn lower_floors_do_no_input_or_output() {
    let mut found = Vec::new();
    for source in sources().iter().filter(|s| level(&s.floor).is_some_and(|l| l < 8)) {
        for (number, line) in code_lines(&source.text) {
            let threads = (source.path != "src/base/par.rs").then_some(&"std::thread");
            for word in OUTSIDE.iter().chain(threads) {
                if line.contains(word) {
                    found.push(format!("{}:{number}: {word}", source.path));
                }
            }
        }
    }
    report("floors below the session touch neither disk, environment, clock nor terminal", found);
}

#[test]
fn files_and_floors_stay_small() {
    let mut found = Vec::new();
    let sources = sources();
    for source in &sources {
        let lines = source.text.lines().count();
        if lines > LONGEST_FILE {
            found.push(format!("{}: {lines} lines, more than {LONGEST_FILE}", source.path));
        }
    }
    for (floor, ceiling) in CEILINGS {
        let lines: usize = sources.iter().filter(|s| s.floor == *floor).map(|s| s.text.lines().count()).sum();
        if lines > *ceiling {
            found.push(format!("{floor}: {lines} lines, more than {ceiling}"));
        }
    }
    report("files and floors have ceilings", found);
}

/// The functions of a file without those of its tests: line, name and number of lines.
fn functions(text: &str) -> Vec<(usize, &str, usize)> {
    let end = text.find("#[cfg(test)]\nmod tests").unwrap_or(text.len());
    let lines: Vec<&str> = text[..end].lines().collect();
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        let mut words = code.split(' ').skip_while(|word| word.starts_with("pub") || matches!(*word, "const" | "super)" | "self)"));
        if words.next() != Some("fn") {
            continue;
        }
        let name = words.next().unwrap_or_default().split(['(', '<']).next().unwrap_or_default();
        let closes = |line: &&str| line.strip_prefix(indent).is_some_and(|rest| rest.starts_with('}'));
        let declared = code.ends_with(';') || code.ends_with('}');
        if let Some(length) = lines[start..].iter().position(closes).filter(|_| !declared) {
            found.push((start + 1, name, length + 1));
        }
    }
    found
}

#[test]
fn functions_stay_small() {
    let mut found = Vec::new();
    for source in &sources() {
        for (line, name, length) in functions(&source.text).into_iter().filter(|f| f.2 > LONGEST_FUNCTION) {
            found.push(format!("{}:{line}: {name} has {length} lines, more than {LONGEST_FUNCTION}", source.path));
        }
    }
    report("functions have a limit", found);
}

#[test]
fn functions_are_measured() {
    let text = "impl A {\n    pub(crate) const fn a(\n        b: u8,\n    ) -> u8 {\n        b\n    }\n    fn c();\n    fn d() {}\n}\n\
                pub fn e<T>() {\n    if true {\n    }\n}\n#[cfg(test)]\nmod tests {\n    fn f() {\n    }\n}\n";
    assert_eq!(functions(text), [(2, "a", 5), (10, "e", 4)]);
}

/// A small literal with an exponent is a tolerance, and tolerances live in one file.
#[test]
fn tolerances_live_in_one_file() {
    let mut found = Vec::new();
    for source in sources().iter().filter(|s| level(&s.floor).is_some_and(|l| l < 7) && s.path != "src/base/tolerance.rs") {
        for (number, line) in code_lines(&source.text) {
            let bytes = line.as_bytes();
            for (at, _) in line.match_indices("e-") {
                let digit_before = at > 0 && bytes[at - 1].is_ascii_digit();
                let digit_after = bytes.get(at + 2).is_some_and(u8::is_ascii_digit);
                if digit_before && digit_after {
                    found.push(format!("{}:{number}: {}", source.path, line.trim()));
                }
            }
        }
    }
    report("a tolerance has a name in src/base/tolerance.rs", found);
}

/// What a user's clone must not hold: paths of one machine, marks of unfinished work.
#[test]
fn nothing_of_one_machine_and_nothing_unfinished() {
    let mut files = Vec::new();
    for dir in ["src", "tests", "benches", "docs", "examples", "grammar"] {
        all_text(Path::new(dir), &mut files);
    }
    for name in ["README.md", "CHANGELOG.md", "Cargo.toml"] {
        files.push(PathBuf::from(name));
    }
    let marks = [
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("XX", "X"),
        concat!("/wo", "rk/"),
        concat!("../sha", "red"),
        concat!("to", "do!("),
    ];
    let mut found = Vec::new();
    for file in files {
        let Ok(text) = fs::read_to_string(&file) else { continue };
        for mark in marks {
            if text.contains(mark) {
                found.push(format!("{}: {mark}", file.display()));
            }
        }
    }
    report("nothing of one machine, nothing unfinished", found);
}

fn all_text(dir: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(dir) else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            all_text(&path, files);
        } else if path.extension().is_some_and(|e| ["rs", "md", "loft", "pest", "toml", "py", "sh"].iter().any(|x| e == *x)) {
            files.push(path);
        }
    }
}

#[test]
fn lints_stay_on() {
    // Missing docs are a compiler warning, and warnings are denied by clippy in continuous integration; here the lint is only held in place.
    let manifest = fs::read_to_string("Cargo.toml").expect("the manifest can be read");
    for lint in ["missing_docs = \"warn\"", "unsafe_code = \"forbid\"", "unwrap_used = \"deny\"", "panic = \"deny\""] {
        assert!(manifest.contains(lint), "Cargo.toml lost the lint {lint}");
    }
}

/// A golden that holds a failed check would keep a wrong answer; only those about failing do.
#[test]
fn goldens_hold_no_failed_checks() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = vec![root.join("examples"), root.join("tests/golden"), root.join("tests/acceptance")];
    let mut failed = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path()) {
            if path.is_dir() && path.file_name().is_some_and(|name| name != "broken") {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "golden") {
                let text = fs::read_to_string(&path).unwrap();
                let fails = |line: &str| line.starts_with("check ") && line.ends_with("  fail");
                failed.extend(text.lines().filter(|line| fails(line)).map(|line| format!("{}: {line}", path.display())));
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// What notes and guides call a file by is the end of the path of one.
#[test]
fn documents_name_files_that_exist() {
    let (mut files, mut pages) = (Vec::new(), Vec::new());
    ["src", "tests", "benches", "examples"].iter().for_each(|dir| collect(Path::new(dir), &mut files));
    all_text(Path::new("docs"), &mut pages);
    let paths: Vec<String> = files.iter().map(|file| format!("/{}", file.to_string_lossy().replace('\\', "/"))).collect();
    let mut found = Vec::new();
    for page in pages.iter().filter(|page| page.extension().is_some_and(|e| e == "md")) {
        let text = fs::read_to_string(page).expect("a page can be read");
        for (number, line) in text.lines().enumerate() {
            for name in line.split('`').skip(1).step_by(2).filter(|name| name.ends_with(".rs") && !name.contains(['<', ' ', '*', '{'])) {
                if !paths.iter().any(|path| path.ends_with(&format!("/{name}"))) {
                    found.push(format!("{}:{}: {name}", page.display(), number + 1));
                }
            }
        }
    }
    report("documents name files that exist", found);
}

/// Where the papers and books stand that are cited by a key in square brackets.
const SOURCES: &str = "docs/notes/sources.md";

/// A key of citation (names and a year) with a line for it, and a line for nothing that is not cited.
#[test]
fn every_cited_source_stands_in_the_list() {
    let list = fs::read_to_string(SOURCES).expect("the list of sources can be read");
    let listed: Vec<&str> = list.lines().filter_map(|line| line.strip_prefix("- **")?.split("**").next()).collect();
    let mut files = Vec::new();
    for dir in ["src", "tests", "benches", "docs"] {
        all_text(Path::new(dir), &mut files);
    }
    files.sort();
    let mut cited = Vec::new();
    let mut found = Vec::new();
    for file in files.iter().filter(|file| file.as_path() != Path::new(SOURCES)) {
        let Ok(text) = fs::read_to_string(file) else { continue };
        for (number, key) in citations(&text) {
            if !listed.contains(&key.as_str()) {
                found.push(format!("{}:{number}: {key} has no line in {SOURCES}", file.display()));
            }
            cited.push(key);
        }
    }
    for (k, key) in listed.iter().enumerate() {
        if !cited.iter().any(|one| one == key) {
            found.push(format!("{SOURCES}: nothing cites {key}"));
        }
        if listed[..k].contains(key) {
            found.push(format!("{SOURCES}: {key} is given twice"));
        }
    }
    report("what is cited stands in the list of sources, and what stands there is cited", found);
}

/// The keys between square brackets, several of them apart by semicolons, with their lines. A bracket may go on in the next line
/// of a comment.
fn citations(text: &str) -> Vec<(usize, String)> {
    let plain: Vec<&str> = text.lines().map(uncommented).collect();
    let plain = plain.join("\n");
    let mut found = Vec::new();
    let mut open = None;
    for (at, c) in plain.char_indices().filter(|(_, c)| matches!(c, '[' | ']')) {
        if c == '[' {
            open = Some(at);
        } else if let Some(start) = open.take() {
            for key in plain[start + 1..at].split(';').filter_map(citation) {
                found.push((plain[..start].matches('\n').count() + 1, key));
            }
        }
    }
    found
}

/// A line without blanks round it and without the mark of a comment.
fn uncommented(line: &str) -> &str {
    let line = line.trim();
    ["//!", "///", "//", "#"].iter().find_map(|mark| line.strip_prefix(mark)).unwrap_or(line)
}

/// The names and the year that an entry begins with, one blank apart; none where it begins otherwise.
fn citation(entry: &str) -> Option<String> {
    let words: Vec<&str> = entry.split_whitespace().collect();
    let year = words.iter().position(|word| is_year(word.trim_end_matches(',')))?;
    let names = &words[..year];
    let last = *names.last()?;
    let named = |word: &str| word == "&" || is_name(word.trim_end_matches([',', '.']));
    let whole = names.iter().all(|word| named(word)) && (last == "al." || last.ends_with(char::is_alphabetic));
    let capital = names.iter().any(|word| word.starts_with(char::is_uppercase));
    (whole && capital).then(|| format!("{} {}", names.join(" "), words[year].trim_end_matches(',')))
}

fn is_year(word: &str) -> bool {
    word.len() == 4 && word.bytes().all(|b| b.is_ascii_digit()) && ["18", "19", "20"].iter().any(|century| word.starts_with(century))
}

fn is_name(word: &str) -> bool {
    !word.is_empty() && word.chars().all(|c| c.is_alphabetic() || matches!(c, '-' | '\''))
}

#[test]
fn keys_of_citations_are_found() {
    // Written apart, so that this file cites nothing itself.
    let text =
        ["//! Lengths [", "Press et al. 1992, rtsafe; de Boor\n//! 1978] of `[f64; 2000]`, [A, 1990] and [Steele, Lea & ", "Flood 2014]."]
            .concat();
    let keys: Vec<(usize, String)> = citations(&text);
    let wanted = [(1, "Press et al. 1992"), (1, "de Boor 1978"), (2, "Steele, Lea & Flood 2014")];
    assert_eq!(keys, wanted.map(|(line, key)| (line, key.to_owned())));
}
