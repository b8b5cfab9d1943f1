//! Why a free face was not made, and its fault.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::triangulate_points::PointsFault;
use crate::mesh::border::layout::{Face, middle};
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::request::fault::{CountFault, FaceFault};
use crate::mesh::tri::tree::MAX_DEPTH;

/// The fault of a face that was not made.
pub(crate) fn fault(face_input: &FaceInput, face: &Face, border: &FaceBorder, reason: NoMesh) -> Fault {
    let surface = face_input.input.model.surfaces[face.surface.index()].surface.origin();
    let place = |n: u32| border.ids.get(n as usize).map_or(DVec3::ZERO, |id| face_input.points[*id as usize]);
    match reason {
        NoMesh::Border(PointsFault::Crosses(a, b)) => {
            FaceFault::BordersCross { surface, at: 0.5 * (place(a) + place(b)), size: face.size.0 }.into()
        }
        NoMesh::Border(PointsFault::Same(a, _)) => FaceFault::BordersCross { surface, at: place(a), size: face.size.0 }.into(),
        NoMesh::Border(PointsFault::Flat) | NoMesh::Empty => no_area(face_input, face),
        NoMesh::TreeTooDeep(at) => FaceFault::TreeTooDeep { surface, at, levels: MAX_DEPTH }.into(),
        NoMesh::Odd => {
            let odd = face.segments().find(|s| face_input.nodes.count(*s) % 2 == 1).unwrap_or(0);
            CountFault::Odd { count: (0, Origin::NONE), surface, at: face_input.layout.point(odd, 0.5) }.into()
        }
        NoMesh::TooManyNodes => {
            let plan = face_input.input.plan;
            let bent = !face_input.input.model.surfaces[face.surface.index()].surface.is_in_plane();
            let limit = plan.settings.chord_error.or(plan.settings.angle_error).filter(|_| bent).map(|limit| limit.1);
            let of = limit.unwrap_or_else(|| crate::mesh::size::too_large::of_size(face_input.input, face.size.1));
            crate::mesh::request::work::too_many(plan, of, None)
        }
    }
}

pub(crate) fn no_area(face_input: &FaceInput, face: &Face) -> Fault {
    let surface = face_input.input.model.surfaces[face.surface.index()].surface.origin();
    FaceFault::Empty { surface, at: middle(face_input.input, face) }.into()
}

/// A result, or why there is none; the outer result is an interruption.
pub type Outcome<T> = Result<std::result::Result<T, NoMesh>>;

/// Why there is no mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoMesh {
    /// The border cannot be triangulated in the chart.
    Border(PointsFault),
    /// Nothing is inside the border.
    Empty,
    /// More nodes than allowed.
    TooManyNodes,
    /// Lines inside divide the border into parts with odd counts.
    Odd,
    /// A quadtree has to be deeper than it may be here.
    TreeTooDeep(DVec3),
}
