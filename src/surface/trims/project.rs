//! Curves projected to a surface: its points under a curve in (u, v), the feet of a curve in space, or where a curve meets
//! the surface along a direction. Curves in (u, v) of planes and nets are exact where their degree allows (`compose`); the
//! others have no exact form in general: cubics within a quarter of the tolerance.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, NUDGE, SLIVER, Tolerance};
use crate::geometry::curves::curve::Shape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::closest::foot;
use crate::surface::closest::nearest::Nearest;
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::{chain_breaks, tidy};
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::faults::BorderFault;
use crate::surface::trims::compose;
use crate::surface::trims::over_lines::Lines;

/// What steers the projection of a curve and its cubics.
struct Projecting {
    /// Share of the tolerance that a cubic may be off.
    cubic_share: f64,
    /// Places inside a cubic at which it is compared.
    probes: [f64; 5],
    /// Cubics at most.
    max_cubics: usize,
    /// Newton steps to a point of the surface.
    max_newton_steps: usize,
    /// Steps between two stops when nothing is known of the surface.
    steps_between_stops: usize,
    /// Longest Newton step in (u, v).
    largest_newton_step: f64,
    /// Starts along each direction when no place is known.
    starts_each_way: usize,
    /// Roundings of a coordinate that a Newton step is short within.
    roundings: f64,
}

const PROJECT: Projecting = Projecting {
    cubic_share: 0.25,
    probes: [0.13, 0.3, 0.5, 0.7, 0.87],
    max_cubics: 1 << 14,
    max_newton_steps: 40,
    steps_between_stops: 32,
    largest_newton_step: 0.25,
    starts_each_way: 8,
    roundings: 8.0,
};

/// How a curve gets to the surface.
#[derive(Clone, Copy, Debug)]
pub enum Way {
    /// The curve's x and y are u and v.
    Parameters,
    /// To the nearest points.
    Nearest,
    /// Along a unit vector, either way.
    Along(DVec3),
}

/// A place on the surface with the projected curve's point and derivative.
#[derive(Clone, Copy)]
pub(crate) struct Landing {
    /// Where on the surface.
    pub uv: DVec2,
    /// The point.
    pub p: DVec3,
    /// Derivative by the parameter that is run over.
    pub d1: DVec3,
}

/// Cubics through places that can be asked for between stops: nowhere, among [`PROJECT.probes`], farther off than `allowed`.
///
/// `land` gives the place at a parameter, near a guess when there is one; with `true` as part of what ends there. `lost`
/// is the fault when halving leads nowhere.
pub(crate) fn cubics<E>(
    stops: &[f64],
    allowed: f64,
    land: impl Fn(f64, Option<DVec2>, bool) -> std::result::Result<Landing, E>,
    lost: impl Fn(DVec3) -> E,
) -> std::result::Result<Vec<Nurbs>, E> {
    let mut pieces: Vec<Nurbs> = Vec::new();
    let mut last: Option<DVec2> = None;
    for w in stops.windows(2) {
        let start = land(w[0], last, false)?;
        let end = land(w[1], Some(start.uv), true)?;
        let mut open = vec![(w[0], start, w[1], end)];
        while let Some((a, from, b, to)) = open.pop() {
            let h = b - a;
            let poles = [from.p, from.p + from.d1 * (h / 3.0), to.p - to.d1 * (h / 3.0), to.p];
            let cubic = Nurbs::bezier(a, b, poles.iter().map(|p| p.extend(1.0)).collect());
            let mut good = true;
            for probe in PROJECT.probes {
                let f = a + h * probe;
                let spot = land(f, Some(from.uv.lerp(to.uv, probe)), false)?;
                good &= spot.p.distance(cubic.jet(f).p) <= allowed;
            }
            if good {
                last = Some(to.uv);
                pieces.push(cubic);
                continue;
            }
            if pieces.len() + open.len() > PROJECT.max_cubics || h < NUDGE * NUDGE * (w[1] - w[0]) {
                return Err(lost(from.p));
            }
            let middle = 0.5 * (a + b);
            let before = land(middle, Some(from.uv.lerp(to.uv, 0.5)), true)?;
            let after = land(middle, Some(before.uv), false)?;
            open.push((middle, after, b, to));
            open.push((a, from, middle, before));
        }
    }
    Ok(pieces)
}

