//! The words of a golden file: every kind of line with its words, and what kind of value stands behind each of them.

/// What a real measures; its allowed change grows with the model's size to this power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A length, area or volume by its power, in model units.
    Length(u8),
    /// An angle, degrees.
    Angle,
    /// A bare number.
    Ratio,
}

/// What stands behind a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A phrase, compared letter by letter.
    Word,
    /// A whole number, compared exactly.
    Count,
    /// A real with its unit, compared within the tolerance.
    Real(Measure),
    /// `name:count …`, compared by name.
    Groups,
    /// `(x, y, z) (x, y, z) unit`: two corners of a box.
    Corners,
    /// `(x, y, z) unit`, each number compared within the tolerance.
    List(Measure),
    /// Cells of a row of a reported table, between ` | `.
    Cells,
    /// The same of numbers that may be tiny, such as a tolerance: each is compared as a share of itself.
    Limit,
    /// `pass` or `fail`, standing alone.
    Verdict,
    /// A stretch of source between backquotes.
    Source,
}

/// One word of a line.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// As written; empty for a value that stands alone.
    pub word: &'static str,
    /// What stands behind it.
    pub kind: Kind,
}

/// A kind of line.
#[derive(Debug)]
pub struct LineKind {
    /// Its first word.
    pub word: &'static str,
    /// Whether a name follows.
    pub named: bool,
    /// Whether what is said of it in words begins with the kind: `mesh fine: …`, not `roof: …`.
    pub spoken: bool,
    /// Its words, in the order of writing.
    fields: &'static [Fields],
}

const fn field(word: &'static str, kind: Kind) -> Field {
    Field { word, kind }
}

const fn count(word: &'static str) -> Field {
    field(word, Kind::Count)
}

const fn length(word: &'static str, power: u8) -> Field {
    field(word, Kind::Real(Measure::Length(power)))
}

const fn list(word: &'static str, power: u8) -> Field {
    field(word, Kind::List(Measure::Length(power)))
}

const fn real(word: &'static str, measure: Measure) -> Field {
    field(word, Kind::Real(measure))
}

/// Fields that several kinds of lines have, each declared once.
type Fields = &'static [Field];

/// The smallest and largest coordinates.
const BOX: Fields = &[field("box", Kind::Corners)];
/// How it lies: centre of the length of curves, the area of surfaces or the nodes of meshes; mean squares about it (xx, yy, zz, xy,
/// yz, zx); mean cubes (xxx, yyy, zzz).
const MOMENTS: Fields = &[list("centroid", 1), list("spread", 2), list("skew", 3)];
/// Area vector: area times mean normal.
const SIDE: Fields = &[list("side", 2)];
/// Volume between it and its centroid, negative where the normal points to the centroid.
const INSIDE: Fields = &[length("inside", 3)];
/// The way of a curve.
const ENDS: Fields = &[list("from", 1), list("to", 1)];
/// Area vector of what a closed curve goes round.
const ROUND: Fields = &[list("round", 2)];
/// What a group, a rule or an output holds.
const MEMBERS: Fields = &[count("points"), count("curves"), count("surfaces"), count("meshes")];
/// A table.
const TABLE: Fields = &[count("rows"), field("columns", Kind::Word)];
/// Counts of a surface or a model.
const PATCHES: Fields = &[count("patches"), count("edges"), count("vertices")];

/// Numbers of a mesh.
const MESH: Fields = &[
    count("nodes"),
    count("triangles"),
    count("quads"),
    count("order"),
    real("min_angle", Measure::Angle),
    real("max_angle", Measure::Angle),
    real("mean_quality", Measure::Ratio),
    real("min_quality", Measure::Ratio),
    real("max_aspect", Measure::Ratio),
    length("area", 2),
    length("chord_error", 1),
    field("watertight", Kind::Word),
    count("parts"),
];

/// What is asked of a mesh, and of parts of it.
const SETTINGS: Fields = &[
    length("size", 1),
    length("chord_error", 1),
    real("angle_error", Measure::Angle),
    length("min_size", 1),
    real("growth", Measure::Ratio),
    count("smooth"),
    field("elements", Kind::Word),
    count("order"),
    field("method", Kind::Word),
    field("conforming", Kind::Word),
    count("count"),
    real("bias", Measure::Ratio),
    length("radius", 1),
];

