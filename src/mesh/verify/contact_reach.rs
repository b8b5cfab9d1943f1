//! How far a face may be from its elements: as second derivatives of the surface allow, and never more than a share of their edges.

use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::data::mesh::Mesh;
use crate::surface::Domain;

/// Largest distance of a curved face from its element, as a share of the element's longest edge: more than usual sizes leave.
pub const BULGE: f64 = 0.2;

/// A face that is known by its second derivatives.
pub(crate) struct FaceBulge<'a> {
    nodes: &'a FaceNodes,
    /// Bounds of |∂²/∂u²|, |∂²/∂u∂v| and |∂²/∂v²| over the face, model units.
    second: [f64; 3],
    /// Largest extent in (u, v) of a cell; of a free face each triangle has its own.
    cell: (f64, f64),
    /// Borders bend in (u, v): beside them the face goes beyond its elements.
    trimmed: bool,
}

impl<'a> FaceBulge<'a> {
    /// A face of a mesh by its number; `None` where its surface is not known, or has no bounds.
    pub(crate) fn new(mesh: &'a Mesh, face: usize) -> Option<Self> {
        let FaceGeometry { surface, nodes, .. } = mesh.geometries.0.get(face)?;
        let mut range = ((f64::INFINITY, f64::NEG_INFINITY), (f64::INFINITY, f64::NEG_INFINITY));
        let mut cell = (0.0_f64, 0.0_f64);
        let mut reach = |(u, v): (f64, f64)| {
            range.0 = (range.0.0.min(u), range.0.1.max(u));
            range.1 = (range.1.0.min(v), range.1.1.max(v));
        };
        match nodes {
            FaceNodes::Grid(grid, _) => {
                let (nu, nv) = grid.size();
                reach(grid.uv(0, 0));
                reach(grid.uv(nu, nv));
                // Lines of the grid are straight from side to side.
                let apart = |a: [f64; 4]| a.into_iter().fold(f64::MIN, f64::max) - a.into_iter().fold(f64::MAX, f64::min);
                let column = |i: usize| apart([(i, 0), (i + 1, 0), (i, nv), (i + 1, nv)].map(|(i, j)| grid.uv(i, j).0));
                let row = |j: usize| apart([(0, j), (0, j + 1), (nu, j), (nu, j + 1)].map(|(i, j)| grid.uv(i, j).1));
                cell = ((0..nu).map(column).fold(0.0, f64::max), (0..nv).map(row).fold(0.0, f64::max));
            }
            FaceNodes::Free(free, _) => free.uv.iter().for_each(|uv| reach(*uv)),
            FaceNodes::Lattice(..) | FaceNodes::Blocks(..) => {
                let uv = nodes.listed_uv();
                uv.iter().for_each(|uv| reach(*uv));
                nodes.each_listed_cell(|corners| {
                    let own = extent(corners.iter().map(|n| uv[*n]));
                    cell = (cell.0.max(own.0), cell.1.max(own.1));
                });
            }
        }
        // Over a seam a surface repeats itself.
        let held = |(low, high): (f64, f64)| if low < 0.0 || high > 1.0 { (0.0, 1.0) } else { (low, high) };
        let second = surface.second_derivative_bound(held(range.0), held(range.1));
        let trimmed = surface.domain() == Domain::Loop;
        second.iter().all(|bound| bound.is_finite()).then_some(Self { nodes, second, cell, trimmed })
    }

    /// How far the face may be from its `k`-th triangle, those of quads after its own, model units: by Taylor's formula about any place of it
    /// what the surface is off the linear interpolation between its corners.
    pub(crate) fn of(&self, k: usize) -> f64 {
        let (u, v) = match self.nodes {
            FaceNodes::Free(free, _) => {
                let own = free.triangles.get(k).map(|t| t.as_slice());
                let corners = own.or_else(|| free.quads.get((k - free.triangles.len()) / 2).map(|q| q.as_slice())).unwrap_or(&[]);
                if corners.is_empty() || self.trimmed && corners.iter().any(|n| (*n as usize) < free.border) {
                    return f64::INFINITY;
                }
                extent(corners.iter().map(|n| free.uv[*n as usize]))
            }
            _ => self.cell,
        };
        let [uu, uv, vv] = self.second;
        (uu * u * u + 2.0 * uv * u * v + vv * v * v) / 8.0
    }
}

/// Width and height of the box of some places.
fn extent(places: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let empty = ((f64::INFINITY, f64::NEG_INFINITY), (f64::INFINITY, f64::NEG_INFINITY));
    let all = places.fold(empty, |(u, v), at| ((u.0.min(at.0), u.1.max(at.0)), (v.0.min(at.1), v.1.max(at.1))));
    (all.0.1 - all.0.0, all.1.1 - all.1.0)
}

/// How far a curve may be from the line between two of its points, model units: it lies in the ellipse about them whose points are
/// together as far from both as it is long, and no further than a share of their distance.
pub(crate) fn bend_of_step(length: f64, chord: f64) -> f64 {
    let (sum, less) = (length + chord, (length - chord).max(0.0));
    (0.5 * (sum * less).sqrt()).min(BULGE * chord)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;

    #[test]
    fn a_step_of_a_circle_bends_within_its_bound_and_hardly_less() {
        for turn in [0.02_f64, 0.1, 0.5] {
            let (chord, sagitta) = (2.0 * math::sin(0.5 * turn), 1.0 - math::cos(0.5 * turn));
            let bound = bend_of_step(turn, chord);
            assert!(sagitta <= bound && bound <= 1.2 * sagitta, "{turn}: {sagitta} {bound}");
        }
        assert!(bend_of_step(1.0, 1.0) == 0.0 && bend_of_step(9.0, 1.0) == BULGE);
    }
}
