//! What makes faces conform that touch: the curves in which they cross, and the points where their borders do.

use std::collections::BTreeSet;

use glam::DVec3;

use super::topology::{EdgeCurve, EdgeId, Model, SurfaceId};
use crate::base::boxtree::BoxTree;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, Network, meet};
use crate::surface::IsoLine;
use crate::surface::meet::with_surfaces;

/// Curves and points that faces have in common beside the edges that they share.
#[derive(Clone, Debug, Default)]
pub struct Imprint {
    /// Curves in which faces cross, within the tolerance of both.
    pub curves: Vec<Chain>,
    /// Points where borders and these curves cross.
    pub points: Vec<DVec3>,
}

crate::content!(Imprint { curves, points });

/// Faces that run along each other have no curve in common: their borders tell where.
const COINCIDE: &str = "E657";

impl Model {
    /// What some surfaces have in common where they share no edge; `origin` is given to the curves.
    ///
    /// Fails with E413 when the work exceeds its limit.
    pub fn imprint(
        &self,
        listed: &[SurfaceId],
        origin: Origin,
        (network, tolerance): (&Network, &Tolerance),
        job: &Job,
    ) -> Result<Imprint> {
        let pairs = self.apart_pairs(listed, tolerance);
        let curves = par::try_map(pairs.len(), |k| {
            job.go_on()?;
            let surface = |s: SurfaceId| std::slice::from_ref(&self.surfaces[s.index()].surface);
            match with_surfaces(surface(pairs[k].0), surface(pairs[k].1), origin, tolerance) {
                Ok(common) => Ok(common.curves),
                Err(fault) if fault.code().0 == COINCIDE => Ok(Vec::new()),
                Err(fault) => Err(fault),
            }
        })?;
        let curves: Vec<Chain> = curves.into_iter().flatten().collect();
        let sides = |s: SurfaceId| self.edges_of(&self.patches_of(s).collect::<Vec<_>>());
        let crossing: BTreeSet<(EdgeId, EdgeId)> = pairs
            .iter()
            .flat_map(|(a, b)| {
                let others = sides(*b);
                sides(*a).into_iter().flat_map(move |x| others.clone().into_iter().map(move |y| (x.min(y), x.max(y))))
            })
            .filter(|(x, y)| x != y)
            .collect();
        let edges: BTreeSet<EdgeId> = crossing.iter().flat_map(|(a, b)| [*a, *b]).collect();
        let edges: Vec<EdgeId> = edges.into_iter().collect();
        let ways = par::try_map(edges.len(), |k| self.ways(edges[k], network, tolerance))?;
        let place = |e: EdgeId| edges.binary_search(&e).unwrap_or_default();
        let mut meetings: Vec<(&Chain, &Chain)> = Vec::new();
        for (a, b) in &crossing {
            meetings.extend(ways[place(*a)].iter().flat_map(|x| ways[place(*b)].iter().map(move |y| (x, y))));
        }
        for (k, curve) in curves.iter().enumerate() {
            meetings.extend(curves[k + 1..].iter().map(|other| (curve, other)));
            meetings.extend(ways.iter().flatten().map(|way| (curve, way)));
        }
        let points = par::try_map(meetings.len(), |k| {
            job.go_on()?;
            let (a, b) = meetings[k];
            let found = meet(a, b, tolerance)?;
            Ok::<_, crate::base::fault::Fault>(
                found.into_iter().flat_map(|m| [Some(m.point), m.shared_to.map(|to| a.point(to.0))]).flatten().collect::<Vec<_>>(),
            )
        })?;
        Ok(Imprint { curves, points: points.into_iter().flatten().collect() })
    }

    /// Pairs of surfaces whose boxes touch and that share no edge, in the order of the list.
    fn apart_pairs(&self, listed: &[SurfaceId], tolerance: &Tolerance) -> Vec<(SurfaceId, SurfaceId)> {
        let boxes: Vec<_> = listed.iter().map(|s| self.surfaces[s.index()].surface.hull()).collect();
        let mut joined: BTreeSet<(SurfaceId, SurfaceId)> = BTreeSet::new();
        for edge in &self.edges {
            let users: Vec<SurfaceId> = edge.users.iter().map(|(p, _)| self.patches[p.index()].surface).collect();
            joined.extend(users.iter().flat_map(|a| users.iter().map(move |b| (*a, *b))));
        }
        let pairs = BoxTree::build(&boxes).pairs(tolerance.point);
        let pairs = pairs.into_iter().map(|(a, b)| (listed[a as usize], listed[b as usize]));
        pairs.filter(|(a, b)| a != b && !joined.contains(&(*a, *b))).collect()
    }

    /// The curves that carry an edge, whole ones also where the edge is a part.
    fn ways(&self, edge: EdgeId, network: &Network, tolerance: &Tolerance) -> Result<Vec<Chain>> {
        Ok(match &self.edges[edge.index()].curve {
            EdgeCurve::Links { links, .. } => links.iter().map(|(link, _)| network.link_chain(*link)).collect(),
            EdgeCurve::Run { chain, .. } => vec![chain.clone()],
            EdgeCurve::Iso { surface, from, to } => {
                let surface = &self.surfaces[surface.index()].surface;
                // A side of a trimmed face that is neither is straight in (u, v); its ends are corners, and no border cuts it.
                let line = match (from.0 == to.0, from.1 == to.1) {
                    (true, _) => IsoLine::U(from.0),
                    (false, true) => IsoLine::V(from.1),
                    _ => return Ok(Vec::new()),
                };
                surface.iso(line, surface.origin(), tolerance)?.iter().map(Chain::of_curve).collect()
            }
        })
    }
}
