//! E715: elements whose normal is opposite to the surface's, or that have no area.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::par;
use crate::mesh::data::face_geometry::{FaceNodes, Free};
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::data::quality::is_concave;
use crate::mesh::request::fault::ElementFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::recall::RecallFace;
use crate::surface::Surface;

/// Largest number of cells along each direction of a face that are compared with the surface's normal.
const MAX_PROBES: usize = 16;

/// Turned cells of a face: how many, and (u, v) of the first.
pub type Turned = (u64, (f64, f64));

/// Fails when a face has turned elements, with their number and the first place.
pub fn refuse_turned(input: &Input, prepared: &[FaceMesh], mesh: &Mesh, recall: &RecallFace<Option<Turned>>) -> Result<()> {
    let found = par::map(prepared.len(), |k| {
        let surface = &input.model.surfaces[prepared[k].surface.index()].surface;
        recall(k, &|_| {}, &|| turned(surface, &prepared[k], mesh))
    });
    first_fault(input, prepared, found)
}

/// Fails when a face that is made freely has concave quads, with their number and the first place.
pub fn refuse_concave(input: &Input, prepared: &[FaceMesh], mesh: &Mesh) -> Result<()> {
    let found = prepared.iter().map(|face_mesh| match &face_mesh.geometry.nodes {
        FaceNodes::Free(free, places) => concave_quads(free, places, mesh),
        _ => None,
    });
    first_fault(input, prepared, found.collect())
}

fn first_fault(input: &Input, prepared: &[FaceMesh], found: Vec<Option<Turned>>) -> Result<()> {
    for (face_mesh, bad) in prepared.iter().zip(found) {
        if let Some((count, uv)) = bad {
            let surface = &input.model.surfaces[face_mesh.surface.index()].surface;
            let at = surface.point(uv.0, uv.1);
            let free = matches!(face_mesh.geometry.nodes, FaceNodes::Free(..));
            return Err(ElementFault::Inverted { surface: surface.origin(), count, uv, at, free }.into());
        }
    }
    Ok(())
}

/// Free quads with a corner of a half turn or more, or without area.
fn concave_quads(free: &Free, places: &[u32], mesh: &Mesh) -> Option<Turned> {
    let point = |n: u32| mesh.nodes[places[n as usize] as usize];
    let concave = |quad: &&[u32; 4]| is_concave(quad.map(point));
    let first = free.quads.iter().find(concave)?;
    let (a, b) = (free.uv[first[0] as usize], free.uv[first[2] as usize]);
    let count = free.quads.iter().filter(concave).count() as u64;
    Some((count, (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1))))
}

/// Cells on a coarse selection of rows and columns whose normal stands against the surface's.
fn turned(surface: &Surface, face_mesh: &FaceMesh, mesh: &Mesh) -> Option<Turned> {
    let FaceNodes::Grid(grid, frame) = &face_mesh.geometry.nodes else {
        return None;
    };
    let (nu, nv) = frame.size();
    let pick = |n: usize| (0..n.min(MAX_PROBES)).map(move |k| k * n / n.min(MAX_PROBES));
    let node = |i: usize, j: usize| mesh.nodes[frame.node(i, j) as usize];
    let (mut count, mut first) = (0, None);
    for j in pick(nv) {
        for i in pick(nu) {
            let normal: DVec3 = (node(i + 1, j + 1) - node(i, j)).cross(node(i, j + 1) - node(i + 1, j));
            let (a, b) = (grid.uv(i, j), grid.uv(i + 1, j + 1));
            let middle = (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
            let wanted = surface.normal(middle.0, middle.1);
            // Where the surface itself has no normal there is nothing to compare with.
            if wanted != DVec3::ZERO && normal.dot(wanted) <= 0.0 {
                count += 1;
                first = first.or(Some(middle));
            }
        }
    }
    first.map(|uv| (count, uv))
}
