//! Curves as points along them, and what a format for curves is.

use std::io::{self, Write};

use glam::DVec3;

use crate::io::files::loss::Loss;

/// A curve as the points that stand for it, in units of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// Name as declared.
    pub name: String,
    /// Points along it; of a closed one the first point is not repeated.
    pub points: Vec<DVec3>,
    /// Whether the last point joins the first.
    pub closed: bool,
}

/// Curves to write.
pub struct Drawing<'a> {
    /// The curves.
    pub curves: &'a [Polyline],
    /// Name of the unit of length in the file, for example "mm".
    pub unit: &'a str,
}

/// A format for curves.
pub struct CurveFormat {
    /// Short name, which is its ending.
    pub name: &'static str,
    /// Writes a drawing.
    pub write: fn(&Drawing, &mut dyn Write) -> io::Result<Vec<Loss>>,
}
