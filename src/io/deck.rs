//! What a mesh writer gets and gives, and the table of formats.

use std::io::{self, Write};

use super::endings::{Sort, ending_for, misfit};
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
    /// Element names of a deck (`S4R`, or `[S3R, S4R, B31]`) with the places that say them; each replaces the default of the shape it
    /// is for.
    pub elements: Vec<(String, Origin)>,
    /// Names of the groups that the script declares. A format without names loses these by a warning, while the sets that every
    /// mesh has by itself, one per surface and shell, are a word for those who ask.
    pub groups: Vec<String>,
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

/// What a format could not hold as it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Something was left out that was asked for: what, in words. A warning.
    LeftOut(String),
    /// Names that every mesh has are not in the file: which, in words. Told when asked.
    Unnamed(String),
    /// A set has another name in the file.
    Renamed(Renamed),
}

/// A name that stands otherwise in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renamed {
    /// Name in the model.
    pub from: String,
    /// Name in the file.
    pub to: String,
    /// Only the brackets of a family went, as in `ribs[3]`, `ribs_3`: this is so in every format and no warning.
    pub family: bool,
}

impl Loss {
    /// The warnings for the export `of` to `path` (as written): one for each thing left out, one for all new names.
    pub fn faults(losses: &[Self], of: Origin, path: &str) -> Vec<FileFault> {
        let mut faults = Vec::new();
        let mut names = Vec::new();
        for loss in losses {
            match loss {
                Self::LeftOut(what) => faults.push(FileFault::LeftOut { of, path: path.to_owned(), what: what.clone() }),
                Self::Renamed(renamed) if !renamed.family => names.push((renamed.from.clone(), renamed.to.clone())),
                Self::Renamed(_) | Self::Unnamed(_) => {}
            }
        }
        if !names.is_empty() {
            faults.push(FileFault::Renamed { of, path: path.to_owned(), names });
        }
        faults
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
    /// What of a mesh is kept in the file, in a few words: for the guide.
    pub holds: &'static str,
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

/// The ending of a path in lower case, without its dot.
pub fn extension(path: &str) -> String {
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    name.rsplit_once('.').map(|(_, ending)| ending.to_lowercase()).unwrap_or_default()
}

/// The mesh format that a path's ending chooses; E804 or E805 where it chooses none, E230 for one of a later version.
pub fn format_for(of: Origin, path: &str) -> Result<&'static Format, FileFault> {
    let ending = ending_for(of, path, Sort::Meshes)?;
    FORMATS.iter().find(|format| format.extensions.contains(&ending.as_str())).ok_or_else(|| misfit(of, path, Sort::Meshes))
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
        if self.name == "stl" && deck.mesh.triangles.is_empty() && deck.mesh.quads.is_empty() && !deck.mesh.nodes.is_empty() {
            let what = format!("STL holds triangles, and `{}` has none", deck.mesh.name);
            let help = Some("write its lines as .obj, .vtu or .msh".to_owned());
            return Err(FileFault::Unsupported { of, what, help, edits: Vec::new() });
        }
        let mut taken: Vec<(Shape, &str)> = Vec::new();
        for (name, of) in &deck.options.elements {
            let shape = self.element_shape(*of, deck, name)?;
            if let Some((_, other)) = taken.iter().find(|(known, _)| *known == shape) {
                let what = match other.eq_ignore_ascii_case(name) {
                    true => format!("`{name}` is named twice in `element:`"),
                    false => format!("`{other}` and `{name}` are both for {}, which can be only one of them", shape.words()),
                };
                let help = Some(format!("remove `{other}` or `{name}`"));
                return Err(FileFault::Unsupported { of: *of, what, help, edits: Vec::new() });
            }
            taken.push((shape, name));
        }
        Ok(())
    }

    /// Shapes that a mesh has.
    fn present(mesh: &Mesh) -> Vec<Shape> {
        let counts = [mesh.lines.len(), mesh.triangles.len(), mesh.quads.len()];
        Shape::of_order(mesh.order).into_iter().zip(counts).filter(|(_, n)| *n > 0).map(|(shape, _)| shape).collect()
    }

    /// Whether elements of a name's shape may stand for those of another.
    fn stands_for(&self, named: Shape, meshed: Shape) -> bool {
        named == meshed || self.name == "bdf" && (named, meshed) == (Shape::Line2, Shape::Line3)
    }

    /// The shape of the mesh that one name of `element:` is for; E805 for a name that the format does not know or the mesh has
    /// no elements for.
    fn element_shape(&self, of: Origin, deck: &Deck, name: &str) -> Result<Shape, FileFault> {
        if self.elements.is_empty() {
            let what = format!("{} has no element names, got `element: {name}`", self.name.to_uppercase());
            let help = Some("remove `element:`".to_owned());
            return Err(FileFault::Unsupported { of, what, help, edits: vec![Edit::DropSetting] });
        }
        let present = Self::present(deck.mesh);
        let fitting = || {
            let fits = |shape: &Shape| present.iter().any(|meshed| self.stands_for(*shape, *meshed));
            let names: Vec<&str> = self.elements.iter().filter(|(_, shape)| fits(shape)).map(|(name, _)| *name).collect();
            let edits = names.iter().map(|name| Edit::Put((*name).to_owned())).collect();
            (Some(format!("use one of {}", names.join(" "))), edits)
        };
        let Some((_, shape)) = self.elements.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)) else {
            let what = format!("{} has no element `{name}`", self.name.to_uppercase());
            let (help, edits) = fitting();
            return Err(FileFault::Unsupported { of, what, help, edits });
        };
        if let Some(meshed) = present.iter().find(|meshed| self.stands_for(*shape, **meshed)) {
            return Ok(*meshed);
        }
        let has = present.iter().map(|shape| shape.words()).collect::<Vec<_>>().join(" and ");
        let has = if has.is_empty() { "no elements".to_owned() } else { has };
        let what = format!("`element: {name}` is for {}, but `{}` has {has}", shape.words(), deck.mesh.name);
        let (help, edits) = fitting();
        Err(FileFault::Unsupported { of, what, help, edits })
    }

    /// The name for elements of a shape: the one asked for, else the default.
    pub fn element_name(&self, options: &Options, shape: Shape) -> &'static str {
        let asked =
            options.elements.iter().filter_map(|(asked, _)| self.elements.iter().find(|(name, _)| asked.eq_ignore_ascii_case(name)));
        let asked = asked.filter(|(_, named)| self.stands_for(*named, shape)).map(|(name, _)| *name).next();
        asked.or_else(|| self.elements.iter().find(|(_, s)| *s == shape).map(|(name, _)| *name)).unwrap_or("")
    }
}
