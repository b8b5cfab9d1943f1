//! What a mesh stands on: its faces, and all segments of their borders and of its curves, each once.

use glam::DVec3;

use crate::mesh::border::lost::{self, Lost};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::request::plan::Target;
use crate::model::gather::Station;
use crate::model::glue::preference;
use crate::model::segments::{Part, SegmentUse, Segments, segments};
use crate::model::{EdgeCurve, EdgeId, EdgePart, PatchId, SurfaceId, Trace, Track};
use crate::network::{Chain, LinkId};
use crate::surface::{Domain, Surface};

/// One side of a face, in the direction of ascending u or v.
#[derive(Clone, Debug, Default)]
pub struct FaceSide {
    /// Stretches in order: `against` where the side runs against the segment; `s` on the side, from its start.
    pub uses: Vec<SegmentUse>,
    /// The junction of the pole.
    pub pole: Option<usize>,
    /// Length of the side, model units.
    pub length: f64,
}

impl FaceSide {
    /// The segments of the side.
    pub fn segments(&self) -> Vec<usize> {
        self.uses.iter().map(|u| u.segment).collect()
    }
}

/// A patch to mesh.
#[derive(Clone, Debug)]
pub struct Face {
    /// The patch.
    pub patch: PatchId,
    /// Its surface.
    pub surface: SurfaceId,
    /// The other side is up.
    pub flipped: bool,
    /// Kind of elements.
    pub elements: Elements,
    /// Method.
    pub method: Method,
    /// Made freely: grown from its border instead of mapped.
    pub free: bool,
    /// Target size inside, model units, and the rule that says so.
    pub size: (f64, Option<usize>),
    /// How far its border may be from the surface, model units: what its edges were glued over.
    pub near: f64,
    /// Sides in the order of the patch: four, or three of a triangle.
    pub sides: Vec<FaceSide>,
    /// What rows would have to follow, or keep others from following: it is made freely for that.
    pub uneven: Option<Uneven>,
    /// It stays mapped whatever its map is like: made freely it failed, or turned out worse.
    pub kept: bool,
    /// Elements that it was foreseen to have where it is made freely for better angles.
    pub foreseen_free: u64,
    /// The least angle that its map was foreseen to have, radians.
    pub foreseen: Option<f64>,
    /// Times that the steps of its border were halved because it closes on itself and its elements did not keep apart.
    pub halved: u32,
    /// Why it is made freely though no method says so, in words that follow "a face".
    pub why: Option<String>,
    /// Stretches of curves inside it.
    pub lines: Vec<usize>,
    /// Points of the plan inside it.
    pub points: Vec<usize>,
}

impl Face {
    /// Has it made by its map from now on: freely it turned out worse.
    pub fn keep_map(&mut self) {
        (self.uneven, self.kept) = (None, true);
    }

    /// Whether it is the triangle of a uniform trilateral.
    pub fn is_triangle(&self) -> bool {
        self.sides.len() == 3
    }

    /// Whether it is made freely of nothing but quads.
    pub fn takes_quads(&self) -> bool {
        self.free && self.elements == Elements::Quads
    }

    /// Whether it is made freely of triangles that are all alike.
    pub fn is_grown(&self) -> bool {
        self.free && self.elements == Elements::Triangles && !matches!(self.method, Method::Display | Method::Isoline)
    }

    /// Stretches along which a side of its border runs there and back, as it runs there.
    pub fn turns(&self) -> impl Iterator<Item = SegmentUse> + '_ {
        self.sides.iter().flat_map(|side| side.uses.windows(2)).filter(|w| w[0].segment == w[1].segment).map(|w| w[0])
    }

    /// Stretches round it and inside it.
    pub fn segments(&self) -> impl Iterator<Item = usize> + '_ {
        self.sides.iter().flat_map(|s| s.uses.iter().map(|u| u.segment)).chain(self.lines.iter().copied())
    }
}

