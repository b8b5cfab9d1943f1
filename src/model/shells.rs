//! Shells: surfaces as one skin, connected and oriented [Koh & Park 1990, §4.3].

use crate::model::fault::ShellFault;
use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::around_edge::Paired;
use super::gather::Station;
use super::glue::preference;
use super::segments::{Part, Segments, segments};
use super::sew::Seams;
use super::sides::{Component, Usage, components, usages};
use super::topology::{EdgeId, Model, PatchId, Shell, SurfaceId};
use super::trace::Track;
use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{SNAP_SHARE, Tolerance};
use crate::network::Network;

/// Edges of some surfaces as tracks, and their segments.
pub(super) struct Joins {
    /// The edges, ascending; tracks and their uses of segments come in this order.
    pub edges: Vec<EdgeId>,
    pub parts: Vec<Part>,
    pub pieces: Segments,
}

/// Surfaces with their edges joined.
pub(super) struct Sewn {
    /// How far borders that are one edge may be apart, model units.
    pub near: f64,
    pub joins: Joins,
    /// Patches thinner than that, ascending.
    pub slivers: Vec<PatchId>,
    /// Who uses each segment of the edges; slivers do not.
    pub usages: Vec<Vec<Usage>>,
}

impl Joins {
    /// The point in the middle of a segment.
    pub fn middle(&self, segment: usize) -> DVec3 {
        let segment = &self.pieces.segments[segment];
        self.parts[segment.track].track.point(0.5 * (segment.s.0 + segment.s.1))
    }
}

impl Model {
    /// A shell of surfaces, oriented so that neighbours use an edge in opposite senses; free edges are a note.
    ///
    /// Segments that a long side shares with several shorter ones count as joined. A closed shell points out of the material,
    /// in several skins where it has cavities or lies in pieces; in an open one the first surface of the list keeps its side. Borders up to [`Model::reach`] apart are one edge; what that moved is a note. Fails with E616 (one-sided),
    /// E617 (three faces at an edge), E618 (open and not connected) or E711 (borders just beyond a stated reach).
    pub fn shell(&self, request: &ShellRequest, network: &Network, tolerance: &Tolerance, sink: &mut Vec<Fault>) -> Result<Shell> {
        let members: BTreeSet<SurfaceId> = request.surfaces.iter().copied().collect();
        let sewn = self.sewn(request, &members, network, tolerance);
        let Sewn { near, joins, slivers, usages } = &sewn;
        let paired = request.touches.then(|| self.paired(joins, usages));
        let pieces = &joins.pieces;
        let free: Vec<usize> = (0..usages.len()).filter(|a| usages[*a].len() == 1).collect();
        let seams = Seams { model: self, joins };
        seams.refuse_gaps(request, &free)?;
        if !request.branches {
            self.manifold(request, &sewn, paired.as_ref())?;
        }
        let sides = self.orient(request, &sewn, paired.as_ref(), tolerance, sink)?;
        seams.report(request, slivers, tolerance, sink);
        if let Some(longest) = free.iter().copied().max_by(|a, b| pieces.segments[*a].length().total_cmp(&pieces.segments[*b].length())) {
            let length = free.iter().map(|a| pieces.segments[*a].length()).sum();
            let at = joins.middle(longest);
            sink.push(ShellFault::Open { shell: request.origin, edges: free.len(), length, at }.into());
        }
        let mut free: Vec<_> =
            free.iter().flat_map(|a| usages[*a].iter().map(|(s, _)| (*s, joins.middle(*a), pieces.segments[*a].length()))).collect();
        free.sort_by(|a, b| b.2.total_cmp(&a.2));
        Ok(Shell {
            name: request.name.clone(),
            origin: request.origin,
            surfaces: sides,
            near: *near,
            closed: free.is_empty() && paired.as_ref().map_or(usages, |paired| &paired.usages).iter().all(|u| u.len() <= 2),
            free,
        })
    }

    /// The edges of a shell, joined over [`Model::reach`], or where nothing is stated and every edge finds its other face within the widest
    /// gap of one face's borders, over that alone: what is small beside a wide gap then stays.
    fn sewn(&self, request: &ShellRequest, members: &BTreeSet<SurfaceId>, network: &Network, tolerance: &Tolerance) -> Sewn {
        let most = self.reach(members.iter().copied(), request.snap.map(|s| s.0), tolerance);
        let least = self.own_gap(members.iter().copied()).max(tolerance.point);
        if request.snap.is_none() && least < most {
            let sewn = self.sewn_over(members, least, network, tolerance);
            let joins = |n: usize| matches!(n, 0 | 2) || request.touches && n.is_multiple_of(2);
            if sewn.usages.iter().all(|users| joins(users.len())) {
                return sewn;
            }
        }
        self.sewn_over(members, most, network, tolerance)
    }

    /// Edges of some surfaces, joined where their borders are up to `near` apart, model units.
    pub(super) fn sewn_over(&self, members: &BTreeSet<SurfaceId>, near: f64, network: &Network, tolerance: &Tolerance) -> Sewn {
        let joins = self.joins(members, near, network, tolerance);
        let slivers = self.slivers(members, &joins, near);
        let usages = usages(self, &joins, |s, p| members.contains(&s) && slivers.binary_search(&p).is_err());
        Sewn { near, joins, slivers, usages }
    }

