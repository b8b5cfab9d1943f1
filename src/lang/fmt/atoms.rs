//! The tokens of a declaration with their comments: what the layout is made of.
//!
//! A comment belongs to the token it follows on its line, to the token it stands before on its line, or to the token
//! below it. The layout keeps these three apart, which is why it may be done again without a change.

use std::ops::Range;

use crate::base::text::columns;
use crate::lang::syntax::{Kind, Tokens};

/// A comment, `///` lines included.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Comment {
    pub start: u32,
    pub end: u32,
    /// `/// …` that begins a line.
    pub doc: bool,
}

/// One token, or a whole string with all that is interpolated in it.
#[derive(Clone, Debug)]
pub(crate) struct Atom {
    pub kind: Kind,
    pub start: u32,
    pub end: u32,
    /// Columns it takes with the comments around it that stay on its line.
    pub width: u32,
    /// Comments on lines of their own above it.
    pub own: Range<usize>,
    /// Comments before it on its line.
    pub before: Range<usize>,
    /// Comments behind it on its line.
    pub after: Range<usize>,
    /// The line ends behind `after`.
    pub ends_line: bool,
    /// First of its line.
    pub fresh: bool,
    /// A blank line stands before it, or before the comments above it.
    pub blank: bool,
    /// Blanks before it, or before the comments in front of it, on its line; 0 when it is the first.
    pub gap: u32,
}

impl Atom {
    /// Whether it closes a bracket.
    pub fn closes(&self) -> bool {
        matches!(self.kind, Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly)
    }

    /// Whether no comment belongs to it.
    pub fn is_bare(&self) -> bool {
        self.own.is_empty() && self.before.is_empty() && self.after.is_empty()
    }
}

/// What stands between two tokens.
#[derive(Debug, Default)]
pub(crate) struct Gap {
    pub trailing: Range<usize>,
    pub own: Range<usize>,
    pub before: Range<usize>,
    pub blank: bool,
}

/// A file with its comments in order.
pub(crate) struct CommentedFile<'a> {
    pub source: &'a str,
    pub tokens: &'a Tokens,
    pub comments: Vec<Comment>,
}

/// Columns of a text on a screen; beyond any line when it has several.
pub(crate) fn width(text: &str) -> u32 {
    if text.is_ascii() {
        return if text.len() > 120 && text.contains('\n') { MANY } else { text.len() as u32 };
    }
    if text.contains('\n') { MANY } else { columns(text) as u32 }
}

/// More columns than any line has.
const MANY: u32 = 10_000;

impl<'a> CommentedFile<'a> {
    pub fn new(source: &'a str, tokens: &'a Tokens) -> Self {
        let docs = tokens.docs.iter().map(|&(_, span)| Comment { start: span.start - 3, end: span.end, doc: true });
        let others = tokens.comments.iter().map(|span| Comment { start: span.start, end: span.end, doc: false });
        let mut comments: Vec<Comment> = others.chain(docs).collect();
        comments.sort_unstable_by_key(|c| c.start);
        Self { source, tokens, comments }
    }

