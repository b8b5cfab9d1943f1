//! Declarations beside values: params, imports, shells, groups, meshes, snapping and outputs.

pub mod collections;
pub mod import_part;
pub mod imports;
pub mod keywords;
pub mod outputs;
pub mod params;
pub mod pictures;
pub mod refine;
pub mod report_tables;
pub mod setting_values;
pub mod shares;
pub mod snap_curves;
pub mod snap_rounds;
pub mod snapping;
