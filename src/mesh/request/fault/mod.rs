//! What can go wrong with meshes, family by family.

pub mod counts;
pub mod elements;
pub mod faces;
pub mod mesh;
pub mod sizes;

pub use counts::CountFault;
pub use elements::{Close, ElementFault};
pub use faces::FaceFault;
pub use mesh::{Cure, LostPart, MeshFault};
pub use sizes::{MeshLimit, SizeFault};
