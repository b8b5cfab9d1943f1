//! Bodies of a mesh that have nodes of their own and yet take the same room: they go through each other, lie on each other as a whole,
//! or one lies inside the other and is no void of it. Bodies that only touch are valid.
//!
//! Boxes of faces say which bodies are near each other, elements where faces may cross, curves and surfaces whether they do.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::boxtree::{BoxTree, PAIR};
use crate::base::limits::WORK_OF_A_SURFACE;
use crate::base::tolerance::{FLAT, NEAR_MISS, SINGULAR, STATED};
use crate::base::{job, par, work};
use crate::mesh::border::inside;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::touch::{Kind, Touch};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::input::Input;
use crate::mesh::verify::contact_leaves::Leaves;
use crate::surface::{Closest, Nearest};

/// Bounds of the search for bodies that overlap.
struct BodySettings {
    /// Largest number of crossings of elements of two faces that are examined.
    max_samples: usize,
    /// Largest number of crossings of elements that the samples are chosen from.
    max_crossings: usize,
    /// Largest number of Newton steps to a point on both faces.
    max_newton_steps: usize,
    /// Number of nodes of a body that are tested against the faces of another one.
    probes: usize,
    /// Number of those off the faces that are tested for being inside.
    inside_probes: usize,
}

const BODIES: BodySettings = BodySettings { max_samples: 8, max_crossings: 256, max_newton_steps: 30, probes: 24, inside_probes: 3 };

/// A body with its mesh.
#[derive(Clone, Copy)]
pub struct MeshBody<'a> {
    /// Its faces.
    pub layout: &'a Layout,
    /// Its elements.
    pub mesh: &'a Mesh,
}

/// Two parts, or two faces, by their numbers.
type NumberPair = (usize, usize);

/// A face: its part and its place there.
type PartFace = (usize, usize);

/// Every two bodies that take the same room, with a place where that is so, in the order of the parts; `known` has the elements of the
/// faces of each part in boxes, or nothing.
pub fn find(input: &Input, parts: &[MeshBody], known: Vec<Vec<Leaves>>) -> Vec<Touch> {
    if parts.iter().filter(|part| !part.layout.faces.is_empty()).count() < 2 {
        return Vec::new();
    }
    let near = input.tolerance.point;
    let mut faces: Vec<(PartFace, Box3)> = Vec::new();
    for (n, part) in parts.iter().enumerate() {
        faces.extend((0..part.layout.faces.len()).map(|f| ((n, f), hull_of(part.mesh, f))));
    }
    let hulls: Vec<Box3> = faces.iter().map(|face| face.1).collect();
    let mut beside: BTreeMap<NumberPair, Vec<NumberPair>> = BTreeMap::new();
    for (a, b) in BoxTree::build(&hulls).pairs(near, PAIR) {
        let (a, b) = (faces[a as usize].0, faces[b as usize].0);
        if a.0 != b.0 {
            let (a, b) = (a.min(b), a.max(b));
            beside.entry((a.0, b.0)).or_default().push((a.1, b.1));
        }
    }
    let of_parts: Vec<(usize, Box3)> = faces
        .chunk_by(|a, b| a.0.0 == b.0.0)
        .map(|own| (own[0].0.0, own.iter().fold(Box3::EMPTY, |all, face| all.union(face.1))))
        .collect();
    let bodies: Vec<Box3> = of_parts.iter().map(|own| own.1).collect();
    let within = |a: &Box3, b: &Box3| a.min.cmpge(b.min - near).all() && a.max.cmple(b.max + near).all();
    let both = BoxTree::build(&bodies).pairs(near, PAIR).into_iter().map(|(a, b)| (a as usize, b as usize));
    let pairs = both.flat_map(|(a, b)| [(a, b), (b, a)]).filter(|(a, b)| within(&bodies[*a], &bodies[*b]));
    let nested: Vec<(usize, usize)> = pairs.map(|(a, b)| (of_parts[a].0, of_parts[b].0)).collect();
    // Elements of the faces in question, in boxes.
    let mut wanted: BTreeSet<PartFace> = BTreeSet::new();
    for ((a, b), pairs) in &beside {
        wanted.extend(pairs.iter().flat_map(|(x, y)| [(*a, *x), (*b, *y)]));
    }
    wanted.extend(nested.iter().flat_map(|(_, b)| (0..parts[*b].layout.faces.len()).map(move |f| (*b, f))));
    let wanted: Vec<PartFace> = wanted.into_iter().filter(|(part, _)| known[*part].is_empty()).collect();
    let leaves = par::map(wanted.len(), |n| {
        let (part, face) = wanted[n];
        let surface = &input.model.surfaces[parts[part].layout.faces[face].surface.index()].surface;
        Leaves::new(parts[part].mesh, face, surface.is_flat(), (near, parts[part].layout.faces[face].near))
    });
    let scan = BodyScan { input, parts, known, computed: wanted.into_iter().zip(leaves).collect() };
    if let Some(budget) = work::budget() {
        budget.allow(beside.len() as u64 * WORK_OF_A_SURFACE);
    }
    let groups: Vec<(NumberPair, Vec<NumberPair>)> = beside.into_iter().collect();
    let crossed = par::map(groups.len(), |n| scan.crossing(groups[n].0, &groups[n].1));
    let mut found: BTreeMap<(usize, usize), Touch> = groups.iter().zip(crossed).filter_map(|(g, t)| Some((g.0, t?))).collect();
    let open: Vec<(usize, usize)> = nested.into_iter().filter(|(a, b)| !found.contains_key(&((*a).min(*b), (*a).max(*b)))).collect();
    let volumes: BTreeMap<usize, f64> = open.iter().flat_map(|(a, b)| [*a, *b]).map(|n| (n, volume(parts[n].mesh))).collect();
    let closed: BTreeSet<usize> = volumes.keys().copied().filter(|n| parts[*n].mesh.is_watertight()).collect();
    let open: Vec<(usize, usize)> = open.into_iter().filter(|(a, b)| closed.contains(a) && closed.contains(b)).collect();
    let contained = par::map(open.len(), |n| scan.contained(open[n], &volumes));
    // What lies in a body and in a void of another one lies in neither.
    let mut depth: BTreeMap<usize, (i32, (usize, usize), Touch)> = BTreeMap::new();
    for ((a, b), touch) in open.into_iter().zip(contained) {
        let Some(touch) = touch else { continue };
        if touch.kind == Kind::Overlap {
            found.entry((a.min(b), a.max(b))).or_insert(touch);
            continue;
        }
        let side = if volumes[&b] > 0.0 { 1 } else { -1 };
        depth.entry(a).and_modify(|known| known.0 += side).or_insert((side, (a.min(b), a.max(b)), touch));
    }
    for (count, key, touch) in depth.into_values() {
        if count > 0 {
            found.entry(key).or_insert(touch);
        }
    }
    found.into_values().collect()
}

