//! `plane`: flat faces between curves, and the unbounded plane.
//!
//! A boundary of two, three or four sides is mapped (ruled, uniform trilateral, bilinear Coons). Sides are the curves as
//! written; of one curve, or of more than four, the runs between corners. Any other boundary is a face with an area
//! and a border, over the box of its plane, but without a map.

use glam::DVec3;

use super::Jet2;
use super::blend::Blend;
use super::breaks::chain_breaks;
use super::coons::{borders, set_kinks};
use super::core::{Border, Domain, Parts, Side, Surface, SurfaceKind};
use super::flow_words::phrase;
use super::rail::Rail;
use super::reparam::Map;
use super::shape::Shape;
use super::trilateral::Trilateral;
use super::weights::{Axis, Rule};
use crate::base::bbox::Box3;
use crate::base::fault::{CurveEnd, CurveFault, Fault, LoopFault, LoopRole, NetworkFault, Result, SurfaceFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{BESIDE, Tolerance};
use crate::geometry::{Curve, Hit, Kind, Motion, self_intersect};
use crate::network::{Chain, Flow, FlowKind, meet};

/// A frame in space: o + u·eu + v·ev, the vectors spanning the box of a boundary (or unit vectors, unbounded).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Where u = v = 0.
    pub origin: DVec3,
    /// ∂/∂u.
    pub eu: DVec3,
    /// ∂/∂v.
    pub ev: DVec3,
}

crate::content!(Frame { origin, eu, ev });

impl Frame {
    /// Point and derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        Jet2 { p: self.origin + self.eu * u + self.ev * v, du: self.eu, dv: self.ev, ..Jet2::default() }
    }

    /// (u, v) of the foot of a point.
    pub fn uv(&self, p: DVec3) -> (f64, f64) {
        let arm = p - self.origin;
        (arm.dot(self.eu) / self.eu.length_squared(), arm.dot(self.ev) / self.ev.length_squared())
    }

    /// The box of 0 ≤ u, v ≤ 1.
    pub fn hull(&self) -> Box3 {
        Box3::of([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| self.jet(u, v).p))
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        Self { origin: motion.point(self.origin), eu: motion.vector(self.eu), ev: motion.vector(self.ev) }
    }
}

/// The unbounded plane through a point, u and v in model units from it; E409 for a normal without length.
pub fn unbounded(at: DVec3, normal: DVec3, origin: Origin) -> Result<Surface> {
    let Some(n) = math::unit(normal, 0.0) else {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "normal", needed: "with a length" }.into());
    };
    let eu = math::any_normal(n);
    let frame = Frame { origin: at, eu, ev: n.cross(eu) };
    Ok(flat(Shape::Plane(frame), Domain::Unbounded, Vec::new(), String::new(), origin, Vec::new()))
}

/// The square of an unbounded plane that holds whatever of it lies in a box, with room around.
pub(super) fn over(surface: &Surface, reach: Box3) -> Surface {
    let parts = surface.parts();
    let Shape::Plane(frame) = parts.shape else { return surface.clone() };
    let (center, size) = (reach.center(), reach.diagonal());
    let (eu, ev) = (frame.eu.normalize_or_zero() * (2.0 * size), frame.ev.normalize_or_zero() * (2.0 * size));
    let (u, v) = frame.uv(center);
    let middle = frame.jet(u, v).p;
    let shape = Shape::Plane(Frame { origin: middle - eu * 0.5 - ev * 0.5, eu, ev });
    Surface::new(Parts { shape, domain: Domain::Square, borders: free_sides(), trim: None, chains: Vec::new(), ..parts.clone() })
}

/// The whole square of the frame of a plane face.
pub(super) fn squared(surface: &Surface) -> Surface {
    Surface::new(Parts { domain: Domain::Square, borders: free_sides(), trim: None, ..surface.parts().clone() })
}

/// Share of a plane face by which its square is widened on each side.
const WIDER: f64 = 1.0 / 16.0;

