//! A session from a pipe: where one entry ends and the next begins, and transcripts of sessions.

use super::{notebook, text_of};
use crate::lang::syntax::outline::outline;
use crate::session::notebook::Notebook;

/// What starts a line of input in a transcript.
const INPUT: &str = "> ";
/// What starts a further line of the same entry.
const MORE: &str = ". ";

/// Cuts a text into entries: a command is a line; everything else goes on while something is open, but not beyond a
/// line that starts with a keyword.
pub fn entries(text: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut open = String::new();
    for line in text.lines() {
        if !open.is_empty() {
            // Comments go with what follows.
            if outline(&open).is_empty() || !begins(line) && Notebook::is_unfinished(&open) {
                open.push('\n');
                open.push_str(line);
                continue;
            }
            out.push(std::mem::take(&mut open));
        }
        if line.trim().is_empty() {
            continue;
        }
        match line.trim_start().starts_with(':') {
            true => out.push(line.trim().to_owned()),
            false => open = line.to_owned(),
        }
    }
    if !open.trim().is_empty() {
        out.push(open);
    }
    out
}

/// Whether a line starts with a keyword or a command, without a blank before it.
fn begins(line: &str) -> bool {
    let first = line.chars().next();
    first == Some(':') || first.is_some_and(|c| !c.is_whitespace()) && outline(line).first().is_some_and(|o| o.keyword.is_some())
}

/// Plays a transcript: keeps its lines of input (`> ` and `. `), and puts what is answered now below each entry.
pub fn transcript(text: &str) -> String {
    let mut notebook = notebook(false);
    let mut out = String::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        if line.starts_with("//") {
            out.push_str(line);
            out.push('\n');
            continue;
        }
        let Some(first) = line.strip_prefix(INPUT) else { continue };
        let mut entry = first.to_owned();
        out.push_str(line);
        out.push('\n');
        while let Some(more) = lines.next_if(|next| next.starts_with(MORE.trim_end())) {
            entry.push('\n');
            entry.push_str(more.strip_prefix(MORE).unwrap_or(""));
            out.push_str(more);
            out.push('\n');
        }
        let answer = notebook.enter(&entry);
        out.push_str(&text_of(&answer, false));
        if answer.failed {
            out.push_str("(failed)\n");
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::entries;

    #[test]
    fn entries_end_where_they_are_complete() {
        let text = "curve a = line(\n  (0, 0, 0),\n  (1, 0, 0))\na.length\n:nodes\n\nlet x = (1\ncurve b = a\n/// Doc.\nlet y = 2\n";
        let found = entries(text);
        assert_eq!(
            found,
            ["curve a = line(\n  (0, 0, 0),\n  (1, 0, 0))", "a.length", ":nodes", "let x = (1", "curve b = a", "/// Doc.\nlet y = 2"]
        );
    }
}
