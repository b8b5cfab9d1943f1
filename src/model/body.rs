//! Faces with the edges that they share, as boundary representations have them: every edge ends where another one begins, and a face
//! has loops of edges, each with its direction.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::glue::{join, root};
use super::measure;
use super::shared::EdgePart;
use super::sides::Component;
use super::topology::{Model, PatchId, Shell, SurfaceId};
use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::job;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::network::Network;
use crate::surface::{Domain, Side, Surface};

/// An edge of a body.
#[derive(Clone, Debug)]
pub struct BodyEdge {
    /// The part of an edge of the model that gives its geometry, in its own direction.
    pub part: EdgePart,
    /// First and last vertex, as places in the list of the body.
    pub ends: (usize, usize),
    /// The patch of which it is a seam put together from several edges of the model.
    pub seam: Option<PatchId>,
}

/// One loop round a face, the face on its left seen against its normal: edges in order, `true` where it runs against one.
pub type BodyLoop = Vec<(usize, bool)>;

/// A smooth face of a body.
#[derive(Clone, Debug)]
pub struct BodyFace {
    /// The patch that it is.
    pub patch: PatchId,
    /// Its surface.
    pub surface: SurfaceId,
    /// The body shows the other side of the surface.
    pub other: bool,
    /// The outer loop first.
    pub loops: Vec<BodyLoop>,
}

/// Faces that hang together.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Places of its faces in the list of the body.
    pub faces: Vec<usize>,
    /// Every edge is used twice, once each way.
    pub closed: bool,
    /// The closed skin, by its place in the list, round the material that this one bounds from inside.
    pub within: Option<usize>,
}

/// Faces with their edges and vertices.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// Corners, model units.
    pub vertices: Vec<DVec3>,
    /// Edges.
    pub edges: Vec<BodyEdge>,
    /// Faces in the order of the surfaces.
    pub faces: Vec<BodyFace>,
    /// What hangs together, in the order of their first faces.
    pub skins: Vec<Skin>,
    /// Patches that have no face: thinner than the distance within which edges are one.
    pub slivers: Vec<PatchId>,
}

impl Model {
    /// The faces of a shell with the edges they share, cut where an edge of one ends inside that of another one.
    ///
    /// Fails with E413 where it cannot be told whether one closed skin lies inside another one.
    pub fn body(&self, shell: &Shell, network: &Network, tolerance: &Tolerance) -> Result<Body> {
        let members: BTreeSet<SurfaceId> = shell.surfaces.iter().map(|s| s.0).collect();
        let joins = self.joins(&members, shell.near, network, tolerance);
        let slivers = self.slivers(&members, &joins, shell.near);
        let mut body = Body { vertices: joins.pieces.junctions.clone(), ..Body::default() };
        body.edges.extend(joins.pieces.segments.iter().map(|segment| BodyEdge {
            part: EdgePart { edge: joins.edges[segment.track], s: segment.s, against: false },
            ends: segment.ends,
            seam: None,
        }));
        for (surface, other) in &shell.surfaces {
            for patch in self.patches_of(*surface).filter(|p| slivers.binary_search(p).is_err()) {
                job::poll();
                let mut loops = Vec::new();
                for sides in self.sides_by_loop(patch) {
                    let mut around = BodyLoop::new();
                    for (edge, against) in sides {
                        let Ok(track) = joins.edges.binary_search(&edge) else { continue };
                        let uses = &joins.pieces.of_track[track];
                        let step = |u: &super::segments::SegmentUse| (u.segment, u.against != against);
                        if against { around.extend(uses.iter().rev().map(step)) } else { around.extend(uses.iter().map(step)) }
                    }
                    if *other {
                        around.reverse();
                        around.iter_mut().for_each(|step| step.1 = !step.1);
                    }
                    if !around.is_empty() {
                        loops.push(around);
                    }
                }
                body.faces.push(BodyFace { patch, surface: *surface, other: *other, loops });
            }
        }
        body.slivers = slivers;
        body.join_corners();
        body.join_seams(self, tolerance);
        body.part_skins(shell.closed);
        self.nest(&mut body, tolerance)?;
        Ok(body)
    }

    /// Edges along the border of a patch, loop by loop, each with whether its loop runs against it.
    fn sides_by_loop(&self, patch: PatchId) -> Vec<Vec<(super::topology::EdgeId, bool)>> {
        let record = &self.patches[patch.index()];
        let surface = &self.surfaces[record.surface.index()].surface;
        let counts = if surface.domain() == Domain::Loop { surface.loops() } else { vec![record.sides.len()] };
        let mut first = 0;
        let of_loop = |n: usize| {
            let range = first..first + n;
            first += n;
            let mut around = Vec::new();
            for (k, side) in range.clone().zip(&record.sides[range]) {
                if self.runs_back(record, k) {
                    around.extend(side.edges.iter().rev().map(|(edge, against)| (*edge, !against)));
                } else {
                    around.extend(side.edges.iter().copied());
                }
            }
            around
        };
        counts.into_iter().map(of_loop).collect()
    }

