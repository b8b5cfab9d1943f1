//! Whether a mapped face keeps a chord error everywhere, by bounds and not by samples. `docs/notes/bounds.md` has the formulas.
//!
//! A triangle's points are no farther from the surface than its corners are, plus what the surface is off the flat triangle
//! between the feet of the corners. The latter follows from ranges of second derivatives and falls by four with each
//! halving; a triangle whose bound is not enough is bounded by parts, whose corners have feet of their own.

use glam::DVec3;

use crate::base::par;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::deviation::flat_triangle::{FlatCorner, Region, widened};
use crate::mesh::deviation::proof::{CERTIFY_SETTINGS, Proof};
use crate::mesh::mapped::grid::{Grid, GridIds, triangle_rows};
use crate::surface::{Domain, Strip, Surface};

/// Whether all elements of a mapped face (a quad as its two triangles) keep a distance from its surface, model units;
/// `triangles` are those of the face.
pub fn of_face(surface: &Surface, limit: f64, geometry: &FaceGeometry, triangles: &[[u32; 3]], nodes: &[DVec3]) -> Proof {
    let prepared = surface.quick();
    let surface = if prepared.evaluator().has_ranges() { prepared.evaluator() } else { surface.evaluator() };
    match &geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let region = Region { surface, u: grid.u, v: grid.v, slanted: false, limit };
            let columns = Columns::new(&region, grid);
            let starts = triangle_rows(frame, !triangles.is_empty());
            let rows = par::map(grid.size().1, |j| {
                let of_row = if starts.is_empty() { &[][..] } else { triangles.get(starts[j]..starts[j + 1]).unwrap_or(&[]) };
                CertifyRow { region: &region, grid, frame, nodes }.proof(j, of_row, columns.as_ref())
            });
            rows.into_iter().fold(Proof::Kept, Proof::and)
        }
        FaceNodes::Free(..) => Proof::Kept,
        listed => {
            let region = Region { surface, u: (0.0, 1.0), v: (0.0, 1.0), slanted: surface.surface().domain() == Domain::Triangle, limit };
            let (uv, ids) = (listed.listed_uv(), listed.listed_ids());
            let mut halves = Vec::new();
            listed.each_listed_cell(|corners| {
                let own: &[[usize; 3]] = if corners.len() == 4 { &[[0, 1, 2], [0, 2, 3]] } else { &[[0, 1, 2]] };
                halves.extend(own.iter().map(|half| half.map(|k| corners[k])));
            });
            let proofs = par::map(halves.len(), |k| {
                let corner = |n: usize| region.corner(nodes[ids[n] as usize], uv[n], None);
                region.certify(halves[k].map(corner), None)
            });
            proofs.into_iter().fold(Proof::Kept, Proof::and)
        }
    }
}

/// What depends on u alone, for each column of a straight grid.
struct Columns(Vec<Strip>);

impl Columns {
    fn new(region: &Region, grid: &Grid) -> Option<Self> {
        let one = |i: usize| {
            let (low, high) = widened(grid.uv(i, 0).0, grid.uv(i + 1, 0).0, region.u);
            region.surface.surface().strip_u(low, high)
        };
        (grid.straight == (true, true) && !region.surface.has_ranges()).then(|| Self(par::map(grid.size().0, one)))
    }
}

/// One row of cells of a grid.
struct CertifyRow<'a> {
    region: &'a Region<'a>,
    grid: &'a Grid,
    frame: &'a GridIds,
    nodes: &'a [DVec3],
}

impl CertifyRow<'_> {
    fn proof(&self, j: usize, triangles: &[[u32; 3]], columns: Option<&Columns>) -> Proof {
        let grid = self.grid;
        let strip = columns.map(|_| {
            let (low, high) = widened(grid.uv(0, j).1, grid.uv(0, j + 1).1, self.region.v);
            self.region.surface.surface().strip_v(low, high)
        });
        let (mut whole, mut open, mut next) = (Proof::Kept, 0, triangles.iter());
        for i in 0..grid.size().0 {
            let at = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let ids = at.map(|(i, j)| self.frame.node(i, j));
            let pole = (0..4).find(|k| ids[*k] == ids[(k + 1) % 4]);
            // A triangle of the mesh that holds both b and d shows that the other diagonal is used.
            let other = match (next.next(), pole) {
                (Some(t), None) => {
                    next.next();
                    t.contains(&ids[3]) && t.contains(&ids[1])
                }
                _ => false,
            };
            let halves: &[[usize; 3]] = match pole {
                Some(0) => &[[0, 2, 3]],
                Some(1) => &[[0, 1, 3]],
                Some(_) => &[[0, 1, 2]],
                None if other => &[[0, 1, 3], [1, 2, 3]],
                None => &[[0, 1, 2], [0, 2, 3]],
            };
            let known = columns.zip(strip.as_ref()).map(|(columns, strip)| self.region.surface.surface().spread_of(&columns.0[i], strip));
            // Along a pole any u (or v) is right.
            let free = |k: usize| pole.filter(|p| k == *p || k == (*p + 1) % 4).map(|p| p % 2);
            for half in halves {
                let corner = |k: usize| {
                    let (p, uv) = (self.nodes[ids[k] as usize], grid.uv(at[k].0, at[k].1));
                    // What is made from the geometry lies on the surface; border nodes are those of glued edges.
                    if ids[k] >= self.frame.first { FlatCorner::on(p, uv) } else { self.region.corner(p, uv, free(k)) }
                };
                let proof = self.region.certify(half.map(corner), known.as_ref());
                whole = whole.and(proof);
                open += usize::from(proof != Proof::Kept);
            }
            if open >= CERTIFY_SETTINGS.max_open_triangles {
                break;
            }
        }
        whole
    }
}
