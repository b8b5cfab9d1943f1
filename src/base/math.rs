//! Elementary functions that give the same bits on every platform, and a few vector helpers.
//!
//! The standard library's `sin` and friends come from the platform and may differ in the last bit; clippy forbids
//! them (`.clippy.toml`). `sqrt` is correctly rounded everywhere and allowed.

use glam::DVec3;

pub use libm::{acos, acosh, asin, asinh, atan, atan2, atanh, cbrt, cosh, exp, hypot, log, log2, log10, pow, sinh, tanh};

/// Sine of an angle in radians, exact at quarter turns that are written as multiples of π/2.
pub fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

/// Cosine of an angle in radians, exact at quarter turns.
pub fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

/// Tangent of an angle in radians.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Sine and cosine of an angle in radians, exact at quarter turns.
pub fn sin_cos(x: f64) -> (f64, f64) {
    let quarters = x / std::f64::consts::FRAC_PI_2;
    if quarters == quarters.trunc() && quarters.abs() < 1e15 {
        return match (quarters as i64).rem_euclid(4) {
            0 => (0.0, 1.0),
            1 => (1.0, 0.0),
            2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        };
    }
    libm::sincos(x)
}

/// x to a whole power by repeated multiplication.
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut base, mut left, mut result) = (if n < 0 { 1.0 / x } else { x }, n.unsigned_abs(), 1.0);
    while left > 0 {
        if left & 1 == 1 {
            result *= base;
        }
        base *= base;
        left >>= 1;
    }
    result
}

/// Angle between two vectors of any length but zero, 0…π radians; accurate near 0 and π.
pub fn angle_between(a: DVec3, b: DVec3) -> f64 {
    atan2(a.cross(b).length(), a.dot(b))
}

/// The unit vector along `v`, or `None` when its length is not above `least`.
pub fn unit(v: DVec3, least: f64) -> Option<DVec3> {
    let length = v.length();
    (length > least && length.is_finite()).then(|| v / length)
}

/// Some unit vector at right angles to the unit vector `n`; the same for the same `n`.
pub fn any_normal(n: DVec3) -> DVec3 {
    let a = n.abs();
    let axis = if a.x <= a.y && a.x <= a.z {
        DVec3::X
    } else if a.y <= a.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    (axis - n * n.dot(axis)).normalize()
}

/// Points in one order everywhere: by x, then y, then z.
pub fn compare_points(a: DVec3, b: DVec3) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}
