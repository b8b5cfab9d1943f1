//! All tests of the library and of its program, in one program: each module stands in a file of its name, what they share in `support`.
//! `cargo test meshes_of` runs those with that in their names, `cargo test quads::` those of `quads.rs`.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by panicking, and may tell what it found")]
#![allow(clippy::disallowed_methods, reason = "what a test compares with need not be the same bits everywhere")]
#![allow(missing_docs, reason = "a test is named by what it shows")]

mod acceptance_mesh;
mod angle_steps;
mod assist;
mod bounds;
mod broken;
mod cache;
mod cad;
mod chord_errors;
mod cli;
mod draw;
mod edges;
mod edits;
mod fmt;
mod fmt_cli;
mod geometry;
mod golden;
mod goldens_edits;
mod goldens_see;
mod gordon;
mod guide;
mod hostile;
mod house;
mod iges;
mod incremental;
mod interrupt;
mod intersect_surfaces;
mod io;
mod isoline;
mod joins;
mod layouts;
mod library;
mod lists;
mod lsp;
mod mesh;
mod mesh_invariants;
mod meshing_numbers;
mod mutations;
mod narrow;
mod nearest;
mod net_forms;
mod net_properties;
mod network;
mod order;
mod properties;
mod quads;
mod quadtree;
mod random_plates;
mod repl;
mod report;
mod scatters;
mod sizing;
mod skins;
mod spec;
mod splits;
mod step;
mod step_out;
mod support;
mod surface;
mod sweeps;
mod triangulations;
mod trims;
mod walls;
