//! Reads and writes STEP files (ISO 10303-21) of the schemas AP203, AP214 and AP242: curves, surfaces, faces, shells, solids and
//! assemblies of them. Of what is read:
//!
//! ```text
//!   bytes → records (spans of the file) → products and their places → items of each as faces → part (names, groups)
//! ```
//!
//! A file that breaks the rules is read as far as it is clear what it means, with a warning each; a damaged entity costs itself and what
//! stands on it. References are followed to a fixed depth, and what may be copied is bounded.

mod assembly;
mod bounding_box;
mod conics;
mod contexts;
mod curves;
mod faces;
mod file_check;
mod items;
mod line_index;
mod open;
mod parameters;
mod part;
mod part21;
mod product_tables;
mod reader;
mod records;
mod revolved;
mod splines;
mod strings;
mod styles;
mod surfaces;
mod trimmed_surfaces;
mod units;
mod validation;
pub mod write;

pub use crate::io::step::open::{OpenedStep, open};
