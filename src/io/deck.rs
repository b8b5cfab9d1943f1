//! What a mesh writer gets and gives, and the table of formats.

use std::io::{self, Write};

use super::{bdf, inp, msh, obj, ply, stl, vtu};
use crate::base::fault::{Edit, FileFault};
use crate::base::origin::Origin;
use crate::mesh::Mesh;

/// Text or binary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Binary,
    /// Readable text.
    Text,
}

/// Settings of an `export`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// `None`: the format's default.
    pub encoding: Option<Encoding>,
    /// Element names of a deck (`S4R`, or `[S3R, S4R]`); each replaces the default of the shape it has.
    pub elements: Vec<String>,
    /// Model units in one unit of the file; `None` when the file is in model units.
    pub units_per_file_unit: Option<f64>,
}

/// A mesh to write.
pub struct Deck<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Name of the unit of length in the file, for example "mm".
    pub unit: &'a str,
    /// Settings.
    pub options: &'a Options,
}

impl Deck<'_> {
    /// Coordinates of a node in units of the file.
    pub fn node(&self, index: usize) -> [f64; 3] {
        let p = self.mesh.nodes[index];
        match self.options.units_per_file_unit {
            Some(unit) => (p / unit).to_array(),
            None => p.to_array(),
        }
    }

    /// Whether the file is text, with the format's default.
    pub fn is_text(&self, default: Encoding) -> bool {
        self.options.encoding.unwrap_or(default) == Encoding::Text
    }
}

/// What a format could not hold; becomes a warning at the `export`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Something was left out: what, in words.
    LeftOut(String),
    /// A set was renamed: from, to.
    Renamed(String, String),
}

impl Loss {
    /// The warning for the export `of` to `path` (as written).
    pub fn fault(self, of: Origin, path: &str) -> FileFault {
        let path = path.to_owned();
        match self {
            Self::LeftOut(what) => FileFault::LeftOut { of, path, what },
            Self::Renamed(from, to) => FileFault::Renamed { of, path, from, to },
        }
    }
}

/// Shapes of elements, as decks tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Two nodes.
    Line2,
    /// Two nodes and the middle.
    Line3,
    /// Three nodes.
    Triangle3,
    /// Three corners and three mid nodes.
    Triangle6,
    /// Four nodes.
    Quad4,
    /// Four corners and four mid nodes.
    Quad8,
}

impl Shape {
    /// The shapes that a mesh of this order has: line, triangle, quad.
    pub fn of_order(order: u8) -> [Self; 3] {
        if order == 2 { [Self::Line3, Self::Triangle6, Self::Quad8] } else { [Self::Line2, Self::Triangle3, Self::Quad4] }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Line2 => "2-node lines",
            Self::Line3 => "3-node lines",
            Self::Triangle3 => "3-node triangles",
            Self::Triangle6 => "6-node triangles",
            Self::Quad4 => "4-node quads",
            Self::Quad8 => "8-node quads",
        }
    }
}

/// A file format.
pub struct Format {
    /// Short name.
    pub name: &'static str,
    /// Endings that choose it, in lower case.
    pub extensions: &'static [&'static str],
    /// Default encoding.
    pub encoding: Encoding,
    /// Encodings it has.
    pub encodings: &'static [Encoding],
    /// Element names of a deck with their shapes, the default of each shape first; empty where `element:` means nothing.
    pub elements: &'static [(&'static str, Shape)],
    /// Writes a deck.
    pub write: fn(&Deck, &mut dyn Write) -> io::Result<Vec<Loss>>,
}

/// All mesh formats.
pub const FORMATS: &[Format] = &[stl::FORMAT, obj::FORMAT, ply::FORMAT, vtu::FORMAT, msh::FORMAT, inp::FORMAT, bdf::FORMAT];

const fn element_count() -> usize {
    let (mut n, mut k) = (0, 0);
    while k < FORMATS.len() {
        n += FORMATS[k].elements.len();
        k += 1;
    }
    n
}

/// Element names of all formats: what `element:` may say.
pub const ELEMENT_NAMES: [&str; element_count()] = {
    let mut names = [""; element_count()];
    let (mut n, mut k) = (0, 0);
    while k < FORMATS.len() {
        let mut i = 0;
        while i < FORMATS[k].elements.len() {
            names[n] = FORMATS[k].elements[i].0;
            n += 1;
            i += 1;
        }
        k += 1;
    }
    names
};

