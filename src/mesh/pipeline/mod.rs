//! From a plan to a mesh: the rooms before this one in their order.

pub mod assemble;
pub mod attempt;
pub mod build;
pub mod fill;
pub mod free_face;
pub mod retry;
