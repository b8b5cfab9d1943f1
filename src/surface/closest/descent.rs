//! Local minima of a function of a surface's point, inside the unit square: Newton's method held in a trust region.

use crate::base::tolerance::{EPSILON, LEAST_CURVATURE, NEAREST};
use crate::surface::data::jet::Jet2;

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

/// Goes down from a place to a local minimum of `f` of the `jet` of each place in the unit square; never up. Variables at a border
/// leave it only inwards.
pub fn descend(jet: &impl Fn(f64, f64) -> Jet2, start: (f64, f64), f: impl Fn(&Jet2) -> Local) -> Minimum {
    descend_within(jet, [(0.0, 1.0), (0.0, 1.0)], start, f)
}

/// [`descend`] in a rectangle of the square, given by the first and last value of each variable. Derivatives at its upper borders
/// are those from inside: beyond them the surface may go on round a crease.
///
/// Each step solves the shifted Newton equations; the shift grows until the value falls and shrinks when it falls as
/// foreseen [Levenberg 1944], so the method is Newton's near a minimum. Steps are weighed by the lengths that they move the
/// point by, not by parameters [Marquardt 1963]: beside a pole one of the two moves it by next to nothing.
pub fn descend_within(
    jet: &impl Fn(f64, f64) -> Jet2,
    [xs, ys]: [(f64, f64); 2],
    start: (f64, f64),
    f: impl Fn(&Jet2) -> Local,
) -> Minimum {
    let inner = |x: f64, high: f64| if high < 1.0 { x.min(high - NEAREST) } else { x };
    let at = |(x, y): (f64, f64)| Scaled::at(&jet(inner(x, xs.1), inner(y, ys.1)), &f);
    let (mut place, mut here) = (start, at(start));
    let mut shift = 0.0;
    for _ in 0..STEPS {
        let free = [open(place.0, xs, here.local.gradient[0]), open(place.1, ys, here.local.gradient[1])];
        if !free[0] && !free[1] {
            break;
        }
        let [dx, dy] = step(&here.local, free, shift);
        let next = ((place.0 + dx / here.lengths[0]).clamp(xs.0, xs.1), (place.1 + dy / here.lengths[1]).clamp(ys.0, ys.1));
        let moved = (next.0 - place.0).abs().max((next.1 - place.1).abs());
        if moved <= EPSILON {
            break;
        }
        let there = at(next);
        let scale = here.local.hessian[0].abs().max(here.local.hessian[2].abs()).max(f64::MIN_POSITIVE);
        if there.local.value < here.local.value {
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

/// A function at one place by the lengths that each variable moves the point by.
struct Scaled {
    local: Local,
    /// Length of the derivative by x and y.
    lengths: [f64; 2],
}

impl Scaled {
    fn at(jet: &Jet2, f: &impl Fn(&Jet2) -> Local) -> Self {
        let (x, y) = (jet.du.length(), jet.dv.length());
        let least = (EPSILON * x.max(y)).max(f64::MIN_POSITIVE.sqrt());
        let [x, y] = [x.max(least), y.max(least)];
        let Local { value, gradient: [gx, gy], hessian: [xx, xy, yy] } = f(jet);
        let local = Local { value, gradient: [gx / x, gy / y], hessian: [xx / (x * x), xy / (x * y), yy / (y * y)] };
        Self { local, lengths: [x, y] }
    }
}

/// Whether a variable may move: not at a border it is pushed against.
fn open(x: f64, (low, high): (f64, f64), slope: f64) -> bool {
    !(x <= low && slope >= 0.0 || x >= high && slope <= 0.0)
}

/// The shifted Newton step in the free variables, downhill always.
fn step(here: &Local, free: [bool; 2], shift: f64) -> [f64; 2] {
    let [gx, gy] = here.gradient;
    let [xx, xy, yy] = here.hessian;
    if free[0] && free[1] {
        // Along each principal direction of the curvature by its size: where it is negative, Newton's step would climb.
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let half_apart = (half * half + xy * xy).sqrt();
        // The direction of the larger eigenvalue, from whichever of its two forms does not cancel.
        let (a, b) = if half >= 0.0 { (half + half_apart, xy) } else { (xy, half_apart - half) };
        let norm = (a * a + b * b).sqrt();
        let (a, b) = if norm > 0.0 { (a / norm, b / norm) } else { (1.0, 0.0) };
        let (high, low) = ((mean + half_apart).abs(), (mean - half_apart).abs());
        let least = LEAST_CURVATURE * high.max(low);
        let along = (a * gx + b * gy) / (high.max(least) + shift);
        let across = (a * gy - b * gx) / (low.max(least) + shift);
        if along.is_finite() && across.is_finite() {
            return [b * across - a * along, -b * along - a * across];
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
