//! The balls along an edge, and the largest radius for which there are some.

use super::ball::Ball;
use super::station::Station;
use crate::base::fault::{BlendFault, Fault, NoBlend, Result};
use crate::base::origin::Origin;

/// Halvings in search of a radius that fits.
const SMALLER: usize = 24;
/// Halvings between a radius that fits and one that does not.
const BETWEEN: usize = 32;

/// The balls of a radius at places along the edge; E673 with the largest radius where they do not fit.
pub(super) fn stations(ball: &Ball, radius: f64, origin: Origin) -> Result<Vec<Station>> {
    let found = ball.stations(radius).map(|mut all| {
        if !ball.closed {
            ball.run_out(radius, &mut all);
        }
        all
    });
    found.map_err(|at| {
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
        let (a, b) = (ball.origins[0], ball.origins[1]);
        Fault::from(BlendFault::TooLarge { blend: origin, a, b, radius, largest: low, at })
    })
}
