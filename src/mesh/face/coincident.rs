//! Coincident parts of faces: elements of two faces with the same nodes, and edges inside two faces between the same two nodes of
//! their borders, in which four elements would meet.
//!
//! Free faces of triangles divide such an edge (`face/twins.rs`). A mapped one of triangles flips the diagonal
//! of the cell; where a face has a single row of cells between two borders it gets more rows.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::base::fault::Fault;
use crate::base::par;
use crate::mesh::border::inside;
use crate::mesh::border::layout::{Layout, Uneven};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::{FaceMesh, element_ranges};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::divide::verdict::Verdict;
use crate::mesh::face::twins::{NodePair, is_upright, ordered, twins};
use crate::mesh::request::fault::ElementFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::{Elements, Method};
use crate::model::fault::ContactFault;
use crate::surface::{Nearest, Surface};

/// An edge, or two nodes of an element, that two faces or more have, with these.
pub type Coincidence = (NodePair, Vec<usize>);

/// Flips diagonals that are edges of two faces; the coincidences that are left.
pub fn resolve(face_input: &FaceInput, prepared: &[FaceMesh], mesh: &mut Mesh, limits: &Limits) -> Vec<Coincidence> {
    let mut left = twins(face_input, prepared, mesh);
    for (edge, faces) in &mut left {
        let mut kept = faces.len();
        for f in faces.iter() {
            if kept > 1 && flip_diagonal(face_input, &prepared[*f], &element_ranges(prepared)[*f].0, mesh, limits, *edge) {
                kept -= 1;
            }
        }
        faces.truncate(if kept > 1 { faces.len() } else { 0 });
    }
    left.retain(|(_, faces)| !faces.is_empty());
    left.extend(same_elements(face_input, prepared, mesh));
    left
}

/// Elements of two faces with the same nodes.
fn same_elements(face_input: &FaceInput, prepared: &[FaceMesh], mesh: &Mesh) -> Vec<Coincidence> {
    let (border, places) = (face_input.nodes.total, element_ranges(prepared));
    let found = par::map(prepared.len(), |f| {
        let (triangles, quads) = places[f].clone();
        let mut own: Vec<[u32; 4]> = Vec::new();
        own.extend(mesh.triangles[triangles].iter().filter(|t| t.iter().all(|n| *n < border)).map(|[a, b, c]| [*a, *b, *c, *c]));
        own.extend(mesh.quads[quads].iter().filter(|q| q.iter().all(|n| *n < border)));
        own.iter_mut().for_each(|nodes| nodes.sort_unstable());
        own
    });
    let mut all: Vec<([u32; 4], usize)> = found.into_iter().enumerate().flat_map(|(f, own)| own.into_iter().map(move |e| (e, f))).collect();
    all.sort_unstable();
    let same = all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1);
    same.map(|same| ((same[0].0[0], same[0].0[1]), same.iter().map(|s| s.1).collect())).collect()
}

/// Flips the edge where it is the diagonal of a cell of a mapped face and the other diagonal is valid; whether it did. `triangles` are those
/// of the face.
fn flip_diagonal(
    face_input: &FaceInput,
    face_mesh: &FaceMesh,
    triangles: &Range<usize>,
    mesh: &mut Mesh,
    limits: &Limits,
    edge: NodePair,
) -> bool {
    let (FaceNodes::Grid(grid, _), FaceNodes::Grid(_, frame), Elements::Triangles) =
        (&face_mesh.geometry.nodes, &face_mesh.geometry.nodes, face_mesh.elements)
    else {
        return false;
    };
    let (nu, nv) = frame.size();
    let corners = |(i, j): (usize, usize)| [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
    let is_cell = |cell: &(usize, usize)| {
        let [a, b, c, d] = corners(*cell).map(|(i, j)| frame.node(i, j));
        a != b && b != c && c != d && d != a && (ordered(a, c) == edge || ordered(b, d) == edge)
    };
    let Some(cell) = (0..nv).flat_map(|j| (0..nu).map(move |i| (i, j))).find(is_cell) else { return false };
    let has = |t: &[u32; 3]| t.contains(&edge.0) && t.contains(&edge.1);
    let both: Vec<usize> = triangles.clone().filter(|t| has(&mesh.triangles[*t])).collect();
    let &[first, second] = both.as_slice() else { return false };
    let tip = |t: usize| mesh.triangles[t].into_iter().find(|n| *n != edge.0 && *n != edge.1);
    let (Some(x), Some(y)) = (tip(first), tip(second)) else { return false };
    let surface = &face_input.input.model.surfaces[face_mesh.surface.index()].surface;
    let uv = |node: u32| corners(cell).into_iter().find(|(i, j)| frame.node(*i, *j) == node).map_or((0.0, 0.0), |(i, j)| grid.uv(i, j));
    // The first triangle runs from one end of the edge to the other.
    let t = mesh.triangles[first];
    let k = (0..3).find(|k| t[*k] == x).unwrap_or(0);
    let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
    let parts = [[x, a, y], [y, b, x]];
    let upright = |corners: &[u32; 3]| {
        let [p, q, r] = corners.map(uv);
        is_upright(surface, if face_mesh.geometry.flipped { [p, r, q] } else { [p, q, r] })
    };
    if !parts.iter().all(upright) || !keeps(surface, [uv(x), uv(y)], limits) {
        return false;
    }
    (mesh.triangles[first], mesh.triangles[second]) = (parts[0], parts[1]);
    true
}

/// Whether a diagonal keeps the chord error in its middle.
fn keeps(surface: &Surface, [p, q]: [(f64, f64); 2], limits: &Limits) -> bool {
    let middle = surface.point(0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1));
    let off = middle.distance(surface.point(p.0, p.1).midpoint(surface.point(q.0, q.1)));
    limits.chord.is_none_or(|limit| off <= limit)
}

