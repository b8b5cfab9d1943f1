//! Curves of a mesh as line elements, points as nodes.

use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::data::mesh::{FaceRange, Mesh};
use crate::mesh::request::input::Input;

/// Writes the line elements of the plan's curves, each curve a range of the mesh, and its points.
pub fn add(input: &Input, layout: &Layout, nodes: &Nodes, mesh: &mut Mesh) {
    for ((name, _), uses) in input.plan.curves.iter().zip(&layout.curves) {
        let from = mesh.lines.len() as u32;
        for u in uses {
            let ids = nodes.of_segment(layout, u.segment, u.against);
            mesh.lines.extend(ids.windows(2).map(|w| [w[0], w[1]]));
        }
        let (t, q) = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
        mesh.faces.push(FaceRange { name: name.clone(), triangles: t..t, quads: q..q, lines: from..mesh.lines.len() as u32 });
    }
    mesh.points.extend(&nodes.points);
}
