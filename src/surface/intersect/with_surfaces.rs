//! The curves in which surfaces meet.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build;
use crate::geometry::curves::curve::Shape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::faults::CrossingFault;
use crate::surface::intersect::coplanar::{Coplanar, overlap};
use crate::surface::intersect::extrusions::flat_and_extruded;
use crate::surface::intersect::join_curves::{self, STRAIGHT};
use crate::surface::intersect::known_curves::KnownCurve;
use crate::surface::intersect::lost_runs::with_lost_runs;
use crate::surface::intersect::patch_pair::{Stopped, common};
use crate::surface::intersect::planes::{flat_faces, on_both};
use crate::surface::intersect::revolved::flat_and_revolved;
use crate::surface::intersect::sheet::{Sheet, patches, widely_grounded};
use crate::surface::intersect::turned::flat_and_turned;
use crate::surface::intersect::with_curve::{kept_intervals, long};
use crate::surface::trims::trim::over_frame;

/// What two sets of surfaces have in common.
#[derive(Clone, Debug, Default)]
pub struct Common {
    /// The curves in which they cross, ordered by their first points (x, then y, then z).
    pub curves: Vec<Chain>,
    /// Places where they touch without crossing.
    pub touches: Vec<DVec3>,
}

/// The curves in which surfaces of two sets meet, each within a quarter of the tolerance of both.
///
/// Straight ones are lines. Curves go on from face to face; of trimmed surfaces only the kept parts count. E657 where two
/// run along each other, E413 when the work exceeds its limit.
pub fn with_surfaces(a: &[Surface], b: &[Surface], origin: Origin, tolerance: &Tolerance) -> Result<Common> {
    let mut pieces: Vec<Curve> = Vec::new();
    let mut touches: Vec<DVec3> = Vec::new();
    for x in a {
        for y in b {
            let found = of_two(x, y, origin, tolerance)?;
            pieces.extend(found.0);
            touches.extend(found.1);
        }
    }
    let distinct = once(pieces, tolerance);
    let mut curves = Vec::new();
    for row in join_curves::joined(distinct, tolerance) {
        curves.push(Chain::of_curve(&row.with_origin(origin)));
    }
    touches.retain(|p| curves.iter().all(|c| c.closest(*p).2 > long(tolerance, f64::INFINITY)));
    curves.sort_by(|x, y| lexical(x.start(), y.start()).then(lexical(x.point(0.5), y.point(0.5))));
    Ok(Common { curves, touches })
}

/// The one curve in which surfaces meet; none or several are E507 and E508 with what there is.
pub fn with_surfaces_once(a: &[Surface], b: &[Surface], origin: Origin, tolerance: &Tolerance) -> Result<Chain> {
    let common = with_surfaces(a, b, origin, tolerance)?;
    let of = |list: &[Surface]| list.first().map_or(Origin::NONE, Surface::origin);
    let (a, b) = (of(a), of(b));
    match common.curves.as_slice() {
        [one] => Ok(one.clone()),
        [] => Err(CrossingFault::NoCurve { a, b, touch: common.touches.first().copied(), tolerance: tolerance.point }.into()),
        several => {
            let curves = several.iter().map(|c| (c.point(0.5), c.length())).collect();
            Err(CrossingFault::SeveralCurves { a, b, curves }.into())
        }
    }
}

fn lexical(a: DVec3, b: DVec3) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}

/// Curves and touches of two surfaces.
fn of_two(a: &Surface, b: &Surface, origin: Origin, tolerance: &Tolerance) -> Result<(Vec<Curve>, Vec<DVec3>)> {
    let (a, b) = (&over_frame(a, tolerance)?, &over_frame(b, tolerance)?);
    let reach = |s: &Surface| (s.ground() != Domain::Unbounded).then(|| s.hull());
    let (box_a, box_b) = match (reach(a), reach(b)) {
        (Some(x), Some(y)) => (x, y),
        (Some(x), None) => (x, x),
        (None, Some(y)) => (y, y),
        (None, None) => return Err(CrossingFault::WithoutEnd { of: origin }.into()),
    };
    if !box_a.touches(&box_b, tolerance.point) {
        return Ok((Vec::new(), Vec::new()));
    }
    for closed_form in [flat_faces, flat_and_extruded, flat_and_revolved, flat_and_turned] {
        let Some(lines) = closed_form([a, b], [box_a, box_b], origin, tolerance)? else { continue };
        let mut kept = Vec::new();
        for line in lines.curves {
            kept.extend(kept_parts(line, [a, b], tolerance)?);
        }
        return Ok((kept, lines.touches));
    }
    let (curves, touches) = searched([a, b], [box_a, box_b], origin, tolerance)?;
    let mut kept = Vec::new();
    for curve in curves {
        kept.extend(kept_parts(curve, [a, b], tolerance)?);
    }
    Ok((kept, touches))
}

