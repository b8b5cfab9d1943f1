//! Edges along lines and arcs in a row, parted where these meet: each part is then a line or a circle in the file.

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::io::cad::exact_pieces::exact_pieces;
use crate::model::{Body, BodyEdge};

/// Parts the edges of a body whose curves have pieces that are lines or arcs of circles: a vertex where two pieces meet, an edge and a
/// curve a piece. An edge of which a piece would be shorter than the tolerance stays whole.
pub(super) fn part_edges(body: &mut Body, vertices: &mut Vec<DVec3>, curves: &mut Vec<Option<Curve>>, tolerance: &Tolerance) {
    let mut parts: Vec<Vec<usize>> = Vec::with_capacity(curves.len());
    for k in 0..curves.len() {
        let pieces = curves[k].as_ref().map_or_else(Vec::new, |curve| exact_pieces(curve, tolerance));
        let [first, others @ ..] = pieces.as_slice() else {
            parts.push(vec![k]);
            continue;
        };
        curves[k] = Some(first.clone());
        let mut own = vec![k];
        let (last, part) = (body.edges[k].ends.1, body.edges[k].part.clone());
        let mut s = part.s.0 + first.length();
        body.edges[k].part.s.1 = s;
        for piece in others {
            let joint = vertices.len();
            vertices.push(piece.start());
            body.vertices.push(piece.start());
            body.edges[own[own.len() - 1]].ends.1 = joint;
            let mut edge = BodyEdge { part: part.clone(), ends: (joint, last), seam: None };
            edge.part.s = (s, s + piece.length());
            s = edge.part.s.1;
            own.push(body.edges.len());
            body.edges.push(edge);
            curves.push(Some(piece.clone()));
        }
        parts.push(own);
    }
    for around in body.faces.iter_mut().flat_map(|face| &mut face.loops) {
        let part = |(edge, against): &(usize, bool)| {
            let own = parts[*edge].iter().map(|k| (*k, *against));
            if *against { own.rev().collect::<Vec<_>>() } else { own.collect() }
        };
        *around = around.iter().flat_map(part).collect();
    }
}
