//! What all rooms name: jets, domains, kinds and bounds of a surface, and where curves are less than smooth.

pub mod bends;
pub mod breaks;
pub mod enclosure;
pub mod flow_words;
pub mod jet;
pub mod kind;
pub mod one_sided;
