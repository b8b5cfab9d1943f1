//! Lines to text: columns that neighbouring lines share, and the blanks before comments.

use std::ops::Range;

use crate::lang::fmt::atoms::width;
use crate::lang::fmt::writer::{COLUMNS, Line, NOWHERE, Writer};

/// Blanks before a comment at the end of a line.
const APART: u32 = 2;

/// The text with its columns.
pub(crate) fn align(writer: Writer<'_>) -> String {
    let Writer { out, lines, .. } = writer;
    if lines.iter().all(|l| l.comment == NOWHERE && !l.wide_mark) {
        return out;
    }
    let mut columns = Columns { text: &out, lines: &lines, marks: vec![0; lines.len()], comments: vec![0; lines.len()] };
    runs(&lines, |a, b| a.kind == b.kind && a.kind > 0 && a.indent == b.indent, |run| columns.align_marks(run));
    runs(&lines, |a, b| a.indent == b.indent && !b.apart && !a.apart, |run| columns.align_comments(run));
    let Columns { marks, comments, .. } = columns;
    let mut padded = String::with_capacity(out.len() + out.len() / 8);
    let mut written = 0;
    let mut until = |padded: &mut String, place: u32, blanks: u32| {
        padded.push_str(&out[written..place as usize]);
        padded.extend(std::iter::repeat_n(' ', blanks as usize));
        written = place as usize;
    };
    for (at, line) in lines.iter().enumerate() {
        if marks[at] > 0 {
            until(&mut padded, line.mark, marks[at]);
        }
        if line.comment != NOWHERE {
            until(&mut padded, line.comment, comments[at]);
        }
    }
    until(&mut padded, out.len() as u32, 0);
    padded
}

/// Calls `work` with each run of neighbouring lines that are not free and belong together.
fn runs(lines: &[Line], joined: impl Fn(&Line, &Line) -> bool, mut work: impl FnMut(Range<usize>)) {
    let mut start = 0;
    for at in 1..=lines.len() {
        if at == lines.len() || !joined(&lines[at - 1], &lines[at]) {
            work(start..at);
            start = at;
        }
    }
}

struct Columns<'a> {
    text: &'a str,
    lines: &'a [Line],
    /// Blanks before the mark and the comment of each line.
    marks: Vec<u32>,
    comments: Vec<u32>,
}

impl Columns<'_> {
    /// Columns from the start of a line to a place in it.
    fn columns(&self, at: usize, place: u32) -> u32 {
        width(&self.text[self.lines[at].start as usize..place as usize])
    }

    /// Where the code of a line ends.
    fn code_end(&self, at: usize) -> u32 {
        let line = &self.lines[at];
        let end = self.lines.get(at + 1).map_or(self.text.len() as u32, |next| next.start - 1);
        line.comment.min(end)
    }

    /// Marks stand below each other where the author began to, and no line grows too long by it.
    fn align_marks(&mut self, run: Range<usize>) {
        let marked = |at: &usize| self.lines[*at].mark != NOWHERE;
        if !run.clone().any(|at| self.lines[at].wide_mark) {
            return;
        }
        let places: Vec<(usize, u32)> = run.filter(marked).map(|at| (at, self.columns(at, self.lines[at].mark))).collect();
        let column = places.iter().map(|p| p.1).max().unwrap_or(0);
        let fits = places.iter().all(|&(at, place)| self.columns(at, self.code_end(at)) + column - place <= COLUMNS);
        if fits {
            places.iter().for_each(|&(at, place)| self.marks[at] = column - place);
        }
    }

    /// Comments stand below each other where the author began to.
    fn align_comments(&mut self, run: Range<usize>) {
        let aligned = run.clone().any(|at| self.lines[at].wide_comment);
        let places: Vec<(usize, u32)> = run
            .filter(|&at| self.lines[at].comment != NOWHERE)
            .map(|at| (at, self.columns(at, self.lines[at].comment) + self.marks[at]))
            .collect();
        let column = if aligned { places.iter().map(|p| p.1).max().unwrap_or(0) } else { 0 };
        places.iter().for_each(|&(at, place)| self.comments[at] = column.max(place) - place + APART);
    }
}
