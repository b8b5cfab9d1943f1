//! What makes faces conform that touch: the curves in which they cross, and the points where their borders do.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::topology::{EdgeId, Model, SurfaceId};
use crate::base::boxtree::{BoxTree, PAIR};
use crate::base::fault::{Fault, Result};
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, Network, meet};
use crate::surface::intersect::with_curve::with_curve;
use crate::surface::intersect::with_surfaces::with_surfaces;
use crate::surface::{Nearest, with_loops};

/// Curves and points that faces have in common beside the edges that they share.
#[derive(Clone, Debug, Default)]
pub struct Imprint {
    /// Curves in which faces cross, within the tolerance of both.
    pub curves: Vec<Chain>,
    /// Points where borders and these curves cross.
    pub points: Vec<DVec3>,
}

crate::content!(Imprint { curves, points });

/// Two surfaces that may touch beside the edges that they share.
pub(super) struct TouchingPair {
    pub pair: (SurfaceId, SurfaceId),
    /// The curves in which they cross.
    pub curves: Vec<Chain>,
}

/// Faces that run along each other have no curve in common: their borders tell where.
const COINCIDE: &str = "E657";
/// The curve in which faces cross was not found within the work that it may take.
const LOST: &str = "E413";

/// The parts of a curve that run along none of some others.
fn beside(curve: &Chain, others: &[Chain], tolerance: &Tolerance) -> Result<Vec<Chain>> {
    /// What is left between runs counts where it is longer than so many tolerances.
    const SHORT: f64 = 16.0;
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for other in others {
        let shared = meet(curve, other, tolerance)?;
        runs.extend(shared.iter().filter_map(|m| m.overlap_end.map(|to| (m.fa.min(to.0), m.fa.max(to.0)))));
    }
    if runs.is_empty() {
        return Ok(vec![curve.clone()]);
    }
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    runs.push((1.0, 1.0));
    let (mut from, mut left, short) = (0.0, Vec::new(), SHORT * tolerance.point / curve.length());
    for (start, end) in runs {
        if start - from > short {
            left.push(curve.slice(from, start, tolerance)?);
        }
        from = from.max(end);
    }
    Ok(left)
}

/// Samples of a curve one of which is on a surface that some of it lies on.
const SAMPLES: u32 = 64;

/// Arc-length fractions between which a curve lies on a surface that was made ready, ascending.
///
/// Fails with E413 when the work exceeds its limit.
pub fn runs_on(curve: &Chain, nearest: &Nearest, tolerance: &Tolerance) -> Result<Vec<(f64, f64)>> {
    let surface = nearest.surface();
    if !curve.bbox().touches(&surface.hull(), tolerance.point) {
        return Ok(Vec::new());
    }
    let on = |k: u32| nearest.at(curve.point(f64::from(k) / f64::from(SAMPLES))).distance <= tolerance.point;
    if !(0..=SAMPLES).any(on) {
        return Ok(Vec::new());
    }
    let found = with_curve(curve, &[with_loops(surface, tolerance)?], tolerance)?;
    Ok(found.into_iter().filter_map(|m| m.overlap_end.map(|to| (m.f.min(to), m.f.max(to)))).collect())
}

impl Model {
    /// Points in which curves leave the faces that they lie on, or come to lie on them, and in which they cross each other.
    ///
    /// Fails with E413 when the work exceeds its limit.
    pub fn run_ends(&self, curves: &[&Chain], listed: &[SurfaceId], tolerance: &Tolerance, job: &Job) -> Result<Vec<DVec3>> {
        let ready: Vec<Nearest> = listed.iter().map(|s| Nearest::new(&self.surfaces[s.index()].surface)).collect();
        let pairs: Vec<(&Chain, &Nearest)> = curves.iter().flat_map(|curve| ready.iter().map(|nearest| (*curve, nearest))).collect();
        let found = par::try_map(pairs.len(), |k| {
            job.go_on()?;
            let (curve, nearest) = pairs[k];
            let end = tolerance.point / curve.length();
            let runs = runs_on(curve, nearest, tolerance)?;
            let inside = runs.into_iter().flat_map(|(from, to)| [from, to]).filter(|f| *f > end && *f < 1.0 - end);
            Ok::<Vec<DVec3>, Fault>(inside.map(|f| curve.point(f)).collect())
        })?;
        let mut points: Vec<DVec3> = found.into_iter().flatten().collect();
        for (k, a) in curves.iter().enumerate() {
            for b in curves[k + 1..].iter().filter(|b| b.bbox().touches(&a.bbox(), tolerance.point)) {
                job.go_on()?;
                points.extend(meet(a, b, tolerance)?.iter().map(|m| m.point));
            }
        }
        Ok(points)
    }

