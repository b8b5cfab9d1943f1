//! A format for meshes: its endings, encodings and names of elements, and the check of the settings of an export against them.

use std::io::{self, Write};

use crate::base::fault::Edit;
use crate::base::origin::Origin;
use crate::io::files::fault::FormatFault;
use crate::io::files::loss::Loss;
use crate::io::mesh_files::closed_bodies::bodies;
use crate::io::mesh_files::deck::{Deck, Encoding, Options};
use crate::io::mesh_files::element_shape::Shape;
use crate::mesh::Mesh;

/// Which meshes a format takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// All.
    Any,
    /// Those that have triangles or quads, or nothing at all.
    Faces,
    /// Those whose faces enclose bodies, or that have nothing at all.
    Bodies,
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
    /// The meshes that it takes.
    pub takes: Takes,
    /// Name of the unit of length that all its files have; `None` where a file may be in any unit.
    pub unit: Option<&'static str>,
    /// Whether it holds the colours of surfaces.
    pub colors: bool,
    /// What of a mesh is kept in the file, in a few words: for the guide.
    pub holds: &'static str,
    /// Writes a deck.
    pub write: fn(&Deck, &mut dyn Write) -> io::Result<Vec<Loss>>,
}

impl Format {
    /// E805 when the settings do not go with this format and mesh; asked before anything is written.
    pub fn check(&self, of: Origin, deck: &Deck) -> Result<(), FormatFault> {
        if let Some(encoding) = deck.options.encoding
            && !self.encodings.contains(&encoding)
        {
            let (asked, has) = match encoding {
                Encoding::Binary => ("binary", "text"),
                Encoding::Text => ("text", "binary"),
            };
            let what = format!("{} has no {asked} encoding", self.name.to_uppercase());
            return Err(FormatFault::Unsupported {
                of,
                what,
                help: Some(format!("encoding: {has}")),
                edits: vec![Edit::Set("encoding", has.to_owned())],
            });
        }
        if self.takes != Takes::Any && deck.mesh.triangles.is_empty() && deck.mesh.quads.is_empty() && !deck.mesh.nodes.is_empty() {
            let what = format!("{} holds triangles, and `{}` has none", self.name.to_uppercase(), deck.mesh.name);
            let help = Some("write its lines as .obj, .vtu or .msh".to_owned());
            return Err(FormatFault::Unsupported { of, what, help, edits: Vec::new() });
        }
        if self.takes == Takes::Bodies
            && let Err(defect) = bodies(deck.mesh)
        {
            let what = format!("{} holds closed bodies, and `{}` has {}", self.name.to_uppercase(), deck.mesh.name, defect.words(deck));
            return Err(FormatFault::Unsupported { of, what, help: Some(defect.help().to_owned()), edits: Vec::new() });
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
                return Err(FormatFault::Unsupported { of: *of, what, help, edits: Vec::new() });
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
    fn element_shape(&self, of: Origin, deck: &Deck, name: &str) -> Result<Shape, FormatFault> {
        if self.elements.is_empty() {
            let what = format!("{} has no element names, got `element: {name}`", self.name.to_uppercase());
            let help = Some("remove `element:`".to_owned());
            return Err(FormatFault::Unsupported { of, what, help, edits: vec![Edit::DropSetting] });
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
            return Err(FormatFault::Unsupported { of, what, help, edits });
        };
        if let Some(meshed) = present.iter().find(|meshed| self.stands_for(*shape, **meshed)) {
            return Ok(*meshed);
        }
        let has = present.iter().map(|shape| shape.words()).collect::<Vec<_>>().join(" and ");
        let has = if has.is_empty() { "no elements".to_owned() } else { has };
        let what = format!("`element: {name}` is for {}, but `{}` has {has}", shape.words(), deck.mesh.name);
        let (help, edits) = fitting();
        Err(FormatFault::Unsupported { of, what, help, edits })
    }

    /// The name for elements of a shape: the one asked for, else the default.
    pub fn element_name(&self, options: &Options, shape: Shape) -> &'static str {
        let asked =
            options.elements.iter().filter_map(|(asked, _)| self.elements.iter().find(|(name, _)| asked.eq_ignore_ascii_case(name)));
        let asked = asked.filter(|(_, named)| self.stands_for(*named, shape)).map(|(name, _)| *name).next();
        asked.or_else(|| self.elements.iter().find(|(_, s)| *s == shape).map(|(name, _)| *name)).unwrap_or("")
    }
}
