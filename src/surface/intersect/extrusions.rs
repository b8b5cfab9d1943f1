//! Intersects a flat face with an extruded one in closed form: the profile as it is seen on the plane along the extrusion.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build;
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::closest::nearest::closest;
use crate::surface::core::plane;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::intersect::planes::{Flat, Lines, on_both};
use crate::surface::intersect::with_curve::with_curve;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::between;
use crate::surface::shapes::sweep::Path;

/// An extrusion that leaves a plane by no more than this share of the tolerance runs in it, by less than so many tolerances along it.
const WITHIN: f64 = 1.0 / 64.0;
const ALONG: f64 = 16.0;

/// Points p with w·p ≥ c.
pub(super) struct HalfSpace {
    pub inward: DVec3,
    pub height: f64,
}

impl HalfSpace {
    fn holds(&self, p: DVec3) -> bool {
        self.inward.dot(p) >= self.height
    }
}

/// Returns the curves in which the plane of a flat face and an extruded face meet, cut at parallelograms and at both ends of the
/// extrusion but not at loops, and points where they touch. `None` for other faces, for profiles that a plane has no such form of, and
/// where one runs along the other.
///
/// Faces know their loops in (u, v); one at most is unbounded. Fails where a curve that meets a plane does.
pub(crate) fn flat_and_extruded(faces: [&Surface; 2], boxes: [Box3; 2], origin: Origin, tolerance: &Tolerance) -> Result<Option<Lines>> {
    for (flat, other) in [(0, 1), (1, 0)] {
        let Some((profile, by)) = extruded(faces[other], tolerance)? else { continue };
        let Some(plane) = Flat::of(faces[flat], boxes[other]) else { continue };
        let (sides, lift) = (sides(faces[flat], &plane), plane.normal.dot(by));
        let found = if lift.abs() <= WITHIN * tolerance.point {
            rulings(&profile, by, &plane, &sides, origin, tolerance)?
        } else if lift.abs() <= ALONG * tolerance.point {
            None
        } else {
            section(&profile, by, &plane, sides, origin, tolerance)?
        };
        let Some(Lines { curves, touches }) = found else { return Ok(None) };
        let curves = curves.into_iter().map(|curve| directed(curve, faces, &plane, flat == 0)).collect();
        return Ok(Some(Lines { curves, touches: on_both(touches, faces, tolerance) }));
    }
    Ok(None)
}

/// A curve in the direction in which the normal of the first face crosses that of the second one, as curves that are searched for run.
pub(super) fn directed(curve: Curve, faces: [&Surface; 2], plane: &Flat, flat_first: bool) -> Curve {
    let (from, to) = curve.domain();
    let jet = curve.jet(0.5 * (from + to));
    let bent = faces[usize::from(flat_first)].untrimmed();
    let (u, v) = closest(&bent, jet.p).uv;
    let way = plane.normal.cross(bent.normal(u, v)).dot(jet.d1);
    if (way < 0.0) == flat_first { curve.reversed() } else { curve }
}

/// The whole profile of an extruded face and how far it is moved.
fn extruded(face: &Surface, tolerance: &Tolerance) -> Result<Option<(Chain, DVec3)>> {
    let Shape::Sweep(sweep) = &face.parts().shape else { return Ok(None) };
    let (Rail::Chain { chain, map, .. }, Path::Straight { by }) = (sweep.profile(), sweep.path()) else { return Ok(None) };
    Ok(Some((between(chain, map.value(0.0), map.value(1.0), tolerance)?, by)))
}

/// Where the plane runs along the extrusion: a straight line from each point of the profile at which that crosses or touches it. `None`
/// where the profile runs along it.
fn rulings(profile: &Chain, by: DVec3, plane: &Flat, sides: &[HalfSpace], origin: Origin, tolerance: &Tolerance) -> Result<Option<Lines>> {
    let space = HalfSpace { inward: plane.normal, height: plane.normal.dot(plane.p) };
    let Some(stops) = stops(profile, &space, tolerance)? else { return Ok(None) };
    let mut found = Lines::default();
    for f in stops {
        let p = profile.point(f);
        let line = Chain::of_curve(&build::line(p, p + by, origin)?);
        let Some(parts) = kept(&line, sides, tolerance)? else { return Ok(None) };
        for (from, to) in parts.into_iter().filter(|(from, to)| (to - from) * line.length() > tolerance.point) {
            found.curves.push(line.slice(from, to, tolerance)?.to_curve()?.with_origin(origin));
        }
    }
    Ok(Some(found))
}

