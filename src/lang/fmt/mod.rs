//! Canonical layout of a script: only blanks and line ends change, and no token, string or comment does.
//!
//! ```text
//! tokens, comments → atoms → commands (one declaration at a time) → lines → columns → text
//! ```
//!
//! - A declaration stands on one line when it fits in 100 columns; the comment at its end does not count.
//! - Otherwise it is broken at its outermost brackets and commas, indented by 2, the closing bracket on a line of its own;
//!   sums and other chains before their loosest operators; `if` before `else`; the local `let` behind `in`.
//! - A comma before the closing bracket keeps the bracket open. Plain lists keep the rows of their author while open.
//! - Settings in braces stay on one line when they were, two blanks apart; else each stands on its own line.
//! - At most one free line is kept, between declarations, settings and items; comments stay where they were.
//! - `=` of neighbouring declarations of one keyword, `{` of neighbouring clauses and comments at the end of neighbouring
//!   lines stand below each other where the author set one of them off by more blanks than needed.
//! - A broken declaration stays as it is, byte for byte.

pub mod atoms;
pub mod columns;
pub mod command;
pub mod declaration;
pub mod expression;
pub mod writer;

use std::ops::Range;

use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::fmt::atoms::{Comment, CommentedFile};
use crate::lang::fmt::expression::CommandBuilder;
use crate::lang::fmt::writer::Writer;
use crate::lang::syntax;
use crate::lang::syntax::Tokens;
use crate::lang::words::names::Names;

/// A script in canonical layout.
#[derive(Clone, Debug)]
pub struct Formatted {
    /// The script; it ends with a line end unless it is empty.
    pub text: String,
    /// Whether it differs from what was given.
    pub changed: bool,
    /// Mistakes of the text, sorted by place in what was given; the declarations that hold them were left as they are.
    pub found: Vec<Diagnostic>,
}

/// Lays a script out; never fails.
///
/// `format(format(x)) == format(x)`, the tree stays the same, and so do all comments. A script of more than 32 MiB is
/// given back as it is, with the report that it is too large.
pub fn format(source: &str) -> Formatted {
    let read = syntax::read(source, FileId(0), &mut Names::default());
    if read.found.first().is_some_and(|d| d.code.0 == "E110") {
        return Formatted { text: source.to_owned(), changed: false, found: read.found };
    }
    let text = layout(source, &read.tokens, &read.sound);
    // No layout is worth a lost letter.
    let text = if letters(&text) == letters(source) { text } else { source.to_owned() };
    Formatted { changed: text != source, text, found: read.found }
}

/// Number of bytes other than blanks and line ends.
fn letters(text: &str) -> usize {
    let text = text.strip_prefix(MARK).unwrap_or(text);
    text.bytes().filter(|b| !matches!(b, b' ' | b'\t' | b'\r' | b'\n')).count()
}

/// The byte order mark.
const MARK: char = '\u{feff}';

/// Tokens that are laid out, or left as they are.
struct Part {
    tokens: Range<usize>,
    sound: bool,
}

/// The whole script as parts in order; what shares a line with another declaration is left as it is, and so is all from
/// a comment on that does not end.
fn parts(tokens: &Tokens, sound: &[Range<usize>], quiet: u32) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::with_capacity(sound.len() + 1);
    let mut push = |tokens: Range<usize>, sound: bool| {
        if tokens.is_empty() {
            return;
        }
        match parts.last_mut() {
            Some(last) if !last.sound && !sound => last.tokens.end = tokens.end,
            _ => parts.push(Part { tokens, sound }),
        }
    };
    let mut at = 0;
    for range in sound {
        push(at..range.start, false);
        let alone = tokens.first[range.start] && tokens.first.get(range.end).is_none_or(|&first| first);
        push(range.clone(), alone && tokens.ends[range.end - 1] <= quiet);
        at = range.end;
    }
    push(at..tokens.len(), false);
    parts
}

