//! The plane over which a hole is filled.

use glam::{DVec2, DVec3};

use crate::base::math;

/// A plane with coordinates in which the hole is about two wide.
#[derive(Clone, Copy, Debug)]
pub struct HolePlane {
    at: DVec3,
    x: DVec3,
    y: DVec3,
    /// The hole is walked round anticlockwise about it.
    pub normal: DVec3,
    /// Model units in one of its own.
    pub scale: f64,
}

/// The area vector of a polygon, twice.
pub fn area_vector(points: &[DVec3]) -> DVec3 {
    let next = points.iter().cycle().skip(1);
    let first = points.first().copied().unwrap_or_default();
    points.iter().zip(next).map(|(a, b)| (*a - first).cross(*b - first)).sum()
}

impl HolePlane {
    /// Through the middle of points, across a direction.
    pub fn new(points: &[DVec3], normal: DVec3) -> Self {
        let low = points.iter().fold(DVec3::INFINITY, |a, p| a.min(*p));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |a, p| a.max(*p));
        let x = math::any_normal(normal);
        let at = 0.5 * (low + high);
        let scale = points.iter().map(|p| p.distance(at)).fold(0.0, f64::max);
        Self { at, x, y: normal.cross(x), normal, scale }
    }

    /// A direction in its axes.
    pub fn turned(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.normal))
    }

    /// A point in its coordinates; z is the height over it.
    pub fn local(&self, p: DVec3) -> DVec3 {
        self.turned(p - self.at) / self.scale
    }

    /// A point of space.
    pub fn global(&self, q: DVec3) -> DVec3 {
        self.at + (self.x * q.x + self.y * q.y + self.normal * q.z) * self.scale
    }

    /// The place over which a point lies.
    pub fn foot(&self, p: DVec3) -> DVec2 {
        self.local(p).truncate()
    }
}