    /// The line of a surface along which a seam of it runs, from one point to another; `None` where no side of it ends there.
    pub fn seam_curve(&self, patch: PatchId, ends: (DVec3, DVec3), tolerance: &Tolerance) -> Result<Option<Curve>> {
        let surface = &self.surfaces[self.patches[patch.index()].surface.index()].surface;
        for side in (0..surface.n_sides()).map(|k| surface.side(k)) {
            let Side::Chain { chain, from, to } = side else { continue };
            let curve = chain.slice(from.min(to), from.max(to), tolerance)?.to_curve()?;
            let near = |a: DVec3, b: DVec3| a.distance(b) <= tolerance.point;
            match [(curve.start(), curve.end()), (curve.end(), curve.start())].map(|(a, b)| near(a, ends.0) && near(b, ends.1)) {
                [true, false] => return Ok(Some(curve)),
                [false, true] => return Ok(Some(curve.reversed())),
                _ => {}
            }
        }
        Ok(None)
    }

    /// The curve along an edge of a body; `None` for a line across a trimmed surface that follows neither u nor v.
    pub fn part_curve(&self, part: &EdgePart, network: &Network, tolerance: &Tolerance) -> Result<Option<Curve>> {
        let length = self.edges[part.edge.index()].length;
        let Some(chain) = self.edge_chain(part.edge, network, tolerance)? else { return Ok(None) };
        let whole = part.s.0 <= 0.0 && part.s.1 >= length;
        let chain = if whole { chain } else { chain.slice(part.s.0 / length, (part.s.1 / length).min(1.0), tolerance)? };
        let curve = chain.to_curve()?;
        Ok(Some(if part.against { curve.reversed() } else { curve }))
    }

    /// Which closed skins bound material of others from inside.
    fn nest(&self, body: &mut Body, tolerance: &Tolerance) -> Result<()> {
        let closed: Vec<usize> = (0..body.skins.len()).filter(|k| body.skins[*k].closed).collect();
        if closed.len() < 2 {
            return Ok(());
        }
        let component = |k: usize| {
            let mut faces: Vec<(SurfaceId, bool)> =
                body.skins[k].faces.iter().map(|f| (body.faces[*f].surface, body.faces[*f].other)).collect();
            faces.dedup();
            Component { faces, closed: true, one_sided: None }
        };
        let components: BTreeMap<usize, Component> = closed.iter().map(|k| (*k, component(*k))).collect();
        let shown = |c: &Component| {
            c.faces.iter().map(|(id, other)| (self.surfaces[id.index()].surface.clone(), *other)).collect::<Vec<(Surface, bool)>>()
        };
        let inwards: Vec<usize> =
            closed.iter().copied().filter(|k| measure::points_inwards(&shown(&components[k])) == Some(true)).collect();
        let size = |k: usize| shown(&components[&k]).iter().fold(Box3::EMPTY, |all, (s, _)| all.union(s.hull())).diagonal();
        for k in &inwards {
            let mut holder: Option<(f64, usize)> = None;
            for j in closed.iter().filter(|j| !inwards.contains(j)) {
                if self.holds(&components[j], &components[k], tolerance)? {
                    let found = (size(*j), *j);
                    holder = Some(holder.map_or(found, |known| if found.0 < known.0 { found } else { known }));
                }
            }
            body.skins[*k].within = holder.map(|h| h.1);
        }
        Ok(())
    }
}

impl Body {
    /// Whether each edge of a loop begins at the vertex where the one before it ends.
    pub fn is_closed(&self, around: &BodyLoop) -> bool {
        let ends = |k: usize| self.ends(around[k].0, around[k].1);
        (0..around.len()).all(|k| ends(k).1 == ends((k + 1) % around.len()).0)
    }

    /// Makes one vertex of the ends of consecutive edges that are apart, as on surfaces through curves that miss each other. They stay
    /// apart where one of the two edges is not more than twice as long as the gap.
    fn join_corners(&mut self) {
        let mut parent: Vec<usize> = (0..self.vertices.len()).collect();
        let length = |edge: usize| self.edges[edge].part.s.1 - self.edges[edge].part.s.0;
        for around in self.faces.iter().flat_map(|face| &face.loops) {
            for k in 0..around.len() {
                let (step, next) = (around[k], around[(k + 1) % around.len()]);
                let (a, b) = (self.ends(step.0, step.1).1, self.ends(next.0, next.1).0);
                if a != b && 2.0 * self.vertices[a].distance(self.vertices[b]) < length(step.0).min(length(next.0)) {
                    join(&mut parent, a, b);
                }
            }
        }
        let roots: Vec<usize> = (0..parent.len()).map(|k| root(&mut parent, k)).collect();
        let mut sums = vec![(DVec3::ZERO, 0.0); roots.len()];
        for (to, point) in roots.iter().zip(&self.vertices) {
            sums[*to].0 += *point;
            sums[*to].1 += 1.0;
        }
        for (k, to) in roots.iter().enumerate().filter(|(k, to)| sums[**to].1 > 1.0 || *k != **to) {
            self.vertices[k] = sums[*to].0 / sums[*to].1;
        }
        self.edges.iter_mut().for_each(|edge| edge.ends = (roots[edge.ends.0], roots[edge.ends.1]));
    }

