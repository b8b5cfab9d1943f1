//! A free face: its border in its chart, its inside fitted to the limits.

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::border::layout::Face;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::{FaceInput, prepared};
use crate::mesh::chart::outline::Outline;
use crate::mesh::data::face_geometry::Free;
use crate::mesh::data::face_mesh::{FaceMesh, FreeInside};
use crate::mesh::quad::quad_face;
use crate::mesh::request::methods::Elements;
use crate::mesh::tri::no_mesh::fault;
use crate::mesh::tri::sliding_border::SlidingBorder;
use crate::mesh::tri::triangle_fit::{FittedFace, fitted};

/// Fills the face: of quads, or of triangles that keep its limits.
pub(crate) fn filled(
    face_input: &FaceInput,
    face: &Face,
    border: FaceBorder,
    chart: &Chart,
    outline: &Outline,
    sliding: Option<&SlidingBorder>,
    job: &Job,
) -> Result<FaceMesh> {
    if face.elements != Elements::Triangles && face.method.of_triangles().is_none() {
        return quad_face::prepare(face_input, face, border, chart, outline, job);
    }
    let FittedFace { triangulation, decided, tally } = match fitted(face_input, face, chart, outline, sliding, job)? {
        Ok(fitted) => fitted,
        Err(reason) => return Err(fault(face_input, face, &border, reason)),
    };
    // Rings are fixed, but no part of the border.
    let fixed = border.uv.len();
    // At a pole the chart has an edge that is a point in space.
    let node = |n: u32| border.ids.get(n as usize).copied();
    let flat = |t: &[u32; 3]| (0..3).any(|k| node(t[k]).is_some() && node(t[k]) == node(t[(k + 1) % 3]));
    let triangles: Vec<[u32; 3]> = triangulation.tri.iter().copied().filter(|t| !flat(t)).collect();
    let slid = sliding.map_or_else(Vec::new, |border| border.slid(&triangulation.along));
    let mut uv = border.uv;
    if !slid.is_empty() {
        // A place that stayed keeps its bits.
        let moved = (0..fixed).filter(|n| triangulation.xy[*n] != outline.xy[*n]).collect::<Vec<_>>();
        moved.into_iter().for_each(|n| uv[n] = chart.uv(triangulation.xy[n]));
    }
    uv.extend(triangulation.xy[fixed..].iter().map(|xy| chart.uv(*xy)));
    let points = triangulation.p[fixed..].to_vec();
    let free = Free { uv, border: fixed, triangles, ..Free::default() };
    Ok(prepared(
        face_input,
        face,
        free,
        border.ids,
        FreeInside { points, loops: border.edges, decided: decided.without(fixed), tally, slid },
    ))
}
