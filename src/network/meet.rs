//! Where chains meet, for `&`, `meet` and for finding flows.

use glam::DVec3;

use super::chain::Chain;
use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;

/// One meeting of two chains: a node of the two, or the ends of a shared run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The point: an end or joint point where one is among the hits, else the mean.
    pub point: DVec3,
    /// Fraction on the first chain.
    pub fa: f64,
    /// Fraction on the second chain.
    pub fb: f64,
    /// They touch without crossing.
    pub tangent: bool,
    /// `Some((fa, fb))`: the other end of a run that both share from here on.
    pub shared_to: Option<(f64, f64)>,
}

/// All meetings, ordered along `a`, each node once.
pub fn meet(a: &Chain, b: &Chain, tolerance: &Tolerance) -> Result<Vec<Meeting>> {
    let _ = (a, b, tolerance);
    Ok(Vec::new())
}

/// The one meeting that `a & b` stands for; none, several or a shared run are E507, E508, E509 with candidates and the closest miss.
pub fn meet_once(a: &Chain, b: &Chain, tolerance: &Tolerance) -> Result<Meeting> {
    let _ = tolerance;
    let at = (a.start(), b.start());
    Err(crate::base::fault::NetworkFault::NoMeeting { a: (a.origin(), at.0), b: (b.origin(), at.1), tolerance: tolerance.point }.into())
}
