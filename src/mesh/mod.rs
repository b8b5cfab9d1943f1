//! Floor 5: meshes. Faces are asked for points and normals only; nothing here knows what kind a surface is.

pub mod build;
pub mod chart;
pub mod counts;
pub mod data;
pub mod edges;
pub mod layout;
pub mod mapped;
mod moved;
pub mod plan;
pub mod rows;
pub mod sizing;
pub mod strips;
pub mod trilateral;

pub use build::{Explanation, Input, build};
pub use data::{FaceRange, Group, Mesh};
pub use plan::{Elements, GroupRequest, Method, Plan, Rule, Target};
