//! The line being edited: colours, completion, hints, and whether it goes on. Nothing here evaluates.

use std::borrow::Cow;

use rustyline::completion::{Completer, Pair};
use rustyline::highlight::{CmdKind, Highlighter};
use rustyline::hint::Hinter;
use rustyline::validate::{ValidationContext, ValidationResult, Validator};
use rustyline::{Context, Helper};

use super::complete::{Session, candidates};
use crate::base::text::columns;
use crate::lang::syntax::outline::{Paint, painted};
use crate::session::notebook::Notebook;

/// Longest text that is coloured while it is edited.
const COLOURED: usize = 20_000;

/// What the editor knows of the session.
pub struct Line {
    session: Session,
    color: bool,
    /// Columns of the terminal beside the prompt.
    columns: usize,
}

impl Line {
    pub fn new(color: bool) -> Self {
        Self { session: Session::default(), color, columns: usize::MAX }
    }

    /// Takes over what is in the session, and how many columns the terminal has beside the prompt.
    pub fn learn(&mut self, notebook: &Notebook, columns: usize) {
        self.columns = columns;
        self.session = Session::of(notebook);
    }
}

impl Helper for Line {}

impl Validator for Line {
    fn validate(&self, context: &mut ValidationContext) -> rustyline::Result<ValidationResult> {
        // An empty last line ends whatever is open.
        let ends = context.input().ends_with("\n\n");
        Ok(if !ends && Notebook::is_unfinished(context.input()) { ValidationResult::Incomplete } else { ValidationResult::Valid(None) })
    }
}

impl Completer for Line {
    type Candidate = Pair;

    fn complete(&self, line: &str, at: usize, _: &Context<'_>) -> rustyline::Result<(usize, Vec<Pair>)> {
        Ok(candidates(&line[..at], &self.session))
    }
}

impl Hinter for Line {
    type Hint = String;

    fn hint(&self, line: &str, at: usize, _: &Context<'_>) -> Option<String> {
        if at < line.len() || line.is_empty() {
            return None;
        }
        let used = line.lines().last().map_or(0, columns);
        let call = self.session.call(line)?;
        Some(fitting(format!("   {}", call.signature), self.columns.saturating_sub(used + 1)))
    }
}

/// A hint that stays on its line, with `…` for what has no room.
fn fitting(hint: String, room: usize) -> String {
    if columns(&hint) <= room {
        return hint;
    }
    let kept: String = hint.chars().take(room.saturating_sub(1)).collect();
    if kept.trim().is_empty() { String::new() } else { kept + "…" }
}

impl Highlighter for Line {
    fn highlight<'l>(&self, line: &'l str, _: usize) -> Cow<'l, str> {
        if !self.color || line.len() > COLOURED || line.trim_start().starts_with(':') {
            return Cow::Borrowed(line);
        }
        let mut out = String::with_capacity(line.len() * 2);
        let mut done = 0;
        for (span, paint) in painted(line) {
            let (start, end) = (span.start as usize, (span.end as usize).min(line.len()));
            if start < done || end <= start {
                continue;
            }
            out.push_str(&line[done..start]);
            let code = match paint {
                Paint::Keyword => "1;34",
                Paint::Function => "36",
                Paint::Property => "35",
                Paint::Number | Paint::Constant => "33",
                Paint::Text => "32",
                Paint::Comment => "2",
                Paint::Name | Paint::Operator => "",
            };
            if code.is_empty() {
                out.push_str(&line[start..end]);
            } else {
                out.push_str(&format!("\u{1b}[{code}m{}\u{1b}[0m", &line[start..end]));
            }
            done = end;
        }
        out.push_str(&line[done..]);
        Cow::Owned(out)
    }

    fn highlight_hint<'h>(&self, hint: &'h str) -> Cow<'h, str> {
        if self.color { Cow::Owned(format!("\u{1b}[2m{hint}\u{1b}[0m")) } else { Cow::Borrowed(hint) }
    }

    fn highlight_char(&self, _: &str, _: usize, _: CmdKind) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hints_stay_on_their_line() {
        assert_eq!(fitting("   line(from: point)".to_owned(), 40), "   line(from: point)");
        let cut = fitting("   line(from: point)".to_owned(), 12);
        assert_eq!((cut.as_str(), cut.chars().count()), ("   line(fro…", 12));
        assert_eq!(fitting("   line(from: point)".to_owned(), 3), "");
        assert_eq!(fitting("   line(from: point)".to_owned(), 0), "");
    }
}
