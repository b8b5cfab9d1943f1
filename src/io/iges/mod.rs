//! Reads and writes IGES 5.3. Read are records, then entities as numbers and pointers, then curves, surfaces and faces of the model.
//!
//! ```text
//!   bytes → lines (S G D P T) → records (directory + parameters) → entities → book (curves, bases) → part (names, groups)
//! ```
//!
//! A file that breaks the rules is read as far as it is clear what it means, with a warning each; a damaged entity costs itself
//! and what stands on it. Pointers are followed to a fixed depth, and what may be copied is bounded by the size of the file.

mod book;
mod conics;
mod curves;
mod entities;
mod entity_curves;
mod entity_faces;
mod entity_surfaces;
mod faces;
mod global;
mod levels;
mod lines;
mod params;
mod part;
mod records;
mod sheet;
mod surfaces;
pub mod write;

pub use super::cad::part::{Group, Item, Options, Part};
pub use part::{Opened, open};
pub use sheet::Sheet;
