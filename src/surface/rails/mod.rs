//! Curves of the network as a surface sees them: rails with their parameters, mixtures of them and their bounds, sides, closed boundaries
//! and borders in (u, v).

pub mod boundary;
pub mod line;
pub mod mixed;
pub mod rail;
pub mod reparam;
pub mod ring;
pub mod side;
pub mod trim_curve;
