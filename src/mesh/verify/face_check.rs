//! What must hold of every face of every mesh, looked at before the mesh is handed on: a failure is a bug in loft, and is told.
//!
//! The elements of a face are a surface whose border is that of the face: every edge is used once each way, but for those of
//! the border, which are used as the face's loops run. Edges that touch a border node are counted one by one; of the others
//! each way adds or takes away a number drawn from its nodes, and what is left over must be nothing. Together with the number
//! of elements, edges and nodes (Euler) this leaves no room for a filled hole, a gap, or an element that is there twice.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::base::fault::Fault;
use crate::base::text::real;
use crate::base::tolerance::{TOLD_APART, WHOLE_NUMBER};
use crate::base::{job, par};
use crate::mesh::border::layout::{Face, Layout, closes};
use crate::mesh::border::nodes::Nodes;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::data::face_mesh::{FaceMesh, element_ranges};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::fault::{Close, MeshFault};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::verify::covered_area::{self, CoveredArea};
use crate::surface::faults::CutFault;
use crate::surface::{Domain, Surface};

/// The elements of one face, and what is known of it.
pub struct Claim<'a> {
    /// Triangles of the face.
    pub triangles: &'a [[u32; 3]],
    /// Quads of the face.
    pub quads: &'a [[u32; 4]],
    /// The kind that was asked for.
    pub kind: Elements,
    /// Edges of the border with the elements on their left; one that the face meets on both sides is there twice.
    pub border: &'a [[u32; 2]],
    /// Edges of lines inside the face.
    pub lines: &'a [[u32; 2]],
    /// Single nodes inside the face that lie on no line.
    pub points: &'a [u32],
    /// First node of the face's own, and how many there are; lower ones are those of borders, lines and points.
    pub own: (u32, u32),
    /// Euler number of the face without its border: 1 for a disc, less 1 for each hole; `None` where it is not known.
    pub euler: Option<i64>,
}

/// What is wrong with a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// No element at all.
    Empty,
    /// An element of a kind that was not asked for.
    Kind,
    /// A node that is not of this face, or twice in one element.
    Node(u32),
    /// Nodes of its own that no element uses, the first of them.
    Loose(u32),
    /// An edge, how often elements run along it each way, and how often they should.
    Edge([u32; 2], [u32; 2], [u32; 2]),
    /// Edges between nodes inside that are not used once each way.
    Torn,
    /// The Euler number and the one that it should be.
    Euler(i64, i64),
    /// Elements that lie over each other in the parameter plane.
    Folded,
    /// The area that the elements cover in the parameter plane, and the one inside the loops of the surface.
    CoveredArea(f64, f64),
    /// A node, and how far it is from its place on the surface, model units.
    Misplaced(u32, f64),
}

impl Defect {
    /// In words that follow "a face where".
    fn words(self) -> String {
        match self {
            Self::Empty => "there is no element".to_owned(),
            Self::Kind => "elements are of another kind than asked for".to_owned(),
            Self::Node(_) => "an element has a node of another face or the same node twice".to_owned(),
            Self::Loose(_) => "nodes are in no element".to_owned(),
            Self::Edge(_, found, wanted) => {
                format!("elements run {} and {} times along an edge, and should {} and {}", found[0], found[1], wanted[0], wanted[1])
            }
            Self::Torn => "edges inside are not shared by two elements".to_owned(),
            Self::Euler(found, wanted) => format!("the Euler number inside is {found} and should be {wanted}"),
            Self::Folded => "elements overlap".to_owned(),
            Self::CoveredArea(found, wanted) => {
                format!(
                    "elements cover {} of the parameter plane, where the loops of the surface bound {}, or cover other parts of it",
                    real(found),
                    real(wanted)
                )
            }
            Self::Misplaced(_, off) => format!("a node is {} from its place on the surface", real(off)),
        }
    }

    /// A node that shows the place.
    fn node(self) -> Option<u32> {
        match self {
            Self::Node(n) | Self::Loose(n) | Self::Edge([n, _], ..) | Self::Misplaced(n, _) => Some(n),
            _ => None,
        }
    }
}

/// Uses of the edges that touch a border, what is left over of the others, and how many those are.
#[derive(Default)]
struct Tally {
    near: Vec<(u32, u32, bool)>,
    sum: u64,
    inside: u64,
}

