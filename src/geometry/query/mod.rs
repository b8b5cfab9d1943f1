//! Nearest points and intersections of curves, and where they pass planes, found by bounds.

pub mod closest;
pub mod intersect;
pub mod plane;
