//! What a format cannot hold, and the warnings for it.

use crate::base::origin::Origin;
use crate::io::files::fault::OutputFault;

/// What a format could not hold as it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Something was left out that was asked for: what, in words. A warning.
    LeftOut(String),
    /// Names that every mesh has are not in the file: which, in words. Reported on request.
    Unnamed(String),
    /// A set has another name in the file.
    Renamed(Renamed),
}

impl Loss {
    /// The warnings for the export `of` to `path` (as written): one for each thing left out, one for all new names.
    pub fn faults(losses: &[Self], of: Origin, path: &str) -> Vec<OutputFault> {
        let mut faults = Vec::new();
        let mut names = Vec::new();
        for loss in losses {
            match loss {
                Self::LeftOut(what) => faults.push(OutputFault::LeftOut { of, path: path.to_owned(), what: what.clone() }),
                Self::Renamed(renamed) if !renamed.family => names.push((renamed.from.clone(), renamed.to.clone())),
                Self::Renamed(_) | Self::Unnamed(_) => {}
            }
        }
        if !names.is_empty() {
            faults.push(OutputFault::Renamed { of, path: path.to_owned(), names });
        }
        faults
    }
}

/// A name that stands otherwise in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renamed {
    /// Name in the model.
    pub from: String,
    /// Name in the file.
    pub to: String,
    /// Only the brackets of a family went, as in `ribs[3]`, `ribs_3`: this is so in every format and no warning.
    pub family: bool,
}
