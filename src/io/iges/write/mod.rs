//! Writes IGES 5.3: curves, surfaces and their groups by name.
//!
//! | thing | entity |
//! |---|---|
//! | point | 116 |
//! | line | 110 |
//! | arc of a circle | 100, placed by a 124 unless it runs counter-clockwise about z |
//! | any other curve | 126 |
//! | curves in a row | 102 |
//! | surface of exact forms (plane, cylinder, cone, sphere, torus) | 514 form 2 |
//! | any other surface | 128 |
//! | surface inside loops | 144, 142 over a 128 |
//! | closed shell | 186, its faces share edges: 514, 510, 508, 504, 502 |
//! | open shell | 514 form 2 |
//! | shell as trimmed surfaces, several bodies of one shell | 402 form 7 |
//! | name, colour | 406 form 15, 314 |
//! | layer | a level, named by 406 form 3; several by 406 form 1 |

mod curves;
mod file;
mod file_builder;
mod solids;
mod surfaces;
mod things;
mod trimmed;

pub use crate::io::iges::write::file::{sheet, write};
pub use crate::io::iges::write::things::{IgesScale, IgesShape, IgesThing};
