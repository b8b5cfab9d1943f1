//! Nearest points and intersections of curves, found by bounds.

pub mod closest;
pub mod intersect;
