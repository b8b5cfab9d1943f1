//! How far chords and triangles are from curves and surfaces: bounded, proved, measured.

pub mod certify;
pub mod curve;
pub mod measure;
pub mod poles;
pub mod sides;
pub mod triangle;
