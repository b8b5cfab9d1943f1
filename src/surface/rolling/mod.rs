//! Blends between two surfaces: what a ball leaves that rolls along their edge.

pub mod along;
pub mod ball;
pub mod ball_blend;
pub mod ball_surface;
pub mod breaks;
pub mod cut;
pub mod ends;
pub mod face;
pub mod largest;
pub mod station;
