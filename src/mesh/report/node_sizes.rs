//! Which length of edges is asked at each corner node of a mesh, and by which setting.
//!
//! Along borders it is what decides their steps; inside free faces what decided the distances of nodes; inside mapped faces, whose rows end at
//! borders, the shorter one of the two rows through a node.

use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::node_sizes::NodeSizes;
use crate::mesh::mapped::grid::GridIds;
use crate::mesh::mapped::trilateral::{Blocks, LatticeIds};
use crate::mesh::report::explain::{Because, Explanation};
use crate::mesh::report::reasons;
use crate::mesh::request::input::Input;
use crate::mesh::size::sizing::Sizing;

/// An asked length, model units, and the place of its decider among the words.
type Asked = (f32, u32);

/// Of the corner nodes of a mesh, so many.
pub fn of_nodes(
    input: &Input,
    layout: &Layout,
    nodes: &Nodes,
    sizing: &Sizing,
    prepared: &[FaceMesh],
    explanation: &Explanation,
    count: usize,
) -> NodeSizes {
    let mut sizes = NodeSizes::unknown(count);
    for segment in 0..layout.pieces.segments.len() {
        of_segment(input, layout, nodes, sizing, explanation, segment, &mut sizes);
    }
    for face in prepared {
        match (&face.geometry.nodes, &face.inside) {
            (FaceNodes::Grid(_, ids), _) => of_grid(ids, &mut sizes),
            (FaceNodes::Lattice(_, ids), _) => of_lattice(ids, &mut sizes),
            (FaceNodes::Blocks(blocks, ids), _) => of_blocks(blocks, ids, &mut sizes),
            (FaceNodes::Free(_, ids), Some(inside)) => {
                let decided = &inside.decided;
                let words: Vec<u32> = decided.deciders.iter().map(|d| sizes.word(&reasons::cause(input, d.why))).collect();
                let inner = &ids[ids.len() - face.inner as usize..];
                for ((id, of), length) in inner.iter().zip(&decided.of).zip(&decided.lengths) {
                    sizes.lower(*id as usize, words[*of as usize], *length);
                }
            }
            (FaceNodes::Free(..), None) => {}
        }
    }
    sizes
}

/// The nodes of a segment.
fn of_segment(
    input: &Input,
    layout: &Layout,
    nodes: &Nodes,
    sizing: &Sizing,
    explanation: &Explanation,
    segment: usize,
    sizes: &mut NodeSizes,
) {
    let (decision, length) = (&sizing.decisions[segment], layout.length(segment));
    let fractions = nodes.fractions(segment, false);
    let spacing = sizing.spacings[segment].as_ref();
    let because = &explanation.segments[segment].because;
    let word = sizes.word(&explanation.reason(input, sizing, segment));
    let last = fractions.len() - 1;
    // The longer one of the steps beside a node.
    let step = |k: usize| {
        let before = if k > 0 { fractions[k] - fractions[k - 1] } else { 0.0 };
        let after = if k < last { fractions[k + 1] - fractions[k] } else { 0.0 };
        before.max(after) * length
    };
    for (k, id) in nodes.of_segment(layout, segment, false).into_iter().enumerate() {
        let varied = spacing.and_then(|spacing| Some((spacing.length_at(fractions[k]), spacing.why_at(fractions[k])?)));
        let (asked, word) = match (varied, because) {
            (Some((asked, why)), _) => (asked, sizes.word(&reasons::cause(input, why))),
            (None, Because::Count(_)) => (step(k), word),
            (None, Because::Limit) => (length / f64::from(decision.least.max(1)), word),
            (None, _) => (decision.size.0, word),
        };
        sizes.lower(id as usize, word, asked as f32);
    }
}

/// What is asked at a node.
fn asked_at(sizes: &NodeSizes, id: u32) -> Option<Asked> {
    Some((sizes.lengths[id as usize], sizes.of[id as usize])).filter(|asked| !asked.0.is_nan())
}

/// The shortest of what is asked.
fn shortest(asked: impl IntoIterator<Item = Option<Asked>>) -> Option<Asked> {
    asked.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0))
}

fn of_grid(ids: &GridIds, sizes: &mut NodeSizes) {
    let (nu, nv) = ids.size();
    let end = |sizes: &NodeSizes, side: usize, k: usize| {
        let id = (!ids.poles[side]).then(|| ids.sides[side][k])?;
        asked_at(sizes, id)
    };
    let rows: Vec<Option<Asked>> = (0..=nv).map(|j| shortest([end(sizes, 3, j), end(sizes, 1, j)])).collect();
    let columns: Vec<Option<Asked>> = (0..=nu).map(|i| shortest([end(sizes, 0, i), end(sizes, 2, i)])).collect();
    for (j, row) in rows.into_iter().enumerate().take(nv).skip(1) {
        for (i, column) in columns.iter().enumerate().take(nu).skip(1) {
            if let Some((length, word)) = shortest([row, *column]) {
                sizes.lower(ids.node(i, j) as usize, word, length);
            }
        }
    }
}

fn of_lattice(ids: &LatticeIds, sizes: &mut NodeSizes) {
    let n = ids.sides[0].len() - 1;
    let inner: Vec<(usize, usize)> = LatticeIds::inner(n).collect();
    for (i, j) in inner {
        let ends = [ids.sides[0][i], ids.sides[1][j], ids.sides[2][j]];
        if let Some((length, word)) = shortest(ends.map(|end| asked_at(sizes, end))) {
            sizes.lower(ids.node(i, j) as usize, word, length);
        }
    }
}

/// Three grids that meet inside a triangle: no row leads from side to side, so all inner nodes have what is asked for most of the border.
fn of_blocks(blocks: &Blocks, ids: &[u32], sizes: &mut NodeSizes) {
    let border = blocks.sides.iter().flatten().map(|place| ids[*place as usize]);
    let mut asked: Vec<Asked> = border.filter_map(|id| asked_at(sizes, id)).collect();
    asked.sort_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((length, word)) = asked.get(asked.len() / 2).copied() {
        ids[..blocks.inner].iter().for_each(|id| sizes.lower(*id as usize, word, length));
    }
}