/// The square of the frame of a plane face with room around, so that no curve of the face runs along a side of it.
pub(super) fn widened(surface: &Surface) -> Surface {
    let Shape::Plane(frame) = surface.parts().shape else { return squared(surface) };
    let (eu, ev) = (frame.eu * (1.0 + 2.0 * WIDER), frame.ev * (1.0 + 2.0 * WIDER));
    let shape = Shape::Plane(Frame { origin: frame.origin - (frame.eu + frame.ev) * WIDER, eu, ev });
    Surface::new(Parts { shape, domain: Domain::Square, borders: free_sides(), trim: None, ..surface.parts().clone() })
}

fn free_sides() -> Vec<Border> {
    (0..4).map(|_| Border::straight(Side::Free)).collect()
}

/// A chain of the boundary with `true` where the walk round it runs against the chain.
pub(super) type Step = (Chain, bool);

/// The flat face inside curves that close, in any order and direction; the first curve runs along u.
///
/// Returns warnings too (W614). Fails with E502 when the curves do not close, E611 when they cross, E655 when they
/// leave their plane.
pub fn bounded(chains: &[Chain], origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let walk = walked(chains, LoopRole::Plane, tolerance)?;
    simple(&walk, tolerance)?;
    let frame = fitted(&walk, tolerance)?;
    let sides = if (2..=4).contains(&walk.len()) { walk.clone() } else { between_corners(&walk, origin, tolerance)? };
    let mut notes = Vec::new();
    let mut surface = match sides.as_slice() {
        [a, b] => two(a, b, origin, tolerance, &mut notes),
        [a, b, c] => three(a, b, c, origin),
        [a, b, c, d] => four([a, b, c, d], origin, tolerance, &mut notes),
        _ => around(&walk, frame, origin),
    };
    if surface.domain() != Domain::Loop {
        surface = Surface::new(Parts { chains: chains.to_vec(), ..surface.parts().clone() });
    }
    Ok((surface, notes))
}

/// A bounded plane as a face without a map, whose parameters are straight; any other surface as it is.
pub(super) fn unmapped(surface: &Surface, tolerance: &Tolerance) -> Result<Surface> {
    let parts = surface.parts();
    if parts.kind != SurfaceKind::Plane || parts.domain == Domain::Loop || parts.chains.is_empty() {
        return Ok(surface.clone());
    }
    let walk = walked(&parts.chains, LoopRole::Plane, tolerance)?;
    let frame = fitted(&walk, tolerance)?;
    let flat = around(&walk, frame, parts.origin);
    Ok(if parts.flipped { flat.flipped() } else { flat })
}

fn flat(shape: Shape, domain: Domain, borders: Vec<Border>, flow: String, origin: Origin, chains: Vec<Chain>) -> Surface {
    Surface::new(Parts {
        origin,
        kind: SurfaceKind::Plane,
        flow,
        domain,
        closed: (false, false),
        shape,
        borders,
        kinks: (Vec::new(), Vec::new()),
        chains,
        generated: Vec::new(),
        trim: None,
        flipped: false,
    })
}

pub(super) fn start((chain, against): &Step) -> DVec3 {
    if *against { chain.end() } else { chain.start() }
}

fn end((chain, against): &Step) -> DVec3 {
    if *against { chain.start() } else { chain.end() }
}

