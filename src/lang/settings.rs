//! Settings of blocks: what each key takes, where it may stand, and what it means.

use super::types::Ty;
use super::value::Dim;
use crate::base::limits;

/// Words of `elements:`.
pub const ELEMENTS: &[&str] = &["triangles", "quads", "mixed"];
/// Words of `method:`.
pub const METHODS: &[&str] = &["auto", "mapped", "quadtree", "delaunay", "isoline", "display"];
/// Words of `encoding:`.
pub const ENCODINGS: &[&str] = &["binary", "text"];
/// Words of `schema:`.
pub const SCHEMAS: &[&str] = crate::io::step::write::Schema::WORDS;
/// Words of `shells:`.
pub const SHELLS: &[&str] = &["solids", "faces"];
/// Words of `units:` of an export.
pub const FILE_UNITS: &[&str] = &["um", "mm", "cm", "m", "km", "inch", "ft"];
/// Elements of decks.
pub const DECK_ELEMENTS: &[&str] = &crate::io::ELEMENT_NAMES;

/// Words of `shade:`.
pub const SHADES: &[&str] = &["plain", "names", "side", "quality", "size", "zebra", "curvature"];
/// Words of `view:`.
pub const VIEWS: &[&str] = &{
    let mut words = [""; crate::draw::VIEWS.len()];
    let mut k = 0;
    while k < words.len() {
        words[k] = crate::draw::VIEWS[k].0;
        k += 1;
    }
    words
};

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
/// A length, or a share of the diagonal of what is meshed.
const SIZE: Ty = Ty::Size;

/// `mesh m of … { … }`.
pub const MESH: &[Setting] = &[
    Setting {
        key: "size",
        docs: "Target edge length: never exceeded on borders, by at most 5 % inside free faces. Nodes of free faces, and of borders that \
               only free faces share, are 0.8 of it apart.",
        default: "a 20th of the diagonal of what is meshed",
        ty: SIZE,
    },
    Setting {
        key: "chord_error",
        docs: "Largest distance between mesh and surface; like all lengths of a mesh it may be a percentage of the diagonal of the box around what is meshed: `0.01%`.",
        default: "",
        ty: SIZE,
    },
    Setting { key: "angle_error", docs: "Largest turn of the normal across an element.", default: "", ty: Ty::Quantity(Dim::ANGLE) },
    Setting {
        key: "min_size",
        docs: "Smallest edge length, also within `chord_error` and `angle_error`. A written one that prevents these, or is above a written \
               size, is an error. Written counts and short edges of the model may go below it.",
        default: "a hundredth of the size; written sizes and limits may go below it",
        ty: SIZE,
    },
    Setting {
        key: "growth",
        docs: "Ratio of neighbouring sizes on free faces and their borders: away from a place with small steps the size grows by \
               `growth - 1` of the distance. Rows of mapped faces are even and not graded.",
        default: "1.3",
        ty: Ty::Number,
    },
    Setting {
        key: "smooth",
        docs: "Largest number of smoothing rounds on free faces; a node that no longer moves is done earlier. 0 does not smooth.",
        default: "5; 4 within `chord_error` or `angle_error`; 8 for quads and where lengths grow from short pieces; 30 with `quadtree`",
        ty: Ty::Count,
    },
    Setting { key: "elements", docs: "Kind of elements.", default: "triangles", ty: Ty::Choice(ELEMENTS) },
    Setting { key: "order", docs: "1, or 2 with mid nodes.", default: "1", ty: Ty::Count },
    Setting {
        key: "method",
        docs: "How faces are meshed: `auto` (`mapped` where it fits and its elements are well shaped, else `delaunay`), `mapped`, `delaunay`, `quadtree` (right-angled triangles in rows, finer where a border asks for it), `isoline` (cells between lines of constant u and v, as large as `chord_error` and `size` allow) or `display` (few and long triangles within `chord_error`).",
        default: "auto",
        ty: Ty::Choice(METHODS),
    },
    Setting { key: "conforming", docs: "Neighbouring faces share nodes.", default: "true", ty: Ty::Bool },
    Setting {
        key: "imprint",
        docs: "Faces that touch without a shared border share nodes there: edges that lie on a face, and the curves in which faces cross, \
               are lines of the faces' meshes. Faces that overlap are E666.",
        default: "false",
        ty: Ty::Bool,
    },
    Setting {
        key: "flip",
        docs: "Reverses the normals of faces. Without it faces that close point outwards; a list of faces that stays open keeps the \
               normals it was given.",
        default: "false",
        ty: Ty::Bool,
    },
];

