//! The balls along an edge, and the largest radius for which there are some.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::surface::faults::{BlendFault, NoBlend};
use crate::surface::rolling::ball::Ball;
use crate::surface::rolling::station::BallStation;

/// Halvings in search of a radius that fits.
const SMALLER: usize = 24;
/// Halvings between a radius that fits and one that does not.
const BETWEEN: usize = 32;

/// Halvings in search of one with which surfaces can be made, where the largest ball that fits makes none; each makes them.
const MADE: usize = 12;
/// Share of a radius that is stated, at the least: three digits of it, rounded down.
const STATED: f64 = 1.0 - 1.0 / 1024.0;

/// Share of a radius from which on a smaller one is searched, where its balls are found and the rounding is not.
const FROM: f64 = 0.5;

/// The balls of a radius at places along the edge; E673 with the largest radius where they do not fit: one with which `is_made`
/// says that the rounding can be made.
pub(crate) fn stations(
    ball: &Ball,
    radius: f64,
    origin: Origin,
    is_made: impl Fn(Vec<BallStation>, f64) -> bool,
) -> Result<Vec<BallStation>> {
    ball.stations(radius).map_err(|at| {
        let mut fits = radius;
        for _ in 0..SMALLER {
            fits *= 0.5;
            if ball.stations(fits).is_ok() {
                break;
            }
        }
        if ball.stations(fits).is_err() {
            return ball.fault(NoBlend::NoRadius { at });
        }
        let (mut low, mut high) = (fits, 2.0 * fits);
        for _ in 0..BETWEEN {
            let middle = 0.5 * (low + high);
            if ball.stations(middle).is_ok() { low = middle } else { high = middle }
        }
        let makes = |radius: f64| ball.stations(radius).is_ok_and(|all| is_made(all, radius));
        if !makes(low * STATED) {
            let (mut made, mut not) = (0.0, low * STATED);
            for _ in 0..MADE {
                let middle = 0.5 * (made + not);
                if makes(middle) { made = middle } else { not = middle }
            }
            low = made;
        }
        if low == 0.0 {
            return ball.fault(NoBlend::NoRadius { at });
        }
        too_large(ball, radius, low, at, origin)
    })
}

/// E673 for a radius whose balls are found and whose rounding is not, where that of a smaller one is; `at` is where it was lost.
pub(crate) fn above_made(
    ball: &Ball,
    radius: f64,
    at: DVec3,
    origin: Origin,
    is_made: impl Fn(Vec<BallStation>, f64) -> bool,
) -> Option<Fault> {
    let makes = |radius: f64| ball.stations(radius).is_ok_and(|all| is_made(all, radius));
    let (mut low, mut high) = (FROM * radius, radius);
    if !makes(low) {
        return None;
    }
    for _ in 0..MADE {
        let middle = 0.5 * (low + high);
        if makes(middle) { low = middle } else { high = middle }
    }
    Some(too_large(ball, radius, low, ball.edge.closest(at).1, origin))
}

fn too_large(ball: &Ball, radius: f64, largest: f64, at: DVec3, origin: Origin) -> Fault {
    let (a, b) = (ball.origins[0], ball.origins[1]);
    BlendFault::TooLarge { blend: origin, a, b, radius, largest, at }.into()
}