/// All bodies of a mesh.
struct BodyScan<'a> {
    input: &'a Input<'a>,
    parts: &'a [MeshBody<'a>],
    /// Elements of all faces of some parts, and of the faces in question of the others.
    known: Vec<Vec<Leaves>>,
    computed: BTreeMap<PartFace, Leaves>,
}

/// A face with the search for nearest points on its surface.
struct BodyProbe<'a> {
    input: &'a Input<'a>,
    part: &'a MeshBody<'a>,
    face: usize,
    nearest: Nearest,
}

impl BodyProbe<'_> {
    fn on(&self, p: DVec3) -> bool {
        let patch = self.part.layout.faces[self.face].patch;
        inside::on(&self.nearest, &self.input.model.patches[patch.index()], p, self.input.tolerance)
    }

    fn normal(&self, at: &Closest) -> DVec3 {
        self.nearest.surface().normal(at.uv.0, at.uv.1)
    }

    /// Whether a place of the face is off its border, by more than the distance of distinct places.
    fn is_inner(&self, p: DVec3, normal: DVec3) -> bool {
        let first = crate::base::math::any_normal(normal);
        let second = normal.cross(first);
        let by = NEAR_MISS * self.input.tolerance.point;
        [first, -first, second, -second].into_iter().all(|d| self.on(p + d * by))
    }
}

impl<'a> BodyScan<'a> {
    fn leaves(&self, face: PartFace) -> &Leaves {
        self.known[face.0].get(face.1).unwrap_or_else(|| &self.computed[&face])
    }

