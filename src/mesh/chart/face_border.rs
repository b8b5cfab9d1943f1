//! The border of a face in its chart: the nodes of its segments, each with its own (u, v), and the edges between them.

use std::collections::BTreeMap;

use crate::base::tolerance::NUDGE;
use crate::mesh::border::layout::Face;
use crate::mesh::border::nodes::line as line_of;
use crate::mesh::border::side_parameters::side_parameters;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::embedded;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::request::input::Input;
use crate::model::{Patch, Trace};
use crate::surface::{Domain, Side, Surface};

/// Feet of one point nearer than this in u and v are one place.
pub(crate) const ONE_PLACE: f64 = NUDGE;

/// Ends of two borders of one face that became one junction lie within this many glue distances of each other in the chart,
/// whose lengths are right on average only.
const MAX_GLUE_DISTANCES: f64 = 8.0;

/// Nodes of a border with their places, in order of first use.
#[derive(Default)]
pub struct FaceBorder {
    pub(crate) uv: Vec<(f64, f64)>,
    pub(crate) ids: Vec<u32>,
    pub(crate) edges: Vec<[u32; 2]>,
    /// Edges of lines inside.
    pub(crate) lines: Vec<[u32; 2]>,
}

impl FaceBorder {
    /// Edges of the chart where a loop passes a pole: it goes on at another place of the same node.
    fn jump(&mut self, loops: &[usize], ends: &[Option<(u32, u32)>]) {
        let mut rest = ends;
        for n in loops {
            let (own, others) = rest.split_at(*n);
            rest = others;
            let own: Vec<(u32, u32)> = own.iter().copied().flatten().collect();
            for k in 0..own.len() {
                let (from, to) = (own[k].1, own[(k + 1) % own.len()].0);
                if from != to {
                    self.edges.push([from, to]);
                }
            }
        }
    }

    /// Places of one node that are no further apart than borders were glued over become one: on the face itself the ends of
    /// its borders need not meet.
    pub(crate) fn close(&mut self, chart: &Chart, near: f64) {
        let mut into: Vec<u32> = (0..self.ids.len() as u32).collect();
        for n in 0..self.ids.len() {
            let here = chart.xy(self.uv[n]);
            let first = (0..n).find(|m| self.ids[*m] == self.ids[n] && chart.xy(self.uv[*m]).distance(here) <= MAX_GLUE_DISTANCES * near);
            into[n] = first.map_or(into[n], |m| into[m]);
        }
        let kept: Vec<usize> = (0..into.len()).filter(|n| into[*n] == *n as u32).collect();
        let place = |n: u32| kept.partition_point(|k| *k < into[n as usize] as usize) as u32;
        self.edges = self.edges.iter().map(|e| e.map(place)).filter(|[a, b]| a != b).collect();
        self.lines = self.lines.iter().map(|e| e.map(place)).filter(|[a, b]| a != b).collect();
        self.uv = kept.iter().map(|n| self.uv[*n]).collect();
        self.ids = kept.iter().map(|n| self.ids[*n]).collect();
    }
}

/// The nodes round a face, loop by loop, with their places on the surface.
pub(crate) fn border(context: &FaceInput, face: &Face) -> FaceBorder {
    let record = &context.input.model.patches[face.patch.index()];
    let surface = &context.input.model.surfaces[face.surface.index()].surface;
    let mut border = FaceBorder::default();
    let mut known: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    // First and last node of each side, loops apart.
    let mut ends: Vec<Option<(u32, u32)>> = Vec::new();
    for (k, side) in face.sides.iter().enumerate() {
        ends.push(None);
        let line = line_of(context.layout, context.nodes, face, k, 1);
        let uv = if side.uses.is_empty() {
            match surface.border_line(k) {
                Some((a, b)) => vec![a, b],
                // An edge that was glued together: its neighbours meet there.
                None if surface.domain() == Domain::Loop => continue,
                None => pole(record, k),
            }
        } else {
            let feet = line.ids.iter().map(|n| surface.flat_uv(context.points[*n as usize])).collect::<Option<Vec<_>>>();
            feet.unwrap_or_else(|| places(context.input, face, k, &line.lengths))
        };
        // Edges have the face on their left; sides of a mapped domain run with ascending u or v.
        let back = context.input.model.runs_back(record, k);
        let mut last: Option<u32> = None;
        for (id, at) in line.ids.iter().zip(uv) {
            // A node may be in several places of the chart (a seam, a pole), but in each of them once.
            let same = |n: &&u32| {
                let there = border.uv[**n as usize];
                (there.0 - at.0).abs().max((there.1 - at.1).abs()) <= ONE_PLACE
            };
            let places = known.entry(*id).or_default();
            let node = places.iter().find(same).copied().unwrap_or_else(|| {
                border.uv.push(at);
                border.ids.push(*id);
                places.push(border.ids.len() as u32 - 1);
                border.ids.len() as u32 - 1
            });
            if let Some(before) = last.filter(|before| *before != node) {
                border.edges.push(if back { [node, before] } else { [before, node] });
            }
            last = Some(node);
            ends[k] = Some((ends[k].map_or(node, |e| e.0), node));
        }
    }
    if surface.domain() == Domain::Loop {
        border.jump(&surface.loops(), &ends);
    }
    embedded::add(context, face, &mut border, &mut known);
    border
}

/// The two corners of a side that is one point.
fn pole(record: &Patch, side: usize) -> Vec<(f64, f64)> {
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    match side {
        0 => vec![(u0, v0), (u1, v0)],
        1 => vec![(u1, v0), (u1, v1)],
        2 => vec![(u0, v1), (u1, v1)],
        _ => vec![(u0, v0), (u0, v1)],
    }
}

/// Surface parameters at ascending lengths along a side of a face that is not a flat one without a map.
pub fn places(input: &Input, face: &Face, side: usize, lengths: &[f64]) -> Vec<(f64, f64)> {
    let record = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    if surface.domain() == Domain::Loop {
        return along_border(surface, side, face.sides[side].length, lengths);
    }
    let at = side_parameters(input, face, side, lengths);
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    at.into_iter()
        .map(|t| match (face.is_triangle(), side) {
            (_, 0) => (t, v0),
            (true, 1) => (1.0 - t, t),
            (true, _) => (0.0, t),
            (false, 1) => (u1, t),
            (false, 2) => (t, v1),
            (false, _) => (u0, t),
        })
        .collect()
}

/// The same on a border of a trimmed surface, `total` long.
fn along_border(surface: &Surface, side: usize, total: f64, lengths: &[f64]) -> Vec<(f64, f64)> {
    match (surface.side(side), surface.border_line(side)) {
        (Side::Chain { from, to, .. }, _) => {
            let prepared = surface.quick();
            let place = |s: &f64| prepared.evaluator().border_place(side, from + (to - from) * (s / total)).unwrap_or_default();
            lengths.iter().map(place).collect()
        }
        (_, Some((from, to))) => {
            let trace = Trace::of_prepared(surface.prepared(), from, to);
            lengths.iter().map(|s| trace.uv(trace.at_length(s / total * trace.length()))).collect()
        }
        _ => vec![(0.0, 0.0); lengths.len()],
    }
}
