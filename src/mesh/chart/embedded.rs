//! Lines and points inside a face that its triangles have to hold: their nodes come from the segments, as those of borders do.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::mesh::border::inside::trace;
use crate::mesh::border::layout::Face;
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::FaceInput;

/// Places between two nodes of a line at which it is followed over the surface.
const BETWEEN: usize = 8;

/// Adds lines and points of a face to its border; `known` are the places of each node.
pub fn add(context: &FaceInput, face: &Face, border: &mut FaceBorder, known: &mut BTreeMap<u32, Vec<u32>>) {
    let surface = &context.input.model.surfaces[face.surface.index()].surface;
    let patch = &context.input.model.patches[face.patch.index()];
    for &line in &face.lines {
        let ids = context.nodes.of_segment(context.layout, line, false);
        let at = context.nodes.fractions(line, false);
        let mut points: Vec<DVec3> = Vec::with_capacity(BETWEEN * at.len());
        for (k, w) in at.windows(2).enumerate() {
            points.push(context.points[ids[k] as usize]);
            let between = |i: usize| context.layout.point(line, w[0] + (w[1] - w[0]) * i as f64 / BETWEEN as f64);
            points.extend((1..BETWEEN).map(between));
        }
        points.push(context.points[ids[ids.len() - 1] as usize]);
        let places = trace(surface, patch, &points);
        let nodes: Vec<u32> = ids.iter().enumerate().map(|(k, id)| border.inner(known, *id, places[k * BETWEEN])).collect();
        border.lines.extend(nodes.windows(2).filter(|w| w[0] != w[1]).map(|w| [w[0], w[1]]));
    }
    for &point in &face.points {
        let at = trace(surface, patch, &[context.input.plan.points[point]]);
        border.inner(known, context.nodes.points[point], at[0]);
    }
}

impl FaceBorder {
    /// The place of a node of a line: one of those that the border has of it, or a new one.
    fn inner(&mut self, known: &mut BTreeMap<u32, Vec<u32>>, id: u32, at: (f64, f64)) -> u32 {
        let places = known.entry(id).or_default();
        let here = DVec2::from(at);
        let uv = |n: u32| DVec2::from(self.uv[n as usize]);
        // A pole is an edge of the chart: the line ends in it, and divides it.
        let pole = self.edges.iter().position(|e| e.iter().all(|n| self.ids[*n as usize] == id) && between(e.map(uv), here));
        if let Some(edge) = pole {
            let [a, b] = self.edges[edge].map(uv);
            let along = b - a;
            let foot = a + along * (here - a).dot(along) / along.length_squared();
            let new = self.push(id, foot.into());
            places.push(new);
            let [first, last] = std::mem::replace(&mut self.edges[edge], [0, new]);
            self.edges[edge][0] = first;
            self.edges.push([new, last]);
            return new;
        }
        if let Some(nearest) = places.iter().copied().min_by(|a, b| uv(*a).distance(here).total_cmp(&uv(*b).distance(here))) {
            return nearest;
        }
        let new = self.push(id, at);
        places.push(new);
        new
    }

    fn push(&mut self, id: u32, at: (f64, f64)) -> u32 {
        self.uv.push(at);
        self.ids.push(id);
        self.ids.len() as u32 - 1
    }
}

/// Whether the foot of a place lies truly inside a segment of the chart.
fn between([a, b]: [DVec2; 2], p: DVec2) -> bool {
    let along = b - a;
    let t = (p - a).dot(along) / along.length_squared();
    t > crate::mesh::chart::face_border::ONE_PLACE && t < 1.0 - crate::mesh::chart::face_border::ONE_PLACE
}