/// Finds by subdivision the curves in which two surfaces meet and the points where they touch; loops do not cut the curves yet.
fn searched([a, b]: [&Surface; 2], [box_a, box_b]: [Box3; 2], origin: Origin, tolerance: &Tolerance) -> Result<(Vec<Curve>, Vec<DVec3>)> {
    let (mut sheets_a, mut sheets_b) = (sheets(&widely_grounded(a, box_b)), sheets(&widely_grounded(b, box_a)));
    let lost =
        |at: DVec3| Fault::from(CurveFault::NotConverged { of: origin, what: "the curve in which the surfaces meet".to_owned(), at });
    let along = |at: DVec3| Fault::from(CrossingFault::RunAlong { a: a.origin(), b: b.origin(), at, tolerance: tolerance.point });
    let known_curves = KnownCurve::between(a, b, tolerance)?;
    let (mut curves, mut touches, mut coplanar) = (Vec::new(), Vec::new(), None);
    for known in &known_curves {
        curves.push(known.chain.to_curve()?.with_origin(origin));
    }
    let on_known = |at: DVec3, room: f64| known_curves.iter().any(|known| known.chain.closest(at).2 <= room);
    for x in &mut sheets_a {
        for y in &mut sheets_b {
            job::poll();
            if !x.bounds().touches(&y.bounds(), tolerance.point) {
                continue;
            }
            let found = common(x, y, &known_curves, tolerance.point, long(tolerance, f64::INFINITY)).map_err(|stopped| match stopped {
                Stopped::Along(at) => along(at),
                Stopped::Lost(at) => lost(at),
            })?;
            let mut own = Vec::new();
            for branch in &found.branches {
                match curve(&branch.cubics, origin, tolerance)? {
                    Some(curve) => own.push(curve),
                    None => touches.extend(on_both(branch.spots.first().map(|spot| spot.p).into_iter().collect(), [a, b], tolerance)),
                }
            }
            // Beside a known curve a march finds that one again, within the tolerance only.
            own.retain(|curve| !known_curves.iter().any(|known| lies_on(curve, &known.chain, tolerance)));
            for extent in clusters(&found.touches, tolerance.point) {
                let at = extent.center();
                let known =
                    own.iter().any(|c: &Curve| Chain::of_curve(c).closest(at).2 <= extent.diagonal() + long(tolerance, extent.diagonal()));
                if known || on_known(at, extent.diagonal() + long(tolerance, extent.diagonal())) {
                    continue;
                }
                if extent.diagonal() > long(tolerance, f64::INFINITY) {
                    let known = match coplanar {
                        Some(known) => known,
                        None => *coplanar.insert(overlap(a, b, tolerance)?),
                    };
                    match known {
                        Coplanar::Apart => continue,
                        Coplanar::Overlap(place) => return Err(along(place)),
                        Coplanar::Unknown => return Err(along(at)),
                    }
                }
                touches.push(at);
            }
            curves.extend(own);
        }
    }
    Ok((with_lost_runs(curves, [&sheets_a, &sheets_b], origin, tolerance)?, touches))
}

fn sheets(ground: &Surface) -> Vec<Sheet> {
    patches(ground).into_iter().map(Sheet::new).collect()
}

/// Boxes that touch as one.
fn clusters(boxes: &[Box3], point: f64) -> Vec<Box3> {
    let mut out: Vec<Box3> = Vec::new();
    for one in boxes {
        let mut whole = *one;
        loop {
            job::poll();
            let before = out.len();
            out.retain(|other| {
                let near = other.touches(&whole, point);
                whole = if near { whole.union(*other) } else { whole };
                !near
            });
            if out.len() == before {
                break;
            }
        }
        out.push(whole);
    }
    out
}

/// Cubics in a row as a curve, a straight row as a line; `None` where nothing is left.
pub(super) fn curve(cubics: &[Nurbs], origin: Origin, tolerance: &Tolerance) -> Result<Option<Curve>> {
    let (Some(first), Some(last)) = (cubics.first(), cubics.last()) else { return Ok(None) };
    let (start, end) = (first.pole(0), last.pole(last.poles.len() - 1));
    let chord = end - start;
    let straight = |p: DVec3| {
        let share = (p - start).dot(chord) / chord.length_squared();
        (start + chord * share).distance(p) <= STRAIGHT * tolerance.point
    };
    if chord.length() > tolerance.point && cubics.iter().all(|c| (0..c.poles.len()).all(|k| straight(c.pole(k)))) {
        return build::line(start, end, origin).map(Some);
    }
    let curve = Curve::new(Shape::Nurbs(Arc::new(Nurbs::joined(cubics))), Kind::Meet, origin);
    Ok((curve.length() > tolerance.point).then_some(curve))
}

/// The parts of a curve that lie in the kept parts of two surfaces.
fn kept_parts(curve: Curve, surfaces: [&Surface; 2], tolerance: &Tolerance) -> Result<Vec<Curve>> {
    if surfaces.iter().all(|s| s.domain() != Domain::Loop) {
        return Ok(vec![curve]);
    }
    let chain = Chain::of_curve(&curve);
    let mut intervals = vec![(0.0, 1.0)];
    for surface in surfaces {
        intervals = kept_intervals(&chain, surface, intervals, tolerance)?;
    }
    if intervals == [(0.0, 1.0)] {
        return Ok(vec![curve]);
    }
    let long_enough = intervals.into_iter().filter(|(from, to)| (to - from) * chain.length() > tolerance.point);
    long_enough.map(|(from, to)| chain.slice(from, to, tolerance)?.to_curve()).collect()
}

/// Curves without those that lie on another one: patches side by side both have what lies on their border.
fn once(mut curves: Vec<Curve>, tolerance: &Tolerance) -> Vec<Curve> {
    curves.sort_by(|a, b| b.length().total_cmp(&a.length()));
    let mut kept: Vec<(Curve, Chain)> = Vec::new();
    for curve in curves {
        if !kept.iter().any(|(_, other)| lies_on(&curve, other, tolerance)) {
            let chain = Chain::of_curve(&curve);
            kept.push((curve, chain));
        }
    }
    kept.into_iter().map(|(curve, _)| curve).collect()
}

/// Whether a curve lies on another one, told at several places.
pub(super) fn lies_on(curve: &Curve, other: &Chain, tolerance: &Tolerance) -> bool {
    const PLACES: usize = 5;
    let chain = Chain::of_curve(curve);
    let near = |k: usize| other.closest(chain.point(k as f64 / (PLACES - 1) as f64)).2 <= 2.0 * tolerance.point;
    curve.bbox().touches(&other.bbox(), tolerance.point) && (0..PLACES).all(near)
}
