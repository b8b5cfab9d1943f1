//! The faces, segments and nodes of a mesh with the indices by which contacts between its faces are found.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::par;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::input::Input;
use crate::mesh::verify::contact_leaves::Leaves;
use crate::mesh::verify::contact_reach::bend_of_step;
use crate::model::SurfaceId;

/// A mesh with indices over its faces, segments and nodes.
pub(crate) struct Scan<'a> {
    pub input: &'a Input<'a>,
    pub layout: &'a Layout,
    pub mesh: &'a Mesh,
    /// Elements of each face by place.
    pub leaves: Vec<Leaves>,
    /// The faces by their boxes.
    pub tree: BoxTree,
    /// Faces that have each node of a border.
    pub users: Vec<Vec<u32>>,
    /// Nodes along each segment.
    pub along: Vec<Vec<u32>>,
    /// How far each step of each segment bends beside the line between its nodes, model units.
    bends: Vec<Vec<f64>>,
    /// Surfaces of the faces that have each segment on their border or inside.
    pub on: Vec<Vec<SurfaceId>>,
    /// Where each surface stands first in the plan.
    places: BTreeMap<SurfaceId, usize>,
}

impl<'a> Scan<'a> {
    pub(crate) fn new(input: &'a Input<'a>, layout: &'a Layout, nodes: &Nodes, mesh: &'a Mesh) -> Self {
        let leaves = par::map(layout.faces.len(), |f| {
            let surface = &input.model.surfaces[layout.faces[f].surface.index()].surface;
            let flat = surface.is_in_plane();
            Leaves::new(mesh, f, flat, (input.tolerance.point, layout.faces[f].near))
        });
        let boxes: Vec<Box3> = leaves.iter().map(|l| l.hull).collect();
        let along: Vec<Vec<u32>> = (0..layout.pieces.segments.len()).map(|k| nodes.of_segment(layout, k, false)).collect();
        let glued = layout.faces.iter().map(|face| face.near).fold(input.tolerance.point, f64::max);
        let bends_of = |k: usize| -> Vec<f64> {
            let (ids, fractions) = (&along[k], nodes.fractions(k, false));
            let steps = ids.windows(2).zip(fractions.windows(2));
            let chord = |ids: &[u32]| mesh.nodes[ids[0] as usize].distance(mesh.nodes[ids[1] as usize]);
            steps.map(|(ids, f)| glued + bend_of_step(layout.length(k) * (f[1] - f[0]), chord(ids))).collect()
        };
        let bends: Vec<Vec<f64>> = (0..along.len()).map(bends_of).collect();
        let mut users: Vec<Vec<u32>> = vec![Vec::new(); nodes.total as usize];
        for (f, face) in layout.faces.iter().enumerate() {
            let poles = face.sides.iter().filter_map(|s| s.pole).map(|j| nodes.of_junction(j));
            let points = face.points.iter().map(|k| nodes.points[*k]);
            for n in face.segments().flat_map(|k| along[k].iter().copied()).chain(poles).chain(points) {
                if let Some(own) = users.get_mut(n as usize)
                    && own.last() != Some(&(f as u32))
                {
                    own.push(f as u32);
                }
            }
        }
        let mut on: Vec<Vec<SurfaceId>> = vec![Vec::new(); along.len()];
        for face in &layout.faces {
            face.segments().for_each(|k| on[k].push(face.surface));
        }
        let mut places = BTreeMap::new();
        input.plan.surfaces.iter().enumerate().for_each(|(place, (s, _))| {
            places.entry(*s).or_insert(place);
        });
        Self { input, layout, mesh, leaves, tree: BoxTree::build(&boxes), users, along, bends, on, places }
    }

    /// Where the surface of a face stands in the plan.
    pub(crate) fn place(&self, face: usize) -> usize {
        self.places.get(&self.surface_of(face)).copied().unwrap_or_default()
    }

    /// The places of the surfaces of two faces, ascending.
    pub(crate) fn key(&self, a: usize, b: usize) -> (usize, usize) {
        let (a, b) = (self.place(a), self.place(b));
        (a.min(b), a.max(b))
    }

    pub(crate) fn p(&self, node: u32) -> DVec3 {
        self.mesh.nodes[node as usize]
    }

    pub(crate) fn surface_of(&self, face: usize) -> SurfaceId {
        self.layout.faces[face].surface
    }

    /// Whether a node belongs to a face of a face's surface.
    pub(crate) fn has(&self, node: u32, face: usize) -> bool {
        self.users.get(node as usize).is_some_and(|own| self.knows(own, face))
    }

    /// Whether one of some faces is of the surface of another one.
    fn knows(&self, faces: &[u32], other: usize) -> bool {
        faces.iter().any(|f| self.surface_of(*f as usize) == self.surface_of(other))
    }
}

