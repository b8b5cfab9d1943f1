//! The line in which two patches meet as a curve: cubics within a quarter of the tolerance, a straight one as a line.

use glam::{DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::tolerance::NUDGE;
use crate::geometry::Nurbs;
use crate::surface::intersect::march::Branch;
use crate::surface::intersect::pair::{Pair, Spot};
use crate::surface::trims::project::{self, cubics};

/// Share of the tolerance that a cubic may be off.
pub(super) const SHARE: f64 = 0.25;
/// Places nearer to each other than so many tolerances are one: a march may end just beyond one.
const SHORTEST: f64 = 4.0;

impl Pair<'_> {
    /// Cubics over the places of a branch, one parameter from each to the next.
    ///
    /// Between two places the curve is run over by the planes across their chord, so every point of it is found on both
    /// surfaces by Newton's method.
    pub fn fitted(&self, branch: &Branch, lost: &dyn Fn(DVec3) -> Fault) -> Result<Vec<Nurbs>> {
        let spots = distinct(&branch.spots, SHORTEST * self.point);
        if spots.len() < 2 {
            return Ok(Vec::new());
        }
        let stops: Vec<f64> = (0..spots.len()).map(|k| k as f64).collect();
        let land = |f: f64, _: Option<DVec2>, before: bool| {
            let k = if before { f.ceil() as usize } else { f.floor() as usize + 1 }.clamp(1, spots.len() - 1);
            self.between(&spots[k - 1], &spots[k], f - (k - 1) as f64).ok_or_else(|| lost(spots[k].p))
        };
        cubics(&stops, SHARE * self.point, land, lost)
    }

    /// The common place a share of the way from one to the next.
    fn between(&self, from: &Spot, to: &Spot, share: f64) -> Option<project::Landing> {
        let chord = to.p - from.p;
        let length = chord.length();
        let across = chord / length;
        let spot = if share <= 0.0 {
            *from
        } else if share >= 1.0 {
            *to
        } else {
            let (a, b) = (from.a.lerp(to.a, share), from.b.lerp(to.b, share));
            self.correct(a, b, Some((from.p + chord * share, across)))?
        };
        // Where they touch on the way, the direction is that of the neighbours.
        let straight = from.way.lerp(to.way, share).normalize_or_zero();
        let way = if spot.sine <= NUDGE.sqrt() { straight } else { spot.way };
        let rise = way.dot(across);
        let d1 = if rise.abs() > 0.5 { way * (length / rise) } else { chord };
        Some(project::Landing { uv: spot.a, p: spot.p, d1 })
    }
}

/// Places in a row without those that are one with the place before; first and last stay.
fn distinct(spots: &[Spot], least: f64) -> Vec<Spot> {
    let mut out: Vec<Spot> = Vec::with_capacity(spots.len());
    for (k, spot) in spots.iter().enumerate() {
        let near = out.last().is_some_and(|last| last.p.distance(spot.p) <= least);
        if near && k + 1 == spots.len() && out.len() > 1 {
            out.pop();
        }
        if !near || k + 1 == spots.len() {
            out.push(*spot);
        }
    }
    out
}
