//! What must hold of every mesh before it is handed on.

pub mod contact_bodies;
pub mod contact_edges;
pub mod contact_leaves;
pub mod contacts;
pub mod covered_area;
pub mod face_check;
pub mod turned;
