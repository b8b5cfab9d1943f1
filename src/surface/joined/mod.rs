//! Surfaces that follow one another as one.

pub mod join;
pub mod rims;
