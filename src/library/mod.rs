//! Floor 9: what Rust programs use, under the names at the root of the crate. Thin: each item holds a thing of the floors below and
//! speaks plain numbers, names and one [`Error`].

mod curve;
mod error;
mod files;
mod loaded;
mod mesh;
mod meshing;
mod model;
mod names;
mod network;
mod output;
mod plan;
mod script;
mod surface;

pub use curve::Curve;
pub use error::Error;
pub use mesh::Mesh;
pub use model::Model;
pub use network::Network;
pub use output::Output;
pub use plan::MeshPlan;
pub use script::Script;
pub use surface::Surface;