    /// Makes one edge of consecutive ones between which nothing else ends, where only one face uses them, there and back: a seam between
    /// two poles is then one edge, however many curves of the model part it. Surfaces of several pieces keep the edges of each.
    fn join_seams(&mut self, model: &Model, tolerance: &Tolerance) {
        let in_one_piece = |face: &BodyFace| {
            let (us, vs) = model.surfaces[face.surface.index()].surface.breaks();
            us.is_empty() && vs.is_empty()
        };
        let mut users: Vec<Vec<(usize, bool)>> = vec![Vec::new(); self.edges.len()];
        for (k, face) in self.faces.iter().enumerate() {
            face.loops.iter().flatten().for_each(|(edge, against)| users[*edge].push((k, *against)));
        }
        let mut at: Vec<Vec<usize>> = vec![Vec::new(); self.vertices.len()];
        for (k, edge) in self.edges.iter().enumerate().filter(|(k, _)| !users[*k].is_empty()) {
            at[edge.ends.0].push(k);
            at[edge.ends.1].push(k);
        }
        let seam = |k: usize| matches!(users[k].as_slice(), [a, b] if a.0 == b.0 && a.1 != b.1).then(|| users[k][0].0);
        let follows = |a: usize, b: usize| {
            let (before, after) = (&self.edges[a].part, &self.edges[b].part);
            let goes_on = before.edge == after.edge && (after.s.0 - before.s.1).abs() <= tolerance.point;
            let one = a != b && self.edges[a].ends.1 == self.edges[b].ends.0 && goes_on && seam(a) == seam(b);
            one && seam(a).is_some_and(|face| in_one_piece(&self.faces[face]))
        };
        let mut next = vec![None; self.edges.len()];
        let mut has_one_before = vec![false; self.edges.len()];
        for pair in &at {
            let [a, b] = *pair.as_slice() else { continue };
            for (a, b) in [(a, b), (b, a)].into_iter().filter(|(a, b)| follows(*a, *b)) {
                (next[a], has_one_before[b]) = (Some(b), true);
            }
        }
        let mut gone = vec![false; self.edges.len()];
        for first in (0..self.edges.len()).filter(|k| next[*k].is_some() && !has_one_before[*k]) {
            let mut last = first;
            while let Some(k) = next[last] {
                gone[k] = true;
                last = k;
            }
            let (s, end) = (self.edges[last].part.s.1, self.edges[last].ends.1);
            let patch = users[first].first().map(|(face, _)| self.faces[*face].patch);
            let edge = &mut self.edges[first];
            (edge.part.s.1, edge.ends.1, edge.seam) = (s, end, patch);
        }
        self.faces.iter_mut().flat_map(|face| &mut face.loops).for_each(|around| around.retain(|step| !gone[step.0]));
    }

    /// First and last vertex of an edge, run in its direction or against it.
    fn ends(&self, edge: usize, against: bool) -> (usize, usize) {
        let (first, last) = self.edges[edge].ends;
        if against { (last, first) } else { (first, last) }
    }

    /// Parts the faces into what hangs together by edges that two of them share; of a closed shell, which may touch itself, by all edges.
    fn part_skins(&mut self, closed: bool) {
        let mut users: Vec<Vec<(usize, bool)>> = vec![Vec::new(); self.edges.len()];
        for (k, face) in self.faces.iter().enumerate() {
            face.loops.iter().flatten().for_each(|(edge, against)| users[*edge].push((k, *against)));
        }
        let mut parent: Vec<usize> = (0..self.faces.len()).collect();
        for users in users.iter().filter(|u| u.len() == 2 || closed) {
            users.windows(2).for_each(|pair| join(&mut parent, pair[0].0, pair[1].0));
        }
        let mut skins: BTreeMap<usize, Skin> = BTreeMap::new();
        for k in 0..self.faces.len() {
            let own = root(&mut parent, k);
            skins.entry(own).or_insert_with(|| Skin { faces: Vec::new(), closed: true, within: None }).faces.push(k);
        }
        let is_inner = |users: &[(usize, bool)]| {
            (users.len() == 2 || closed) && 2 * users.iter().filter(|(_, against)| *against).count() == users.len()
        };
        for (face, _) in users.iter().filter(|u| !is_inner(u)).flatten() {
            if let Some(skin) = skins.get_mut(&root(&mut parent, *face)) {
                skin.closed = false;
            }
        }
        self.skins = skins.into_values().collect();
    }
}
