//! `trim`: the part of a surface inside an outer loop and outside holes.

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::closest::nearest::closest;
use crate::surface::core::plane;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::faults::{BorderFault, LoopFault, LoopRole};
use crate::surface::rails::boundary;
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::trims::loops::{LoopRing, crossing, nested, touches};
use crate::surface::trims::noncontractible::{Keep, noncontractible};
use crate::surface::trims::trim_loop::{TrimLoop, around, assembled, natural, shifts};

/// The part of a surface inside `outer` (the whole of it when empty) and outside `holes`, each given by the curves of a loop
/// in any order and direction. Where a surface closes loops may run over seams and round poles. Holes that the surface has
/// already stay where they lie inside `outer`.
///
/// Loops may touch each other in one point. Fails with E502 when a loop does not close, E611 when it crosses itself, E612 when a
/// hole is not inside the outer loop or a loop goes round the surface and bounds nothing alone, E613 when a loop leaves the
/// surface, E661 when holes meet, E662 when one lies in another one, E663 when a curve is given twice.
pub fn trim(base: &Surface, outer: &[Chain], holes: &[Vec<Chain>], origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let mut base = plane::unmapped(base, tolerance)?;
    let unbounded = base.domain() == Domain::Unbounded;
    if unbounded {
        // As much of it as the loops need, with the frame that planes have.
        base = plane::over(&base, outer.iter().chain(holes.iter().flatten()).map(Chain::bbox).fold(Box3::EMPTY, Box3::union));
    }
    let (mut trim_loops, mut rings) = (Vec::new(), Vec::new());
    if !outer.is_empty() {
        let trim_loop = around(&base, outer, LoopRole::Outer, tolerance)?;
        if trim_loop.winds(&base) {
            base = noncontractible(&base, outer, Keep::Inside, origin, tolerance)?.ok_or_else(|| goes_round(&base, outer, origin))?;
        } else {
            let ring = LoopRing::of_chains(outer, None, origin);
            let kept = if unbounded { Vec::new() } else { kept_holes(&base, &ring, &trim_loop, origin, tolerance)? };
            (trim_loops, rings) = (vec![trim_loop], vec![ring]);
            for (ring, trim_loop) in kept {
                rings.push(ring);
                trim_loops.push(trim_loop);
            }
        }
    }
    if trim_loops.is_empty() {
        trim_loops = natural(&base, tolerance)?;
        if !holes.is_empty() {
            rings =
                trim_loops.iter().enumerate().map(|(k, w)| LoopRing::of_trim_loop(&base, w, k == 0, tolerance)).collect::<Result<_>>()?;
        }
    }
    if holes.is_empty() {
        return assembled(&base, trim_loops, origin);
    }
    Holes { base: &base, origin, tolerance }.cut(trim_loops, rings, holes)
}

/// A plane face that knows no loops in (u, v) as one that does; any other surface as it is.
///
/// Fails as [`trim`] does where its border is no loop.
pub fn with_loops(surface: &Surface, tolerance: &Tolerance) -> Result<Surface> {
    let bare = surface.domain() == Domain::Loop && surface.parts().trim.is_none();
    if bare { trim(surface, &[], &[], surface.origin(), tolerance) } else { Ok(surface.clone()) }
}

/// A bounded plane over its own frame, where the map of a triangle would fold at a corner, with its loops in (u, v); any other surface
/// as [`with_loops`] has it, and failing as that does.
pub fn over_frame(surface: &Surface, tolerance: &Tolerance) -> Result<Surface> {
    if surface.is_flat() {
        return with_loops(surface, tolerance);
    }
    with_loops(&plane::unmapped(surface, tolerance)?, tolerance)
}

fn goes_round(base: &Surface, chains: &[Chain], trimming: Origin) -> Fault {
    let of = chains.first().map_or(trimming, Chain::origin);
    let at = chains.first().map_or(DVec3::ZERO, Chain::start);
    BorderFault::LoopGoesRound { of, surface: base.origin(), trimming, at }.into()
}

/// Holes that are cut into a surface.
struct Holes<'a> {
    base: &'a Surface,
    origin: Origin,
    tolerance: &'a Tolerance,
}

