//! The fault for a face with a defect: by the cause where one is found, else as a defect of the mesher.

use glam::DVec3;

use crate::base::fault::Fault;
use crate::base::math;
use crate::base::tolerance::TOLD_APART;
use crate::mesh::border::layout::{Face, Layout, middle};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::fault::{Close, ElementFault};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::Method;
use crate::mesh::verify::defect::Defect;
use crate::mesh::verify::face_border::LayoutBorder;
use crate::surface::faults::CutFault;

/// Chords of a piece of a border that is looked at for turns.
const CHORDS: usize = 4096;
/// What turns by more goes back, radians.
const BACK: f64 = 2.0;

/// E999 for a face with a defect; E720 where it closes on itself or its border turns back along itself
/// more narrowly than its size.
pub(crate) fn fault(face_input: &FaceInput, face: &Face, face_mesh: &FaceMesh, defect: Defect, mesh: &Mesh) -> Fault {
    let FaceInput { input, layout, nodes, .. } = face_input;
    let at = defect.node().and_then(|n| mesh.nodes.get(n as usize).copied());
    let at = at.unwrap_or_else(|| middle(input, face));
    let surface = input.model.surfaces[face.surface.index()].surface.origin();
    let method = if face.free { word(face.method) } else { "mapped" };
    if let Some(turn) = face.turns().next() {
        let at = layout.point(turn.segment, if turn.against { 0.0 } else { 1.0 });
        return ElementFault::ClosesTooNear { surface, method, at, close: Close::Turn }.into();
    }
    if face.halved > 0 {
        let is_pole = |n: u32| face.sides.iter().any(|side| side.pole.is_some_and(|pole| nodes.of_junction(pole) == n));
        let close = if defect.node().is_some_and(is_pole) { Close::Tip } else { Close::Seam };
        return ElementFault::ClosesTooNear { surface, method, at, close }.into();
    }
    let crowded = crowded(face_input, face, defect);
    if let Some(fault) = crowded.or_else(|| short(face_input, face, mesh)).or_else(|| folded(input, face, method)) {
        return fault;
    }
    if let Some(at) = turned_back(layout, face) {
        return ElementFault::ClosesTooNear { surface, method, at, close: Close::Turn }.into();
    }
    ElementFault::Unsound {
        mesh: (input.plan.origin, input.plan.name.clone()),
        surface,
        method,
        elements: [face_mesh.triangles, face_mesh.quads],
        what: defect.words(),
        at,
    }
    .into()
}

/// Where a piece of the border of a free face turns back along itself, as a spline that swings about points in one place does: by chords of
/// a share of the piece each.
fn turned_back(layout: &Layout, face: &Face) -> Option<DVec3> {
    if !face.free {
        return None;
    }
    let fraction = |k: usize| k as f64 / CHORDS as f64;
    let fractions: Vec<f64> = (0..=CHORDS).map(fraction).collect();
    face.sides.iter().flat_map(|side| &side.uses).find_map(|used| {
        let points = layout.points_along(used.segment, &fractions);
        let turns = |w: &&[DVec3]| math::angle_between(w[1] - w[0], w[2] - w[1]) > BACK;
        points.windows(3).find(turns).map(|w| w[1])
    })
}

/// E718 where the surface folds over or has no normal somewhere inside.
fn folded(input: &Input, face: &Face, method: &'static str) -> Option<Fault> {
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let (at, turn) = surface.fold(input.tolerance)?;
    Some(ElementFault::Folded { surface: surface.origin(), method, at, turn }.into())
}

/// E721 where borders and lines of a face cut each other into edges shorter than the distance of distinct cuts.
fn short(face_input: &FaceInput, face: &Face, mesh: &Mesh) -> Option<Fault> {
    let input = face_input.input;
    let own = LayoutBorder::new(face_input, face);
    let ends = |edge: &[u32; 2]| edge.map(|n| mesh.nodes[n as usize]);
    let edges = own.edges.iter().chain(&own.lines).map(ends).filter(|[a, b]| a != b);
    let [a, b] = edges.min_by(|[a, b], [c, d]| a.distance(*b).total_cmp(&c.distance(*d)))?;
    let apart = a.distance(b);
    let surface = input.model.surfaces[face.surface.index()].surface.origin();
    let fault = CutFault::CutsTooNear { surface, cuts: [surface; 2], at: a, apart, tolerance: input.tolerance.point };
    (apart <= TOLD_APART * input.tolerance.point).then(|| fault.into())
}

/// E721 where the edge of a line inside a face is in no element, since another line or border runs beside it within the distance of
/// distinct cuts.
fn crowded(face_input: &FaceInput, face: &Face, defect: Defect) -> Option<Fault> {
    let FaceInput { input, layout, nodes, .. } = face_input;
    let Defect::Edge([a, b], ..) = defect else { return None };
    let is_edge = |w: &[u32]| w == [a, b] || w == [b, a];
    let place = |line: &usize| {
        let k = nodes.of_segment(layout, *line, false).windows(2).position(is_edge)?;
        let at = nodes.fractions(*line, false);
        Some((*line, layout.point(*line, 0.5 * (at[k] + at[k + 1]))))
    };
    let (line, at) = face.lines.iter().find_map(place)?;
    let near = TOLD_APART * input.tolerance.point;
    let others = face.segments().filter(|other| *other != line).map(|other| layout.distance(other, at));
    let apart = others.min_by(f64::total_cmp).filter(|apart| *apart <= near)?;
    let surface = input.model.surfaces[face.surface.index()].surface.origin();
    Some(CutFault::CutsTooNear { surface, cuts: [surface; 2], at, apart, tolerance: input.tolerance.point }.into())
}

/// The name of a method of free faces.
fn word(method: Method) -> &'static str {
    match method {
        Method::Quadtree => "quadtree",
        Method::Isoline => "isoline",
        Method::Display => "display",
        _ => "delaunay",
    }
}
