//! Which setting decides the steps of each segment, and how far apart nodes are along it.

pub mod border_spacing;
pub mod choose;
pub mod gaps;
pub mod girth;
pub mod proximity;
pub mod remark;
pub mod sizing;
pub mod too_large;
pub mod uneven;
