//! The line in which two patches meet as a curve: cubics within a quarter of the tolerance, a straight one as a line.
//!
//! No cubics go through two places in a row of a march where it took a step too long: past a tip, or over to another line near by. Then the
//! march is repeated with shorter steps there.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::NUDGE;
use crate::geometry::Nurbs;
use crate::surface::intersect::march::{Narrow, Strides};
use crate::surface::intersect::pair::{Pair, Spot};
use crate::surface::trims::project::{self, cubics};

/// Share of the tolerance that a cubic may be off.
pub(super) const SHARE: f64 = 0.25;
/// Places nearer to each other than so many tolerances are one: a march may end just beyond one.
const SHORTEST: f64 = 4.0;
/// How often a march is repeated, and how much shorter its steps are where it failed the time before.
const ROUNDS: usize = 8;
const SHORTER: f64 = 0.25;

/// A line in which two patches meet.
#[derive(Clone, Debug)]
pub(crate) struct Branch {
    /// Places in a row.
    pub spots: Vec<Spot>,
    /// The curve through them; none where it is as short as a place.
    pub cubics: Vec<Nurbs>,
}

impl Pair<'_> {
    /// The whole line through a place; the place where it was lost when it was. `size`: of the smaller patch.
    pub fn line_through(&self, start: Spot, size: f64) -> Result<Branch, DVec3> {
        let mut strides = Strides::default();
        for _ in 0..ROUNDS {
            job::poll();
            let spots = self.march(start, size, &strides)?;
            match self.fitted(&spots) {
                Ok(cubics) => return Ok(Branch { spots, cubics }),
                Err(failed) => {
                    let steps = failed.iter().map(|(from, to)| Narrow::between(*from, *to, SHORTER));
                    strides.narrow.extend(steps);
                    let at = failed[0].0;
                    if strides.narrow.iter().any(|narrow| narrow.step <= self.point) {
                        return Err(at);
                    }
                }
            }
        }
        Err(start.p)
    }

    /// Cubics over the places of a line, one parameter from each to the next; the neighbours between which there are none.
    ///
    /// Between two places the curve is run over by the planes across their chord, so every point of it is found on both
    /// surfaces by Newton's method.
    fn fitted(&self, spots: &[Spot]) -> Result<Vec<Nurbs>, Vec<(DVec3, DVec3)>> {
        let spots = distinct(spots, SHORTEST * self.point);
        let (mut pieces, mut failed) = (Vec::new(), Vec::new());
        for (k, w) in spots.windows(2).enumerate() {
            let start = k as f64;
            let land = |f: f64, _: Option<DVec2>, _: bool| self.between(&w[0], &w[1], f - start).ok_or(());
            match cubics(&[start, start + 1.0], SHARE * self.point, land, |_| ()) {
                Ok(some) => pieces.extend(some),
                Err(()) => failed.push((w[0].p, w[1].p)),
            }
        }
        if failed.is_empty() { Ok(pieces) } else { Err(failed) }
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
