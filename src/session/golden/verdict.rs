//! What became of a run of a model that is compared with its golden.

use super::describe::DiffLine;

/// What became of a run, from good to bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// It is as its golden says.
    Passed,
    /// Its golden was written.
    Accepted,
    /// It is not as its golden says.
    Differs,
    /// It has no golden, or its golden no section for this case.
    Missing,
    /// A golden without script, a section without case or a stored file that nothing compares.
    Orphaned,
    /// The golden or the script cannot be read, or the golden not written.
    Unreadable,
    /// It was ended for its work, which `--max-work` limits: nothing is compared or accepted.
    Ended,
    /// A bug in loft, caught.
    Bug,
    /// Stopped from outside.
    Interrupted,
}

impl Verdict {
    /// One word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Passed => "ok",
            Self::Accepted => "accepted",
            Self::Differs => "differs",
            Self::Missing => "missing",
            Self::Orphaned => "orphaned",
            Self::Unreadable => "unreadable",
            Self::Ended => "ended",
            Self::Bug => "bug",
            Self::Interrupted => "interrupted",
        }
    }

    /// Whether all is well.
    pub fn is_good(self) -> bool {
        self <= Self::Accepted
    }
}

/// One run of one model.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseResult {
    /// The script, with its case behind it where there is one: `roof.loft [long]`.
    pub name: String,
    /// What became of it.
    pub verdict: Verdict,
    /// One sentence; empty when all is well.
    pub message: String,
    /// What differs.
    pub lines: Vec<DiffLine>,
    /// What to do about it.
    pub help: Option<String>,
    /// How long it took.
    pub seconds: f64,
}

impl CaseResult {
    pub(super) fn new(name: impl Into<String>, verdict: Verdict, message: impl Into<String>) -> Self {
        Self { name: name.into(), verdict, message: message.into(), lines: Vec::new(), help: None, seconds: 0.0 }
    }

    pub(super) fn help(self, text: impl Into<String>) -> Self {
        Self { help: Some(text.into()), ..self }
    }
}
