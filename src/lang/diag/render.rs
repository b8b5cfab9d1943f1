//! Diagnostics as text for a terminal, drawn by miette.
//!
//! ```text
//! E101 × this `(` is never closed
//!    ╭─[hall.loft:3:17]
//!  3 │ curve c = spline([A, (1, 0, 0)
//!    ·                 ┬ opened here
//!  4 │ surface s = coons(a, b, c, d)
//!    · ───┬─── a new declaration starts here, so the list ended before it
//!    ╰────
//!   help: add `])` after `(1, 0, 0)`
//! ```

use crate::base::fault::Severity;
use crate::base::limits::REPORTS_SHOWN;
use crate::lang::diag::diagnostic::{Diagnostic, FileId, Label, Sources};
use crate::lang::diag::frame::frame;
use crate::lang::diag::paint::{Colors, shortened};

/// Places of equal reports that are listed.
const PLACES_SHOWN: usize = 8;

/// All reports of a run: sorted by place, equal ones counted, at most twenty in full and the rest counted.
pub fn render_all(found: &[Diagnostic], sources: &Sources, colours: bool) -> String {
    let mut sorted: Vec<&Diagnostic> = found.iter().collect();
    sorted.sort_by_key(|d| d.place());
    let mut distinct: Vec<(&Diagnostic, Vec<&Diagnostic>)> = Vec::new();
    let mut seen = std::collections::BTreeMap::new();
    for diagnostic in sorted {
        let at = *seen.entry((diagnostic.code, diagnostic.message.as_str(), diagnostic.help.as_deref())).or_insert(distinct.len());
        match distinct.get_mut(at) {
            Some((_, same)) => same.push(diagnostic),
            None => distinct.push((diagnostic, Vec::new())),
        }
    }
    let mut text = String::new();
    for (diagnostic, same) in distinct.iter().take(REPORTS_SHOWN) {
        if !text.is_empty() {
            text.push('\n');
        }
        text.push_str(&render_one(diagnostic, same, sources, colours));
    }
    let rest: Vec<&Diagnostic> =
        distinct.iter().skip(REPORTS_SHOWN).flat_map(|(first, same)| std::iter::once(*first).chain(same.iter().copied())).collect();
    if !rest.is_empty() {
        text.push_str(&format!("\n… and {}\n", counted(&rest)));
    }
    text
}

/// One report.
pub fn render(diagnostic: &Diagnostic, sources: &Sources, colours: bool) -> String {
    render_one(diagnostic, &[], sources, colours)
}

