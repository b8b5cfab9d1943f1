//! A surface of any kind: its shape with borders, kinks and loops, its bounds, and what is made of it for many evaluations.

mod break_lines;
pub mod enclosure;
pub mod evaluator;
pub mod evened;
pub mod joined;
pub mod joined_piece;
pub mod line_evaluator;
mod normals;
pub mod plane;
pub mod power_form;
pub(crate) mod regular;
pub mod shape;
pub mod square;
pub mod surface;
pub mod trim;
pub mod trimmed;
