//! Parts of meshes that were made before, under keys of all that they follow from.

pub mod cached_face;
pub mod key;
pub mod measured;
pub mod record;
pub mod reuse;
