//! What all curves have in common: points with derivatives, kinds and motions.

pub mod corner_fault;
pub mod extend_fault;
pub mod fault;
pub mod jet;
pub mod kind;
pub mod motion;
