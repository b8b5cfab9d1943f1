//! Edges as faces share them: a whole edge of the model, or what became one edge where the faces of a shell were glued.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::shells::Joins;
use super::topology::{EdgeId, Model, PatchId, SurfaceId, VertexId};
use super::trace::Track;
use crate::base::job;
use crate::base::math::compare_points;
use crate::base::tolerance::Tolerance;
use crate::network::Network;

/// A part of an edge of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePart {
    /// The edge.
    pub edge: EdgeId,
    /// Arc lengths on it where the part begins and ends, ascending, model units.
    pub s: (f64, f64),
    /// What is spoken of runs against it.
    pub against: bool,
}

/// Parts of edges one after the other, from the start of what they make up to its end.
pub type Course = Vec<EdgePart>;

/// One edge as some faces see it.
#[derive(Clone, Debug)]
pub struct SharedEdge {
    /// The borders that run there, each over the whole length; the first one is one part and gives the geometry.
    pub courses: Vec<Course>,
    /// Patches on it; one stands there twice at its own seam.
    pub faces: Vec<PatchId>,
    /// First and last vertex.
    pub ends: (VertexId, VertexId),
    /// The edge of the model whose number it has: one that it is the whole of, if any.
    pub named_by: EdgeId,
    /// How far apart the borders that run there may be, model units.
    pub near: f64,
}

impl PartialEq for SharedEdge {
    fn eq(&self, other: &Self) -> bool {
        self.first() == other.first()
    }
}

impl SharedEdge {
    /// The part of the model's edges that gives the geometry.
    pub fn first(&self) -> Option<EdgePart> {
        self.courses.first().and_then(|course| course.first()).copied()
    }

    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.first().map_or(0.0, |part| part.s.1 - part.s.0)
    }
}

/// The geometry of a [`SharedEdge`] under its arc length.
#[derive(Clone, Debug)]
pub struct SharedTrack {
    track: Track,
    from: f64,
    length: f64,
}

impl SharedTrack {
    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Point and unit tangent at an arc length.
    pub fn jet(&self, s: f64) -> (DVec3, DVec3) {
        self.track.jet(self.from + s)
    }

    /// Point at an arc length.
    pub fn point(&self, s: f64) -> DVec3 {
        self.jet(s).0
    }

    /// Distance of a point, larger than the true one by a thousandth at most.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.track.closest(p, (self.from, self.from + self.length)).1
    }

    /// The track it is a part of, with the arc lengths there.
    pub fn whole(&self) -> (&Track, (f64, f64)) {
        (&self.track, (self.from, self.from + self.length))
    }
}

/// Edges of some faces and, face by face, which of them its border runs along, each once and in that order.
#[derive(Clone, Debug, Default)]
pub struct SharedEdges {
    /// By faces in the order in which their surfaces are listed, then along the border of each.
    pub edges: Vec<SharedEdge>,
    /// Edges along the border of each face.
    pub borders: Vec<(PatchId, Vec<usize>)>,
}

impl SharedEdges {
    /// Free edges in loops, each loop from its first edge on; what does not close stands as it is.
    pub fn rims(&self) -> Vec<Vec<usize>> {
        let mut free: BTreeSet<usize> = (0..self.edges.len()).filter(|k| self.edges[*k].faces.len() == 1).collect();
        let mut touching: BTreeMap<VertexId, BTreeSet<usize>> = BTreeMap::new();
        for k in &free {
            let ends = self.edges[*k].ends;
            [ends.0, ends.1].into_iter().for_each(|end| _ = touching.entry(end).or_default().insert(*k));
        }
        let mut loops = Vec::new();
        while let Some(first) = free.pop_first() {
            let (start, mut at) = self.edges[first].ends;
            let mut around = vec![first];
            while at != start {
                let Some(here) = touching.get_mut(&at) else { break };
                here.retain(|k| free.contains(k));
                let Some(next) = here.pop_first() else { break };
                free.remove(&next);
                let ends = self.edges[next].ends;
                at = if ends.0 == at { ends.1 } else { ends.0 };
                around.push(next);
            }
            loops.push(around);
        }
        loops
    }
}

impl Model {
    /// A whole edge of the model with all faces on it.
    pub fn whole_edge(&self, edge: EdgeId) -> SharedEdge {
        let record = &self.edges[edge.index()];
        let part = EdgePart { edge, s: (0.0, record.length), against: false };
        SharedEdge {
            courses: vec![vec![part]],
            faces: record.users.iter().map(|u| u.0).collect(),
            ends: record.vertices,
            named_by: edge,
            near: 0.0,
        }
    }

