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
//!
//! miette is handed only the lines that carry labels, long ones cut to a window around them: it cannot format beyond
//! column 65 535, and nobody reads that far. It counts columns in bytes, so the place in the frame is ours.

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use crate::base::fault::Severity;
use crate::base::limits::REPORTS_SHOWN;
use crate::lang::diag::diagnostic::{Diagnostic, FileId, Label, SourceFile, Sources};

/// Characters of a line shown before and behind its labels when it is long.
const WINDOW: usize = 100;
/// Characters of the longest message that is shown whole.
const WORDS: usize = 2000;
/// Bytes of the longest line that is shown whole.
const WHOLE_LINE: usize = 500;

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
    let paint = Paint { on: colours, severity: diagnostic.severity() };
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
    let more = diagnostic.more + same.iter().map(|d| 1 + d.more).sum::<usize>();
    if same.is_empty() && more > 0 {
        tail(&mut text, &paint.word("note:"), &format!("and {more} more like this one"));
    }
    if !same.is_empty() {
        let mut places: Vec<String> = Vec::new();
        for other in same.iter().take(8) {
            let label = other.labels.first();
            let place = label.and_then(|l| Some((sources.get(l.file)?, sources.place(l.file, l.span.start)?)));
            places.extend(place.map(|(file, p)| format!("{}:{}:{}", file.name, p.line, p.column)));
        }
        let etc = if more > 8 { ", …" } else { "" };
        let times = if more == 1 { "once more".to_owned() } else { format!("{more} times more") };
        let colon = if places.is_empty() { "" } else { ": " };
        tail(&mut text, &paint.word("note:"), &format!("the same {times}{colon}{}{etc}", places.join(", ")));
    }
    text
}

/// `help:` or `note:` with its text, further lines set in.
fn tail(text: &mut String, word: &str, lines: &str) {
    text.push_str(&format!("  {word} {}\n", shortened(lines).replace('\n', "\n        ")));
}

/// Words that quote something endless: their beginning and end. The JSON report has them whole.
fn shortened(words: &str) -> std::borrow::Cow<'_, str> {
    let total = words.chars().count();
    if total <= WORDS {
        return words.into();
    }
    let begin: String = words.chars().take(WORDS / 2).collect();
    let end: String = words.chars().skip(total - WORDS / 4).collect();
    format!("{begin}…{end}").into()
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

/// One line of the script as it is shown, with its labels in bytes of the shown text.
struct Row {
    index: usize,
    text: String,
    labels: Vec<(usize, usize, String)>,
}

impl Row {
    /// A place between two characters is marked under the one behind it, at the end of the line under a blank.
    fn widen(&mut self) {
        for (from, to, _) in &mut self.labels {
            if from == to {
                if *from == self.text.len() {
                    self.text.push(' ');
                }
                *to = *from + self.text[*from..].chars().next().map_or(0, char::len_utf8);
            }
        }
    }
}

/// The labelled lines of one file in a frame.
fn frame(text: &mut String, source: &SourceFile, labels: &[&Label], number: usize, paint: &Paint) {
    let rows = rows(source, labels);
    let Some(first) = labels.first() else { return };
    let place = source.place(first.span.start);
    let width = rows.last().map_or(1, |row| (row.index + 1).to_string().len()).max(2);
    let pad = " ".repeat(width + 1);
    let corner = if number == 0 { '╭' } else { '├' };
    text.push_str(&format!("{pad}{}\n", paint.frame(&format!("{corner}─[{}:{}:{}]", source.name, place.line, place.column))));
    for row in &rows {
        for (n, line) in drawn_in_tiers(row).iter().enumerate() {
            let (number, bar) = if n == 0 { ((row.index + 1).to_string(), '│') } else { (String::new(), '·') };
            let gutter = paint.frame(&format!("{number:>width$} {bar}"));
            let line = if n == 0 { line.clone() } else { paint.label(line) };
            text.push_str(format!("{gutter} {line}").trim_end_matches(' '));
            text.push('\n');
        }
    }
    text.push_str(&format!("{pad}{}\n", paint.frame("╰────")));
}

/// From and to within a line, with the words.
type Mark = (usize, usize, String);

/// The lines that carry labels, in order. A label over several lines marks what it covers of its first one.
fn rows(source: &SourceFile, labels: &[&Label]) -> Vec<Row> {
    let mut by_line: Vec<(usize, Vec<Mark>)> = Vec::new();
    for label in labels {
        let start = source.boundary(label.span.start) as usize;
        let index = source.place(label.span.start).line - 1;
        let (line_start, line) = source.line(index);
        let from = (start - line_start).min(line.len());
        let to = (source.boundary(label.span.end) as usize).saturating_sub(line_start).clamp(from, line.len());
        let to = if line[from..to].trim_end().is_empty() { to } else { from + line[from..to].trim_end().len() };
        match by_line.iter_mut().find(|(i, _)| *i == index) {
            Some((_, marks)) => marks.push((from, to, shortened(&label.text).into_owned())),
            None => by_line.push((index, vec![(from, to, shortened(&label.text).into_owned())])),
        }
    }
    by_line.sort_by_key(|(index, _)| *index);
    by_line
        .into_iter()
        .map(|(index, mut labels)| {
            labels.sort_by_key(|&(from, to, _)| (from, to));
            let (_, line) = source.line(index);
            let mut row = Row { index, text: line.to_owned(), labels };
            row.widen();
            if line.len() > WHOLE_LINE {
                cut(&mut row);
            }
            row
        })
        .collect()
}

