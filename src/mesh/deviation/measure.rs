//! The distance between mesh and surface: the largest of 25 points a triangle, climbed from (`samples.rs`).
//!
//! Triangles of which bounds of second derivatives say that they are no farther from the surface than one that was measured are left out:
//! the largest distance is the same. Grids are bounded by blocks of cells (`measure_grid.rs`), other faces triangle by triangle.

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::deviation::bend_tiles::BendTiles;
use crate::mesh::deviation::cut_off::{self, FaceTriangles};
use crate::mesh::deviation::measure_grid::{GridList, GridMeasure};
use crate::mesh::deviation::quadratic::over_sides;
use crate::mesh::deviation::samples::{Farthest, Largest, beside_pole, bounded, of_triangle};
use crate::mesh::mapped::grid::Grid;
use crate::surface::{Evaluator, Surface};

/// What steers the measurement.
struct MeasureSettings {
    /// Triangles that one thread measures at a time, and such batches until the farthest are followed.
    batch: usize,
    batches: usize,
    /// Triangles that are measured first: those with the largest bounds. Each time more as many times follow.
    first: usize,
    growth: usize,
    /// Faces of fewer triangles are measured without bounds.
    min_triangles: usize,
    /// Triangles that a tile of bounds is made for.
    triangles_a_tile: usize,
    /// Tiles along u and along v at most.
    max_tiles: usize,
}

const SETTINGS: MeasureSettings =
    MeasureSettings { batch: 1024, batches: 64, first: 64, growth: 4, min_triangles: 256, triangles_a_tile: 32, max_tiles: 64 };

/// Largest distance of a face's elements from its surface, model units; `triangles` are those of the face.
pub fn of_face(surface: &Surface, geometry: &FaceGeometry, triangles: &[[u32; 3]], nodes: &[DVec3], tolerance: &Tolerance) -> f64 {
    match &geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let of_grid = GridMeasure::new(surface, grid, frame, (triangles, nodes), tolerance);
            let is_straight = grid.straight == (true, true);
            let of_rows = if is_straight { of_grid.largest() } else { 0.0 };
            if is_straight && !cut_off::may_fold(surface, grid_range(grid)) {
                return of_rows;
            }
            let GridList { uv, ids, border, triangles } = of_grid.listed();
            let prepared = surface.quick();
            let evaluator = prepared.evaluator();
            let listed = ListedTriangles { evaluator, uv: &uv, ids: &ids, border, nodes, halves: &triangles, tolerance };
            listed.with_cut_off(if is_straight { of_rows } else { listed.largest() })
        }
        listed if surface.is_flat() => from_plane(surface, &listed.listed_ids(), nodes, tolerance),
        listed => {
            let mut halves: Vec<[usize; 3]> = Vec::new();
            listed.each_listed_cell(|c| {
                halves.push([c[0], c[1], c[2]]);
                if let [a, _, b, d] = *c {
                    halves.push([a, b, d]);
                }
            });
            let (uv, ids) = (listed.listed_uv(), listed.listed_ids());
            let prepared = surface.quick();
            let evaluator = prepared.evaluator();
            let border = if let FaceNodes::Free(free, _) = listed { free.border } else { uv.len() };
            let listed = ListedTriangles { evaluator, uv: &uv, ids: &ids, border, nodes, halves: &halves, tolerance };
            listed.with_cut_off(listed.largest())
        }
    }
}

/// The range of (u, v) of a grid.
fn grid_range(grid: &Grid) -> (DVec2, DVec2) {
    let (nu, nv) = grid.size();
    let corners = [(0, 0), (nu, 0), (0, nv), (nu, nv)].map(|(i, j)| DVec2::from(grid.uv(i, j)));
    corners.into_iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)))
}

/// Elements on a plane are as far from it as their farthest node.
fn from_plane(surface: &Surface, ids: &[u32], nodes: &[DVec3], tolerance: &Tolerance) -> f64 {
    const ANYWHERE: (f64, f64) = (0.5, 0.5);
    let jet = surface.jet(ANYWHERE.0, ANYWHERE.1);
    let normal = jet.du.cross(jet.dv).normalize_or_zero();
    let farthest = ids.iter().map(|n| (nodes[*n as usize] - jet.p).dot(normal).abs()).fold(0.0, f64::max);
    if farthest > tolerance.rounding { farthest } else { 0.0 }
}