impl Tally {
    fn add(&mut self, a: u32, b: u32, first: u32) {
        let (low, high) = (a.min(b), a.max(b));
        if low < first {
            self.near.push((low, high, a > b));
        } else {
            let drawn = drawn(low, high);
            self.sum = self.sum.wrapping_add(if a > b { drawn.wrapping_neg() } else { drawn });
            self.inside += 1;
        }
    }
}

/// A number for an edge that no other edges make up by chance (the finaliser of SplitMix [Steele, Lea & Flood 2014]).
fn drawn(low: u32, high: u32) -> u64 {
    let mut x = (u64::from(high) << 32 | u64::from(low)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

impl Claim<'_> {
    /// Whether the elements are what the face asks for.
    ///
    /// Fails with the first thing that is wrong.
    pub fn hold(&self) -> std::result::Result<(), Defect> {
        if self.triangles.is_empty() && self.quads.is_empty() {
            return Err(Defect::Empty);
        }
        if self.kind == Elements::Triangles && !self.quads.is_empty() || self.kind == Elements::Quads && !self.triangles.is_empty() {
            return Err(Defect::Kind);
        }
        let tally = self.tally()?;
        let (edges, nodes) = self.edges(&tally)?;
        if tally.sum != 0 || tally.inside % 2 != 0 {
            return Err(Defect::Torn);
        }
        let inside = i64::from(self.own.1) + nodes - edges - (tally.inside / 2) as i64;
        let made = inside + (self.triangles.len() + self.quads.len()) as i64;
        match self.euler {
            Some(wanted) if wanted != made => Err(Defect::Euler(made, wanted)),
            _ => Ok(()),
        }
    }

    /// All edges of all elements; every node must be one of the face's own or below them, and each own one must be used.
    fn tally(&self) -> std::result::Result<Tally, Defect> {
        let mut tally = Tally::default();
        let (first, own) = self.own;
        let mut used = vec![0_u64; own.div_ceil(64) as usize];
        let mut one = |corners: &[u32]| {
            for (k, &a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                if a == b || corners.len() == 4 && k < 2 && a == corners[k + 2] {
                    return Err(Defect::Node(a));
                }
                if let Some(at) = a.checked_sub(first) {
                    if at >= own {
                        return Err(Defect::Node(a));
                    }
                    used[at as usize / 64] |= 1 << (at % 64);
                }
                tally.add(a, b, first);
            }
            Ok(())
        };
        job::looking(self.triangles).try_for_each(|t| one(t))?;
        job::looking(self.quads).try_for_each(|q| one(q))?;
        let loose = (0..own).find(|n| used[*n as usize / 64] >> (n % 64) & 1 == 0);
        loose.map_or(Ok(tally), |n| Err(Defect::Loose(first + n)))
    }

    /// Edges that touch border nodes: the number of those inside the face, and of the lines' and points' nodes inside it.
    fn edges(&self, tally: &Tally) -> std::result::Result<(i64, i64), Defect> {
        // Uses by elements each way, then by the border.
        let mut edges: BTreeMap<(u32, u32), [u32; 4]> = BTreeMap::new();
        let mut near = tally.near.clone();
        near.sort_unstable();
        for same in near.chunk_by(|a, b| a == b) {
            edges.entry((same[0].0, same[0].1)).or_default()[usize::from(same[0].2)] = same.len() as u32;
        }
        let mut known: BTreeMap<u32, bool> = BTreeMap::new();
        for [a, b] in self.border {
            edges.entry((*a.min(b), *a.max(b))).or_default()[2 + usize::from(a > b)] += 1;
            known.extend([(*a, false), (*b, false)]);
        }
        for [a, b] in self.lines {
            edges.entry((*a.min(b), *a.max(b))).or_default();
        }
        for n in self.lines.iter().flatten().chain(self.points) {
            known.entry(*n).or_insert(true);
        }
        let mut inside = 0;
        for ((a, b), [one, other, along, against]) in edges {
            if let Some(foreign) = [a, b].into_iter().find(|n| *n < self.own.0 && !known.contains_key(n)) {
                return Err(Defect::Node(foreign));
            }
            let is_border = along + against > 0;
            let wanted = if is_border { [along, against] } else { [1, 1] };
            if [one, other] != wanted {
                return Err(Defect::Edge([a, b], [one, other], wanted));
            }
            inside += i64::from(!is_border);
        }
        Ok((inside, known.values().filter(|inner| **inner).count() as i64))
    }
}

/// What a face of a layout says of itself: its border and lines by nodes, and its Euler number.
struct Border {
    edges: Vec<[u32; 2]>,
    lines: Vec<[u32; 2]>,
    points: Vec<u32>,
    euler: Option<i64>,
}

impl Border {
    fn new(input: &Input, layout: &Layout, nodes: &Nodes, face: &Face) -> Self {
        let record = &input.model.patches[face.patch.index()];
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let mut own = Self { edges: Vec::new(), lines: Vec::new(), points: Vec::new(), euler: Some(1) };
        // The sides of each loop.
        let loops = if surface.domain() == Domain::Loop { surface.loops() } else { vec![face.sides.len()] };
        let (mut starts, mut side) = (Vec::new(), 0);
        for sides in loops {
            starts.push(own.edges.len());
            for k in side..(side + sides).min(face.sides.len()) {
                for used in &face.sides[k].uses {
                    let back = input.model.runs_back(record, k) != face.flipped;
                    let ids = nodes.of_segment(layout, used.segment, used.against);
                    own.edges.extend(ids.windows(2).map(|w| if back { [w[1], w[0]] } else { [w[0], w[1]] }));
                }
            }
            side += sides;
        }
        if surface.domain() == Domain::Loop {
            starts.push(own.edges.len());
            own.euler = euler(starts.windows(2).map(|w| &own.edges[w[0]..w[1]]));
        }
        for line in &face.lines {
            own.lines.extend(nodes.of_segment(layout, *line, false).windows(2).map(|w| [w[0], w[1]]));
        }
        own.points = face.points.iter().map(|k| nodes.points[*k]).collect();
        own
    }
}

/// Euler number of what lies inside some loops, without them: two less one for each, and one more for each node where two meet.
/// `None` where a loop meets itself, which may or may not part the inside.
fn euler<'a>(loops: impl Iterator<Item = &'a [[u32; 2]]>) -> Option<i64> {
    let (mut total, mut met): (i64, BTreeMap<u32, i64>) = (2, BTreeMap::new());
    for edges in loops.filter(|edges| !edges.is_empty()) {
        total -= 1;
        let mut starts: Vec<u32> = edges.iter().map(|e| e[0]).collect();
        starts.sort_unstable();
        let mut ways: Vec<[u32; 2]> = edges.to_vec();
        ways.sort_unstable();
        let is_seam = |n: u32| edges.iter().any(|[a, b]| (*a == n || *b == n) && ways.binary_search(&[*b, *a]).is_ok());
        if starts.windows(2).any(|w| w[0] == w[1] && !is_seam(w[0])) {
            return None;
        }
        starts.dedup();
        starts.into_iter().for_each(|n| *met.entry(n).or_insert(-1) += 1);
    }
    Some(total + met.into_values().sum::<i64>())
}

