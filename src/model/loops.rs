//! The loop of a patch: its border as one curve s ↦ (u, v), counter-clockwise from (min, min).

use glam::DVec3;

use super::topology::{EdgeId, Model, Patch, PatchId};
use super::trace::Trace;
use crate::network::Chain;
use crate::surface::{Domain, Side, Surface};

/// The edges of a side in the direction of the loop, `true` where it runs against one.
type Edges = Vec<Option<(EdgeId, bool)>>;

/// What becomes a piece: its edge, its side and its way.
type PieceSource = (Option<(EdgeId, bool)>, usize, PieceGeometry);

/// The way of a piece over its own face.
#[derive(Clone, Debug)]
enum PieceGeometry {
    /// A straight line in (u, v).
    Line(Trace),
    /// A run of a chain along a border (by number) of a face without a map, between two fractions.
    Flat(Box<Surface>, usize, Chain, (f64, f64)),
}

impl PieceGeometry {
    fn length(&self) -> f64 {
        match self {
            Self::Line(trace) => trace.length(),
            Self::Flat(_, _, chain, (from, to)) => (to - from).abs() * chain.length(),
        }
    }

    /// (u, v) of both ends; they differ at a pole too.
    fn ends(&self) -> ((f64, f64), (f64, f64)) {
        match self {
            Self::Line(trace) => (trace.uv(0.0), trace.uv(1.0)),
            Self::Flat(..) => (self.at(0.0).0, self.at(self.length()).0),
        }
    }

    /// (u, v), point and derivative by the arc length, at an arc length; outside the nearer end.
    fn at(&self, s: f64) -> ((f64, f64), DVec3, DVec3) {
        match self {
            Self::Line(trace) => {
                let t = trace.at_length(s);
                let (p, d1) = trace.jet(t);
                (trace.uv(t), p, d1.normalize_or_zero())
            }
            Self::Flat(surface, side, chain, (from, to)) => {
                let f = from + (to - from) * (s / self.length()).clamp(0.0, 1.0);
                let jet = chain.jet(f);
                let uv = surface.border_place(*side, f).unwrap_or_default();
                (uv, surface.point(uv.0, uv.1), jet.d1.normalize_or_zero() * (to - from).signum())
            }
        }
    }
}

/// One edge of a loop. Lengths are arc lengths along the loop, model units.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The edge, with `true` where the loop runs against it; `None` at a pole.
    pub edge: Option<(EdgeId, bool)>,
    /// Side of the patch it lies on.
    pub side: usize,
    /// Where it begins and ends.
    pub s: (f64, f64),
    /// (u, v) where it begins.
    pub from: (f64, f64),
    /// (u, v) where it ends.
    pub to: (f64, f64),
    way: PieceGeometry,
}

impl Piece {
    /// (u, v), point and unit tangent (zero where there is none) on the face itself, at an arc length from where the piece
    /// begins; outside its length the nearer end.
    pub fn at(&self, s: f64) -> ((f64, f64), DVec3, DVec3) {
        self.way.at(s)
    }

    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.way.length()
    }
}

/// The border of a patch under one arc length.
#[derive(Clone, Debug)]
pub struct Loop {
    /// Edges in order; poles count with length 0.
    pub pieces: Vec<Piece>,
    /// Arc length, model units.
    pub length: f64,
}

impl Loop {
    /// Ways one after the other; one without an edge is a pole.
    fn of(ways: Vec<PieceSource>) -> Self {
        let (mut pieces, mut length) = (Vec::new(), 0.0);
        for (edge, side, way) in ways {
            let whole = way.length();
            let (from, to) = way.ends();
            let end = length + if edge.is_some() { whole } else { 0.0 };
            pieces.push(Piece { edge, side, s: (length, end), from, to, way });
            length = end;
        }
        Self { pieces, length }
    }

    /// (u, v) and point at the fraction `f` of the loop's arc length, 0 and 1 being the corner (min, min).
    pub fn at(&self, f: f64) -> ((f64, f64), DVec3) {
        let s = f.clamp(0.0, 1.0) * self.length;
        let k = self.pieces.partition_point(|p| p.s.1 < s).min(self.pieces.len() - 1);
        let piece = &self.pieces[k];
        let (uv, point, _) = piece.at(s - piece.s.0);
        (uv, point)
    }

