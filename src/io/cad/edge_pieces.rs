//! Edges along lines and arcs in a row, parted where these meet: each part is then a line or a circle in the file.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::io::cad::elementary_surface::Ground;
use crate::io::cad::exact_pieces::exact_pieces;
use crate::model::body::BodyLoop;
use crate::model::{Body, BodyEdge};
use crate::surface::analysis::elementary::{Elementary, Form};

/// How far the ends of a curve may be from those of its edge, as a share of the tolerance.
const ENDS: f64 = 0.25;

/// Parts the edges of a body whose curves have pieces that are lines or arcs of circles: a vertex where two pieces meet, an edge and a
/// curve for each piece. An edge with a piece shorter than the tolerance stays whole.
pub(super) fn part_edges(body: &mut Body, vertices: &mut Vec<DVec3>, curves: &mut Vec<Option<Curve>>, tolerance: &Tolerance) {
    let mut parts: Vec<Vec<usize>> = Vec::with_capacity(curves.len());
    for k in 0..curves.len() {
        let pieces = curves[k].as_ref().map_or_else(Vec::new, |curve| exact_pieces(curve, tolerance));
        // A curve whose ends are not those of its edge, as at a pole beside the axis, goes out as it is.
        let ends = body.edges[k].ends;
        let near = |piece: Option<&Curve>, vertex: usize, end: fn(&Curve) -> DVec3| {
            piece.is_some_and(|piece| end(piece).distance(vertices[vertex]) <= ENDS * tolerance.point)
        };
        let [first, others @ ..] = pieces.as_slice() else {
            parts.push(vec![k]);
            continue;
        };
        if !near(pieces.first(), ends.0, Curve::start) || !near(pieces.last(), ends.1, Curve::end) {
            parts.push(vec![k]);
            continue;
        }
        curves[k] = Some(first.clone());
        let mut own = vec![k];
        let (last, part) = (body.edges[k].ends.1, body.edges[k].part);
        let mut s = part.s.0 + first.length();
        body.edges[k].part.s.1 = s;
        for piece in others {
            let joint = vertices.len();
            vertices.push(piece.start());
            body.vertices.push(piece.start());
            body.edges[own[own.len() - 1]].ends.1 = joint;
            let mut edge = BodyEdge { part, ends: (joint, last), seam: None };
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

/// Takes seams out of plane faces: where a loop runs along an edge there and back, it becomes two loops, or one round a point. The widest
/// loop of a face comes first.
pub(super) fn without_seams(body: &mut Body, grounds: &[Ground], curves: &mut [Option<Curve>]) {
    let mut uses = vec![0; body.edges.len()];
    body.faces.iter().flat_map(|face| &face.loops).flatten().for_each(|(edge, _)| uses[*edge] += 1);
    for (face, ground) in body.faces.iter_mut().zip(grounds) {
        if !matches!(ground, Ground::Elementary(Elementary { form: Form::Plane { .. }, .. })) {
            continue;
        }
        let mut open = std::mem::take(&mut face.loops);
        let mut parted = false;
        while let Some(around) = open.pop() {
            let back =
                |k: usize| around[k + 1..].iter().position(|step| step.0 == around[k].0 && step.1 != around[k].1 && uses[step.0] == 2);
            let Some((first, last)) = (0..around.len()).find_map(|k| Some((k, k + 1 + back(k)?))) else {
                face.loops.push(around);
                continue;
            };
            curves[around[first].0] = None;
            parted = true;
            let between = around[first + 1..last].to_vec();
            let rest = [&around[last + 1..], &around[..first]].concat();
            open.extend([between, rest].into_iter().filter(|around| !around.is_empty()));
        }
        face.loops.reverse();
        if parted {
            let reach = |around: &BodyLoop| {
                let boxes = around.iter().filter_map(|(edge, _)| curves[*edge].as_ref()).map(Curve::bbox);
                boxes.fold(Box3::EMPTY, Box3::union).diagonal()
            };
            face.loops.sort_by(|a, b| reach(b).total_cmp(&reach(a)));
        }
    }
}
