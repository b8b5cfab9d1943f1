//! A point of a curve with its derivatives.

use glam::DVec3;

/// Point and first two derivatives at one parameter; lengths in model units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// The point.
    pub p: DVec3,
    /// First derivative.
    pub d1: DVec3,
    /// Second derivative.
    pub d2: DVec3,
}
