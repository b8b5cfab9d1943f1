//! What several tests use.

pub mod borders;
pub mod invariants;
pub mod long;
pub mod mutate;
pub mod networks;
pub mod outlines;
pub mod random;
pub mod reference;
pub mod script;
pub mod surfaces;
