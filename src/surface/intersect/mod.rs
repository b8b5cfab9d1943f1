//! Where surfaces meet curves, each other and themselves: subdivision with guaranteed bounds, Newton's method where there is one meeting
//! or one line.

pub mod coplanar;
mod curve_overlap;
pub mod curve_patch;
mod extrusions;
pub mod fit_branch;
pub mod join_curves;
pub mod known_curves;
pub mod line_crossing;
mod lost_runs;
pub mod march;
pub mod pair;
pub mod patch_pair;
pub mod planes;
pub mod revolved;
pub mod runs;
pub mod self_intersection;
pub mod sheet;
pub mod touch_line;
pub mod turned;
mod turned_branch;
mod turned_spans;
pub mod with_curve;
pub mod with_surfaces;