    /// Fractions and (u, v) of the vertices along the loop, the first one again at the end.
    pub fn breakpoints(&self) -> Vec<(f64, (f64, f64))> {
        let mut points: Vec<_> = self.pieces.iter().map(|p| (p.s.0 / self.length, p.from)).collect();
        points.extend(self.pieces.last().map(|p| (1.0, p.to)));
        points
    }
}

impl Model {
    /// Corners (u, v) of a patch, counter-clockwise from (min, min): where side k begins on the loop.
    pub fn corners(&self, patch: PatchId) -> Vec<(f64, f64)> {
        let patch = &self.patches[patch.index()];
        let ((u0, u1), (v0, v1)) = (patch.u, patch.v);
        if patch.sides.len() == 3 { vec![(u0, v0), (u1, v0), (u0, v1)] } else { vec![(u0, v0), (u1, v0), (u1, v1), (u0, v1)] }
    }

    /// The loop of a patch [Koh & Park 1990, §4.3].
    pub fn loop_of(&self, patch: PatchId) -> Loop {
        let record = &self.patches[patch.index()];
        let surface = &self.surfaces[record.surface.index()].surface;
        let mut pieces = Vec::new();
        for (side, entry) in record.sides.iter().enumerate() {
            let backwards = self.runs_back(record, side);
            let mut edges: Edges = entry.edges.iter().map(|(e, against)| Some((*e, *against != backwards))).collect();
            if backwards {
                edges.reverse();
            }
            if edges.is_empty() {
                edges.push(None);
            }
            let ways =
                if surface.domain() == Domain::Loop { self.flat(surface, side, &edges) } else { self.lines(patch, record, side, &edges) };
            pieces.extend(edges.into_iter().zip(ways).map(|(edge, way)| (edge, side, way)));
        }
        Loop::of(pieces)
    }

    /// Lengths of edges, each up to its end, and of all.
    fn shares(&self, edges: &Edges) -> (Vec<f64>, f64) {
        let mut total = 0.0;
        let ends = edges.iter().map(|edge| {
            total += edge.map_or(0.0, |(e, _)| self.edges[e.index()].length);
            total
        });
        (ends.collect(), total)
    }

    /// Edges of a side that is a line in (u, v). Only the sides of a triangle are in several pieces; their corners are found by length.
    fn lines(&self, patch: PatchId, record: &Patch, side: usize, edges: &Edges) -> Vec<PieceGeometry> {
        let surface = &self.surfaces[record.surface.index()].surface;
        let corners = self.corners(patch);
        let (a, b) = (corners[side], corners[(side + 1) % corners.len()]);
        let whole = Trace::new(surface, a, b);
        let (ends, total) = self.shares(edges);
        let mut from = a;
        let way = |(n, end): (usize, &f64)| {
            let to = if n + 1 == edges.len() { b } else { whole.uv(whole.at_length(end * whole.length() / total)) };
            PieceGeometry::Line(Trace::new(surface, std::mem::replace(&mut from, to), to))
        };
        ends.iter().enumerate().map(way).collect()
    }

    /// Edges of a side of a plane without a map: runs of the chain along it.
    fn flat(&self, surface: &Surface, side: usize, edges: &Edges) -> Vec<PieceGeometry> {
        let Side::Chain { chain, from, to } = surface.side(side) else {
            // A straight line in (u, v): a natural border that no curve carries, or a pole.
            let Some((from, to)) = surface.border_line(side) else { return Vec::new() };
            return edges.iter().map(|_| PieceGeometry::Line(Trace::new(surface, from, to))).collect();
        };
        let (ends, total) = self.shares(edges);
        let mut before = from;
        let way = |(n, end): (usize, &f64)| {
            let after = if n + 1 == edges.len() { to } else { from + (to - from) * end / total };
            PieceGeometry::Flat(Box::new(surface.clone()), side, chain.clone(), (std::mem::replace(&mut before, after), after))
        };
        ends.iter().enumerate().map(way).collect()
    }
}
