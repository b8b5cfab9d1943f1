//! The lists of formats for meshes and curves, and which of them the ending of a path chooses.

pub mod choice;
pub mod endings;
pub mod list;