/// Sine below which a corner of an element is too sharp for its side to be told.
const SHARP: f64 = WHOLE_NUMBER;

/// What the elements of a face cover in the parameter plane, if they lie side by side: over rows by their places, and others by their
/// side where they are turned over in the parameter plane, which alone tells nothing beside a pole.
fn unfolded(ready: &FaceMesh, mesh: &Mesh) -> Option<CoveredArea> {
    let FaceGeometry { nodes, surface, .. } = &ready.geometry;
    let ascends = |side: &Vec<f64>| side.windows(2).all(|w| w[1] > w[0]);
    let mut covered = CoveredArea::default();
    match nodes {
        FaceNodes::Grid(grid, _) if grid.sides.iter().all(ascends) => {
            let (nu, nv) = grid.size();
            covered.add_quad([(0, 0), (nu, 0), (nu, nv), (0, nv)].map(|(i, j)| grid.uv(i, j).into()));
        }
        FaceNodes::Lattice(lattice, _) if lattice.sides.iter().all(ascends) => {
            let n = lattice.size();
            let [a, b, c] = [(0, 0), (n, 0), (0, n)].map(|(i, j)| lattice.uv(i, j).into());
            covered.add(a, b, c);
        }
        FaceNodes::Blocks(blocks, ids) => {
            let of = (blocks.uv.as_slice(), ids.as_slice(), mesh);
            job::looking(&blocks.quads).all(|q| faces_up(surface, of, q, &mut covered)).then_some(())?;
        }
        FaceNodes::Free(free, ids) => {
            let of = (free.uv.as_slice(), ids.as_slice(), mesh);
            let sound = job::looking(&free.triangles).all(|t| faces_up(surface, of, t, &mut covered))
                && job::looking(&free.quads).all(|q| faces_up(surface, of, q, &mut covered));
            sound.then_some(())?;
        }
        FaceNodes::Grid(..) | FaceNodes::Lattice(..) => return None,
    }
    Some(covered)
}

