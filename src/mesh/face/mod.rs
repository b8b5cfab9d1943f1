//! One face from its border to its elements, mapped or free, and faces that fall together.

pub mod foresee;
pub mod free;
pub mod mapped;
pub mod together;
pub mod twins;
