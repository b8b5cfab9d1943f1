//! What is to be run, and what became of it.

use std::sync::Arc;

use super::report::Report;
use crate::base::fault::Severity;
use crate::base::job::TooMuchWork;
use crate::lang::declare::params::TableRow;
use crate::lang::diag::diagnostic::{Diagnostic, Sources};
use crate::lang::diag::render::render_all;
use crate::lang::incremental::recall::Remains;
use crate::lang::values::plans::PictureSpec;
use crate::mesh::Mesh;

/// What is to be run.
pub struct Task<'a> {
    /// The script as named on the command line.
    pub name: &'a str,
    /// Its bytes.
    pub text: &'a [u8],
    /// The same, where they are text that the run may share instead of copying it.
    pub shared: Option<Arc<str>>,
    /// Params set from outside: name and the text of a literal.
    pub sets: &'a [(String, String)],
    /// The row of a table of variants that sets some of them.
    pub row: Option<&'a TableRow>,
    /// Warnings are errors.
    pub strict: bool,
    /// What is sound is written although something failed.
    pub keep_going: bool,
    /// Every number of the JSON report; without it the costly ones of meshes over 200 000 elements are left out.
    pub full: bool,
    /// A row for each curve in the report, which the summary on a terminal has not.
    pub curves: bool,
    /// One picture is all that is written, whatever the script exports, and also of a model that has errors.
    pub picture: Option<&'a Wanted>,
    /// Seconds since some moment.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
}

impl<'a> Task<'a> {
    /// A run without options.
    pub fn new(name: &'a str, text: &'a [u8], sets: &'a [(String, String)], clock: &'a (dyn Fn() -> f64 + Sync)) -> Self {
        Self {
            name,
            text,
            shared: None,
            sets,
            row: None,
            strict: false,
            keep_going: false,
            full: false,
            curves: true,
            picture: None,
            clock,
        }
    }
}

/// The bytes of a script.
#[derive(Debug)]
pub enum ScriptBytes {
    /// Text, which a run may share.
    Text(Arc<str>),
    /// What is no UTF-8.
    Other(Vec<u8>),
}

impl From<Vec<u8>> for ScriptBytes {
    fn from(bytes: Vec<u8>) -> Self {
        String::from_utf8(bytes).map_or_else(|error| Self::Other(error.into_bytes()), |text| Self::Text(text.into()))
    }
}

impl ScriptBytes {
    /// All of them.
    pub fn as_bytes(&self) -> &[u8] {
        match self {
            Self::Text(text) => text.as_bytes(),
            Self::Other(bytes) => bytes,
        }
    }

    /// The text, to be shared.
    pub fn shared(&self) -> Option<Arc<str>> {
        match self {
            Self::Text(text) => Some(Arc::clone(text)),
            Self::Other(_) => None,
        }
    }
}

/// A picture asked for on the command line.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Names of the script to draw; everything where there are none.
    pub names: Vec<String>,
    /// What to fill the picture with; everything drawn where there are none.
    pub zoom: Vec<String>,
    /// The rest of it, without things.
    pub spec: PictureSpec,
}

/// What became of it.
#[derive(Debug, Default)]
pub struct Outcome {
    /// All that was found out.
    pub report: Report,
    /// The meshes by name, in the order of the report.
    pub meshes: Vec<(String, Arc<Mesh>)>,
    /// Everything said about the script.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts that diagnostics point into.
    pub sources: Sources,
    /// How things were found, a line each.
    pub notes: Vec<String>,
    /// Distance within which two points are one, model units.
    pub tolerance: Option<f64>,
    /// Stopped from outside.
    pub interrupted: bool,
    /// Ended for its work, where that is limited: what was found out is a part, and no property of the model.
    pub over: Option<TooMuchWork>,
    /// Something that cannot happen did.
    pub bug: bool,
    /// Declarations, stages and faces of meshes whose results were taken over from the run before.
    pub reused: usize,
    /// Of these the faces of meshes that are otherwise new.
    pub reused_faces: usize,
    /// Results that came from the folder of `--cache`.
    pub from_cache: usize,
    /// What is of no more use.
    pub remains: Remains,
}

impl Outcome {
    /// The diagnostics under their source lines; notes only when `verbose`.
    pub fn drawn(&self, color: bool, verbose: bool) -> String {
        let shown: Vec<Diagnostic> = self.diagnostics.iter().filter(|d| verbose || d.severity() != Severity::Note).cloned().collect();
        if shown.is_empty() { String::new() } else { render_all(&shown, &self.sources, color) }
    }
}
