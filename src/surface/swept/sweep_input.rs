//! What a sweep is asked for.

use crate::base::origin::Origin;
use crate::network::Chain;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::kind::SurfaceKind;
use crate::surface::swept::laws::Law;

/// How the net becomes a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NetMethod {
    /// Cubic splines through all stations and guides, smooth between all patches.
    Gordon,
    /// Each patch from its own four curves.
    Local,
}

/// What a sweep is made of.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// Sections, in any order and direction.
    pub sections: &'a [Chain],
    /// Guides, the main one first.
    pub guides: &'a [Chain],
    /// How sections travel.
    pub law: Law,
    /// How the net becomes a surface.
    pub method: NetMethod,
    /// The declaration.
    pub origin: Origin,
}

/// Other words for a surface made elsewhere.
pub(crate) fn renamed(surface: &Surface, input: &Input) -> Surface {
    let chains = input.sections.iter().chain(input.guides).cloned().collect();
    Surface::new(Parts { kind: SurfaceKind::Sweep, chains, ..surface.parts().clone() })
}
