//! Triangles with a corner at a pole, where a whole side of (u, v) is one point in space.

use glam::{DVec2, DVec3};

use crate::base::math::angle_between;
use crate::base::tolerance::{EPSILON, FLAT, SINGULAR};
use crate::surface::{Domain, Surface};

/// The coordinate that does not matter at a place, at a pole.
fn free(tangents: &impl Fn(DVec2) -> [DVec3; 3], at: DVec2) -> Option<usize> {
    // Poles lie on the border of (u, v), but for what rounding does on the way through the chart.
    if at.cmpgt(DVec2::splat(EPSILON)).all() && at.cmplt(DVec2::splat(1.0 - EPSILON)).all() {
        return None;
    }
    let [_, du, dv] = tangents(at).map(DVec3::length);
    [(du, dv, 0), (dv, du, 1)].into_iter().find(|(none, all, _)| *none <= SINGULAR * all).map(|found| found.2)
}

/// Whether a place is one.
pub fn is_pole(tangents: &impl Fn(DVec2) -> [DVec3; 3], at: DVec2) -> bool {
    free(tangents, at).is_some()
}

/// Places of a triangle of which a corner may be at a pole: all places there are one point, and that between the other two
/// corners spans the least.
pub fn from_pole(tangents: &impl Fn(DVec2) -> [DVec3; 3], at: [DVec2; 3]) -> [DVec2; 3] {
    let free = at.map(|at| free(tangents, at));
    let mut best = at;
    for k in 0..3 {
        let Some(axis) = free[k] else { continue };
        // Of two corners in poles both have the column of the third.
        let others = [(k + 1) % 3, (k + 2) % 3];
        let held: Vec<f64> = others.into_iter().filter(|i| free[*i] != Some(axis)).map(|i| at[i][axis]).collect();
        best[k][axis] = match held[..] {
            [] => 0.5 * (at[others[0]][axis] + at[others[1]][axis]),
            [one] => one,
            _ => 0.5 * (held[0] + held[1]),
        };
    }
    best
}

/// What of (u, v) lies over a triangle: with one corner at a pole all between the columns of the other two, up to the pole, which is
/// two triangles; the second has two corners there.
pub fn under(tangents: &impl Fn(DVec2) -> [DVec3; 3], at: [DVec2; 3]) -> ([DVec2; 3], Option<[DVec2; 3]>) {
    let all = at.map(|at| free(tangents, at));
    let (Some(k), 1) = (all.iter().position(Option::is_some), all.iter().flatten().count()) else {
        return (from_pole(tangents, at), None);
    };
    let axis = all[k].unwrap_or_default();
    let others = [at[(k + 1) % 3], at[(k + 2) % 3]];
    let away = others.map(|place| (place[1 - axis] - at[k][1 - axis]).abs());
    let far = usize::from(away[1] > away[0]);
    let pole = |column: DVec2| {
        let mut place = at[k];
        place[axis] = column[axis];
        place
    };
    let mut first = at;
    first[k] = pole(others[far]);
    (first, Some([first[k], others[1 - far], pole(others[1 - far])]))
}

/// Ends of the sides of a triangle in (u, v), in the order of the corners opposite: up to a pole each runs along the column of its
/// other end.
pub fn sides(tangents: &impl Fn(DVec2) -> [DVec3; 3], at: [DVec2; 3]) -> [[DVec2; 2]; 3] {
    let all = at.map(|at| free(tangents, at));
    let end = |k: usize, other: usize| {
        let mut place = at[k];
        if let Some(axis) = all[k] {
            place[axis] = at[other][axis];
        }
        place
    };
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [end(i, j), end(j, i)])
}

/// The normal of a pole on the way to it along its column: where the surface is smooth there they are one, and round a tip
/// each column has its own. `None` where a place is no pole.
pub fn normal(surface: &Surface, tangents: &impl Fn(DVec2) -> [DVec3; 3], at: DVec2) -> Option<DVec3> {
    let along = 1 - free(tangents, at)?;
    let jet = surface.jet(at.x, at.y);
    // A step inwards, the vanishing derivative is the mixed one times that step.
    let inwards = if at[along] > 0.5 { -jet.duv } else { jet.duv };
    let normal = if along == 1 { inwards.cross(jet.dv) } else { jet.du.cross(inwards) };
    Some(normal.normalize_or_zero())
}

/// The coordinate that does not matter at the tip of a cone or a funnel; `None` elsewhere, also at a smooth pole.
pub fn tip(surface: &Surface, tangents: &impl Fn(DVec2) -> [DVec3; 3], at: DVec2) -> Option<usize> {
    let axis = free(tangents, at).filter(|_| surface.domain() != Domain::Triangle)?;
    let column = |x: f64| {
        let mut place = at;
        place[axis] = x;
        normal(surface, tangents, place)
    };
    (angle_between(column(0.0)?, column(0.5)?) > FLAT).then_some(axis)
}

/// The length wanted at a tip: bends grow without bound towards it, and the length wanted falls as the root of the distance, but triangles
/// round it are as long as they are far from it. So it is the length wanted where that is the distance itself.
pub fn at_tip(surface: &Surface, tangents: &impl Fn(DVec2) -> [DVec3; 3], at: DVec2, wanted: &impl Fn(DVec2) -> f64) -> Option<f64> {
    let axis = tip(surface, tangents, at)?;
    let from = tangents(at)[0];
    let mut step = 0.5 - at[1 - axis].clamp(0.0, 1.0);
    for _ in 0..MAX_TIP_STEPS {
        let mut place = at;
        place[1 - axis] += step;
        let (far, length) = (tangents(place)[0].distance(from), wanted(place));
        if length >= MIN_TIP_SHARE * far {
            return Some(length);
        }
        step *= length / far;
    }
    None
}

/// Steps towards a tip: each halves the logarithm of what is missing.
const MAX_TIP_STEPS: usize = 16;
/// Share of the distance from a tip from which on a length is that.
const MIN_TIP_SHARE: f64 = 0.9;