/// Cuts a long line to a window around its first label; labels are clipped to it, those outside are left out.
fn cut(row: &mut Row) {
    let Some(&(first, first_end, _)) = row.labels.first() else { return };
    let back = row.text[..first].char_indices().rev().nth(WINDOW - 1).map_or(0, |(at, _)| at);
    let far =
        row.labels.iter().map(|&(_, to, _)| to).filter(|&to| to <= first + 4 * WINDOW).max().unwrap_or(first_end).min(first + 4 * WINDOW);
    let far = (first..=far).rev().find(|&at| row.text.is_char_boundary(at)).unwrap_or(first);
    let ahead = row.text[far..].char_indices().nth(WINDOW).map_or(row.text.len(), |(at, _)| far + at);
    let (before, behind) = (if back > 0 { "…" } else { "" }, if ahead < row.text.len() { "…" } else { "" });
    row.labels.retain(|&(from, ..)| from <= ahead);
    for (from, to, _) in &mut row.labels {
        *from = *from - back + before.len();
        *to = (*to).min(ahead) - back + before.len();
    }
    row.text = format!("{before}{}{behind}", &row.text[back..ahead]);
}

/// A line and the marks under it. Marks that cover each other stand under one another, the narrowest first.
fn drawn_in_tiers(row: &Row) -> Vec<String> {
    let mut tiers: Vec<Vec<Mark>> = Vec::new();
    let mut marks: Vec<&Mark> = row.labels.iter().collect();
    marks.sort_by_key(|(from, to, _)| (to - from, *from));
    for mark in marks {
        let free = |tier: &Vec<Mark>| tier.iter().all(|other| mark.1 <= other.0 || other.1 <= mark.0);
        // Never above a narrower one that it covers.
        let first = tiers.iter().rposition(|tier| !free(tier)).map_or(0, |k| k + 1);
        match tiers.get_mut(first) {
            Some(tier) => tier.push(mark.clone()),
            None => tiers.push(vec![mark.clone()]),
        }
    }
    let mut lines: Vec<String> = Vec::new();
    for mut labels in tiers {
        labels.sort_by_key(|&(from, to, _)| (from, to));
        let drawn = drawn(&Row { index: row.index, text: row.text.clone(), labels });
        lines.extend(drawn.into_iter().skip(usize::from(!lines.is_empty())));
    }
    lines
}

/// A line and the marks under it, as miette draws them; a single label stands behind its mark.
fn drawn(row: &Row) -> Vec<String> {
    let tabs = row.text.replace('\t', "    ");
    let widen = |at: usize| at + 3 * row.text[..at].matches('\t').count();
    let labels = row.labels.iter().map(|(from, to, text)| {
        let (from, to) = (widen(*from), widen(*to));
        LabeledSpan::new(Some(text.replace('\n', " ")), from, to - from)
    });
    let snippet = Snippet { line: OneLine(tabs.clone()), labels: labels.collect() };
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor())
        .with_width(100)
        .with_wrap_lines(false)
        .with_links(false)
        .with_context_lines(0);
    let mut text = String::new();
    if handler.render_report(&mut text, &snippet).is_err() {
        return vec![tabs];
    }
    // Only the lines between the corners of the frame are ours; their gutter is cut off.
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines().skip_while(|l| !l.contains('╭')).skip(1) {
        let Some((_, rest)) = line.split_once(if lines.is_empty() { '│' } else { '·' }) else { break };
        lines.push(rest.strip_prefix(' ').unwrap_or(rest).to_owned());
    }
    if let [_, marks, label] = lines.as_mut_slice()
        && let Some((_, words)) = label.split_once("╰── ")
    {
        *marks = format!("{} {words}", marks.trim_end());
        lines.truncate(2);
    }
    lines
}

/// What miette is asked to draw.
struct Snippet {
    line: OneLine,
    labels: Vec<LabeledSpan>,
}

/// A source of one line, given back whole whatever is asked.
struct OneLine(String);

impl SourceCode for OneLine {
    fn read_span<'a>(&'a self, _: &SourceSpan, _: usize, _: usize) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let span = SourceSpan::from((0, self.0.len()));
        Ok(Box::new(MietteSpanContents::new(self.0.as_bytes(), span, 0, 0, 1)))
    }
}

impl std::fmt::Debug for Snippet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("snippet")
    }
}

impl std::fmt::Display for Snippet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("snippet")
    }
}

impl std::error::Error for Snippet {}

impl miette::Diagnostic for Snippet {
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }
    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.line)
    }
}

/// Colours, or none.
struct Paint {
    on: bool,
    severity: Severity,
}

impl Paint {
    fn with(&self, code: &str, text: &str) -> String {
        if self.on { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }

    fn strong(&self) -> &'static str {
        match self.severity {
            Severity::Error => "1;31",
            Severity::Warning => "1;33",
            Severity::Note => "1;36",
        }
    }

    fn head(&self, text: &str) -> String {
        self.with(self.strong(), text)
    }

    fn frame(&self, text: &str) -> String {
        self.with("2", text)
    }

    fn label(&self, text: &str) -> String {
        self.with(&self.strong()[2..], text)
    }

    fn word(&self, text: &str) -> String {
        self.with("36", text)
    }
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
        assert!(shown.contains("  note: the same once more: hall.loft:2:1\n"));
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
        assert!(
            shown(&[one(30, 5), one(31, 3), one(32, 0)]).contains("  note: the same 10 times more: hall.loft:32:1, hall.loft:33:1, …\n")
        );
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
