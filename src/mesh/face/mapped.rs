//! Mapped faces ready to be filled: their grids or lattices, with the ids of their border nodes.

use crate::base::fault::Result;
use crate::mesh::border::layout::{Face, Layout, middle};
use crate::mesh::border::nodes::{Nodes, line};
use crate::mesh::border::side_parameters::side_parameters;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::mapped::grid::{self, Grid};
use crate::mesh::mapped::trilateral::{Blocks, Lattice, LatticeIds};
use crate::mesh::request::fault::{CountFault, FaceFault};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::Elements;

/// The geometry and ids of a face; `rows` are the counts of its rows.
pub fn prepare(input: &Input, layout: &Layout, nodes: &Nodes, face: &Face, rows: &[u32]) -> Result<FaceMesh> {
    if face.is_triangle() {
        return prepare_triangle(input, layout, nodes, face);
    }
    let patch = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let steps = |k: usize| rows[k % 2] as usize;
    let lines = [0, 1, 2, 3].map(|k| line(layout, nodes, face, k, steps(k)));
    let mut values =
        [0, 1, 2, 3].map(|k| if lines[k].lengths.is_empty() { Vec::new() } else { side_parameters(input, face, k, &lines[k].lengths) });
    for k in 0..4 {
        if values[k].is_empty() {
            let (low, high) = if k % 2 == 0 { patch.u } else { patch.v };
            // At a pole lines go on as they come from the other side; between two poles they are even.
            let even = || (0..=steps(k)).map(|i| low + (high - low) * i as f64 / steps(k) as f64).collect();
            let opposite = &values[(k + 2) % 4];
            values[k] = if opposite.is_empty() { even() } else { opposite.clone() };
        }
    }
    let poles = [0, 1, 2, 3].map(|k| face.sides[k].uses.is_empty());
    let [a, b, c, d] = lines;
    let frame = grid::GridIds { sides: [a.ids, b.ids, c.ids, d.ids], poles, first: 0 };
    let (triangles, quads) = frame.elements(face.elements);
    let grid = Grid::new(patch.u, patch.v, values, input.tolerance);
    Ok(FaceMesh {
        inner: frame.inner(),
        geometry: FaceGeometry { surface: surface.clone(), nodes: FaceNodes::Grid(grid, frame), flipped: face.flipped, quality: None },
        surface: face.surface,
        elements: face.elements,
        first: 0,
        triangles,
        quads,
        inside: None,
    })
}

fn prepare_triangle(input: &Input, layout: &Layout, nodes: &Nodes, face: &Face) -> Result<FaceMesh> {
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let lines = [0, 1, 2].map(|k| line(layout, nodes, face, k, 0));
    let values = [0, 1, 2].map(|k| side_parameters(input, face, k, &lines[k].lengths));
    let [a, b, c] = lines;
    let ids = [a.ids, b.ids, c.ids];
    let n = ids[0].len() as u64 - 1;
    if face.elements == Elements::Triangles {
        let inner = if n < 2 { 0 } else { (n - 1) * (n - 2) / 2 };
        return Ok(FaceMesh {
            geometry: FaceGeometry {
                surface: surface.clone(),
                nodes: FaceNodes::Lattice(Lattice { sides: values }, LatticeIds { sides: ids, first: 0 }),
                flipped: face.flipped,
                quality: None,
            },
            surface: face.surface,
            elements: face.elements,
            first: 0,
            inner,
            triangles: n * n,
            quads: 0,
            inside: None,
        });
    }
    let Some(blocks) = Blocks::new(&values) else {
        let counts = [0, 1, 2].map(|k| ids[k].len() as u32 - 1);
        return Err(CountFault::SidesDoNotClose { counts, written: Vec::new(), surface: surface.origin() }.into());
    };
    let mut places = vec![0; blocks.uv.len()];
    for (side, line) in blocks.sides.iter().zip(&ids) {
        side.iter().zip(line).for_each(|(place, id)| places[*place as usize] = *id);
    }
    Ok(FaceMesh {
        inner: blocks.inner as u64,
        triangles: 0,
        quads: blocks.quads.len() as u64,
        geometry: FaceGeometry { surface: surface.clone(), nodes: FaceNodes::Blocks(blocks, places), flipped: face.flipped, quality: None },
        surface: face.surface,
        elements: face.elements,
        first: 0,
        inside: None,
    })
}

/// E704 when faces for which only quads are wanted got triangles.
pub fn refuse_triangles(input: &Input, layout: &Layout, prepared: &[FaceMesh]) -> Result<()> {
    let mut places = Vec::new();
    for (face, face_mesh) in layout.faces.iter().zip(prepared) {
        if face_mesh.elements == Elements::Quads && face_mesh.triangles > 0 {
            let pole = face.sides.iter().find_map(|s| s.pole).map_or_else(|| middle(input, face), |p| layout.pieces.junctions[p]);
            places.push((input.model.surfaces[face.surface.index()].surface.origin(), face_mesh.triangles, pole));
        }
    }
    if places.is_empty() { Ok(()) } else { Err(FaceFault::QuadsImpossible { mesh: input.plan.origin, places }.into()) }
}