/// Faces that a segment may touch.
#[derive(Default)]
pub(crate) struct SegmentContacts {
    /// Those that it may touch, ascending.
    pub(crate) near: BTreeSet<usize>,
    /// Places of its nodes that may lie on each.
    pub(crate) touched: BTreeMap<usize, Vec<usize>>,
    /// Points where the lines between its nodes go through one.
    pub(crate) pierced: Vec<(usize, DVec3)>,
}

impl Scan<'_> {
    /// A face that has a segment on its border.
    pub(crate) fn owner(&self, segment: usize) -> usize {
        let inner = |k: usize| self.users.get(self.along[segment][k] as usize);
        let (a, b) = (inner(0), inner(self.along[segment].len() - 1));
        let has = |f: &&u32| self.layout.faces[**f as usize].sides.iter().any(|s| s.uses.iter().any(|u| u.segment == segment));
        a.into_iter().chain(b).flatten().find(has).map_or(0, |f| *f as usize)
    }

    /// The faces that have a segment on their border.
    pub(crate) fn owners(&self, segment: usize) -> Vec<usize> {
        let at = |k: usize| self.users.get(self.along[segment][k] as usize).into_iter().flatten().map(|f| *f as usize);
        let has = |f: &usize| self.layout.faces[*f].sides.iter().any(|s| s.uses.iter().any(|u| u.segment == segment));
        let found: BTreeSet<usize> = at(0).chain(at(self.along[segment].len() - 1)).filter(has).collect();
        found.into_iter().collect()
    }

    /// Whether two faces have a node of a border in common.
    pub(crate) fn are_neighbours(&self, a: usize, b: usize) -> bool {
        self.layout.faces[a].segments().any(|k| self.along[k].iter().any(|n| self.users[*n as usize].contains(&(b as u32))))
    }

    /// Whether a place lies where two faces share nodes: within an edge of the mesh from one of them.
    pub(crate) fn is_shared(&self, a: usize, b: usize, p: DVec3) -> bool {
        let both = |n: u32| self.users.get(n as usize).is_some_and(|u| u.contains(&(a as u32)) && u.contains(&(b as u32)));
        let near = |k: usize| {
            let along = &self.along[k];
            let step = self.p(along[0]).distance(self.p(along[1]));
            along.iter().any(|n| both(*n) && self.p(*n).distance(p) <= step)
        };
        self.layout.faces[a].segments().any(near)
    }

    /// A place between two faces, where their boxes meet.
    pub(crate) fn between(&self, a: usize, b: usize) -> DVec3 {
        let (a, b) = (&self.leaves[a].hull, &self.leaves[b].hull);
        0.5 * (a.min.max(b.min) + a.max.min(b.max))
    }

    /// The faces beside a segment.
    pub(crate) fn beside(&self, segment: usize) -> SegmentContacts {
        let along = &self.along[segment];
        let none = Vec::new();
        let users = |n: u32| self.users.get(n as usize).unwrap_or(&none);
        let mut found = SegmentContacts::default();
        let mut faces = Vec::new();
        for k in 0..along.len() {
            let p = self.p(along[k]);
            let next = along.get(k + 1).map(|n| self.p(*n));
            let around = Box3::of(std::iter::once(p).chain(next));
            faces.clear();
            // An edge may bend beside the line between its nodes.
            let bend = self.bends[segment].get(k).copied().unwrap_or(0.0);
            self.tree.query(&around, bend, |f| faces.push(f));
            faces.sort_unstable();
            for &f in &faces {
                let own = users(along[k]);
                if !self.knows(own, f) && self.leaves[f].holds(self.mesh, p) {
                    found.touched.entry(f).or_default().push(k);
                }
                let Some(q) = next else { continue };
                let known = (self.knows(own, f), self.knows(users(along[k + 1]), f));
                let straight = self.leaves[f].is_plane() && self.is_straight(segment);
                if !self.on[segment].contains(&self.surface_of(f))
                    && !found.near.contains(&f)
                    && self.leaves[f].beside_line(self.mesh, (p, q), known, if straight { 0.0 } else { bend })
                {
                    found.near.insert(f);
                }
                if known.0 || known.1 {
                    continue;
                }
                if let Some(at) = self.leaves[f].pierced(self.mesh, (p, q), self.input.tolerance.point) {
                    found.pierced.push((f, at));
                }
            }
        }
        found
    }

    /// Whether all nodes of a segment and places between them lie on the line between its ends.
    fn is_straight(&self, segment: usize) -> bool {
        let ends = (self.layout.point(segment, 0.0), self.layout.point(segment, 1.0));
        let off = |p: DVec3| (p - ends.0).cross(ends.1 - ends.0).length() / ends.0.distance(ends.1);
        [0.21, 0.5, 0.83].iter().all(|f| off(self.layout.point(segment, *f)) <= self.input.tolerance.point)
    }
}
