//! Settings of blocks: what each key takes, where it may stand, and what it means.

use super::types::Ty;
use super::value::Dim;

/// Words of `elements:`.
pub const ELEMENTS: &[&str] = &["triangles", "quads", "mixed"];
/// Words of `method:`.
pub const METHODS: &[&str] = &["auto", "mapped", "quadtree", "delaunay", "isoline", "display"];
/// Words of `encoding:`.
pub const ENCODINGS: &[&str] = &["binary", "text"];
/// Words of `units:` of an export.
pub const FILE_UNITS: &[&str] = &["um", "mm", "cm", "m", "km", "in", "ft"];
/// Shell elements of decks.
pub const DECK_ELEMENTS: &[&str] = &crate::io::ELEMENT_NAMES;

/// A key of a settings block.
#[derive(Debug)]
pub struct Setting {
    /// As written before the colon.
    pub key: &'static str,
    /// What it means.
    pub docs: &'static str,
    /// What holds when it is not said; empty where nothing does.
    pub default: &'static str,
    /// What it takes.
    pub ty: Ty,
}

const LENGTH: Ty = Ty::Quantity(Dim::LENGTH);

/// `mesh m of … { … }`.
pub const MESH: &[Setting] = &[
    Setting { key: "size", docs: "Target edge length.", default: "a 20th of the diagonal of what is meshed", ty: LENGTH },
    Setting { key: "chord_error", docs: "Largest distance between mesh and surface.", default: "", ty: LENGTH },
    Setting { key: "angle_error", docs: "Largest turn of the normal across an element.", default: "", ty: Ty::Quantity(Dim::ANGLE) },
    Setting { key: "elements", docs: "Kind of elements.", default: "triangles", ty: Ty::Choice(ELEMENTS) },
    Setting { key: "order", docs: "1, or 2 with mid nodes.", default: "1", ty: Ty::Count },
    Setting {
        key: "method",
        docs: "How faces are meshed; this version has `auto` and `mapped`.",
        default: "auto",
        ty: Ty::Choice(METHODS),
    },
    Setting { key: "conforming", docs: "Neighbouring faces share nodes.", default: "true", ty: Ty::Bool },
];

/// `on things { … }` inside a mesh.
pub const ON: &[Setting] = &[
    Setting { key: "count", docs: "Steps over the whole length of a curve.", default: "", ty: Ty::Count },
    Setting { key: "size", docs: "Target edge length here.", default: "", ty: LENGTH },
    Setting { key: "bias", docs: "Last step over first step along the curve.", default: "", ty: Ty::Number },
    Setting { key: "elements", docs: "Kind of elements of these faces.", default: "", ty: Ty::Choice(ELEMENTS) },
    Setting {
        key: "method",
        docs: "How these faces are meshed; this version has `auto` and `mapped`.",
        default: "",
        ty: Ty::Choice(METHODS),
    },
];

/// `shell s of … { … }`: none in this version; `snap` belongs to faces that come with borders of their own.
pub const SHELL: &[Setting] = &[];

/// `export x to "…" { … }`.
pub const EXPORT: &[Setting] = &[
    Setting { key: "encoding", docs: "Binary or text.", default: "by format", ty: Ty::Choice(ENCODINGS) },
    Setting { key: "element", docs: "Element name of a deck.", default: "", ty: Ty::Choice(DECK_ELEMENTS) },
    Setting { key: "units", docs: "Unit of lengths in the file.", default: "the model's", ty: Ty::Choice(FILE_UNITS) },
];

/// Every block that takes settings: how it is written, and its table.
pub const BLOCKS: &[(&str, &[Setting])] = &[
    ("mesh name of things { … }", MESH),
    ("on things { … }", ON),
    ("shell name of surfaces { … }", SHELL),
    ("export things to \"file\" { … }", EXPORT),
];

/// All words that settings take.
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    BLOCKS.iter().flat_map(|block| block.1).filter(|s| s.key != "units").filter_map(|s| s.ty.choices()).flatten().copied()
}
