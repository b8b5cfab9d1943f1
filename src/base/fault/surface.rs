//! Family 6.

use super::{Describe, Report, Say};
use crate::base::origin::Origin;

/// What can go wrong or deserves a word here.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceFault {
    ///  surfaces and model:E601: placeholder until the family's owner writes the table out.
    Other {
        /// The entity it speaks of.
        of: Origin,
        /// What happened.
        what: String,
    },
}

impl Describe for SurfaceFault {
    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Other { of, what } => {
                Report::new(" surfaces and model:E601", format!("{}: {what}", say.quoted(*of, "this"))).at(*of, "here")
            }
        }
    }
}