/// `on things { … }` inside a mesh.
pub const ON: &[Setting] = &[
    Setting { key: "count", docs: "Steps over the whole length of a curve.", default: "", ty: Ty::Count },
    Setting { key: "size", docs: "Target edge length here.", default: "", ty: SIZE },
    Setting { key: "bias", docs: "Last step over first step along the curve.", default: "", ty: Ty::Number },
    Setting { key: "elements", docs: "Kind of elements of these faces.", default: "", ty: Ty::Choice(ELEMENTS) },
    Setting {
        key: "method",
        docs: "How these faces are meshed, by the words of the mesh's own `method`.",
        default: "",
        ty: Ty::Choice(METHODS),
    },
];

/// `near points and curves { … }` inside a mesh.
pub const NEAR: &[Setting] = &[
    Setting {
        key: "size",
        docs: "Target edge length up to the radius; further out it grows as `growth` says. It only refines: of several sizes the \
               smallest applies. A mapped face takes the least size on it for all its rows, and a written `count` stays.",
        default: "",
        ty: SIZE,
    },
    Setting { key: "radius", docs: "Distance up to which the size applies.", default: "0", ty: SIZE },
];

/// `in box(a, b) { … }` inside a mesh.
pub const IN: &[Setting] = &[Setting { key: "size", docs: "Target edge length in the box, as with `near`.", default: "", ty: SIZE }];

/// `shell s of … { … }`.
pub const SHELL: &[Setting] = &[
    Setting {
        key: "snap",
        docs: "Distance within which edges of faces with separate borders (imported, fitted) are glued.",
        default: "ten times the widest gap within the borders of a face, at least the tolerance",
        ty: LENGTH,
    },
    Setting {
        key: "imprint",
        docs: "Faces are cut by each other where they touch or cross, as by the function `imprint`; more than two may then share an edge. \
               A mesh of the shell also joins faces that touch along lines which cut off no part.",
        default: "false",
        ty: Ty::Bool,
    },
    Setting {
        key: "flip",
        docs: "Reverses the normals. Without it a closed shell points out of its material, whatever the order and direction of its \
               faces, and an open one follows its first face.",
        default: "false",
        ty: Ty::Bool,
    },
];

/// `export x to "…" { … }`.
pub const EXPORT: &[Setting] = &[
    Setting { key: "encoding", docs: "Binary or text.", default: "by format", ty: Ty::Choice(ENCODINGS) },
    Setting {
        key: "element",
        docs: "Element name of a deck, or a list with one for each kind of element that the mesh has: `[S8R, B32]`.",
        default: "by format",
        ty: Ty::OneOf(&[Ty::Choice(DECK_ELEMENTS), Ty::List(&Ty::Choice(DECK_ELEMENTS))]),
    },
    Setting {
        key: "incomplete",
        docs: "Writes parts of an imported file even where some of its faces could not be used; without it that is E904.",
        default: "false",
        ty: Ty::Bool,
    },
    Setting { key: "schema", docs: "Application protocol of a STEP file.", default: "ap242", ty: Ty::Choice(SCHEMAS) },
    Setting {
        key: "shells",
        docs: "How shells are written to an IGES file: as `solids` where they close, else as shells, with shared edges; or as `faces`, separate trimmed surfaces.",
        default: "solids",
        ty: Ty::Choice(SHELLS),
    },
    Setting { key: "units", docs: "Unit of lengths in the file.", default: "the model's", ty: Ty::Choice(FILE_UNITS) },
];

/// `import "file" ( … ) as name`; in this order.
pub const IMPORT: &[Setting] = &[
    Setting {
        key: "header",
        docs: "Whether the first line of a table names its columns.",
        default: "whether no cell of that line is a number",
        ty: Ty::Bool,
    },
    Setting {
        key: "unit",
        docs: "Unit of bare numbers in a table and of the coordinates of an OBJ or STL file; of a CAD file instead of the unit that it \
               states.",
        default: "the model's",
        ty: Ty::Choice(FILE_UNITS),
    },
];

