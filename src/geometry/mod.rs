//! Floor 1: curves. Knows nothing of networks, surfaces or text.
//!
//! A [`Curve`] is one of a closed set of shapes, each evaluated exactly, plus the word the user made it with. A room imports only from rooms before it:
//!
//! [`data`] · [`shapes`] · [`curves`] · [`query`] · [`construct`]

pub mod construct;
pub mod curves;
pub mod data;
pub mod query;
pub mod shapes;

pub use crate::geometry::construct::build::{Ends, Spline};
pub(crate) use crate::geometry::construct::offset_build::height_over;
pub use crate::geometry::curves::curve::Curve;
pub use crate::geometry::curves::enclosure::{Enclosure, enclosure};
pub use crate::geometry::data::jet::Jet;
pub use crate::geometry::data::kind::Kind;
pub use crate::geometry::data::motion::Motion;
pub use crate::geometry::query::closest::{Closest, closest, closest_pair, may_come_near};
pub use crate::geometry::query::intersect::{Hit, intersect, self_intersect};
pub use crate::geometry::shapes::nurbs::Nurbs;