/// Faces, segments and where they meet.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// Faces, surface by surface as listed.
    pub faces: Vec<Face>,
    /// Tracks of edges, then of links of the mesh's curves.
    pub parts: Vec<Part>,
    /// Stretches; where a comment says "segment" it is an index into `pieces.segments`.
    pub pieces: Segments,
    /// The edge of each of the first tracks, ascending.
    pub edges: Vec<EdgeId>,
    /// Stretches of each link that has some, ascending along the link: segment, arc lengths on the link, runs against it.
    pub of_link: Vec<(LinkId, Vec<SegmentUse>)>,
    /// Stretches of each curve of the plan, along it.
    pub curves: Vec<Vec<SegmentUse>>,
    /// Junction of each point of the plan; `None`: a node of its own.
    pub points: Vec<Option<usize>>,
    /// Stretches of curves in which faces cross that are to be joined there.
    pub meets: Vec<usize>,
    /// Stretches of kink lines inside trimmed faces, with the place of the face.
    pub creases: Vec<(usize, Vec<usize>)>,
    /// What is not in the mesh because it became a point or a line.
    pub lost: Vec<Lost>,
}

impl Layout {
    /// Lays out some patches with the curves and points of the plan (`with_lines`).
    pub fn new(input: &Input, patches: &[(PatchId, bool)], with_lines: bool) -> Self {
        let ids: Vec<PatchId> = patches.iter().map(|p| p.0).collect();
        let edges = input.model.edges_of(&ids);
        let imprint = input.plan.imprint.as_ref().map(|i| &i.0).filter(|_| with_lines);
        let mut parts: Vec<Part> = edges.iter().map(|e| edge_part(input, *e)).collect();
        if imprint.is_some() {
            edges.iter().zip(&mut parts).for_each(|(edge, part)| cut_on_others(input, (*edge, &ids), part));
        }
        let links = if with_lines { link_parts(input, &mut parts) } else { Vec::new() };
        let alone = if with_lines { lone_parts(input, &mut parts) } else { Vec::new() };
        let met = parts.len()..parts.len() + imprint.map_or(0, |i| i.curves.len());
        parts.extend(imprint.into_iter().flat_map(|i| &i.curves).map(|chain| lone_part(input, chain)));
        for part in links.iter().map(|l| l.1).chain(alone.iter().map(|l| l.1)).chain(met.clone()) {
            let part = &mut parts[part];
            part.cuts.extend(crate::mesh::border::inside::crossings(input, &ids, &part.track));
            part.cuts.sort_by(f64::total_cmp);
        }
        let creased = parts.len();
        let of_face: Vec<usize> = ids
            .iter()
            .enumerate()
            .flat_map(|(face, patch)| {
                let found = crate::mesh::border::creases::of_patch(input, *patch);
                let n = found.len();
                parts.extend(found);
                std::iter::repeat_n(face, n)
            })
            .collect();
        // Points and curves of the mesh join whatever edge is glued.
        let most = reach(input, patches.iter().map(|p| p.0));
        parts[edges.len()..].iter_mut().for_each(|part| part.near = most);
        let station = |point: DVec3| Station { point, reach: most };
        let vertices = input.model.vertices_of(&ids);
        let mut anchors: Vec<Station> = vertices.iter().map(|v| station(input.model.vertices[v.index()].point)).collect();
        for part in &links {
            let ends = input.network.links[part.0.index()].nodes;
            anchors.extend([ends.0, ends.1].map(|n| station(input.network.nodes[n.index()].point)));
        }
        let nodes = anchors.len();
        if with_lines {
            anchors.extend(input.plan.points.iter().map(|p| station(*p)));
        }
        let last = anchors.len();
        anchors.extend(imprint.into_iter().flat_map(|i| &i.points).map(|p| station(*p)));
        let pieces = segments(&parts, &anchors, input.tolerance);
        let of_link = by_link(input, &edges, &links, &pieces);
        let mut layout = Self { parts, pieces, of_link, edges, ..Self::default() };
        layout.points = layout.pieces.of_anchor[nodes..last].to_vec();
        layout.meets = met.flat_map(|part| layout.pieces.of_track[part].iter().map(|u| u.segment)).collect();
        let segments = |part: usize| layout.pieces.of_track[part].iter().map(|u| u.segment).collect();
        let mut creases: Vec<(usize, Vec<usize>)> = of_face.iter().enumerate().map(|(k, n)| (*n, segments(creased + k))).collect();
        // Patches that are slivers have no face.
        let (mut face_of, mut slivers): (Vec<Option<usize>>, Vec<PatchId>) = (Vec::with_capacity(patches.len()), Vec::new());
        for (patch, flipped) in patches {
            let junction = |v| vertices.binary_search(&v).ok().and_then(|at| layout.pieces.of_anchor[at]);
            if input.model.is_sliver(*patch, (&layout.edges, &layout.pieces), reach(input, std::iter::once(*patch))) {
                face_of.push(None);
                slivers.push(*patch);
                continue;
            }
            face_of.push(Some(layout.faces.len()));
            let face = layout.face(input, (*patch, *flipped), junction);
            layout.faces.push(face);
        }
        creases.retain_mut(|crease| face_of[crease.0].map(|face| crease.0 = face).is_some());
        layout.creases = creases;
        if with_lines {
            let along = |(k, (_, chain)): (usize, &(String, Chain))| match alone.iter().find(|a| a.0 == k) {
                Some((_, part)) => layout.pieces.of_track[*part].clone(),
                None => layout.along(input, chain),
            };
            layout.curves = input.plan.curves.iter().enumerate().map(along).collect();
        }
        layout.lost = lost::find(input, &layout, &slivers);
        layout
    }

