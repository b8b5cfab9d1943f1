//! Floor 5: meshes. Faces are asked for points and normals only; nothing here knows what kind a surface is.

pub mod data;
pub mod plan;

pub use data::{FaceRange, Group, Mesh};
pub use plan::{Elements, Method, Plan, Rule, Target};
