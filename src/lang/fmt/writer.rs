//! Commands to lines.

use std::ops::Range;

use crate::lang::fmt::atoms::{Atom, CommentedFile, width};
use crate::lang::fmt::command::Cmd;

/// Columns of a line, the comment at its end aside.
pub(crate) const COLUMNS: u32 = 100;
/// Blanks of one indentation.
const INDENT: u32 = 2;

/// What is known of a written line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// Its first byte.
    pub start: u32,
    /// Its indentation.
    pub indent: u32,
    /// Where the comment at its end begins; [`NOWHERE`] without one.
    pub comment: u32,
    /// Where its mark stands; [`NOWHERE`] without one.
    pub mark: u32,
    /// Kind of its mark; 0 without one.
    pub kind: u8,
    /// The author set the comment, the mark off by more blanks than needed.
    pub wide_comment: bool,
    pub wide_mark: bool,
    /// It holds a comment alone, or text as it was.
    pub apart: bool,
}

/// No place in a line.
pub(crate) const NOWHERE: u32 = u32::MAX;

/// The text that grows, and what is known of its lines.
pub(crate) struct Writer<'a> {
    text: &'a CommentedFile<'a>,
    pub out: String,
    pub lines: Vec<Line>,
    column: u32,
    indent: u32,
    /// Line ends to be written before the next text.
    pending: u8,
    /// The next line begins where a comment forced it to, in the middle of something.
    loose: bool,
    /// For each open group whether its lines end.
    broken: Vec<bool>,
    /// The line of the last mark.
    marked: usize,
    measures: Measures,
}

/// Widths of the commands of a declaration.
#[derive(Default)]
struct Measures {
    /// Columns from the first command to each one when no line ends.
    at: Vec<u32>,
    /// The command that closes a group or ends the piece behind a [`Cmd::Fill`], and the columns behind it up to the next place where the line may end.
    close: Vec<u32>,
    tail: Vec<u32>,
    /// Groups whose lines must end.
    forced: Vec<bool>,
    stack: Vec<usize>,
    /// Groups with a [`Cmd::Fill`] whose piece has not ended.
    pieces: Vec<(usize, usize)>,
}

impl Measures {
    fn measure(&mut self, cmds: &[Cmd], atoms: &[Atom]) {
        for list in [&mut self.at, &mut self.close, &mut self.tail] {
            list.clear();
            list.resize(cmds.len() + 1, 0);
        }
        self.forced.clear();
        self.forced.resize(cmds.len(), false);
        self.stack.clear();
        self.pieces.clear();
        let (mut low, mut ends) = (0, false);
        for (k, cmd) in cmds.iter().enumerate() {
            let mut columns = 0;
            match *cmd {
                Cmd::Text(atom) => {
                    let atom = &atoms[atom as usize];
                    columns = atom.width;
                    if ends {
                        self.force(low);
                    }
                    (low, ends) = (self.stack.len(), atom.ends_line);
                }
                Cmd::Own(_) => ends = true,
                Cmd::Blank => columns = 1,
                Cmd::Fill { .. } => {
                    columns = 1;
                    self.end_piece(k);
                    self.pieces.extend(self.stack.last().map(|&open| (open, k)));
                }
                Cmd::Break { flat, .. } => columns = u32::from(flat),
                Cmd::Open { force } => {
                    self.stack.push(k);
                    if force {
                        self.force(self.stack.len());
                    }
                }
                Cmd::Close => {
                    self.end_piece(k);
                    if let Some(open) = self.stack.pop() {
                        self.close[open] = k as u32;
                    }
                    low = low.min(self.stack.len());
                }
                _ => {}
            }
            self.at[k + 1] = self.at[k] + columns;
        }
        let mut next = self.at[cmds.len()];
        for k in (0..cmds.len()).rev() {
            if matches!(cmds[k], Cmd::Break { .. } | Cmd::Fill { .. }) {
                next = self.at[k];
            }
            self.tail[k] = next - self.at[k];
        }
    }

    /// Ends the piece behind the last [`Cmd::Fill`] of the group at hand.
    fn end_piece(&mut self, end: usize) {
        if let Some(&(_, fill)) = self.pieces.last().filter(|piece| Some(&piece.0) == self.stack.last()) {
            self.close[fill] = end as u32;
            self.pieces.pop();
        }
    }

