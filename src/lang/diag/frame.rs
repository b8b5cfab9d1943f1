//! The lines of a script that carry labels, in a frame.
//!
//! miette is handed only these lines, long ones cut to a window around their labels: it cannot format beyond
//! column 65 535, and nobody reads that far. It counts columns in bytes, so the place in the frame is ours.

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use crate::base::visible::visible;
use crate::lang::diag::diagnostic::{Label, SourceFile};
use crate::lang::diag::paint::{Colors, shortened};

/// Characters of a line shown before and behind its labels when it is long.
const WINDOW: usize = 100;
/// Bytes of the longest line that is shown whole.
const WHOLE_LINE: usize = 500;

/// The labelled lines of one file in a frame.
pub(super) fn frame(text: &mut String, source: &SourceFile, labels: &[&Label], number: usize, paint: &Colors) {
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

/// One line of the script as it is shown, with its labels in bytes of the shown text.
struct Row {
    index: usize,
    text: String,
    labels: Vec<(usize, usize, String)>,
}

impl Row {
    /// Nothing in the line steers the terminal, and labels stand where they did.
    fn show(&mut self) {
        let at = |at: &mut usize| *at = visible(&self.text[..*at]).len();
        self.labels.iter_mut().flat_map(|(from, to, _)| [from, to]).for_each(at);
        self.text = visible(&self.text).into_owned();
    }

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

/// From and to within a line, with the words.
type LabelSpan = (usize, usize, String);

/// The lines that carry labels, in order. A label over several lines marks what it covers of its first one.
fn rows(source: &SourceFile, labels: &[&Label]) -> Vec<Row> {
    let mut by_line: Vec<(usize, Vec<LabelSpan>)> = Vec::new();
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
            row.show();
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
    let mut tiers: Vec<Vec<LabelSpan>> = Vec::new();
    let mut marks: Vec<&LabelSpan> = row.labels.iter().collect();
    marks.sort_by_key(|(from, to, _)| (to - from, *from));
    for mark in marks {
        let free = |tier: &Vec<LabelSpan>| tier.iter().all(|other| mark.1 <= other.0 || other.1 <= mark.0);
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