/// `2 errors, 1 warning` of several reports.
fn counted(found: &[&Diagnostic]) -> String {
    let count = |severity, one: &str| {
        let n: usize = found.iter().filter(|d| d.severity() == severity).map(|d| 1 + d.more).sum();
        (n > 0).then(|| format!("{n} more {one}{}", if n == 1 { "" } else { "s" }))
    };
    let parts = [count(Severity::Error, "error"), count(Severity::Warning, "warning"), count(Severity::Note, "note")];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn render_one(diagnostic: &Diagnostic, same: &[&Diagnostic], sources: &Sources, colours: bool) -> String {
    let paint = Colors { on: colours, severity: diagnostic.severity() };
    let sign = match diagnostic.severity() {
        Severity::Error => '×',
        Severity::Warning => '⚠',
        Severity::Note => '☞',
    };
    let message = shortened(&diagnostic.message).replace('\n', "\n       ");
    let mut text = format!("{} {message}\n", paint.head(&format!("{} {sign}", diagnostic.code.0)));
    for (number, file) in files(diagnostic).into_iter().enumerate() {
        if let Some(source) = sources.get(file) {
            let labels: Vec<&Label> = diagnostic.labels.iter().filter(|l| l.file == file).collect();
            frame(&mut text, source, &labels, number, &paint);
        }
    }
    if let Some(help) = &diagnostic.help {
        tail(&mut text, &paint.word("help:"), help);
    }
    for note in &diagnostic.notes {
        tail(&mut text, &paint.word("note:"), note);
    }
    if let Some(words) = further(diagnostic, same, sources) {
        tail(&mut text, &paint.word("note:"), &words);
    }
    text
}

/// How many further reports one stands for, and the first places of those elsewhere.
fn further(diagnostic: &Diagnostic, same: &[&Diagnostic], sources: &Sources) -> Option<String> {
    let elsewhere: Vec<&&Diagnostic> = same.iter().filter(|d| d.labels.is_empty() || d.place() != diagnostic.place()).collect();
    let more = diagnostic.more + elsewhere.len() + same.iter().map(|d| d.more).sum::<usize>();
    let place = |other: &&Diagnostic| {
        let label = other.labels.first()?;
        let (file, p) = (sources.get(label.file)?, sources.place(label.file, label.span.start)?);
        Some(format!("{}:{}:{}", file.name, p.line, p.column))
    };
    let places: Vec<String> = elsewhere.into_iter().take(PLACES_SHOWN).filter_map(place).collect();
    match (more, places.len()) {
        (0, _) => None,
        (_, 0) => Some(format!("and {more} more like this one")),
        (_, all) if all == more => Some(format!("also at {}", places.join(", "))),
        _ => Some(format!("and {more} more like this one, at {}, …", places.join(", "))),
    }
}

/// `help:` or `note:` with its text, further lines set in.
fn tail(text: &mut String, word: &str, lines: &str) {
    text.push_str(&format!("  {word} {}\n", shortened(lines).replace('\n', "\n        ")));
}

/// Files of the labels in the order in which they are named.
fn files(diagnostic: &Diagnostic) -> Vec<FileId> {
    let mut files = Vec::new();
    for label in &diagnostic.labels {
        if !files.contains(&label.file) {
            files.push(label.file);
        }
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::diag::span::Span;

    fn at(start: u32, end: u32) -> Span {
        Span { start, end }
    }

    fn sources(text: &str) -> Sources {
        let mut sources = Sources::default();
        sources.add("hall.loft", text);
        sources
    }

    #[test]
    fn two_lines_in_one_frame() {
        let text = "units mm\ncurve c = spline([A, (1, 0, 0)\nsurface s = coons(a, b, c, d)\n";
        let found = Diagnostic::new("E101", "this `(` is never closed", FileId(0), at(25, 26), "opened here")
            .label(FileId(0), at(40, 47), "a new declaration starts here")
            .help("add `])` after `(1, 0, 0)`")
            .note("one\ntwo");
        let expected = "\
E101 × this `(` is never closed
   ╭─[hall.loft:2:17]
 2 │ curve c = spline([A, (1, 0, 0)
   ·                 ┬ opened here
 3 │ surface s = coons(a, b, c, d)
   · ───┬─── a new declaration starts here
   ╰────
  help: add `])` after `(1, 0, 0)`
  note: one
        two
";
        assert_eq!(render(&found, &sources(text), false), expected);
        let coloured = render(&found, &sources(text), true);
        assert!(coloured.starts_with("\x1b[1;31mE101 ×\x1b[0m this `(`"), "{coloured}");
    }

    #[test]
    fn two_labels_on_one_line_and_wide_letters() {
        let text = "let 지붕 = f(widht, hight)";
        let byte = |word: &str| text.find(word).unwrap() as u32;
        let found = Diagnostic::new("E201", "two names", FileId(0), at(byte("widht"), byte("widht") + 5), "first").label(
            FileId(0),
            at(byte("hight"), byte("hight") + 5),
            "second",
        );
        let shown = render(&found, &sources(text), false);
        let lines: Vec<&str> = shown.lines().collect();
        assert_eq!(lines[1], "   ╭─[hall.loft:1:12]");
        assert_eq!(lines[3], "   ·              ──┬──  ──┬──");
        assert!(lines[4].ends_with("╰── second") && lines[5].ends_with("╰── first"), "{shown}");
    }

    #[test]
    fn a_label_inside_another_stands_above_it() {
        let text = "check roof.area == 4m2 within 1um\n";
        let found = Diagnostic::new("E901", "check failed", FileId(0), at(6, 33), "differs").label(FileId(0), at(6, 15), "3m2");
        let expected = "\
E901 × check failed
   ╭─[hall.loft:1:7]
 1 │ check roof.area == 4m2 within 1um
   ·       ────┬──── 3m2
   ·       ─────────────┬───────────── differs
   ╰────
";
        assert_eq!(render(&found, &sources(text), false), expected);
        let third = found.label(FileId(0), at(19, 22), "wanted");
        assert!(
            render(&third, &sources(text), false)
                .contains("   ·           │         ╰── wanted\n   ·           ╰── 3m2\n   ·       ─────────────┬───────────── differs\n")
        );
    }

    #[test]
    fn long_lines_are_shown_in_a_window() {
        let text = format!("let x = [{}oops, {}]", "1234567, ".repeat(20_000), "1, ".repeat(20_000));
        let start = text.find("oops").unwrap() as u32;
        let found = Diagnostic::new("E201", "`oops` is not defined", FileId(0), at(start, start + 4), "here").label(
            FileId(0),
            at(text.len() as u32 - 1, text.len() as u32),
            "far away",
        );
        let shown = render(&found, &sources(&text), false);
        assert!(
            shown.len() < 2000 && shown.contains("[hall.loft:1:180010]") && shown.contains("┬ here") || shown.contains("┬─ here"),
            "{shown}"
        );
        let line: Vec<&str> = shown.lines().collect();
        assert!(line[2].contains("…") && line[2].contains("oops"));
    }

    #[test]
    fn many_reports_are_counted() {
        let text = "a\n".repeat(100);
        let one = |n: u32, message: String| Diagnostic::new("E201", message, FileId(0), at(2 * n, 2 * n + 1), "here");
        let found: Vec<Diagnostic> = (0..40).rev().map(|n| one(n, format!("message {}", n / 2 * 2 % 60))).collect();
        let shown = render_all(&found, &sources(&text), false);
        assert_eq!(shown.matches("E201 ×").count(), 20);
        assert!(shown.find("message 0") < shown.find("message 2"));
        assert!(shown.contains("  note: also at hall.loft:2:1\n"));
        let again = [one(1, "twice".to_owned()), one(1, "twice".to_owned()).label(FileId(0), at(8, 9), "and there")];
        assert!(!render_all(&again, &sources(&text), false).contains("note:"), "its own place is no other one");
        let found: Vec<Diagnostic> = (0..25).map(|n| one(n, format!("message {n}"))).collect();
        assert!(render_all(&found, &sources(&text), false).ends_with("\n… and 5 more errors\n"));
    }

    #[test]
    fn reports_that_stand_for_others_are_counted_as_many() {
        let one = |n: u32, more: usize| {
            let mut report = Diagnostic::new("W514", format!("message {}", n.min(25)), FileId(0), at(2 * n, 2 * n + 1), "here");
            report.more = more;
            report
        };
        let shown = |found: &[Diagnostic]| render_all(found, &sources(&"a\n".repeat(100)), false);
        assert!(shown(&[one(0, 12_345)]).contains("  note: and 12345 more like this one\n"));
        let several = shown(&[one(30, 5), one(31, 3), one(32, 0)]);
        assert!(several.contains("  note: and 10 more like this one, at hall.loft:32:1, hall.loft:33:1, …\n"), "{several}");
        let found: Vec<Diagnostic> = (0..28).map(|n| one(n, if n == 26 { 1000 } else { 0 })).collect();
        assert!(shown(&found).ends_with("\n… and 1008 more warnings\n"));
    }

    #[test]
    fn labels_beyond_the_text_do_no_harm() {
        let found = Diagnostic::new("E201", "x", FileId(0), at(90, 99), "here").label(FileId(7), at(0, 1), "no such file");
        assert!(render(&found, &sources("let a = 1\n"), false).contains("[hall.loft:2:1]"));
        assert!(render(&found, &sources(""), false).contains("[hall.loft:1:1]"));
    }
}
