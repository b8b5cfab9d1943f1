//! Floor 6: file formats. Computes no geometry beyond conversion. A room imports only from rooms before it:
//!
//! - [`files`]: how files are reached, written in blocks, and named; what formats lose
//! - [`tables`]: tables (csv, dat, txt) and JSON
//! - [`mesh_files`]: mesh files: OBJ and STL read; STL, OBJ, PLY, VTU, MSH, INP, BDF, GLB and 3MF written
//! - [`curve_files`]: curves as polylines: csv, SVG and OBJ
//! - [`formats`]: which format the ending of a path chooses
//! - [`cad`]: what CAD formats have in common: surfaces, trimmed faces, bodies and parts
//! - [`iges`]: IGES, read and written
//! - [`step`]: STEP, read and written

pub mod cad;
pub mod curve_files;
pub mod files;
pub mod formats;
pub mod iges;
pub mod mesh_files;
pub mod step;
pub mod tables;

pub use crate::io::curve_files::polylines::{CurveFormat, Drawing, Polyline};
pub use crate::io::files::access::{FileError, Files, Memory};
pub use crate::io::files::loss::{Loss, Renamed};
pub use crate::io::formats::choice::{curve_format_for, format_for};
pub use crate::io::formats::endings::{Sort, ending_for, extension};
pub use crate::io::formats::list::{CURVE_FORMATS, ELEMENT_NAMES, FORMATS};
pub use crate::io::mesh_files::deck::{Deck, Encoding, Options};
pub use crate::io::mesh_files::element_shape::Shape;
pub use crate::io::mesh_files::format::Format;
pub use crate::io::mesh_files::obj_read::Obj;
pub use crate::io::tables::json::Json;
pub use crate::io::tables::table::{Cell, Table};
