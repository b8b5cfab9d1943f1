//! The words of a golden file: every kind of line with its words and what stands behind each of them.

use super::cells::{self, Entry};
use crate::lang::units::{length_unit, number_text};

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
    pub fields: &'static [Field],
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

const BOX: Field = field("box", Kind::Corners);
/// Centre of what there is: of the length of curves, the area of surfaces, the nodes of meshes.
const CENTROID: Field = list("centroid", 1);
/// Mean squares about the centroid: xx, yy, zz, xy, yz, zx.
const SPREAD: Field = list("spread", 2);
/// Mean cubes about the centroid: xxx, yyy, zzz.
const SKEW: Field = list("skew", 3);
/// Area vector: area times mean normal.
const SIDE: Field = list("side", 2);
/// Volume between it and its centroid, negative where the normal looks at the centroid.
const INSIDE: Field = length("inside", 3);

/// All kinds of lines but diagnostics, in the order of writing.
pub const KINDS: &[LineKind] = &[
    LineKind { word: "network", named: false, spoken: true, fields: &[count("curves"), count("links"), count("nodes"), count("modeling")] },
    LineKind { word: "point", named: true, spoken: false, fields: &[list("at", 1)] },
    LineKind {
        word: "curve",
        named: true,
        spoken: false,
        fields: &[
            field("kind", Kind::Word),
            length("length", 1),
            count("links"),
            list("from", 1),
            list("to", 1),
            BOX,
            CENTROID,
            SPREAD,
            SKEW,
            list("round", 2),
        ],
    },
    LineKind {
        word: "modeling",
        named: true,
        spoken: true,
        fields: &[
            length("length", 1),
            count("links"),
            count("kinks"),
            list("from", 1),
            list("to", 1),
            CENTROID,
            SPREAD,
            SKEW,
            list("round", 2),
        ],
    },
    LineKind {
        word: "topology",
        named: false,
        spoken: true,
        fields: &[count("patches"), count("edges"), count("vertices"), count("shells")],
    },
    LineKind {
        word: "surface",
        named: true,
        spoken: false,
        fields: &[
            field("kind", Kind::Word),
            field("flow", Kind::Word),
            count("patches"),
            count("edges"),
            count("vertices"),
            length("area", 2),
            BOX,
            CENTROID,
            SPREAD,
            SKEW,
            SIDE,
            INSIDE,
        ],
    },
    LineKind {
        word: "shell",
        named: true,
        spoken: false,
        fields: &[
            count("faces"),
            field("closed", Kind::Word),
            length("area", 2),
            length("volume", 3),
            length("gap", 1),
            field("angle", Kind::Real(Measure::Angle)),
            BOX,
            CENTROID,
            SPREAD,
            SKEW,
            SIDE,
            INSIDE,
        ],
    },
    LineKind { word: "group", named: true, spoken: true, fields: HELD },
    LineKind {
        word: "mesh",
        named: true,
        spoken: true,
        fields: &[
            count("nodes"),
            count("triangles"),
            count("quads"),
            count("order"),
            field("min_angle", Kind::Real(Measure::Angle)),
            field("max_angle", Kind::Real(Measure::Angle)),
            field("mean_quality", Kind::Real(Measure::Ratio)),
            field("min_quality", Kind::Real(Measure::Ratio)),
            field("max_aspect", Kind::Real(Measure::Ratio)),
            length("area", 2),
            length("chord_error", 1),
            field("watertight", Kind::Word),
            count("parts"),
            BOX,
            CENTROID,
            SPREAD,
            SKEW,
            SIDE,
            INSIDE,
            field("groups", Kind::Groups),
            field("hash", Kind::Word),
        ],
    },
    LineKind { word: "set", named: true, spoken: true, fields: &[count("nodes"), count("elements"), BOX, CENTROID, SPREAD, SKEW, SIDE] },
    LineKind { word: "settings", named: true, spoken: true, fields: SETTINGS },
    LineKind { word: "report", named: true, spoken: true, fields: &[count("rows"), field("columns", Kind::Word)] },
    LineKind { word: "row", named: true, spoken: true, fields: &[field("cells", Kind::Cells)] },
    LineKind {
        word: "check",
        named: true,
        spoken: true,
        fields: &[field("", Kind::Verdict), field("left", Kind::Cells), field("right", Kind::Cells), field("within", Kind::Cells)],
    },
    LineKind { word: "export", named: true, spoken: true, fields: OUTPUT },
    LineKind { word: "picture", named: true, spoken: true, fields: OUTPUT },
];

