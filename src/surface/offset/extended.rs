//! Offsets that run on beyond their borders, so that those of two faces at an angle meet.

use glam::{DVec3, DVec4};

use crate::base::fault::{Fault, Result};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build::line;
use crate::network::Chain;
use crate::surface::closest::nearest::closest;
use crate::surface::core::plane;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::offset::boundary::whole;
use crate::surface::offset::exact::{folds, level, moved_profile, rough, swept_by};
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::sweep::Path;
use crate::surface::swept::extrude::extrude;
use crate::surface::swept::revolve::{Axis, revolve};

/// Places along a border at which its speed across is looked at.
const PLACES: usize = 9;
/// Share of the way to the axis that a profile may run on.
const BEFORE_AXIS: f64 = 0.9;

/// The offset of a face without creases at a distance, about `reach` model units longer on all sides: planes without end, profiles
/// and paths by straight lines, nets by straight strips. Its loops are left out.
pub(crate) fn longer(face: &Surface, distance: f64, reach: f64, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    if let Some(normal) = level(face, tolerance) {
        let bounds = face.hull();
        let at = closest(face, bounds.center()).point + normal * distance;
        let flat = plane::unbounded(at, normal, origin)?;
        let mut room = bounds;
        for corner in [bounds.min - DVec3::splat(reach), bounds.max + DVec3::splat(reach)] {
            room = room.with(corner);
        }
        return Ok((plane::over(&flat, room), Vec::new()));
    }
    let below = whole(face, tolerance);
    if let Some((profile, path)) = swept_by(&below)? {
        let flipped = below.parts().flipped;
        let moved = moved_profile(&profile, path, distance, origin, tolerance)?;
        let made = match path {
            Path::Straight { by } => {
                let way = by.normalize_or_zero() * reach;
                let back = crate::geometry::Motion::translation(-way);
                extrude(&on_both_sides(&moved, |_, _| reach, tolerance)?.moved(&back), by + way * 2.0, origin, tolerance)?
            }
            Path::Turn { about, axis, angle } => {
                let out = |p: DVec3| (p - about).reject_from_normalized(axis);
                let room = |p: DVec3, way: DVec3| {
                    let (r, towards) = (out(p).length(), -way.dot(out(p).normalize_or_zero()));
                    if r <= tolerance.point {
                        0.0
                    } else if towards > 0.0 {
                        reach.min(BEFORE_AXIS * r / towards)
                    } else {
                        reach
                    }
                };
                let moved = on_both_sides(&moved, room, tolerance)?;
                let least = moved_radius(&moved, &out);
                let turn = std::f64::consts::TAU;
                let more = (reach / least).min(0.5 * (turn - angle.abs()).max(0.0) * BEFORE_AXIS);
                let axis = Axis { about, direction: axis };
                let whole_turn = angle.abs() >= turn;
                let start = crate::geometry::Motion::rotation(about, axis.direction, -more * angle.signum());
                let profile = if whole_turn { moved } else { moved.moved(&start) };
                let angle = if whole_turn { angle } else { angle + 2.0 * more * angle.signum() };
                revolve(&profile, &axis, angle, origin, tolerance)?
            }
        };
        return Ok((if flipped { made.flipped() } else { made }, Vec::new()));
    }
    rough(&below, face.origin(), origin, tolerance)?;
    let base = if below.domain() == Domain::Triangle {
        below.to_net(tolerance)?.map_or_else(|| below.clone(), |form| form.net.surface(SurfaceKind::Nurbs, below.origin(), tolerance))
    } else {
        below
    };
    let mut net = base.offset_net(distance, tolerance)?;
    let closed = base.closed();
    for (in_u, closed) in [(true, closed.0), (false, closed.1)] {
        if !closed {
            net = lengthened(&net, in_u, reach, tolerance);
        }
    }
    Ok((net.surface(SurfaceKind::Offset, origin, tolerance), folds(&base, distance, origin)))
}

/// The smallest distance of a profile from its axis, at places of it.
fn moved_radius(profile: &Chain, out: &impl Fn(DVec3) -> DVec3) -> f64 {
    (0..=PLACES).map(|k| out(profile.point(k as f64 / PLACES as f64)).length()).filter(|r| *r > 0.0).fold(f64::INFINITY, f64::min)
}