    /// The geometry of an edge.
    pub fn shared_track(&self, edge: &SharedEdge, network: &Network) -> Option<SharedTrack> {
        let part = edge.first()?;
        Some(SharedTrack { track: self.track(part.edge, network), from: part.s.0, length: part.s.1 - part.s.0 })
    }

    /// Edges along the border of a patch, each with whether its border runs against it.
    pub fn border_of(&self, patch: PatchId) -> Vec<(EdgeId, bool)> {
        let record = &self.patches[patch.index()];
        let mut border = Vec::new();
        for (k, side) in record.sides.iter().enumerate() {
            if self.runs_back(record, k) {
                border.extend(side.edges.iter().rev().map(|(edge, against)| (*edge, !against)));
            } else {
                border.extend(side.edges.iter().copied());
            }
        }
        border
    }

    /// Edges of some patches, each once: patch by patch as listed, along the border of each.
    pub fn edges_along(&self, patches: &[PatchId]) -> Vec<EdgeId> {
        let mut seen = std::collections::BTreeSet::new();
        let borders = patches.iter().flat_map(|p| self.border_of(*p));
        borders.filter_map(|(edge, _)| seen.insert(edge).then_some(edge)).collect()
    }

    /// The edges of some surfaces where borders up to `near` apart are one, and a long one is cut where shorter ones end on it.
    ///
    /// Faces of other surfaces do not count. Edges that became a corner and faces that became an edge are not there.
    pub fn shared_edges(&self, surfaces: &[SurfaceId], near: f64, network: &Network, tolerance: &Tolerance) -> SharedEdges {
        let members = surfaces.iter().copied().collect();
        let joins = self.joins(&members, near, network, tolerance);
        let slivers = self.slivers(&members, &joins, near);
        let mut faces: Vec<PatchId> = Vec::new();
        for surface in surfaces {
            job::poll();
            let own: Vec<PatchId> = self.patches_of(*surface).filter(|p| slivers.binary_search(p).is_err()).collect();
            if own.first().is_some_and(|p| !faces.contains(p)) {
                faces.extend(own);
            }
        }
        Sharing::new(self, &joins, &faces, near).all(&faces)
    }
}

/// What edges are put together from.
struct Sharing<'a> {
    model: &'a Model,
    joins: &'a Joins,
    /// Tracks with a face, ascending, on each segment.
    on: Vec<Vec<usize>>,
    /// Faces on each edge.
    users: Vec<Vec<PatchId>>,
    /// The place of each face in the list.
    order: BTreeMap<PatchId, usize>,
    near: f64,
    /// The vertex at each junction.
    corners: BTreeMap<usize, VertexId>,
}

/// Segments one after the other that the same tracks run along, each with whether it is run against.
type SegmentRun = Vec<(usize, bool)>;

impl<'a> Sharing<'a> {
    fn new(model: &'a Model, joins: &'a Joins, faces: &[PatchId], near: f64) -> Self {
        let order: BTreeMap<PatchId, usize> = faces.iter().enumerate().map(|(n, face)| (*face, n)).collect();
        let of_edge = |edge: &EdgeId| model.edges[edge.index()].users.iter().map(|u| u.0).filter(|p| order.contains_key(p)).collect();
        let users: Vec<Vec<PatchId>> = joins.edges.iter().map(of_edge).collect();
        let mut on = vec![Vec::new(); joins.pieces.segments.len()];
        for (track, uses) in joins.pieces.of_track.iter().enumerate().filter(|(track, _)| !users[*track].is_empty()) {
            uses.iter().for_each(|u| on[u.segment].push(track));
        }
        on.iter_mut().for_each(|tracks: &mut Vec<usize>| tracks.dedup());
        let mut corners: BTreeMap<usize, VertexId> = BTreeMap::new();
        for (track, edge) in joins.edges.iter().enumerate() {
            let ends = model.edges[edge.index()].vertices;
            for (anchor, vertex) in [(2 * track, ends.0), (2 * track + 1, ends.1)] {
                let Some(junction) = joins.pieces.of_anchor[anchor] else { continue };
                let place = |v: VertexId| model.vertices[v.index()].point;
                let known = corners.entry(junction).or_insert(vertex);
                if compare_points(place(vertex), place(*known)).is_lt() {
                    *known = vertex;
                }
            }
        }
        Self { model, joins, on, users, order, near, corners }
    }

