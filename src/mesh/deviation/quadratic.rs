//! The most that a quadratic function can be over a triangle, by barycentric λ, and the bounds that follow from second derivatives.

use glam::DVec2;

use crate::surface::core::power_form::Bends;

/// Second derivatives over the box of a triangle, `width` wide, along its sides in the order of the corners opposite: in the
/// middle, and how far they may be from there.
fn forms(Bends { mid, slack, .. }: &Bends, uv: [DVec2; 3], width: DVec2) -> [(f64, f64); 3] {
    // 2 |x y| ≤ a x² + y² / a, with a that makes both alike over the box.
    let a = if width.x > 0.0 && width.y > 0.0 { width.y / width.x } else { 1.0 };
    let (ru, rv) = (slack[0] + slack[1] * a, slack[2] + slack[1] / a);
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let e = uv[j] - uv[i];
        let m = mid[0] * e.x * e.x + 2.0 * mid[1] * e.x * e.y + mid[2] * e.y * e.y;
        (m, ru * e.x * e.x + rv * e.y * e.y)
    })
}

/// The bound of a triangle by second derivatives over its box, `width` wide.
pub fn over_sides(bends: &Bends, uv: [DVec2; 3], width: DVec2) -> f64 {
    let forms = forms(bends, uv, width);
    bends.jump + 0.5 * most(forms.map(|(m, r)| m + r)).max(most(forms.map(|(m, r)| r - m)))
}

/// The same where the corners are so far above the plane.
pub(super) fn over_corners(above: [f64; 3], bends: &Bends, uv: [DVec2; 3], width: DVec2) -> f64 {
    let forms = forms(bends, uv, width);
    let up = highest(above, forms.map(|(m, r)| 0.5 * (r - m)));
    bends.jump + up.max(highest(above.map(|f| -f), forms.map(|(m, r)| 0.5 * (r + m))))
}

/// The most that Σ a λi + Σ c λi λj can be for barycentric λ, `c` in the order of the sides opposite the corners.
fn highest(a: [f64; 3], c: [f64; 3]) -> f64 {
    let mut highest = a[0].max(a[1]).max(a[2]);
    for k in 0..3 {
        let (from, to, bend) = (a[(k + 1) % 3], a[(k + 2) % 3], c[k]);
        let t = 0.5 + 0.5 * (to - from) / bend;
        if bend > 0.0 && t > 0.0 && t < 1.0 {
            highest = highest.max(from + t * t * bend);
        }
    }
    // Inside, by λ1 and λ2.
    let (p, q, r) = (c[2], c[1], c[2] + c[1] - c[0]);
    let (x, y) = (a[1] - a[0] + p, a[2] - a[0] + q);
    let det = 4.0 * p * q - r * r;
    let (l1, l2) = ((2.0 * q * x - r * y) / det, (2.0 * p * y - r * x) / det);
    if p > 0.0 && det > 0.0 && l1 > 0.0 && l2 > 0.0 && l1 + l2 < 1.0 {
        highest = highest.max(a[0] + 0.5 * (x * l1 + y * l2));
    }
    highest
}

/// The most that Σ c λi λj can be for barycentric λ, `c` in the order of the sides opposite the corners.
fn most(c: [f64; 3]) -> f64 {
    let on_side = c.iter().fold(0.0_f64, |m, c| m.max(0.25 * c));
    stationary(c).map_or(on_side, |(value, _)| on_side.max(value))
}

/// The value of Σ c λi λj where it is stationary, and the barycentric λ of that place; `None` where that is outside of the triangle.
pub fn stationary(c: [f64; 3]) -> Option<(f64, [f64; 3])> {
    // The three derivatives are equal: λ ∝ c_a (c_b + c_c − c_a).
    let weight = |k: usize| c[k] * (c[(k + 1) % 3] + c[(k + 2) % 3] - c[k]);
    let w = [weight(0), weight(1), weight(2)];
    let sum: f64 = w.iter().sum();
    let l = w.map(|x| x / sum);
    l.iter().all(|x| *x > 0.0).then(|| (c[0] * l[1] * l[2] + c[1] * l[2] * l[0] + c[2] * l[0] * l[1], l))
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

    #[test]
    fn the_most_of_a_form_with_heights_on_a_triangle() {
        let all = [[1.0, 0.5, 0.7], [1.0, -0.5, 0.3], [2.0, 1.9, 0.2], [-1.0, -2.0, -0.5], [0.0; 3], [4.0, 3.0, 5.0]];
        for (a, c) in all.iter().flat_map(|a| all.iter().map(move |c| (*a, *c))) {
            let mut best = f64::NEG_INFINITY;
            for i in 0..=400 {
                for j in 0..=400 - i {
                    let l = [f64::from(i) / 400.0, f64::from(j) / 400.0, 1.0 - f64::from(i + j) / 400.0];
                    let bends = c[0] * l[1] * l[2] + c[1] * l[2] * l[0] + c[2] * l[0] * l[1];
                    best = best.max(a[0] * l[0] + a[1] * l[1] + a[2] * l[2] + bends);
                }
            }
            let found = highest(a, c);
            assert!(found >= best - 1e-12 && found < best + 1e-4, "{a:?} {c:?}: {found} {best}");
            if a == [0.0; 3] {
                assert!((found - most(c).max(0.0)).abs() < 1e-12);
            }
        }
    }
}
