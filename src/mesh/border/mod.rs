//! What a mesh stands on: segments of borders and curves, each once, their nodes, and what lies inside faces.

pub mod beside;
pub mod counts;
pub mod creases;
pub mod inside;
pub mod layout;
pub mod layout_check;
pub mod lost;
pub mod nodes;
pub mod touch;