/// What things are where: of a group, a rule, an output.
const HELD: &[Field] = &[count("points"), count("curves"), count("surfaces"), count("meshes"), BOX, CENTROID, SPREAD, SKEW];

/// What is asked of a mesh, and of parts of it.
const SETTINGS: &[Field] = &[
    length("size", 1),
    length("chord_error", 1),
    field("angle_error", Kind::Real(Measure::Angle)),
    length("min_size", 1),
    field("growth", Kind::Real(Measure::Ratio)),
    count("smooth"),
    field("elements", Kind::Word),
    count("order"),
    field("method", Kind::Word),
    field("conforming", Kind::Word),
    count("count"),
    field("bias", Kind::Real(Measure::Ratio)),
    length("radius", 1),
    count("points"),
    count("curves"),
    count("surfaces"),
    count("meshes"),
    BOX,
    CENTROID,
    SPREAD,
    SKEW,
];

/// What is written, and how.
const OUTPUT: &[Field] = &[
    field("of", Kind::Word),
    field("encoding", Kind::Word),
    field("element", Kind::Word),
    field("units", Kind::Word),
    field("pixels", Kind::Word),
    field("eye", Kind::List(Measure::Ratio)),
    field("up", Kind::List(Measure::Ratio)),
    field("view", Kind::Word),
    field("shade", Kind::Word),
    field("zoom", Kind::Word),
    field("title", Kind::Word),
    field("show", Kind::Word),
    count("rows"),
    field("columns", Kind::Word),
    count("points"),
    count("curves"),
    count("surfaces"),
    count("meshes"),
    BOX,
    CENTROID,
    SPREAD,
    SKEW,
];

/// Words of a diagnostic, behind its message.
pub const DIAGNOSTIC: &[Field] = &[field("at", Kind::Source), field("in", Kind::Word), count("more")];

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
pub fn fields_of(word: &str) -> &'static [Field] {
    if is_code(word) { DIAGNOSTIC } else { kind_of(word).map_or(&[], |kind| kind.fields) }
}

/// What stands behind a word of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A phrase, a verdict or a stretch of source.
    Word(String),
    /// A whole number.
    Count(u64),
    /// A number and its unit (empty for a bare one).
    Real(f64, String),
    /// Names with counts.
    Groups(Vec<(String, u64)>),
    /// Two corners and their unit.
    Corners([[f64; 3]; 2], String),
    /// Numbers and their unit (empty for bare ones).
    List(Vec<f64>, String),
    /// A row of a table.
    Cells(Vec<Entry>),
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

/// Numbers as far as the largest of them is written with so many significant digits.
fn together(all: &[f64], digits: usize) -> Vec<String> {
    let exponent = |x: f64| format!("{x:e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    let most = exponent(all.iter().fold(0.0, |most, x| most.max(x.abs())));
    let one = |x: &f64| match digits as i32 - (most - exponent(*x)) {
        _ if *x == 0.0 => "0".to_owned(),
        left if left > 0 => rounded(*x, left as usize),
        _ => "0".to_owned(),
    };
    all.iter().map(one).collect()
}

/// A number with so many significant digits, or with all it has.
pub fn rounded(x: f64, digits: usize) -> String {
    let cut: f64 = format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x);
    number_text(cut)
}

impl Value {
    /// As written in a golden file, reals with so many significant digits.
    pub fn text(&self, kind: Kind, digits: usize) -> String {
        let number = |x: &f64| rounded(*x, digits);
        let with_unit = |text: String, unit: &str| if unit.is_empty() { text } else { format!("{text} {unit}") };
        match self {
            Self::Word(word) if kind == Kind::Source => format!("`{word}`"),
            Self::Word(word) => phrase(word),
            Self::Count(n) => n.to_string(),
            Self::Real(x, unit) => with_unit(number(x), unit),
            Self::Groups(groups) => groups.iter().map(|(name, n)| format!("{}:{n}", label(name))).collect::<Vec<_>>().join(" "),
            Self::Cells(row) => cells::text(row, digits),
            Self::List(all, unit) => with_unit(format!("({})", together(all, digits).join(", ")), unit),
            Self::Corners(corners, unit) => {
                let point = |p: &[f64; 3]| format!("({})", p.iter().map(number).collect::<Vec<_>>().join(", "));
                with_unit(format!("{} {}", point(&corners[0]), point(&corners[1])), unit)
            }
        }
    }

