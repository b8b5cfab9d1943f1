//! Whether the elements of a face lie side by side in the parameter plane, and the area that they cover there.

use glam::DVec2;

use crate::base::job;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::verify::covered_area::{CoveredArea, NodePlaces};
use crate::surface::Surface;

/// Sine of an element's angle below which its normal is not determined.
const MIN_SINE: f64 = WHOLE_NUMBER;

/// The area that the elements of a face cover in the parameter plane, if they lie side by side; `None` where they fold over. Elements of grids
/// and lattices are checked by their rows. A free element that is clockwise in the parameter plane, as may be beside a pole, is checked by its
/// normal in space.
pub(crate) fn unfolded(face_mesh: &FaceMesh, mesh: &Mesh) -> Option<CoveredArea> {
    let FaceGeometry { nodes, surface, .. } = &face_mesh.geometry;
    let ascends = |side: &Vec<f64>| side.windows(2).all(|w| w[1] > w[0]);
    let mut covered = CoveredArea::default();
    match nodes {
        FaceNodes::Grid(grid, _) if grid.sides.iter().all(ascends) => {
            let (nu, nv) = grid.size();
            covered.add_quad([(0, 0), (nu, 0), (nu, nv), (0, nv)].map(|(i, j)| grid.uv(i, j).into()));
        }
        FaceNodes::Lattice(lattice, _) if lattice.sides.iter().all(ascends) => {
            let n = lattice.size();
            let [a, b, c] = [(0, 0), (n, 0), (0, n)].map(|(i, j)| lattice.uv(i, j).into());
            covered.add(a, b, c);
        }
        FaceNodes::Blocks(blocks, ids) => {
            let places = NodePlaces { uv: &blocks.uv, ids };
            job::looking(&blocks.quads).all(|q| faces_up(surface, places, mesh, q, &mut covered)).then_some(())?;
        }
        FaceNodes::Free(free, ids) => {
            let places = NodePlaces { uv: &free.uv, ids };
            let sound = job::looking(&free.triangles).all(|t| faces_up(surface, places, mesh, t, &mut covered))
                && job::looking(&free.quads).all(|q| faces_up(surface, places, mesh, q, &mut covered));
            sound.then_some(())?;
        }
        FaceNodes::Grid(..) | FaceNodes::Lattice(..) => return None,
    }
    Some(covered)
}

/// Whether an element is counter-clockwise in the parameter plane, or has its normal on the side of the surface's normal. Its area in the
/// parameter plane is added to `covered`.
fn faces_up(surface: &Surface, places: NodePlaces, mesh: &Mesh, corners: &[u32], covered: &mut CoveredArea) -> bool {
    let at = |k: usize| DVec2::from(places.uv[corners[k] as usize]);
    let [a, b] = if corners.len() == 3 {
        covered.add(at(0), at(1), at(2));
        [at(1) - at(0), at(2) - at(0)]
    } else {
        covered.add_quad([at(0), at(1), at(2), at(3)]);
        [at(2) - at(0), at(3) - at(1)]
    };
    if a.perp_dot(b) > 0.0 {
        return true;
    }
    let p = |k: usize| mesh.nodes[places.ids[corners[k] as usize] as usize];
    let [a, b] = if corners.len() == 3 { [p(1) - p(0), p(2) - p(0)] } else { [p(2) - p(0), p(3) - p(1)] };
    let up = a.cross(b);
    if up.length() <= MIN_SINE * a.length() * b.length() {
        return true;
    }
    let middle = (0..corners.len()).map(at).sum::<DVec2>() / corners.len() as f64;
    let normals = (0..corners.len()).map(at).chain([middle]).map(|at| surface.normal(at.x, at.y));
    normals.into_iter().any(|normal| up.dot(normal) >= 0.0)
}