fn layout(source: &str, tokens: &Tokens, sound: &[Range<usize>]) -> String {
    let text = CommentedFile::new(source, tokens);
    let end = source.len() as u32;
    let quiet = tokens.quiet_from.map_or(end, |from| line_start(source, from));
    let mut file = FormattedFile { writer: Writer::new(&text), text: &text, comment: 0, end: None };
    let (mut atoms, mut mates, mut cmds) = (Vec::new(), Vec::new(), Vec::new());
    for part in parts(tokens, sound, quiet) {
        let start = tokens.starts[part.tokens.start];
        if !part.sound && tokens.ends[part.tokens.end - 1] > quiet {
            file.rest(start.min(tokens.quiet_from.unwrap_or(end)));
            return file.finish();
        }
        let before = file.above(start);
        if part.sound {
            file.writer.before(before, false);
            text.atoms(part.tokens.clone(), &mut file.comment, &mut atoms);
            expression::mates(&atoms, &mut mates);
            CommandBuilder::new(&atoms, &mates, &mut cmds).declaration();
            file.writer.commands(&cmds, &atoms);
            file.end = Some(tokens.ends[part.tokens.end - 1]);
        } else {
            file.verbatim(start, part.tokens.end, before);
        }
    }
    if let Some(from) = tokens.quiet_from {
        file.rest(from);
    }
    file.finish()
}

/// Start of the line that holds a byte.
fn line_start(source: &str, at: u32) -> u32 {
    source[..at as usize].rfind('\n').map_or(0, |n| n as u32 + 1)
}

struct FormattedFile<'a> {
    writer: Writer<'a>,
    text: &'a CommentedFile<'a>,
    /// First comment that is not placed yet.
    comment: usize,
    /// Where the last declaration ends.
    end: Option<u32>,
}

impl FormattedFile<'_> {
    /// Places what stands between the last declaration and the next one, which begins at `start`; gives the comments
    /// before the latter on its line.
    fn above(&mut self, start: u32) -> Range<usize> {
        let next = self.text.comment_at(self.comment, start);
        let gap = self.text.gap(self.comment..next, self.end, Some(start));
        self.comment = next;
        if !gap.trailing.is_empty() {
            self.writer.trailing(gap.trailing, self.end.unwrap_or(0));
        }
        let first = gap.before.clone().next().map_or(start, |c| self.text.comments[c].start);
        self.writer.end_line(gap.blank);
        self.writer.own(gap.own, gap.blank, Some(first));
        gap.before
    }

    /// A broken declaration, which ends before token `end`, with its line's indentation and the comments at its end.
    fn verbatim(&mut self, start: u32, end: usize, before: Range<usize>) {
        let next = self.text.tokens.starts.get(end).copied().unwrap_or(u32::MAX);
        let end = self.text.tokens.ends[end - 1];
        self.writer.before(before, false);
        let mut last = end;
        self.comment = self.text.comment_at(self.comment, end);
        let is_trailing = |c: &Comment, last: u32| c.start < next && !self.text.has_line_end(last, c.start);
        while let Some(comment) = self.text.comments.get(self.comment).filter(|c| is_trailing(c, last)) {
            last = comment.end;
            self.comment += 1;
        }
        self.writer.verbatim(self.text.str(self.indented(start), last));
        self.end = Some(last);
    }

    /// All from a byte on as it is.
    fn rest(&mut self, start: u32) {
        let start = self.indented(start);
        let before = self.above(start);
        self.writer.before(before, false);
        let rest = self.text.source[start as usize..].trim_end_matches([' ', '\t', '\r', '\n']);
        self.writer.verbatim(rest);
        self.comment = self.text.comments.len();
        self.end = Some(self.text.source.len() as u32);
    }

    /// The start of the line of what begins at a byte when only blanks stand before it, else that byte.
    fn indented(&self, start: u32) -> u32 {
        let line = line_start(self.text.source, start);
        let before = self.text.str(line, start);
        let blanks = before.trim_start_matches(MARK);
        let bare = blanks.bytes().all(|b| matches!(b, b' ' | b'\t' | b'\r'));
        if bare { line + (before.len() - blanks.len()) as u32 } else { start }
    }

    fn finish(mut self) -> String {
        let gap = self.text.gap(self.comment..self.text.comments.len(), self.end, None);
        if !gap.trailing.is_empty() {
            self.writer.trailing(gap.trailing, self.end.unwrap_or(0));
        }
        self.writer.end_line(gap.blank);
        self.writer.own(gap.own, gap.blank, None);
        let mut text = columns::align(self.writer);
        if !text.is_empty() {
            text.push('\n');
        }
        text
    }
}
