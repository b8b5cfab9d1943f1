//! Runs of a common line between seams, or between lines where a patch ends, that are near to each other along it.
//!
//! The search halves cells down to a share of a patch; a run that leaves a pair of patches again before that is not seen. But the line that
//! comes to such a border goes on behind it: from an end of what was found that is the end of nothing else, marches begin in all pairs of
//! patches that have the place.

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::{TOLD_APART, Tolerance};
use crate::geometry::Curve;
use crate::network::Chain;
use crate::surface::closest::foot::FootSearch;
use crate::surface::closest::nearest::closest;
use crate::surface::intersect::join_curves::joined;
use crate::surface::intersect::pair::{Pair, Spot};
use crate::surface::intersect::patch_pair::TOUCHING_SINE;
use crate::surface::intersect::sheet::Sheet;
use crate::surface::intersect::touch_line::Touch;
use crate::surface::intersect::with_surfaces::{curve, lies_on};

/// The most borders in a row behind which runs are looked for.
const ROUNDS: usize = 16;

/// Adds the runs that go on from free ends of some curves.
pub(super) fn with_lost_runs(mut curves: Vec<Curve>, sheets: [&[Sheet]; 2], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Curve>> {
    let bordered = |sheets: &[Sheet]| sheets.len() > 1 || sheets.first().is_some_and(|s| s.patch.surface.closed() != (false, false));
    if !sheets.iter().any(|sheets| bordered(sheets)) {
        return Ok(curves);
    }
    for _ in 0..ROUNDS {
        job::poll();
        let rows = joined(curves.clone(), tolerance);
        let closed = |c: &Curve| c.start().distance(c.end()) <= 2.0 * tolerance.point;
        let free = rows.iter().filter(|c| !closed(c)).flat_map(|c| [c.start(), c.end()]);
        let before = curves.len();
        for at in free {
            for run in from(at, sheets, origin, tolerance)? {
                if !curves.iter().any(|known| lies_on(&run, &Chain::of_curve(known), tolerance)) {
                    curves.push(run);
                }
            }
        }
        if curves.len() == before {
            break;
        }
    }
    Ok(curves)
}

/// The lines through a place in all pairs of patches that have it.
fn from(at: DVec3, sheets: [&[Sheet]; 2], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Curve>> {
    let mut found = Vec::new();
    let beside = sheets.map(|sheets| places(at, sheets, tolerance));
    for (x, a) in &beside[0] {
        for (y, b) in &beside[1] {
            let pair = Pair { a: &x.patch, b: &y.patch, point: tolerance.point };
            let size = x.bounds().diagonal().min(y.bounds().diagonal());
            // Where they touch along a line, all of it is found already.
            let touch = Touch { pair: &pair, size };
            let crosses = |spot: &Spot| spot.sine > TOUCHING_SINE || !touch.has(spot);
            let is_here = |spot: &Spot| spot.p.distance(at) <= TOLD_APART * tolerance.point;
            let spot = pair.correct(*a, *b, None).filter(|spot| is_here(spot) && crosses(spot));
            // Where no run can be followed the end stays free.
            let Some(Ok(branch)) = spot.map(|spot| pair.line_through(spot, size)) else { continue };
            found.extend(curve(&branch.cubics, origin, tolerance)?);
        }
    }
    Ok(found)
}

/// The places of a point in patches: on both sides of a seam and of a line where patches end.
fn places<'a>(at: DVec3, sheets: &'a [Sheet], tolerance: &Tolerance) -> Vec<(&'a Sheet, DVec2)> {
    let Some(first) = sheets.first() else { return Vec::new() };
    let near = DVec2::from(closest(&first.patch.surface, at).uv);
    let turns = |closed: bool| if closed { &[0.0, 1.0, -1.0][..] } else { &[0.0][..] };
    let (closed_u, closed_v) = first.patch.surface.closed();
    let copies = turns(closed_u).iter().flat_map(|u| turns(closed_v).iter().map(move |v| near + DVec2::new(*u, *v)));
    let mut all: Vec<(&Sheet, DVec2)> = Vec::new();
    for uv in copies {
        for sheet in sheets {
            let held = sheet.patch.hold(uv);
            let on = sheet.patch.jet(held).p.distance(at) <= TOLD_APART * tolerance.point;
            let known = |(other, place): &(&Sheet, DVec2)| std::ptr::eq(*other, sheet) && *place == held;
            if on && !all.iter().any(known) {
                all.push((sheet, held));
            }
        }
    }
    all
}
