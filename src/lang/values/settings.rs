//! Settings of blocks: what each key takes, where it may stand, and what it means.

use crate::base::limits;
use crate::lang::values::types::Ty;
use crate::lang::values::value::Dim;
use crate::mesh::request::settings::{Bound, BoxSettings, Declared, MeshSettings, NearSettings, POSITIVE, RuleSettings, Settings, Takes};

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
pub const SHADES: &[&str] =
    &["plain", "names", "side", "quality", "size", "zebra", "reflection", "isophotes", "curvature", "mean", "gauss"];
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
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// As written before the colon.
    pub key: &'static str,
    /// What it means.
    pub docs: &'static str,
    /// What holds when it is not said; empty where nothing does.
    pub default: &'static str,
    /// What it takes.
    pub ty: Ty,
    /// What its numbers must be.
    pub range: &'static [Bound],
}

/// `mesh m of … { … }`.
pub const MESH: &[Setting] = &of_mesh::<{ MeshSettings::DECLARED.len() }>(MeshSettings::DECLARED);
/// `on things { … }` inside a mesh.
pub const ON: &[Setting] = &of_mesh::<{ RuleSettings::DECLARED.len() }>(RuleSettings::DECLARED);
/// `near points and curves { … }` inside a mesh.
pub const NEAR: &[Setting] = &of_mesh::<{ NearSettings::DECLARED.len() }>(NearSettings::DECLARED);
/// `in box(a, b) { … }` inside a mesh.
pub const IN: &[Setting] = &of_mesh::<{ BoxSettings::DECLARED.len() }>(BoxSettings::DECLARED);

/// Settings that the mesher declares, as those of the language.
const fn of_mesh<const N: usize>(declared: &[Declared]) -> [Setting; N] {
    let mut all = [Setting { key: "", docs: "", default: "", ty: Ty::Any, range: &[] }; N];
    let mut k = 0;
    while k < N {
        let Declared { word, docs, default, takes, range } = declared[k];
        let ty = match takes {
            Takes::Size => Ty::Size,
            Takes::Angle => Ty::Quantity(Dim::ANGLE),
            Takes::Ratio => Ty::Number,
            Takes::Count => Ty::Count,
            Takes::Flag => Ty::Bool,
            Takes::Word(words) => Ty::Choice(words),
        };
        all[k] = Setting { key: word, docs, default, ty, range };
        k += 1;
    }
    all
}

/// `shell s of … { … }`: `snap` is decided by [`Model::reach`](crate::model::Model::reach), the sides of faces by
/// [`Model::shell`](crate::model::Model::shell), what `imprint` cuts by [`Model::imprint`](crate::model::Model::imprint).
pub const SHELL: &[Setting] = &[
    Setting {
        key: "snap",
        docs: "Distance within which edges of faces with separate borders (imported, fitted) are glued.",
        default: "ten times the widest gap within the borders of a face, at least the tolerance",
        ty: Ty::Quantity(Dim::LENGTH),
        range: POSITIVE,
    },
    Setting {
        key: "imprint",
        docs: "Faces are cut by each other where they touch or cross, as by the function `imprint`; more than two may then share an edge. \
               A mesh of the shell also joins faces that touch along lines which cut off no part.",
        default: "false",
        ty: Ty::Bool,
        range: &[],
    },
    Setting {
        key: "flip",
        docs: "Reverses the normals. Without it a closed shell points out of its material, whatever the order and direction of its \
               faces, and an open one follows its first face.",
        default: "false",
        ty: Ty::Bool,
        range: &[],
    },
];

/// `export x to "…" { … }`: `encoding` and `element` are decided by [`Format::check`](crate::io::mesh_files::format::Format::check),
/// `schema` by [`Schema`](crate::io::step::write::Schema), `shells` by [`IgesShape`](crate::io::iges::write::IgesShape), `units` by
/// [`Deck`](crate::io::Deck).
pub const EXPORT: &[Setting] = &[
    Setting { key: "encoding", docs: "Binary or text.", default: "by format", ty: Ty::Choice(ENCODINGS), range: &[] },
    Setting {
        key: "element",
        docs: "Element name of a deck, or a list with one for each kind of element that the mesh has: `[S8R, B32]`.",
        default: "by format",
        ty: Ty::OneOf(&[Ty::Choice(DECK_ELEMENTS), Ty::List(&Ty::Choice(DECK_ELEMENTS))]),
        range: &[],
    },
    Setting {
        key: "incomplete",
        docs: "Writes parts of an imported file even where some of its faces could not be used; without it that is E904.",
        default: "false",
        ty: Ty::Bool,
        range: &[],
    },
    Setting { key: "schema", docs: "Application protocol of a STEP file.", default: "ap242", ty: Ty::Choice(SCHEMAS), range: &[] },
    Setting {
        key: "shells",
        docs: "How shells are written to an IGES file: as `solids` where they close, else as shells, with shared edges; or as `faces`, separate trimmed surfaces.",
        default: "solids",
        ty: Ty::Choice(SHELLS),
        range: &[],
    },
    Setting {
        key: "units",
        docs: "Unit of lengths in the file; GLB is in metres and 3MF in millimetres.",
        default: "the model's",
        ty: Ty::Choice(FILE_UNITS),
        range: &[],
    },
];

