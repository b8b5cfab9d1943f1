//! The distance between mesh and surface, measured at 25 points a triangle.
//!
//! The points are those of a triangle divided in six along each side, corners left out. Each has a place on the surface by
//! linear interpolation of (u, v). What is off along the normal there is nearly the distance; only points that could be
//! the farthest are followed to their foot.

use glam::DVec3;

use super::chart::{Chart, Grid, Shape};
use super::faces::Frame;
use super::foot;
use super::trilateral::{LatticeFrame, lattice_points};
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::surface::Surface;

/// Divisions of a triangle's side.
const SIX: usize = 6;
/// How much farther than the farthest a point must seem to be followed.
const WORTH: f64 = 1.000_5;

/// Largest distance of a face's elements from its surface, model units; `triangles` are those of the face.
pub fn of_face(surface: &Surface, chart: &Chart, triangles: &[[u32; 3]], nodes: &[DVec3], tolerance: &Tolerance) -> f64 {
    match (&chart.shape, &chart.frame) {
        (Shape::Grid(grid), Frame::Grid(frame)) => {
            let (nu, nv) = grid.size();
            let starts = triangle_rows(frame, !triangles.is_empty());
            let rows = par::map(nv, |j| {
                let cells = GridRow { surface, grid, frame, nodes, tolerance };
                let of_row = if starts.is_empty() { &[][..] } else { triangles.get(starts[j]..starts[j + 1]).unwrap_or(&[]) };
                cells.measure(j, nu, of_row)
            });
            rows.into_iter().fold(0.0, f64::max)
        }
        (shape, frame) => {
            let uv = match shape {
                Shape::Lattice(lattice) => lattice_points(lattice),
                Shape::Blocks(blocks) => blocks.uv.clone(),
                Shape::Grid(_) => Vec::new(),
            };
            let ids = ids(shape, frame);
            let mut best = 0.0;
            each_cell(shape, |corners| {
                let halves: &[[usize; 3]] = if corners.len() == 4 { &[[0, 1, 2], [0, 2, 3]] } else { &[[0, 1, 2]] };
                for half in halves {
                    let c = half.map(|k| corners[k]);
                    let (places, points) = (c.map(|n| uv[n]), c.map(|n| nodes[ids[n] as usize]));
                    best = measure_triangle(surface, places, points, best, tolerance);
                }
            });
            best
        }
    }
}

/// Cells of a lattice or of blocks by places in their lists of (u, v).
pub fn each_cell(shape: &Shape, mut visit: impl FnMut(&[usize])) {
    match shape {
        Shape::Lattice(lattice) => {
            LatticeFrame::triangles(lattice.size()).for_each(|t| visit(&t.map(|(i, j)| lattice.index(i, j))));
        }
        Shape::Blocks(blocks) => blocks.quads.iter().for_each(|q| visit(&q.map(|n| n as usize))),
        Shape::Grid(_) => {}
    }
}

/// Global ids by place in the list of (u, v).
pub fn ids(shape: &Shape, frame: &Frame) -> Vec<u32> {
    match (shape, frame) {
        (Shape::Lattice(lattice), Frame::Lattice(frame)) => {
            let n = lattice.size();
            (0..=n).flat_map(|j| (0..=n - j).map(move |i| (i, j))).map(|(i, j)| frame.node(i, j)).collect()
        }
        (_, Frame::Blocks(places)) => places.clone(),
        _ => Vec::new(),
    }
}

/// First triangle of each row of cells of a grid meshed with triangles; empty for quads.
fn triangle_rows(frame: &super::mapped::Frame, triangles: bool) -> Vec<usize> {
    let (nu, nv) = frame.size();
    if !triangles {
        return Vec::new();
    }
    let mut starts = vec![0];
    for j in 0..nv {
        let pole_row = frame.poles[0] && j == 0 || frame.poles[2] && j + 1 == nv;
        let at_flanks = usize::from(frame.poles[1]) + usize::from(frame.poles[3]);
        starts.push(starts[j] + if pole_row { nu } else { 2 * nu - at_flanks });
    }
    starts
}

/// One row of cells of a grid.
struct GridRow<'a> {
    surface: &'a Surface,
    grid: &'a Grid,
    frame: &'a super::mapped::Frame,
    nodes: &'a [DVec3],
    tolerance: &'a Tolerance,
}

