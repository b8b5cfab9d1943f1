//! Types as builtins, `fn`s and messages know them, and how typed Rust values come out of values and go back.

use crate::lang::values::units;
use crate::lang::values::value::{Dim, Value};

/// A type. Small and `Copy`, so that signatures are constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ty {
    /// Anything.
    Any,
    /// `none`.
    None,
    /// `true`, `false`.
    Bool,
    /// A bare number; `30%` too.
    Number,
    /// A whole number, 0 or more.
    Count,
    /// A whole number.
    Whole,
    /// A number of this dimension; a bare number is taken in model units where it is a power of a length.
    Quantity(Dim),
    /// A length, or a share in percent.
    Size,
    /// A number of any dimension.
    Measure,
    /// A fraction or percentage (bare), or a length.
    Station,
    /// Text.
    Text,
    /// A word.
    Word,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A point: a tuple, a node, a vertex.
    Point,
    /// A direction: a tuple of any dimension.
    Direction,
    /// A vector of any dimension.
    Vector,
    /// A direction, or a straight curve that gives one.
    Axis,
    /// A curve, modeling curve or link.
    Curve,
    /// A node.
    Node,
    /// A link.
    Link,
    /// An edge.
    Edge,
    /// A vertex.
    Vertex,
    /// A patch.
    Patch,
    /// A surface.
    Surface,
    /// A shell.
    Shell,
    /// A mesh.
    Mesh,
    /// An unbounded plane.
    Plane,
    /// A record.
    Record,
    /// A range of whole numbers.
    Range,
    /// An imported table.
    Table,
    /// An imported part, or a body or group of it.
    Part,
    /// A module.
    Module,
    /// The network of a script.
    Network,
    /// A plot or a lines plan.
    Drawing,
    /// A list of these; a range is a list of whole numbers. See [`Ty::is_thing`] for what a list of things takes.
    List(&'static Ty),
    /// All remaining positional arguments, nested lists flattened.
    Rest(&'static Ty),
    /// This, or `none`.
    Optional(&'static Ty),
    /// Any of these.
    OneOf(&'static [Ty]),
}

impl Ty {
    /// The type in words, for messages: "a length", "a list of points".
    pub fn words(self) -> String {
        match self {
            Self::Any => "a value".into(),
            Self::None => "none".into(),
            Self::Bool => "true or false".into(),
            Self::Number => "a number".into(),
            Self::Count => "a count".into(),
            Self::Whole => "a whole number".into(),
            Self::Quantity(dim) => dim_words(dim),
            Self::Size => "a length".into(),
            Self::Measure => "a number or quantity".into(),
            Self::Station => "a fraction or a length".into(),
            Self::Text => "a text".into(),
            Self::Word => "a word".into(),
            Self::Choice(words) => format!("one of {}", words.join(", ")),
            Self::Point => "a point".into(),
            Self::Direction => "a direction".into(),
            Self::Vector => "a vector".into(),
            Self::Axis => "a direction or a straight curve".into(),
            Self::Curve => "a curve".into(),
            Self::Node => "a node".into(),
            Self::Link => "a link".into(),
            Self::Edge => "an edge".into(),
            Self::Vertex => "a vertex".into(),
            Self::Patch => "a patch".into(),
            Self::Surface => "a surface".into(),
            Self::Shell => "a shell".into(),
            Self::Mesh => "a mesh".into(),
            Self::Plane => "an unbounded plane".into(),
            Self::Record => "a record".into(),
            Self::Range => "a range".into(),
            Self::Table => "a table".into(),
            Self::Part => "a part".into(),
            Self::Module => "a module".into(),
            Self::Network => "the network".into(),
            Self::Drawing => "a drawing".into(),
            Self::List(Self::Any) => "a list".into(),
            Self::List(of) | Self::Rest(of) => format!("a list of {}", plural(&of.words())),
            Self::Optional(of) => format!("{} or none", of.words()),
            Self::OneOf([one, Self::List(many)]) if one == *many => format!("{}, or a list of them", one.words()),
            Self::OneOf(of) => {
                let words: Vec<String> = of.iter().map(|t| t.words()).collect();
                words.join(" or ")
            }
        }
    }

    /// The type as signatures show it: `length`, `[point]`, `curve…`.
    pub fn signature(self) -> String {
        match self {
            Self::Any => "any".into(),
            Self::Whole => "whole number".into(),
            Self::Quantity(dim) => dim_name(dim).map_or_else(|| units::unit_text(dim, units::MILLIMETRE), str::to_owned),
            Self::Size => "length or %".into(),
            Self::Measure => "quantity".into(),
            Self::Station => "fraction|length".into(),
            Self::Choice(words) => words.join("|"),
            Self::Axis => "direction|curve".into(),
            Self::List(of) => format!("[{}]", of.signature()),
            Self::Rest(of) => format!("{}…", of.signature()),
            Self::Optional(of) => of.signature(),
            Self::OneOf([one, Self::List(many)]) if one == *many => format!("{}, or a list", one.signature()),
            Self::OneOf(of) => {
                let words: Vec<String> = of.iter().map(|t| t.signature()).collect();
                words.join("|")
            }
            Self::Bool => "bool".into(),
            other => {
                let words = other.words();
                words.split_once(' ').map_or(words.clone(), |(_, rest)| rest.to_owned())
            }
        }
    }

    /// Whether it is a list of some kind.
    pub fn is_list(self) -> bool {
        matches!(self, Self::List(_) | Self::Rest(_))
    }

    /// What a list of this type holds; anything for what is no list.
    pub fn member(self) -> Self {
        match self {
            Self::List(of) | Self::Rest(of) => *of,
            Self::Optional(of) => of.member(),
            Self::OneOf(of) => of.iter().map(|t| t.member()).find(|t| *t != Self::Any).unwrap_or(Self::Any),
            _ => Self::Any,
        }
    }

    /// Whether a list of these is a list of things: one of them counts as a list of one, and lists inside it flatten.
    /// Lists of lists (nets) and lists of anything keep their rows.
    pub fn is_thing(self) -> bool {
        match self {
            Self::Any | Self::List(_) | Self::Rest(_) => false,
            Self::Optional(of) => of.is_thing(),
            Self::OneOf(of) => of.iter().all(|t| t.is_thing()),
            _ => true,
        }
    }

    /// The words that may be given where this is wanted.
    pub fn choices(self) -> Option<&'static [&'static str]> {
        match self {
            Self::Choice(words) => Some(words),
            Self::Optional(of) => of.choices(),
            Self::OneOf(of) => of.iter().find_map(|t| t.choices()),
            _ => None,
        }
    }

    /// The type that a script writes as this name inside so many brackets.
    pub fn written(name: &str, lists: u8) -> Option<Self> {
        let i = TYPE_NAMES.iter().position(|t| *t == name)?;
        match lists {
            0 => Some(TYPES[i]),
            1 => Some(LISTS[i]),
            _ => Some(LISTS_OF_LISTS[i]),
        }
    }
}

/// The names of types that a script may write.
pub const TYPE_NAMES: &[&str] = &[
    "number",
    "count",
    "bool",
    "text",
    "word",
    "length",
    "area",
    "volume",
    "angle",
    "mass",
    "point",
    "direction",
    "node",
    "link",
    "curve",
    "surface",
    "patch",
    "edge",
    "vertex",
    "shell",
    "mesh",
    "list",
    "record",
];

/// The types of [`TYPE_NAMES`], in the same order.
static TYPES: [Ty; 23] = [
    Ty::Number,
    Ty::Count,
    Ty::Bool,
    Ty::Text,
    Ty::Word,
    Ty::Quantity(Dim::LENGTH),
    Ty::Quantity(Dim::AREA),
    Ty::Quantity(Dim::VOLUME),
    Ty::Quantity(Dim::ANGLE),
    Ty::Quantity(Dim::MASS),
    Ty::Point,
    Ty::Direction,
    Ty::Node,
    Ty::Link,
    Ty::Curve,
    Ty::Surface,
    Ty::Patch,
    Ty::Edge,
    Ty::Vertex,
    Ty::Shell,
    Ty::Mesh,
    Ty::List(&Ty::Any),
    Ty::Record,
];
static LISTS: [Ty; 23] = lists_of(&TYPES);
static LISTS_OF_LISTS: [Ty; 23] = lists_of(&LISTS);

const fn lists_of(types: &'static [Ty; 23]) -> [Ty; 23] {
    let mut lists = [Ty::Any; 23];
    let mut i = 0;
    while i < lists.len() {
        lists[i] = Ty::List(&types[i]);
        i += 1;
    }
    lists
}

fn dim_name(dim: Dim) -> Option<&'static str> {
    Some(match dim {
        Dim::NONE => "number",
        Dim::LENGTH => "length",
        Dim::AREA => "area",
        Dim::VOLUME => "volume",
        Dim::ANGLE => "angle",
        Dim::MASS => "mass",
        _ => return None,
    })
}

/// A dimension in words: "a length", "a quantity in kg/mm3".
pub fn dim_words(dim: Dim) -> String {
    match dim_name(dim) {
        Some("area") => "an area".into(),
        Some("angle") => "an angle".into(),
        Some(name) => format!("a {name}"),
        None => format!("a quantity in {}", units::unit_text(dim, units::MILLIMETRE)),
    }
}

/// "a length" → "lengths".
fn plural(words: &str) -> String {
    let bare = words.strip_prefix("a ").or_else(|| words.strip_prefix("an ")).unwrap_or(words);
    match bare {
        "vertex" => "vertices".into(),
        "patch" => "patches".into(),
        "mesh" => "meshes".into(),
        _ if bare.ends_with('s') || bare.contains(" of ") || bare.contains(" or ") => bare.to_owned(),
        _ => format!("{bare}s"),
    }
}

impl Value {
    /// What kind of value this is.
    pub fn ty(&self) -> Ty {
        match self {
            Self::None => Ty::None,
            Self::Bool(_) => Ty::Bool,
            Self::Number(q) if q.dim.is_none() => Ty::Number,
            Self::Number(q) => Ty::Quantity(q.dim),
            Self::Range(..) => Ty::Range,
            Self::Vector(_, Dim::LENGTH) => Ty::Point,
            Self::Vector(..) => Ty::Vector,
            Self::Text(_) => Ty::Text,
            Self::Word(_) => Ty::Word,
            Self::List(_) => Ty::List(&Ty::Any),
            Self::Record(r) if r.part.is_some() => Ty::Part,
            Self::Record(_) => Ty::Record,
            Self::Curve(_) => Ty::Curve,
            Self::Node(_) => Ty::Node,
            Self::Link(..) => Ty::Link,
            Self::Edge(..) => Ty::Edge,
            Self::Vertex(..) => Ty::Vertex,
            Self::Patch(..) => Ty::Patch,
            Self::Surface(_) => Ty::Surface,
            Self::Shell(_) => Ty::Shell,
            Self::Mesh(_) => Ty::Mesh,
            Self::Plane(_) => Ty::Plane,
            Self::Table(_) => Ty::Table,
            Self::Module(_) => Ty::Module,
            Self::Network(_) => Ty::Network,
            Self::Drawing(_) => Ty::Drawing,
        }
    }
}
