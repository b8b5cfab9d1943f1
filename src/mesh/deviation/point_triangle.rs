//! How far a point is from a triangle.

use glam::DVec3;

/// Distance of a point from a triangle.
pub fn distance([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let normal = (b - a).cross(c - a);
    let outside = |x: DVec3, y: DVec3| (y - x).cross(p - x).dot(normal) < 0.0;
    let side = |x: DVec3, y: DVec3| {
        let along = ((p - x).dot(y - x) / (y - x).length_squared()).clamp(0.0, 1.0);
        if along.is_finite() { x.lerp(y, along).distance(p) } else { x.distance(p) }
    };
    let size = normal.length();
    if size > 0.0 && !(outside(a, b) || outside(b, c) || outside(c, a)) {
        return (normal.dot(p - a) / size).abs();
    }
    side(a, b).min(side(b, c)).min(side(c, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_near_the_inside_a_side_or_a_corner() {
        let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let over = DVec3::new(0.2, 0.3, 1.0);
        for (q, wanted) in
            [(over, 1.0), (DVec3::new(-3.0, 0.5, 4.0), 5.0), (DVec3::new(1.0, 1.0, 0.0), 0.5_f64.sqrt()), (2.0 * DVec3::X, 1.0)]
        {
            assert!((distance(t, q) - wanted).abs() < 1e-15, "{q}");
        }
    }
}
