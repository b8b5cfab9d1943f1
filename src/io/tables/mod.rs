//! Tables (csv, dat, txt) and JSON, read and written, with the places of cells in the text of a csv.

pub mod cell_places;
mod cells;
pub mod json;
pub mod table;
pub mod table_read;
pub mod table_write;
pub(crate) mod text;