/// How a file or picture is written.
const WRITTEN: Fields = &[
    field("of", Kind::Word),
    field("encoding", Kind::Word),
    field("element", Kind::Word),
    field("schema", Kind::Word),
    field("shells", Kind::Word),
    field("units", Kind::Word),
    field("pixels", Kind::Word),
    field("eye", Kind::List(Measure::Ratio)),
    field("up", Kind::List(Measure::Ratio)),
    field("view", Kind::Word),
    field("views", Kind::Word),
    field("shade", Kind::Word),
    field("zoom", Kind::Word),
    field("title", Kind::Word),
    field("show", Kind::Word),
];

/// A line whose name follows its word, and which is spoken of with its word.
const fn named(word: &'static str, fields: &'static [Fields]) -> LineKind {
    LineKind { word, named: true, spoken: true, fields }
}

/// A line that is spoken of by its name alone.
const fn by_name(word: &'static str, fields: &'static [Fields]) -> LineKind {
    LineKind { word, named: true, spoken: false, fields }
}

/// A line of which there is one.
const fn single(word: &'static str, fields: &'static [Fields]) -> LineKind {
    LineKind { word, named: false, spoken: true, fields }
}

/// All kinds of lines but diagnostics, in the order of writing.
pub const KINDS: &[LineKind] = &[
    single("network", &[&[count("curves"), count("links"), count("nodes"), count("modeling")]]),
    by_name("point", &[&[list("at", 1)]]),
    by_name("curve", &[&[field("kind", Kind::Word), length("length", 1), count("links")], ENDS, BOX, MOMENTS, ROUND]),
    named("modeling", &[&[length("length", 1), count("links"), count("kinks")], ENDS, MOMENTS, ROUND]),
    single("topology", &[PATCHES, &[count("shells")]]),
    by_name(
        "surface",
        &[&[field("kind", Kind::Word), field("flow", Kind::Word)], PATCHES, &[length("area", 2)], BOX, MOMENTS, SIDE, INSIDE],
    ),
    by_name(
        "shell",
        &[
            &[count("faces"), field("closed", Kind::Word), length("area", 2), length("volume", 3), length("gap", 1)],
            &[real("angle", Measure::Angle)],
            BOX,
            MOMENTS,
            SIDE,
            INSIDE,
        ],
    ),
    named("group", &[MEMBERS, BOX, MOMENTS]),
    named("mesh", &[MESH, BOX, MOMENTS, SIDE, INSIDE, &[field("groups", Kind::Groups), field("hash", Kind::Word)]]),
    named("set", &[&[count("nodes"), count("elements")], BOX, MOMENTS, SIDE]),
    named("settings", &[SETTINGS, MEMBERS, BOX, MOMENTS]),
    named("report", &[TABLE]),
    named("row", &[&[field("cells", Kind::Cells)]]),
    named("check", &[&[field("", Kind::Verdict), field("left", Kind::Cells), field("right", Kind::Cells), field("within", Kind::Limit)]]),
    named("export", &[WRITTEN, TABLE, MEMBERS, BOX, MOMENTS]),
    named("picture", &[WRITTEN, TABLE, MEMBERS, BOX, MOMENTS]),
];

/// Words of a diagnostic, behind its message.
const DIAGNOSTIC: &[Fields] = &[&[field("at", Kind::Source), field("in", Kind::Word), count("more")]];

/// Whether the first word of a line is the code of a diagnostic.
pub fn is_code(word: &str) -> bool {
    let bytes = word.as_bytes();
    bytes.len() == 4 && matches!(bytes[0], b'E' | b'W' | b'N') && bytes[1..].iter().all(u8::is_ascii_digit)
}

/// The kind of line that begins with this word.
pub fn kind_of(word: &str) -> Option<&'static LineKind> {
    KINDS.iter().find(|kind| kind.word == word)
}

/// The fields of a line that begins with this word.
pub fn fields_of(word: &str) -> impl Iterator<Item = &'static Field> + Clone {
    let parts = if is_code(word) { DIAGNOSTIC } else { kind_of(word).map_or(&[] as &[Fields], |kind| kind.fields) };
    parts.iter().copied().flatten()
}

/// The unit of a measure in a model of this unit.
pub fn unit_of(measure: Measure, model: &str) -> String {
    match measure {
        Measure::Length(1) => model.to_owned(),
        Measure::Length(power) => format!("{model}{power}"),
        Measure::Angle => "deg".to_owned(),
        Measure::Ratio => String::new(),
    }
}
