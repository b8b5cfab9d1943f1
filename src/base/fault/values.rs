//! Families 2 and 3: values that do not fit, found below the language.

use super::{Describe, Report, Say, Subject};

/// A plain value that an entity cannot be made from.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueFault {
    /// E306: an argument outside its range; `range` says it in words ("between 0 and 1").
    OutsideRange {
        /// Parameter name.
        argument: &'static str,
        /// The value as text.
        found: String,
        /// What is allowed, in words.
        range: String,
    },
    /// E230: known but not in this version.
    NotInThisVersion {
        /// What was asked for, for example "`method: delaunay`".
        what: String,
    },
    /// E217: a list or work limit.
    Limit {
        /// What would be made, for example "a mesh of 4 000 000 000 elements".
        what: String,
        /// The limit in words.
        limit: String,
    },
}

impl Describe for ValueFault {
    fn describe(&self, _: &dyn Say) -> Report {
        match self {
            Self::OutsideRange { argument, found, range } => {
                Report::new("E306", format!("`{argument}` must be {range}, got {found}")).label(Subject::Argument(argument), found.clone())
            }
            Self::NotInThisVersion { what } => {
                Report::new("E230", format!("{what} is not in this version")).label(Subject::Call, "asked for here")
            }
            Self::Limit { what, limit } => {
                Report::new("E217", format!("{what} is too much")).label(Subject::Call, "made here").help(format!("the limit is {limit}"))
            }
        }
    }
}
