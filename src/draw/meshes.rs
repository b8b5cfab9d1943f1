//! Meshes as triangles with the edges of their elements, and what is wrong with them: free and crowded edges.

use std::ops::Range;

use glam::DVec3;

use std::collections::BTreeSet;

use super::color::FACE;
use super::lines::Folds;
use super::scene::{Kind, Line, Paint, Sheet};
use crate::base::job;
use crate::base::math;
use crate::mesh::{FaceRange, Mesh};

/// Turn between two elements above which their edge counts as a kink where nothing is known of their faces, radians.
const TURN: f64 = std::f64::consts::FRAC_PI_6;

/// What elements show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Nothing but light.
    Light,
    /// 1 for perfect elements, 0 for flat ones, as in the report.
    Quality,
    /// The longest side, model units.
    Size,
}

/// Corners of the n-th element, triangles before quads.
fn corners(mesh: &Mesh, n: usize) -> &[u32] {
    match mesh.triangles.get(n) {
        Some(triangle) => triangle,
        None => &mesh.quads[n - mesh.triangles.len()],
    }
}

/// A mesh as one sheet of flat elements.
pub fn whole(mesh: &Mesh, measure: Measure) -> Sheet {
    let mut sheet = of_elements(mesh, &(0..mesh.triangles.len()), &(0..mesh.quads.len()), measure);
    sheet.name = mesh.name.clone();
    sheet.points = mesh.nodes.clone();
    sheet
}

/// Triangles of some elements with the numbers of the mesh's nodes; without points.
fn of_elements(mesh: &Mesh, triangles: &Range<usize>, quads: &Range<usize>, measure: Measure) -> Sheet {
    let n = triangles.len() + 2 * quads.len();
    let (mut out, mut edges, mut values) = (Vec::with_capacity(n), Vec::with_capacity(n), Vec::new());
    for t in job::looking(&mesh.triangles[triangles.clone()]) {
        out.push(*t);
        edges.push(0b111);
    }
    for [a, b, c, d] in job::looking(&mesh.quads[quads.clone()]) {
        out.extend([[*a, *b, *c], [*a, *c, *d]]);
        edges.extend([0b011, 0b110]);
    }
    if measure != Measure::Light {
        let of = |nodes: &[u32]| of_element(mesh, nodes, measure) as f32;
        values.extend(job::looking(&mesh.triangles[triangles.clone()]).map(|t| of(t)));
        values.extend(job::looking(&mesh.quads[quads.clone()]).flat_map(|q| [of(q); 2]));
    }
    let paint = if values.is_empty() { Paint::Even(FACE) } else { Paint::OfTriangles(values) };
    Sheet { name: String::new(), points: Vec::new(), normals: Vec::new(), triangles: out, edges, paint, bends: Vec::new() }
}

fn of_element(mesh: &Mesh, nodes: &[u32], measure: Measure) -> f64 {
    let p: Vec<DVec3> = nodes.iter().map(|n| mesh.nodes[*n as usize]).collect();
    match measure {
        Measure::Size => (0..p.len()).map(|k| p[k].distance(p[(k + 1) % p.len()])).fold(0.0, f64::max),
        _ => crate::mesh::data::quality::of_element(&p),
    }
}

/// A sheet for each face of the mesh with points of its own; `smooth` gives them the mean normals of its elements.
pub fn by_face(mesh: &Mesh, smooth: bool) -> Vec<Sheet> {
    let whole =
        [FaceRange { name: mesh.name.clone(), triangles: 0..mesh.triangles.len() as u32, quads: 0..mesh.quads.len() as u32, lines: 0..0 }];
    let ranges = if mesh.faces.iter().any(has_faces) { mesh.faces.as_slice() } else { &whole };
    let mut place = vec![u32::MAX; mesh.nodes.len()];
    let mut sheets = Vec::new();
    for range in ranges.iter().filter(|r| has_faces(r)) {
        let wide = |r: &Range<u32>| r.start as usize..r.end as usize;
        let mut sheet = of_elements(mesh, &wide(&range.triangles), &wide(&range.quads), Measure::Light);
        sheet.name = range.name.clone();
        let mut used = Vec::new();
        for corner in job::looking(sheet.triangles.iter_mut().flatten()) {
            let n = *corner as usize;
            if place[n] == u32::MAX {
                place[n] = used.len() as u32;
                used.push(n);
            }
            *corner = place[n];
        }
        sheet.points = used.iter().map(|n| mesh.nodes[*n]).collect();
        used.iter().for_each(|n| place[*n] = u32::MAX);
        if smooth {
            sheet.normals = mean_normals(&sheet.points, &sheet.triangles);
        }
        sheets.push(sheet);
    }
    sheets
}

fn has_faces(range: &FaceRange) -> bool {
    !range.triangles.is_empty() || !range.quads.is_empty()
}

/// Normals at points: those of the triangles around, weighted by their areas.
fn mean_normals(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for t in job::looking(triangles) {
        let [a, b, c] = t.map(|k| points[k as usize]);
        let normal = (b - a).cross(c - a);
        t.iter().for_each(|k| sums[*k as usize] += normal);
    }
    sums.into_iter().map(|n| n.try_normalize().unwrap_or(DVec3::Z)).collect()
}

/// A side of an element: its nodes ascending in one number, and the element.
type Use = (u64, u32);

