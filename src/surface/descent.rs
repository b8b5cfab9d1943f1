//! Local minima of a function of a surface's point, inside the unit square: Newton's method held in a trust region.

use super::Jet2;
use crate::base::tolerance::{EPSILON, LEAST_CURVATURE};

/// Value, gradient (x, y) and second derivatives (xx, xy, yy) of a function of the surface at one place.
pub struct Local {
    /// Value.
    pub value: f64,
    /// ∂x, ∂y.
    pub gradient: [f64; 2],
    /// ∂xx, ∂xy, ∂yy.
    pub hessian: [f64; 3],
}

/// Where a descent ended.
#[derive(Clone, Copy, Debug)]
pub struct Minimum {
    /// Place in the unit square.
    pub place: (f64, f64),
}

/// Steps of one descent.
const STEPS: usize = 60;

/// Goes down from a place to a local minimum of `f` of the `jet` of each place in the square; never up. Variables at a border
/// leave it only inwards.
///
/// Each step solves the shifted Newton equations; the shift grows until the value falls and shrinks when it falls as
/// foreseen (Levenberg's rule), so the method is Newton's near a minimum.
pub fn descend(jet: &impl Fn(f64, f64) -> Jet2, start: (f64, f64), f: impl Fn(&Jet2) -> Local) -> Minimum {
    let at = |(x, y): (f64, f64)| f(&jet(x, y));
    let (mut place, mut here) = (start, at(start));
    let mut shift = 0.0;
    for _ in 0..STEPS {
        let free = [open(place.0, here.gradient[0]), open(place.1, here.gradient[1])];
        if !free[0] && !free[1] {
            break;
        }
        let [dx, dy] = step(&here, free, shift);
        let next = ((place.0 + dx).clamp(0.0, 1.0), (place.1 + dy).clamp(0.0, 1.0));
        let moved = (next.0 - place.0).abs().max((next.1 - place.1).abs());
        if moved <= EPSILON {
            break;
        }
        let there = at(next);
        let scale = here.hessian[0].abs().max(here.hessian[2].abs()).max(f64::MIN_POSITIVE);
        if there.value < here.value {
            (place, here) = (next, there);
            shift *= 0.1;
            if shift < EPSILON * scale {
                shift = 0.0;
            }
        } else {
            const FIRST_SHIFT: f64 = 0.01;
            shift = if shift == 0.0 { FIRST_SHIFT * scale } else { 10.0 * shift };
            if shift > scale / EPSILON {
                break;
            }
        }
    }
    Minimum { place }
}

/// Whether a variable may move: not at a border it is pushed against.
fn open(x: f64, slope: f64) -> bool {
    !(x <= 0.0 && slope >= 0.0 || x >= 1.0 && slope <= 0.0)
}

/// The shifted Newton step in the free variables, downhill always.
fn step(here: &Local, free: [bool; 2], shift: f64) -> [f64; 2] {
    let [gx, gy] = here.gradient;
    let [mut xx, xy, mut yy] = here.hessian;
    if free[0] && free[1] {
        // Lift the smallest eigenvalue above zero: Newton's step goes down only then.
        let (mean, spread) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
        let (low, high) = (mean - spread, mean.abs() + spread);
        let lift = shift + (LEAST_CURVATURE * high - low).max(0.0) * f64::from(u8::from(low < EPSILON * high));
        (xx, yy) = (xx + lift, yy + lift);
        let det = xx * yy - xy * xy;
        if det > 0.0 {
            return [(xy * gy - yy * gx) / det, (xy * gx - xx * gy) / det];
        }
    }
    let one = |free: bool, g: f64, h: f64| {
        let h = if h > 0.0 { h + shift } else { h.abs() + shift };
        if !free || g == 0.0 {
            0.0
        } else if h > 0.0 {
            -g / h
        } else {
            -g.signum()
        }
    };
    [one(free[0], gx, xx), one(free[1], gy, yy)]
}