/// `picture things to "…" { … }`.
pub const PICTURE: &[Setting] = &[
    Setting {
        key: "view",
        docs: "Position of the eye: a word, or the direction from the model to the eye, as in `(1, -2, 0.5)`.",
        default: "isometric",
        ty: Ty::OneOf(&[Ty::Choice(VIEWS), Ty::Direction]),
    },
    Setting { key: "up", docs: "Direction that is up in the picture.", default: "z, in `top` and `bottom` y", ty: Ty::Direction },
    Setting { key: "perspective", docs: "Near things are larger.", default: "false", ty: Ty::Bool },
    Setting { key: "zoom", docs: "Things that fill the picture.", default: "everything drawn", ty: Ty::Any },
    Setting { key: "width", docs: "Pixels across.", default: "1200", ty: Ty::Count },
    Setting { key: "height", docs: "Pixels down.", default: "800", ty: Ty::Count },
    Setting {
        key: "shade",
        docs: "What the colours of faces show: light only (`plain`), the surface (`names`), the side of the normal (`side`), \
               quality or longest side of elements (`quality`, `size`), reflected stripes that break where the tangent plane does \
               (`zebra`), the larger principal curvature (`curvature`).",
        default: "plain",
        ty: Ty::Choice(SHADES),
    },
    Setting { key: "elements", docs: "Edges of elements are drawn.", default: "true", ty: Ty::Bool },
    Setting {
        key: "borders",
        docs: "Edges of faces are drawn: free ones red, folds (inside a surface and between two) orange, edges of three faces or more purple.",
        default: "true",
        ty: Ty::Bool,
    },
    Setting {
        key: "network",
        docs: "The model's curves and nodes are drawn as well.",
        default: "whether `network` is among the things",
        ty: Ty::Bool,
    },
    Setting {
        key: "labels",
        docs: "Names of surfaces, curves, links, nodes and points are shown.",
        default: "whether curves or points are drawn",
        ty: Ty::Bool,
    },
    Setting { key: "title", docs: "Words above the picture, none with `\"\"`.", default: "the model and what is drawn", ty: Ty::Text },
    Setting { key: "axes", docs: "The directions of x, y and z are shown in a corner.", default: "true", ty: Ty::Bool },
    Setting { key: "ruler", docs: "A scale bar is shown.", default: "true", ty: Ty::Bool },
    Setting { key: "legend", docs: "A legend of colours and lines is shown.", default: "true", ty: Ty::Bool },
];

/// Every block that takes settings: how it is written, and its table.
pub const BLOCKS: &[(&str, &[Setting])] = &[
    ("mesh name of things { … }", MESH),
    ("on things { … }", ON),
    ("near points { … }", NEAR),
    ("in box(a, b) { … }", IN),
    ("shell name of surfaces { … }", SHELL),
    ("export things to \"file\" { … }", EXPORT),
    ("import \"file\" ( … ) as name", IMPORT),
    ("picture things to \"file\" { … }", PICTURE),
];

/// The blocks that a word opens: `mesh`, `on`, `export`.
pub fn blocks_of(word: &str) -> impl Iterator<Item = &'static (&'static str, &'static [Setting])> {
    BLOCKS.iter().filter(move |(form, _)| form.split(' ').next() == Some(word))
}

/// All words that settings take.
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    BLOCKS.iter().flat_map(|block| block.1).filter(|s| !matches!(s.key, "unit" | "units")).filter_map(|s| s.ty.choices()).flatten().copied()
}

/// A condition of a number, and its words.
type Bound = (fn(f64) -> bool, &'static str);

/// What the numbers of a setting must be.
pub fn bounds(key: &str) -> &'static [Bound] {
    match key {
        "order" => &[(|x| x == 1.0 || x == 2.0, "1 or 2")],
        "count" => &[(|x| x >= 1.0, "at least 1"), (|x| x <= 1e8, "at most 10^8")],
        "size" | "chord_error" | "angle_error" | "min_size" | "bias" | "snap" => &[(|x| x > 0.0, "more than 0")],
        "growth" => &[(|x| x > 1.0, "more than 1")],
        "radius" => &[(|x| x >= 0.0, "0 or more")],
        _ => &[],
    }
}

/// What a setting may be, in words; empty where its type says all.
pub fn range(setting: &Setting) -> String {
    match setting.key {
        "width" | "height" => format!("{} to {} pixels", limits::PICTURE_LEAST, limits::PICTURE_SIDE),
        key => bounds(key).iter().map(|bound| bound.1).collect::<Vec<_>>().join(", "),
    }
}

/// ` = triangles`; empty where nothing holds unless it is said.
pub fn default_words(setting: &Setting) -> String {
    if setting.default.is_empty() { String::new() } else { format!(" = {}", setting.default) }
}
