//! Bounds of second derivatives over boxes of (u, v) that may run over a seam, and what lies on one side of kink lines.

use glam::{DVec2, DVec3};

use crate::base::tolerance::NUDGE;
use crate::surface::core::power_form::Bends;
use crate::surface::{Domain, Evaluator, Surface};

/// Second derivatives along a unit vector over any box: where the surface closes, parameters go on over the seam. `None` where they are
/// not bounded.
pub fn bends_over(evaluator: Evaluator, (low, high): (DVec2, DVec2), normal: DVec3) -> Option<Bends> {
    let closed = turning(evaluator.surface());
    if evaluator.surface().is_flat() || low.cmpge(DVec2::ZERO).all() && high.cmple(DVec2::ONE).all() {
        return evaluator.bends((low, high), normal);
    }
    let mut whole: Option<Bends> = None;
    for (x0, x1) in turns(low.x, high.x, closed.0).into_iter().flatten() {
        for (y0, y1) in turns(low.y, high.y, closed.1).into_iter().flatten() {
            let own = evaluator.bends((DVec2::new(x0, y0), DVec2::new(x1, y1)), normal)?;
            whole = Some(whole.map_or(own, |w| w.union(&own)));
        }
    }
    whole
}

/// Directions in which parameters may go on over a seam.
pub(super) fn turning(surface: &Surface) -> (bool, bool) {
    if surface.domain() == Domain::Loop { surface.closed() } else { (false, false) }
}

/// An interval in 0…1: held there, or cut at the seams of a closed direction and each part turned back.
fn turns(low: f64, high: f64, closed: bool) -> [Option<(f64, f64)>; 2] {
    if !closed {
        return [Some((low.clamp(0.0, 1.0), high.clamp(0.0, 1.0))), None];
    }
    if high - low >= 1.0 {
        return [Some((0.0, 1.0)), None];
    }
    let (low, high) = (low - low.floor(), high - low.floor());
    if high <= 1.0 { [Some((low, high)), None] } else { [Some((low, 1.0)), Some((0.0, high - 1.0))] }
}

/// The wider one of two boxes in (u, v), held on the side of each kink line on which the other lies: a triangle beside a kink
/// line sees nothing of what is beyond.
pub(super) fn beside_kinks(surface: &Surface, own: (DVec2, DVec2), (mut low, mut high): (DVec2, DVec2)) -> (DVec2, DVec2) {
    let (us, vs) = surface.kinks();
    for (axis, kinks) in [us, vs].into_iter().enumerate() {
        for kink in kinks.iter().copied() {
            if low[axis] < kink && own.0[axis] >= kink - NUDGE {
                low[axis] = kink;
            } else if high[axis] > kink && own.1[axis] <= kink + NUDGE {
                high[axis] = kink;
            }
        }
    }
    (low, high)
}

/// A place held on the side of each kink line on which `at` is, or where that is on the line, `beyond`.
pub(super) fn on_side(surface: &Surface, at: DVec2, beyond: DVec2, mut place: DVec2) -> DVec2 {
    let (us, vs) = surface.kinks();
    for (axis, kinks) in [us, vs].into_iter().enumerate() {
        for kink in kinks.iter().copied() {
            let below = if (at[axis] - kink).abs() > NUDGE { at[axis] < kink } else { beyond[axis] < kink };
            place[axis] = if below { place[axis].min(kink) } else { place[axis].max(kink) };
        }
    }
    place
}
