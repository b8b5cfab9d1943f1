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
    if quarters.abs() < 1e15 && quarters as i64 as f64 == quarters {
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

/// Directions up to which all pairs of them are compared.
const FEW: usize = 16;

/// The largest angle between any two of some unit vectors, radians; vectors that are zero are left aside.
///
/// Only pairs that may be wider than the widest known one are looked at: the angle of two is never more than both have
/// together from a third direction, and the middle of a wide pair makes few of these sums large.
pub fn widest_angle(all: &[DVec3]) -> f64 {
    let real = |d: &&DVec3| **d != DVec3::ZERO;
    if all.len() <= FEW {
        let pairs =
            all.iter().enumerate().filter(|(_, a)| real(a)).flat_map(|(k, a)| all[k + 1..].iter().filter(real).map(move |b| (*a, *b)));
        let widest = pairs.max_by(|(a, b), (c, d)| a.distance_squared(*b).total_cmp(&c.distance_squared(*d)));
        return widest.map_or(0.0, |(a, b)| angle_between(a, b));
    }
    let all: Vec<DVec3> = all.iter().filter(real).copied().collect();
    let Some(first) = all.first() else { return 0.0 };
    let farthest = |from: DVec3| {
        let far = all.iter().copied().max_by(|a, b| from.distance_squared(*a).total_cmp(&from.distance_squared(*b)));
        far.unwrap_or(from)
    };
    let one = farthest(*first);
    let other = farthest(one);
    let mut widest = angle_between(one, other);
    // The middle of opposite directions may be anything; nothing is wider than they are.
    let middle = (one + other).normalize_or(one);
    let mut ordered: Vec<(f64, DVec3)> = all.iter().map(|d| (angle_between(middle, *d), *d)).collect();
    ordered.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (k, (off, a)) in ordered.iter().enumerate() {
        if off + off <= widest {
            break;
        }
        for (other, b) in &ordered[k + 1..] {
            if off + other <= widest {
                break;
            }
            widest = widest.max(angle_between(*a, *b));
        }
    }
    widest
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Directions within some angle of z, each turned about it against the one before.
    fn fan(n: usize, reach: f64, turns: f64) -> Vec<DVec3> {
        let direction = |k: usize| {
            let (a, r) = (turns * k as f64, reach * (0.5 + 0.5 * cos(0.37 * k as f64)));
            DVec3::new(sin(r) * cos(a), sin(r) * sin(a), cos(r))
        };
        (0..n).map(direction).collect()
    }

    #[test]
    fn the_widest_angle_is_that_of_the_widest_pair() {
        let three = |reach: f64| [0.0, 120.0, 240.0_f64].map(|a| DVec3::new(reach * cos(a.to_radians()), reach * sin(a.to_radians()), 1.0));
        // Where each is as far from the others as these from each other, the farthest of the farthest is one of many.
        let mut cases = vec![three(0.02).map(DVec3::normalize).to_vec(), vec![DVec3::X, DVec3::ZERO, -DVec3::X], vec![DVec3::ZERO; 20]];
        for (n, reach, turns) in [(17, 0.01, 2.1), (200, 1.0, 0.7), (300, 3.0, 1.9), (40, 1e-6, 2.09)] {
            cases.push(fan(n, reach, turns));
        }
        for all in cases {
            let known: Vec<DVec3> = all.iter().copied().filter(|d| *d != DVec3::ZERO).collect();
            let pairs = known.iter().flat_map(|a| known.iter().map(|b| angle_between(*a, *b)));
            let expected = pairs.fold(0.0, f64::max);
            assert!((widest_angle(&all) - expected).abs() <= 1e-12, "{} {expected}", widest_angle(&all));
        }
    }
}