/// The chains in the order of a walk round the boundary, the first one forwards; E502 where it does not go on or some of several
/// curves are closed by themselves, E663 for a curve that is given twice.
pub(super) fn walked(chains: &[Chain], role: LoopRole, tolerance: &Tolerance) -> Result<Vec<Step>> {
    let mut left: Vec<&Chain> = chains.iter().collect();
    if left.is_empty() {
        return Err(SurfaceFault::FlowUnknown { curves: Vec::new(), why: crate::base::fault::NoFlow::TooFewCurves { given: 0 } }.into());
    }
    once_each(chains, role, tolerance)?;
    let mut walk: Vec<Step> = vec![(left.remove(0).clone(), false)];
    let open = |from: &Step, to: CurveEnd| {
        let a = CurveEnd { of: from.0.origin(), last: !from.1, at: end(from) };
        Fault::from(NetworkFault::BoundaryOpen { a, b: to, tolerance: tolerance.point })
    };
    while !left.is_empty() {
        let last = &walk[walk.len() - 1];
        let here = end(last);
        // The nearest end goes on; of equal ones the first written.
        let near = |chain: &Chain| here.distance(chain.start()).min(here.distance(chain.end()));
        let next = (0..left.len()).min_by(|&a, &b| near(left[a]).total_cmp(&near(left[b]))).unwrap_or(0);
        let chain = left[next];
        let against = here.distance(chain.end()) < here.distance(chain.start());
        if near(chain) > tolerance.point {
            let at = if against { chain.end() } else { chain.start() };
            return Err(open(last, CurveEnd { of: chain.origin(), last: against, at }));
        }
        walk.push((left.remove(next).clone(), against));
    }
    let (first, last) = (&walk[0], &walk[walk.len() - 1]);
    match tolerance.same_point(end(last), start(first)) {
        true => Ok(walk),
        false if walk.len() == 1 => Err(open_alone(&first.0, role, tolerance)),
        false => Err(open(last, CurveEnd { of: first.0.origin(), last: false, at: start(first) })),
    }
}

/// Fails where curves of one loop cannot follow each other whatever their order: one is given twice, or closed among others.
fn once_each(chains: &[Chain], role: LoopRole, tolerance: &Tolerance) -> Result<()> {
    if let Some(places) = crate::network::given_twice(chains, tolerance) {
        let (argument, hole) = match role {
            LoopRole::Plane => ("curves", None),
            LoopRole::Outer => ("outer", None),
            LoopRole::Hole(k) => ("holes", Some(k)),
        };
        return Err(LoopFault::Twice { of: chains[places.1].origin(), argument, places, hole }.into());
    }
    let (mut closed, open): (Vec<&Chain>, Vec<&Chain>) = chains.iter().partition(|c| c.is_closed(tolerance));
    if chains.len() == 1 || closed.is_empty() {
        return Ok(());
    }
    closed.sort_by(|a, b| b.bbox().diagonal().total_cmp(&a.bbox().diagonal()));
    let origins = |list: Vec<&Chain>| list.into_iter().map(Chain::origin).collect();
    Err(LoopFault::ClosedAmong { given: origins(chains.iter().collect()), closed: origins(closed), open: origins(open), role }.into())
}

/// E502 for one curve that does not come back to its start.
fn open_alone(chain: &Chain, role: LoopRole, tolerance: &Tolerance) -> Fault {
    let closes = chain.whole_curve().map(Curve::kind).filter(|k| CLOSABLE.contains(k)).map(Kind::name);
    let ends = (chain.start(), chain.end());
    LoopFault::Open { of: chain.origin(), ends, closes, role, together: Vec::new(), tolerance: tolerance.point }.into()
}

/// Curves whose constructors take `closed:`.
const CLOSABLE: [Kind; 3] = [Kind::Polyline, Kind::Spline, Kind::Bspline];

/// Samples of a step in walking order, its last point left out: enough for a plane and for how far a curve leaves it.
fn samples((chain, against): &Step) -> Vec<DVec3> {
    const EACH: usize = 32;
    let stops = [vec![0.0], chain_breaks(chain), vec![1.0]].concat();
    let inner = stops.windows(2).flat_map(|w| (0..EACH).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / EACH as f64));
    let mut fractions: Vec<f64> = inner.collect();
    if *against {
        // Backwards the walk starts at the end and leaves the start to the next step.
        fractions[0] = 1.0;
        fractions[1..].reverse();
    }
    fractions.iter().map(|&f| chain.point(f)).collect()
}