    fn probe(&self, (part, face): PartFace) -> BodyProbe<'a> {
        let part = &self.parts[part];
        let surface = &self.input.model.surfaces[part.layout.faces[face].surface.index()].surface;
        BodyProbe { input: self.input, part, face, nearest: Nearest::new(surface) }
    }

    fn touch(&self, kind: Kind, a: PartFace, b: PartFace, at: DVec3) -> Touch {
        let surface = |(part, face): PartFace| self.parts[part].layout.faces[face].surface;
        let place = |face: PartFace| self.input.plan.surfaces.iter().position(|s| s.0 == surface(face)).unwrap_or_default();
        let name = |face: PartFace| self.input.model.surfaces[surface(face).index()].name.clone();
        Touch { kind, surfaces: (place(a), place(b)), names: (name(a), name(b)), length: 0.0, at }
    }

    /// The first two faces of two bodies that go through each other.
    fn crossing(&self, (a, b): NumberPair, faces: &[NumberPair]) -> Option<Touch> {
        for (x, y) in faces {
            job::poll();
            let (x, y) = ((a, *x), (b, *y));
            let places = self.leaves(x).crossings(self.parts[a].mesh, self.leaves(y), self.parts[b].mesh, BODIES.max_crossings);
            if places.is_empty() {
                continue;
            }
            let (one, other) = (self.probe(x), self.probe(y));
            // Evenly among all, so that none hides behind many in one place.
            let step = places.len().div_ceil(BODIES.max_samples);
            let found = places.into_iter().step_by(step).find_map(|near| common(&one, &other, near));
            if let Some(at) = found {
                return Some(self.touch(Kind::Crossing, x, y, at));
            }
        }
        None
    }

    /// Whether the first of two closed bodies whose faces do not cross lies inside the second, or on it as a whole.
    fn contained(&self, (a, b): NumberPair, volumes: &BTreeMap<usize, f64>) -> Option<Touch> {
        // A void has its outside within.
        if volumes[&a] <= 0.0 {
            return None;
        }
        let (mesh, other) = (self.parts[a].mesh, self.parts[b].mesh);
        let own: Vec<&Leaves> = (0..self.parts[b].layout.faces.len()).map(|f| self.leaves((b, f))).collect();
        let tree = BoxTree::build(&own.iter().map(|l| l.hull).collect::<Vec<Box3>>());
        let step = mesh.triangles.len().max(mesh.quads.len()).div_ceil(BODIES.probes).max(1);
        let corners = mesh.triangles.iter().map(|t| t[0]).chain(mesh.quads.iter().map(|q| q[0])).step_by(step);
        let probes: Vec<DVec3> = corners.map(|n| mesh.nodes[n as usize]).collect();
        let is_on = |p: &DVec3| tree.near(&Box3::of([*p]), 0.0).into_iter().any(|f| own[f].holds(other, *p));
        let off: Vec<DVec3> = probes.iter().filter(|p| !is_on(p)).copied().collect();
        let at = *probes.first()?;
        if off.is_empty() {
            let same = (volumes[&a] - volumes[&b]).abs() <= STATED * volumes[&a];
            return (same && a < b).then(|| self.touch(Kind::Overlap, (a, 0), (b, 0), at));
        }
        let reach = own.iter().fold(Box3::EMPTY, |all, l| all.union(l.hull)).diagonal();
        let is_in = |p: &DVec3| {
            let rays = [DVec3::X, DVec3::Y, DVec3::Z].map(|d| {
                let ray = (*p, *p + d * 2.0 * reach);
                tree.near(&Box3::of([ray.0, ray.1]), 0.0).into_iter().map(|f| own[f].pierces(other, ray)).sum::<usize>() % 2
            });
            rays.iter().sum::<usize>() >= 2
        };
        let step = off.len().div_ceil(BODIES.inside_probes);
        let decide: Vec<DVec3> = off.iter().step_by(step).copied().collect();
        decide.iter().all(is_in).then(|| self.touch(Kind::Inside, (a, 0), (b, 0), decide[0]))
    }
}

/// A place where two faces cross each other off their borders, near a point: on both tangent planes at its feet, as Newton's method has it.
fn common(a: &BodyProbe, b: &BodyProbe, near: DVec3) -> Option<DVec3> {
    let tolerance = a.input.tolerance.point;
    let mut p = near;
    for _ in 0..BODIES.max_newton_steps {
        let (x, y) = (a.nearest.at(p), b.nearest.at(p));
        let (m, n) = (a.normal(&x), b.normal(&y));
        let cosine = m.dot(n);
        let sine2 = m.length_squared() * n.length_squared() - cosine * cosine;
        // Faces that touch along each other do not cross: an angle below a thousandth of a radian is no crossing.
        if sine2 <= FLAT {
            return None;
        }
        if x.distance.max(y.distance) <= 0.5 * tolerance {
            // Beside their common curve they must part by more than what touches.
            let (from, to) = (a.on(p) && a.is_inner(p, m), b.on(p) && b.is_inner(p, n));
            return (from && to).then_some(p);
        }
        let (off_a, off_b) = (m.dot(x.point - p), n.dot(y.point - p));
        p += (m * (off_a - cosine * off_b) + n * (off_b - cosine * off_a)) / sine2.max(SINGULAR);
    }
    None
}

fn hull_of(mesh: &Mesh, face: usize) -> Box3 {
    let range = |r: &std::ops::Range<u32>| r.start as usize..r.end as usize;
    let own = &mesh.faces[face];
    let quads = mesh.quads[range(&own.quads)].iter().flatten();
    Box3::of(mesh.triangles[range(&own.triangles)].iter().flatten().chain(quads).map(|n| mesh.nodes[*n as usize]))
}

/// The corners of all triangles, quads as two.
fn triangles(mesh: &Mesh) -> impl Iterator<Item = [u32; 3]> + '_ {
    let halves = |q: &[u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]];
    mesh.triangles.iter().copied().chain(mesh.quads.iter().flat_map(halves))
}

/// Volume inside a mesh, below 0 where its outside is within.
fn volume(mesh: &Mesh) -> f64 {
    let from = mesh.nodes.first().copied().unwrap_or_default();
    let corner = |n: u32| mesh.nodes[n as usize] - from;
    triangles(mesh).map(|[a, b, c]| corner(a).dot(corner(b).cross(corner(c)))).sum::<f64>() / 6.0
}