/// Whether an element is counter-clockwise in the parameter plane, or at least seen against the normal of the surface. What it covers
/// is added to the rest.
fn faces_up(surface: &Surface, (uv, ids, mesh): (&[(f64, f64)], &[u32], &Mesh), corners: &[u32], covered: &mut CoveredArea) -> bool {
    let at = |k: usize| DVec2::from(uv[corners[k] as usize]);
    let [a, b] = if corners.len() == 3 {
        covered.add(at(0), at(1), at(2));
        [at(1) - at(0), at(2) - at(0)]
    } else {
        covered.add_quad([at(0), at(1), at(2), at(3)]);
        [at(2) - at(0), at(3) - at(1)]
    };
    if a.perp_dot(b) > 0.0 {
        return true;
    }
    let p = |k: usize| mesh.nodes[ids[corners[k] as usize] as usize];
    let [a, b] = if corners.len() == 3 { [p(1) - p(0), p(2) - p(0)] } else { [p(2) - p(0), p(3) - p(1)] };
    let up = a.cross(b);
    if up.length() <= SHARP * a.length() * b.length() {
        return true;
    }
    let middle = (0..corners.len()).map(at).sum::<DVec2>() / corners.len() as f64;
    let normals = (0..corners.len()).map(at).chain([middle]).map(|at| surface.normal(at.x, at.y));
    normals.into_iter().any(|normal| up.dot(normal) >= 0.0)
}

/// What is wrong with where the elements of a face lie on its surface.
fn off_surface(input: &Input, (layout, nodes): (&Layout, &Nodes), (face, ready): (&Face, &FaceMesh), mesh: &Mesh) -> Option<Defect> {
    let Some(covered) = unfolded(ready, mesh) else { return Some(Defect::Folded) };
    let left_out = match (&ready.geometry.nodes, &ready.inside) {
        (FaceNodes::Free(free, ids), Some(inside)) if closes(face) => {
            let triangles = free.triangles.iter().map(|t| t.as_slice());
            let elements = triangles.chain(free.quads.iter().map(|q| q.as_slice()));
            let Some(out) = covered_area::left_out(elements, (&free.uv, ids, free.border), &inside.loops) else {
                return Some(Defect::Torn);
            };
            out
        }
        _ => CoveredArea::default(),
    };
    if let Err((found, wanted)) = covered_area::compare(input, (layout, nodes), face, covered.and(left_out)) {
        return Some(Defect::CoveredArea(found, wanted));
    }
    covered_area::misplaced(input, (face, ready), mesh).map(|(node, off)| Defect::Misplaced(node, off))
}

/// The first face whose elements are not what it asks for, and what is wrong.
pub(crate) fn unsound(input: &Input, (layout, nodes): (&Layout, &Nodes), prepared: &[FaceMesh], mesh: &Mesh) -> Option<(usize, Defect)> {
    let places = element_ranges(prepared);
    let found = par::map(prepared.len(), |f| {
        let (face, ready, (triangles, quads)) = (&layout.faces[f], &prepared[f], places[f].clone());
        let own = Border::new(input, layout, nodes, face);
        let claim = Claim {
            triangles: &mesh.triangles[triangles],
            quads: &mesh.quads[quads],
            kind: if face.free && face.method.of_triangles().is_some() { Elements::Triangles } else { face.elements },
            border: &own.edges,
            lines: &own.lines,
            points: &own.points,
            own: (ready.first, ready.inner as u32),
            euler: own.euler,
        };
        claim.hold().err().or_else(|| off_surface(input, (layout, nodes), (face, ready), mesh))
    });
    found.into_iter().enumerate().find_map(|(f, defect)| Some((f, defect?)))
}

