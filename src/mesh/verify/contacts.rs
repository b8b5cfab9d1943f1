//! Faces of a mesh that touch, cross or cover each other where they share no nodes.
//!
//! The elements of the finished mesh say where to look, at the cost of its borders; curves and surfaces say what is so, wherever the
//! nodes are. Faces that cross inside both do so where an element of one goes through one of the other, or, where they share no node,
//! comes near one; faces cover each other beside an edge of one that lies on the other, or by a place inside one of them.

use crate::model::fault::ModelFault;
use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::boxtree::{BoxTree, PAIR};
use crate::base::fault::Result;
use crate::base::limits::WORK_OF_A_SURFACE;
use crate::base::tolerance::SINGULAR;
use crate::base::{par, work};
use crate::mesh::border::inside;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::border::touch::{Kind, Touch};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::input::Input;
use crate::mesh::verify::contact_edges::{Task, meetings};
use crate::mesh::verify::contact_leaves::{BULGE, Leaves};
use crate::model::SurfaceId;
use crate::surface::faults::CutFault;
use crate::surface::intersect::with_surfaces::with_surfaces;
use crate::surface::{Closest, Nearest, SurfaceKind};

/// Crossings of elements of two faces that are looked at before the faces count as apart, and those that they are chosen from.
const MAX_SAMPLES: usize = 64;
const MOST: usize = 4096;
/// Steps until a place on both of two faces is found.
const ROUNDS: usize = 60;

/// All of a mesh that is needed to look at its faces.
pub(crate) struct Scan<'a> {
    pub input: &'a Input<'a>,
    pub layout: &'a Layout,
    mesh: &'a Mesh,
    /// Elements of each face by place.
    pub leaves: Vec<Leaves>,
    /// The faces by their boxes.
    tree: BoxTree,
    /// Faces that have each node of a border.
    users: Vec<Vec<u32>>,
    /// Nodes along each segment.
    pub along: Vec<Vec<u32>>,
    /// Surfaces of the faces that have each segment on their border or inside.
    pub on: Vec<Vec<SurfaceId>>,
    /// Where each surface stands first in the plan.
    places: BTreeMap<SurfaceId, usize>,
}

/// A segment of an edge on a face, nodes from and to by their places along it.
struct Found {
    segment: usize,
    face: usize,
    nodes: Vec<usize>,
}

/// Every two surfaces of a mesh that touch, cross or cover each other without sharing nodes there, in the order of the plan; with the
/// elements of each face in boxes, where it took them.
pub fn find(input: &Input, layout: &Layout, nodes: &Nodes, mesh: &Mesh) -> (Vec<Touch>, Vec<Leaves>) {
    let mut surfaces: Vec<SurfaceId> = layout.faces.iter().map(|f| f.surface).collect();
    surfaces.dedup();
    if surfaces.len() < 2 {
        return (Vec::new(), Vec::new());
    }
    let scan = Scan::new(input, layout, nodes, mesh);
    let mut known = Known { scan: &scan, nearest: BTreeMap::new(), touches: BTreeMap::new(), tries: BTreeMap::new() };
    known.borders();
    known.insides();
    known.covered();
    known.crossings();
    let touches = known.touches.into_values().map(|t| t.0).collect();
    (touches, scan.leaves)
}

/// E666 where faces that are to be joined cover each other: what they share would be in the mesh twice.
pub fn refuse_overlaps(input: &Input, touches: &[Touch]) -> Result<()> {
    let Some((_, imprint)) = &input.plan.imprint else { return Ok(()) };
    let Some(Touch { surfaces: (a, b), names, at, .. }) = touches.iter().find(|t| t.kind == Kind::Overlap) else { return Ok(()) };
    let origin = |place: usize| input.model.surfaces[input.plan.surfaces[place].0.index()].surface.origin();
    let (a, b, names) = (origin(*a), origin(*b), names.clone());
    Err(ModelFault::ImprintOverlap { imprint: *imprint, a, b, names, at: *at }.into())
}

