//! Tables (csv, dat, txt) and JSON, read and written, with the places of cells in the text of a csv.

pub mod cell_places;
pub mod json;
pub mod table;
