//! Free faces of triangles: placed by a front or a quadtree, or triangulated between isolines; optimised, refined, coarsened.

pub mod background;
pub mod build;
pub mod coarse;
pub mod coarsen;
pub mod fill;
pub mod front;
pub mod graded_size;
mod grid_lines;
pub mod isoline;
pub mod isoline_mesh;
pub mod large;
pub mod limit_table;
pub mod longest;
pub mod marks;
pub mod no_mesh;
pub mod optimize;
pub mod optimize_settings;
pub mod pending;
pub mod placement_settings;
pub mod point_hash;
pub mod quadtree;
pub mod shape;
pub mod sliding_border;
pub mod too_large;
pub mod tree;
pub mod triangle_fit;
pub mod triangulation;
