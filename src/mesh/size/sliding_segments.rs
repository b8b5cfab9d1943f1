//! Segments whose nodes may slide along them while the triangles beside them are optimized.

use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::request::input::Input;
use crate::mesh::size::sizing::Sizing;

/// Which segments have nodes that may slide.
#[derive(Clone, Debug, Default)]
pub struct SlidingSegments {
    /// As far as no bias is written.
    without_bias: Vec<bool>,
    /// With the written ones: a bias says where nodes are, and one of 1 keeps them even.
    sliding: Vec<bool>,
}

impl SlidingSegments {
    /// Segments round holes of plane faces that are grown of triangles: steps of an outer border stay as they are, for opposite sides of a sheet
    /// are often to be alike. Only one patch of the whole model lies on such a segment, so that no other face or mesh expects its nodes where
    /// they are, and neither a count, a size of its own, a source of sizes, a least size nor a curve of the mesh says where these are.
    pub fn new(input: &Input, layout: &Layout, sizing: &Sizing) -> Self {
        let mut uses = vec![0_u32; layout.pieces.segments.len()];
        let curves = layout.curves.iter().flatten().map(|used| used.segment);
        layout.faces.iter().flat_map(Face::segments).chain(curves).for_each(|k| uses[k] += 1);
        let mut without_bias = vec![false; uses.len()];
        let is_plane = |face: &&Face| input.model.surfaces[face.surface.index()].surface.is_flat();
        let grown = layout.faces.iter().filter(|face| face.is_grown()).filter(is_plane);
        let is_even = sizing.wanted.sources.is_empty() && sizing.wanted.written == 0.0;
        for face in grown.filter(|_| is_even) {
            let outer = input.model.surfaces[face.surface.index()].surface.loops().first().copied().unwrap_or(0);
            for k in face.sides.iter().skip(outer).flat_map(|side| side.uses.iter().map(|used| used.segment)) {
                let decision = &sizing.decisions[k];
                let edge = layout.edges.get(layout.pieces.segments[k].track);
                let is_alone = edge.is_some_and(|edge| input.model.edges[edge.index()].users.len() == 1);
                without_bias[k] = is_alone && uses[k] == 1 && decision.count.is_none() && decision.size.1 == face.size.1;
            }
        }
        let sliding = without_bias.iter().zip(&sizing.bias_rule).map(|(may, bias)| *may && bias.is_none()).collect();
        Self { without_bias, sliding }
    }

    /// For each segment whether its nodes may slide.
    pub fn each(&self) -> &[bool] {
        &self.sliding
    }

    /// Whether the nodes of a segment would be free to slide but for a bias.
    pub fn is_held_by_bias(&self, segment: usize) -> bool {
        self.without_bias[segment] && !self.sliding[segment]
    }
}
