//! Free faces of quads: triangles paired, cells halved, nodes smoothed.

mod cavity;
pub mod collapse;
mod disk;
pub mod equalize;
mod level_face;
pub mod limit_repair;
pub mod net;
pub mod net_check;
pub mod net_fit;
pub mod odd;
pub mod open;
pub mod optimize_nodes;
pub mod pair;
mod pattern;
mod placements;
pub mod plane;
mod polygon;
pub mod quad_face;
pub mod regular;
mod remesh;
pub mod settings;
pub mod smooth;
pub mod split;
pub mod swap;
