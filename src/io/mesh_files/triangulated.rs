//! The faces of a mesh as triangles: its triangles, then its quads as two each.

use crate::mesh::Mesh;

/// The two triangles of a quad, cut from its first corner to its third: those by which areas and errors are measured.
pub(crate) fn halves(mesh: &Mesh, quad: usize) -> [[u32; 3]; 2] {
    let [a, b, c, d] = mesh.quads[quad];
    [[a, b, c], [a, c, d]]
}

/// How many triangles there are.
pub(crate) fn count(mesh: &Mesh) -> usize {
    mesh.triangles.len() + 2 * mesh.quads.len()
}

/// Corners of the triangle at `index`.
pub(crate) fn triangle(mesh: &Mesh, index: usize) -> [u32; 3] {
    match mesh.triangles.get(index) {
        Some(corners) => *corners,
        None => {
            let half = index - mesh.triangles.len();
            halves(mesh, half / 2)[half % 2]
        }
    }
}

/// Corners of all triangles in order.
pub(crate) fn triangles(mesh: &Mesh) -> impl Iterator<Item = [u32; 3]> + '_ {
    mesh.triangles.iter().copied().chain((0..mesh.quads.len()).flat_map(|quad| halves(mesh, quad)))
}
