//! What a writer of meshes gets: the mesh, the unit of the file and the settings of the export.

use glam::DVec3;

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
    /// Colours of surfaces by name, red, green and blue from 0 to 1 as screens take them (sRGB); for formats that hold them.
    pub colors: Vec<(String, [f64; 3])>,
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

    /// [`node`](Self::node) as a vector.
    pub fn place(&self, node: u32) -> DVec3 {
        DVec3::from_array(self.node(node as usize))
    }

    /// The colour of a surface, where one is known.
    pub fn color(&self, surface: &str) -> Option<[f64; 3]> {
        self.options.colors.iter().find(|(name, _)| name == surface).map(|(_, rgb)| *rgb)
    }

    /// Whether the file is text, with the format's default.
    pub fn is_text(&self, default: Encoding) -> bool {
        self.options.encoding.unwrap_or(default) == Encoding::Text
    }
}
