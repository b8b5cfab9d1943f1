//! Diagnostics: places, reports, codes, and how they are drawn.

pub mod codes;
pub mod diagnostic;
mod frame;
mod paint;
pub mod render;
pub mod span;