    fn face(&self, input: &Input, (patch, flipped): (PatchId, bool), junction: impl Fn(crate::model::VertexId) -> Option<usize>) -> Face {
        let record = &input.model.patches[patch.index()];
        let mut sides = Vec::new();
        for side in &record.sides {
            let mut border = FaceSide { pole: side.pole.and_then(&junction), ..FaceSide::default() };
            let mut corner = None;
            for (edge, against) in &side.edges {
                let Ok(part) = self.edges.binary_search(edge) else { continue };
                let length = self.parts[part].track.length();
                border.uses.extend(oriented(&self.pieces.of_track[part], *against, length, border.length));
                border.length += length;
                corner = corner.or(Some(self.pieces.starts[part]));
            }
            // A side that was glued together is a corner.
            if border.uses.is_empty() {
                border.pole = border.pole.or(corner);
            }
            sides.push(border);
        }
        let plan = input.plan;
        Face {
            patch,
            surface: record.surface,
            flipped,
            elements: plan.settings.elements(),
            method: plan.settings.method(),
            free: false,
            size: (0.0, None),
            near: reach(input, std::iter::once(patch)),
            sides,
            uneven: None,
            kept: false,
            foreseen_free: 0,
            foreseen: None,
            halved: 0,
            why: None,
            lines: Vec::new(),
            points: Vec::new(),
        }
    }

    /// Stretches of a border in its direction, `s` from its start; those of edges that are in the mesh.
    pub fn along_course(&self, course: &[EdgePart]) -> Vec<SegmentUse> {
        let (mut uses, mut start) = (Vec::new(), 0.0);
        for part in course {
            let (from, to) = part.s;
            if let Ok(track) = self.edges.binary_search(&part.edge) {
                let inside = |u: &&SegmentUse| 0.5 * (u.s.0 + u.s.1) > from && 0.5 * (u.s.0 + u.s.1) < to;
                let own = self.pieces.of_track[track].iter().filter(inside);
                let own: Vec<SegmentUse> = own.map(|u| SegmentUse { s: (u.s.0 - from, u.s.1 - from), ..*u }).collect();
                uses.extend(oriented(&own, part.against, to - from, start));
            }
            start += to - from;
        }
        uses
    }

