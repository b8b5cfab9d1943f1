//! Surfaces from points: control nets, powers, grids gone through or near or faired, scattered points.

pub mod control_net;
pub mod even_points;
pub mod fair;
pub mod fair_lines;
pub(crate) mod fair_rest;
pub mod fit_net;
pub mod interpolate;
pub mod polynomial;
pub mod scatter;
mod scatter_estimate;