    fn force(&mut self, groups: usize) {
        for &open in self.stack[..groups].iter().rev() {
            if self.forced[open] {
                break;
            }
            self.forced[open] = true;
        }
    }

    /// Columns of a group and of what cannot be parted from it.
    fn of_group(&self, open: usize) -> u32 {
        let close = self.close[open] as usize;
        self.at[close] - self.at[open] + self.tail[close]
    }
}

impl<'a> Writer<'a> {
    pub fn new(text: &'a CommentedFile<'a>) -> Self {
        let out = String::with_capacity(text.source.len() + text.source.len() / 8);
        let mut writer = Self {
            text,
            out,
            lines: Vec::new(),
            column: 0,
            indent: 0,
            pending: 0,
            loose: false,
            broken: Vec::new(),
            marked: 0,
            measures: Measures::default(),
        };
        writer.line();
        writer
    }

    fn line(&mut self) {
        let start = self.out.len() as u32;
        let (comment, mark) = (NOWHERE, NOWHERE);
        self.lines.push(Line { start, indent: 0, comment, mark, kind: 0, wide_comment: false, wide_mark: false, apart: false });
        self.column = 0;
    }

    /// Ends the line before the next text; `blank` leaves a line free.
    pub fn end_line(&mut self, blank: bool) {
        self.pending = self.pending.max(1 + u8::from(blank));
        self.loose = false;
    }

    /// Writes the line ends that wait, and the indentation.
    fn begin(&mut self) {
        if self.pending > 0 {
            if !self.out.is_empty() {
                for _ in 0..self.pending {
                    self.out.push('\n');
                    self.line();
                }
            }
            self.pending = 0;
            let indent = self.indent + if self.loose { INDENT } else { 0 };
            self.loose = false;
            self.out.extend(std::iter::repeat_n(' ', indent as usize));
            self.column = indent;
            if let Some(line) = self.lines.last_mut() {
                line.indent = indent;
            }
        }
    }

    /// Writes a text that may hold line ends.
    fn write(&mut self, text: &str) {
        self.begin();
        let mut parts = text.split('\n');
        let first = parts.next().unwrap_or_default();
        self.out.push_str(first);
        self.column += width(first);
        for part in parts {
            self.out.push('\n');
            self.line();
            self.out.push_str(part);
            self.column = width(part);
            self.apart();
        }
    }

    fn apart(&mut self) {
        if let Some(line) = self.lines.last_mut() {
            line.apart = true;
        }
    }

    /// Text as it is, on lines of its own.
    pub fn verbatim(&mut self, text: &str) {
        self.begin();
        self.apart();
        self.write(text);
    }

    /// Comments before something on its line.
    ///
    /// `glued`: nothing stands between the last one and what it belongs to.
    pub fn before(&mut self, comments: Range<usize>, glued: bool) {
        let end = comments.end;
        for comment in comments {
            self.begin();
            if self.column > 0 && !self.out.ends_with([' ', '\n', '(', '[']) {
                self.write(" ");
            }
            self.write(&self.text.comment(self.text.comments[comment]));
            if !glued || comment + 1 < end {
                self.write(" ");
            }
        }
    }

    /// Comments at the end of a line; `end` is where the text before them ends.
    pub fn trailing(&mut self, comments: Range<usize>, end: u32) {
        let Some(&first) = self.text.comments.get(comments.start) else { return };
        // A comment that went behind its comma stood before it.
        let gap = self.text.str(end.min(first.start), first.start);
        if let Some(line) = self.lines.last_mut() {
            if line.comment == NOWHERE {
                line.comment = self.out.len() as u32;
                line.wide_comment = gap.len() > 2 || gap.contains('\t');
            } else {
                self.out.push(' ');
            }
        }
        for (n, comment) in comments.enumerate() {
            if n > 0 {
                self.write(" ");
            }
            self.write(&self.text.comment(self.text.comments[comment]));
        }
        self.pending = self.pending.max(1);
        self.loose = true;
    }