impl<'a> Scan<'a> {
    fn new(input: &'a Input<'a>, layout: &'a Layout, nodes: &Nodes, mesh: &'a Mesh) -> Self {
        let leaves = par::map(layout.faces.len(), |f| {
            let surface = &input.model.surfaces[layout.faces[f].surface.index()].surface;
            let flat = surface.is_flat() || surface.kind() == SurfaceKind::Plane;
            Leaves::new(mesh, f, flat, input.tolerance.point)
        });
        let boxes: Vec<Box3> = leaves.iter().map(|l| l.hull).collect();
        let along: Vec<Vec<u32>> = (0..layout.pieces.segments.len()).map(|k| nodes.of_segment(layout, k, false)).collect();
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
        Self { input, layout, mesh, leaves, tree: BoxTree::build(&boxes), users, along, on, places }
    }

    /// Where the surface of a face stands in the plan.
    fn place(&self, face: usize) -> usize {
        self.places.get(&self.surface_of(face)).copied().unwrap_or_default()
    }

    /// The places of the surfaces of two faces, ascending.
    fn key(&self, a: usize, b: usize) -> (usize, usize) {
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

/// What has been found out.
struct Known<'a> {
    scan: &'a Scan<'a>,
    nearest: BTreeMap<SurfaceId, Nearest>,
    /// By the places of the surfaces, with the length of the longest segment.
    touches: BTreeMap<(usize, usize), (Touch, f64)>,
    /// Crossings of elements that were looked at, by faces.
    tries: BTreeMap<(usize, usize), usize>,
}

impl Known<'_> {
    /// Whether a point lies on a face.
    fn on(&mut self, face: usize, p: DVec3) -> bool {
        let scan = self.scan;
        let face = &scan.layout.faces[face];
        let surface = &scan.input.model.surfaces[face.surface.index()].surface;
        let nearest = self.nearest.entry(face.surface).or_insert_with(|| Nearest::new(surface));
        inside::on(nearest, &scan.input.model.patches[face.patch.index()], p, scan.input.tolerance)
    }

    /// The point of a face's surface nearest to another one.
    fn foot(&mut self, face: usize, p: DVec3) -> Closest {
        let id = self.scan.surface_of(face);
        let surface = &self.scan.input.model.surfaces[id.index()].surface;
        self.nearest.entry(id).or_insert_with(|| Nearest::new(surface)).at(p)
    }

    fn add(&mut self, (a, b): (usize, usize), kind: Kind, (length, longest): (f64, f64), at: DVec3) {
        let scan = self.scan;
        let name = |face: usize| scan.input.model.surfaces[scan.surface_of(face).index()].name.clone();
        let touch = Touch { kind, surfaces: (scan.place(a), scan.place(b)), names: (name(a), name(b)), length, at };
        match self.touches.entry(scan.key(a, b)) {
            std::collections::btree_map::Entry::Vacant(slot) => {
                slot.insert((touch, longest));
            }
            std::collections::btree_map::Entry::Occupied(mut slot) => {
                let (old, before) = slot.get_mut();
                let length = old.length + length;
                // What covers more is said first; of the same kind the longest segment gives the place.
                if (kind, *before) < (old.kind, longest) && kind <= old.kind {
                    (*old, *before) = (touch, longest);
                }
                old.length = length;
            }
        }
    }

    /// Edges on faces, and edges through faces.
    fn borders(&mut self) {
        let scan = self.scan;
        let used: Vec<bool> = {
            let mut used = vec![false; scan.along.len()];
            scan.layout.faces.iter().flat_map(|f| f.sides.iter().flat_map(|s| &s.uses)).for_each(|u| used[u.segment] = true);
            used
        };
        let segments: Vec<usize> = (0..used.len()).filter(|k| used[*k]).collect();
        let near = par::map(segments.len(), |n| scan.beside(segments[n]));
        let tasks = near.iter().zip(&segments).flat_map(|(b, k)| b.near.iter().map(|face| Task { segment: *k, face: *face }));
        let tasks: Vec<Task> = tasks.collect();
        let met = meetings(scan, &tasks);
        let exact: BTreeMap<Task, usize> = tasks.iter().enumerate().filter(|(n, _)| met[*n].is_some()).map(|(n, t)| (*t, n)).collect();
        for (n, found) in near.into_iter().enumerate() {
            let segment = segments[n];
            for face in found.near {
                if let Some(met) = exact.get(&Task { segment, face }).and_then(|n| met[*n].as_ref()) {
                    met.runs.iter().for_each(|run| self.runs_along(segment, face, *run));
                    for (at, inside) in &met.points {
                        let (ends, slow) = met.known;
                        let leaves = ends.into_iter().flatten().any(|p| p.distance(*at) <= slow && self.on(face, p.midpoint(*at)));
                        if !leaves && self.on(face, *at) {
                            let kind = if *inside { Kind::Crossing } else { Kind::Edge };
                            self.add((scan.owner(segment), face), kind, (0.0, 0.0), *at);
                        }
                    }
                }
            }
            // Edges that no curve carries are known by their nodes.
            for (face, candidates) in found.touched {
                if exact.contains_key(&Task { segment, face }) {
                    continue;
                }
                let nodes = candidates.into_iter().filter(|k| self.on(face, scan.p(scan.along[segment][*k]))).collect();
                self.lies_on(&Found { segment, face, nodes });
            }
            for (face, at) in found.pierced {
                if !exact.contains_key(&Task { segment, face }) {
                    self.crosses(scan.owner(segment), face, at);
                }
            }
        }
    }

