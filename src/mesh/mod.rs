//! Floor 5: meshes. Faces are asked for points and normals only; nothing here knows what kind a surface is.
//!
//! One dimension first: every segment of a border or curve is divided once, for all faces that share it. Faces are then
//! mapped between their divided sides. `docs/notes/mapped-mesh.md` tells the phases.

mod ahead;
mod assemble;
mod beside;
mod blame;
mod border_error;
pub mod build;
mod chord;
mod contact_bodies;
pub mod contact_edges;
mod contact_leaves;
pub mod contacts;
mod counts;
mod creases;
pub mod data;
mod edges;
pub mod explain;
pub mod extent;
pub mod face_geometry;
pub mod faces;
mod foresee;
pub mod free;
mod gaps;
mod girth;
mod hash;
mod inside;
mod key;
mod layout;
mod limits;
mod lines;
pub mod lost;
pub mod mapped;
mod measured;
mod moved;
mod narrow;
mod nodes;
mod parity;
mod parts;
pub mod plan;
mod proof;
pub mod quality;
mod reasons;
pub mod record;
mod relations;
pub mod reuse;
mod rows;
mod second_order;
pub mod section;
mod sets;
mod shape_check;
pub mod sizing;
pub mod sources;
mod spacing;
pub mod strips;
mod together;
pub mod trilateral;
mod uneven;
pub mod verify;
mod wanted;

pub use build::{Built, Input, Outline, build};
pub use data::{FaceRange, Group, Mesh};
pub use explain::Explanation;
pub use plan::{Elements, GroupRequest, Method, Plan, Rule, Target};
pub use quality::Quality;

/// Version of the mesher: one more whenever the same plan gives another mesh, so that golden files can name it as the cause.
pub const VERSION: u32 = 57;
