//! The mesh of a set of faces that share their borders.

use crate::base::fault::{Fault, Result};
use crate::base::job::Job;
use crate::mesh::border::inside;
use crate::mesh::border::layout::{Face, Layout, Uneven};
use crate::mesh::border::nodes::Nodes;
use crate::mesh::cache::reuse::CacheView;
use crate::mesh::data::face_geometry::FaceGeometries;
use crate::mesh::data::face_mesh::{self, FaceMesh};
use crate::mesh::data::mesh::{FaceRange, Mesh};
use crate::mesh::output::{lines, second_order};
use crate::mesh::pipeline::attempt::{FinishedMesh, attempt};
use crate::mesh::report::border_error;
use crate::mesh::report::explain::Explanation;
use crate::mesh::report::node_sizes;
use crate::mesh::request::fault::SizeFault;
use crate::mesh::request::input::Input;
use crate::mesh::size::sizing::Sizing;

/// The mesh of some faces, with what is needed to name its parts.
pub struct MeshPart {
    /// The mesh, without groups.
    pub mesh: Mesh,
    /// Surface and element ranges of its faces.
    pub ranges: crate::mesh::output::sets::Ranges,
    /// How it came about.
    pub explanation: Explanation,
    /// Its segments.
    pub layout: Layout,
    /// Nodes on them.
    pub nodes: Nodes,
    /// Its rules.
    pub sizing: Sizing,
}

/// Largest number of times that the steps of the border of a face are halved because triangles beside it are tilted against the surface.
const MAX_TILT_HALVINGS: u32 = 3;

/// Divides what is laid out, refines until every limit is kept, and fills. `size` is the target size where no rule sets
/// another, model units.
pub fn assemble(input: &Input, mut layout: Layout, size: f64, cache: Option<&CacheView>, job: &Job) -> Result<MeshPart> {
    inside::place(input, &mut layout);
    debug_assert_eq!(layout.check(input), Ok(()));
    loop {
        match attempt(input, &mut layout, size, cache, job) {
            Ok(done) => return Ok(finish(input, layout, done, cache.is_some())),
            // Faces that are free only for better angles have a map.
            Err(_) if keep_maps(&mut layout) => job.go_on()?,
            Err(fault) if halve_tilted(input, &mut layout, &fault) => job.go_on()?,
            Err(fault) => return Err(fault),
        }
    }
}

/// Maps the faces again that are free because their maps are sharp; whether there were any.
fn keep_maps(layout: &mut Layout) -> bool {
    let mut any = false;
    for face in layout.faces.iter_mut().filter(|face| matches!(face.uneven, Some(Uneven::Sharp(_)))) {
        face.keep_map();
        any = true;
    }
    any
}

/// Halves the steps of the borders of faces made with as few triangles as may be that do not keep a limit: an element
/// beside a long step of a border is tilted against the surface, however small it is. Whether there were any.
fn halve_tilted(input: &Input, layout: &mut Layout, fault: &Fault) -> bool {
    let Some(SizeFault::NotReached { surface, .. }) = fault.of() else { return false };
    let of = |face: &Face| input.model.surfaces[face.surface.index()].surface.origin();
    let mut any = false;
    for face in layout.faces.iter_mut().filter(|face| of(face) == *surface) {
        if face.method.is_coarse() && face.halved < MAX_TILT_HALVINGS {
            face.halved += 1;
            any = true;
        }
    }
    any
}

/// Ranges, line elements and mid nodes; with asked lengths for a session, where somebody may look at the mesh.
fn finish(input: &Input, layout: Layout, done: FinishedMesh, sized: bool) -> MeshPart {
    let FinishedMesh { nodes, prepared, sizing, mut mesh, explanation } = done;
    if sized {
        mesh.sizes = node_sizes::of_nodes(input, &layout, &nodes, &sizing, &prepared, &explanation, mesh.nodes.len());
    }
    let mut ranges = crate::mesh::output::sets::Ranges::new();
    for ((face_mesh, face), own) in prepared.iter().zip(&layout.faces).zip(face_mesh::element_ranges(&prepared)) {
        let [triangles, quads] = [own.0, own.1].map(|range| range.start as u32..range.end as u32);
        let name = input.model.surfaces[face_mesh.surface.index()].name.clone();
        mesh.faces.push(FaceRange { name, triangles: triangles.clone(), quads: quads.clone(), lines: 0..0 });
        ranges.push(((face.patch, face_mesh.surface), triangles, quads));
    }
    lines::add(input, &layout, &nodes, &mut mesh);
    if input.plan.settings.order() == 2 {
        second_order::add(input, &layout, &nodes, &prepared, &mut mesh);
    }
    mesh.border_error = border_error::of_free_borders(&layout, &nodes);
    mesh.geometries = FaceGeometries(prepared.into_iter().map(FaceMesh::into_chart).collect());
    MeshPart { mesh, ranges, explanation, layout, nodes, sizing }
}
