//! Bounds of a chain's derivatives by its fraction.

use glam::DVec3;

use super::chain::Chain;
use crate::base::range::Interval3;
use crate::base::tolerance::SLIVER;
use crate::geometry::Enclosure;
use crate::geometry::enclosure;

/// Derivatives of a chain with respect to its fraction over an interval.
#[derive(Clone, Copy, Debug)]
pub struct ChainEnclosure {
    /// First derivative, model units.
    pub d1: Interval3,
    /// Second derivative, model units; unbounded at a cusp.
    pub d2: Interval3,
    /// Sum of the jumps of the first derivative inside, coordinate by coordinate.
    pub jumps: DVec3,
}

/// Bounds between two fractions, `f0 < f1`.
pub fn of_chain(chain: &Chain, f0: f64, f1: f64) -> ChainEnclosure {
    let joints = chain.joints();
    let length = chain.length();
    let mut whole: Option<Enclosure> = None;
    for (k, run) in chain.runs().iter().enumerate() {
        let (a, b) = (f0.max(joints[k]), f1.min(joints[k + 1]));
        // What is there of a run by rounding alone says nothing beside the rest.
        if b - a <= SLIVER && f1 - f0 > 2.0 * SLIVER || b <= a {
            continue;
        }
        let at = |f: f64| run.s0 + (run.s1 - run.s0) * ((f - joints[k]) / (joints[k + 1] - joints[k])).clamp(0.0, 1.0);
        let (low, high) = (at(a).min(at(b)), at(a).max(at(b)));
        let turn = run.curve.length();
        // A run past the start of a closed curve is on it twice.
        let parts = [(low.min(turn), high.min(turn)), (low.max(turn) - turn, high.max(turn) - turn)];
        let mut own: Option<Enclosure> = None;
        for (s0, s1) in parts {
            if s1 - s0 <= SLIVER * turn && (high - low > 2.0 * SLIVER * turn || own.is_some() || s1 <= s0) {
                continue;
            }
            let found = enclosure(&run.curve, run.curve.param_at_length(s0), run.curve.param_at_length(s1));
            own = Some(match own {
                Some(before) => {
                    let seam = run.curve.jet(run.curve.domain().0).d1.normalize_or_zero()
                        - run.curve.jet_before(run.curve.domain().1).d1.normalize_or_zero();
                    Enclosure { jumps: before.jumps + seam.abs(), ..before }.union(&found)
                }
                None => found,
            });
        }
        let Some(own) = own else { continue };
        let own = if run.is_backward() { own.reversed() } else { own };
        whole = Some(match whole {
            Some(before) => {
                let jump = (chain.jet(joints[k]).d1 - chain.jet_before(joints[k]).d1) / length;
                Enclosure { jumps: before.jumps + jump.abs(), ..before }.union(&own)
            }
            None => own,
        });
    }
    let found = whole.unwrap_or(Enclosure { tangent: Interval3::around_zero(DVec3::ONE), bend: Interval3::ANY, jumps: DVec3::ZERO });
    ChainEnclosure { d1: found.tangent * length, d2: found.bend * (length * length), jumps: found.jumps * length }
}
