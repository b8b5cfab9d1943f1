//! Family 8.

use super::{Describe, Report, Say};
use crate::base::origin::Origin;

/// What can go wrong or deserves a word here.
#[derive(Clone, Debug, PartialEq)]
pub enum FileFault {
    ///  files:E801: placeholder until the family's owner writes the table out.
    Other {
        /// The entity it speaks of.
        of: Origin,
        /// What happened.
        what: String,
    },
}

impl Describe for FileFault {
    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Other { of, what } => Report::new(" files:E801", format!("{}: {what}", say.quoted(*of, "this"))).at(*of, "here"),
        }
    }
}
