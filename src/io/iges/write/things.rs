//! What is written into a file: points, curves, surfaces and bodies with their names, and the unit and accuracy of the file.

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::io::cad::bodies::Faces;
use crate::network::Chain;
use crate::surface::Surface;

/// One thing to write.
#[derive(Clone, Debug)]
pub enum IgesShape {
    /// A point, model units.
    Point(DVec3),
    /// A curve.
    Curve(Chain),
    /// A surface by itself.
    Surface(Surface),
    /// Faces that share their edges: a solid where they close.
    Faces(Box<Faces>),
    /// The same for a surface by itself, which goes out as that where its edges do not close.
    Face(Box<Faces>, Surface),
}

/// Things with their names; those under one group name become a group.
#[derive(Clone, Debug)]
pub struct IgesThing {
    /// Name as declared, empty for none.
    pub name: String,
    /// The shell or group it belongs to, empty for none.
    pub group: String,
    /// Layers that it is on.
    pub layers: Vec<String>,
    /// Red, green and blue from 0 to 1, where it has a colour.
    pub color: Option<[f64; 3]>,
    /// What it is.
    pub shown: IgesShape,
}

impl IgesThing {
    /// Layers that it or a face of it is on.
    pub(super) fn all_layers(&self) -> impl Iterator<Item = &str> {
        let faces = if let IgesShape::Faces(faces) | IgesShape::Face(faces, _) = &self.shown {
            Some(faces.layers.values().flatten())
        } else {
            None
        };
        self.layers.iter().chain(faces.into_iter().flatten()).map(String::as_str)
    }
}

/// Unit and accuracy of a file.
#[derive(Clone, Copy, Debug)]
pub struct IgesScale {
    /// Name of the file's unit as scripts have it.
    pub unit: &'static str,
    /// Model units in one unit of the file.
    pub model: f64,
    /// Of the model: surfaces that are no B-splines are within it.
    pub tolerance: Tolerance,
}
