//! Feet and nearest points of a surface, whether a place lies in its kept part, and the boxes that surfaces and curves fit into.

pub mod bounding_box;
pub mod boxed;
pub mod curve_extent;
pub mod descent;
pub mod foot;
pub mod inside;
pub mod nearest;
pub mod samples;
pub mod swept_profile;
pub mod trimmed_extent;
