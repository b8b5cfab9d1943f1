//! How far a triangle may be from its surface: bounded by interval arithmetic, not sampled.
//!
//! Along the triangle's normal n, the surface less the triangle's plane is a function of (u, v) that vanishes at the three
//! corners. With second derivatives H = M ± R over the triangle's box, at barycentric λ it is
//! −½ Σ λi λj (eᵀ M e + eᵀ R e) over the three sides e: Taylor's formula about the point, and Σ λi (vi − x)(vi − x)ᵀ =
//! Σ λi λj e eᵀ. For constant H this is exact.

use glam::{DVec2, DVec3};

use crate::base::range::Range;
use crate::surface::Surface;

/// Share of the box of a triangle by which it is widened: feet of its points lie a little beside their (u, v).
const WIDER: f64 = 0.05;

/// Largest distance of a triangle from the surface, by the places and points of its corners; infinite where the surface
/// has no bounded second derivative.
pub fn chord(surface: &Surface, uv: [DVec2; 3], p: [DVec3; 3]) -> f64 {
    let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
    if normal == DVec3::ZERO {
        return 0.0;
    }
    let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
    let width = high - low;
    let Some([uu, uv_, vv]) = bends(surface, low - width * WIDER, high + width * WIDER, normal) else { return f64::INFINITY };
    let (mid, half) = (|r: Range| 0.5 * (r.low + r.high), |r: Range| 0.5 * (r.high - r.low));
    // 2 |x y| ≤ a x² + y² / a, with a that makes both alike over the box.
    let a = if width.x > 0.0 && width.y > 0.0 { width.y / width.x } else { 1.0 };
    let (ru, rv) = (half(uu) + half(uv_) * a, half(vv) + half(uv_) / a);
    let side = |i: usize, j: usize| {
        let e = uv[j] - uv[i];
        let m = mid(uu) * e.x * e.x + 2.0 * mid(uv_) * e.x * e.y + mid(vv) * e.y * e.y;
        (m, ru * e.x * e.x + rv * e.y * e.y)
    };
    let sides = [side(1, 2), side(2, 0), side(0, 1)];
    let above = most(sides.map(|(m, r)| m + r));
    let below = most(sides.map(|(m, r)| r - m));
    0.5 * above.max(below)
}

/// The most that Σ c λi λj can be for barycentric λ, `c` in the order of the sides opposite the corners.
fn most(c: [f64; 3]) -> f64 {
    let on_side = c.iter().fold(0.0_f64, |m, c| m.max(0.25 * c));
    // Inside, the three derivatives are equal: λ ∝ c_a (c_b + c_c − c_a).
    let weight = |k: usize| c[k] * (c[(k + 1) % 3] + c[(k + 2) % 3] - c[k]);
    let w = [weight(0), weight(1), weight(2)];
    let sum: f64 = w.iter().sum();
    let inside = w.iter().all(|x| x / sum > 0.0);
    if !inside {
        return on_side;
    }
    let l = w.map(|x| x / sum);
    on_side.max(c[0] * l[1] * l[2] + c[1] * l[2] * l[0] + c[2] * l[0] * l[1])
}

/// Second derivatives along a direction over a box of (u, v): by u twice, by both, by v twice. `None` where they have no bound.
fn bends(surface: &Surface, low: DVec2, high: DVec2, along: DVec3) -> Option<[Range; 3]> {
    let (closed_u, closed_v) = surface.closed();
    let mut found: Option<[Range; 3]> = None;
    for u in parts(surface, closed_u, (low.x, high.x)) {
        for v in parts(surface, closed_v, (low.y, high.y)) {
            let spread = surface.spread(u, v);
            if spread.duu.is_vast() || spread.duv.is_vast() || spread.dvv.is_vast() {
                return None;
            }
            let here = [&spread.duu, &spread.duv, &spread.dvv].map(|d| d.along(along));
            found = Some(found.map_or(here, |before| [0, 1, 2].map(|k| before[k].union(here[k]))));
        }
    }
    found
}

/// A range of u or v inside the surface's own: where it closes, what lies over the seam is at the other end.
fn parts(surface: &Surface, closed: bool, (low, high): (f64, f64)) -> Vec<(f64, f64)> {
    if surface.is_flat() {
        return vec![(low, high)];
    }
    if !closed || (low >= 0.0 && high <= 1.0) {
        return vec![(low.clamp(0.0, 1.0), high.clamp(0.0, 1.0))];
    }
    if high - low >= 1.0 {
        return vec![(0.0, 1.0)];
    }
    let turns = low.floor();
    let (low, high) = (low - turns, high - turns);
    if high <= 1.0 { vec![(low, high)] } else { vec![(low, 1.0), (0.0, high - 1.0)] }
}

/// Wanted edge length for limits at a place: of an equilateral triangle, however it lies.
///
/// On the local quadric of principal curvatures k1 ≥ |k2| it is at most k1 h² (1/8 + max(k2/k1, 0)/24) away.
pub fn wanted(surface: &Surface, (u, v): (f64, f64), chord: Option<f64>, angle: Option<f64>) -> f64 {
    let jet = surface.jet(u, v);
    let normal = jet.du.cross(jet.dv).normalize_or_zero();
    let (e, f, g) = (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
    let (l, m, n) = (jet.duu.dot(normal), jet.duv.dot(normal), jet.dvv.dot(normal));
    let area = e * g - f * f;
    let (mean, gauss) = ((e * n - 2.0 * f * m + g * l) / (2.0 * area), (l * n - m * m) / area);
    let spread = (mean * mean - gauss).max(0.0).sqrt();
    let (k1, k2) = (mean.abs() + spread, mean.abs() - spread);
    if !(k1 > 0.0 && k1.is_finite()) {
        return f64::INFINITY;
    }
    let share = 1.0 / 8.0 + (k2 / k1).max(0.0) / 24.0;
    let by_chord = chord.map_or(f64::INFINITY, |limit| (limit / (k1 * share)).sqrt());
    let by_angle = angle.map_or(f64::INFINITY, |limit| limit / k1);
    by_chord.min(by_angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_of_a_form_on_a_triangle() {
        assert!((most([1.0; 3]) - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(most([4.0, 0.0, 0.0]), 1.0);
        // Against a fine grid.
        for c in [[1.0, 0.5, 0.7], [1.0, -0.5, 0.3], [2.0, 1.9, 0.2], [-1.0, -2.0, -0.5]] {
            let mut best = 0.0_f64;
            for i in 0..=400 {
                for j in 0..=400 - i {
                    let (a, b) = (f64::from(i) / 400.0, f64::from(j) / 400.0);
                    let d = 1.0 - a - b;
                    best = best.max(c[0] * b * d + c[1] * d * a + c[2] * a * b);
                }
            }
            assert!((most(c) - best).abs() < 1e-4, "{c:?}: {} {best}", most(c));
        }
    }
}
