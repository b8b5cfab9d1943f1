//! Floor 3: surfaces. Built from chains; knows nothing of patches, meshes or text.
//!
//! A room imports only from rooms before it:
//!
//! - [`faults`]: what can go wrong, family by family
//! - [`data`]: jets, domains, kinds, bounds, breaks
//! - [`rails`]: curves under a parameter, sides, closed boundaries, borders in (u, v)
//! - [`shapes`]: blended curves, nets, profiles in motion, heights, each by itself
//! - [`mod@core`]: a surface of any shape, with its borders, loops and bounds
//! - [`mod@closest`]: feet, nearest points, inside or outside, boxes
//! - [`trims`]: curves on surfaces and the parts that they divide them into
//! - [`points`]: surfaces from control nets, grids and scattered points
//! - [`blended`]: Coons and Gordon surfaces, ruled ones, plane faces, skins
//! - [`swept`]: extrusions, revolutions, sweeps
//! - [`joined`]: several surfaces as one
//! - [`filled`]: holes of any number of sides closed
//! - [`analysis`]: surfaces as nets, their lines, simple forms, reports, validation
//! - [`intersect`]: with curves, each other and themselves
//! - [`mod@offset`]: surfaces at a distance, and walls
//! - [`mod@rolling`]: blends of a rolling ball

pub mod analysis;
pub mod blended;
pub mod closest;
pub mod core;
pub mod data;
pub mod faults;
pub mod filled;
pub mod intersect;
pub mod joined;
pub mod offset;
pub mod points;
pub mod rails;
pub mod rolling;
pub mod shapes;
pub mod swept;
pub mod trims;

pub use crate::surface::analysis::as_net::{NetForm, Off};
pub use crate::surface::analysis::extend::{Rim, extend};
pub use crate::surface::analysis::iso_line::IsoLine;
pub use crate::surface::blended::ruled::{ruled, ruled_as_drawn};
pub use crate::surface::closest::bounding_box::{bbox, boxed};
pub use crate::surface::closest::boxed::Boxed;
pub use crate::surface::closest::curve_extent::curve_bbox;
pub use crate::surface::closest::foot::{foot_within, step};
pub use crate::surface::closest::nearest::{Closest, Nearest, closest};
pub use crate::surface::core::enclosure::Strip;
pub use crate::surface::core::evaluator::{Evaluator, PreparedSurface};
pub use crate::surface::core::evened::Evened;
pub use crate::surface::core::line_evaluator::LineEvaluator;
pub use crate::surface::core::surface::Surface;
pub use crate::surface::data::breaks::chain_breaks;
pub use crate::surface::data::enclosure::Enclosure;
pub use crate::surface::data::jet::Jet2;
pub use crate::surface::data::kind::{Domain, SurfaceKind};
pub use crate::surface::data::one_sided::OneSided;
pub use crate::surface::filled::fill::{Filling, fill};
pub use crate::surface::joined::join::join;
pub use crate::surface::offset::build::offset;
pub use crate::surface::points::control_net::Net;
pub use crate::surface::points::interpolate::grid;
pub use crate::surface::points::polynomial::{polynomial, polynomial_net};
pub use crate::surface::points::scatter::scatter;
pub use crate::surface::rails::rail::Rail;
pub use crate::surface::rails::reparam::{Map, Reparam};
pub use crate::surface::rails::side::Side;
pub use crate::surface::rolling::ball_blend::rolling;
pub use crate::surface::shapes::nurbs::NurbsSurface;
pub use crate::surface::swept::extrude::extrude;
pub use crate::surface::swept::revolve::{axis_of, revolve};
pub use crate::surface::trims::divide::{divide, parted, split};
pub use crate::surface::trims::outlined::{Doubt, Ground, Outlined, outlined};
pub use crate::surface::trims::project::{Way, project};
pub use crate::surface::trims::trim::{over_frame, trim, with_loops};
