//! `loft fmt`: a table of cases in `tests/fmt/*.txt`, and what holds for every script: laid out twice is laid out once,
//! the tree is the same, and so are all tokens and comments.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use lofting::lang::diag::diagnostic::FileId;
use lofting::lang::fmt::format;
use lofting::lang::syntax::parse;
use lofting::lang::words::names::Names;
use proptest::prelude::*;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files with an ending below a folder of the project.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![root().join(folder)]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The ```` ```loft ```` blocks of a page.
fn blocks(page: &str) -> Vec<String> {
    let (mut found, mut inside) = (Vec::new(), None::<String>);
    for line in page.lines() {
        match &mut inside {
            Some(block) if line.starts_with("```") => {
                found.push(std::mem::take(block));
                inside = None;
            }
            Some(block) => *block += &format!("{line}\n"),
            None if line.starts_with("```loft") => inside = Some(String::new()),
            None => {}
        }
    }
    found
}

/// All scripts of the project, broken ones included, with where they stand.
fn corpus() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for path in ["examples", "tests", "docs"].iter().flat_map(|folder| files(folder, "loft")) {
        found.push((path.display().to_string(), fs::read_to_string(&path).unwrap()));
    }
    let pages = ["docs", "tests"].iter().flat_map(|folder| files(folder, "md")).chain([root().join("README.md")]);
    for path in pages {
        for (n, block) in blocks(&fs::read_to_string(&path).unwrap()).into_iter().enumerate() {
            found.push((format!("{} block {n}", path.display()), block));
        }
    }
    assert!(found.len() > 150, "{} scripts", found.len());
    found
}

/// The trees of a script without places, and the codes of its mistakes.
fn tree(source: &str) -> String {
    let (script, found) = parse(source, FileId(0), &mut Names::default());
    let text = format!("{script:?}");
    let mut parts = text.split("Span { start: ");
    let mut bare = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        bare += part.split_once('}').unwrap().1;
    }
    for mistake in found {
        let _ = write!(bare, " {}", mistake.code.0);
    }
    bare
}

/// A script cut in words, signs, strings and comments by a second scanner that knows nothing of the first.
fn cut(source: &str) -> Vec<String> {
    let chars: Vec<char> = source.chars().collect();
    let (mut pieces, mut at) = (Vec::new(), 0);
    while at < chars.len() {
        let start = at;
        let next = chars.get(at + 1).copied().unwrap_or(' ');
        match chars[at] {
            c if c.is_whitespace() || c == '\u{feff}' => {
                at += 1;
                continue;
            }
            '/' if next == '/' => at += chars[at..].iter().take_while(|&&c| c != '\n').count(),
            '/' if next == '*' => at = comment_end(&chars, at),
            '"' => at = string_end(&chars, at),
            c if c.is_alphanumeric() || c == '_' => {
                while chars.get(at).is_some_and(|c| c.is_alphanumeric() || *c == '_') {
                    at += 1;
                }
            }
            _ => at += 1,
        }
        pieces.push(chars[start..at].iter().collect());
    }
    pieces
}