    /// What a text says; the error is what was expected instead.
    pub fn parse(kind: Kind, text: &str) -> Result<Self, String> {
        match kind {
            Kind::Word => Ok(Self::Word(if text.starts_with('"') { unquoted(text)? } else { text.to_owned() })),
            Kind::Verdict => Ok(Self::Word(text.to_owned())),
            Kind::Source => match text.strip_prefix('`').and_then(|t| t.strip_suffix('`')) {
                Some(inside) => Ok(Self::Word(inside.to_owned())),
                None => Err("a stretch of the script between backquotes".to_owned()),
            },
            Kind::Count => text.parse().map(Self::Count).map_err(|_| "a whole number".to_owned()),
            Kind::Real(measure) => real(measure, text),
            Kind::Groups => groups(text),
            Kind::Cells => cells::parse(text).map(Self::Cells),
            Kind::List(measure) => list_of(measure, text),
            Kind::Corners => corners(text).ok_or_else(|| "two corners and a unit: `(0, 0, 0) (4, 3, 1) m`".to_owned()),
        }
    }
}

/// A finite number.
pub fn number(text: &str) -> Option<f64> {
    crate::base::text::parse_real(text).filter(|x| x.is_finite())
}

/// Whether a unit measures this, and what stands behind a number that does.
fn is_unit_of(measure: Measure, unit: &str) -> (bool, String) {
    match measure {
        Measure::Length(power) => {
            let tail = if power == 1 { String::new() } else { power.to_string() };
            (unit.strip_suffix(tail.as_str()).is_some_and(|name| length_unit(name).is_some()), format!(" m{tail}"))
        }
        Measure::Angle => (unit == "deg", " deg".to_owned()),
        Measure::Ratio => (unit.is_empty(), String::new()),
    }
}

fn real(measure: Measure, text: &str) -> Result<Value, String> {
    let (value, unit) = text.split_once(' ').unwrap_or((text, ""));
    let unit = unit.trim();
    let (known, tail) = is_unit_of(measure, unit);
    match number(value) {
        Some(x) if known => Ok(Value::Real(x, unit.to_owned())),
        _ if measure == Measure::Ratio => Err("a number like `0.95`".to_owned()),
        _ => Err(format!("a number and its unit like `12.5{tail}`")),
    }
}

fn list_of(measure: Measure, text: &str) -> Result<Value, String> {
    let wanted = |tail: &str| format!("numbers in brackets{} like `(4, 3, 1){tail}`", if tail.is_empty() { "" } else { " and their unit" });
    let (inside, unit) = text.strip_prefix('(').and_then(|t| t.split_once(')')).unwrap_or(("", ""));
    let unit = unit.trim();
    let (known, tail) = is_unit_of(measure, unit);
    let all: Option<Vec<f64>> = inside.split(',').map(|x| number(x.trim())).collect();
    all.filter(|_| known).map(|all| Value::List(all, unit.to_owned())).ok_or_else(|| wanted(&tail))
}

fn groups(text: &str) -> Result<Value, String> {
    let wanted = || "names with counts like `supports:12 \"west wall\":4`".to_owned();
    let mut found: Vec<(String, u64)> = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let (name, after) = if rest.starts_with('"') {
            let end = end_of_quote(rest).ok_or_else(wanted)?;
            (unquoted(&rest[..end])?, rest[end..].strip_prefix(':').ok_or_else(wanted)?)
        } else {
            let (name, after) = rest.split_once(':').ok_or_else(wanted)?;
            (name.to_owned(), after)
        };
        let (count, after) = after.split_once(' ').unwrap_or((after, ""));
        found.push((name, count.parse().map_err(|_| wanted())?));
        rest = after.trim_start();
    }
    if let Some((_, (name, _))) = found.iter().enumerate().find(|(k, g)| found[..*k].iter().any(|o| o.0 == g.0)) {
        return Err(format!("each group once, and `{name}` stands there twice"));
    }
    if found.is_empty() { Err(wanted()) } else { Ok(Value::Groups(found)) }
}

