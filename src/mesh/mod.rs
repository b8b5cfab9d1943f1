//! Floor 5: meshes. Faces are asked for points and normals only; nothing here knows what kind a surface is.
//!
//! One dimension first: every segment of a border or curve is divided once, for all faces that share it. Faces are then filled between
//! their divided borders. A room imports only from rooms before it:
//!
//! [`request`] · [`mapped`] · [`data`] · [`border`] · [`chart`] · [`deviation`] · [`size`] · [`divide`] ·
//! [`tri`] · [`quad`] · [`face`] · [`output`] · [`verify`] · [`report`] · [`cache`] · [`pipeline`]

pub mod border;
pub mod cache;
pub mod chart;
pub mod data;
pub mod deviation;
pub mod divide;
pub mod face;
pub mod mapped;
pub mod output;
pub mod pipeline;
pub mod quad;
pub mod report;
pub mod request;
pub mod size;
pub mod tri;
pub mod verify;

pub use crate::mesh::data::mesh::{FaceRange, Group, Mesh};
pub use crate::mesh::data::quality::Quality;
pub use crate::mesh::pipeline::build::{MeshLayouts, build};
pub use crate::mesh::report::built::Built;
pub use crate::mesh::report::explain::Explanation;
pub use crate::mesh::request::VERSION;
pub use crate::mesh::request::input::Input;
pub use crate::mesh::request::methods::{Elements, Method};
pub use crate::mesh::request::plan::{GroupRequest, Plan, Rule, Target};
pub use crate::mesh::request::settings::{MeshSettings, Settings};