fn comment_end(chars: &[char], start: usize) -> usize {
    let (mut at, mut depth) = (start, 0);
    while at < chars.len() {
        match (chars[at], chars.get(at + 1)) {
            ('/', Some('*')) => (depth, at) = (depth + 1, at + 2),
            ('*', Some('/')) => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

fn string_end(chars: &[char], start: usize) -> usize {
    let mut at = start + 1;
    while let Some(&c) = chars.get(at) {
        at += 1;
        match c {
            '\\' => at += 1,
            '"' => break,
            '{' => {
                while chars.get(at).is_some_and(|&c| c != '}') {
                    at = if chars[at] == '"' { string_end(chars, at) } else { at + 1 };
                }
            }
            _ => {}
        }
    }
    at.min(chars.len())
}

/// Comments in order, and everything else in order.
fn halves(source: &str) -> (Vec<String>, String) {
    let (comments, code): (Vec<_>, Vec<_>) = cut(source).into_iter().partition(|p| p.starts_with("//") || p.starts_with("/*"));
    (comments.iter().map(|c| c.replace("\r\n", "\n").trim_end().to_owned()).collect(), code.concat())
}

/// What must hold for any script; gives its layout.
fn holds(name: &str, source: &str) -> String {
    let once = format(source);
    assert_eq!(once.changed, once.text != source, "{name}");
    let twice = format(&once.text);
    assert!(
        twice.text == once.text,
        "{name}: laid out twice differs\n--- source\n{source}\n--- once\n{}\n--- twice\n{}",
        once.text,
        twice.text
    );
    assert!(tree(source) == tree(&once.text), "{name}: another tree\n--- source\n{source}\n--- layout\n{}", once.text);
    once.text
}

/// The same for a script whose strings and comments all end.
fn keeps(name: &str, source: &str) -> String {
    let text = holds(name, source);
    assert_eq!(halves(source), halves(&text), "{name}\n--- source\n{source}\n--- layout\n{text}");
    text
}

fn is_sound(source: &str) -> bool {
    let (_, found) = parse(source, FileId(0), &mut Names::default());
    found.iter().all(|d| d.code.0.starts_with('W'))
}

/// `=== title`, the source, `--->`, the layout.
#[test]
fn cases() {
    let mut count = 0;
    for path in files("tests/fmt", "txt") {
        let page = fs::read_to_string(&path).unwrap();
        let mut rewritten = page.split("=== ").next().unwrap().to_owned();
        for case in page.split("=== ").skip(1) {
            let (title, rest) = case.split_once('\n').unwrap();
            let (source, wanted) = rest.split_once("--->\n").unwrap();
            let wanted = wanted.strip_suffix('\n').unwrap();
            let source = source.replace("␍", "\r").replace('⇥', "\t");
            let text = holds(title, &source).replace('\r', "␍").replace('\t', "⇥");
            if std::env::var_os("LOFT_ACCEPT").is_none() {
                assert!(text == wanted, "{}: {title}\n--- layout\n{text}\n--- wanted\n{wanted}", path.display());
            }
            let source = source.replace('\r', "␍").replace('\t', "⇥");
            let _ = write!(rewritten, "=== {title}\n{source}--->\n{text}\n");
            count += 1;
        }
        if std::env::var_os("LOFT_ACCEPT").is_some() {
            fs::write(&path, rewritten).unwrap();
        }
    }
    assert!(count > 25, "{count} cases");
}

#[test]
fn all_scripts_of_the_project_keep_their_meaning() {
    for (name, source) in corpus() {
        if is_sound(&source) {
            keeps(&name, &source);
        } else {
            holds(&name, &source);
        }
    }
}

/// What people copy is laid out already.
#[test]
fn examples_are_laid_out() {
    for path in files("examples", "loft").into_iter().chain(files("tests/golden", "loft")) {
        let source = fs::read_to_string(&path).unwrap();
        assert!(!format(&source).changed, "{}: run `loft fmt`", path.display());
    }
}

/// Line ends of another system change nothing else.
#[test]
fn carriage_returns_and_byte_order_marks_go() {
    for (name, source) in corpus().into_iter().filter(|(_, source)| is_sound(source)) {
        let foreign = format!("\u{feff}{}", source.replace('\n', "\r\n"));
        assert_eq!(format(&foreign).text, format(&source).text, "{name}");
        assert_eq!(format(source.trim_end()).text, format(&source).text, "{name}: without a line end at its end");
    }
}

/// A script without line ends inside its declarations and one with a blank around every token look the same.
#[test]
fn blanks_of_the_author_do_not_matter() {
    let mut compared = 0;
    for (name, source) in corpus() {
        for line in source.lines().filter(|l| is_sound(l) && !l.contains("//") && !l.contains("/*") && !l.trim().is_empty()) {
            let (tight, loose) = (line.to_owned(), spaced(line));
            if tree(&tight) == tree(&loose) {
                assert_eq!(format(&tight).text.replace(['(', ' '], ""), format(&loose).text.replace(['(', ' '], ""), "{name}: {line}");
                compared += 1;
            }
        }
    }
    assert!(compared > 300, "{compared}");
}

fn spaced(line: &str) -> String {
    let mut text = String::new();
    let mut string = false;
    for c in line.chars() {
        string ^= c == '"';
        if !string && matches!(c, '(' | ')' | '[' | ']' | ',' | '+' | '*') {
            let _ = write!(text, " {c} ");
        } else {
            text.push(c);
        }
    }
    text
}

#[test]
fn a_broken_declaration_stays_byte_for_byte() {
    for broken in
        ["  curve  x=line( (0,0,0)  ,\r\n   (1,0,0)", "curve a=1 curve   b=2  // two", "wall  x=3", "let t = \"open", "let y  =  1 +"]
    {
        let source = format!("let   a=1\n{broken}\nlet   b=2\n");
        let text = holds(broken, &source);
        assert_eq!(text, format!("let a = 1\n{broken}\nlet b = 2\n"));
    }
}

#[test]
fn what_follows_a_comment_without_end_stays() {
    let source = "let   a=1\nlet   b=2 /* never\nlet   c=3\n";
    assert_eq!(holds("open", source), "let a = 1\nlet   b=2 /* never\nlet   c=3\n");
}

/// Time grows with the length, also of one declaration.
#[test]
fn deep_and_long_declarations_are_laid_out() {
    let deep = format!("let x = {}1{}\n", "[".repeat(250), "]".repeat(250));
    holds("deep", &deep);
    let long = format!("let x = [{}]\n", vec!["f(1, 2)"; 20_000].join(", "));
    assert_eq!(holds("long", &long).lines().count(), 20_002);
    let sum = format!("let x = {}\n", vec!["abcdefgh"; 3_000].join(" + "));
    assert_eq!(holds("sum", &sum).lines().count(), 3_001);
    let choices = format!("let x = {}0\n", (0..60).map(|i| format!("if a == {i} then {i} else ")).collect::<String>());
    holds("choices", &choices);
}

/// Pieces to be put between two tokens.
fn between() -> impl Strategy<Value = &'static str> {
    prop_oneof![
        10 => Just(""),
        6 => Just(" "),
        3 => Just("   "),
        3 => Just("\n"),
        1 => Just("\r\n"),
        1 => Just("\n\n\n"),
        1 => Just("\t"),
        2 => Just(" /* 지붕 */ "),
        1 => Just("/* a /* b */ c */"),
        1 => Just("\n  // 👩‍🚀 e\u{301}\n"),
        2 => Just(" // why\n"),
        1 => Just("\n/* two\n   lines */\n"),
        1 => Just(" /* two\n lines */ "),
        1 => Just("\n/// doc\n"),
    ]
}

/// A script with other blanks, line ends and comments between its pieces, words kept apart.
fn mixed(source: &str, gaps: &[&str]) -> String {
    let pieces = cut(source);
    let mut text = String::new();
    for (n, piece) in pieces.iter().enumerate() {
        let gap = gaps[n % gaps.len()];
        let word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '.' || c == '%');
        if gap.is_empty() && word(text.chars().next_back()) && word(piece.chars().next()) && source.contains(&format!(" {piece}")) {
            text.push(' ');
        }
        text += gap;
        text += piece;
        if piece.starts_with("//") {
            text.push('\n');
        }
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn line_ends_and_comments_anywhere(which in any::<prop::sample::Index>(), gaps in prop::collection::vec(between(), 1..60)) {
        let corpus = scripts();
        let source = &corpus[which.index(corpus.len())];
        for declaration in source.split_inclusive('\n') {
            let text = mixed(declaration, &gaps);
            if is_sound(&text) { keeps("mixed", &text) } else { holds("mixed", &text) };
        }
        holds("mixed", &mixed(source, &gaps));
    }

    #[test]
    fn damaged_scripts(which in any::<prop::sample::Index>(), places in prop::collection::vec((any::<prop::sample::Index>(), 0usize..14), 1..6)) {
        let corpus = scripts();
        let mut text: Vec<char> = corpus[which.index(corpus.len())].chars().collect();
        for (place, what) in places {
            let at = place.index(text.len().max(1)).min(text.len());
            match ['(', ')', '[', '"', '{', '}', '/', '\n', '*', '\r', '\u{feff}', '지', ' '].get(what) {
                Some(&c) => text.insert(at, c),
                None => drop(text.drain(at..text.len().min(at + 7))),
            }
        }
        holds("damaged", &text.iter().collect::<String>());
    }
}

fn scripts() -> &'static [String] {
    static SCRIPTS: std::sync::OnceLock<Vec<String>> = std::sync::OnceLock::new();
    SCRIPTS.get_or_init(|| corpus().into_iter().map(|c| c.1).filter(|s| s.len() < 4_000 && !s.trim().is_empty()).collect())
}
