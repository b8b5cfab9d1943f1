//! Where an entity comes from, opaque to the kernel.

/// The expression of the script that made an entity.
///
/// The kernel copies it from entity to entity (a link has its curve's) and never looks inside; the language
/// keeps the table that turns it into a declaration, an expression and a span. That is how a failure found
/// phases later, in the mesher, still knows its names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Origin(pub u32);

impl Origin {
    /// Nothing to point at; what unit tests use.
    pub const NONE: Self = Self(0);

    /// Whether there is something to point at.
    pub fn is_some(self) -> bool {
        self.0 != 0
    }
}