struct Projector<'a> {
    surface: &'a Surface,
    near: Nearest,
    lines: Lines<'a>,
    chain: &'a Chain,
    way: Way,
}

/// The curve on the surface.
///
/// Fails with E613 where the curve leaves the surface (its parameters, or the direction misses it), E413 where the result
/// has a cusp.
pub fn project(surface: &Surface, chain: &Chain, way: Way, origin: Origin, tolerance: &Tolerance) -> Result<Curve> {
    let carrier = Projector { surface, near: Nearest::new(surface), lines: Lines::of(surface), chain, way };
    let off = |at: DVec3, distance: f64| BorderFault::LoopOutsideSurface {
        of: chain.origin(),
        surface: surface.origin(),
        off: distance,
        at,
        tolerance: tolerance.point,
    };
    let missed = |f: f64| match (way, chain.point(f)) {
        (Way::Parameters, p) => BorderFault::LoopOutsideParameters { of: chain.origin(), surface: surface.origin(), uv: (p.x, p.y) },
        (_, p) => off(p, carrier.near.at(p).distance),
    };
    let land = |f: f64, guess: Option<DVec2>, before: bool| carrier.at(f, guess, before).ok_or_else(|| Fault::from(missed(f)));
    let lost = |at| CurveFault::NotConverged { of: origin, what: "the curve on the surface".to_owned(), at }.into();
    if let (Way::Parameters, Some(curve)) = (way, compose::exact(surface, chain, origin)) {
        return long_enough(curve, tolerance);
    }
    let mut breaks = chain_breaks(chain);
    if matches!(way, Way::Parameters) {
        breaks.extend(carrier.lines.met(chain));
    }
    let stops = [vec![0.0], tidy(breaks, SLIVER), vec![1.0]].concat();
    let fitted = |stops: &[f64]| cubics(stops, PROJECT.cubic_share * tolerance.point, land, lost);
    // Long steps may land on another sheet of the surface, short ones follow their own.
    let pieces = fitted(&stops).or_else(|_| fitted(&sampled(&stops)))?;
    let curve = Curve::new(Shape::Nurbs(Arc::new(Nurbs::joined(&pieces))), Kind::Project, origin);
    long_enough(curve, tolerance)
}

fn long_enough(curve: Curve, tolerance: &Tolerance) -> Result<Curve> {
    let length = curve.length();
    if length <= tolerance.point {
        return Err(CurveFault::ZeroLength { of: curve.origin(), length, tolerance: tolerance.point }.into());
    }
    Ok(curve)
}

/// Stops with as many between each two.
fn sampled(stops: &[f64]) -> Vec<f64> {
    let between = |w: &[f64]| -> Vec<f64> {
        (0..PROJECT.steps_between_stops).map(|k| w[0] + (w[1] - w[0]) * k as f64 / PROJECT.steps_between_stops as f64).collect()
    };
    stops.windows(2).flat_map(between).chain(stops.last().copied()).collect()
}