impl Holes<'_> {
    /// The face with these loops, the outer one first, without what the holes bound.
    fn cut(&self, mut trim_loops: Vec<TrimLoop>, mut rings: Vec<LoopRing>, holes: &[Vec<Chain>]) -> Result<Surface> {
        let (base, origin, tolerance) = (self.base, self.origin, self.tolerance);
        let new = rings.len();
        let mut cutting = Vec::with_capacity(holes.len());
        for (k, chains) in holes.iter().enumerate() {
            cutting.push(around(base, chains, LoopRole::Hole(k), tolerance).map_err(|fault| together(fault, holes, tolerance))?);
            rings.push(LoopRing::of_chains(chains, Some(k), origin));
        }
        let touches = touches(&rings, new, tolerance)?;
        if let Some(((a, b), touch)) = touches.iter().find(|(_, touch)| touch.is_crossing()) {
            return Err(crossing((&rings[*a], &rings[*b]), touch, origin, tolerance).into());
        }
        let touched = |a: usize, b: usize| touches.get(&(a.min(b), a.max(b))).and_then(|t| t.places.first().copied());
        // Numbers of the loops that lie in (u, v) as they are, and of those that divide a closed surface.
        let (mut plain, mut apart): (Vec<usize>, Vec<usize>) = ((1..new).collect(), Vec::new());
        let outline = trim_loops.first().map(TrimLoop::copied);
        for (k, trim_loop) in cutting.into_iter().enumerate() {
            let ring = &rings[new + k];
            let (place, at) = trim_loop.place_off(base, touched(0, new + k));
            let moved = match trim_loops.first() {
                _ if trim_loop.winds(base) => None,
                Some(outer) if shifts(base).len() > 1 => self.moved_inside(outer, &rings[0], ring, &trim_loop, place)?,
                Some(outer) => outer.holds_moved(base, place),
                None => Some(DVec2::ZERO),
            };
            if let Some(by) = moved {
                trim_loops.push(trim_loop.shifted(by));
                plain.push(new + k);
            } else if shifts(base).len() > 1 && outline.as_ref().is_some_and(|outline| trim_loop.lies_within(base, outline)) {
                apart.push(k);
            } else {
                return Err(LoopFault::Outside { hole: ring.of, outer: rings[0].of, trimming: origin, at }.into());
            }
        }
        let numbered: Vec<(usize, &TrimLoop)> = plain.iter().copied().zip(trim_loops.iter().skip(1)).collect();
        let found = nested(base, &numbered, touched);
        let nested = |(inner, around, at): (usize, usize, DVec3)| -> Fault {
            LoopFault::Nested { inner: rings[inner].of, around: rings[around].of, trimming: origin, at }.into()
        };
        if let Some(found) = found {
            return Err(nested(found));
        }
        let whole = assembled(base, trim_loops.iter().take(1).map(TrimLoop::copied).collect(), origin)?;
        for k in &apart {
            let within = noncontractible(&whole, &holes[*k], Keep::Inside, origin, tolerance)?
                .ok_or_else(|| goes_round(base, &holes[*k], origin))?;
            for other in (1..rings.len()).filter(|r| *r != new + *k) {
                let at = place_of(&rings[other], touched(other, new + *k));
                let foot = closest(&within.untrimmed(), at).uv;
                if within.holds(foot.0, foot.1) {
                    return Err(nested((other, new + *k, at)));
                }
            }
        }
        let mut made = assembled(base, trim_loops, origin)?;
        for k in apart {
            made =
                noncontractible(&made, &holes[k], Keep::Outside, origin, tolerance)?.ok_or_else(|| goes_round(base, &holes[k], origin))?;
        }
        Ok(made)
    }

    /// How far a loop on a closed surface must be moved in (u, v) to lie inside the outer one, if it does without crossing a seam.
    fn moved_inside(
        &self,
        outer: &TrimLoop,
        border: &LoopRing,
        ring: &LoopRing,
        trim_loop: &TrimLoop,
        place: DVec2,
    ) -> Result<Option<DVec2>> {
        if ring.crosses_seam(border, self.tolerance)? {
            return Ok(None);
        }
        let offsets = [DVec2::ZERO, DVec2::splat(NUDGE), DVec2::splat(-NUDGE), DVec2::new(NUDGE, -NUDGE), DVec2::new(-NUDGE, NUDGE)];
        let all = |by: &DVec2| {
            let inside = |p: DVec2| offsets.iter().any(|off| outer.goes_round(self.base, p + *by + *off));
            inside(place) && trim_loop.trim_curves.iter().flat_map(TrimCurve::places).all(inside)
        };
        Ok(outer.copies(self.base, place).into_iter().map(|at| at - place).find(all))
    }
}

