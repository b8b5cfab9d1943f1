//! The golden file: its head and its sections, and its text.

use crate::lang::values::units::LengthUnit;

use super::line::Line;
use super::parse::comment_at;

/// Version of the grammar.
pub const VERSION: u32 = 1;
/// Tolerance where the head says none.
pub const TOLERANCE: f64 = 1e-9;

/// Something wrong in a golden file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// Line, from 1.
    pub line: usize,
    /// One sentence.
    pub what: String,
}

impl Flaw {
    pub(super) fn new(line: usize, what: impl Into<String>) -> Self {
        Self { line, what: what.into() }
    }
}

/// `compare "hall.obj" within 1e-6mm`.
#[derive(Clone, Debug, PartialEq)]
pub struct Compare {
    /// Path of the output, as the script writes it.
    pub file: String,
    /// Largest distance or difference that is none.
    pub within: f64,
    /// Its unit; without one it is in the file's.
    pub unit: Option<LengthUnit>,
}

/// `case "long": span = 50m, n = 4`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseLine {
    /// Name of its section.
    pub name: String,
    /// Params and the texts of their literals.
    pub sets: Vec<(String, String)>,
}

/// A case and the params it sets; `None` is the model as written.
pub type CaseParams = (Option<String>, Vec<(String, String)>);

/// Which program wrote the body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Producer {
    /// Version of loft.
    pub loft: String,
    /// Version of its mesher.
    pub mesher: u32,
}

impl Producer {
    /// This program.
    pub fn this() -> Self {
        Self { loft: env!("CARGO_PKG_VERSION").to_owned(), mesher: crate::mesh::VERSION }
    }

    /// `loft 0.4.0 mesher 3`.
    pub fn text(&self) -> String {
        format!("loft {} mesher {}", self.loft, self.mesher)
    }
}

/// What the head says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Head {
    /// Its lines as written.
    pub(super) raw: Vec<String>,
    /// Index of `made by` among them.
    pub(super) made_at: Option<usize>,
    /// Who wrote the body.
    pub made_by: Option<Producer>,
    /// Relative tolerance of reals; 0 is exact.
    pub tolerance: Option<f64>,
    /// Files to compare.
    pub compares: Vec<Compare>,
    /// Runs; none: the model as written.
    pub cases: Vec<CaseLine>,
}

/// A line of a body with the comments that belong to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Whole-line comments above it.
    pub above: Vec<String>,
    /// The comment at its end.
    pub behind: Option<String>,
    /// The line.
    pub line: Line,
}

/// The lines of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// The case; `None` for the model as written.
    pub case: Option<String>,
    /// Comments above its `[name]`.
    pub above: Vec<String>,
    /// Its lines.
    pub entries: Vec<Entry>,
    /// Comments at its end.
    pub below: Vec<String>,
}

/// A golden file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Golden {
    /// What is written by hand.
    pub head: Head,
    /// What is compared.
    pub sections: Vec<Section>,
}

impl Head {
    /// The relative tolerance in force.
    pub fn tolerance(&self) -> f64 {
        self.tolerance.unwrap_or(TOLERANCE)
    }

    /// The runs: a name and the params set.
    pub fn runs(&self) -> Vec<CaseParams> {
        if self.cases.is_empty() {
            return vec![(None, Vec::new())];
        }
        self.cases.iter().map(|case| (Some(case.name.clone()), case.sets.clone())).collect()
    }

    /// The head of a golden made from nothing.
    pub fn fresh() -> Self {
        let raw = vec![format!("loft golden {VERSION}"), format!("made by {}", Producer::this().text()), "tolerance 1e-9".to_owned()];
        Self { raw, made_at: Some(1), made_by: Some(Producer::this()), tolerance: Some(TOLERANCE), ..Self::default() }
    }

    /// Says that this program wrote the body.
    pub fn set_producer(&mut self) {
        let text = format!("made by {}", Producer::this().text());
        self.made_by = Some(Producer::this());
        match self.made_at {
            Some(at) => {
                let comment = comment_at(&self.raw[at]).map(|c| self.raw[at][c..].to_owned());
                self.raw[at] = comment.map_or(text.clone(), |c| format!("{text}  {c}"));
            }
            None => {
                let at = self.raw.iter().position(|line| line.trim_start().starts_with("loft ")).map_or(0, |at| at + 1);
                self.raw.insert(at, text);
                self.made_at = Some(at);
            }
        }
    }
}

impl Golden {
    /// The section of a case.
    pub fn section(&self, case: Option<&str>) -> Option<&Section> {
        self.sections.iter().find(|s| s.case.as_deref() == case)
    }

    /// The whole text.
    pub fn text(&self) -> String {
        let mut out = String::new();
        let mut put = |line: &str| {
            out.push_str(line);
            out.push('\n');
        };
        self.head.raw.iter().for_each(|line| put(line));
        for section in &self.sections {
            put("");
            section.above.iter().for_each(|line| put(line));
            if let Some(case) = &section.case {
                put(&format!("[{case}]"));
            }
            for entry in &section.entries {
                entry.above.iter().for_each(|line| put(line));
                let line = entry.line.text(self.head.tolerance());
                put(&entry.behind.as_ref().map_or(line.clone(), |comment| format!("{line}  {comment}")));
            }
            section.below.iter().for_each(|line| put(line));
        }
        out
    }
}
