//! What a run found out, as plain data: the JSON report is this structure, and the summary table reads it too.
//!
//! The order of fields is the order of keys. Lengths are in model units, angles in degrees.

use crate::base::tolerance::Tolerance;
use crate::lang::eval::members::UNIT_COLUMN;
use serde::Serialize;

/// Version of the report's shape.
pub const VERSION: u32 = 1;

/// All that `loft run --json` gives about one run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// [`VERSION`].
    pub loft: u32,
    /// The script as named on the command line; `-` is standard input.
    pub model: String,
    /// Model unit.
    pub units: String,
    /// No errors, no failed checks.
    pub ok: bool,
    /// Counts of the curve network.
    pub network: NetworkCounts,
    /// Declared chains and the unnamed ones that surfaces stand on.
    pub modeling: Vec<ModelingRow>,
    /// Curves of the network.
    pub curves: Vec<CurveRow>,
    /// Declared surfaces.
    pub surfaces: Vec<SurfaceRow>,
    /// Counts of the surface model.
    pub topology: TopologyCounts,
    /// Shells.
    pub shells: Vec<ShellRow>,
    /// Meshes.
    pub meshes: Vec<MeshRow>,
    /// Checks.
    pub checks: Vec<CheckRow>,
    /// Report tables.
    pub reports: Vec<Table>,
    /// Files written, by path inside the output folder.
    pub outputs: Vec<OutputRow>,
    /// Names of the model that stand otherwise in one of the files.
    pub renamed: Vec<RenamedRow>,
    /// Files that the script asks for and a failed run did not write, by path inside the output folder.
    pub unwritten: Vec<String>,
    /// What failed, and what was not made because of it.
    pub unmade: Vec<UnmadeRow>,
    /// Everything said about the script.
    pub diagnostics: Vec<DiagnosticRow>,
    /// Seconds; the only part that may differ between two runs.
    pub timings: Timings,
    /// Box of all curves and bounded surfaces, model units; `None` without any and where no full report was asked for.
    #[serde(skip)]
    pub bounds: Option<Corners>,
}

/// Smallest and largest coordinates of a box, model units.
pub type Corners = [[f64; 3]; 2];

/// Counts of the curve network.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[allow(missing_docs)]
pub struct NetworkCounts {
    pub curves: usize,
    pub links: usize,
    pub nodes: usize,
}

/// A modeling curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ModelingRow {
    /// Its name, or its source text when it has none.
    pub name: String,
    /// How many links it runs over.
    pub links: usize,
    /// Arc length.
    pub length: f64,
    /// Slope discontinuities inside it.
    pub kinks: usize,
}

/// A curve of the network.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CurveRow {
    /// Its name, or its source text when it has none.
    pub name: String,
    /// The word it was made with.
    pub kind: &'static str,
    /// Arc length.
    pub length: f64,
    /// How many links it runs over.
    pub links: usize,
}

/// A declared surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct SurfaceRow {
    pub name: String,
    /// The word it was made with.
    pub kind: &'static str,
    /// Phrase of its flow, where a flow was looked for.
    pub flow: Option<String>,
    pub patches: usize,
    pub edges: usize,
    pub vertices: usize,
    pub area: Option<f64>,
    /// Its box; `None` where it has no bounds and where no full report was asked for.
    #[serde(skip)]
    pub corners: Option<Corners>,
}

/// Counts of the surface model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[allow(missing_docs)]
pub struct TopologyCounts {
    pub patches: usize,
    pub edges: usize,
    pub vertices: usize,
    pub shells: usize,
}

/// A shell.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct ShellRow {
    pub name: String,
    /// Patches.
    pub faces: usize,
    pub closed: bool,
    pub area: Option<f64>,
    /// Only of a closed shell.
    pub volume: Option<f64>,
    /// Largest distance between the faces of an inner edge; `None` without inner edges and where no JSON report was asked for.
    pub gap: Option<f64>,
    /// Largest angle between the normals of the faces of an inner edge, degrees; `None` without inner edges.
    pub angle: Option<f64>,
    /// Its box; `None` where no full report was asked for.
    #[serde(skip)]
    pub corners: Option<Corners>,
}

/// A mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct MeshRow {
    pub name: String,
    pub nodes: usize,
    pub triangles: usize,
    pub quads: usize,
    pub order: u8,
    /// Smallest corner angle, degrees; `None` without faces, as all that follow.
    pub min_angle: Option<f64>,
    pub max_angle: Option<f64>,
    pub mean_quality: Option<f64>,
    pub min_quality: Option<f64>,
    pub max_aspect: Option<f64>,
    pub area: Option<f64>,
    pub chord_error: Option<f64>,
    pub watertight: Option<bool>,
    /// Parts that share no node with each other.
    pub parts: usize,
    /// Of the connectivity with its groups, not of numbers or positions.
    pub hash: Option<String>,
    pub groups: Vec<GroupRow>,
}

crate::plain!(MeshRow {
    name,
    nodes,
    triangles,
    quads,
    order,
    min_angle,
    max_angle,
    mean_quality,
    min_quality,
    max_aspect,
    area,
    chord_error,
    watertight,
    parts,
    hash,
    groups,
});

