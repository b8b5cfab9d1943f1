//! How far chords and triangles are from curves and surfaces: bounded, proved, measured.

pub mod bend_bounds;
pub mod bend_tiles;
pub mod certify;
pub mod curve;
pub mod cut_off;
pub mod edge_length;
pub mod flat_triangle;
mod heights;
pub mod measure;
mod measure_grid;
pub mod point_triangle;
pub mod poles;
pub mod proof;
pub mod quadratic;
mod samples;
pub mod sides;
pub mod triangle;
