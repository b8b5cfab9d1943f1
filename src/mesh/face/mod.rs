//! One face from its border to its elements, mapped or free, and coincident faces.

pub mod coincident;
pub mod free;
mod map_cells;
pub mod map_quality;
pub mod mapped;
pub mod twins;