/// A point of a loop, far from one at which it touches another.
fn place_of(ring: &LoopRing, touched: Option<DVec3>) -> DVec3 {
    let ends = ring.chains.iter().flat_map(|c| [c.start(), c.point(0.5)]);
    let far = |p: &DVec3| touched.map_or(0.0, |t| t.distance_squared(*p));
    ends.max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(DVec3::ZERO)
}

/// E502 of a hole that is one open curve, with the other ones that it closes with.
fn together(fault: Fault, holes: &[Vec<Chain>], tolerance: &Tolerance) -> Fault {
    let Some(LoopFault::Open { of, ends, closes, role, .. }) = fault.of() else { return fault };
    let open: Vec<Chain> = holes.iter().filter(|h| h.len() == 1 && !h[0].is_closed(tolerance)).map(|h| h[0].clone()).collect();
    if open.len() < 2 || boundary::walked(&open, LoopRole::Plane, tolerance).is_err() {
        return fault;
    }
    let together = open.iter().map(Chain::origin).collect();
    LoopFault::Open { of: *of, ends: *ends, closes: *closes, role: *role, together, tolerance: tolerance.point }.into()
}

/// Where an outer loop lies on a surface that has loops already: E613 where it leaves it, else the holes that lie inside it.
fn kept_holes(
    base: &Surface,
    ring: &LoopRing,
    trim_loop: &TrimLoop,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<Vec<(LoopRing, TrimLoop)>> {
    if base.parts().trim.is_none() && base.domain() != Domain::Loop {
        return Ok(Vec::new());
    }
    let own = natural(base, tolerance)?;
    let mut rings = vec![LoopRing::of_chains(&ring.chains, None, origin)];
    for (k, trim_loop) in own.iter().enumerate() {
        rings.push(LoopRing::of_trim_loop(base, trim_loop, k == 0, tolerance)?);
    }
    // The outer loop is the new one: it comes last.
    rings.rotate_left(1);
    let last = rings.len() - 1;
    let touches = touches(&rings, last, tolerance)?;
    let face = assembled(base, own.iter().map(TrimLoop::copied).collect(), base.origin())?;
    let below = face.untrimmed();
    let foot = |p: DVec3| DVec2::from(closest(&below, p).uv);
    let cuts = touches.values().flat_map(|t| &t.cuts.1).copied().collect();
    for (chain, p) in middles(&ring.chains, cuts) {
        if !face.keeps_point(p, foot(p), 2.0 * tolerance.point) {
            let (of, off) = (chain.origin(), closest(&face, p).distance);
            return Err(BorderFault::LoopOutsideSurface { of, surface: base.origin(), off, at: p, tolerance: tolerance.point }.into());
        }
    }
    let mut kept = Vec::new();
    for (k, hole) in own.into_iter().enumerate().skip(1) {
        let touch = touches.get(&(k, last));
        let crosses = touch.filter(|t| t.is_crossing());
        let off = |p: DVec3| ring.chains.iter().all(|c| c.closest(p).2 > 2.0 * tolerance.point);
        if let Some(touch) = crosses {
            let inside = |(_, p): &(&Chain, DVec3)| off(*p) && trim_loop.holds_moved(base, foot(*p)).is_some();
            if middles(&rings[k].chains, touch.cuts.0.clone()).iter().any(inside) {
                return Err(crossing((&rings[k], ring), touch, origin, tolerance).into());
            }
        } else if let Some(by) = trim_loop.holds_moved(base, hole.place_off(base, touch.and_then(|t| t.places.first().copied())).0) {
            kept.push((LoopRing::of_trim_loop(base, &hole, false, tolerance)?, hole.shifted(-by)));
        }
    }
    Ok(kept)
}

/// A point of each part of some chains between cuts, given by number of the chain and fraction.
fn middles(chains: &[Chain], cuts: Vec<(usize, f64)>) -> Vec<(&Chain, DVec3)> {
    let mut all = Vec::new();
    for (k, chain) in chains.iter().enumerate() {
        let mut at: Vec<f64> = cuts.iter().filter(|(n, _)| *n == k).map(|(_, f)| *f).chain([0.0, 1.0]).collect();
        at.sort_by(f64::total_cmp);
        at.dedup();
        all.extend(at.windows(2).map(|w| (chain, chain.point(w[0] + (w[1] - w[0]) * MIDDLE))));
    }
    all
}

/// Where between two cuts a part is looked at: no place that is special for anything.
const MIDDLE: f64 = 0.4873;
