//! The foot of a point near a guess: Gauss–Newton steps, halved until the distance falls.

use glam::{DVec2, DVec3};

use super::Jet2;
use crate::base::tolerance::EPSILON;

/// Steps before the nearest place found so far is taken.
const STEPS: usize = 24;
/// Halvings of a step.
const HALVINGS: usize = 6;

/// The step in the parameters whose image under two tangents is a vector's tangential part, to first order; `None` where
/// the tangents run together.
pub fn step(du: DVec3, dv: DVec3, d: DVec3) -> Option<DVec2> {
    let (e, f, g) = (du.length_squared(), du.dot(dv), dv.length_squared());
    let (a, b) = (du.dot(d), dv.dot(d));
    let det = e * g - f * f;
    let found = DVec2::new((g * a - f * b) / det, (e * b - f * a) / det);
    found.is_finite().then_some(found)
}

/// Where a foot is looked for: a surface held in a part of its parameters.
pub(super) trait Footing {
    /// Point and derivatives.
    fn jet(&self, uv: DVec2) -> Jet2;
    /// The nearest place that is allowed.
    fn hold(&self, uv: DVec2) -> DVec2;
    /// The step in (u, v) whose image is nearest to `d`.
    fn step(&self, jet: &Jet2, _uv: DVec2, d: DVec3) -> Option<DVec2> {
        step(jet.du, jet.dv, d)
    }

    /// The foot of a point near a guess, with its distance.
    fn foot(&self, p: DVec3, guess: DVec2) -> (DVec2, f64) {
        let mut uv = self.hold(guess);
        let mut jet = self.jet(uv);
        let mut best = jet.p.distance_squared(p);
        for _ in 0..STEPS {
            let Some(full) = self.step(&jet, uv, p - jet.p) else { break };
            let mut share = 1.0;
            let mut better = None;
            for _ in 0..HALVINGS {
                let next = self.hold(uv + full * share);
                let there = self.jet(next);
                let distance = there.p.distance_squared(p);
                if distance < best {
                    better = Some((next, there, distance));
                    break;
                }
                share *= 0.5;
            }
            let Some((next, there, distance)) = better else { break };
            let still = (next - uv).length() <= EPSILON;
            (uv, jet, best) = (next, there, distance);
            if still {
                break;
            }
        }
        (uv, best.sqrt())
    }
}
