//! The shapes that are evaluated by themselves: arcs, helices, rational B-splines with their bounds and exact other forms.

pub mod arc;
pub mod bounds;
pub mod helix;
pub mod least_squares;
pub mod nurbs;
pub mod nurbs_edit;
mod nurbs_lean;
