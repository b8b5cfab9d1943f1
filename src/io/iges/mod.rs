//! Reads and writes IGES 5.3. Read are records, then entities as numbers and pointers, then curves, surfaces and faces of the model.
//!
//! ```text
//!   bytes → lines (S G D P T) → records (directory + parameters) → entities → their table (curves, bases) → part (names, groups)
//! ```
//!
//! A file that breaks the rules is read as far as it is clear what it means, with a warning each; a damaged entity costs itself
//! and what stands on it. Pointers are followed to a fixed depth, and what may be copied is bounded by the size of the file.

mod conics;
mod curves;
mod entity_curves;
mod entity_data;
mod entity_decode;
mod entity_faces;
mod entity_surfaces;
mod entity_table;
mod entity_writer;
mod faces;
mod global;
mod instances;
mod levels;
mod lines;
mod open;
mod params;
mod part;
mod records;
mod surfaces;
pub mod write;

pub use crate::io::cad::part::{Group, Imported, Part, ReadOptions};
pub use crate::io::iges::entity_writer::IgesFile;
pub use crate::io::iges::open::{OpenedIges, open};
