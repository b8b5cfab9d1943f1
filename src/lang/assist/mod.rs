//! Help while typing: what may stand at a place of a text, and what a word there means.
//!
//! Everything is found in the text, in the modules it names and in what the last run showed; nothing is evaluated. So it
//! works in half-typed text, at once, and for session and language server alike.

pub mod around;
pub mod frames;
pub mod function;
pub mod hover;
pub mod infer;
pub mod offer;
pub mod place;
pub mod scripts;
pub mod shape;

pub use crate::lang::assist::function::{Function, Parameter};
pub use crate::lang::assist::hover::{About, hover_text};
pub use crate::lang::assist::offer::{Candidate, Offer, Sort};
pub use crate::lang::assist::scripts::{Known, OpenFile};
pub use crate::lang::assist::shape::KnownType;

use crate::lang::assist::scripts::Scripts;

/// Longest text that is looked at while it is typed.
pub const LONGEST: usize = 4 << 20;

/// A text, and what is around it.
#[derive(Clone, Copy)]
pub struct EditedScript<'s> {
    /// The text as it stands.
    pub text: &'s str,
    /// Its path, as [`OpenFile`] takes it.
    pub path: &'s str,
    /// Reads modules.
    pub open: OpenFile<'s>,
    /// What the last run showed.
    pub known: &'s Known,
    /// A line of a session, which may also be an expression.
    pub session: bool,
}

impl EditedScript<'_> {
    fn read(&self) -> Scripts<'_> {
        Scripts::new(self.text, self.path, self.open, self.known)
    }

    fn is_served(&self, at: usize) -> bool {
        self.text.len() <= LONGEST && self.text.is_char_boundary(at)
    }

    /// What may stand at a byte of the text, the likeliest first.
    pub fn complete(&self, at: usize) -> Offer {
        if !self.is_served(at) {
            return Offer { start: at.min(self.text.len()), candidates: Vec::new(), file: false };
        }
        if let Some(start) = open_text(&self.text[..at]) {
            return Offer { start, candidates: Vec::new(), file: true };
        }
        offer::offer(&self.read(), at, self.session)
    }

    /// What the word at a byte means.
    pub fn hover(&self, at: usize) -> Option<About> {
        if self.is_served(at) { hover::about(&self.read(), at) } else { None }
    }

    /// The call whose brackets a byte is in, and the parameter that is at hand.
    pub fn call(&self, at: usize) -> Option<(Function, Option<usize>)> {
        if !self.is_served(at) || open_text(&self.text[..at]).is_some() {
            return None;
        }
        place::stand(&self.read(), at).call
    }
}

/// Whether a text ends inside a string, and where that begins; a value inside of a string is none.
fn open_text(before: &str) -> Option<usize> {
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    // Strings and the `{` inside them, the innermost last.
    let mut open: Vec<(char, usize)> = Vec::new();
    let mut letters = before[line..].char_indices().peekable();
    while let Some((at, c)) = letters.next() {
        let inside = open.last().is_some_and(|(quote, _)| *quote == '"');
        match c {
            '\\' if inside => drop(letters.next()),
            '"' if inside => drop(open.pop()),
            '"' => open.push(('"', line + at + 1)),
            '{' if inside || !open.is_empty() => open.push(('{', at)),
            '}' if !inside => drop(open.pop()),
            '/' if open.is_empty() && letters.peek().is_some_and(|next| next.1 == '/') => return None,
            _ => {}
        }
    }
    open.last().filter(|(quote, _)| *quote == '"').map(|(_, at)| *at)
}

#[cfg(test)]
mod tests {
    use super::open_text;

    #[test]
    fn open_strings_are_found() {
        assert_eq!(open_text("import \"Car"), Some(8));
        assert_eq!(open_text("export a to \"plate_{i"), None);
        assert_eq!(open_text("export a to \"plate_{i}_"), Some(13));
        assert_eq!((open_text("// \"a"), open_text("let a = \"b\\\"c\" + "), open_text("\"a\nlet b")), (None, None, None));
    }
}
