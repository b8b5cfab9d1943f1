//! The faces of a mesh, and all segments of their borders and of its curves, each once.

use glam::DVec3;

use crate::mesh::border::loose::Loose;
use crate::mesh::border::lost::{self, Lost};
use crate::mesh::border::tracks::{by_link, curve_part, curve_parts, cut_on_others, edge_part, link_parts, oriented, reach};
use crate::mesh::border::{creases, inside};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::{Elements, Method};
use crate::model::gather::Station;
use crate::model::segments::{Part, SegmentUse, Segments, segments};
use crate::model::{EdgeId, PatchId, SurfaceId, VertexId};
use crate::network::{Chain, LinkId};

/// One side of a face, in the direction of ascending u or v.
#[derive(Clone, Debug, Default)]
pub struct FaceSide {
    /// Segments in order: `against` where the side runs against the segment; `s` on the side, from its start.
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
    /// Target size inside, model units, and its rule.
    pub size: (f64, Option<usize>),
    /// How far its border may be from the surface, model units: what its edges were glued over.
    pub near: f64,
    /// Sides in the order of the patch: four, or three of a triangle.
    pub sides: Vec<FaceSide>,
    /// Why it is meshed freely though it has a map.
    pub uneven: Option<Uneven>,
    /// It stays mapped whatever its map is like: meshed freely it failed, or turned out worse.
    pub kept: bool,
    /// Its rows are even: uneven ones would lean, or be more.
    pub even_rows: bool,
    /// Elements that it was foreseen to have where it is meshed freely for better angles.
    pub foreseen_free: u64,
    /// The least angle that its map was foreseen to have, radians.
    pub foreseen: Option<f64>,
    /// Times that the steps of its border were halved because it closes on itself and its elements did not keep apart.
    pub halved: u32,
    /// Why it is meshed freely though no method is written, in words that follow "a face".
    pub why: Option<String>,
    /// Segments of curves inside it.
    pub lines: Vec<usize>,
    /// Points of the plan inside it.
    pub points: Vec<usize>,
}

impl Face {
    /// Keeps its map from now on: meshed freely it turned out worse.
    pub fn keep_map(&mut self) {
        (self.uneven, self.kept) = (None, true);
    }

    /// Whether it is the triangle of a uniform trilateral.
    pub fn is_triangle(&self) -> bool {
        self.sides.len() == 3
    }

    /// Whether it is meshed freely of nothing but quads.
    pub fn takes_quads(&self) -> bool {
        self.free && self.elements == Elements::Quads
    }

    /// Whether it is meshed freely of triangles that are all alike.
    pub fn is_grown(&self) -> bool {
        self.free && self.elements == Elements::Triangles && !matches!(self.method, Method::Display | Method::Isoline)
    }

    /// Segments along which a side of its border runs there and back, as it runs there.
    pub fn turns(&self) -> impl Iterator<Item = SegmentUse> + '_ {
        self.sides.iter().flat_map(|side| side.uses.windows(2)).filter(|w| w[0].segment == w[1].segment).map(|w| w[0])
    }

    /// Segments round it and inside it.
    pub fn segments(&self) -> impl Iterator<Item = usize> + '_ {
        self.sides.iter().flat_map(|s| s.uses.iter().map(|u| u.segment)).chain(self.lines.iter().copied())
    }

    /// Whether one of its sides is a point.
    pub fn has_pole(&self) -> bool {
        self.sides.iter().any(|side| side.pole.is_some())
    }
}

