//! Floor 3: surfaces, one file per kind. Built from chains; knows nothing of patches, meshes or text.

mod blend;
mod breaks;
pub mod coons;
pub mod core;
mod rail;
mod reparam;
mod review;
mod shape;
mod trilateral;
mod weights;

pub use core::{Domain, Jet2, Side, Surface, SurfaceKind};
pub use rail::Lean;
pub use reparam::{Map, Reparam};
