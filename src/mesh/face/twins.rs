//! Edges inside faces that are one edge of the mesh in two places, where four elements would meet.
//!
//! Two faces that share the borders on both sides of a corner may both cut the corner off by the same edge; a face that closes on
//! itself may have the same edge on both sides of its seam, as round the tip of a steep cone. Such an edge is divided in all
//! places but one, where elements are triangles.

use std::collections::BTreeSet;

use crate::base::par;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::{FaceMesh, element_ranges};
use crate::mesh::data::mesh::Mesh;
use crate::surface::Surface;

/// Least sine of the angle at a corner of a divided triangle, by its part along the normal of the surface.
const MIN_SINE: f64 = 0.1;

/// An edge as two nodes of the mesh, or as two places in a chart, the lower first.
pub(crate) type NodePair = (u32, u32);

/// Divides such edges at their middles in (u, v); whether there were any. Nodes have to be numbered again then.
pub(crate) fn divide(face_input: &FaceInput, prepared: &mut [FaceMesh], mesh: &Mesh) -> bool {
    // The mesh does not have the divided edges yet.
    let shared = twins(face_input, prepared, mesh);
    let mut any = false;
    for face_mesh in prepared.iter_mut() {
        for edge in own_twins(face_mesh) {
            any |= divide_edge(face_mesh, edge);
        }
    }
    for (edge, faces) in shared {
        // One face may keep it.
        let mut left = faces.len() - 1;
        for f in faces {
            let local = local(&prepared[f], edge).filter(|_| left > 0 && divides(&prepared[f]));
            if local.is_some_and(|edge| divide_edge(&mut prepared[f], edge)) {
                (left, any) = (left - 1, true);
            }
        }
    }
    any
}

/// Edges inside a face, by their places in its chart, that are one edge of the mesh with another one, which stays.
fn own_twins(face_mesh: &FaceMesh) -> Vec<NodePair> {
    let FaceNodes::Free(free, ids) = &face_mesh.geometry.nodes else { return Vec::new() };
    let border = ids.len() - face_mesh.inner as usize;
    let mut on_border = ids[..border].to_vec();
    on_border.sort_unstable();
    if !divides(face_mesh) || on_border.windows(2).all(|w| w[0] != w[1]) {
        return Vec::new();
    }
    let sides = free.triangles.iter().flat_map(|t| (0..3).map(|k| ordered(t[k], t[(k + 1) % 3]))).filter(|(a, _)| (*a as usize) < border);
    let mut all: Vec<(NodePair, NodePair)> = sides.map(|(a, b)| (ordered(ids[a as usize], ids[b as usize]), (a, b))).collect();
    all.sort_unstable();
    let mut out = Vec::new();
    for same in all.chunk_by(|a, b| a.0 == b.0) {
        let mut places: Vec<(usize, NodePair)> = same.chunk_by(|a, b| a.1 == b.1).map(|uses| (uses.len(), uses[0].1)).collect();
        // A piece of the border is used once, and stays; of others the shortest way over the surface.
        places.sort_by(|a, b| a.0.cmp(&b.0).then(way(face_mesh, a.1).total_cmp(&way(face_mesh, b.1))));
        let seam = places.iter().filter(|p| p.0 == 1).count();
        out.extend(places.into_iter().skip(seam.max(1)).map(|(_, edge)| edge));
    }
    out
}

/// The length of the way over the surface from one end of an edge to the other, by two chords.
fn way(face_mesh: &FaceMesh, (a, b): NodePair) -> f64 {
    let FaceNodes::Free(free, _) = &face_mesh.geometry.nodes else { return 0.0 };
    let point = |(u, v): (f64, f64)| face_mesh.geometry.surface.point(u, v);
    let (p, q) = (free.uv[a as usize], free.uv[b as usize]);
    let top = point(middle(p, q));
    top.distance(point(p)) + top.distance(point(q))
}

fn middle(p: (f64, f64), q: (f64, f64)) -> (f64, f64) {
    (0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1))
}

/// The place in the chart of an edge inside a face.
fn local(face_mesh: &FaceMesh, edge: NodePair) -> Option<NodePair> {
    let FaceNodes::Free(free, ids) = &face_mesh.geometry.nodes else { return None };
    let sides = free.triangles.iter().flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3])));
    let mut found = sides.filter(|(a, b)| ordered(ids[*a as usize], ids[*b as usize]) == edge);
    found.next().map(|(a, b)| ordered(a, b))
}

