//! What can go wrong with surfaces, family by family.

pub mod blends;
pub mod cut;
pub mod join;
pub mod loops;
pub mod scatter;
pub mod surface;
pub mod sweep;
pub mod walls;

pub use crate::surface::faults::blends::{BlendFault, NoBlend};
pub use crate::surface::faults::cut::CutFault;
pub use crate::surface::faults::join::JoinFault;
pub use crate::surface::faults::loops::{LoopFault, LoopRole};
pub use crate::surface::faults::scatter::ScatterFault;
pub use crate::surface::faults::surface::{Construction, SurfaceFault};
pub use crate::surface::faults::sweep::SweepFault;
pub use crate::surface::faults::walls::{WallEdge, WallFault};