/// Triangles (of quads their halves) with the places of their corners.
struct ListedTriangles<'a> {
    evaluator: Evaluator<'a>,
    /// (u, v) and numbers in the mesh of the nodes of the list.
    uv: &'a [(f64, f64)],
    ids: &'a [u32],
    /// Those from here on lie on the surface at their (u, v).
    border: usize,
    nodes: &'a [DVec3],
    /// Corners by their places in the list.
    halves: &'a [[usize; 3]],
    tolerance: &'a Tolerance,
}

impl ListedTriangles<'_> {
    /// The larger of a distance that was measured from the triangles and of that of folds which they cut off.
    fn with_cut_off(&self, measured: f64) -> f64 {
        let range = self.uv.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), at| (l.min((*at).into()), h.max((*at).into())));
        if !cut_off::may_fold(self.evaluator.surface(), range) {
            return measured;
        }
        let triangles = FaceTriangles { uv: self.uv, ids: self.ids, halves: self.halves, nodes: self.nodes };
        triangles.largest_cut_off(self.evaluator, measured.max(self.tolerance.rounding)).unwrap_or(measured)
    }

    fn largest(&self) -> f64 {
        let count = self.halves.len();
        if count < SETTINGS.min_triangles {
            let mut largest = Largest::new();
            self.measure(&(0..count as u32).collect::<Vec<_>>(), &mut largest);
            return largest.climbed(self.evaluator);
        }
        let bounds = self.bounds();
        let mut order: Vec<u32> = (0..count as u32).collect();
        let larger = |a: &u32, b: &u32| bounds[*b as usize].total_cmp(&bounds[*a as usize]).then(a.cmp(b));
        let (mut most, mut take) = (Largest::new(), SETTINGS.first);
        while !order.is_empty() {
            if take < order.len() {
                order.select_nth_unstable_by(take, larger);
            }
            let rest = order.split_off(take.min(order.len()));
            order.sort_unstable();
            self.measure(&order, &mut most);
            order = rest;
            order.retain(|k| bounds[*k as usize] > most.distance);
            take *= SETTINGS.growth;
        }
        most.climbed(self.evaluator)
    }

    /// How far each triangle may be from the surface, model units; infinite where nothing is known.
    fn bounds(&self) -> Vec<f64> {
        let (low, high) = self.uv.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), at| {
            let at = DVec2::from(*at);
            (low.min(at), high.max(at))
        });
        let wanted = (self.halves.len() as f64 / SETTINGS.triangles_a_tile as f64).sqrt().ceil() as usize;
        let tiles = BendTiles::new(self.evaluator.surface(), (low, high), wanted.min(SETTINGS.max_tiles));
        let off: Vec<f64> = par::map(self.border, |n| {
            let (u, v) = self.uv[n];
            self.evaluator.point(u, v).distance(self.nodes[self.ids[n] as usize])
        });
        let off_surface = |half: &[usize; 3]| half.iter().filter_map(|n| off.get(*n)).fold(0.0_f64, |most, off| most.max(*off));
        let of_half = |half: &[usize; 3]| {
            let uv = beside_pole(self.evaluator, half.map(|n| self.uv[n])).map(DVec2::from);
            let p = half.map(|n| self.nodes[self.ids[n] as usize]);
            let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
            let box_of = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
            if normal == DVec3::ZERO {
                return f64::INFINITY;
            }
            tiles.bends(box_of, normal).map_or(f64::INFINITY, |bends| over_sides(&bends, uv, box_of.1 - box_of.0) + off_surface(half))
        };
        let batches = par::map(self.halves.len().div_ceil(SETTINGS.batch), |batch| {
            self.halves[batch * SETTINGS.batch..].iter().take(SETTINGS.batch).map(of_half).collect::<Vec<_>>()
        });
        batches.into_iter().flatten().collect()
    }

    /// Takes some triangles into the largest distance.
    fn measure(&self, triangles: &[u32], largest: &mut Largest) {
        let point = |(u, v)| self.evaluator.point(u, v);
        let of_half = |k: &u32| {
            let half = self.halves[*k as usize];
            let at = beside_pole(self.evaluator, half.map(|n| self.uv[n]));
            bounded(self.evaluator, of_triangle(&point, at, half.map(|n| self.nodes[self.ids[n] as usize])))
        };
        for lot in triangles.chunks(SETTINGS.batch * SETTINGS.batches) {
            let batches: Vec<Vec<Farthest>> = par::map(lot.len().div_ceil(SETTINGS.batch), |batch| {
                lot[batch * SETTINGS.batch..].iter().take(SETTINGS.batch).map(of_half).collect()
            });
            largest.follow(self.evaluator, batches.into_iter().flatten().collect(), self.tolerance);
        }
    }
}
