//! `Curve`, one of all shapes, with composites and offsets of others; its length, smooth pieces, corners and bounds.

pub mod arclength;
pub mod composite;
pub mod convert;
pub mod curve;
pub mod enclosure;
pub mod kinks;
pub mod length;
pub mod offset;
pub mod pieces;