/// A chain with straight lines on at its ends; the second function gives their lengths.
fn on_both_sides(chain: &Chain, room: impl Fn(DVec3, DVec3) -> f64, tolerance: &Tolerance) -> Result<Chain> {
    if chain.is_closed(tolerance) {
        return Ok(chain.clone());
    }
    let mut parts = vec![chain.clone()];
    let ends = [(false, chain.start(), -chain.jet(0.0).d1), (true, chain.end(), chain.jet_before(1.0).d1)];
    for (last, end, way) in ends {
        let Some(way) = math::unit(way, 0.0) else { continue };
        let length = room(end, way);
        if length <= tolerance.point {
            continue;
        }
        let more = Chain::of_curve(&line(end, end + way * length, chain.origin())?);
        if last { parts.push(more) } else { parts.insert(0, more.reversed()) }
    }
    if parts.len() == 1 { Ok(chain.clone()) } else { Chain::join(&parts, chain.origin(), tolerance) }
}

/// A polynomial net with a straight strip on at both ends of a direction, unless they are points; smooth where they join.
fn lengthened(net: &NurbsSurface, in_u: bool, reach: f64, tolerance: &Tolerance) -> NurbsSurface {
    let (nu, nv) = net.counts;
    let (along, across) = if in_u { (nu, nv) } else { (nv, nu) };
    let (degree, knots) = if in_u { (net.degree.0, &net.knots.0) } else { (net.degree.1, &net.knots.1) };
    let at = |i: usize, j: usize| if in_u { net.pole(i, j) } else { net.pole(j, i) };
    let (first, last) = (knots[degree + 1] - knots[1], knots[knots.len() - 2] - knots[knots.len() - degree - 2]);
    let slope = |j: usize, end: bool| {
        let (a, b, span) = if end { (at(along - 2, j), at(along - 1, j), last) } else { (at(0, j), at(1, j), first) };
        (b - a) * (degree as f64 / span)
    };
    let point = |end: bool| {
        let i = if end { along - 1 } else { 0 };
        (1..across).all(|j| at(i, j).truncate().distance(at(i, 0).truncate()) <= tolerance.point)
    };
    let extent = |end: bool| {
        let slowest = (0..across).map(|j| slope(j, end).truncate().length()).fold(f64::INFINITY, f64::min);
        if point(end) || slowest <= 0.0 { 0.0 } else { reach / slowest }
    };
    let (before, after) = (extent(false), extent(true));
    let row = |j: usize| -> Vec<DVec4> {
        let inner: Vec<DVec4> = (0..along).map(|i| at(i, j)).collect();
        let share = |k: usize| k as f64 / degree as f64;
        let mut all: Vec<DVec4> = Vec::new();
        if before > 0.0 {
            all.extend((0..degree).map(|k| inner[0] - slope(j, false) * (before * (1.0 - share(k)))));
        }
        // The point where a strip joins follows from its neighbours.
        all.extend(&inner[usize::from(before > 0.0)..along - usize::from(after > 0.0)]);
        if after > 0.0 {
            all.extend((1..=degree).map(|k| inner[along - 1] + slope(j, true) * (after * share(k))));
        }
        all
    };
    let rows: Vec<Vec<DVec4>> = (0..across).map(row).collect();
    let mut longer: Vec<f64> = Vec::new();
    let ends = |from: f64| std::iter::repeat_n(from, degree + 1);
    if before > 0.0 {
        longer.extend(ends(-before));
    }
    longer.extend(&knots[if before > 0.0 { 2 } else { 0 }..knots.len() - if after > 0.0 { 2 } else { 1 }]);
    if after > 0.0 {
        longer.extend(ends(1.0 + after));
    } else {
        longer.push(1.0);
    }
    let (low, high) = (longer[0], longer[longer.len() - 1]);
    let longer: Vec<f64> = longer.into_iter().map(|k| if k == high { 1.0 } else { (k - low) / (high - low) }).collect();
    let n = rows[0].len();
    if in_u {
        let poles = rows.into_iter().flatten().collect();
        NurbsSurface { poles, counts: (n, nv), knots: (longer, net.knots.1.clone()), ..*net }
    } else {
        let poles = (0..n).flat_map(|i| rows.iter().map(move |row| row[i])).collect();
        NurbsSurface { poles, counts: (nu, n), knots: (net.knots.0.clone(), longer), ..*net }
    }
}
