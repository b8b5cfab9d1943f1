//! How far the surface over the sides of a triangle may be from them.
//!
//! Less the straight side, and across it, the surface over a side is a curve r(t) with r(0) = r(1) = 0. Over a part of it between t0
//! and t1, |r| ≤ max(|r(t0)|, |r(t1)|) + (t1 − t0)² |r″| / 8, with |r″| from second derivatives over a box, along two
//! directions across.

use glam::{DVec2, DVec3};

use crate::mesh::deviation::bend_bounds::bends_over;
use crate::surface::Evaluator;

/// How often a side is halved where the bound over the whole of it is not enough.
const MAX_HALVINGS: u32 = 5;

/// A bound of the distance between the surface and the sides of a triangle, model units.
///
/// `ends` are the ends of the sides in (u, v), in the order of the corners opposite ([`super::poles::sides`]); a side without them is left
/// out. `p` are the corners. The search ends with the first distance above `wanted`, which need not be the largest.
pub fn distance(evaluator: Evaluator, ends: [Option<[DVec2; 2]>; 3], p: [DVec3; 3], wanted: f64) -> f64 {
    let up = (p[1] - p[0]).cross(p[2] - p[0]);
    let mut worst = 0.0_f64;
    for (k, places) in ends.into_iter().enumerate().filter_map(|(k, ends)| Some((k, ends?))) {
        let (from, to) = (p[(k + 1) % 3], p[(k + 2) % 3]);
        let along = (to - from).normalize_or_zero();
        let normal = up.reject_from_normalized(along).try_normalize().unwrap_or_else(|| along.any_orthonormal_vector());
        if places[0] == places[1] || along == DVec3::ZERO {
            continue;
        }
        let side = TriangleSide { evaluator, places, from, across: [normal, normal.cross(along)] };
        worst = worst.max(side.distance(wanted));
        if worst > wanted {
            break;
        }
    }
    worst
}

/// A side with two directions across it.
struct TriangleSide<'a> {
    evaluator: Evaluator<'a>,
    places: [DVec2; 2],
    from: DVec3,
    across: [DVec3; 2],
}

impl TriangleSide<'_> {
    fn distance(&self, wanted: f64) -> f64 {
        let mut worst = 0.0_f64;
        let mut open = vec![([0.0, 1.0], [DVec2::ZERO; 2], MAX_HALVINGS)];
        while let Some((t, r, left)) = open.pop() {
            let bound = r[0].length().max(r[1].length()) + self.bulge(t);
            if bound > wanted && left > 0 {
                let middle = 0.5 * (t[0] + t[1]);
                let there = self.beside(middle);
                if there.length() > wanted {
                    return there.length();
                }
                open.push(([t[0], middle], [r[0], there], left - 1));
                open.push(([middle, t[1]], [there, r[1]], left - 1));
            } else {
                worst = worst.max(bound);
            }
        }
        worst
    }

    /// Where the surface is beside the side, along the two directions.
    fn beside(&self, t: f64) -> DVec2 {
        let at = self.places[0].lerp(self.places[1], t);
        let d = self.evaluator.point(at.x, at.y) - self.from;
        DVec2::new(d.dot(self.across[0]), d.dot(self.across[1]))
    }

    /// How far the surface over a part is from the chord of it, across the side, at most.
    fn bulge(&self, t: [f64; 2]) -> f64 {
        let ends = t.map(|t| self.places[0].lerp(self.places[1], t));
        let step = ends[1] - ends[0];
        let whole = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let along = |normal| match bends_over(self.evaluator, whole, normal) {
            Some(bends) => 0.125 * bends.along(step) + bends.jump,
            None => f64::INFINITY,
        };
        DVec2::new(along(self.across[0]), along(self.across[1])).length()
    }
}