/// Faces, segments and where they meet.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// Faces, surface by surface as listed.
    pub faces: Vec<Face>,
    /// Tracks of edges, then of links of the mesh's curves.
    pub parts: Vec<Part>,
    /// Segments and where they meet; elsewhere a segment is an index into `pieces.segments`.
    pub pieces: Segments,
    /// The edge of each of the first tracks, ascending.
    pub edges: Vec<EdgeId>,
    /// Segments of each link that has some, ascending along the link: segment, arc lengths on the link, runs against it.
    pub of_link: Vec<(LinkId, Vec<SegmentUse>)>,
    /// Segments of each curve of the plan, along it.
    pub curves: Vec<Vec<SegmentUse>>,
    /// Junction of each point of the plan; `None`: a node of its own.
    pub points: Vec<Option<usize>>,
    /// Segments of curves in which faces cross that are to be joined there.
    pub meets: Vec<usize>,
    /// Segments of kink lines inside trimmed faces, with the place of the face.
    pub creases: Vec<(usize, Vec<usize>)>,
    /// What is not in the mesh because it became a point or a line.
    pub lost: Vec<Lost>,
    /// A curve that shares no nodes with a face that it lies on.
    pub loose: Option<Loose>,
}

impl Layout {
    /// Lays out some patches with the curves and points of the plan (`with_lines`).
    pub fn new(input: &Input, patches: &[(PatchId, bool)], with_lines: bool) -> Self {
        let ids: Vec<PatchId> = patches.iter().map(|p| p.0).collect();
        let edges = input.model.edges_of(&ids);
        let imprint = input.plan.imprint.as_ref().map(|i| &i.0).filter(|_| with_lines);
        let mut parts: Vec<Part> = edges.iter().map(|e| edge_part(input, *e)).collect();
        if imprint.is_some() {
            edges.iter().zip(&mut parts).for_each(|(edge, part)| cut_on_others(input, *edge, &ids, part));
        }
        let links = if with_lines { link_parts(input, &mut parts) } else { Vec::new() };
        let alone = if with_lines { curve_parts(input, &mut parts) } else { Vec::new() };
        let met = parts.len()..parts.len() + imprint.map_or(0, |i| i.curves.len());
        parts.extend(imprint.into_iter().flat_map(|i| &i.curves).map(|chain| curve_part(input, chain)));
        for part in links.iter().map(|l| l.1).chain(alone.iter().map(|l| l.1)).chain(met.clone()) {
            let part = &mut parts[part];
            part.cuts.extend(inside::crossings(input, &ids, &part.track));
            part.cuts.sort_by(f64::total_cmp);
        }
        let creased = parts.len();
        let of_face: Vec<usize> = ids
            .iter()
            .enumerate()
            .flat_map(|(face, patch)| {
                let found = creases::of_patch(input, *patch);
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
            if input.model.is_sliver(*patch, &layout.edges, &layout.pieces, reach(input, std::iter::once(*patch))) {
                face_of.push(None);
                slivers.push(*patch);
                continue;
            }
            face_of.push(Some(layout.faces.len()));
            let face = layout.face(input, *patch, *flipped, junction);
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

    /// A patch with the segments of its sides; `junction` is the junction of a vertex.
    fn face(&self, input: &Input, patch: PatchId, flipped: bool, junction: impl Fn(VertexId) -> Option<usize>) -> Face {
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
            even_rows: false,
            foreseen_free: 0,
            foreseen: None,
            halved: 0,
            why: None,
            lines: Vec::new(),
            points: Vec::new(),
        }
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

/// Why a mapped face is meshed freely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uneven {
    /// A row would be as narrow as a piece of its border, model units.
    Row(f64),
    /// A free face beside it needs steps as short, model units.
    Beside(f64),
    /// Its map would have angles as sharp, radians.
    Sharp(f64),
    /// Its map would take this many times the elements of its first division to keep the size.
    Crowded(f64),
    /// One edge would stand for two, inside it and inside another face.
    Together,
}

/// Whether a face that is meshed freely meets itself at a seam or in a pole.
pub(crate) fn closes(face: &Face) -> bool {
    let mut round: Vec<usize> = face.sides.iter().flat_map(|s| s.segments()).collect();
    let all = round.len();
    round.sort_unstable();
    round.dedup();
    face.free && (round.len() < all || face.has_pole())
}
