//! The border, lines and points of a face by their nodes, and its Euler number, as the layout has them.

use std::collections::BTreeMap;

use crate::mesh::border::layout::Face;
use crate::mesh::chart::face_input::FaceInput;
use crate::surface::Domain;

/// Border and lines of a face by nodes of the mesh.
pub(crate) struct LayoutBorder {
    /// Edges of the loops, the face on their left.
    pub(crate) edges: Vec<[u32; 2]>,
    /// Edges of the lines inside.
    pub(crate) lines: Vec<[u32; 2]>,
    /// Single nodes inside.
    pub(crate) points: Vec<u32>,
    /// Euler number of the inside; `None` where a loop meets itself.
    pub(crate) euler: Option<i64>,
}

impl LayoutBorder {
    pub(crate) fn new(face_input: &FaceInput, face: &Face) -> Self {
        let FaceInput { input, layout, nodes, .. } = face_input;
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
