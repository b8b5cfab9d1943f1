//! What is written into a file: points, curves and faces with their names, and the unit, accuracy and schema of the file.

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::io::cad::bodies::Faces;
use crate::io::step::write::product::Schema;
use crate::network::Chain;

/// One thing to write.
#[derive(Clone, Debug)]
pub enum StepShape {
    /// A point, model units.
    Point(DVec3),
    /// A curve.
    Curve(Chain),
    /// Faces.
    Faces(Box<Faces>),
}

/// A thing with its name and what is known of it.
#[derive(Clone, Debug)]
pub struct StepThing {
    /// Name as declared, empty for none.
    pub name: String,
    /// Groups that it belongs to.
    pub layers: Vec<String>,
    /// What it is.
    pub shown: StepShape,
    /// Red, green and blue from 0 to 1 of a curve that has a colour.
    pub color: Option<[f64; 3]>,
    /// Area and volume that a reader can compare.
    pub measured: Measured,
    /// The product of an imported assembly that it is of, by the place in the list of nodes.
    pub node: Option<usize>,
}

/// What a file is to be.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Its application protocol.
    pub schema: Schema,
    /// Name of its unit as scripts have it.
    pub unit: &'static str,
    /// Its unit and accuracy.
    pub scale: StepScale,
}

/// Area and volume, model units.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measured {
    /// Area of faces.
    pub area: Option<f64>,
    /// Volume of solids.
    pub volume: Option<f64>,
}

/// How lengths go into the file.
#[derive(Clone, Copy, Debug)]
pub struct StepScale {
    /// Model units in one unit of the file.
    pub model: f64,
    /// Of the model: what is no B-spline is within it.
    pub tolerance: Tolerance,
}
