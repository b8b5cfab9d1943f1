//! Writes STEP: points, curves, surfaces, shells and solids by name.
//!
//! | thing | entity |
//! |---|---|
//! | point, curve | `GEOMETRIC_CURVE_SET` |
//! | surface, open shell | `SHELL_BASED_SURFACE_MODEL` of faces that share edges |
//! | closed shell | `MANIFOLD_SOLID_BREP`, with cavities `BREP_WITH_VOIDS` |
//! | product of an imported assembly, at a place | `PRODUCT`, `NEXT_ASSEMBLY_USAGE_OCCURRENCE` |
//! | group | `PRESENTATION_LAYER_ASSIGNMENT` |
//! | colour of a solid, face or curve | `STYLED_ITEM`, of a face that differs from its solid `OVER_RIDING_STYLED_ITEM` |
//! | tolerance | `UNCERTAINTY_MEASURE_WITH_UNIT` |

mod assembly;
mod curves;
mod file;
mod pcurves;
mod product;
mod records;
mod styles;
mod surfaces;
mod things;
mod topology;
mod validation;

pub use crate::io::step::write::file::{StepFile, sheet, write};
pub use crate::io::step::write::product::Schema;
pub use crate::io::step::write::things::{Measured, Setup, StepScale, StepShape, StepThing};
