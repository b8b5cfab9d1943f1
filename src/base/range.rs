//! Interval arithmetic: numbers and vectors known to lie between two ends.
//!
//! Every operation holds all results of its operands; rounding is not counted (relative 1e-16 an operation). A width
//! above [`UNBOUNDED_REACH`] stands for "not bounded" and stays finite, so that nothing ever becomes NaN.

use std::ops::{Add, Mul, Neg, Sub};

use glam::{DVec3, Vec3Swizzles as _};

use super::bbox::Box3;
use super::tolerance::UNBOUNDED_REACH;

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// Least.
    pub low: f64,
    /// Largest.
    pub high: f64,
}

impl Interval {
    /// One number.
    pub const fn at(x: f64) -> Self {
        Self { low: x, high: x }
    }

    /// Between two numbers in any order.
    pub fn between(a: f64, b: f64) -> Self {
        Self { low: a.min(b), high: a.max(b) }
    }

    /// −r … r.
    pub fn around_zero(r: f64) -> Self {
        Self { low: -r, high: r }
    }

    /// Both and all between.
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// What both hold; of ranges apart (by rounding) the first.
    pub fn intersection(self, other: Self) -> Self {
        let both = Self { low: self.low.max(other.low), high: self.high.min(other.high) };
        if both.low <= both.high { both } else { self }
    }

    /// Largest absolute value.
    pub fn reach(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Squares.
    pub fn square(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        Self { low: if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { a.min(b) }, high: a.max(b) }
    }

    /// One over each; unbounded where zero is inside.
    pub fn inverse(self) -> Self {
        if self.low <= 0.0 && self.high >= 0.0 {
            return Self::around_zero(UNBOUNDED_REACH);
        }
        Self::between(1.0 / self.low, 1.0 / self.high)
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { low: self.low - other.high, high: self.high - other.low }
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b, c, d) = (self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high);
        Self { low: a.min(b).min(c.min(d)), high: a.max(b).max(c.max(d)) }
    }
}

impl Mul<f64> for Interval {
    type Output = Self;
    fn mul(self, f: f64) -> Self {
        Self::between(self.low * f, self.high * f)
    }
}

/// The vectors of a box along the axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval3 {
    /// Least of each coordinate.
    pub low: DVec3,
    /// Largest of each coordinate.
    pub high: DVec3,
}

impl Interval3 {
    /// One vector.
    pub const fn at(v: DVec3) -> Self {
        Self { low: v, high: v }
    }

    /// Not bounded.
    pub const ANY: Self = Self { low: DVec3::splat(-UNBOUNDED_REACH), high: DVec3::splat(UNBOUNDED_REACH) };

    /// All of the vectors; there must be one.
    pub fn of(vectors: impl IntoIterator<Item = DVec3>) -> Self {
        let Box3 { min, max } = Box3::of(vectors);
        Self { low: min, high: max }
    }

    /// Each coordinate within ±r of zero.
    pub fn around_zero(r: DVec3) -> Self {
        Self { low: -r, high: r }
    }

    /// Both and all between.
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// What both hold, coordinate by coordinate.
    pub fn intersection(self, other: Self) -> Self {
        let one = |k: usize| self.coordinate(k).intersection(other.coordinate(k));
        Self::from_coordinates([one(0), one(1), one(2)])
    }

    /// One coordinate.
    pub fn coordinate(&self, k: usize) -> Interval {
        Interval { low: self.low[k], high: self.high[k] }
    }

    fn from_coordinates(c: [Interval; 3]) -> Self {
        Self { low: DVec3::new(c[0].low, c[1].low, c[2].low), high: DVec3::new(c[0].high, c[1].high, c[2].high) }
    }

    /// Whether no useful bound is known.
    pub fn is_unbounded(&self) -> bool {
        let reach = self.reach();
        reach.is_nan() || reach >= UNBOUNDED_REACH.sqrt()
    }

    /// Largest length, at most.
    pub fn reach(&self) -> f64 {
        self.low.abs().max(self.high.abs()).length()
    }

    /// Lengths.
    pub fn length(&self) -> Interval {
        let nearest = DVec3::ZERO.clamp(self.low, self.high);
        Interval { low: nearest.length(), high: self.reach() }
    }

