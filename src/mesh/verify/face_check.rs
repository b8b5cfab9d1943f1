//! The check of every face of every mesh before the mesh is handed on: a failure is a defect of the mesher, and is reported as one.
//!
//! Elements are checked by their node numbers (`connectivity.rs`), by their orientation (`orientation.rs`), by the part of the parameter
//! plane that they cover and by where their nodes lie (`covered_area.rs`).

use crate::base::par;
use crate::mesh::border::layout::{Face, closes};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::{FaceMesh, element_ranges};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::methods::Elements;
use crate::mesh::verify::connectivity::Claim;
use crate::mesh::verify::covered_area::{self, CoveredArea, NodePlaces};
use crate::mesh::verify::defect::Defect;
use crate::mesh::verify::face_border::LayoutBorder;
use crate::mesh::verify::orientation::unfolded;

/// The first defect in the positions of the elements of a face on its surface.
fn off_surface(face_input: &FaceInput, face: &Face, face_mesh: &FaceMesh, mesh: &Mesh) -> Option<Defect> {
    let Some(covered) = unfolded(face_mesh, mesh) else { return Some(Defect::Folded) };
    let left_out = match (&face_mesh.geometry.nodes, &face_mesh.inside) {
        (FaceNodes::Free(free, ids), Some(inside)) if closes(face) => {
            let triangles = free.triangles.iter().map(|t| t.as_slice());
            let elements = triangles.chain(free.quads.iter().map(|q| q.as_slice()));
            let places = NodePlaces { uv: &free.uv, ids };
            let Some(out) = covered_area::left_out(elements, places, free.border, &inside.loops) else {
                return Some(Defect::Torn);
            };
            out
        }
        _ => CoveredArea::default(),
    };
    if let Err((found, wanted)) = covered_area::compare(face_input, face, covered.and(left_out)) {
        return Some(Defect::CoveredArea(found, wanted));
    }
    covered_area::misplaced(face_input.input, face, face_mesh, mesh).map(|(node, off)| Defect::Misplaced(node, off))
}

/// The first face with a defect, by its place in the layout.
pub(crate) fn unsound(face_input: &FaceInput, prepared: &[FaceMesh], mesh: &Mesh) -> Option<(usize, Defect)> {
    let ranges = element_ranges(prepared);
    let found = par::map(prepared.len(), |f| {
        let (face, face_mesh, (triangles, quads)) = (&face_input.layout.faces[f], &prepared[f], ranges[f].clone());
        let own = LayoutBorder::new(face_input, face);
        let claim = Claim {
            triangles: &mesh.triangles[triangles],
            quads: &mesh.quads[quads],
            kind: if face.free && face.method.of_triangles().is_some() { Elements::Triangles } else { face.elements },
            border: &own.edges,
            lines: &own.lines,
            points: &own.points,
            own: (face_mesh.first, face_mesh.inner as u32),
            euler: own.euler,
        };
        claim.hold().err().or_else(|| off_surface(face_input, face, face_mesh, mesh))
    });
    found.into_iter().enumerate().find_map(|(f, defect)| Some((f, defect?)))
}