    /// Takes a run of an edge on a face: its middle and its length.
    fn runs_along(&mut self, segment: usize, face: usize, (at, length): (DVec3, f64)) {
        /// How far beside the run is looked, as a share of its length, and how much nearer each time.
        const BESIDE: (f64, f64) = (0.05, 0.125);
        /// What merely touches along the run parts from it nearer than so many times the root of tolerance times length.
        const TOUCH: f64 = 8.0;
        let scan = self.scan;
        if !self.on(face, at) {
            return;
        }
        let nearest = TOUCH * (scan.input.tolerance.point * length).sqrt();
        for owner in scan.owners(segment) {
            let mut by = BESIDE.0 * length;
            loop {
                let inside = scan.leaves[owner].inwards(scan.mesh, at, by);
                if let Some(p) = inside.map(|p| self.foot(owner, p).point)
                    && p.distance(at) > scan.input.tolerance.point
                    && self.on(face, p)
                {
                    return self.add((owner, face), Kind::Overlap, (length, length), at);
                }
                by *= BESIDE.1;
                if by < nearest {
                    break;
                }
            }
        }
        self.add((scan.owner(segment), face), Kind::Edge, (length, length), at);
    }

    /// Takes an edge on a face.
    fn lies_on(&mut self, found: &Found) {
        let scan = self.scan;
        let Some(&middle) = found.nodes.get(found.nodes.len() / 2) else { return };
        let along = &scan.along[found.segment];
        let on = |k: usize| {
            found.nodes.binary_search(&k).is_ok() || scan.users.get(along[k] as usize).is_some_and(|u| u.contains(&(found.face as u32)))
        };
        let steps = (1..along.len()).filter(|k| on(k - 1) && on(*k));
        let length: f64 = steps.map(|k| scan.p(along[k - 1]).distance(scan.p(along[k]))).sum();
        let owner = scan.owner(found.segment);
        let at = scan.p(along[middle]);
        // Beside an edge that only touches, its own face leaves the other one.
        let beside = scan.leaves[owner].beside(scan.mesh, along[middle]);
        let kind = match beside.map(|p| self.foot(owner, p).point) {
            Some(p) if self.on(found.face, p) => Kind::Overlap,
            _ => Kind::Edge,
        };
        self.add((owner, found.face), kind, (length, length), at);
    }

    /// The place on the surfaces of two faces near a point: on both tangent planes at its feet, as Newton's method has it.
    fn common(&mut self, a: usize, b: usize, near: DVec3) -> Option<DVec3> {
        let scan = self.scan;
        let normal = |face: usize, at: &Closest| scan.input.model.surfaces[scan.surface_of(face).index()].surface.normal(at.uv.0, at.uv.1);
        let mut p = near;
        for _ in 0..ROUNDS {
            let (x, y) = (self.foot(a, p), self.foot(b, p));
            if x.distance.max(y.distance) <= 0.5 * scan.input.tolerance.point {
                return Some(p);
            }
            let (m, n) = (normal(a, &x), normal(b, &y));
            let (off_a, off_b, cosine) = (m.dot(x.point - p), n.dot(y.point - p), m.dot(n));
            let sine2 = m.length_squared() * n.length_squared() - cosine * cosine;
            p = if sine2 > SINGULAR {
                p + (m * (off_a - cosine * off_b) + n * (off_b - cosine * off_a)) / sine2
            } else {
                // Where they are parallel each is the other's foot in turn.
                self.foot(b, x.point).point
            };
        }
        None
    }

