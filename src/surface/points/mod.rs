//! Surfaces from points: control nets, powers, grids gone through or near, scattered points.

pub mod control_net;
pub mod fit_net;
pub mod interpolate;
pub mod polynomial;
pub mod scatter;
