//! How far chords and triangles are from curves and surfaces: bounded, proved, measured.

pub mod bend_bounds;
pub mod certify;
pub mod curve;
pub mod edge_length;
pub mod flat_triangle;
pub mod measure;
pub mod poles;
pub mod proof;
pub mod quadratic;
pub mod sides;
pub mod triangle;