    /// Edges of some surfaces, cut into segments; borders up to `near` apart are one.
    pub(super) fn joins(&self, members: &BTreeSet<SurfaceId>, near: f64, network: &Network, tolerance: &Tolerance) -> Joins {
        let edges: Vec<EdgeId> = (0..self.edges.len())
            .map(EdgeId::at)
            .filter(|e| self.edges[e.index()].users.iter().any(|(p, _)| members.contains(&self.patches[p.index()].surface)))
            .collect();
        let parts: Vec<Part> = edges
            .iter()
            .map(|e| {
                let curve = &self.edges[e.index()].curve;
                let track = Track::of(curve, &self.surfaces, network);
                Part { cuts: track.joints(tolerance), track, rank: preference(curve), near }
            })
            .collect();
        let anchors: Vec<_> = edges
            .iter()
            .flat_map(|e| {
                let ends = self.edges[e.index()].vertices;
                [ends.0, ends.1].map(|v| Station { point: self.vertices[v.index()].point, reach: near })
            })
            .collect();
        let pieces = segments(&parts, &anchors, tolerance);
        Joins { edges, parts, pieces }
    }

    /// Patches of some surfaces that are thinner than what was glued, ascending.
    pub(super) fn slivers(&self, members: &BTreeSet<SurfaceId>, joins: &Joins, near: f64) -> Vec<PatchId> {
        let mut found: Vec<PatchId> = members.iter().flat_map(|s| self.patches_of(*s)).collect();
        found.retain(|p| self.is_sliver(*p, &joins.edges, &joins.pieces, near));
        found.sort_unstable();
        found
    }

    pub(super) fn origin_of(&self, surface: SurfaceId) -> Origin {
        self.surfaces[surface.index()].surface.origin()
    }

    /// E617 where more than two faces share a segment.
    fn manifold(&self, request: &ShellRequest, sewn: &Sewn, paired: Option<&Paired>) -> Result<()> {
        let Sewn { joins, usages, .. } = sewn;
        for (segment, users) in usages.iter().enumerate() {
            if users.len() > 2 && paired.is_none_or(|paired| paired.has_more_than_two(segment)) {
                let at = joins.middle(segment);
                let users = users.iter().map(|(s, _)| self.origin_of(*s)).collect();
                return Err(ShellFault::NonManifold { shell: request.origin, users, at }.into());
            }
        }
        Ok(())
    }

    /// Each surface with its side: `true` for the other one. E616 for a skin with one side, E618 for open ones that do not hang together.
    fn orient(
        &self,
        request: &ShellRequest,
        sewn: &Sewn,
        paired: Option<&Paired>,
        tolerance: &Tolerance,
        sink: &mut Vec<Fault>,
    ) -> Result<Vec<(SurfaceId, bool)>> {
        let whole: Vec<SurfaceId> = request.surfaces.iter().copied().filter(|s| !self.is_thin(*s, &sewn.slivers)).collect();
        let mut components = components(&whole, paired.map_or(&sewn.usages, |paired| &paired.usages));
        if let Some(one_sided) = components.iter().find_map(|c| c.one_sided.as_ref()) {
            let (a, b) = (self.origin_of(one_sided.faces.0), self.origin_of(one_sided.faces.1));
            let at = sewn.joins.middle(paired.map_or(one_sided.segment, |paired| paired.segments[one_sided.segment]));
            return Err(ShellFault::NotOrientable { shell: request.origin, a, b, at }.into());
        }
        match components.as_slice() {
            [first, others @ ..] if !others.is_empty() => {
                // Skins that close may lie apart or inside each other; an open one is all of its shell.
                if let Some(apart) = others.iter().find(|c| !(request.branches || first.closed && c.closed)) {
                    return Err(self.not_connected(request, first, apart));
                }
                if !request.branches {
                    self.report_touching(request, &components, tolerance, sink)?;
                }
                let (mut closed, open): (Vec<Component>, Vec<_>) = components.into_iter().partition(|c| c.closed);
                self.turn_outwards(&mut closed, tolerance)?;
                components = closed.into_iter().chain(open).collect();
            }
            [only] if only.closed => self.turn_outwards(&mut components, tolerance)?,
            _ => {}
        }
        // What became an edge has no side.
        let sides: BTreeMap<SurfaceId, bool> = components.into_iter().flat_map(|c| c.faces).collect();
        Ok(request.surfaces.iter().map(|s| (*s, sides.get(s).copied().unwrap_or(false))).collect())
    }

    /// Whether nothing of a surface is left beside edges.
    pub(super) fn is_thin(&self, surface: SurfaceId, slivers: &[PatchId]) -> bool {
        self.patches_of(surface).all(|p| slivers.binary_search(&p).is_ok())
    }

    /// E618 with where two components come nearest.
    fn not_connected(&self, request: &ShellRequest, first: &Component, apart: &Component) -> Fault {
        let ids = |c: &Component| c.faces.iter().map(|f| f.0).collect::<Vec<_>>();
        let (joined, apart) = (ids(first), ids(apart));
        let found = self.apart(&joined, &apart);
        let (a, b, gap, at) = found.map_or((joined[0], apart[0], 0.0, DVec3::ZERO), |f| (f.surfaces.0, f.surfaces.1, f.gap, f.at));
        let smaller = [a, b].map(|s| self.surfaces[s.index()].surface.hull().diagonal()).into_iter().fold(f64::INFINITY, f64::min);
        let near = gap > 0.0 && gap <= SNAP_SHARE * smaller;
        ShellFault::NotAdjacent { a: self.origin_of(a), b: self.origin_of(b), gap, at, near, snap: request.snap }.into()
    }
}

/// What a shell is made of.
#[derive(Clone, Debug)]
pub struct ShellRequest {
    /// Name as declared.
    pub name: String,
    /// Its surfaces, each once.
    pub surfaces: Vec<SurfaceId>,
    /// How far apart borders may be and still be one edge, model units, with the expression that says so.
    pub snap: Option<(f64, Origin)>,
    /// More than two faces may share an edge, and pieces may lie apart.
    pub branches: bool,
    /// They bound a solid, which may touch itself along edges and at vertices.
    pub touches: bool,
    /// The declaration.
    pub origin: Origin,
}