    /// Stretches of a chain in its direction, `s` from its start: those of links that are in the mesh, and those of borders
    /// that run along it without being links of it.
    pub fn along(&self, input: &Input, chain: &Chain) -> Vec<SegmentUse> {
        let mut uses = self.along_links(input, chain);
        let covered: f64 = uses.iter().map(|u| u.s.1 - u.s.0).sum();
        if covered < chain.length() - input.tolerance.point {
            let known: Vec<usize> = uses.iter().map(|u| u.segment).collect();
            uses.extend(crate::mesh::border::beside::lying_on(input, self, chain).into_iter().filter(|u| !known.contains(&u.segment)));
            uses.sort_by(|a, b| a.s.0.total_cmp(&b.s.0).then(a.segment.cmp(&b.segment)));
        }
        uses
    }

    /// Stretches of the links of a chain.
    fn along_links(&self, input: &Input, chain: &Chain) -> Vec<SegmentUse> {
        let Some(links) = input.network.links_of(chain, input.tolerance) else {
            return Vec::new();
        };
        let (mut uses, mut start) = (Vec::new(), 0.0);
        for (link, against) in links {
            let s = input.network.links[link.index()].s;
            if let Ok(at) = self.of_link.binary_search_by_key(&link, |l| l.0) {
                uses.extend(oriented(&self.of_link[at].1, against, s.1 - s.0, start));
            }
            start += s.1 - s.0;
        }
        uses
    }

    /// What a segment lies on, by name: its curve, or the surface whose line it is.
    pub fn name_of(&self, input: &Input, segment: usize) -> String {
        let on_link = self.of_link.iter().find(|(_, uses)| uses.iter().any(|u| u.segment == segment));
        if let Some((link, _)) = on_link {
            let curve = input.network.links[link.index()].curve;
            return input.network.curves[curve.index()].name.clone();
        }
        let on_face = self.faces.iter().find(|f| f.sides.iter().any(|s| s.uses.iter().any(|u| u.segment == segment)));
        match on_face {
            Some(face) => format!("a border in {}", input.model.surfaces[face.surface.index()].name),
            None => "a curve".to_owned(),
        }
    }

    /// Stretches that an edge or a curve runs along, each once, in no order that means anything.
    pub fn on(&self, input: &Input, target: &Target) -> Vec<usize> {
        let uses = match target {
            Target::Chain(chain) => self.along(input, chain),
            Target::Edge(courses) => courses.iter().flat_map(|course| self.along_course(course)).collect(),
            Target::Surface(_) | Target::Patches(_) | Target::Point(_) => Vec::new(),
        };
        let mut segments: Vec<usize> = uses.iter().map(|u| u.segment).collect();
        segments.sort_unstable();
        segments.dedup();
        segments
    }

    /// Length of a segment, model units.
    pub fn length(&self, segment: usize) -> f64 {
        self.pieces.segments[segment].length()
    }

    /// Points of a segment at ascending fractions of its length.
    pub fn points_along(&self, segment: usize, fractions: &[f64]) -> Vec<DVec3> {
        fractions.iter().map(|f| self.point(segment, *f)).collect()
    }

    /// Distance of a point from a segment, never below the true one and above it by a thousandth at most.
    pub fn distance(&self, segment: usize, p: DVec3) -> f64 {
        let segment = &self.pieces.segments[segment];
        self.parts[segment.track].track.closest(p, segment.s).1
    }

    /// Point of a segment at a fraction of its length.
    pub fn point(&self, segment: usize, fraction: f64) -> DVec3 {
        let segment = &self.pieces.segments[segment];
        self.parts[segment.track].track.point(segment.s.0 + (segment.s.1 - segment.s.0) * fraction)
    }
}

/// How far edges of some patches are glued at most, or curves of their nets miss each other.
fn reach(input: &Input, patches: impl Iterator<Item = PatchId>) -> f64 {
    let of = |p: PatchId| {
        let surface = input.model.patches[p.index()].surface;
        let glued = input.plan.glue.get(&surface).copied();
        let missed = input.model.surfaces[surface.index()].surface.net_gaps().first().map(|gap| gap.by);
        glued.into_iter().chain(missed)
    };
    patches.flat_map(of).fold(input.tolerance.point, f64::max)
}