/// A set of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct GroupRow {
    pub name: String,
    pub nodes: usize,
    pub elements: usize,
}

crate::plain!(GroupRow { name, nodes, elements });

/// A check of the script.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CheckRow {
    /// Its label, or its source text.
    pub label: String,
    /// Whether it holds.
    pub pass: bool,
    /// Line of the script, from 1.
    pub line: usize,
    /// Left side of its comparison.
    pub left: Cell,
    /// Right side of its comparison.
    pub right: Cell,
}

/// A table that a `report` makes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Table {
    pub title: String,
    pub columns: Vec<Column>,
    pub rows: Vec<Vec<Cell>>,
}

/// Head of a column.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Unit of its numbers, `None` for plain numbers and words.
    pub unit: Option<String>,
}

impl Table {
    /// The table as people see it: coordinates of points in this unit, the model's, as far as the tolerance resolves them. The unit is
    /// that of the column, or stands in the row where each row has its own.
    pub fn rounded(mut self, tolerance: &Tolerance, unit: &str) -> Self {
        let own = self.columns.iter().position(|c| c.name == UNIT_COLUMN && c.unit.is_none());
        for row in &mut self.rows {
            let in_row = own.is_some_and(|k| matches!(row.get(k), Some(Cell::Text(text)) if text == unit));
            for (cell, column) in row.iter_mut().zip(&self.columns) {
                if let (Cell::List(items), true) = (cell, in_row || column.unit.as_deref() == Some(unit))
                    && let [Cell::Number(x), Cell::Number(y), Cell::Number(z)] = items[..]
                {
                    *items = tolerance.rounded(glam::DVec3::new(x, y, z)).to_array().map(Cell::Number).to_vec();
                }
            }
        }
        self
    }
}

/// A value of a check or table.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// None.
    #[default]
    Missing,
    /// True or false.
    Bool(bool),
    /// A plain number, a length in model units or an angle in degrees.
    Number(f64),
    /// Text or a word.
    Text(String),
    /// Points and other short lists of numbers.
    List(Vec<Cell>),
}

/// A file that was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct OutputRow {
    /// Path inside the output folder.
    pub path: String,
    /// Its size.
    pub bytes: u64,
    /// Name of the unit of its lengths; empty where it holds none.
    #[serde(skip)]
    pub unit: &'static str,
    /// Where it stands: as seen from the working directory, or in full where it is not below that.
    #[serde(skip)]
    pub place: String,
    /// Names that stand otherwise in it.
    #[serde(skip)]
    pub renamed: Vec<RenamedRow>,
    /// Names that every mesh has and that are not in it, in words.
    #[serde(skip)]
    pub unnamed: Vec<String>,
}

/// A name of the model that a format had to change.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RenamedRow {
    /// Path of the output, as in `outputs`.
    pub path: String,
    /// Name in the model.
    pub from: String,
    /// Name in the file.
    pub to: String,
}

/// Something that was not made; a check that does not hold was made.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct UnmadeRow {
    /// Its name; of what has none its text.
    pub name: String,
    /// The word that declares it; empty where its declaration could not be read.
    pub what: String,
    /// Its script.
    pub file: String,
    /// Line there, from 1.
    pub line: usize,
    /// What it needs and what failed; `None` where it is wrong itself, empty where it uses what could not be read, or a network or model that failed.
    pub because: Option<String>,
}

/// An error, a warning or a note about the script.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DiagnosticRow {
    /// Code, for example `E501`.
    pub code: &'static str,
    /// `error`, `warning` or `note`.
    pub severity: &'static str,
    /// One sentence.
    pub message: String,
    /// Something that can be typed.
    pub help: Option<String>,
    /// Further lines, such as what was not built.
    pub notes: Vec<String>,
    /// Places, the foremost first.
    pub labels: Vec<LabelRow>,
    /// How often it was said in these words at these places.
    pub count: usize,
}

/// A place that a diagnostic speaks of; counts characters from 1.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LabelRow {
    /// The script, as it is called in messages.
    pub file: String,
    /// Its line, from 1.
    pub line: usize,
    /// Its column, from 1.
    pub column: usize,
    /// How many characters it speaks of.
    pub length: usize,
    /// A few words about them.
    pub text: String,
}

/// Seconds of each phase.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Timings {
    pub parse: f64,
    pub evaluate: f64,
    pub mesh: f64,
    pub write: f64,
}

/// A param that a row of a table of variants sets.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SetRow {
    /// Its name.
    pub name: String,
    /// The text of its literal: `50m`.
    pub value: String,
}

/// One run of a table of variants.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Case {
    /// Name of the row, also of its output folder.
    pub case: String,
    /// Params that the row sets, in order of its columns; none where a case is a model of the command line.
    pub set: Vec<SetRow>,
    /// Its report.
    #[serde(flatten)]
    pub report: Report,
}

/// What `loft run --table --json` prints.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Cases {
    /// [`VERSION`].
    pub loft: u32,
    /// In order of the rows.
    pub cases: Vec<Case>,
}
