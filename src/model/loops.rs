//! The loop of a patch: its border as one curve s ↦ (u, v), counter-clockwise from (min, min).

use glam::DVec3;

use super::topology::{EdgeId, Model, PatchId};
use super::trace::Trace;

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
    trace: Trace,
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
    /// (u, v) and point at the fraction `f` of the loop's arc length, 0 and 1 being the corner (min, min).
    pub fn at(&self, f: f64) -> ((f64, f64), DVec3) {
        let s = f.clamp(0.0, 1.0) * self.length;
        let k = self.pieces.partition_point(|p| p.s.1 < s).min(self.pieces.len() - 1);
        let piece = &self.pieces[k];
        let t = piece.trace.at_length(s - piece.s.0);
        (piece.trace.uv(t), piece.trace.jet(t).0)
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
        let corners = self.corners(patch);
        let record = &self.patches[patch.index()];
        let surface = &self.surfaces[record.surface.index()].surface;
        let (mut pieces, mut length) = (Vec::new(), 0.0);
        for (side, entry) in record.sides.iter().enumerate() {
            let (a, b) = (corners[side], corners[(side + 1) % corners.len()]);
            let backwards = self.runs_back(record, side);
            let mut edges: Vec<Option<(EdgeId, bool)>> = entry.edges.iter().map(|(e, against)| Some((*e, *against != backwards))).collect();
            if backwards {
                edges.reverse();
            }
            if edges.is_empty() {
                edges.push(None);
            }
            // Only the sides of a triangle are in several pieces; their corners are found by length.
            let whole = Trace::new(surface, a, b);
            let total: f64 = edges.iter().flatten().map(|(e, _)| self.edges[e.index()].length).sum();
            let (mut from, mut done) = (a, 0.0);
            for (n, edge) in edges.iter().enumerate() {
                done += edge.map_or(0.0, |(e, _)| self.edges[e.index()].length);
                let to = if n + 1 == edges.len() { b } else { whole.uv(whole.at_length(done * whole.length() / total)) };
                let trace = Trace::new(surface, from, to);
                let end = length + if edge.is_some() { trace.length() } else { 0.0 };
                pieces.push(Piece { edge: *edge, side, s: (length, end), from, to, trace });
                (length, from) = (end, to);
            }
        }
        Loop { pieces, length }
    }
}
