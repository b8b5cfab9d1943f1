//! Shells: surfaces as one skin, connected and oriented [Koh & Park 1990, §4.3].

use std::collections::BTreeSet;

use glam::DVec3;

use super::atoms::{Atoms, Part, atoms};
use super::gather::Station;
use super::glue::{preference, root};
use super::sew::Seams;
use super::topology::{EdgeId, Model, PatchId, Shell, SurfaceId};
use super::trace::Track;
use crate::base::fault::{Fault, Result, SurfaceFault};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Network;

/// Edges of a shell as tracks, and their atoms.
pub(super) struct Joins {
    pub parts: Vec<Part>,
    pub pieces: Atoms,
}

impl Joins {
    /// The point in the middle of an atom.
    pub fn middle(&self, atom: usize) -> DVec3 {
        let atom = &self.pieces.atoms[atom];
        self.parts[atom.track].track.point(0.5 * (atom.s.0 + atom.s.1))
    }
}

/// One use of an atom by a surface: `true` where the surface's loop runs against the atom.
type Usage = (SurfaceId, bool);

impl Model {
    /// A shell of surfaces: connected, oriented so that neighbours use an edge in opposite senses; free edges are a note.
    ///
    /// Stretches that a long side shares with several shorter ones count as joined. The first surface of the list keeps
    /// its side. Borders up to [`Model::reach`] apart are one edge; what that moved is a note. Fails with E616 (one-sided),
    /// E617 (three faces at an edge), E618 (not connected) or E711 (borders just beyond a stated reach).
    pub fn shell(&self, request: &ShellRequest, network: &Network, tolerance: &Tolerance, sink: &mut Vec<Fault>) -> Result<Shell> {
        let members: BTreeSet<SurfaceId> = request.surfaces.iter().copied().collect();
        let near = self.reach(members.iter().copied(), request.snap.map(|s| s.0), tolerance);
        let (edges, joins) = self.joins(&members, near, network, tolerance);
        let pieces = &joins.pieces;
        let slivers = self.slivers(&members, (&edges, pieces), near);
        let mut usages: Vec<Vec<Usage>> = vec![Vec::new(); pieces.atoms.len()];
        for (edge, uses) in edges.iter().zip(&pieces.of_track) {
            for (patch, against) in &self.edges[edge.index()].users {
                let surface = self.patches[patch.index()].surface;
                if members.contains(&surface) && slivers.binary_search(patch).is_err() {
                    uses.iter().for_each(|u| usages[u.atom].push((surface, *against != u.against)));
                }
            }
        }
        let free: Vec<usize> = (0..usages.len()).filter(|a| usages[*a].len() == 1).collect();
        let seams = Seams { model: self, edges: &edges, joins: &joins };
        seams.refuse_gaps(request, &free)?;
        self.manifold(request, &joins, &usages)?;
        let sides = self.orient(request, &joins, (&usages, &slivers))?;
        seams.tell(request, &slivers, tolerance, sink);
        if let Some(longest) = free.iter().copied().max_by(|a, b| pieces.atoms[*a].length().total_cmp(&pieces.atoms[*b].length())) {
            let length = free.iter().map(|a| pieces.atoms[*a].length()).sum();
            let at = joins.middle(longest);
            sink.push(SurfaceFault::ShellOpen { shell: request.origin, edges: free.len(), length, at }.into());
        }
        let surfaces = request.surfaces.iter().map(|s| (*s, sides[s.index()].unwrap_or(false))).collect();
        let mut free: Vec<_> =
            free.iter().flat_map(|a| usages[*a].iter().map(|(s, _)| (*s, joins.middle(*a), pieces.atoms[*a].length()))).collect();
        free.sort_by(|a, b| b.2.total_cmp(&a.2));
        Ok(Shell { name: request.name.clone(), origin: request.origin, surfaces, near, closed: free.is_empty(), free })
    }

    /// Edges of some surfaces, cut into atoms; borders up to `near` apart are one.
    pub(super) fn joins(&self, members: &BTreeSet<SurfaceId>, near: f64, network: &Network, tolerance: &Tolerance) -> (Vec<EdgeId>, Joins) {
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
        let pieces = atoms(&parts, &anchors, tolerance);
        (edges, Joins { parts, pieces })
    }

