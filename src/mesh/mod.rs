//! Floor 5: meshes. Faces are asked for points and normals only; nothing here knows what kind a surface is.

pub mod build;
pub mod counts;
pub mod data;
mod moved;
pub mod plan;
pub mod strips;

pub use build::{Explanation, Input, build};
pub use data::{FaceRange, Group, Mesh};
pub use plan::{Elements, GroupRequest, Method, Plan, Rule, Target};
