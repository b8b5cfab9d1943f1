//! Origins: which declaration and expression made an entity, and how faults find their places in the script.

use crate::base::origin::Origin;
use crate::lang::syntax::ast::ExprId;
use crate::lang::values::value::ModuleId;

/// Not a member of a family.
pub const NO_MEMBER: u32 = u32::MAX;

/// One entry: a declaration, the member of its family, an expression of it, and the call it was run by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OriginEntry {
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

/// A declaration that keeps its identity from one run to the next, wherever it stands in its script.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Home(pub u32);

#[derive(Clone, Copy, Debug)]
struct Stored {
    home: Home,
    member: [u32; 2],
    expr: Option<ExprId>,
    caller: Origin,
}

/// All origins of a run, and of the runs before it whose entities are kept.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    places: Vec<Stored>,
    /// Where each home stands in this run; `None` while it is in no script.
    standing: Vec<Option<(ModuleId, u32)>>,
    /// Homes of the declarations of each script.
    homes: Vec<Vec<Home>>,
}

impl Origins {
    /// A home that no declaration had before.
    pub(crate) fn new_home(&mut self) -> Home {
        self.standing.push(None);
        Home(self.standing.len() as u32 - 1)
    }

    /// Says which home each declaration of the next script has.
    pub(crate) fn enter(&mut self, module: ModuleId, homes: Vec<Home>) {
        for (declaration, home) in homes.iter().enumerate() {
            self.standing[home.0 as usize] = Some((module, declaration as u32));
        }
        if self.homes.len() <= module.index() {
            self.homes.resize_with(module.index() + 1, Vec::new);
        }
        self.homes[module.index()] = homes;
    }

    /// Forgets where declarations stand; entities keep their origins.
    pub(crate) fn leave(&mut self) {
        self.standing.fill(None);
        self.homes.clear();
    }

    /// Number of origins.
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// A new origin.
    pub fn add(&mut self, place: OriginEntry) -> Origin {
        let OriginEntry { module, declaration, member, expr, caller } = place;
        let Some(&home) = self.homes.get(module.index()).and_then(|of| of.get(declaration as usize)) else { return Origin::NONE };
        self.places.push(Stored { home, member, expr, caller });
        Origin(u32::try_from(self.places.len()).unwrap_or(0))
    }

    /// The entry of an origin; `None` when its declaration is no longer there.
    pub fn place(&self, origin: Origin) -> Option<OriginEntry> {
        let Stored { home, member, expr, caller } = *self.places.get((origin.0 as usize).wrapping_sub(1))?;
        let (module, declaration) = self.standing[home.0 as usize]?;
        Some(OriginEntry { module, declaration, member, expr, caller })
    }
}
