//! Diagnostics: places, reports, codes, and how they are drawn.

pub mod codes;
pub mod diagnostic;
pub mod render;
pub mod span;
