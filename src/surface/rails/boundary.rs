//! Curves that close, walked round in order.

use crate::network::fault::GridFault;
use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::tolerance::{BESIDE, Tolerance};
use crate::geometry::{Curve, Hit, Kind, self_intersect};
use crate::network::fault::{ChainFault, CurveEnd, EndFault};
use crate::network::{Chain, meet};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::faults::{BorderFault, LoopFault, LoopRole};

/// A chain of the boundary with `true` where the walk round it runs against the chain.
pub(crate) type Step = (Chain, bool);

pub(crate) fn start((chain, against): &Step) -> DVec3 {
    if *against { chain.end() } else { chain.start() }
}

pub(crate) fn end((chain, against): &Step) -> DVec3 {
    if *against { chain.start() } else { chain.end() }
}

/// The chains in the order of a walk round the boundary, the first one forwards; E502 where it does not go on or some of several
/// curves are closed by themselves, E663 for a curve that is given twice.
pub(crate) fn walked(chains: &[Chain], role: LoopRole, tolerance: &Tolerance) -> Result<Vec<Step>> {
    let mut left: Vec<&Chain> = chains.iter().collect();
    if left.is_empty() {
        return Err(GridFault::FlowUnknown { curves: Vec::new(), why: crate::network::fault::NoFlow::TooFewCurves { given: 0 } }.into());
    }
    once_each(chains, role, tolerance)?;
    let mut walk: Vec<Step> = vec![(left.remove(0).clone(), false)];
    let open = |from: &Step, to: CurveEnd| {
        let a = CurveEnd { of: from.0.origin(), last: !from.1, at: end(from) };
        Fault::from(EndFault::BoundaryOpen { a, b: to, tolerance: tolerance.point })
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
pub(crate) fn once_each(chains: &[Chain], role: LoopRole, tolerance: &Tolerance) -> Result<()> {
    if let Some(places) = crate::network::given_twice(chains, tolerance) {
        let (argument, hole) = match role {
            LoopRole::Plane => ("curves", None),
            LoopRole::Fill => ("borders", None),
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
pub(crate) fn samples((chain, against): &Step) -> Vec<DVec3> {
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

/// E611 when curves of the boundary meet away from the ends that the walk joins, or come as near to each other as the tolerance.
pub(crate) fn simple(walk: &[Step], tolerance: &Tolerance) -> Result<()> {
    let n = walk.len();
    let crossing = |(a, b): (usize, usize), at: DVec3, along: (f64, f64), apart: f64| -> Fault {
        let (a, b) = (walk[a].0.origin(), walk[b].0.origin());
        match apart > BESIDE * tolerance.point {
            true => ChainFault::LoopThin { a, b, at, apart, tolerance: tolerance.point }.into(),
            false => BorderFault::LoopSelfIntersects { a, b, at, along }.into(),
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
                if !joined || hit.overlap_end.is_some() {
                    let gap = |fa: f64, fb: f64| walk[a].0.point(fa).distance(walk[b].0.point(fb));
                    let apart = hit.overlap_end.map_or(f64::INFINITY, |(fa, fb)| gap(fa, fb)).min(gap(hit.fa, hit.fb));
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
