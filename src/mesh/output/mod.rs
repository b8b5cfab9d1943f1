//! What a mesh holds beside its faces: lines, mid nodes, named sets.

pub mod lines;
pub mod second_order;
pub mod sets;
