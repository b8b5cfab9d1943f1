//! Why an evaluation gives no value.

use crate::base::fault::{Family, Fault};
use crate::lang::values::value::ModuleId;

/// Why an evaluation gives no value.
#[derive(Clone, Debug)]
pub enum Halt {
    /// It was reported already.
    Failed,
    /// It depends on a declaration that failed: script and place there.
    Skipped(ModuleId, u32),
    /// It depends on something that did not parse and was reported there.
    Broken,
    /// It asks for the tolerance, which is not known yet; it is evaluated again when it is.
    NotYet,
    /// The kernel or a builtin says why; becomes a diagnostic at the call.
    Fault(Fault),
    /// Something that cannot happen did.
    Bug(&'static str),
}

impl From<Fault> for Halt {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

impl<T: Family> From<T> for Halt {
    fn from(fault: T) -> Self {
        Self::Fault(fault.into())
    }
}
