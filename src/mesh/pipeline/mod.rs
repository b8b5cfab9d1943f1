//! From a plan to a mesh: the rooms before this one in their order.

pub mod assemble;
pub mod build;
pub mod free_face;