    pub fn str(&self, start: u32, end: u32) -> &'a str {
        &self.source[start as usize..end as usize]
    }

    /// Text of a comment as it is printed: LF only, nothing blank at its end.
    pub fn comment(&self, comment: Comment) -> std::borrow::Cow<'a, str> {
        let text = self.str(comment.start, comment.end).trim_end_matches([' ', '\t', '\r']);
        if text.contains("\r\n") { text.replace("\r\n", "\n").into() } else { text.into() }
    }

    /// The first comment that begins at or behind a byte, looked for from `from` on.
    pub fn comment_at(&self, mut from: usize, byte: u32) -> usize {
        while self.comments.get(from).is_some_and(|c| c.start < byte) {
            from += 1;
        }
        from
    }

    pub fn has_line_end(&self, start: u32, end: u32) -> bool {
        self.source.as_bytes()[start as usize..end as usize].contains(&b'\n')
    }

    /// Whether a blank line stands in a stretch without comments.
    pub fn has_blank_line(&self, start: u32, end: u32) -> bool {
        self.source.as_bytes()[start as usize..end as usize].iter().filter(|&&b| b == b'\n').count() > 1
    }

    /// Sorts the comments between two tokens; `end` is where the one before ends, `None` at the start of the file, and
    /// `start` where the next one begins, `None` at its end.
    pub fn gap(&self, comments: Range<usize>, end: Option<u32>, start: Option<u32>) -> Gap {
        let (mut low, mut last) = (comments.start, end.unwrap_or(0));
        while end.is_some() && low < comments.end && !self.has_line_end(last, self.comments[low].start) {
            last = self.comments[low].end;
            low += 1;
        }
        let (mut high, mut next) = (comments.end, start.unwrap_or(self.source.len() as u32));
        while start.is_some() && high > comments.start && !self.has_line_end(self.comments[high - 1].end, next) {
            high -= 1;
            next = self.comments[high].start;
        }
        let low = low.min(high);
        let behind = if low > comments.start { self.comments[low - 1].end } else { end.unwrap_or(0) };
        let ahead = if low < comments.end { self.comments[low].start } else { next };
        Gap { trailing: comments.start..low, own: low..high, before: high..comments.end, blank: self.has_blank_line(behind, ahead) }
    }

    /// The atoms of a sound declaration. `comment` is the first comment not yet placed, and is moved behind the last
    /// one in the declaration; the comments before its first token are left to the caller.
    pub fn atoms(&self, tokens: Range<usize>, comment: &mut usize, atoms: &mut Vec<Atom>) {
        atoms.clear();
        let mut at = tokens.start;
        while at < tokens.end {
            let last = self.string_end(at);
            let kind = if last > at { Kind::Text } else { self.tokens.kinds[at] };
            let (start, end) = (self.tokens.starts[at], self.tokens.ends[last]);
            let from = self.comment_at(*comment, atoms.last().map_or(start, |a| a.end));
            let to = self.comment_at(from, start);
            let mut atom = Atom {
                kind,
                start,
                end,
                width: 0,
                own: 0..0,
                before: 0..0,
                after: 0..0,
                ends_line: false,
                fresh: self.tokens.first[at],
                blank: false,
                gap: 0,
            };
            if let Some(before) = atoms.last_mut() {
                self.between(before, &mut atom, from..to);
            }
            atoms.push(atom);
            *comment = self.comment_at(to, end);
            at = last + 1;
        }
        move_to_commas(atoms);
        for atom in atoms {
            atom.width = width(self.str(atom.start, atom.end));
            let kept = if atom.ends_line { 0..0 } else { atom.after.clone() };
            atom.width += kept.chain(atom.before.clone()).map(|c| 1 + width(&self.comment(self.comments[c]))).sum::<u32>();
        }
    }

    fn between(&self, before: &mut Atom, atom: &mut Atom, comments: Range<usize>) {
        if comments.is_empty() {
            atom.blank = atom.fresh && self.has_blank_line(before.end, atom.start);
            atom.gap = if atom.fresh { 0 } else { atom.start - before.end };
            return;
        }
        let gap = self.gap(comments, Some(before.end), Some(atom.start));
        (before.after, before.ends_line) = (gap.trailing.clone(), !gap.trailing.is_empty());
        (atom.own, atom.before, atom.blank) = (gap.own, gap.before, gap.blank);
        // A column is in front of the comments that belong to what stands in it.
        let first = atom.before.clone().next().map(|first| self.comments[first].start);
        let beside = first.filter(|start| gap.trailing.is_empty() && atom.own.is_empty() && !self.has_line_end(before.end, *start));
        atom.gap = beside.map_or(0, |start| start - before.end);
        if atom.kind == Kind::Comma && gap.trailing.is_empty() && atom.own.is_empty() {
            before.after = std::mem::take(&mut atom.before);
        }
    }

    /// The last token of the string that begins with a token, or the token itself.
    fn string_end(&self, at: usize) -> usize {
        if self.tokens.kinds[at] != Kind::TextHead {
            return at;
        }
        let (mut depth, mut last) = (0usize, at);
        for (n, kind) in self.tokens.kinds[at..].iter().enumerate() {
            match kind {
                Kind::TextHead => depth += 1,
                Kind::TextTail => depth -= 1,
                _ => {}
            }
            last = at + n;
            if depth == 0 {
                break;
            }
        }
        last
    }
}

/// A comment that ends the line before a comma goes behind the comma.
fn move_to_commas(atoms: &mut [Atom]) {
    for at in 1..atoms.len() {
        let (left, right) = atoms.split_at_mut(at);
        let (before, comma) = (&mut left[at - 1], &mut right[0]);
        if comma.kind == Kind::Comma && before.ends_line && comma.is_bare() {
            comma.after = std::mem::take(&mut before.after);
            (comma.ends_line, before.ends_line) = (true, false);
        }
    }
}
