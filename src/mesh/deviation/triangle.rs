//! How far a triangle may be from its surface: bounded by interval arithmetic, not sampled.
//!
//! Along the triangle's normal n, the surface less the triangle's plane is a function of (u, v) that vanishes at the three
//! corners. With second derivatives H = M ± R over the triangle's box, at barycentric λ it is
//! −½ Σ λi λj (eᵀ M e + eᵀ R e) over the three sides e: Taylor's formula about the point, and Σ λi (vi − x)(vi − x)ᵀ =
//! Σ λi λj e eᵀ. For constant H this is exact.

use glam::{DVec2, DVec3};

use crate::base::range::Interval3;
use crate::base::tolerance::NUDGE;
use crate::mesh::deviation::bend_bounds::{bends_over, beside_kinks};
use crate::mesh::deviation::heights::{Heights, Plane};
use crate::mesh::deviation::point_triangle;
use crate::mesh::deviation::poles;
use crate::mesh::deviation::quadratic::{over_corners, over_sides};
use crate::surface::core::power_form::Bends;
use crate::surface::{Evaluator, Surface};

/// What steers the bound of a triangle.
struct TriangleSettings {
    /// Share of the box of a triangle by which it is widened: feet of its points lie a little beside their (u, v).
    widening: f64,
    /// How often a triangle is cut into [`Heights::PARTS`]² parts where the bound over the whole of it is not enough.
    max_divisions: u32,
    /// How often a triangle that stands on edge is cut into four.
    max_parts: u32,
    /// A bound that is larger than this times the distance wanted is not refined by parts, but where one polynomial a span makes that cheap.
    max_excess: f64,
    /// Width in (u, v) from which a triangle goes round a tip.
    min_width_round_tip: f64,
}

const SETTINGS: TriangleSettings =
    TriangleSettings { widening: 0.05, max_divisions: 2, max_parts: 8, max_excess: 8.0, min_width_round_tip: 0.03 };

/// Largest distance of a triangle from the surface, by the places and points of its corners; infinite where the surface
/// has no bounded second derivative.
///
/// Of a triangle with a corner at a pole a `second` one in (u, v) belongs to it, with two corners there ([`poles::under`]): each is
/// bounded. A bound above `wanted` is found by parts, with the heights at their corners: what is not known of the bend of the whole weighs a
/// sixteenth over parts a quarter as wide. Where that is not enough for a part, its own bend is found.
pub fn chord(evaluator: Evaluator, uv: [DVec2; 3], second: Option<[DVec2; 3]>, p: [DVec3; 3], wanted: f64) -> f64 {
    let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
    if normal == DVec3::ZERO {
        return in_any_direction(evaluator.surface(), uv);
    }
    let most = |evaluator| {
        let first = above_plane(evaluator, uv, p[0], normal, wanted);
        match second {
            Some(second) if first <= wanted => first.max(above_plane(evaluator, second, p[0], normal, wanted)),
            _ => first,
        }
    };
    let found = most(evaluator);
    let by_net = || most(evaluator.without_power_form());
    if found > wanted && evaluator.has_power_form() && goes_round_tip(evaluator, uv) { found.min(by_net()) } else { found }
}

/// Whether a triangle goes a good part of the way round a tip: bounds of third derivatives are those of a whole box, and do not get less
/// with the distance from it.
fn goes_round_tip(evaluator: Evaluator, uv: [DVec2; 3]) -> bool {
    let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
    let middle = 0.5 * (low + high);
    let tangents = |at: DVec2| evaluator.tangents(at.x, at.y);
    let at = [DVec2::new(middle.x, middle.y.round()), DVec2::new(middle.x.round(), middle.y)];
    (high - low).max_element() > SETTINGS.min_width_round_tip
        && at.into_iter().any(|at| poles::tip(evaluator.surface(), &tangents, at).is_some())
}

/// The most that the surface over a triangle of (u, v) is off the plane of its corners, through `on` with a unit normal. The search ends with
/// the first height above `wanted`.
fn above_plane(evaluator: Evaluator, uv: [DVec2; 3], on: DVec3, normal: DVec3, wanted: f64) -> f64 {
    let plane = Plane { on, normal };
    let bends = bends_of(evaluator, uv, normal);
    let first = bends.map_or(f64::INFINITY, |bends| over_sides(&bends, uv, width(uv)));
    let costly = !evaluator.has_power_form() || evaluator.has_ranges();
    if first <= wanted || costly && first > SETTINGS.max_excess * wanted {
        return first;
    }
    let mut worst = 0.0_f64;
    let mut open = vec![(uv, [0.0_f64; 3], bends, SETTINGS.max_divisions)];
    while let Some((uv, above, bends, left)) = open.pop() {
        let heights = match Heights::of(evaluator, uv, above, plane, wanted) {
            Ok(heights) => heights,
            Err(seen) => return seen,
        };
        for (small, above) in heights.parts(uv) {
            let shared = bends.map_or(f64::INFINITY, |bends| over_corners(above, &bends, small, width(small)));
            if shared <= wanted {
                worst = worst.max(shared);
                continue;
            }
            let own = if left > 0 { bends_of(evaluator, small, normal) } else { None };
            let bound = own.map_or(shared, |own| over_corners(above, &own, small, width(small)).min(shared));
            if bound <= wanted {
                worst = worst.max(bound);
            } else if left > 1 {
                open.push((small, above, own, left - 1));
            } else {
                return bound;
            }
        }
    }
    worst
}

