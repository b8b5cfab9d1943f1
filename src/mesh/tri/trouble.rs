//! Why a free face was not made, and what is said of it.

use glam::DVec3;

use crate::base::fault::Fault;
use crate::base::origin::Origin;
use crate::base::triangulate_points::PointsFault;
use crate::mesh::border::layout::{Face, middle};
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::request::fault::MeshFault;
use crate::mesh::tri::tree::MAX_DEPTH;

/// What went wrong, in the user's words.
pub(crate) fn fault(made: &FaceInput, face: &Face, border: &FaceBorder, trouble: Trouble) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    let place = |n: u32| border.ids.get(n as usize).map_or(DVec3::ZERO, |id| made.points[*id as usize]);
    match trouble {
        Trouble::Border(PointsFault::Crosses(a, b)) => {
            MeshFault::BordersCross { surface, at: 0.5 * (place(a) + place(b)), size: face.size.0 }.into()
        }
        Trouble::Border(PointsFault::Same(a, _)) => MeshFault::BordersCross { surface, at: place(a), size: face.size.0 }.into(),
        Trouble::Border(PointsFault::Flat) | Trouble::Empty => no_area(made, face),
        Trouble::Deep(at) => MeshFault::TreeTooDeep { surface, at, levels: MAX_DEPTH }.into(),
        Trouble::Odd => {
            let odd = face.segments().find(|s| made.nodes.count(*s) % 2 == 1).unwrap_or(0);
            MeshFault::OddCount { count: (0, Origin::NONE), surface, at: made.layout.point(odd, 0.5) }.into()
        }
        Trouble::Full => {
            let plan = made.input.plan;
            let bent = !made.input.model.surfaces[face.surface.index()].surface.is_flat();
            let limit = plan.settings.chord_error.or(plan.settings.angle_error).filter(|_| bent).map(|limit| limit.1);
            let of = limit.unwrap_or_else(|| crate::mesh::size::too_large::of_size(made.input, face.size.1));
            crate::mesh::request::work::too_many(plan, of, None)
        }
    }
}

pub(crate) fn no_area(made: &FaceInput, face: &Face) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    MeshFault::FaceEmpty { surface, at: middle(made.input, face) }.into()
}

/// Why there is no mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// The border cannot be triangulated in the chart.
    Border(PointsFault),
    /// Nothing is inside the border.
    Empty,
    /// More nodes than allowed.
    Full,
    /// Lines inside part the odd counts of a border.
    Odd,
    /// A quadtree has to be deeper than it may be here.
    Deep(DVec3),
}