/// Largest number of demands on a face for more rows, or for shorter steps.
const MAX_DEMANDS: u32 = 3;

/// The demand of coincident faces: more rows of mapped ones; others are changed in the layout. `None` where each face has had its demands.
pub fn demand(
    layout: &mut Layout,
    prepared: &[FaceMesh],
    coincidences: &[Coincidence],
    demands_on: &mut BTreeMap<usize, u32>,
) -> Option<Demand> {
    let mut rows = vec![Verdict::FINE; layout.faces.len()];
    let (mut any, mut relaid) = (false, false);
    for f in coincidences.iter().flat_map(|(_, faces)| faces.iter().copied()) {
        let face = &mut layout.faces[f];
        let times = demands_on.entry(f).or_default();
        if rows[f].size != [1.0; 2] || *times == MAX_DEMANDS {
            continue;
        }
        match &prepared[f].geometry.nodes {
            FaceNodes::Grid(_, frame) => {
                let (nu, nv) = frame.size();
                rows[f].size = [nu, nv].map(|n| if n == 1 { ROWS_FOR_ONE } else { 1.0 });
            }
            FaceNodes::Lattice(..) if face.method == Method::Auto => (face.uneven, relaid) = (Some(Uneven::Together), true),
            FaceNodes::Lattice(..) | FaceNodes::Blocks(..) => rows[f].size = [ROWS_FOR_ONE; 2],
            FaceNodes::Free(..) => {
                face.halved += 1;
                relaid = true;
            }
        }
        any |= relaid || rows[f].size != [1.0; 2];
        *times += 1;
    }
    any.then_some(if relaid { Demand::NewLayout } else { Demand::Rows(rows) })
}

/// Number of rows demanded in place of one.
const ROWS_FOR_ONE: f64 = 2.0;

/// The demand of coincident faces.
pub enum Demand {
    /// The layout has changed.
    NewLayout,
    /// More rows by faces.
    Rows(Vec<Verdict>),
}

/// E720 for faces that stay coincident; E666 for faces to be joined that lie on each other there.
pub fn fault(input: &Input, layout: &Layout, mesh: &Mesh, (edge, faces): &Coincidence) -> Fault {
    let surface = |f: usize| &input.model.surfaces[layout.faces[f].surface.index()];
    let (p, q) = (mesh.nodes[edge.0 as usize], mesh.nodes[edge.1 as usize]);
    let [first, second] = [faces[0], faces[faces.len() - 1]];
    if let Some((_, imprint)) = &input.plan.imprint {
        let [one, other] =
            [first, second].map(|f| (Nearest::new(&surface(f).surface), &input.model.patches[layout.faces[f].patch.index()]));
        let is_on_both = |share: f64| {
            let foot = one.0.at(p.lerp(q, share)).point;
            inside::on(&one.0, one.1, foot, input.tolerance) && inside::on(&other.0, other.1, foot, input.tolerance)
        };
        if [0.25, 0.5, 0.75].into_iter().all(is_on_both) {
            let names = (surface(first).name.clone(), surface(second).name.clone());
            let (a, b) = (surface(first).surface.origin(), surface(second).surface.origin());
            return ContactFault::ImprintOverlap { imprint: *imprint, a, b, names, at: one.0.at(p.midpoint(q)).point }.into();
        }
    }
    let [a, b] = [first, second].map(|f| surface(f).surface.origin());
    ElementFault::FallTogether { surfaces: [a, b], at: p.midpoint(q) }.into()
}
