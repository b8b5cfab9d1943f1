//! What a mesh writer gets and gives.

use std::io::{self, Write};

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
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `None`: the format's default.
    pub encoding: Option<Encoding>,
    /// Element name of a deck (`S4R`).
    pub element: Option<String>,
    /// Model units in one unit of the file (1 when the file is in model units).
    pub units_per_file_unit: Option<f64>,
}

/// A mesh to write.
pub struct Deck<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Name of the model unit, for example "mm".
    pub unit: &'a str,
    /// Settings.
    pub options: &'a Options,
}

/// What a format could not hold; becomes a warning at the `export`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Something was left out: what, in words.
    LeftOut(String),
    /// A set was renamed: from, to.
    Renamed(String, String),
}

/// A file format.
pub struct Format {
    /// Short name.
    pub name: &'static str,
    /// Endings that choose it, in lower case.
    pub extensions: &'static [&'static str],
    /// Default encoding.
    pub encoding: Encoding,
    /// Writes a deck.
    pub write: fn(&Deck, &mut dyn Write) -> io::Result<Vec<Loss>>,
}

/// All mesh formats.
pub const FORMATS: &[Format] = &[];