/// Uses of a track as seen by something that runs along or against it and places it at `start`.
fn oriented(uses: &[SegmentUse], against: bool, length: f64, start: f64) -> Vec<SegmentUse> {
    let turn = |u: &SegmentUse| {
        if against {
            SegmentUse { segment: u.segment, against: !u.against, s: (start + length - u.s.1, start + length - u.s.0) }
        } else {
            SegmentUse { s: (start + u.s.0, start + u.s.1), ..*u }
        }
    };
    if against { uses.iter().rev().map(turn).collect() } else { uses.iter().map(turn).collect() }
}

/// An edge as a track, cut where its links end.
fn edge_part(input: &Input, edge: EdgeId) -> Part {
    let track = input.model.track(edge, input.network);
    let cuts = track.joints(input.tolerance);
    let users = &input.model.edges[edge.index()].users;
    let near = reach(input, users.iter().map(|(p, _)| *p));
    Part { track, cuts, rank: preference(&input.model.edges[edge.index()].curve), near }
}

/// Adds the links of the plan's curves as tracks of their own; gives link and part, ascending.
fn link_parts(input: &Input, parts: &mut Vec<Part>) -> Vec<(LinkId, usize)> {
    let chains = input.plan.curves.iter().map(|c| &c.1);
    let mut links: Vec<LinkId> =
        chains.filter_map(|c| input.network.links_of(c, input.tolerance)).flatten().map(|(link, _)| link).collect();
    links.sort_unstable();
    links.dedup();
    links
        .into_iter()
        .map(|link| {
            let s = input.network.links[link.index()].s;
            let curve = EdgeCurve::Links { links: vec![(link, false)], span: (0.0, s.1 - s.0) };
            parts.push(Part { track: Track::of(&curve, &[], input.network), cuts: Vec::new(), rank: 0, near: input.tolerance.point });
            (link, parts.len() - 1)
        })
        .collect()
}

/// Adds the plan's curves that are not in the network as tracks of their own; gives curve and part.
fn lone_parts(input: &Input, parts: &mut Vec<Part>) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (k, (_, chain)) in input.plan.curves.iter().enumerate() {
        if input.network.links_of(chain, input.tolerance).is_none() {
            parts.push(lone_part(input, chain));
            found.push((k, parts.len() - 1));
        }
    }
    found
}

/// A chain as a track of its own.
fn lone_part(input: &Input, chain: &Chain) -> Part {
    let curve = EdgeCurve::Run { chain: chain.clone(), span: (0.0, chain.length()) };
    let cuts = chain.joints().iter().map(|f| f * chain.length()).filter(|s| *s > 0.0 && *s < chain.length()).collect();
    Part { track: Track::of(&curve, &[], input.network), cuts, rank: preference(&curve), near: input.tolerance.point }
}

/// Cuts an edge where it runs over borders between patches of surfaces that it is no edge of.
fn cut_on_others(input: &Input, (edge, patches): (EdgeId, &[PatchId]), part: &mut Part) {
    let surface = |p: PatchId| input.model.patches[p.index()].surface;
    let own: Vec<SurfaceId> = input.model.edges[edge.index()].users.iter().map(|(p, _)| surface(*p)).collect();
    let others: Vec<PatchId> = patches.iter().copied().filter(|p| !own.contains(&surface(*p))).collect();
    part.cuts.extend(crate::mesh::border::inside::crossings(input, &others, &part.track));
    part.cuts.sort_by(f64::total_cmp);
}

