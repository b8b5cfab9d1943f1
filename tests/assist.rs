//! Help while typing: `tests/assist/*.loft` hold lines `//   ^ offers …` and `//   ^ tells …` below the place they
//! speak of, and what must be said there. `LOFT_ACCEPT=1 cargo test assist::` writes it anew; read the difference.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lofting::lang::assist::{About, EditedScript, Known, hover_text};

/// Longest time that one place may take.
const LONGEST: Duration = Duration::from_millis(50);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/assist")
}

fn open(_: &str, written: &str) -> Option<(String, String)> {
    Some((written.to_owned(), fs::read_to_string(folder().join(written)).ok()?))
}

fn script<'s>(text: &'s str, known: &'s Known) -> EditedScript<'s> {
    EditedScript { text, path: "main.loft", open: &open, known, session: false }
}

/// What is offered first; what is behind it is counted.
fn offers(text: &str, at: usize) -> String {
    let known = Known::new();
    let offer = script(text, &known).complete(at);
    if offer.file {
        return "a file".to_owned();
    }
    let best: Vec<&str> = offer.candidates.iter().filter(|c| c.rank == 0).map(|c| c.text.trim()).collect();
    let rest = offer.candidates.len() - best.len();
    match (best.len(), rest) {
        (0, 0) => "nothing".to_owned(),
        (_, 0) => best.join(" "),
        _ => format!("{} and {rest} more", best.join(" ")).trim().to_owned(),
    }
}

fn tells(text: &str, at: usize) -> String {
    let known = Known::new();
    let words = match script(text, &known).hover(at) {
        Some(About::Words(words)) => words,
        Some(About::Declared { name, line, docs }) => format!("{}\n(a name: {name})", hover_text(&line, &docs)),
        None => return "nothing".to_owned(),
    };
    let lines: Vec<&str> = words.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("```")).collect();
    let said = lines.join(" | ");
    said.chars().take(220).collect()
}

/// A file without its marks, and the marks: line, byte of the place, whether it is a hover.
fn read(text: &str) -> (String, Vec<(usize, usize, bool)>) {
    let (mut kept, mut marks, mut last) = (String::new(), Vec::new(), 0);
    for (number, line) in text.lines().enumerate() {
        let mark = line.strip_prefix("//").filter(|rest| rest.trim_start().starts_with('^'));
        match mark {
            Some(_) => {
                let column = line.chars().take_while(|c| *c != '^').count();
                let before = kept[last..].char_indices().nth(column).map_or(kept.len() - 1, |(at, _)| last + at);
                marks.push((number, before, line.contains("^ tells")));
            }
            None => {
                last = kept.len();
                kept.push_str(line);
                kept.push('\n');
            }
        }
    }
    (kept, marks)
}

#[test]
fn places_are_known() {
    let accepts = std::env::var_os("LOFT_ACCEPT").is_some();
    let mut wrong = Vec::new();
    let mut files: Vec<PathBuf> = fs::read_dir(folder()).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        let (kept, marks) = read(&text);
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for (number, at, hover) in marks {
            let said = if hover { format!("tells {}", tells(&kept, at)) } else { format!("offers {}", offers(&kept, at)) };
            let head = lines[number].find('^').unwrap() + 1;
            let line = format!("{} {said}", &lines[number][..head]);
            if line != lines[number] {
                wrong.push(format!("{}:{}\n  kept {}\n  now  {line}", path.display(), number + 1, lines[number]));
                lines[number] = line;
            }
        }
        if accepts {
            fs::write(&path, lines.join("\n") + "\n").unwrap();
        }
    }
    assert!(accepts || wrong.is_empty(), "{}", wrong.join("\n"));
}

/// At every place of a script, cut off there as if that were all that is typed, and in the whole text.
#[test]
fn every_place_is_answered_at_once() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut longest = (Duration::ZERO, String::new());
    for name in ["tank", "wing", "canopy", "porch"] {
        let text = fs::read_to_string(examples.join(format!("{name}.loft"))).unwrap();
        let known = Known::new();
        for (at, _) in text.char_indices() {
            for shown in [&text[..at], &text] {
                let here = script(shown, &known);
                let offer = here.complete(at);
                assert!(offer.start <= at && text.is_char_boundary(offer.start));
                let timed = || {
                    let start = Instant::now();
                    here.complete(at);
                    let asked = start.elapsed();
                    let start = Instant::now();
                    here.hover(at);
                    here.call(at);
                    asked.max(start.elapsed() / 2)
                };
                let mut taken = timed();
                // What else the machine does is left out.
                for _ in 0..8 {
                    taken = if taken > LONGEST { taken.min(timed()) } else { taken };
                }
                if taken > longest.0 {
                    longest = (taken, format!("{name} at byte {at}"));
                }
            }
        }
    }
    assert!(longest.0 < LONGEST, "{longest:?}");
}

/// Text that no grammar knows does not stop anything.
#[test]
fn strange_text_is_survived() {
    let known = Known::new();
    let deep = format!("let a = {}", "(".repeat(3000));
    let chain: String = (1..3000).map(|k| format!("let a{k} = a{}.x\n", k - 1)).collect();
    let ring = "let a = b.c\nlet b = a.c\nlet c = a.".to_owned();
    let strange = [
        "",
        ".",
        "let a = .",
        "mesh m of s { on { near { ",
        "fn f(",
        "fn f(a: [",
        "use \"",
        "use \"x\" (",
        "}}}",
        "\"{\"{",
        "지붕.",
        "a.b.c.d.",
        "/* a.",
    ];
    for text in strange.iter().map(|s| (*s).to_owned()).chain([deep, format!("{chain}let z = a2999."), ring]) {
        let here = script(&text, &known);
        for at in [text.len(), text.len() / 2, 0] {
            here.complete(at);
            here.hover(at);
            here.call(at);
        }
    }
    assert_eq!(script("let 지붕 = 1", &known).complete(5).candidates.len(), 0);
}
