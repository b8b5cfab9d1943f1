//! Surfaces at a distance from others, with their borders, and the walls between them.

pub mod boundary;
pub mod build;
pub mod exact;
pub mod extended;
pub mod joint;
pub mod revolved_profile;
pub mod shell;
pub mod thicken;
