//! What must hold of every mesh before it is handed on.

pub mod connectivity;
pub mod contact_bodies;
pub mod contact_borders;
pub mod contact_edges;
pub mod contact_interiors;
pub mod contact_leaves;
pub mod contact_reach;
pub mod contact_scan;
pub mod contacts;
pub mod covered_area;
pub mod defect;
pub mod face_border;
pub mod face_check;
pub mod face_fault;
pub mod orientation;
pub mod turned;