/// `import "file" ( … ) as name`; in this order.
pub const IMPORT: &[Setting] = &[
    Setting {
        key: "header",
        docs: "Whether the first line of a table names its columns.",
        default: "whether no cell of that line is a number",
        ty: Ty::Bool,
        range: &[],
    },
    Setting {
        key: "unit",
        docs: "Unit of bare numbers in a table and of the coordinates of an OBJ or STL file; of a CAD file instead of the unit that it \
               states.",
        default: "the model's",
        ty: Ty::Choice(FILE_UNITS),
        range: &[],
    },
    Setting {
        key: "incomplete",
        docs: "Takes a CAD file of which nothing, or less than half, could be read.",
        default: "false: that is an error",
        ty: Ty::Bool,
        range: &[],
    },
];

/// `picture things to "…" { … }`.
pub const PICTURE: &[Setting] = &[
    Setting {
        key: "view",
        docs: "Position of the eye: a word, or the direction from the model to the eye, as in `(1, -2, 0.5)`.",
        default: "isometric",
        ty: Ty::OneOf(&[Ty::Choice(VIEWS), Ty::Direction]),
        range: &[],
    },
    Setting {
        key: "views",
        docs: "Several views on one sheet, each as for `view`, 16 at most.",
        default: "one view",
        ty: Ty::List(&Ty::OneOf(&[Ty::Choice(VIEWS), Ty::Direction])),
        range: &[],
    },
    Setting {
        key: "up",
        docs: "Direction that is up in the picture.",
        default: "z, in `top` and `bottom` y",
        ty: Ty::Direction,
        range: &[],
    },
    Setting { key: "perspective", docs: "Near things are larger.", default: "false", ty: Ty::Bool, range: &[] },
    Setting { key: "zoom", docs: "Things that fill the picture.", default: "everything drawn", ty: Ty::Any, range: &[] },
    Setting { key: "width", docs: "Pixels across.", default: "1200", ty: Ty::Count, range: &[] },
    Setting { key: "height", docs: "Pixels down.", default: "800", ty: Ty::Count, range: &[] },
    Setting {
        key: "shade",
        docs: "What the colours of faces show: light only (`plain`), the surface (`names`), the side of the normal (`side`), \
               quality or longest side of elements (`quality`, `size`), reflected stripes that break where the tangent plane does \
               (`zebra`), reflected parallel lamps (`reflection`), bands of equal angle between normal and z (`isophotes`), the larger principal curvature \
               (`curvature`), the mean or the Gauss curvature (`mean`, `gauss`).",
        default: "plain",
        ty: Ty::Choice(SHADES),
        range: &[],
    },
    Setting { key: "elements", docs: "Edges of elements are drawn.", default: "true", ty: Ty::Bool, range: &[] },
    Setting {
        key: "borders",
        docs: "Edges of faces are drawn: free ones red, folds (inside a surface and between two) orange, edges of three faces or more purple.",
        default: "true",
        ty: Ty::Bool,
        range: &[],
    },
    Setting {
        key: "network",
        docs: "The model's curves and nodes are drawn as well.",
        default: "whether `network` is among the things",
        ty: Ty::Bool,
        range: &[],
    },
    Setting {
        key: "combs",
        docs: "Curvature combs stand on the curves that are drawn: teeth away from the centre of curvature, as long as the curvature is large.",
        default: "false",
        ty: Ty::Bool,
        range: &[],
    },
    Setting {
        key: "labels",
        docs: "Names of surfaces, curves, links, nodes and points are shown.",
        default: "whether curves or points are drawn",
        ty: Ty::Bool,
        range: &[],
    },
    Setting {
        key: "title",
        docs: "Words above the picture, none with `\"\"`.",
        default: "the model and what is drawn",
        ty: Ty::Text,
        range: &[],
    },
    Setting { key: "axes", docs: "The directions of x, y and z are shown in a corner.", default: "true", ty: Ty::Bool, range: &[] },
    Setting { key: "ruler", docs: "A scale bar is shown.", default: "true", ty: Ty::Bool, range: &[] },
    Setting { key: "legend", docs: "A legend of colours and lines is shown.", default: "true", ty: Ty::Bool, range: &[] },
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
pub(crate) fn words() -> impl Iterator<Item = &'static str> {
    BLOCKS.iter().flat_map(|block| block.1).filter(|s| !matches!(s.key, "unit" | "units")).filter_map(|s| s.ty.choices()).flatten().copied()
}

/// What a setting may be, in words; empty where its type says all.
pub fn range(setting: &Setting) -> String {
    match setting.key {
        "width" | "height" => format!("{} to {} pixels", limits::PICTURE_LEAST, limits::PICTURE_SIDE),
        _ => setting.range.iter().map(|bound| bound.1).collect::<Vec<_>>().join(", "),
    }
}

/// ` = triangles`; empty where nothing holds unless it is said.
pub fn default_words(setting: &Setting) -> String {
    if setting.default.is_empty() { String::new() } else { format!(" = {}", setting.default) }
}
