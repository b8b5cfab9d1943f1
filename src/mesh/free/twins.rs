//! Edges inside two faces between the same nodes of their borders: four elements would meet in one.
//!
//! Two faces that share the borders on both sides of a corner may both cut the corner off by the same edge. Such an edge is
//! divided in all faces of triangles but one.

use std::collections::BTreeSet;

use super::face::Made;
use crate::base::par;
use crate::mesh::chart::Shape;
use crate::mesh::data::Mesh;
use crate::mesh::faces::{Frame, Prepared};

/// An edge by its nodes, the lower first.
type Edge = (u32, u32);

/// Divides such edges at their middles in (u, v); whether there were any. Nodes have to be numbered again then.
pub(in crate::mesh) fn divide(made: &Made, prepared: &mut [Prepared], mesh: &Mesh) -> bool {
    let mut any = false;
    for (edge, faces) in twins(made, prepared, mesh) {
        let mut able: Vec<usize> = faces.iter().copied().filter(|f| divides(&prepared[*f])).collect();
        // One face may keep it.
        able.truncate(faces.len() - 1);
        for f in able {
            any |= divide_edge(&mut prepared[f], edge);
        }
    }
    any
}

/// Edges that lie inside two faces or more, with these.
fn twins(made: &Made, prepared: &[Prepared], mesh: &Mesh) -> Vec<(Edge, Vec<usize>)> {
    let (mut places, mut t, mut q) = (Vec::with_capacity(prepared.len()), 0, 0);
    for ready in prepared {
        let (triangles, quads) = (t..t + ready.triangles as usize, q..q + ready.quads as usize);
        (t, q) = (triangles.end, quads.end);
        places.push((triangles, quads));
    }
    let border = made.nodes.total;
    let inside = par::map(prepared.len(), |f| {
        let (triangles, quads) = places[f].clone();
        let mut edges: Vec<Edge> = Vec::new();
        let mut add = |corners: &[u32]| {
            for (k, &a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                if a < border && b < border {
                    edges.push((a.min(b), a.max(b)));
                }
            }
        };
        mesh.triangles[triangles].iter().for_each(|t| add(t));
        mesh.quads[quads].iter().for_each(|q| add(q));
        edges.sort_unstable();
        let twice: Vec<Edge> = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 2).map(|same| same[0]).collect();
        twice
    });
    let mut all: Vec<(Edge, usize)> = inside.into_iter().enumerate().flat_map(|(f, own)| own.into_iter().map(move |e| (e, f))).collect();
    all.sort_unstable();
    let lines = lines(made);
    let shared = all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1 && !lines.contains(&same[0].0));
    shared.map(|same| (same[0].0, same.iter().map(|s| s.1).collect())).collect()
}

/// Edges of the lines inside faces, which others may share.
fn lines(made: &Made) -> BTreeSet<Edge> {
    let stretches: BTreeSet<usize> = made.layout.faces.iter().flat_map(|face| face.lines.iter().copied()).collect();
    let edges = |stretch: usize| {
        let ids = made.nodes.of_stretch(made.layout, stretch, false);
        ids.windows(2).map(|w| (w[0].min(w[1]), w[0].max(w[1]))).collect::<Vec<Edge>>()
    };
    stretches.into_iter().flat_map(edges).collect()
}

/// Whether edges of a face can be divided: one made freely of triangles.
fn divides(ready: &Prepared) -> bool {
    matches!(&ready.chart.shape, Shape::Free(free) if free.quads.is_empty())
}

/// Divides an edge between two triangles; whether it is there.
fn divide_edge(ready: &mut Prepared, edge: Edge) -> bool {
    let (Shape::Free(free), Frame::Free(ids)) = (&mut ready.chart.shape, &mut ready.chart.frame) else { return false };
    let is_edge = |a: u32, b: u32| {
        let (a, b) = (ids[a as usize], ids[b as usize]);
        (a.min(b), a.max(b)) == edge
    };
    let side = |t: &[u32; 3]| (0..3).find(|k| is_edge(t[*k], t[(k + 1) % 3]));
    let found: Vec<(usize, usize)> = free.triangles.iter().enumerate().filter_map(|(n, t)| side(t).map(|k| (n, k))).collect();
    let &[(one, k), (other, _)] = found.as_slice() else { return false };
    let (a, b) = (free.triangles[one][k], free.triangles[one][(k + 1) % 3]);
    if ![a, b].iter().all(|n| free.triangles[other].contains(n)) {
        return false;
    }
    let (p, q) = (free.uv[a as usize], free.uv[b as usize]);
    let uv = (0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1));
    let new = free.uv.len() as u32;
    free.uv.push(uv);
    ids.push(u32::MAX);
    ready.made.push(ready.chart.surface.point(uv.0, uv.1));
    for (n, k) in found {
        let t = free.triangles[n];
        let (from, to, tip) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
        free.triangles[n] = [from, new, tip];
        free.triangles.push([new, to, tip]);
    }
    ready.inner += 1;
    ready.triangles += 2;
    true
}
