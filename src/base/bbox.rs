//! Boxes along the axes.

use glam::DVec3;

/// A closed box along the axes; empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box3 {
    /// Smallest coordinates, model length units.
    pub min: DVec3,
    /// Largest coordinates, model length units.
    pub max: DVec3,
}

impl Box3 {
    /// The box of nothing.
    pub const EMPTY: Self = Self { min: DVec3::splat(f64::INFINITY), max: DVec3::splat(f64::NEG_INFINITY) };

    /// The smallest box that holds all points.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }

    /// This box grown to hold `p`.
    pub fn with(self, p: DVec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box that holds both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        !(self.min.cmple(self.max).all())
    }

    /// Whether the two, each grown by half of `margin`, touch.
    pub fn touches(&self, other: &Self, margin: f64) -> bool {
        (self.min - DVec3::splat(margin)).cmple(other.max).all() && other.min.cmple(self.max + DVec3::splat(margin)).all()
    }

    /// The box with its sides further out by `margin`.
    pub fn grown(&self, margin: f64) -> Self {
        Self { min: self.min - DVec3::splat(margin), max: self.max + DVec3::splat(margin) }
    }

    /// Square of the distance of a point, model units; 0 inside.
    pub fn distance_squared(&self, p: DVec3) -> f64 {
        p.distance_squared(p.clamp(self.min, self.max))
    }

    /// Length of the diagonal, 0 when empty.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }

    /// Distance from the origin to the farthest corner, 0 when empty.
    pub fn furthest(&self) -> f64 {
        if self.is_empty() { 0.0 } else { self.min.abs().max(self.max.abs()).length() }
    }

    /// The eight corners; of an empty box none is a point.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|k| {
            let pick = |bit: usize, low: f64, high: f64| if k >> bit & 1 == 0 { low } else { high };
            DVec3::new(pick(0, self.min.x, self.max.x), pick(1, self.min.y, self.max.y), pick(2, self.min.z, self.max.z))
        })
    }

    /// How far it reaches along a unit vector from a point, least and most, model units.
    pub fn stretch(&self, from: DVec3, direction: DVec3) -> (f64, f64) {
        let along = self.corners().map(|p| (p - from).dot(direction));
        (along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    /// Middle of the box.
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }
}
