//! Floor 7: the language: text to tree, values, evaluation by dependency, diagnostics.

pub mod diag;
pub mod names;
pub mod syntax;
