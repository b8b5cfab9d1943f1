//! Origins: which declaration and expression made an entity, and how faults find their places in the script.

use super::syntax::ast::ExprId;
use super::value::ModuleId;
use crate::base::origin::Origin;

/// Not a member of a family.
pub const NO_MEMBER: u32 = u32::MAX;

/// One entry: a declaration, the member of its family, an expression of it, and the call it was run by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Script.
    pub module: ModuleId,
    /// Declaration in it.
    pub declaration: u32,
    /// Indices of the family's member, [`NO_MEMBER`] where there is none.
    pub member: [u32; 2],
    /// Expression; `None` means the declaration itself.
    pub expr: Option<ExprId>,
    /// The call of a script's function that ran this.
    pub caller: Origin,
}

/// All origins of a run.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    places: Vec<Place>,
}

impl Origins {
    /// A new origin.
    pub fn add(&mut self, place: Place) -> Origin {
        self.places.push(place);
        Origin(u32::try_from(self.places.len()).unwrap_or(0))
    }

    /// The entry of an origin.
    pub fn place(&self, origin: Origin) -> Option<&Place> {
        self.places.get((origin.0 as usize).wrapping_sub(1))
    }
}