/// Formats of a later version, by ending.
const LATER: &[(&str, &str)] = &[("glb", "glTF"), ("gltf", "glTF"), ("stp", "STEP"), ("step", "STEP"), ("html", "HTML")];

/// The ending of a path in lower case, without its dot.
pub fn extension(path: &str) -> String {
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    name.rsplit_once('.').map(|(_, ending)| ending.to_lowercase()).unwrap_or_default()
}

/// The mesh format that a path's ending chooses, or E804 (E230 for one of a later version).
pub fn format_for(of: Origin, path: &str) -> Result<&'static Format, FileFault> {
    let ending = extension(path);
    FORMATS
        .iter()
        .find(|format| format.extensions.contains(&ending.as_str()))
        .ok_or_else(|| no_format(of, path, FORMATS.iter().flat_map(|format| format.extensions.iter().copied()).collect()))
}

/// The fault for an ending that is none of `known`.
pub fn no_format(of: Origin, path: &str, known: Vec<&'static str>) -> FileFault {
    let ending = extension(path);
    match LATER.iter().find(|(name, _)| *name == ending) {
        Some((_, format)) => FileFault::LaterFormat { of, format },
        None => FileFault::NoSuchFormat { of, path: path.to_owned(), known },
    }
}

impl Format {
    /// E805 when the settings do not go with this format and mesh; asked before anything is written.
    pub fn check(&self, of: Origin, deck: &Deck) -> Result<(), FileFault> {
        if let Some(encoding) = deck.options.encoding
            && !self.encodings.contains(&encoding)
        {
            let (asked, has) = match encoding {
                Encoding::Binary => ("binary", "text"),
                Encoding::Text => ("text", "binary"),
            };
            let what = format!("{} has no {asked} encoding", self.name.to_uppercase());
            return Err(FileFault::Unsupported {
                of,
                what,
                help: Some(format!("encoding: {has}")),
                edits: vec![Edit::Set("encoding", has.to_owned())],
            });
        }
        deck.options.elements.iter().try_for_each(|name| self.element_shape(of, deck, name))
    }

    /// Checks one `element:`: known to the format, and of a shape that the mesh has.
    fn element_shape(&self, of: Origin, deck: &Deck, name: &str) -> Result<(), FileFault> {
        if self.elements.is_empty() {
            let what = format!("{} has no element names, got `element: {name}`", self.name.to_uppercase());
            return Err(FileFault::Unsupported { of, what, help: None, edits: Vec::new() });
        }
        let shapes = Shape::of_order(deck.mesh.order);
        let counts = [deck.mesh.lines.len(), deck.mesh.triangles.len(), deck.mesh.quads.len()];
        let present: Vec<Shape> = shapes.iter().zip(counts).filter(|(_, n)| *n > 0).map(|(shape, _)| *shape).collect();
        let fitting = |shape: Option<Shape>| {
            let names = self.elements.iter().filter(|(_, s)| shape.map_or(present.contains(s), |one| *s == one)).map(|(n, _)| *n);
            let names: Vec<&str> = names.collect();
            let edits = names.iter().map(|name| Edit::Set("element", (*name).to_owned())).collect();
            (Some(format!("use one of {}", names.join(" "))), edits)
        };
        let Some((_, shape)) = self.elements.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)) else {
            let what = format!("{} has no element `{name}`", self.name.to_uppercase());
            let (help, edits) = fitting(None);
            return Err(FileFault::Unsupported { of, what, help, edits });
        };
        if present.contains(shape) {
            return Ok(());
        }
        let has = present.iter().map(|shape| shape.words()).collect::<Vec<_>>().join(" and ");
        let what = format!("`element: {name}` is for {}, but `{}` has {has}", shape.words(), deck.mesh.name);
        let (help, edits) = fitting(None);
        Err(FileFault::Unsupported { of, what, help, edits })
    }

    /// The name for elements of a shape: the one asked for, else the default.
    pub fn element_name(&self, options: &Options, shape: Shape) -> &'static str {
        let of_shape = || self.elements.iter().filter(|(_, s)| *s == shape).map(|(name, _)| *name);
        let asked = of_shape().find(|name| options.elements.iter().any(|asked| asked.eq_ignore_ascii_case(name)));
        asked.or_else(|| of_shape().next()).unwrap_or("")
    }
}