pub(crate) fn ordered(a: u32, b: u32) -> NodePair {
    (a.min(b), a.max(b))
}

/// Edges that lie inside two faces or more, with these.
pub(crate) fn twins(face_input: &FaceInput, prepared: &[FaceMesh], mesh: &Mesh) -> Vec<(NodePair, Vec<usize>)> {
    let places = element_ranges(prepared);
    let border = face_input.nodes.total;
    let inside = par::map(prepared.len(), |f| {
        let (triangles, quads) = places[f].clone();
        let mut edges: Vec<NodePair> = Vec::new();
        let mut add = |corners: &[u32]| {
            for (k, &a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                if a < border && b < border {
                    edges.push(ordered(a, b));
                }
            }
        };
        mesh.triangles[triangles].iter().for_each(|t| add(t));
        mesh.quads[quads].iter().for_each(|q| add(q));
        edges.sort_unstable();
        let twice: Vec<NodePair> = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 2).map(|same| same[0]).collect();
        twice
    });
    let mut all: Vec<(NodePair, usize)> =
        inside.into_iter().enumerate().flat_map(|(f, own)| own.into_iter().map(move |e| (e, f))).collect();
    all.sort_unstable();
    let lines = lines(face_input);
    let shared = all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1 && !lines.contains(&same[0].0));
    shared.map(|same| (same[0].0, same.iter().map(|s| s.1).collect())).collect()
}

/// Edges of the lines inside faces, which others may share.
fn lines(face_input: &FaceInput) -> BTreeSet<NodePair> {
    let segments: BTreeSet<usize> = face_input.layout.faces.iter().flat_map(|face| face.lines.iter().copied()).collect();
    let edges = |segment: usize| {
        let ids = face_input.nodes.of_segment(face_input.layout, segment, false);
        ids.windows(2).map(|w| ordered(w[0], w[1])).collect::<Vec<NodePair>>()
    };
    segments.into_iter().flat_map(edges).collect()
}

/// Whether edges of a face can be divided: one made freely of triangles.
fn divides(face_mesh: &FaceMesh) -> bool {
    matches!(&face_mesh.geometry.nodes, FaceNodes::Free(free, _) if free.quads.is_empty())
}

/// Divides an edge between two triangles, given by its places in the chart; whether it is there.
fn divide_edge(face_mesh: &mut FaceMesh, (a, b): NodePair) -> bool {
    let (FaceNodes::Free(free, ids), Some(inside)) = (&mut face_mesh.geometry.nodes, &mut face_mesh.inside) else { return false };
    let side = |t: &[u32; 3]| (0..3).find(|k| ordered(t[*k], t[(k + 1) % 3]) == (a, b));
    let found: Vec<(usize, usize)> = free.triangles.iter().enumerate().filter_map(|(n, t)| side(t).map(|k| (n, k))).collect();
    if found.len() != 2 {
        return false;
    }
    let (p, q) = (free.uv[a as usize], free.uv[b as usize]);
    let uv = middle(p, q);
    let surface = &face_mesh.geometry.surface;
    let parts = |(n, k): &(usize, usize)| {
        let [from, to, tip] = [0, 1, 2].map(|d| free.uv[free.triangles[*n][(k + d) % 3] as usize]);
        [[from, uv, tip], [uv, to, tip]]
    };
    if !found.iter().flat_map(parts).all(|corners| is_upright(surface, corners)) {
        return false;
    }
    let new = free.uv.len() as u32;
    free.uv.push(uv);
    ids.push(u32::MAX);
    inside.points.push(surface.point(uv.0, uv.1));
    for (n, k) in found {
        let t = free.triangles[n];
        let (from, to, tip) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
        free.triangles[n] = [from, new, tip];
        free.triangles.push([new, to, tip]);
    }
    face_mesh.inner += 1;
    face_mesh.triangles += 2;
    true
}

/// Whether a triangle lies with the surface, not across or against it, and is no sliver.
pub(crate) fn is_upright(surface: &Surface, corners: [(f64, f64); 3]) -> bool {
    let [a, b, c] = corners.map(|(u, v)| surface.point(u, v));
    let third = |x: [f64; 3]| x.iter().sum::<f64>() / 3.0;
    let normal = surface.normal(third(corners.map(|c| c.0)), third(corners.map(|c| c.1)));
    (b - a).cross(c - a).dot(normal) > MIN_SINE * (b - a).length() * (c - a).length()
}