/// E999 for a face whose elements are not what it asks for; E720 where it closes on itself or its border turns back along itself, and
/// its size leaves no room.
pub(crate) fn fault(
    input: &Input,
    (layout, nodes, face): (&Layout, &Nodes, &Face),
    (ready, defect): (&FaceMesh, Defect),
    mesh: &Mesh,
) -> Fault {
    let at = defect.node().and_then(|n| mesh.nodes.get(n as usize).copied());
    let at = at.unwrap_or_else(|| crate::mesh::border::layout::middle(input, face));
    let surface = input.model.surfaces[face.surface.index()].surface.origin();
    let method = if face.free { word(face.method) } else { "mapped" };
    if let Some(turn) = face.turns().next() {
        let at = layout.point(turn.segment, if turn.against { 0.0 } else { 1.0 });
        return MeshFault::ClosesTooNear { surface, method, at, close: Close::Turn }.into();
    }
    if face.halved > 0 {
        let is_pole = |n: u32| face.sides.iter().any(|side| side.pole.is_some_and(|pole| nodes.of_junction(pole) == n));
        let close = if defect.node().is_some_and(is_pole) { Close::Tip } else { Close::Seam };
        return MeshFault::ClosesTooNear { surface, method, at, close }.into();
    }
    let parted = crowded(input, (layout, nodes, face), defect);
    if let Some(fault) = parted.or_else(|| short(input, (layout, nodes, face), mesh)).or_else(|| folded(input, face, method)) {
        return fault;
    }
    MeshFault::Unsound {
        mesh: (input.plan.origin, input.plan.name.clone()),
        surface,
        method,
        elements: [ready.triangles, ready.quads],
        what: defect.words(),
        at,
    }
    .into()
}

/// E718 where the surface folds over or has no normal somewhere inside.
fn folded(input: &Input, face: &Face, method: &'static str) -> Option<Fault> {
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let (at, turn) = surface.fold(input.tolerance)?;
    Some(MeshFault::Folded { surface: surface.origin(), method, at, turn }.into())
}

/// E721 where borders and lines of a face part each other within what is told apart.
fn short(input: &Input, (layout, nodes, face): (&Layout, &Nodes, &Face), mesh: &Mesh) -> Option<Fault> {
    let own = Border::new(input, layout, nodes, face);
    let ends = |edge: &[u32; 2]| edge.map(|n| mesh.nodes[n as usize]);
    let edges = own.edges.iter().chain(&own.lines).map(ends).filter(|[a, b]| a != b);
    let [a, b] = edges.min_by(|[a, b], [c, d]| a.distance(*b).total_cmp(&c.distance(*d)))?;
    let apart = a.distance(b);
    let surface = input.model.surfaces[face.surface.index()].surface.origin();
    let fault = CutFault::CutsTooNear { surface, cuts: [surface; 2], at: a, apart, tolerance: input.tolerance.point };
    (apart <= TOLD_APART * input.tolerance.point).then(|| fault.into())
}

/// E721 where the edge of a line inside a face is in no element, since another line or border runs beside it within what is told apart.
fn crowded(input: &Input, (layout, nodes, face): (&Layout, &Nodes, &Face), defect: Defect) -> Option<Fault> {
    let Defect::Edge([a, b], ..) = defect else { return None };
    let is_edge = |w: &[u32]| w == [a, b] || w == [b, a];
    let place = |line: &usize| {
        let k = nodes.of_segment(layout, *line, false).windows(2).position(is_edge)?;
        let at = nodes.fractions(*line, false);
        Some((*line, layout.point(*line, 0.5 * (at[k] + at[k + 1]))))
    };
    let (line, at) = face.lines.iter().find_map(place)?;
    let near = TOLD_APART * input.tolerance.point;
    let others = face.segments().filter(|other| *other != line).map(|other| layout.distance(other, at));
    let apart = others.min_by(f64::total_cmp).filter(|apart| *apart <= near)?;
    let surface = input.model.surfaces[face.surface.index()].surface.origin();
    Some(CutFault::CutsTooNear { surface, cuts: [surface; 2], at, apart, tolerance: input.tolerance.point }.into())
}

/// The word of a method that makes faces freely.
fn word(method: Method) -> &'static str {
    match method {
        Method::Quadtree => "quadtree",
        Method::Isoline => "isoline",
        Method::Display => "display",
        _ => "delaunay",
    }
}
