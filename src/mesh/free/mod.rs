//! Faces that no map fits: nodes grown over the surface, triangulated in the chart, improved in space.

pub mod bound;
pub mod build;
pub mod cells;
pub mod chart;
pub mod face;
pub mod fill;
pub mod ground;
pub mod grow;
pub mod improve;
mod inner;
pub mod isoline;
mod lay;
pub mod loads;
pub mod marks;
pub mod outline;
mod pending;
pub mod poles;
pub mod quads;
pub mod quadtree;
pub mod shape;
pub mod sides;
pub mod size;
pub mod taken;
pub mod thin;
pub mod tree;
pub mod triangulation;
pub mod twins;
