//! What can go wrong with surfaces, family by family.

pub mod blends;
pub mod borders;
pub mod corners;
pub mod crossing;
pub mod cut;
pub mod deviation;
pub mod fills;
pub mod join;
pub mod loops;
pub mod points;
pub mod profiles;
pub mod scatter;
pub mod sections;
pub mod surface;
pub mod sweep;
pub mod walls;

pub use blends::{BlendFault, NoBlend};
pub use borders::BorderFault;
pub use corners::CornerFault;
pub use crossing::CrossingFault;
pub use cut::CutFault;
pub use deviation::DeviationFault;
pub use fills::FillFault;
pub use join::JoinFault;
pub use loops::{LoopFault, LoopRole};
pub use points::PointsFault;
pub use profiles::ProfileFault;
pub use scatter::ScatterFault;
pub use sections::SectionFault;
pub use surface::{Construction, SurfaceFault};
pub use sweep::SweepFault;
pub use walls::{WallEdge, WallFault};