fn corners(text: &str) -> Option<Value> {
    let (first, rest) = text.strip_prefix('(')?.split_once(')')?;
    let (second, unit) = rest.trim_start().strip_prefix('(')?.split_once(')')?;
    let point = |inside: &str| {
        let parts: Vec<f64> = inside.split(',').map(|x| number(x.trim())).collect::<Option<_>>()?;
        <[f64; 3]>::try_from(parts).ok()
    };
    let unit = unit.trim();
    length_unit(unit)?;
    Some(Value::Corners([point(first)?, point(second)?], unit.to_owned()))
}

/// A name as a line's head or a group holds it: quoted where it is more than one plain word.
pub fn label(name: &str) -> String {
    let plain = !name.is_empty()
        && !name.starts_with("//")
        && !name.contains(|c: char| c.is_whitespace() || c.is_control() || "\"`:\\".contains(c));
    if plain { name.to_owned() } else { quoted(name) }
}

/// A phrase: quoted only where it could be misread.
fn phrase(text: &str) -> String {
    let odd =
        text.is_empty() || text != text.trim() || text.contains("  ") || text.contains("//") || text.starts_with('"') || text.contains('`');
    if odd || text.contains(char::is_control) { quoted(text) } else { text.to_owned() }
}

/// Between quotes, with `\"`, `\\` and `\u{…}` for what cannot stand there.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            c if c.is_control() => out.push_str(&format!("\\u{{{:x}}}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// Bytes up to behind the closing quote of a text that begins with one.
pub fn end_of_quote(text: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return Some(at + 1),
            '\\' if !escaped => escaped = true,
            _ => escaped = false,
        }
    }
    None
}

/// The text between quotes.
pub fn unquoted(text: &str) -> Result<String, String> {
    let inside = match end_of_quote(text) {
        Some(end) if end == text.len() && end >= 2 => &text[1..end - 1],
        _ => return Err("a text between quotes".to_owned()),
    };
    let mut out = String::new();
    let mut letters = inside.chars();
    while let Some(c) = letters.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match letters.next() {
            Some('n') => out.push('\n'),
            Some('u') => {
                let code: String = letters.by_ref().skip_while(|c| *c == '{').take_while(|c| *c != '}').collect();
                let found = u32::from_str_radix(&code, 16).ok().and_then(char::from_u32);
                out.push(found.ok_or("`\\u{…}` with a character's number")?);
            }
            Some(c) => out.push(c),
            None => return Err("something behind `\\`".to_owned()),
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(kind: Kind, text: &str) {
        let value = Value::parse(kind, text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(value.text(kind, 17), text);
    }

    #[test]
    fn values_read_back() {
        check(Kind::Real(Measure::Length(2)), "9.424777961 m2");
        check(Kind::Real(Measure::Angle), "38.2 deg");
        check(Kind::Groups, "supports:12 \"west \\\"wall\\\"\":4");
        check(Kind::Corners, "(0, -1.5, 0) (4, 1e300, 1) mm");
        check(Kind::List(Measure::Length(2)), "(0, -1.5, 12345678901, 2, 3, 4) mm2");
        assert_eq!(
            Value::List(vec![1234.5, 0.001_234_5, 1e-9], "m".to_owned()).text(Kind::List(Measure::Length(1)), 8),
            "(1234.5, 0.0012, 0) m"
        );
        check(Kind::Source, "`near A { size: 20mm }`");
        check(Kind::Word, "degenerate trilateral closed in u");
        check(Kind::Count, "63");
    }

    #[test]
    fn what_is_wrong_is_said() {
        let said = |kind, text| Value::parse(kind, text).unwrap_err();
        assert_eq!(said(Kind::Count, "63 triangles 96"), "a whole number");
        assert_eq!(said(Kind::Real(Measure::Length(2)), "9.4 m"), "a number and its unit like `12.5 m2`");
        assert_eq!(said(Kind::Real(Measure::Length(1)), "nan m"), "a number and its unit like `12.5 m`");
        assert_eq!(said(Kind::Groups, "a:1 a:2"), "each group once, and `a` stands there twice");
    }

    #[test]
    fn any_text_survives_its_quotes() {
        for text in ["", "a", "\"", "\\", "a\nb\t\u{1b}", "지붕 // x", "`x`", "a\\u{"] {
            assert_eq!(unquoted(&quoted(text)).as_deref(), Ok(text));
        }
    }
}
