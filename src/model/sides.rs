//! Which side of each face a skin shows: faces at an edge use it in opposite senses, and what closes points outwards.

use std::collections::{BTreeMap, BTreeSet};

use super::glue::root;
use super::shells::Joins;
use super::topology::{Model, PatchId, SurfaceId};
use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;
use crate::network::Network;

/// One use of a segment by a surface: `true` where the surface's loop runs against the segment.
pub(super) type Usage = (SurfaceId, bool);

/// Two faces that cannot agree on a side, and the segment between them.
pub(super) struct OneSided {
    pub faces: (SurfaceId, SurfaceId),
    pub segment: usize,
}

/// Faces that hang together by edges that two of them share.
pub(super) struct Component {
    /// The faces, each with `true` where its other side is shown; the first one listed shows its own.
    pub faces: Vec<(SurfaceId, bool)>,
    /// Every edge of them is used twice.
    pub closed: bool,
    /// Where it has only one side.
    pub one_sided: Option<OneSided>,
}

/// The uses of each segment, in the order of the edges.
pub(super) fn usages(model: &Model, joins: &Joins, is_member: impl Fn(SurfaceId, PatchId) -> bool) -> Vec<Vec<Usage>> {
    let mut usages: Vec<Vec<Usage>> = vec![Vec::new(); joins.pieces.segments.len()];
    for (edge, uses) in joins.edges.iter().zip(&joins.pieces.of_track) {
        for (patch, against) in &model.edges[edge.index()].users {
            let surface = model.patches[patch.index()].surface;
            if is_member(surface, *patch) {
                uses.iter().for_each(|u| usages[u.segment].push((surface, *against != u.against)));
            }
        }
    }
    usages
}

/// Components of some faces, in the order of their first ones. A segment that more than two faces use joins none of them.
pub(super) fn components(listed: &[SurfaceId], usages: &[Vec<Usage>]) -> Vec<Component> {
    let count = listed.iter().map(|s| s.index() + 1).max().unwrap_or(0);
    let mut neighbours: Vec<Vec<(SurfaceId, bool, usize)>> = vec![Vec::new(); count];
    let mut parent: Vec<usize> = (0..count).collect();
    let mut open = vec![false; count];
    for (segment, users) in usages.iter().enumerate() {
        if let [a, b] = users.as_slice() {
            // Used in the same sense, one of the two must be turned.
            let turned = a.1 == b.1;
            neighbours[a.0.index()].push((b.0, turned, segment));
            neighbours[b.0.index()].push((a.0, turned, segment));
            let (ra, rb) = (root(&mut parent, a.0.index()), root(&mut parent, b.0.index()));
            parent[ra.max(rb)] = ra.min(rb);
        } else {
            users.iter().for_each(|(s, _)| open[s.index()] = true);
        }
    }
    let mut found: Vec<Component> = Vec::new();
    let mut sides: Vec<Option<bool>> = vec![None; count];
    for &first in listed {
        if sides[first.index()].is_some() {
            continue;
        }
        let one_sided = spread(first, &neighbours, &mut sides);
        let own = root(&mut parent, first.index());
        let members: Vec<SurfaceId> = listed.iter().copied().filter(|s| root(&mut parent, s.index()) == own).collect();
        let closed = members.iter().all(|s| !open[s.index()]);
        let faces = members.into_iter().map(|s| (s, sides[s.index()].unwrap_or(false))).collect();
        found.push(Component { faces, closed, one_sided });
    }
    found
}

/// Gives a side to all that hangs together with a face, which shows its own; where two faces do not agree.
fn spread(first: SurfaceId, neighbours: &[Vec<(SurfaceId, bool, usize)>], sides: &mut [Option<bool>]) -> Option<OneSided> {
    sides[first.index()] = Some(false);
    let (mut open, mut one_sided) = (vec![first], None);
    while let Some(surface) = open.pop() {
        let own = sides[surface.index()].unwrap_or(false);
        for &(other, turned, segment) in &neighbours[surface.index()] {
            match sides[other.index()] {
                None => {
                    sides[other.index()] = Some(own != turned);
                    open.push(other);
                }
                Some(side) if side != (own != turned) => {
                    one_sided.get_or_insert(OneSided { faces: (surface, other), segment });
                }
                Some(_) => {}
            }
        }
    }
    one_sided
}

impl Model {
    /// Faces of a list with the sides that they show together: those that close to a skin point out of what they enclose, out of the
    /// material where one skin lies inside another one; all others stay as they are, but for open ones of `unsewn` faces alone: these show
    /// one side, that of most of them. Borders up to `near` apart are one edge.
    ///
    /// Fails with E413 where it cannot be told whether one skin lies inside another one.
    pub fn outward(
        &self,
        listed: &[(SurfaceId, bool)],
        unsewn: &BTreeSet<SurfaceId>,
        near: f64,
        network: &Network,
        tolerance: &Tolerance,
    ) -> Result<Vec<(SurfaceId, bool)>> {
        let members = listed.iter().map(|s| s.0).collect();
        let sewn = self.sewn_over(&members, near, network, tolerance);
        let whole: Vec<SurfaceId> = members.iter().copied().filter(|s| !self.is_thin(*s, &sewn.slivers)).collect();
        let mut components = components(&whole, &sewn.usages);
        components.retain(|c| c.one_sided.is_none());
        let (mut closed, mut open): (Vec<Component>, Vec<Component>) = components.into_iter().partition(|c| c.closed);
        self.turn_outwards(&mut closed, tolerance)?;
        open.retain(|c| c.faces.iter().all(|(surface, _)| unsewn.contains(surface)));
        let given: BTreeMap<SurfaceId, bool> = listed.iter().copied().collect();
        for faces in open.iter_mut().map(|c| &mut c.faces) {
            let against = faces.iter().filter(|(surface, other)| given.get(surface) != Some(other)).count();
            if 2 * against > faces.len() {
                faces.iter_mut().for_each(|(_, other)| *other = !*other);
            }
        }
        let sides: BTreeMap<SurfaceId, bool> = closed.into_iter().chain(open).flat_map(|c| c.faces).collect();
        Ok(listed.iter().map(|(surface, own)| (*surface, sides.get(surface).copied().unwrap_or(*own))).collect())
    }
}
