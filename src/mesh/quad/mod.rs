//! Free faces of quads: triangles paired, cells halved, nodes smoothed.

pub mod fit;
pub mod maker;
pub mod net;
pub mod net_check;
pub mod odd;
pub mod open;
pub mod pair;
pub mod repaired;
pub mod smooth;
pub mod split;
pub mod swap;
