//! Floor 7: the language: text to tree, values, evaluation by dependency, diagnostics.

pub mod codes;
pub mod cx;
pub mod diag;
pub mod diag_render;
pub mod eval;
mod faults;
pub mod names;
pub mod origins;
pub mod plans;
pub mod scene;
mod stages;
pub mod std;
pub mod syntax;
pub mod table;
pub mod types;
pub mod units;
pub mod value;