impl Projector<'_> {
    /// The projected point at a fraction of the chain, near a place when one is known; `before`: derivatives of the piece
    /// that ends there. `None` where there is none. Over a seam (u, v) go on, so that what is between two places is near both.
    fn at(&self, f: f64, near: Option<DVec2>, before: bool) -> Option<Landing> {
        let found = self.landed(f, near, before)?;
        let Some(near) = near else { return Some(found) };
        let turns = |closed: bool, there: f64, here: f64| if closed { (there - here).round() } else { 0.0 };
        let closed = self.surface.closed();
        let uv = found.uv + DVec2::new(turns(closed.0, near.x, found.uv.x), turns(closed.1, near.y, found.uv.y));
        Some(Landing { uv, ..found })
    }

    fn landed(&self, f: f64, near: Option<DVec2>, before: bool) -> Option<Landing> {
        let jet = if before { self.chain.jet_before(f) } else { self.chain.jet(f) };
        match self.way {
            Way::Parameters => {
                let uv = DVec2::new(jet.p.x, jet.p.y);
                let inside = |x: f64| (-NUDGE..=1.0 + NUDGE).contains(&x);
                let endless = self.surface.domain() == Domain::Unbounded;
                let (closed_u, closed_v) = self.surface.closed();
                if !(endless || (closed_u || inside(uv.x)) && (closed_v || inside(uv.y))) {
                    return None;
                }
                let s = self.lines.jet(uv, jet.d1.truncate(), before);
                Some(Landing { uv, p: s.p, d1: s.du * jet.d1.x + s.dv * jet.d1.y })
            }
            Way::Nearest => {
                let uv = self.foot(jet.p, near);
                let s = self.surface.jet(uv.x, uv.y);
                let r = s.p - jet.p;
                let (a, b, c) = (s.du.length_squared() + r.dot(s.duu), s.du.dot(s.dv) + r.dot(s.duv), s.dv.length_squared() + r.dot(s.dvv));
                let (x, y) = (s.du.dot(jet.d1), s.dv.dot(jet.d1));
                let det = a * c - b * b;
                let d1 = s.du * ((c * x - b * y) / det) + s.dv * ((a * y - b * x) / det);
                d1.is_finite().then_some(Landing { uv, p: s.p, d1 })
            }
            Way::Along(way) => {
                let (uv, s) = self.hit(jet.p, way, near)?;
                let solved = DMat3::from_cols(s.du, s.dv, -way).inverse() * jet.d1;
                let d1 = s.du * solved.x + s.dv * solved.y;
                d1.is_finite().then_some(Landing { uv, p: s.p, d1 })
            }
        }
    }

    fn foot(&self, p: DVec3, near: Option<DVec2>) -> DVec2 {
        let best = self.near.at(p);
        let found = DVec2::new(best.uv.0, best.uv.1);
        let Some(near) = near else { return found };
        // The sheet that was followed, unless another one is truly nearer.
        let (uv, distance) = foot::foot(self.surface.evaluator(), p, near);
        if distance <= best.distance * (1.0 + NUDGE) + EPSILON { uv } else { found }
    }

    /// Where a straight line meets the surface, nearest to a place or to the point.
    fn hit(&self, p: DVec3, way: DVec3, near: Option<DVec2>) -> Option<(DVec2, Jet2)> {
        let newton = |start: DVec2| -> Option<(DVec2, Jet2)> {
            let mut uv = start;
            for _ in 0..PROJECT.max_newton_steps {
                let s = self.surface.jet(uv.x, uv.y);
                let off = (p - s.p).reject_from_normalized(way);
                let solved = DMat3::from_cols(s.du, s.dv, way).inverse() * (p - s.p);
                let step = DVec2::new(solved.x, solved.y);
                if !step.is_finite() {
                    return None;
                }
                let next = self.surface.hold(uv + step.clamp_length_max(PROJECT.largest_newton_step));
                // Far from the origin coordinates are rounded by more than a step may be short.
                let rounding = PROJECT.roundings * s.p.abs().max_element() / s.du.length().min(s.dv.length());
                let still = (next - uv).length() <= EPSILON * rounding.max(1.0);
                uv = next;
                if still {
                    // At rest away from the line: the line misses the surface.
                    return (off.length() <= NUDGE * (s.du.length() + s.dv.length())).then(|| (uv, self.surface.jet(uv.x, uv.y)));
                }
            }
            None
        };
        if let Some(found) = near.and_then(newton) {
            return Some(found);
        }
        let foot = self.near.at(p);
        let mut starts = vec![DVec2::new(foot.uv.0, foot.uv.1)];
        let at = |k: usize| (k as f64 + 0.5) / PROJECT.starts_each_way as f64;
        starts.extend(
            (0..PROJECT.starts_each_way * PROJECT.starts_each_way)
                .map(|k| DVec2::new(at(k % PROJECT.starts_each_way), at(k / PROJECT.starts_each_way))),
        );
        let found = starts.into_iter().filter_map(newton);
        found.min_by(|a, b| a.1.p.distance(p).total_cmp(&b.1.p.distance(p)))
    }
}