    /// Products with one vector.
    pub fn along(&self, n: DVec3) -> Interval {
        let (a, b) = (self.low * n, self.high * n);
        Interval { low: a.min(b).element_sum(), high: a.max(b).element_sum() }
    }

    /// Scalar products.
    pub fn dot(&self, other: &Self) -> Interval {
        let product = *self * *other;
        Interval { low: product.low.element_sum(), high: product.high.element_sum() }
    }

    /// Vector products.
    pub fn cross(&self, other: &Self) -> Self {
        let turned = |r: &Self| (Self { low: r.low.zxy(), high: r.high.zxy() }, Self { low: r.low.yzx(), high: r.high.yzx() });
        let ((a_zxy, a_yzx), (b_zxy, b_yzx)) = (turned(self), turned(other));
        a_yzx * b_zxy - a_zxy * b_yzx
    }

    /// The box of the same vectors as points.
    pub fn bounds(&self) -> Box3 {
        Box3 { min: self.low, max: self.high }
    }
}

impl Add for Interval3 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }
}

impl Add<DVec3> for Interval3 {
    type Output = Self;
    fn add(self, v: DVec3) -> Self {
        Self { low: self.low + v, high: self.high + v }
    }
}

impl Sub for Interval3 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { low: self.low - other.high, high: self.high - other.low }
    }
}

impl Neg for Interval3 {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

/// Coordinate by coordinate.
impl Mul for Interval3 {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b, c, d) = (self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high);
        Self { low: a.min(b).min(c.min(d)), high: a.max(b).max(c.max(d)) }
    }
}

impl Mul<Interval> for Interval3 {
    type Output = Self;
    fn mul(self, f: Interval) -> Self {
        let (a, b, c, d) = (self.low * f.low, self.low * f.high, self.high * f.low, self.high * f.high);
        Self { low: a.min(b).min(c.min(d)), high: a.max(b).max(c.max(d)) }
    }
}

impl Mul<f64> for Interval3 {
    type Output = Self;
    fn mul(self, f: f64) -> Self {
        let (a, b) = (self.low * f, self.high * f);
        Self { low: a.min(b), high: a.max(b) }
    }
}

/// Multiples of one vector.
impl Mul<DVec3> for Interval {
    type Output = Interval3;
    fn mul(self, v: DVec3) -> Interval3 {
        let (a, b) = (v * self.low, v * self.high);
        Interval3 { low: a.min(b), high: a.max(b) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_hold_all_results() {
        let pick = |r: Interval, k: u32| r.low + (r.high - r.low) * f64::from(k) / 4.0;
        let holds = |r: Interval, x: f64| r.low - 1e-12 <= x && x <= r.high + 1e-12;
        let ends = [-2.0, -0.5, 0.0, 0.75, 3.0];
        for (&a, &b) in ends.iter().zip(&ends[1..]) {
            for (&c, &d) in ends.iter().zip(&ends[1..]) {
                let (r, s) = (Interval::between(b, a), Interval::between(c, d));
                let (x, y) = (
                    Interval3 { low: DVec3::new(a, c, a), high: DVec3::new(b, d, b) },
                    Interval3 { low: DVec3::new(c, a, c), high: DVec3::new(d, b, d) },
                );
                for k in 0..25 {
                    let (p, q) = (pick(r, k / 5), pick(s, k % 5));
                    assert!(holds(r + s, p + q) && holds(r - s, p - q) && holds(r * s, p * q) && holds(r.square(), p * p));
                    let (v, w) = (DVec3::new(p, q, pick(r, k % 5)), DVec3::new(q, p, pick(s, k / 5)));
                    assert!(holds(x.dot(&y), v.dot(w)) && holds(x.length(), v.length()) && holds(x.along(w), v.dot(w)));
                    let cross = v.cross(w);
                    (0..3).for_each(|i| assert!(holds(x.cross(&y).coordinate(i), cross[i])));
                    (0..3).for_each(|i| assert!(holds((x * s).coordinate(i), v[i] * q)));
                }
            }
        }
    }
}
