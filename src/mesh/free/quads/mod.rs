//! Quads on faces that no map fits: cells of a crystal of squares, triangles paired, cells halved, nodes smoothed.

pub mod halves;
pub mod net;
pub mod odd;
pub mod open;
pub mod pair;
pub mod smooth;
pub mod split;
pub mod swap;
