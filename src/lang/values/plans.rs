//! What `mesh`, `check`, `report`, `export` and `picture` declarations say, resolved to plain data for the session.

use std::sync::Arc;

use crate::base::bbox::Box3;
use crate::base::origin::Origin;
use crate::draw::View;
use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::values::value::Value;
pub use crate::mesh::request::settings::Located;
use crate::mesh::request::settings::{MeshSettings, RuleSettings};

/// `on THINGS { … }` of a mesh.
#[derive(Clone, Debug, Default)]
pub struct RuleSpec {
    /// Links, curves, edges, surfaces, patches; nested lists flattened.
    pub things: Vec<(Value, Origin)>,
    /// What it says, model units.
    pub settings: RuleSettings,
    /// The clause.
    pub origin: Origin,
}

/// `near THINGS { … }` or `in BOX { … }` of a mesh.
#[derive(Clone, Debug)]
pub struct RefineSpec {
    /// Points and curves; nested lists flattened.
    pub things: Vec<(Value, Origin)>,
    /// Boxes along the axes, model units.
    pub boxes: Vec<Box3>,
    /// Target edge length, model units.
    pub size: (f64, Origin),
    /// How far around it holds, model units.
    pub radius: f64,
    /// The clause.
    pub origin: Origin,
}

/// `mesh m of things { settings }`.
#[derive(Clone, Debug)]
pub struct MeshSpec {
    /// Name as declared (`m`, `m[2]`).
    pub name: Arc<str>,
    /// The declaration.
    pub origin: Origin,
    /// Surfaces, shells, curves, points; nested lists flattened, each with the expression that names it.
    pub things: Vec<(Value, Origin)>,
    /// What it says of the whole mesh, model units and radians.
    pub settings: MeshSettings,
    /// `on` clauses in order of writing.
    pub rules: Vec<RuleSpec>,
    /// `near` and `in` clauses in order of writing.
    pub refines: Vec<RefineSpec>,
}

/// A `check` that was evaluated.
#[derive(Clone, Debug)]
pub struct CheckResult {
    /// Its label, or its source text.
    pub label: String,
    /// Whether it has a label.
    pub labelled: bool,
    /// Whether it holds.
    pub pass: bool,
    /// Where it stands.
    pub file: FileId,
    /// Where it stands.
    pub span: Span,
    /// Left side of its comparison as text; `None` when it is none.
    pub left: Option<String>,
    /// Right side of its comparison as text.
    pub right: Option<String>,
    /// Left side as a value, for the JSON report.
    pub left_value: Option<Value>,
    /// Right side as a value.
    pub right_value: Option<Value>,
    /// The difference that `within` allows.
    pub allowed: Option<Value>,
}

/// A column of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Unit of its numbers: `mm`, `deg`, empty.
    pub unit: String,
}

/// A `report` as a table.
#[derive(Clone, Debug)]
pub struct ReportTable {
    /// Its label, or the source text of what is reported.
    pub title: String,
    /// Whether it has a label.
    pub labelled: bool,
    /// Columns.
    pub columns: Vec<Column>,
    /// Cells: numbers (in model units and degrees), texts, bools, `none`.
    pub rows: Vec<Vec<Value>>,
}

/// `export things to "path" { settings }`.
#[derive(Clone, Debug)]
pub struct ExportSpec {
    /// What is written, nested lists flattened.
    pub things: Vec<(Value, Origin)>,
    /// Where, as written (interpolated).
    pub path: String,
    /// The path expression.
    pub path_origin: Origin,
    /// `encoding:` as a word.
    pub encoding: Located<Arc<str>>,
    /// The words of `element:`, each with its place.
    pub elements: Vec<(Arc<str>, Origin)>,
    /// `schema:` as a word.
    pub schema: Located<Arc<str>>,
    /// `shells:` as a word.
    pub shells: Located<Arc<str>>,
    /// What lacks faces is written all the same.
    pub incomplete: bool,
    /// `units:` of the file.
    pub units: Located<crate::lang::values::units::LengthUnit>,
    /// The declaration.
    pub origin: Origin,
}

/// `picture things to "path" { settings }`.
#[derive(Clone, Debug)]
pub struct PictureSpec {
    /// What is drawn, nested lists flattened.
    pub things: Vec<(Value, Origin)>,
    /// The things as written.
    pub named: String,
    /// Where, as written (interpolated).
    pub path: String,
    /// The path expression.
    pub path_origin: Origin,
    /// Where it is seen from.
    pub view: View,
    /// Several views on one sheet, each with its name; empty for one.
    pub views: Vec<(String, View)>,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// `shade:` as a word.
    pub shade: Located<Arc<str>>,
    /// What fills the picture; empty for everything.
    pub zoom: Vec<(Value, Origin)>,
    /// Words above it.
    pub title: Option<Arc<str>>,
    /// What is drawn beside faces.
    pub show: Show,
    /// The declaration.
    pub origin: Origin,
}

impl PictureSpec {
    /// A picture seen from somewhere with all other settings left alone, in a file of this name.
    pub fn of_file(path: &str, view: View) -> Self {
        Self {
            things: Vec::new(),
            named: String::new(),
            path: path.to_owned(),
            path_origin: Origin::NONE,
            view,
            views: Vec::new(),
            size: PICTURE_SIZE,
            shade: None,
            zoom: Vec::new(),
            title: None,
            show: Show::default(),
            origin: Origin::NONE,
        }
    }
}

/// What a picture shows beside faces; `None` where it was left to what is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Show {
    /// Edges of elements.
    pub elements: Option<bool>,
    /// Edges of faces.
    pub borders: Option<bool>,
    /// Curves and nodes of the network.
    pub network: Option<bool>,
    /// Names.
    pub labels: Option<bool>,
    /// Directions of x, y and z.
    pub axes: Option<bool>,
    /// A bar that shows a length.
    pub ruler: Option<bool>,
    /// What colours and lines mean.
    pub legend: Option<bool>,
    /// Curvature combs on curves.
    pub combs: Option<bool>,
}

/// Pixels of a picture that says nothing of its size.
pub const PICTURE_SIZE: (u32, u32) = (1200, 800);
