//! Where a curve passes a plane.

use glam::{DVec3, DVec4};

use crate::base::tolerance::{CURVE_CROSSINGS_APART, CURVE_HEIGHT_ROUNDING};
use crate::geometry::shapes::nurbs::Nurbs;
use crate::geometry::shapes::nurbs_edit::Bezier;

/// Halvings of a Bézier piece: below rounding of its parameter.
const HALVINGS: u32 = 50;

/// Parameters at which a curve passes or touches the plane of the points `p` with `normal · p = offset`, ascending.
///
/// All of them: a piece is left out only when its Bézier points lie on one side (convex hull), and halved while they do not.
/// Pieces that lie in the plane give their ends.
pub fn plane_crossings(curve: &Nurbs, normal: DVec3, offset: f64) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    let plane = normal.extend(-offset);
    for mut piece in curve.beziers() {
        piece.poles.iter_mut().for_each(|p| *p = DVec4::X * plane.dot(*p));
        let size = piece.poles.iter().fold(0.0, |most: f64, p| most.max(p.x.abs()));
        if size == 0.0 {
            found.extend([piece.t0, piece.t1]);
        } else {
            search(&piece, CURVE_HEIGHT_ROUNDING * size, HALVINGS, &mut found);
        }
    }
    let apart = CURVE_CROSSINGS_APART * (curve.domain().1 - curve.domain().0);
    found.sort_by(f64::total_cmp);
    found.dedup_by(|b, a| *b - *a <= apart);
    found
}

/// Roots of one piece whose heights over the plane are the x of its poles.
fn search(piece: &Bezier, rounding: f64, left: u32, found: &mut Vec<f64>) {
    let (low, high) = piece.poles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.x), high.max(p.x)));
    if low > 0.0 || high < 0.0 {
        return;
    }
    if left == 0 || high - low <= rounding {
        found.push(0.5 * (piece.t0 + piece.t1));
        return;
    }
    let (a, b) = piece.halves();
    search(&a, rounding, left - 1, found);
    search(&b, rounding, left - 1, found);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;

    #[test]
    fn crossings_are_all_found() {
        // Heights (1−t)³ − 9t(1−t)² + 9t²(1−t) − t³: three roots.
        let poles = [1.0, -3.0, 3.0, -1.0].map(|z| DVec4::new(0.0, 0.0, z, 1.0));
        let curve = Nurbs::bezier(0.0, 1.0, poles.to_vec());
        let roots = plane_crossings(&curve, DVec3::Z, 0.0);
        assert_eq!(roots.len(), 3, "{roots:?}");
        for t in roots {
            let s = 1.0 - t;
            let height = math::powi(s, 3) - 9.0 * t * s * s + 9.0 * t * t * s - math::powi(t, 3);
            assert!(height.abs() < 1e-12, "{t}: {height}");
        }
    }

    #[test]
    fn a_touch_an_end_and_a_part_in_the_plane() {
        let of = |heights: &[f64]| Nurbs::bezier(0.0, 1.0, heights.iter().map(|z| DVec4::new(0.0, 0.0, *z, 1.0)).collect());
        let touch = plane_crossings(&of(&[1.0, -1.0, 1.0]), DVec3::Z, 0.0);
        assert!(touch.len() == 1 && (touch[0] - 0.5).abs() < 1e-7, "{touch:?}");
        // A touch at one third, where halves are rounded: nothing is halved without end.
        let third = plane_crossings(&of(&[1.0, -2.0, 4.0]), DVec3::Z, 0.0);
        assert!(third.iter().all(|t| (t - 1.0 / 3.0).abs() < 1e-6), "{third:?}");
        let end = plane_crossings(&of(&[0.0, 1.0, 1.0]), DVec3::Z, 0.0);
        assert!(end.len() == 1 && end[0] < 1e-12, "{end:?}");
        assert_eq!(plane_crossings(&of(&[0.0, 0.0, 0.0]), DVec3::Z, 0.0), [0.0, 1.0]);
        assert!(plane_crossings(&of(&[1.0, 0.5, 2.0]), DVec3::Z, 0.0).is_empty());
    }
}
