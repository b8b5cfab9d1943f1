//! What one run takes over from the run before: keys of declarations, and values under them.

pub mod keys;
pub mod numbering;
pub mod recall;
