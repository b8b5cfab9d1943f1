//! Curves as polylines in csv, svg and OBJ files.

pub(crate) mod csv;
pub(crate) mod obj;
pub mod polylines;
pub(crate) mod svg;