    /// Takes two faces whose elements cross, if the faces themselves do near there.
    fn crosses(&mut self, a: usize, b: usize, near: DVec3) -> bool {
        let tries = self.tries.entry((a, b)).or_default();
        *tries += 1;
        if *tries > MAX_SAMPLES {
            return false;
        }
        let Some(p) = self.common(a, b, near) else { return false };
        if !(self.on(a, p) && self.on(b, p)) || self.scan.is_shared(a, b, p) {
            return false;
        }
        self.add((a, b), Kind::Crossing, (0.0, 0.0), p);
        true
    }

    /// Faces that lie on each other whatever their borders do: a place inside each is looked at.
    fn insides(&mut self) {
        let scan = self.scan;
        for a in 0..scan.leaves.len() {
            let Some(p) = scan.leaves[a].place(scan.mesh) else { continue };
            let mut near = Vec::new();
            scan.tree.query(&Box3::of([p]), 0.0, |b| near.push(b));
            near.retain(|b| scan.surface_of(a) != scan.surface_of(*b) && scan.leaves[*b].holds(scan.mesh, p));
            near.sort_unstable();
            for b in near {
                let foot = self.foot(a, p).point;
                if self.on(b, foot) {
                    self.add((a, b), Kind::Overlap, (0.0, 0.0), foot);
                }
            }
        }
    }

    /// Faces on which a border of another one lies as a line, and beside it that face itself.
    fn covered(&mut self) {
        let scan = self.scan;
        for (f, face) in scan.layout.faces.iter().enumerate() {
            for &k in &face.lines {
                let along = &scan.along[k];
                let middle = along[along.len() / 2];
                let others: Vec<usize> = scan.users[middle as usize].iter().map(|n| *n as usize).collect();
                for a in others {
                    let own = scan.layout.faces[a].sides.iter().any(|s| s.uses.iter().any(|u| u.segment == k));
                    if !own || scan.surface_of(a) == scan.surface_of(f) {
                        continue;
                    }
                    let beside = scan.leaves[a].beside(scan.mesh, middle).map(|p| self.foot(a, p).point);
                    if beside.is_some_and(|p| self.on(f, p)) {
                        self.add((a, f), Kind::Overlap, (0.0, 0.0), scan.p(middle));
                    }
                }
            }
        }
    }

    /// Faces that bend and cross inside both; two planes cross where a border of one goes through the other.
    fn crossings(&mut self) {
        let scan = self.scan;
        let pairs = scan.tree.pairs(0.0, PAIR).into_iter().map(|(a, b)| (a as usize, b as usize));
        let wanted = |(a, b): &(usize, usize)| {
            let flat = scan.leaves[*a].is_flat() && scan.leaves[*b].is_flat();
            !flat && scan.surface_of(*a) != scan.surface_of(*b) && !self.touches.contains_key(&scan.key(*a, *b))
        };
        let pairs: Vec<(usize, usize)> = pairs.filter(wanted).collect();
        let found = par::map(pairs.len(), |n| scan.leaves[pairs[n].0].crossings(scan.mesh, (&scan.leaves[pairs[n].1], scan.mesh), MOST));
        let mut quiet = Vec::new();
        for ((a, b), places) in pairs.into_iter().zip(found) {
            if places.is_empty() {
                quiet.push((a, b));
                continue;
            }
            // Evenly among all, so that none hides behind many in one place.
            let step = places.len().div_ceil(MAX_SAMPLES);
            for at in places.into_iter().step_by(step) {
                if self.touches.contains_key(&scan.key(a, b)) || self.crosses(a, b, at) {
                    break;
                }
            }
        }
        // What bends between its nodes may cross where no element does.
        quiet.retain(|(a, b)| !scan.are_neighbours(*a, *b) && scan.leaves[*a].near(&scan.leaves[*b]));
        let surface = |face: usize| &scan.input.model.surfaces[scan.surface_of(face).index()].surface;
        let mut pairs: Vec<(usize, usize)> = quiet.into_iter().filter(|(a, b)| !self.touches.contains_key(&scan.key(*a, *b))).collect();
        pairs.dedup_by_key(|(a, b)| (scan.surface_of(*a), scan.surface_of(*b)));
        // Walls of a thin shell: as many pairs as faces, each to be told apart.
        if let Some(budget) = work::budget() {
            budget.allow(pairs.len() as u64 * WORK_OF_A_SURFACE);
        }
        let found = par::map(pairs.len(), |n| {
            let (a, b) = (surface(pairs[n].0), surface(pairs[n].1));
            let common = with_surfaces(std::slice::from_ref(a), std::slice::from_ref(b), scan.input.plan.origin, scan.input.tolerance);
            match common {
                Ok(common) => common.curves.first().map(|curve| (Kind::Crossing, curve.point(0.5))),
                Err(fault) => match fault.of() {
                    Some(CutFault::RunAlong { at, .. }) => Some((Kind::Overlap, *at)),
                    _ => Some((Kind::Unknown, scan.between(pairs[n].0, pairs[n].1))),
                },
            }
        });
        for ((a, b), found) in pairs.into_iter().zip(found) {
            // Beside each other within the tolerance is not on each other.
            let lies = |known: &mut Self, at: DVec3| known.on(a, at) && known.on(b, at);
            match found {
                Some((Kind::Overlap, at)) if !lies(self, at) => {}
                Some((kind, at)) => self.add((a, b), kind, (0.0, 0.0), at),
                None => {}
            }
        }
    }
}

