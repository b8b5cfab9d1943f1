//! A body in calm water: where the water plane is.

use glam::DVec3;

use crate::base::math;
use crate::base::range::Interval3;

/// The water plane with a frame: the model's x runs forward, y to port and z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Water {
    /// A point of the plane, model units: origin of ξ, η, ζ.
    pub origin: DVec3,
    /// Unit vector of ξ: in the plane, forward.
    pub forward: DVec3,
    /// Unit vector of η: in the plane, to port.
    pub port: DVec3,
    /// Unit vector of ζ: out of the water.
    pub up: DVec3,
}

impl Water {
    /// The plane through a point of the centre line, the body trimmed by the stern (its end of small x deeper) and then heeled to
    /// starboard (the side of negative y deeper), radians.
    pub fn at(origin: DVec3, trim: f64, heel: f64) -> Self {
        let ((st, ct), (sh, ch)) = (math::sin_cos(trim), math::sin_cos(heel));
        let up = DVec3::new(st, ct * sh, ct * ch);
        let forward = DVec3::new(ct, -st * sh, -st * ch);
        Self { origin, forward, port: up.cross(forward), up }
    }

    /// Height of a point over the plane, model units.
    pub fn height(&self, p: DVec3) -> f64 {
        self.up.dot(p - self.origin)
    }

    /// ξ, η, ζ of a point.
    pub fn local(&self, p: DVec3) -> DVec3 {
        let r = p - self.origin;
        DVec3::new(self.forward.dot(r), self.port.dot(r), self.up.dot(r))
    }

    /// A point from its ξ, η, ζ.
    pub fn global(&self, q: DVec3) -> DVec3 {
        self.origin + self.forward * q.x + self.port * q.y + self.up * q.z
    }

    /// Least and largest height of points within ranges.
    pub fn heights(&self, points: &Interval3) -> (f64, f64) {
        let (along, zero) = (points.along(self.up), self.up.dot(self.origin));
        (along.low - zero, along.high - zero)
    }

    /// The plane as a body mirrored at y = 0 sees it: what lies at p in that body has here the ξ, η, ζ of p mirrored.
    pub fn mirrored(&self) -> Self {
        let turned = |v: DVec3| DVec3::new(v.x, -v.y, v.z);
        Self { origin: turned(self.origin), forward: turned(self.forward), port: turned(self.port), up: turned(self.up) }
    }
}
