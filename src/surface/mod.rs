//! Floor 3: surfaces, one file per kind. Built from chains; knows nothing of patches, meshes or text.

mod blend;
mod breaks;
pub mod closest;
pub mod coons;
pub mod core;
mod descent;
mod extent;
pub mod extrude;
mod flow_words;
pub mod interpolate;
pub mod nurbs;
pub mod plane;
mod rail;
mod reparam;
mod review;
pub mod revolve;
mod ruled;
mod shape;
mod square;
mod sweep;
mod trilateral;
mod weights;

pub use breaks::chain_breaks;
pub use closest::{Closest, Nearest, closest};
pub use core::{Domain, Jet2, Side, Surface, SurfaceKind};
pub use extent::bbox;
pub use extrude::extrude;
pub use interpolate::grid;
pub use nurbs::{Net, NurbsSurface};
pub use rail::Lean;
pub use reparam::{Map, Reparam};
pub use revolve::{axis_of, revolve};
pub use ruled::ruled;
