//! How a mesh came about, in words.

pub mod blame;
pub mod border_error;
pub mod built;
pub mod explain;
pub mod node_sizes;
pub mod reasons;