/// How far the surface over a triangle of (u, v) may be from the places between its corners in space, in any direction: |S − L| where L is linear
/// and S at the corners. Infinite where no second derivative is bounded; nothing where (u, v) are on a line, as in a pole.
///
/// A bound for three corners on a line, which have no plane, and for a triangle that stands on edge.
pub fn in_any_direction(surface: &Surface, uv: [DVec2; 3]) -> f64 {
    if (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]).abs() <= NUDGE * NUDGE {
        return 0.0;
    }
    let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
    let hold = |x: f64| x.clamp(0.0, 1.0);
    let enclosure = surface.enclosure((hold(low.x), hold(high.x)), (hold(low.y), hold(high.y)));
    let all = [enclosure.duu, enclosure.duv, enclosure.dvv];
    if all.iter().any(Interval3::is_unbounded) {
        return f64::INFINITY;
    }
    over_sides(&Bends { mid: [0.0; 3], slack: all.map(|r| r.reach()), jump: 0.0 }, uv, high - low)
}

/// How far the surface over a triangle of (u, v) may be from the triangle, whichever way it leaves it. The search ends with the first distance
/// above `wanted`.
///
/// A triangle that stands on edge may keep the surface near its plane and its sides near the surface, and yet lie beside a peak: heights over
/// its plane do not tell. Between three places the surface is at most as far from the triangle as the farthest of them, for the triangle is
/// convex, and farther by what the surface bends there.
pub fn beyond(evaluator: Evaluator, uv: [DVec2; 3], p: [DVec3; 3], wanted: f64) -> f64 {
    let off = |at: DVec2| point_triangle::distance(p, evaluator.point(at.x, at.y));
    let mut worst = 0.0_f64;
    // Border nodes of glued edges lie beside the surface.
    let mut open = vec![(uv, uv.map(off), SETTINGS.max_parts)];
    while let Some((uv, corners, left)) = open.pop() {
        let far = corners.into_iter().fold(0.0, f64::max);
        let area = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        let bends = lengths_over(evaluator, area);
        let bound = far + bends.map_or(f64::INFINITY, |bends| over_sides(&bends, uv, area.1 - area.0));
        if far > wanted || bound > wanted && left == 0 {
            return bound;
        }
        if bound <= wanted {
            worst = worst.max(bound);
            continue;
        }
        // The middle of the side opposite each corner.
        let middles = [0, 1, 2].map(|k| 0.5 * (uv[(k + 1) % 3] + uv[(k + 2) % 3]));
        let own = middles.map(off);
        open.push((middles, own, left - 1));
        for k in 0..3 {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            open.push(([uv[k], middles[last], middles[next]], [corners[k], own[last], own[next]], left - 1));
        }
    }
    worst
}

/// How long second derivatives may be over a box; `None` where they are not bounded.
fn lengths_over(evaluator: Evaluator, area: (DVec2, DVec2)) -> Option<Bends> {
    let both = |x: f64, y: f64| (x * x + y * y).sqrt();
    let mut whole = Bends { mid: [0.0; 3], slack: [0.0; 3], jump: 0.0 };
    for axis in DVec3::AXES {
        let along = bends_over(evaluator, area, axis)?;
        (0..3).for_each(|k| whole.slack[k] = both(whole.slack[k], along.mid[k].abs() + along.slack[k]));
        whole.jump = both(whole.jump, along.jump);
    }
    Some(whole)
}

/// The width of the box of a triangle.
fn width(uv: [DVec2; 3]) -> DVec2 {
    uv[0].max(uv[1]).max(uv[2]) - uv[0].min(uv[1]).min(uv[2])
}

/// Second derivatives along a unit vector over the box of a triangle and a little more; `None` where they are not bounded.
fn bends_of(evaluator: Evaluator, uv: [DVec2; 3], normal: DVec3) -> Option<Bends> {
    let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
    let more = (high - low) * SETTINGS.widening;
    bends_over(evaluator, beside_kinks(evaluator.surface(), (low, high), (low - more, high + more)), normal)
}

/// How far the surface is from a triangle in the middles of its sides and in its own.
pub fn sampled(point: &impl Fn(DVec2) -> DVec3, uv: [DVec2; 3], p: [DVec3; 3]) -> f64 {
    let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
    let middle = |i: usize, j: usize| 0.5 * (uv[i] + uv[j]);
    let places = [middle(0, 1), middle(1, 2), middle(2, 0), (uv[0] + uv[1] + uv[2]) / 3.0];
    places.into_iter().map(|at| (point(at) - p[0]).dot(normal).abs()).fold(0.0, f64::max)
}
