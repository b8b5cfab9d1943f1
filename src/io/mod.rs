//! Floor 6: file formats, one file each. Computes no geometry beyond conversion.

mod bdf;
mod blocks;
pub mod cad;
pub mod curves;
pub mod deck;
pub mod endings;
pub mod files;
pub mod iges;
mod inp;
pub mod json;
mod msh;
mod obj;
pub mod obj_read;
mod ply;
mod romanize;
mod sets;
pub mod step;
mod stl;
pub mod stl_read;
pub mod table;
pub mod table_places;
mod vtu;
mod weld;

pub use curves::{CURVE_FORMATS, CurveFormat, Drawing, Polyline, curve_format_for};
pub use deck::{Deck, ELEMENT_NAMES, Encoding, FORMATS, Format, Loss, Options, Renamed, Shape, extension, format_for};
pub use endings::{Sort, ending_for};
pub use files::{FileError, Files, Memory};
pub use json::Json;
pub use obj_read::Obj;
pub use table::{Cell, Table};