    fn all(&self, faces: &[PatchId]) -> SharedEdges {
        let mut found = SharedEdges::default();
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        for face in faces {
            job::poll();
            let mut border = Vec::new();
            for (edge, against) in self.model.border_of(*face) {
                let Ok(track) = self.joins.edges.binary_search(&edge) else { continue };
                for run in self.runs(track, against) {
                    let place = *known.entry(run.iter().map(|a| a.0).min().unwrap_or(0)).or_insert_with(|| {
                        found.edges.push(self.edge(track, &run));
                        found.edges.len() - 1
                    });
                    border.push(place);
                }
            }
            found.borders.push((*face, border));
        }
        found
    }

    /// The runs of a track, in its direction or against it.
    fn runs(&self, track: usize, against: bool) -> Vec<SegmentRun> {
        let uses = &self.joins.pieces.of_track[track];
        let steps: SegmentRun = if against {
            uses.iter().rev().map(|u| (u.segment, !u.against)).collect()
        } else {
            uses.iter().map(|u| (u.segment, u.against)).collect()
        };
        steps.chunk_by(|a, b| self.on[a.0] == self.on[b.0]).map(<[_]>::to_vec).collect()
    }

    /// The edge that a run along a track is.
    fn edge(&self, track: usize, run: &[(usize, bool)]) -> SharedEdge {
        let segments = &self.joins.pieces.segments;
        let tracks = &self.on[run[0].0];
        // As in meshes: the border that gives the geometry of the segments, where one gives that of all.
        let giver = segments[run[0].0].track;
        let one = tracks.contains(&giver) && run.iter().all(|(segment, _)| segments[*segment].track == giver);
        let giver = if one && self.course(giver, run).len() == 1 { giver } else { track };
        let mut courses = vec![self.course(giver, run)];
        courses.extend(tracks.iter().filter(|t| **t != giver).map(|t| self.course(*t, run)));
        let ends = |(segment, against): (usize, bool)| {
            if against { (segments[segment].ends.1, segments[segment].ends.0) } else { segments[segment].ends }
        };
        let own = self.model.edges[self.joins.edges[track].index()].vertices;
        let corner = |junction: usize, other: VertexId| self.corners.get(&junction).copied().unwrap_or(other);
        let mut ends = (corner(ends(run[0]).0, own.0), corner(ends(run[run.len() - 1]).1, own.1));
        // The edge runs as its geometry does.
        if courses[0].first().is_some_and(|part| part.against) {
            ends = (ends.1, ends.0);
            for course in &mut courses {
                course.reverse();
                course.iter_mut().for_each(|part| part.against = !part.against);
            }
        }
        let mut faces: Vec<PatchId> = tracks.iter().flat_map(|t| self.users[*t].iter().copied()).collect();
        faces.sort_by_key(|face| self.order.get(face).copied());
        let whole = |part: &&EdgePart| part.s == (0.0, self.model.edges[part.edge.index()].length);
        let mut lone = courses.iter().filter(|course| course.len() == 1).map(|course| &course[0]);
        let named_by = lone.find(whole).map_or(self.joins.edges[giver], |part| part.edge);
        SharedEdge { courses, faces, ends, named_by, near: self.near }
    }

    /// The parts of a track along a run.
    fn course(&self, track: usize, run: &[(usize, bool)]) -> Course {
        let (edge, uses) = (self.joins.edges[track], &self.joins.pieces.of_track[track]);
        let mut course = Course::new();
        for (segment, backwards) in run {
            let Some(place) = uses.iter().find(|u| u.segment == *segment) else { continue };
            let against = place.against != *backwards;
            match course.last_mut() {
                Some(part) if part.against == against && !against && part.s.1 == place.s.0 => part.s.1 = place.s.1,
                Some(part) if part.against == against && against && part.s.0 == place.s.1 => part.s.0 = place.s.0,
                _ => course.push(EdgePart { edge, s: place.s, against }),
            }
        }
        // What runs from one end of the edge to the other is the whole edge.
        let (first, last) = (uses.first().map(|u| u.s.0), uses.last().map(|u| u.s.1));
        if let [part] = course.as_mut_slice()
            && (Some(part.s.0), Some(part.s.1)) == (first, last)
        {
            part.s = (0.0, self.model.edges[edge.index()].length);
        }
        course
    }
}
