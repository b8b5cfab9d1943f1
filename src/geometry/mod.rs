//! Floor 1: curves. Knows nothing of networks, surfaces or text.
//!
//! A [`Curve`] is one of a closed set of shapes, each evaluated exactly, plus the word the user made it with.

pub mod arc;
mod arclength;
pub(crate) mod bounds;
pub mod build;
pub mod closest;
pub mod composite;
mod convert;
pub mod curve;
mod enclosure;
pub mod fewest;
pub mod fillet;
pub mod fit;
pub mod helix;
pub mod intersect;
mod kinks;
pub mod least_squares;
pub mod motion;
pub mod nurbs;
pub mod nurbs_edit;
pub mod offset;
mod offset_build;
pub(crate) mod pieces;
pub mod polynomial;
mod rebuilt;
pub mod spline;

pub use build::{Ends, Spline};
pub use closest::{Closest, closest, closest_pair};
pub use curve::{Curve, Jet, Kind};
pub use enclosure::{Enclosure, enclosure};
pub use intersect::{Hit, intersect, self_intersect};
pub use motion::Motion;
pub use nurbs::Nurbs;
pub(crate) use offset_build::height_over;
