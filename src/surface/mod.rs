//! Floor 3: surfaces, one file per kind. Built from chains; knows nothing of patches, meshes or text.

pub mod core;

pub use core::{Domain, Jet2, Side, Surface, SurfaceKind};