/// The plane of a boundary with the box of it as frame: u along the first curve's chord, normal by the walk's sense; E655.
fn fitted(walk: &[Step], tolerance: &Tolerance) -> Result<Frame> {
    let rings: Vec<Vec<DVec3>> = walk.iter().map(samples).collect();
    let points: Vec<DVec3> = rings.iter().flatten().copied().collect();
    let center = points.iter().copied().sum::<DVec3>() / points.len() as f64;
    // Twice the area vector [Newell]; a boundary that encloses nothing has no plane.
    let area: DVec3 = (0..points.len()).map(|k| (points[k] - center).cross(points[(k + 1) % points.len()] - center)).sum();
    let size = Box3::of(points.iter().copied()).diagonal();
    let Some(normal) = math::unit(area, tolerance.point * size) else {
        let fault = SurfaceFault::FlowUnknown {
            curves: walk.iter().map(|s| s.0.origin()).collect(),
            why: crate::base::fault::NoFlow::TooFewCurves { given: walk.len() },
        };
        return Err(fault.into());
    };
    let (mut off, mut at, mut curve) = (0.0, center, walk[0].0.origin());
    for (ring, step) in rings.iter().zip(walk) {
        for p in ring {
            let distance = (*p - center).dot(normal).abs();
            if distance > off {
                (off, at, curve) = (distance, *p, step.0.origin());
            }
        }
    }
    if off > tolerance.point {
        return Err(SurfaceFault::PlaneNotFlat { curve, off, at, tolerance: tolerance.point }.into());
    }
    let chord = end(&walk[0]) - start(&walk[0]);
    let eu = math::unit(chord.reject_from_normalized(normal), tolerance.point).unwrap_or_else(|| math::any_normal(normal));
    let ev = normal.cross(eu);
    let span = |e: DVec3| points.iter().map(|p| (*p - center).dot(e)).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    let ((u0, u1), (v0, v1)) = (span(eu), span(ev));
    Ok(Frame { origin: center + eu * u0 + ev * v0, eu: eu * (u1 - u0), ev: ev * (v1 - v0) })
}

/// E611 when curves of the boundary meet away from the ends that the walk joins, or come as near to each other as the tolerance.
pub(super) fn simple(walk: &[Step], tolerance: &Tolerance) -> Result<()> {
    let n = walk.len();
    let crossing = |(a, b): (usize, usize), at: DVec3, along: (f64, f64), apart: f64| -> Fault {
        let (a, b) = (walk[a].0.origin(), walk[b].0.origin());
        match apart > BESIDE * tolerance.point {
            true => NetworkFault::LoopThin { a, b, at, apart, tolerance: tolerance.point }.into(),
            false => SurfaceFault::LoopSelfIntersects { a, b, at, along }.into(),
        }
    };
    for a in 0..n {
        for b in a + 1..n {
            let mut joints = Vec::new();
            if b == a + 1 {
                joints.push(end(&walk[a]));
            }
            if (b + 1) % n == a {
                joints.push(end(&walk[b]));
            }
            for hit in meet(&walk[a].0, &walk[b].0, tolerance)? {
                let joined = joints.iter().any(|p| p.distance(hit.point) <= 2.0 * tolerance.point);
                if !joined || hit.shared_to.is_some() {
                    let gap = |fa: f64, fb: f64| walk[a].0.point(fa).distance(walk[b].0.point(fb));
                    let apart = hit.shared_to.map_or(f64::INFINITY, |(fa, fb)| gap(fa, fb)).min(gap(hit.fa, hit.fb));
                    return Err(crossing((a, b), hit.point, (hit.fa, hit.fb), apart));
                }
            }
        }
        let curve = walk[a].0.to_curve()?;
        let own = |t: f64| curve.length_at(t) / curve.length();
        if let Some(hit) = self_intersect(&curve, tolerance)?.first() {
            let gap = |ta: f64, tb: f64| curve.point(ta).distance(curve.point(tb));
            let (at, along, apart) = match hit {
                Hit::Point { ta, tb, at, gap, .. } => (*at, (own(*ta), own(*tb)), *gap),
                Hit::Overlap { a, b } => (curve.point(a.0), (own(a.0), own(b.0)), gap(a.0, b.0).min(gap(a.1, b.1))),
            };
            return Err(crossing((a, a), at, along, apart));
        }
    }
    Ok(())
}