/// The mesh without the elements of some faces; its nodes stay.
pub fn without(mesh: &Mesh, faces: &BTreeSet<&str>) -> Mesh {
    let mut out =
        Mesh { name: mesh.name.clone(), order: mesh.order, nodes: mesh.nodes.clone(), points: mesh.points.clone(), ..Mesh::default() };
    let wide = |r: &Range<u32>| r.start as usize..r.end as usize;
    for range in mesh.faces.iter().filter(|range| !faces.contains(range.name.as_str())) {
        let before = (out.triangles.len() as u32, out.quads.len() as u32, out.lines.len() as u32);
        out.triangles.extend(&mesh.triangles[wide(&range.triangles)]);
        out.quads.extend(&mesh.quads[wide(&range.quads)]);
        out.lines.extend(&mesh.lines[wide(&range.lines)]);
        let (triangles, quads, lines) =
            (before.0..out.triangles.len() as u32, before.1..out.quads.len() as u32, before.2..out.lines.len() as u32);
        out.faces.push(FaceRange { name: range.name.clone(), triangles, quads, lines });
    }
    out
}

/// Free and crowded edges, edges between faces, and line elements; those of some faces alone, by their names, are left out.
pub fn lines(mesh: &Mesh, folds: &Folds, left_out: &BTreeSet<&str>) -> Vec<Line> {
    let count = mesh.triangles.len() + mesh.quads.len();
    let face_of = faces_of(mesh);
    let mut uses: Vec<Use> = Vec::with_capacity(3 * mesh.triangles.len() + 4 * mesh.quads.len());
    for element in job::looking(0..count) {
        let nodes = corners(mesh, element);
        for k in 0..nodes.len() {
            let (a, b) = (nodes[k], nodes[(k + 1) % nodes.len()]);
            uses.push((u64::from(a.min(b)) << 32 | u64::from(a.max(b)), element as u32));
        }
    }
    job::sort(&mut uses);
    let is_shown = |element: u32| match face_of.get(element as usize).and_then(|k| mesh.faces.get(*k as usize)) {
        Some(face) => !left_out.contains(face.name.as_str()),
        None => true,
    };
    let mut shown = vec![true; mesh.lines.len()];
    for range in mesh.faces.iter().filter(|range| left_out.contains(range.name.as_str())) {
        (range.lines.start as usize..range.lines.end as usize).for_each(|k| shown[k] = false);
    }
    let drawn = mesh.lines.iter().zip(shown).filter(|(_, shown)| *shown);
    let mut out: Vec<Line> = drawn.map(|(ends, _)| segment(mesh, Kind::Curve, *ends)).collect();
    for edge in job::looking(uses.chunk_by(|a, b| a.0 == b.0)) {
        if !edge.iter().any(|(_, element)| is_shown(*element)) {
            continue;
        }
        if let Some(kind) = kind_of(mesh, edge, &face_of, folds) {
            out.push(segment(mesh, kind, [(edge[0].0 >> 32) as u32, edge[0].0 as u32]));
        }
    }
    out
}

fn segment(mesh: &Mesh, kind: Kind, ends: [u32; 2]) -> Line {
    Line { kind, points: ends.map(|n| mesh.nodes[n as usize]).to_vec() }
}

/// The face of each element; empty where the mesh knows none.
fn faces_of(mesh: &Mesh) -> Vec<u32> {
    if !mesh.faces.iter().any(has_faces) {
        return Vec::new();
    }
    let mut of = vec![u32::MAX; mesh.triangles.len() + mesh.quads.len()];
    for (k, range) in mesh.faces.iter().enumerate() {
        let quads = range.quads.start as usize + mesh.triangles.len()..range.quads.end as usize + mesh.triangles.len();
        (range.triangles.start as usize..range.triangles.end as usize).chain(quads).for_each(|e| of[e] = k as u32);
    }
    of
}

/// What an edge shows; `None` for one inside a face.
fn kind_of(mesh: &Mesh, edge: &[Use], face_of: &[u32], folds: &Folds) -> Option<Kind> {
    let [(_, a), (_, b)] = *edge else {
        return Some(if edge.len() == 1 { Kind::Free } else { Kind::Crowded });
    };
    let face = |element: u32| face_of.get(element as usize).and_then(|k| Some((*k, mesh.faces.get(*k as usize)?.name.as_str())));
    match (face(a), face(b)) {
        (Some((a, _)), Some((b, _))) if a == b => None,
        (Some((_, one)), Some((_, other))) => {
            let ends = [(edge[0].0 >> 32) as usize, edge[0].0 as u32 as usize].map(|n| mesh.nodes[n]);
            let known = folds.at((one, other), 0.5 * (ends[0] + ends[1])).filter(|kind| matches!(kind, Kind::Kink | Kind::Border));
            Some(known.unwrap_or(if one == other || is_bent(mesh, a, b) { Kind::Kink } else { Kind::Border }))
        }
        _ => is_bent(mesh, a, b).then_some(Kind::Kink),
    }
}

/// Whether two elements meet at such an angle that it is hardly the bend of a smooth surface.
fn is_bent(mesh: &Mesh, a: u32, b: u32) -> bool {
    let normal = |e: u32| {
        let p: Vec<DVec3> = corners(mesh, e as usize).iter().map(|n| mesh.nodes[*n as usize]).collect();
        crate::base::triangulate::newell(&p)
    };
    let (m, n) = (normal(a), normal(b));
    m.length() > 0.0 && n.length() > 0.0 && math::angle_between(m, n) > TURN
}
