//! What goes wrong, in one type: code, message and where.

use std::fmt;

use super::model::Model;
use super::names::{Names, Speaker};
use crate::base::fault::{Fault, Say, ValueFault};
use crate::session::guard::Bug;
use crate::session::report::{DiagnosticRow, LabelRow};

/// What went wrong: a code, a sentence, and for scripts the place.
///
/// Printed it is one line, `roof.loft:7:15: E501 …`; [`Error::diagnostics`] has all that was said, and `loft explain E501` (or
/// `docs/codes/E501.md`) what a code means and how to fix it.
///
/// ```
/// let error = lofting::Script::from_str("let half = widht / 2").run().unwrap_err();
/// assert_eq!(error.code(), "E201");
/// assert_eq!(error.to_string(), "model.loft:1:12: E201 `widht` is not defined");
/// ```
pub struct Error(Box<Inner>);

struct Inner {
    first: DiagnosticRow,
    all: Vec<DiagnosticRow>,
    drawn: String,
    model: Option<Model>,
}

impl Error {
    /// An error that no script has a place for.
    pub(super) fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self::of_row(DiagnosticRow { code, severity: "error", message: message.into(), count: 1, ..DiagnosticRow::default() })
    }

    fn of_row(first: DiagnosticRow) -> Self {
        Self(Box::new(Inner { all: vec![first.clone()], first, drawn: String::new(), model: None }))
    }

    /// A fault of the kernel in words.
    pub(super) fn of_fault(fault: &Fault, say: &dyn Say) -> Self {
        Self::of_row(row(fault, say))
    }

    /// A value out of its range.
    pub(super) fn outside(argument: &'static str, found: impl fmt::Display, range: impl Into<String>) -> Self {
        let fault = ValueFault::OutsideRange { argument, found: found.to_string(), range: range.into() };
        Self::of_fault(&fault.into(), &Speaker { names: &Names::default(), unit: None, tolerance: None })
    }

    /// A bug that was caught.
    pub(super) fn bug(bug: &Bug) -> Self {
        Self::new("E999", format!("a bug in loft: {}", bug.what))
    }

    /// A run that failed: the first error is the one that is printed. `drawn` is everything under the lines of the script.
    pub(super) fn of_run(all: Vec<DiagnosticRow>, drawn: String, model: Option<Model>) -> Self {
        let first = all.iter().find(|row| row.severity == "error").or(all.first()).cloned();
        let first = first.unwrap_or_else(|| DiagnosticRow {
            code: "E999",
            severity: "error",
            message: "the run failed and did not say why".to_owned(),
            count: 1,
            ..DiagnosticRow::default()
        });
        Self(Box::new(Inner { first, all, drawn, model }))
    }

    /// The code, for example `E501`: its letter is the severity, its first digit the family.
    pub fn code(&self) -> &'static str {
        self.0.first.code
    }

    /// One sentence without its final dot.
    pub fn message(&self) -> &str {
        &self.0.first.message
    }

    /// Something that can be typed to fix it.
    pub fn help(&self) -> Option<&str> {
        self.0.first.help.as_deref()
    }

    /// The foremost place in the script, lines and columns from 1; `None` for what is not in a script.
    pub fn place(&self) -> Option<&LabelRow> {
        self.0.first.labels.first()
    }

    /// Everything that was said, warnings and notes as well, in order of place.
    pub fn diagnostics(&self) -> &[DiagnosticRow] {
        &self.0.all
    }

    /// All of it as text, each error under the lines of the script that it speaks of, as `loft run` prints it without colours.
    pub fn report(&self) -> String {
        if self.0.drawn.is_empty() { format!("{self}\n") } else { self.0.drawn.clone() }
    }

    /// What of a script is sound in spite of the error; its outputs were not written.
    pub fn model(&self) -> Option<&Model> {
        self.0.model.as_ref()
    }
}

/// A fault as a row that points nowhere.
pub(super) fn row(fault: &Fault, say: &dyn Say) -> DiagnosticRow {
    let report = fault.describe(say);
    let (code, severity, labels) = (fault.code().0, fault.code().severity().word(), Vec::new());
    DiagnosticRow { code, severity, message: report.message, help: report.help, notes: report.notes, labels, count: 1 }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place() {
            write!(f, "{}:{}:{}: ", place.file, place.line, place.column)?;
        }
        write!(f, "{} {}", self.code(), self.message())
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // What `main` prints when it returns an error.
        f.write_str(self.report().trim_end())
    }
}

impl std::error::Error for Error {}