/// The boundary cut at its corners, begun at the first corner along the walk when the first chain does not start in one.
fn between_corners(walk: &[Step], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Step>> {
    let parts: Vec<Chain> = walk.iter().map(|(chain, against)| if *against { chain.reversed() } else { chain.clone() }).collect();
    let whole = if parts.len() == 1 { parts[0].clone() } else { Chain::join(&parts, origin, tolerance)? };
    let corners = whole.kinks(tolerance);
    let n = corners.len();
    if !(2..=4).contains(&n) {
        return Ok(Vec::new());
    }
    (0..n)
        .map(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % n]);
            Ok((whole.slice(from, if to == 0.0 { 1.0 } else { to }, tolerance)?, false))
        })
        .collect()
}

fn rail((chain, against): &Step, backwards: bool) -> Rail {
    Rail::new(chain.clone(), if *against == backwards { Map::identity() } else { Map::reverse() })
}

fn linear() -> Axis {
    Axis::new(vec![0.0, 1.0], Rule::Lagrange)
}

fn blended(mut blend: Blend, poles: bool, origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Surface {
    let kinks = set_kinks(&mut blend, origin, tolerance, notes);
    let mut sides = borders(&blend);
    if poles {
        sides[1] = Border::straight(Side::Pole(blend.along_u()[0].point(1.0)));
        sides[3] = Border::straight(Side::Pole(blend.along_u()[0].point(0.0)));
    }
    let flow = phrase(if poles { 2 } else { 0 }, (false, false));
    let surface = flat(Shape::Blend(blend), Domain::Square, sides, flow, origin, Vec::new());
    Surface::new(Parts { kinks, ..surface.parts().clone() })
}

/// Two curves with both ends common: straight lines between them.
fn two(a: &Step, b: &Step, origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Surface {
    let blend = Blend::new(linear(), linear(), Vec::new(), vec![rail(a, false), rail(b, true)]);
    blended(blend, true, origin, tolerance, notes)
}

fn three(a: &Step, b: &Step, c: &Step, origin: Origin) -> Surface {
    let sides = [rail(a, false), rail(b, false), rail(c, true)];
    let borders = vec![Border::chain(a.0.clone(), a.1), Border::chain(b.0.clone(), b.1), Border::chain(c.0.clone(), !c.1)];
    let none = Flow {
        kind: FlowKind::UniformTrilateral,
        along_u: Vec::new(),
        along_v: Vec::new(),
        closed_u: false,
        closed_v: false,
        poles: (None, None),
        overhangs: Vec::new(),
    };
    flat(Shape::Trilateral(Trilateral::new(sides)), Domain::Triangle, borders, none.phrase(), origin, Vec::new())
}

/// Bilinear Coons: the walk goes round v = 0, u = 1, v = 1, u = 0.
fn four([a, b, c, d]: [&Step; 4], origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Surface {
    let blend = Blend::new(linear(), linear(), vec![rail(d, true), rail(b, false)], vec![rail(a, false), rail(c, true)]);
    blended(blend, false, origin, tolerance, notes)
}

/// A boundary that no map fits.
fn around(walk: &[Step], frame: Frame, origin: Origin) -> Surface {
    let borders = walk.iter().map(|(chain, against)| Border::chain(chain.clone(), *against)).collect();
    let chains = walk.iter().map(|step| step.0.clone()).collect();
    flat(Shape::Plane(frame), Domain::Loop, borders, String::new(), origin, chains)
}