/// Stretches of each link, along the link.
fn by_link(input: &Input, edges: &[EdgeId], links: &[(LinkId, usize)], pieces: &Segments) -> Vec<(LinkId, Vec<SegmentUse>)> {
    let mut found: std::collections::BTreeMap<LinkId, Vec<SegmentUse>> = std::collections::BTreeMap::new();
    for (link, part) in links {
        found.entry(*link).or_default().extend(&pieces.of_track[*part]);
    }
    for (part, edge) in edges.iter().enumerate() {
        let EdgeCurve::Links { links, span } = &input.model.edges[edge.index()].curve else {
            continue;
        };
        let mut start = -span.0;
        for (link, against) in links {
            let s = input.network.links[link.index()].s;
            let length = s.1 - s.0;
            let inside = |u: &&SegmentUse| 0.5 * (u.s.0 + u.s.1) > start && 0.5 * (u.s.0 + u.s.1) < start + length;
            let own: Vec<SegmentUse> =
                pieces.of_track[part].iter().filter(inside).map(|u| SegmentUse { s: (u.s.0 - start, u.s.1 - start), ..*u }).collect();
            found.entry(*link).or_default().extend(oriented(&own, *against, length, 0.0));
            start += length;
        }
    }
    for uses in found.values_mut() {
        uses.sort_by(|a, b| a.s.0.total_cmp(&b.s.0).then(a.segment.cmp(&b.segment)));
        uses.dedup_by_key(|u| u.segment);
    }
    found.into_iter().collect()
}

/// Side parameters (u or v of the surface, ascending) at lengths along a side of a face.
pub fn side_parameters(input: &Input, face: &Face, side: usize, lengths: &[f64]) -> Vec<f64> {
    let record = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let triangle = face.is_triangle();
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    let along_u = side == 0 || side == 2 && !triangle;
    let (low, high) = if along_u { (u0, u1) } else { (v0, v1) };
    let total = face.sides[side].length;
    let mut at: Vec<f64> = match chain_side(surface, side, record.u, record.v, triangle) {
        Some(()) => {
            let (from, to) = (surface.side_fraction(side, low), surface.side_fraction(side, high));
            lengths.iter().map(|s| surface.side_parameter(side, from + (to - from) * (s / total))).collect()
        }
        None => {
            let (from, to) = match (triangle, side) {
                (true, 1) => ((1.0, 0.0), (0.0, 1.0)),
                (true, 2) | (false, 3) => ((u0, v0), (u0, v1)),
                (_, 0) => ((u0, v0), (u1, v0)),
                (_, 1) => ((u1, v0), (u1, v1)),
                _ => ((u0, v1), (u1, v1)),
            };
            let trace = Trace::new(surface, from, to);
            lengths.iter().map(|s| low + (high - low) * trace.at_length(s / total * trace.length())).collect()
        }
    };
    if let (Some(first), Some(s)) = (at.first_mut(), lengths.first())
        && *s == 0.0
    {
        *first = low;
    }
    if let (Some(last), Some(s)) = (at.last_mut(), lengths.last())
        && *s == total
    {
        *last = high;
    }
    at
}

/// Whether a side of a patch lies on a border of the surface that a chain carries.
fn chain_side(surface: &Surface, side: usize, u: (f64, f64), v: (f64, f64), triangle: bool) -> Option<()> {
    let on_border = triangle && surface.domain() == Domain::Triangle
        || match side {
            0 => v.0 == 0.0,
            1 => u.1 == 1.0,
            2 => v.1 == 1.0,
            _ => u.0 == 0.0,
        };
    (on_border && matches!(surface.side(side), crate::surface::Side::Chain { .. })).then_some(())
}

/// A point in the middle of a face.
pub fn middle(input: &Input, face: &Face) -> DVec3 {
    let patch = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    if face.is_triangle() {
        surface.point(1.0 / 3.0, 1.0 / 3.0)
    } else {
        surface.point(0.5 * (patch.u.0 + patch.u.1), 0.5 * (patch.v.0 + patch.v.1))
    }
}

/// Why a mapped face is made freely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uneven {
    /// A row would be as narrow as a piece of its border, model units.
    Row(f64),
    /// A free face beside it needs steps as short, model units.
    Beside(f64),
    /// Its map would have angles as sharp, radians.
    Sharp(f64),
    /// One edge would stand for two, inside it and inside another face.
    Together,
}

/// Whether a face that is made freely meets itself at a seam or in a pole.
pub(crate) fn closes(face: &Face) -> bool {
    let mut round: Vec<usize> = face.sides.iter().flat_map(|s| s.segments()).collect();
    let all = round.len();
    round.sort_unstable();
    round.dedup();
    face.free && (round.len() < all || face.sides.iter().any(|side| side.pole.is_some()))
}
