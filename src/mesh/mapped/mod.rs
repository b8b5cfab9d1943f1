//! Grids of quads and lattices of triangles over a rectangle or a triangle of (u, v).

pub mod diagonals;
pub mod grid;
pub mod trilateral;
