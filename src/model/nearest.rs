//! The place of a curve under its arc length that is nearest to a point, found without missing a nearer one.

use glam::DVec3;

use crate::base::tolerance::{EPSILON, NEAREST_PLACE};

/// Stretches that the search begins with.
const STRETCHES: u32 = 64;
/// Projections on the tangent from one place.
const ROUNDS: u32 = 20;

/// Arc length and distance of the place between two arc lengths that is nearest to a point: no other one is nearer by more than
/// [`NEAREST_PLACE`] of the distance, and it is one itself, so the distance is never below the true one.
///
/// `jet` gives point and unit tangent. No way along a curve is shorter than the chord, so a place between two others is no
/// nearer than half of what their distances are more than the way between them: what may hold a nearer one is halved.
pub fn nearest(jet: impl Fn(f64) -> (DVec3, DVec3), (from, to): (f64, f64), p: DVec3) -> (f64, f64) {
    let at = |s: f64| (s, jet(s).0.distance(p));
    let projected = |start: (f64, f64)| down(&jet, p, start.0, (from, to));
    let places: Vec<(f64, f64)> = (0..=STRETCHES).map(|k| from + (to - from) * f64::from(k) / f64::from(STRETCHES)).map(at).collect();
    let mut best = places.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1)).map_or((from, f64::INFINITY), projected);
    let mut open: Vec<((f64, f64), (f64, f64))> = places.windows(2).map(|w| (w[0], w[1])).collect();
    while let Some((a, b)) = open.pop() {
        let way = b.0 - a.0;
        if 0.5 * (a.1 + b.1 - way) >= best.1 * (1.0 - NEAREST_PLACE) || way <= EPSILON * (to - from) {
            continue;
        }
        let middle = at(0.5 * (a.0 + b.0));
        if middle.1 < best.1 {
            best = projected(middle);
        }
        open.extend([(a, middle), (middle, b)]);
    }
    best
}

/// Arc length and distance of a place nearer to a point than a given one, by projection on the tangent as long as that helps.
pub fn down(jet: &impl Fn(f64) -> (DVec3, DVec3), p: DVec3, start: f64, (from, to): (f64, f64)) -> (f64, f64) {
    let (mut best, mut s) = ((start, f64::INFINITY), start);
    for _ in 0..ROUNDS {
        let (point, tangent) = jet(s);
        let distance = point.distance(p);
        if distance >= best.1 {
            break;
        }
        best = (s, distance);
        s = (s + (p - point).dot(tangent)).clamp(from, to);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;

    #[test]
    fn the_nearest_place_of_a_long_winding_curve_is_found() {
        // Eighty turns of a helix; the samples that the search begins with fall on every turn but one or two.
        let (radius, rise) = (1.0, 0.1 / std::f64::consts::TAU);
        let scale = (radius * radius + rise * rise).sqrt();
        let jet = |s: f64| {
            let (sin, cos) = math::sin_cos(s / scale);
            (DVec3::new(radius * cos, radius * sin, rise * s / scale), DVec3::new(-radius * sin, radius * cos, rise) / scale)
        };
        let length = 80.0 * std::f64::consts::TAU * scale;
        for k in 0..200 {
            let s = length * (f64::from(k) + 0.37) / 200.0;
            let (p, normal) = (jet(s).0, DVec3::new(math::cos(s / scale), math::sin(s / scale), 0.0));
            assert!(nearest(jet, (0.0, length), p).1 <= 1e-9, "{s}");
            let off = nearest(jet, (0.0, length), p + 0.02 * normal);
            assert!((off.1 - 0.02).abs() <= 2e-5 && (off.0 - s).abs() <= 1e-3, "{s} {off:?}");
        }
        assert_eq!(nearest(jet, (0.0, length), DVec3::new(1.0, 0.0, -3.0)).0, 0.0);
        // Outside what is asked for nothing counts.
        let there = nearest(jet, (10.0, 20.0), jet(15.0 + std::f64::consts::TAU * scale * 20.0).0);
        assert!((10.0..=20.0).contains(&there.0) && there.1 > 1.0, "{there:?}");
    }
}
