//! The point of a surface nearest to a point, from a good first guess.

use glam::DVec3;

use crate::base::tolerance::EPSILON;
use crate::surface::{Domain, Surface};

/// Steps before the nearest place found so far is taken.
const STEPS: usize = 12;

/// Distance of a point from a surface near (u, v), with the place of the foot: Gauss–Newton with second derivatives where
/// they help, steps halved until the distance falls, held inside the ranges of u and v.
pub fn nearest(surface: &Surface, p: DVec3, guess: (f64, f64), u: (f64, f64), v: (f64, f64)) -> (f64, (f64, f64)) {
    let triangle = surface.domain() == Domain::Triangle;
    let hold = |(x, y): (f64, f64)| {
        let (x, y) = (x.clamp(u.0, u.1), y.clamp(v.0, v.1));
        let over = x + y - 1.0;
        if triangle && over > 0.0 { ((x - 0.5 * over).clamp(0.0, 1.0), (y - 0.5 * over).clamp(0.0, 1.0)) } else { (x, y) }
    };
    let mut at = hold(guess);
    let mut jet = surface.jet(at.0, at.1);
    let mut best = jet.p.distance_squared(p);
    for _ in 0..STEPS {
        let r = jet.p - p;
        let (gu, gv) = (r.dot(jet.du), r.dot(jet.dv));
        let (a, b, c) = (jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.dv.dot(jet.dv));
        let (ha, hb, hc) = (a + r.dot(jet.duu), b + r.dot(jet.duv), c + r.dot(jet.dvv));
        // The full second derivative where it is positive, else the part that always is.
        let (a, b, c) = if ha > 0.0 && ha * hc - hb * hb > 0.5 * (a * c - b * b).max(0.0) { (ha, hb, hc) } else { (a, b, c) };
        let det = a * c - b * b;
        let (du, dv) = if det > EPSILON * a * c {
            ((b * gv - c * gu) / det, (b * gu - a * gv) / det)
        } else {
            (if a > 0.0 { -gu / a } else { 0.0 }, if c > 0.0 { -gv / c } else { 0.0 })
        };
        let mut share = 1.0;
        let mut moved = false;
        for _ in 0..STEPS {
            let next = hold((at.0 + share * du, at.1 + share * dv));
            let there = surface.jet(next.0, next.1);
            let distance = there.p.distance_squared(p);
            if distance < best {
                moved = best - distance > EPSILON * best;
                (at, jet, best) = (next, there, distance);
                break;
            }
            share *= 0.5;
        }
        if !moved {
            break;
        }
    }
    (best.sqrt(), at)
}
