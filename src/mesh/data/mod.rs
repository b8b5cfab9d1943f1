//! Meshes and their faces as plain arrays, with their quality.

pub mod edge_uses;
pub mod face_geometry;
pub mod face_mesh;
pub mod hash;
pub mod mesh;
pub mod mesh_check;
pub mod moved;
pub mod node_sizes;
pub mod parts;
pub mod quality;
pub mod section;