    /// Patches of some surfaces that are thinner than what was glued, ascending.
    fn slivers(&self, members: &BTreeSet<SurfaceId>, (edges, pieces): (&[EdgeId], &Atoms), near: f64) -> Vec<PatchId> {
        let mut found: Vec<PatchId> = members.iter().flat_map(|s| self.patches_of(*s)).collect();
        found.retain(|p| self.is_sliver(*p, (edges, pieces), near));
        found.sort_unstable();
        found
    }

    pub(super) fn origin_of(&self, surface: SurfaceId) -> Origin {
        self.surfaces[surface.index()].surface.origin()
    }

    /// E617 where more than two faces share a stretch.
    fn manifold(&self, request: &ShellRequest, joins: &Joins, usages: &[Vec<Usage>]) -> Result<()> {
        for (atom, users) in usages.iter().enumerate() {
            if users.len() > 2 {
                let at = joins.middle(atom);
                let users = users.iter().map(|(s, _)| self.origin_of(*s)).collect();
                return Err(SurfaceFault::ShellNonManifold { shell: request.origin, users, at }.into());
            }
        }
        Ok(())
    }

    /// Side of each surface of the model: `true` for the other one, `None` for surfaces outside the shell.
    fn orient(&self, request: &ShellRequest, joins: &Joins, (usages, slivers): (&[Vec<Usage>], &[PatchId])) -> Result<Vec<Option<bool>>> {
        let mut sides: Vec<Option<bool>> = vec![None; self.surfaces.len()];
        let mut neighbours: Vec<Vec<(SurfaceId, bool, usize)>> = vec![Vec::new(); self.surfaces.len()];
        let mut parent: Vec<usize> = (0..self.surfaces.len()).collect();
        for (atom, users) in usages.iter().enumerate() {
            if let [a, b] = users.as_slice() {
                // Used in the same sense, one of the two must be turned.
                let turned = a.1 == b.1;
                neighbours[a.0.index()].push((b.0, turned, atom));
                neighbours[b.0.index()].push((a.0, turned, atom));
                let (ra, rb) = (root(&mut parent, a.0.index()), root(&mut parent, b.0.index()));
                parent[ra.max(rb)] = ra.min(rb);
            }
        }
        let whole = |s: &&SurfaceId| self.patches_of(**s).any(|p| slivers.binary_search(&p).is_err());
        let Some(&first) = request.surfaces.iter().find(whole) else {
            return Ok(sides);
        };
        sides[first.index()] = Some(false);
        let mut open = vec![first];
        while let Some(surface) = open.pop() {
            let own = sides[surface.index()].unwrap_or(false);
            for &(other, turned, atom) in &neighbours[surface.index()] {
                match sides[other.index()] {
                    None => {
                        sides[other.index()] = Some(own != turned);
                        open.push(other);
                    }
                    Some(side) if side != (own != turned) => {
                        let at = joins.middle(atom);
                        let (a, b) = (self.origin_of(surface), self.origin_of(other));
                        return Err(SurfaceFault::ShellNotOrientable { shell: request.origin, a, b, at }.into());
                    }
                    Some(_) => {}
                }
            }
        }
        // What became an edge has no side.
        let thin = |s: SurfaceId| self.patches_of(s).all(|p| slivers.binary_search(&p).is_ok());
        request.surfaces.iter().filter(|s| thin(**s)).for_each(|s| sides[s.index()] = Some(false));
        match request.surfaces.iter().find(|s| sides[s.index()].is_none()) {
            None => Ok(sides),
            Some(apart) => Err(self.not_connected(request, &sides, *apart)),
        }
    }

    /// E618 with where the joined part and a surface apart from it come nearest.
    fn not_connected(&self, request: &ShellRequest, sides: &[Option<bool>], apart: SurfaceId) -> Fault {
        let joined: Vec<SurfaceId> = request.surfaces.iter().copied().filter(|s| sides[s.index()].is_some()).collect();
        let found = self.apart(&joined, &[apart]);
        let (a, gap, at) = found.map_or((apart, 0.0, DVec3::ZERO), |f| (f.surfaces.0, f.gap, f.at));
        SurfaceFault::NotAdjacent { a: self.origin_of(a), b: self.origin_of(apart), gap, at }.into()
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
    /// The declaration.
    pub origin: Origin,
}
