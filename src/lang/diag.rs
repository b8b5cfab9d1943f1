//! Diagnostics: what is said about a script, with places in it.

use crate::base::fault::{Code, Severity};
use crate::lang::syntax::ast::Span;

crate::ids! {
    /// A file of the run: the main script is 0, modules follow.
    FileId,
}

/// A place in a file with a few words.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The file.
    pub file: FileId,
    /// The narrowest stretch the user can change.
    pub span: Span,
    /// A few words.
    pub text: String,
}

/// One report: an error, a warning or a note.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Code of `diagnostics.md`; its letter is the severity.
    pub code: Code,
    /// One sentence without final dot.
    pub message: String,
    /// Places, the foremost first.
    pub labels: Vec<Label>,
    /// Something that can be typed.
    pub help: Option<String>,
    /// Further lines: call chain, what was not built.
    pub notes: Vec<String>,
}

impl Diagnostic {
    /// A report with one label.
    pub fn new(code: &'static str, message: impl Into<String>, file: FileId, span: Span, label: impl Into<String>) -> Self {
        Self {
            code: Code(code),
            message: message.into(),
            labels: vec![Label { file, span, text: label.into() }],
            help: None,
            notes: Vec::new(),
        }
    }

    /// With one more label.
    pub fn label(mut self, file: FileId, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { file, span, text: text.into() });
        self
    }

    /// With help that can be typed.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// With a further line.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// How bad it is.
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }
}
