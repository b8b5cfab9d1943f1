//! What a mesh stands on: segments of borders and curves, each once, their nodes, and what lies inside faces.

pub mod along;
pub mod beside;
pub mod counts;
pub mod creases;
pub mod folds;
pub mod inside;
pub mod layout;
pub mod layout_check;
pub mod loose;
pub mod lost;
pub mod nodes;
pub mod side_parameters;
pub mod touch;
pub mod tracks;