/// Where the plane crosses the extrusion: the profile moved along it into the plane, where it is between both ends.
fn section(
    profile: &Chain,
    by: DVec3,
    plane: &Flat,
    sides: Vec<HalfSpace>,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<Option<Lines>> {
    let lift = plane.normal.dot(by);
    let onto = |p: DVec3| p - by * (plane.normal.dot(p - plane.p) / lift);
    // A plane that cuts the image cuts the profile in one along the extrusion.
    let before = |space: HalfSpace| {
        let inward = space.inward - plane.normal * (space.inward.dot(by) / lift);
        HalfSpace { inward, height: space.height - space.inward.dot(by) * plane.normal.dot(plane.p) / lift }
    };
    let up = plane.normal * lift.signum();
    let level = up.dot(plane.p);
    let ends = [HalfSpace { inward: -up, height: -level }, HalfSpace { inward: up, height: level - lift.abs() }];
    let spaces: Vec<HalfSpace> = ends.into_iter().chain(sides.into_iter().map(before)).collect();
    let Some(intervals) = kept(profile, &spaces, tolerance)? else { return Ok(None) };
    let mut found = Lines::default();
    for (from, to) in &intervals {
        let part = if (*from, *to) == (0.0, 1.0) { profile.clone() } else { profile.slice(*from, *to, tolerance)? };
        let Some(curve) = image(&part.to_curve()?, &onto, origin) else { return Ok(None) };
        if curve.length() > tolerance.point {
            found.curves.push(curve);
        }
    }
    // Where the profile of an end touches the plane nothing is between the ends but a point.
    for end in &spaces[..2] {
        let Some(stops) = stops(profile, end, tolerance)? else { return Ok(None) };
        let near = tolerance.point / profile.length();
        let lone = |f: &f64| !intervals.iter().any(|(from, to)| (from - near..=to + near).contains(f));
        found.touches.extend(stops.iter().filter(|f| lone(f)).map(|f| onto(profile.point(*f))));
    }
    Ok(Some(found))
}

/// The half spaces that bound a flat face that is a parallelogram.
pub(super) fn sides(face: &Surface, plane: &Flat) -> Vec<HalfSpace> {
    let all = plane.sides().into_iter().map(|(inward, p)| HalfSpace { inward, height: inward.dot(p) });
    if face.domain() == Domain::Square { all.collect() } else { Vec::new() }
}

/// The intervals of a chain inside half spaces, ascending; the first of a closed chain may begin before its start. `None` where the chain
/// runs along the border of one.
pub(super) fn kept(chain: &Chain, spaces: &[HalfSpace], tolerance: &Tolerance) -> Result<Option<Vec<(f64, f64)>>> {
    let mut cuts = vec![0.0, 1.0];
    for space in spaces {
        let Some(more) = stops(chain, space, tolerance)? else { return Ok(None) };
        cuts.extend(more);
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let mut out: Vec<(f64, f64)> = Vec::new();
    for w in cuts.windows(2) {
        if !spaces.iter().all(|space| space.holds(chain.point(0.5 * (w[0] + w[1])))) {
            continue;
        }
        match out.last_mut() {
            Some(last) if last.1 == w[0] => last.1 = w[1],
            _ => out.push((w[0], w[1])),
        }
    }
    if out.len() > 1 && out[0].0 == 0.0 && out[out.len() - 1].1 == 1.0 && chain.is_closed(tolerance) {
        let (_, to) = out.remove(0);
        if let Some(last) = out.last_mut() {
            last.1 = to;
        }
    }
    Ok(Some(out))
}

/// Where a chain meets the border of a half space, by its fractions; `None` where it runs along it.
pub(super) fn stops(chain: &Chain, space: &HalfSpace, tolerance: &Tolerance) -> Result<Option<Vec<f64>>> {
    let length = space.inward.length();
    let bounds = chain.bbox();
    let reach = 0.5 * (bounds.max - bounds.min).dot(space.inward.abs());
    let middle = space.inward.dot(bounds.center()) - space.height;
    if length == 0.0 || middle.abs() > reach + tolerance.point * length {
        return Ok(Some(Vec::new()));
    }
    let border = plane::unbounded(space.inward * (space.height / (length * length)), space.inward, Origin::NONE)?;
    let met = with_curve(chain, &[border], tolerance)?;
    if met.iter().any(|m| m.overlap_end.is_some()) {
        return Ok(None);
    }
    Ok(Some(met.into_iter().map(|m| m.f).collect()))
}

/// A curve under an affine map that leaves no part of it a point; `None` of curves that are then no curve of a kind that there is.
fn image(curve: &Curve, map: &impl Fn(DVec3) -> DVec3, origin: Origin) -> Option<Curve> {
    let vector = |v: DVec3| map(v) - map(DVec3::ZERO);
    let shape = match curve.shape() {
        CurveShape::Line(a, b) => CurveShape::Line(map(*a), map(*b)),
        CurveShape::Arc(arc) => CurveShape::Arc(Box::new(EllipticArc::new(map(arc.center), vector(arc.u), vector(arc.v), arc.sweep))),
        CurveShape::Nurbs(spline) => {
            let poles = spline.poles.iter().map(|q| (vector(q.truncate()) + map(DVec3::ZERO) * q.w).extend(q.w)).collect();
            CurveShape::Nurbs(Arc::new(Nurbs { poles, knots: spline.knots.clone(), ..**spline }))
        }
        CurveShape::Composite(all) => {
            let pieces = all.pieces.iter().map(|piece| image(piece, map, origin)).collect::<Option<Vec<Curve>>>()?;
            CurveShape::Composite(Arc::new(Composite::new(pieces)))
        }
        CurveShape::Helix(_) | CurveShape::Offset(_) => return None,
    };
    Some(Curve::new(shape, Kind::Meet, origin))
}
