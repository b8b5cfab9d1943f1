//! Colours of reports, and the length of their words.

use std::borrow::Cow;

use crate::base::fault::Severity;
use crate::base::visible::{colored, visible};

/// Characters of the longest message that is shown whole.
const WORDS: usize = 2000;

/// Words as they are shown: of what quotes something endless the beginning and the end, and nothing that steers the terminal. The JSON report
/// has them whole.
pub(super) fn shortened(words: &str) -> Cow<'_, str> {
    let words = visible(words);
    let total = words.chars().count();
    if total <= WORDS {
        return words;
    }
    let begin: String = words.chars().take(WORDS / 2).collect();
    let end: String = words.chars().skip(total - WORDS / 4).collect();
    format!("{begin}…{end}").into()
}

/// Colours, or none.
pub(super) struct Colors {
    pub(super) on: bool,
    pub(super) severity: Severity,
}

impl Colors {
    fn with(&self, code: &str, text: &str) -> String {
        colored(text, code, self.on)
    }

    fn strong(&self) -> &'static str {
        match self.severity {
            Severity::Error => "1;31",
            Severity::Warning => "1;33",
            Severity::Note => "1;36",
        }
    }

    pub(super) fn head(&self, text: &str) -> String {
        self.with(self.strong(), text)
    }

    pub(super) fn frame(&self, text: &str) -> String {
        self.with("2", text)
    }

    pub(super) fn label(&self, text: &str) -> String {
        self.with(&self.strong()[2..], text)
    }

    pub(super) fn word(&self, text: &str) -> String {
        self.with("36", text)
    }
}