    /// Comments on lines of their own; `blank` tells whether a free line stands before them, `next` where what they
    /// stand above begins.
    pub fn own(&mut self, comments: Range<usize>, blank: bool, next: Option<u32>) {
        let mut free = blank;
        for k in comments.clone() {
            let comment = self.text.comments[k];
            if self.pending < 1 + u8::from(free) {
                let loose = self.loose || self.pending == 0;
                self.end_line(free);
                self.loose = loose && self.indent > 0;
            }
            self.begin();
            self.apart();
            self.write(&self.text.comment(comment));
            let behind = if k + 1 < comments.end { Some(self.text.comments[k + 1].start) } else { next };
            let documents = comment.doc && (k + 1 == comments.end || self.text.comments[k + 1].doc);
            free = !documents && behind.is_some_and(|behind| self.text.has_blank_line(comment.end, behind));
            self.end_line(free);
        }
    }

    /// Writes a declaration.
    pub fn commands(&mut self, cmds: &[Cmd], atoms: &[Atom]) {
        let mut measures = std::mem::take(&mut self.measures);
        measures.measure(cmds, atoms);
        self.indent = 0;
        self.broken.clear();
        self.marked = usize::MAX;
        for (k, cmd) in cmds.iter().enumerate() {
            match *cmd {
                Cmd::Text(atom) => self.atom(&atoms[atom as usize]),
                Cmd::Own(atom) => {
                    let atom = &atoms[atom as usize];
                    let next = atom.before.clone().next().map_or(atom.start, |c| self.text.comments[c].start);
                    self.own(atom.own.clone(), false, Some(next));
                }
                Cmd::Blank => self.blanks(1),
                Cmd::Break { keep, .. } if self.broken.last() == Some(&true) => self.end_line(keep),
                Cmd::Break { flat, .. } => self.blanks(flat),
                Cmd::Fill { fresh } => {
                    let broken = self.broken.last() == Some(&true);
                    let piece = measures.at[measures.close[k] as usize] - measures.at[k];
                    if broken && (fresh || self.column + piece > COLUMNS) { self.end_line(false) } else { self.blanks(1) }
                }
                Cmd::Open { .. } => {
                    let column = if self.pending > 0 { self.indent } else { self.column };
                    let flat_around = self.broken.last() == Some(&false);
                    let fits = flat_around || column + measures.of_group(k) <= COLUMNS;
                    self.broken.push(measures.forced[k] || !fits);
                }
                Cmd::Close => drop(self.broken.pop()),
                Cmd::In => self.indent += INDENT,
                Cmd::Out => self.indent = self.indent.saturating_sub(INDENT),
                Cmd::Mark { kind, wide } => self.mark(kind, wide),
                Cmd::MarkEnd => self.check_mark(),
                Cmd::Nothing => {}
            }
        }
        self.indent = 0;
        self.measures = measures;
    }

    fn blanks(&mut self, count: u8) {
        if self.pending == 0 {
            for _ in 0..count {
                self.out.push(' ');
            }
            self.column += u32::from(count);
        }
    }

    fn atom(&mut self, atom: &Atom) {
        self.begin();
        self.before(atom.before.clone(), atom.closes());
        self.out.push_str(self.text.str(atom.start, atom.end));
        self.column += width(self.text.str(atom.start, atom.end));
        if atom.ends_line {
            self.trailing(atom.after.clone(), atom.end);
        } else {
            for comment in atom.after.clone() {
                self.write(" ");
                self.write(&self.text.comment(self.text.comments[comment]));
            }
        }
    }

    fn mark(&mut self, kind: u8, wide: bool) {
        self.begin();
        let mark = self.out.len() as u32;
        self.marked = usize::MAX;
        if let Some(line) = self.lines.last_mut().filter(|l| l.kind == 0 && !l.apart && (kind > 1 || l.indent > 0)) {
            (line.mark, line.kind, line.wide_mark) = (mark, kind, wide);
            self.marked = self.lines.len() - 1;
        }
    }

    /// Lines that are part of a longer text share no column.
    fn check_mark(&mut self) {
        let last = self.lines.len() - 1;
        if self.marked < last {
            let line = &mut self.lines[self.marked];
            (line.mark, line.kind) = (NOWHERE, 0);
        }
        self.marked = usize::MAX;
    }
}
