//! Free faces of quads: triangles paired, cells halved, nodes smoothed.

pub mod limit_repair;
pub mod net;
pub mod net_check;
pub mod net_fit;
pub mod odd;
pub mod open;
pub mod pair;
pub mod quad_face;
pub mod settings;
pub mod smooth;
pub mod split;
pub mod swap;
