//! Surfaces of profiles in motion: extruded, revolved, along a path, along guides by a law.

pub mod along;
mod blend;
mod course;
pub mod deform;
mod displacement;
pub mod extrude;
pub mod frame;
mod law_met;
pub mod laws;
pub mod legs;
pub mod marks;
pub mod revolve;
mod ribs;
pub mod rounded;
pub mod sections;
pub mod single;
pub mod sweep;
pub mod sweep_input;
pub mod sweep_net;
pub mod synchronized;