/// Faces beside a segment.
#[derive(Default)]
struct Beside {
    /// Those that it may touch, ascending.
    near: BTreeSet<usize>,
    /// Places of its nodes that may lie on each.
    touched: BTreeMap<usize, Vec<usize>>,
    /// Points where the lines between its nodes go through one.
    pierced: Vec<(usize, DVec3)>,
}

impl Scan<'_> {
    /// A face that has a segment on its border.
    fn owner(&self, segment: usize) -> usize {
        let inner = |k: usize| self.users.get(self.along[segment][k] as usize);
        let (a, b) = (inner(0), inner(self.along[segment].len() - 1));
        let has = |f: &&u32| self.layout.faces[**f as usize].sides.iter().any(|s| s.uses.iter().any(|u| u.segment == segment));
        a.into_iter().chain(b).flatten().find(has).map_or(0, |f| *f as usize)
    }

    /// The faces that have a segment on their border.
    fn owners(&self, segment: usize) -> Vec<usize> {
        let at = |k: usize| self.users.get(self.along[segment][k] as usize).into_iter().flatten().map(|f| *f as usize);
        let has = |f: &usize| self.layout.faces[*f].sides.iter().any(|s| s.uses.iter().any(|u| u.segment == segment));
        let found: BTreeSet<usize> = at(0).chain(at(self.along[segment].len() - 1)).filter(has).collect();
        found.into_iter().collect()
    }

    /// Whether two faces have a node of a border in common.
    fn are_neighbours(&self, a: usize, b: usize) -> bool {
        self.layout.faces[a].segments().any(|k| self.along[k].iter().any(|n| self.users[*n as usize].contains(&(b as u32))))
    }

    /// Whether a place lies where two faces share nodes: within an edge of the mesh from one of them.
    fn is_shared(&self, a: usize, b: usize, p: DVec3) -> bool {
        let both = |n: u32| self.users.get(n as usize).is_some_and(|u| u.contains(&(a as u32)) && u.contains(&(b as u32)));
        let near = |k: usize| {
            let along = &self.along[k];
            let step = self.p(along[0]).distance(self.p(along[1]));
            along.iter().any(|n| both(*n) && self.p(*n).distance(p) <= step)
        };
        self.layout.faces[a].segments().any(near)
    }

    /// A place between two faces, where their boxes meet.
    fn between(&self, a: usize, b: usize) -> DVec3 {
        let (a, b) = (&self.leaves[a].hull, &self.leaves[b].hull);
        0.5 * (a.min.max(b.min) + a.max.min(b.max))
    }

    fn beside(&self, segment: usize) -> Beside {
        let along = &self.along[segment];
        let none = Vec::new();
        let users = |n: u32| self.users.get(n as usize).unwrap_or(&none);
        let mut found = Beside::default();
        let mut faces = Vec::new();
        for k in 0..along.len() {
            let p = self.p(along[k]);
            let next = along.get(k + 1).map(|n| self.p(*n));
            let around = Box3::of(std::iter::once(p).chain(next));
            faces.clear();
            // An edge may bend beside the line between its nodes.
            let bend = next.map_or(0.0, |q| BULGE * p.distance(q));
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
