//! Everything a face is made from, and its border in its chart.

use glam::DVec3;

use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::border::nodes::Nodes;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_border::{FaceBorder, border};
use crate::mesh::chart::outline::Outline;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes, Free};
use crate::mesh::data::face_mesh::{FaceMesh, FreeInside};
use crate::mesh::request::input::Input;
use crate::mesh::request::size_requests::SizeRequests;

/// Everything a face is made from.
pub struct FaceInput<'a> {
    /// The plan and the model.
    pub input: &'a Input<'a>,
    /// Its segments.
    pub layout: &'a Layout,
    /// Their nodes.
    pub nodes: &'a Nodes,
    /// Points of all border nodes.
    pub points: &'a [DVec3],
    /// Sizes requested by `near`, `in` and `min_size`.
    pub wanted: &'a SizeRequests,
    /// Segments whose nodes may slide.
    pub sliding: &'a [bool],
}

/// The border of a face, its chart, and the border in it; `None` where the surface is singular all along it.
pub(crate) fn outlined(context: &FaceInput, face: &Face) -> Option<(FaceBorder, Chart, Outline)> {
    let surface = &context.input.model.surfaces[face.surface.index()].surface;
    // Converted once for the border and the chart.
    let _ready = surface.quick();
    let mut border = border(context, face);
    let chart = Chart::new(surface, border.uv.iter().copied())?;
    if face.near > context.input.tolerance.point {
        border.close(&chart, face.near);
    }
    let outline = Outline {
        xy: border.uv.iter().map(|uv| chart.xy(*uv)).collect(),
        p: border.ids.iter().map(|n| context.points[*n as usize]).collect(),
        loops: border.edges.clone(),
        lines: border.lines.clone(),
    };
    Some((border, chart, outline))
}

/// A face of these places and elements, with the ids of the border nodes.
pub(crate) fn prepared(context: &FaceInput, face: &Face, free: Free, mut ids: Vec<u32>, inside: FreeInside) -> FaceMesh {
    let surface = &context.input.model.surfaces[face.surface.index()].surface;
    let (triangles, quads) = (free.triangles.len() as u64, free.quads.len() as u64);
    ids.resize(free.uv.len(), 0);
    FaceMesh {
        surface: face.surface,
        geometry: FaceGeometry { surface: surface.clone(), nodes: FaceNodes::Free(free, ids), flipped: face.flipped, quality: None },
        elements: face.elements,
        first: 0,
        inner: inside.points.len() as u64,
        triangles,
        quads,
        inside: Some(inside),
    }
}

/// A face without anything in it, for as long as only its border matters.
pub fn empty(context: &FaceInput, face: &Face) -> FaceMesh {
    prepared(context, face, Free::default(), Vec::new(), FreeInside::default())
}