impl GridRow<'_> {
    fn measure(&self, j: usize, nu: usize, triangles: &[[u32; 3]]) -> f64 {
        let mut best = 0.0;
        let fine = self.fine_points(j, nu);
        let mut next = triangles.iter();
        for i in 0..nu {
            let places = [self.grid.uv(i, j), self.grid.uv(i + 1, j), self.grid.uv(i + 1, j + 1), self.grid.uv(i, j + 1)];
            let ids = [self.frame.node(i, j), self.frame.node(i + 1, j), self.frame.node(i + 1, j + 1), self.frame.node(i, j + 1)];
            let points = ids.map(|n| self.nodes[n as usize]);
            let degenerate = (0..4).find(|k| ids[*k] == ids[(k + 1) % 4]);
            // A triangle of the mesh that holds both b and d tells that the other diagonal was taken.
            let other = match (next.next(), degenerate) {
                (Some(t), None) => {
                    next.next();
                    t.contains(&ids[3]) && t.contains(&ids[1])
                }
                _ => false,
            };
            let halves: &[[usize; 3]] = match degenerate {
                Some(0) => &[[0, 2, 3]],
                Some(1) => &[[0, 1, 3]],
                Some(_) => &[[0, 1, 2]],
                None if other => &[[0, 1, 3], [1, 2, 3]],
                None => &[[0, 1, 2], [0, 2, 3]],
            };
            for half in halves {
                let cell = Cell { places, points, half: *half };
                best = match &fine {
                    Some(fine) if degenerate.is_none() => self.measure_fine(&cell, fine, i, nu, best),
                    _ => measure_triangle(self.surface, half.map(|k| places[k]), half.map(|k| points[k]), best, self.tolerance),
                };
            }
        }
        best
    }

    /// Surface points at sixths of the cells of a row, when they form a tensor grid.
    fn fine_points(&self, j: usize, nu: usize) -> Option<Vec<DVec3>> {
        if self.grid.straight != (true, true) {
            return None;
        }
        let sixth = |a: f64, b: f64, k: usize| a + (b - a) * k as f64 / SIX as f64;
        let us: Vec<f64> = (0..=nu * SIX)
            .map(|k| {
                if k == nu * SIX {
                    self.grid.uv(nu, 0).0
                } else {
                    sixth(self.grid.uv(k / SIX, 0).0, self.grid.uv(k / SIX + 1, 0).0, k % SIX)
                }
            })
            .collect();
        let (low, high) = (self.grid.uv(0, j).1, self.grid.uv(0, j + 1).1);
        let vs: Vec<f64> = (0..=SIX).map(|k| sixth(low, high, k)).collect();
        let mut points = vec![DVec3::ZERO; us.len() * vs.len()];
        self.surface.grid(&us, &vs, &mut points);
        Some(points)
    }

    fn measure_fine(&self, cell: &Cell, fine: &[DVec3], i: usize, nu: usize, mut best: f64) -> f64 {
        let width = nu * SIX + 1;
        // Corners of the cell in sixths.
        let corner = [(0, 0), (SIX, 0), (SIX, SIX), (0, SIX)];
        let [a, b, c] = cell.half.map(|k| corner[k]);
        let [pa, pb, pc] = cell.half.map(|k| cell.points[k]);
        let normal = (pb - pa).cross(pc - pa).normalize_or_zero();
        for (wa, wb, wc) in weights() {
            let x = (a.0 * wa + b.0 * wb + c.0 * wc) / SIX;
            let y = (a.1 * wa + b.1 * wb + c.1 * wc) / SIX;
            let p = (pa * wa as f64 + pb * wb as f64 + pc * wc as f64) / SIX as f64;
            let there = fine[y * width + i * SIX + x];
            let seems = if normal == DVec3::ZERO { p.distance(there) } else { (p - there).dot(normal).abs() };
            if seems > best * WORTH && seems > self.tolerance.rounding {
                let (s, t) = (x as f64 / SIX as f64, y as f64 / SIX as f64);
                let at = |f: &dyn Fn((f64, f64)) -> f64| {
                    let [q0, q1, _, q3] = cell.places;
                    f(q0) + (f(q1) - f(q0)) * s + (f(q3) - f(q0)) * t
                };
                best = f64::max(best, foot_distance(self.surface, p, (at(&|q| q.0), at(&|q| q.1))));
            }
        }
        best
    }
}

struct Cell {
    places: [(f64, f64); 4],
    points: [DVec3; 4],
    half: [usize; 3],
}

/// The 25 points as weights in sixths.
fn weights() -> impl Iterator<Item = (usize, usize, usize)> {
    (0..=SIX).flat_map(|b| (0..=SIX - b).map(move |c| (SIX - b - c, b, c))).filter(|(a, b, c)| *a != SIX && *b != SIX && *c != SIX)
}

fn foot_distance(surface: &Surface, p: DVec3, guess: (f64, f64)) -> f64 {
    foot::nearest(surface, p, guess, (0.0, 1.0), (0.0, 1.0)).0
}

/// The farthest of the 25 points of a triangle, or `best` when that is farther.
fn measure_triangle(surface: &Surface, uv: [(f64, f64); 3], points: [DVec3; 3], mut best: f64, tolerance: &Tolerance) -> f64 {
    let normal = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero();
    for (a, b, c) in weights() {
        let w = [a, b, c].map(|n| n as f64 / SIX as f64);
        let at = (uv[0].0 * w[0] + uv[1].0 * w[1] + uv[2].0 * w[2], uv[0].1 * w[0] + uv[1].1 * w[1] + uv[2].1 * w[2]);
        let p = points[0] * w[0] + points[1] * w[1] + points[2] * w[2];
        let there = surface.point(at.0, at.1);
        let seems = if normal == DVec3::ZERO { p.distance(there) } else { (p - there).dot(normal).abs() };
        if seems > best * WORTH && seems > tolerance.rounding {
            best = f64::max(best, foot_distance(surface, p, at));
        }
    }
    best
}
