//! Signs that decide topology, exact for doubles [Shewchuk 1997] by way of the crate robust.

use glam::DVec2;
use robust::Coord;

fn coord(p: DVec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

/// Twice the area of the triangle a b c with the right sign: positive when it runs counter-clockwise, 0 only when collinear.
pub fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Positive when `d` lies inside the circle through the counter-clockwise triangle a b c, 0 only when on it.
pub fn in_circle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> f64 {
    robust::incircle(coord(a), coord(b), coord(c), coord(d))
}

/// Where a point is relative to a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Strictly inside (odd winding).
    Inside,
    /// On an edge or corner.
    Boundary,
    /// Strictly outside.
    Outside,
}

/// Even-odd rule by exact orientation tests [Hormann & Agathos 2001]; the polygon closes itself.
pub fn point_in_polygon(p: DVec2, polygon: &[DVec2]) -> Side {
    let mut inside = false;
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[if i == 0 { polygon.len() - 1 } else { i - 1 }];
        if p == b {
            return Side::Boundary;
        }
        if a.y == p.y && b.y == p.y {
            if (a.x < p.x) != (b.x < p.x) {
                return Side::Boundary;
            }
            continue;
        }
        if (a.y <= p.y) == (b.y <= p.y) {
            continue;
        }
        let side = orient(a, b, p);
        if side == 0.0 {
            return Side::Boundary;
        }
        if (side > 0.0) == (b.y > a.y) {
            inside = !inside;
        }
    }
    if inside { Side::Inside } else { Side::Outside }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_hold_where_rounding_fails() {
        let tiny = f64::EPSILON;
        let (a, b) = (DVec2::new(12.0, 12.0), DVec2::new(24.0, 24.0));
        assert_eq!(orient(DVec2::splat(0.5), a, b), 0.0);
        assert!(orient(DVec2::new(0.5, 0.5 + tiny), a, b) > 0.0);
        assert!(orient(DVec2::new(0.5 + tiny, 0.5), a, b) < 0.0);
        assert!(in_circle(DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::new(0.0, -1.0 + tiny)) > 0.0);
    }

    #[test]
    fn points_in_a_concave_polygon() {
        let l = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec2::new(x, y));
        for (p, side) in [
            ((0.5, 0.5), Side::Inside),
            ((3.0, 0.5), Side::Inside),
            ((0.5, 1.0), Side::Inside),
            ((2.0, 2.0), Side::Outside),
            ((-1.0, 1.0), Side::Outside),
            ((5.0, 0.0), Side::Outside),
            ((2.0, 1.0), Side::Boundary),
            ((1.0, 1.0), Side::Boundary),
            ((0.0, 2.0), Side::Boundary),
            ((2.0, 0.0), Side::Boundary),
        ] {
            assert_eq!(point_in_polygon(DVec2::new(p.0, p.1), &l), side, "{p:?}");
        }
    }
}
