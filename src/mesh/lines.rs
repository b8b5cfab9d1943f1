//! Curves of a mesh as line elements, points as nodes; what lies inside a face needs another method.

use super::build::Input;
use super::data::{FaceRange, Mesh};
use super::foot;
use super::layout::Layout;
use super::nodes::Nodes;
use crate::base::bbox::Box3;
use crate::base::fault::{MeshFault, Result};
use crate::base::origin::Origin;
use crate::model::PatchId;
use crate::surface::Domain;
use glam::DVec3;

/// E230 for curves and points that lie inside a face, off its mesh lines.
pub fn refuse_inside(input: &Input, layout: &Layout) -> Result<()> {
    let mut on_face = vec![false; layout.pieces.atoms.len()];
    layout.faces.iter().flat_map(|f| &f.sides).flat_map(|s| s.stretches()).for_each(|s| on_face[s] = true);
    for ((name, chain), uses) in input.plan.curves.iter().zip(&layout.curves) {
        for u in uses.iter().filter(|u| !on_face[u.atom]) {
            let probes = [0.25, 0.5, 0.75].map(|f| layout.point(u.atom, f));
            if let Some(at) = inside(input, layout, &probes) {
                let what = format!("`{name}`, which runs inside a face");
                return Err(MeshFault::NeedsLater { of: chain.origin(), what, method: "delaunay", at }.into());
            }
        }
    }
    for (point, junction) in input.plan.points.iter().zip(&layout.points) {
        if junction.is_none() && inside(input, layout, &[*point]).is_some() {
            let what = "a point inside a face".to_owned();
            return Err(MeshFault::NeedsLater { of: origin(input), what, method: "delaunay", at: *point }.into());
        }
    }
    Ok(())
}

fn origin(input: &Input) -> Origin {
    input.plan.origin
}

/// The first of some points when all of them lie on one face.
fn inside(input: &Input, layout: &Layout, points: &[DVec3]) -> Option<DVec3> {
    let box_of = Box3::of(points.iter().copied());
    let on = |patch: PatchId| {
        let record = &input.model.patches[patch.index()];
        let surface = &input.model.surfaces[record.surface.index()].surface;
        box_of.touches(&surface.hull(), input.tolerance.point)
            && points.iter().all(|p| match surface.domain() {
                Domain::Loop => crate::surface::closest(surface, *p).distance <= input.tolerance.point,
                _ => foot::nearest_anywhere(surface, *p, record.u, record.v).0 <= input.tolerance.point,
            })
    };
    layout.faces.iter().any(|f| on(f.patch)).then(|| points[points.len() / 2])
}

/// Writes the line elements of the plan's curves, each curve a range of the mesh, and its points.
pub fn add(input: &Input, layout: &Layout, nodes: &Nodes, mesh: &mut Mesh) {
    for ((name, _), uses) in input.plan.curves.iter().zip(&layout.curves) {
        let from = mesh.lines.len() as u32;
        for u in uses {
            let ids = nodes.of_stretch(layout, u.atom, u.against);
            mesh.lines.extend(ids.windows(2).map(|w| [w[0], w[1]]));
        }
        let (t, q) = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
        mesh.faces.push(FaceRange { name: name.clone(), triangles: t..t, quads: q..q, lines: from..mesh.lines.len() as u32 });
    }
    mesh.points.extend(&nodes.points);
}
