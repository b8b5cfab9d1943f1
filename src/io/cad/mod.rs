//! What CAD formats have in common: exact surfaces with the loops of curves on them, made into surface values, and the part that
//! offers them by name. Readers of a format make [`face::Face`]s and put them into a [`part::Part`]; writers of solids take
//! [`bodies::Bodies`], faces with the edges that they share.

pub mod assembly;
pub mod base_surface;
pub mod bodies;
pub mod border;
mod build;
pub mod control_nets;
pub mod curve_on_surface;
pub mod curves;
pub mod defect;
mod degenerate_edges;
mod doubled;
mod edge_pieces;
pub mod elementary_surface;
mod exact_pieces;
pub mod face;
pub mod face_loops;
mod face_pieces;
pub mod healing;
pub mod inside_point;
mod natural_bounds;
mod offset_surface;
pub mod part;
pub mod revolution_profile;
mod validation;
