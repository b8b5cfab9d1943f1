//! Loops on closed surfaces that no polygon in (u, v) represents: over the seam of a whole surface, round a pole, round a tube. They
//! divide the surface, and what they bound alone is the part without its border.

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::closest::inside::inside;
use crate::surface::closest::nearest::closest;
use crate::surface::core::surface::Surface;
use crate::surface::rails::side::Side;
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::trims::divide::divide;
use crate::surface::trims::trim_loop::{TrimLoop, natural};

/// How the two sides of a loop are found.
struct SideSearch {
    /// Shares of a curve; its two sides are looked for at the one farthest from its corners.
    at_fractions: [f64; 5],
    /// How far beside it, as a share of its length, at first.
    first_distance_share: f64,
    /// Halvings of that.
    max_halvings: usize,
    /// Least distance of a side from the whole loop, as a share of how far beside it is looked for. Nearer than this it may lie beyond
    /// another run of the loop.
    clear_share: f64,
    /// How far beside its border a surface surely is, in nudges of (u, v).
    inward_nudges: f64,
    /// Cells along u and v by which areas are compared.
    cells_each_way: usize,
}

const SIDES: SideSearch = SideSearch {
    at_fractions: [0.4873, 0.2327, 0.7719, 0.3541, 0.6137],
    first_distance_share: 0.01,
    max_halvings: 12,
    clear_share: 0.9,
    inward_nudges: 100.0,
    cells_each_way: 48,
};

/// Which part a loop keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    /// What it bounds alone.
    Inside,
    /// The rest.
    Outside,
}

impl TrimLoop {
    /// Whether it comes back to its first place by a whole turn round the surface.
    pub fn winds(&self, base: &Surface) -> bool {
        let ends = |c: &TrimCurve| -> Option<(DVec2, DVec2)> { Some((*c.places().first()?, *c.places().last()?)) };
        let (Some(first), Some(last)) = (self.trim_curves.first().and_then(ends), self.trim_curves.last().and_then(ends)) else {
            return false;
        };
        let turns = (last.1 - first.0).round();
        let closed = base.closed();
        closed.0 && turns.x != 0.0 || closed.1 && turns.y != 0.0
    }

    /// Whether every place of it is inside another one, each moved by turns of its own; a place on a seam is.
    pub fn lies_within(&self, base: &Surface, bounds: &TrimLoop) -> bool {
        let offsets = [DVec2::ZERO, DVec2::splat(NUDGE), DVec2::splat(-NUDGE), DVec2::new(NUDGE, -NUDGE), DVec2::new(-NUDGE, NUDGE)];
        let outline = bounds.polygon();
        let place = |p: DVec2| bounds.copies(base, p).into_iter().any(|at| offsets.iter().any(|off| inside(&outline, at + *off)));
        self.trim_curves.iter().flat_map(TrimCurve::places).all(place)
    }
}

/// The part of a surface that a loop bounds alone, or the rest; `None` where there is border on both sides of it.
///
/// On a surface without any border the smaller part is what a loop bounds.
pub(crate) fn noncontractible(
    base: &Surface,
    chains: &[Chain],
    keep: Keep,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<Option<Surface>> {
    let Some(points) = beside(base, chains, tolerance) else { return Ok(None) };
    let [a, b] = points.map(|p| divide(base, chains, p, origin, tolerance));
    let (a, b) = (a?, b?);
    let border = border_places(base, tolerance)?;
    let all = |part: &Surface| border.iter().all(|p| part.holds(p.x, p.y));
    let first_is_outside = match (all(&a), all(&b)) {
        (true, false) => true,
        (false, true) => false,
        (true, true) => area(&a) >= area(&b),
        (false, false) => return Ok(None),
    };
    Ok(Some(if first_is_outside == (keep == Keep::Outside) { a } else { b }))
}

/// A point of the surface on each side of a loop.
fn beside(base: &Surface, chains: &[Chain], tolerance: &Tolerance) -> Option<[DVec3; 2]> {
    let chain = chains.first()?;
    let corners = chain.kinks(tolerance);
    let clear = |f: &f64| corners.iter().map(|corner| (corner - f).abs()).fold(f64::INFINITY, f64::min);
    let clearest = SIDES.at_fractions.into_iter().rev().max_by(|f, g| clear(f).total_cmp(&clear(g)))?;
    let jet = chain.jet(clearest);
    let at = closest(base, jet.p).uv;
    let aside = base.normal(at.0, at.1).cross(jet.d1).try_normalize()?;
    let mut step = SIDES.first_distance_share * chain.length();
    for _ in 0..SIDES.max_halvings {
        let points = [aside * step, aside * -step].map(|d| closest(base, jet.p + d).point);
        let far = |p: &DVec3| chains.iter().map(|c| c.closest(*p).2).fold(f64::INFINITY, f64::min) >= SIDES.clear_share * step;
        if points.iter().all(far) {
            return Some(points);
        }
        step *= 0.5;
        if step <= 4.0 * tolerance.point {
            break;
        }
    }
    None
}

/// Places just inside the border of a surface, one for each side of it that is neither a seam nor a pole.
fn border_places(base: &Surface, tolerance: &Tolerance) -> Result<Vec<DVec2>> {
    let mut found = Vec::new();
    for trim_loop in natural(base, tolerance)? {
        for ((border, trim_curve), twin) in trim_loop.borders.iter().zip(&trim_loop.trim_curves).zip(trim_loop.twins(base)) {
            if matches!(border.side, Side::Pole(_)) || twin.is_some() {
                continue;
            }
            let places = trim_curve.places();
            // A place of a curve itself: its chords may lie outside.
            let k = places.len() / 2;
            let (a, b) = (places[k - 1], places[(k + 1).min(places.len() - 1)]);
            let on = if places.len() > 2 { places[k] } else { 0.5 * (a + b) };
            found.push(on + (b - a).normalize_or_zero().perp() * SIDES.inward_nudges * NUDGE);
        }
    }
    Ok(found)
}

/// About the area of a part of a surface, by the middles of cells that it holds.
fn area(part: &Surface) -> f64 {
    let at = |k: usize| (k as f64 + 0.5) / SIDES.cells_each_way as f64;
    let cells = (0..SIDES.cells_each_way * SIDES.cells_each_way).map(|k| (at(k % SIDES.cells_each_way), at(k / SIDES.cells_each_way)));
    let own = cells.filter(|(u, v)| part.holds(*u, *v)).map(|(u, v)| {
        let jet = part.jet(u, v);
        jet.du.cross(jet.dv).length()
    });
    own.sum()
}