    /// What some surfaces have in common beside the edges that they share; `origin` is given to the curves.
    ///
    /// Fails with E413 when the work exceeds its limit.
    pub fn imprint(&self, listed: &[SurfaceId], origin: Origin, network: &Network, tolerance: &Tolerance, job: &Job) -> Result<Imprint> {
        let met = self.met(listed, origin, network, tolerance, job)?;
        let mut crossing: BTreeSet<(EdgeId, EdgeId)> = BTreeSet::new();
        for m in &met {
            let others = self.sides_of(m.pair.1);
            crossing.extend(self.sides_of(m.pair.0).iter().flat_map(|x| others.iter().map(move |y| (*x.min(y), *x.max(y)))));
        }
        crossing.retain(|(x, y)| x != y);
        let edges: BTreeSet<EdgeId> = crossing.iter().flat_map(|(a, b)| [*a, *b]).collect();
        let edges: Vec<EdgeId> = edges.into_iter().collect();
        let ways = par::try_map(edges.len(), |k| self.edge_chain(edges[k], network, tolerance))?;
        let ways: BTreeMap<EdgeId, Chain> = edges.into_iter().zip(ways).filter_map(|(e, way)| Some((e, way?))).collect();
        let curves: Vec<Chain> = met.into_iter().flat_map(|m| m.curves).collect();
        let mut pairs: Vec<(&Chain, &Chain)> = crossing.iter().filter_map(|(a, b)| Some((ways.get(a)?, ways.get(b)?))).collect();
        for (k, curve) in curves.iter().enumerate() {
            pairs.extend(curves[k + 1..].iter().map(|other| (curve, other)));
            pairs.extend(ways.values().map(|way| (curve, way)));
        }
        let points = par::try_map(pairs.len(), |k| {
            job.go_on()?;
            let (a, b) = pairs[k];
            let found = meet(a, b, tolerance)?;
            let both = |m: &crate::network::Meeting| [Some(m.point), m.overlap_end.map(|to| a.point(to.0))];
            Ok::<Vec<DVec3>, Fault>(found.iter().flat_map(both).flatten().collect())
        })?;
        let points = points.into_iter().flatten().collect();
        Ok(Imprint { curves, points })
    }

    /// Pairs of surfaces whose boxes touch, with the curves in which they cross beside the edges that they share.
    pub(super) fn met(
        &self,
        listed: &[SurfaceId],
        origin: Origin,
        network: &Network,
        tolerance: &Tolerance,
        job: &Job,
    ) -> Result<Vec<TouchingPair>> {
        let pairs = self.near_pairs(listed, tolerance);
        par::try_map(pairs.len(), |k| {
            job.go_on()?;
            let (pair, shared) = &pairs[k];
            let surface = |s: SurfaceId| &self.surfaces[s.index()].surface;
            let (a, b) = (surface(pair.0), surface(pair.1));
            let none = || Ok(TouchingPair { pair: *pair, curves: Vec::new() });
            let found = match with_surfaces(std::slice::from_ref(a), std::slice::from_ref(b), origin, tolerance) {
                Ok(common) => common.curves,
                Err(fault) if fault.code().0 == COINCIDE => return none(),
                // Faces that go on smoothly over a shared edge run along each other beside it: their borders tell where they cross.
                Err(fault) if !shared.is_empty() && fault.code().0 == LOST => return none(),
                Err(fault) => return Err(fault),
            };
            let mut ways = Vec::new();
            for edge in shared {
                ways.extend(self.edge_chain(*edge, network, tolerance)?);
            }
            let mut curves = Vec::new();
            for curve in found {
                curves.extend(beside(&curve, &ways, tolerance)?);
            }
            Ok(TouchingPair { pair: *pair, curves })
        })
    }

    /// Pairs of surfaces whose boxes touch, in the order of the list, with the edges that they share.
    fn near_pairs(&self, listed: &[SurfaceId], tolerance: &Tolerance) -> Vec<((SurfaceId, SurfaceId), Vec<EdgeId>)> {
        let boxes: Vec<_> = listed.iter().map(|s| self.surfaces[s.index()].surface.hull()).collect();
        let mut joined: BTreeMap<(SurfaceId, SurfaceId), Vec<EdgeId>> = BTreeMap::new();
        for (n, edge) in self.edges.iter().enumerate() {
            let users: BTreeSet<SurfaceId> = edge.users.iter().map(|(p, _)| self.patches[p.index()].surface).collect();
            for (a, b) in users.iter().flat_map(|a| users.iter().map(move |b| (*a, *b))) {
                joined.entry((a, b)).or_default().push(EdgeId::at(n));
            }
        }
        let pairs = BoxTree::build(&boxes).pairs(tolerance.point, PAIR);
        let pairs = pairs.into_iter().map(|(a, b)| (listed[a as usize], listed[b as usize])).filter(|(a, b)| a != b);
        pairs.map(|pair| (pair, joined.get(&pair).cloned().unwrap_or_default())).collect()
    }

    /// Edges of a surface.
    pub(super) fn sides_of(&self, surface: SurfaceId) -> Vec<EdgeId> {
        self.edges_of(&self.patches_of(surface).collect::<Vec<_>>())
    }
}
