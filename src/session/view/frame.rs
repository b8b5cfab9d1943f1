//! What a page is sent: the list of what a script declares, with the keys of the buffers that draw it.

use serde::Serialize;

use crate::session::report::{Cell, Corners};

/// Version of the frame's shape.
pub const VERSION: u32 = 1;

/// One state of a model. Lengths are in model units.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Frame {
    /// [`VERSION`].
    pub loft: u32,
    /// Counts up with every frame.
    pub number: u64,
    /// Only the shapes are evaluated: nothing is known yet of meshes, checks, reports and what else a whole frame tells.
    pub partial: bool,
    /// The script as named on the command line.
    pub model: String,
    /// What the page is called.
    pub title: String,
    /// Model unit.
    pub units: String,
    /// No errors, no failed checks.
    pub ok: bool,
    /// Whether something drawn is of an earlier frame, because it could not be made now; its things are marked.
    pub stale: bool,
    /// Frame whose things are drawn; the same as `number` unless nothing could be evaluated.
    pub drawn: u64,
    /// Seconds that the evaluation took.
    pub seconds: f64,
    /// Box of everything drawn; `None` where nothing is.
    #[serde(rename = "box")]
    pub corners: Option<Corners>,
    /// How far display triangles may be from their surfaces.
    pub chord_error: f64,
    /// What the script declares and can be drawn, in order of declaration; what is not made now stands last.
    pub things: Vec<Thing>,
    /// The script first, then its modules.
    pub sources: Vec<Source>,
    /// Params of the script.
    pub params: Vec<Param>,
    /// Errors, warnings and notes.
    pub diagnostics: Vec<Said>,
    /// Checks.
    pub checks: Vec<Check>,
    /// Reports.
    pub reports: Vec<Table>,
    /// Pictures that the script writes.
    pub pictures: Vec<Output>,
    /// Other files that it writes.
    pub outputs: Vec<Output>,
    /// Another state of the model, shown beside it.
    pub compare: Option<Compare>,
}

/// A text of the model.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Source {
    /// As the user knows it.
    pub file: String,
    /// In full; empty where it is no file.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// A stretch of a text: lines from 1, columns from 1 in UTF-16 code units, as browsers and editors count.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Place {
    /// Which of the sources.
    pub file: usize,
    /// First line.
    pub line: usize,
    /// First column.
    pub column: usize,
    /// Last line.
    pub end_line: usize,
    /// Column after the last one.
    pub end_column: usize,
    /// A few words.
    pub label: Option<String>,
}

/// Something that is drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Thing {
    /// Name as declared; `ribs[2]` of a family.
    pub name: String,
    /// `point`, `curve`, `surface`, `shell`, `mesh`, `group` or `network`.
    pub kind: &'static str,
    /// Names of the things in it.
    pub of: Vec<String>,
    /// Names of the surfaces and patches in it that other things draw, as they stand in the headers of buffers.
    pub surfaces: Vec<String>,
    /// The lines that made it: the one that a person would name first, then those that it went through.
    pub chain: Vec<Place>,
    /// What is known of it, ready to show.
    pub facts: Vec<(String, String)>,
    /// What draws it.
    pub buffers: Vec<BufferRow>,
    /// Whether it is shown at first.
    pub visible: bool,
    /// Its own colour, `#rrggbb`.
    pub color: Option<String>,
    /// Why it was not made.
    pub unmade: Option<String>,
    /// Drawn as of an earlier frame.
    pub stale: bool,
    /// Not made yet, in a partial frame.
    pub pending: bool,
}

/// A buffer of a thing.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct BufferRow {
    /// By which it is asked for.
    pub key: String,
    /// Its size.
    pub bytes: usize,
    /// What it shows.
    pub role: &'static str,
}

/// A param.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Param {
    /// Its name.
    pub name: String,
    /// Its value as written in a script.
    pub text: String,
    /// Its value where it is a number, in `unit`.
    pub value: Option<f64>,
    /// Unit of value and range; empty for a plain number.
    pub unit: String,
    /// `length`, `angle`, `number`, `count`, `text`, `bool` or `choice`.
    pub kind: &'static str,
    /// Least value, in `unit`.
    pub min: Option<f64>,
    /// Largest value, in `unit`.
    pub max: Option<f64>,
    /// Values that it may have, as written.
    pub choices: Vec<String>,
    /// Whether the page has set it.
    pub set: bool,
    /// Its default in the script.
    pub place: Place,
}

/// An error, a warning or a note.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Said {
    /// `error`, `warning` or `note`.
    pub severity: &'static str,
    /// Code of the table.
    pub code: String,
    /// One sentence.
    pub message: String,
    /// Something that can be typed.
    pub help: Option<String>,
    /// Where, the foremost first.
    pub places: Vec<Place>,
    /// Where it is in space.
    pub points: Vec<[f64; 3]>,
    /// The distance of two points, such as the width of a gap, or the first length that it speaks of.
    pub size: Option<f64>,
    /// Names of the things it speaks of.
    pub things: Vec<String>,
}

/// A check.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Check {
    /// Its label, or its source text.
    pub name: String,
    /// Its source text.
    pub text: String,
    /// Whether it holds.
    pub pass: bool,
    /// What was found.
    pub found: Option<String>,
    /// Where it stands.
    pub place: Place,
    /// Names of the things it speaks of.
    pub things: Vec<String>,
}

/// A table of a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Table {
    /// Its label, or the source text of what is reported.
    pub name: String,
    /// The same, as a heading.
    pub title: String,
    /// Heads.
    pub columns: Vec<String>,
    /// Units of the columns; empty for plain numbers and words.
    pub units: Vec<String>,
    /// Cells.
    pub rows: Vec<Vec<Cell>>,
    /// Where it stands.
    pub place: Option<Place>,
}

/// A file that the script writes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Output {
    /// As written in the script.
    pub path: String,
    /// Where it stands.
    pub place: Option<Place>,
}

/// Another state of the model.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Compare {
    /// What it is: `revision:HEAD`.
    pub with: String,
    /// It is not evaluated yet; a frame that has it, or tells why it cannot be made, follows.
    pub pending: bool,
    /// Its things.
    pub things: Vec<Thing>,
    /// Why it could not be made.
    pub failed: Option<String>,
}
