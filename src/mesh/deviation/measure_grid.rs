//! The largest distance of a grid from its surface: blocks of cells in the order of their bounds.
//!
//! The bound of a block is that of the largest half of a cell in it, by second derivatives over the block along its normal and by how far
//! the normals of its elements may lean from there. A block whose bound is not more than a distance that was measured is left out;
//! others are halved down to a few cells, which are measured at 25 points a triangle.

use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::base::range::Interval3;
use crate::base::tolerance::Tolerance;
use crate::mesh::deviation::bend_tiles::along_normal;
use crate::mesh::deviation::quadratic::over_sides;
use crate::mesh::deviation::samples::{Farthest, Largest, SIX, beside_pole, middle, of_triangle, off, peak, weighted, weights};
use crate::mesh::mapped::grid::{Grid, GridIds, triangle_rows};
use crate::surface::Surface;
use crate::surface::core::power_form::Bends;

/// What steers the measurement of grids.
struct GridMeasureSettings {
    /// Cells of a block along each direction that are measured without being halved.
    leaf: usize,
    /// Blocks that are bounded or measured at a time.
    at_once: usize,
    /// Largest share of the length of a normal by which it may vary inside a block: beyond, bends in all directions count.
    max_normal_share: f64,
    /// Over the sine of the angle that such a normal leans by, at most, how far its unit vector moves.
    lean: f64,
}

const SETTINGS: GridMeasureSettings = GridMeasureSettings { leaf: 8, at_once: 32, max_normal_share: 0.5, lean: 1.04 };

/// A grid with all that its measurement follows from.
pub(super) struct GridMeasure<'a> {
    surface: &'a Surface,
    grid: &'a Grid,
    frame: &'a GridIds,
    triangles: &'a [[u32; 3]],
    nodes: &'a [DVec3],
    tolerance: &'a Tolerance,
    /// First triangle of each row; empty for quads.
    starts: Vec<usize>,
}

/// A grid as a list of nodes, row by row.
pub(super) struct GridList {
    /// (u, v) and numbers in the mesh of the nodes.
    pub uv: Vec<(f64, f64)>,
    pub ids: Vec<u32>,
    /// How many of them may be off the surface.
    pub border: usize,
    /// Corners by their places in the list.
    pub triangles: Vec<[usize; 3]>,
}

/// Cells from the first corner to before the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct CellBlock {
    i: (usize, usize),
    j: (usize, usize),
}

impl CellBlock {
    fn is_leaf(self) -> bool {
        self.i.1 - self.i.0 <= SETTINGS.leaf && self.j.1 - self.j.0 <= SETTINGS.leaf
    }

    fn halves(self) -> [Self; 2] {
        let middle = |(a, b): (usize, usize)| a.midpoint(b);
        if self.i.1 - self.i.0 >= self.j.1 - self.j.0 {
            let m = middle(self.i);
            [Self { i: (self.i.0, m), ..self }, Self { i: (m, self.i.1), ..self }]
        } else {
            let m = middle(self.j);
            [Self { j: (self.j.0, m), ..self }, Self { j: (m, self.j.1), ..self }]
        }
    }
}

/// A block in the queue, largest bound first; among equal bounds the order of the blocks decides.
#[derive(Clone, Copy, Debug)]
struct BoundedBlock(f64, CellBlock);

impl Ord for BoundedBlock {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

impl PartialOrd for BoundedBlock {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for BoundedBlock {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for BoundedBlock {}

/// What became of a block.
enum Examined {
    Measured(Vec<Farthest>),
    Halved([BoundedBlock; 2]),
}

impl<'a> GridMeasure<'a> {
    pub fn new(
        surface: &'a Surface,
        grid: &'a Grid,
        frame: &'a GridIds,
        (triangles, nodes): (&'a [[u32; 3]], &'a [DVec3]),
        tolerance: &'a Tolerance,
    ) -> Self {
        Self { surface, grid, frame, triangles, nodes, tolerance, starts: triangle_rows(frame, !triangles.is_empty()) }
    }

    /// The largest distance of a grid whose rows and columns are straight in (u, v), model units.
    pub fn largest(&self) -> f64 {
        let (nu, nv) = self.grid.size();
        // Nodes of the border need not lie on the surface.
        let (inner_u, inner_v) = ((1, nu - 1), (1, nv - 1));
        let mut rim = vec![CellBlock { i: (0, nu), j: (0, 1) }, CellBlock { i: (0, nu), j: (nv.max(2) - 1, nv) }];
        if nv > 2 {
            rim.extend([CellBlock { i: (0, 1), j: inner_v }, CellBlock { i: (nu.max(2) - 1, nu), j: inner_v }]);
        }
        rim.dedup();
        let measured = par::map(rim.len(), |k| self.measured(rim[k]));
        let mut most = Largest::new();
        most.follow(self.surface.evaluator(), measured.into_iter().flatten().collect(), self.tolerance);
        let mut queue = BinaryHeap::new();
        if nu > 2 && nv > 2 {
            queue.push(BoundedBlock(f64::INFINITY, CellBlock { i: inner_u, j: inner_v }));
        }
        while queue.peek().is_some_and(|block| block.0 > most.distance) {
            let lot: Vec<CellBlock> =
                std::iter::from_fn(|| queue.pop()).take(SETTINGS.at_once).filter(|b| b.0 > most.distance).map(|b| b.1).collect();
            for examined in par::map(lot.len(), |k| self.examined(lot[k])) {
                match examined {
                    Examined::Measured(farthest) => most.follow(self.surface.evaluator(), farthest, self.tolerance),
                    Examined::Halved(halves) => queue.extend(halves),
                }
            }
        }
        most.climbed(self.surface.evaluator())
    }

    fn examined(&self, block: CellBlock) -> Examined {
        if block.is_leaf() {
            return Examined::Measured(self.measured(block));
        }
        Examined::Halved(block.halves().map(|half| BoundedBlock(self.bound(half), half)))
    }

    /// The most that a half of a cell of a block, whose nodes lie on the surface, may be off.
    fn bound(&self, CellBlock { i, j }: CellBlock) -> f64 {
        let us = |k: usize| self.grid.uv(k, j.0).0;
        let vs = |k: usize| self.grid.uv(i.0, k).1;
        let widths = |(first, last): (usize, usize), at: &dyn Fn(usize) -> f64| {
            (first..last).map(|k| at(k + 1) - at(k)).fold((f64::INFINITY, 0.0_f64), |(low, high), w| (low.min(w), high.max(w)))
        };
        let (across, along) = (widths(i, &us), widths(j, &vs));
        let around = self.surface.enclosure((us(i.0), us(i.1)), (vs(j.0), vs(j.1)));
        let second = [around.duu, around.duv, around.dvv];
        if second.iter().any(Interval3::is_unbounded) {
            return f64::INFINITY;
        }
        let reach = second.map(|r| r.reach());
        let in_any = over_halves(&Bends { mid: [0.0; 3], slack: reach, jump: 0.0 }, across, along);
        let normals = around.du.cross(&around.dv);
        let (center, radius) = (0.5 * (normals.low + normals.high), 0.5 * (normals.high - normals.low).length());
        let share = radius / center.length();
        if share.is_nan() || share > SETTINGS.max_normal_share {
            return in_any;
        }
        let mut bends = along_normal(&second, center.normalize_or_zero());
        (0..3).for_each(|k| bends.slack[k] += SETTINGS.lean * share * reach[k]);
        over_halves(&bends, across, along).min(in_any)
    }

    /// The points of the halves of the cells of a block that seem farthest from the surface.
    fn measured(&self, block: CellBlock) -> Vec<Farthest> {
        let fine = self.fine_points(block);
        let width = (block.i.1 - block.i.0) * SIX + 1;
        let mut farthest = Vec::with_capacity(2 * (block.i.1 - block.i.0) * (block.j.1 - block.j.0));
        for j in block.j.0..block.j.1 {
            for i in block.i.0..block.i.1 {
                let cell = self.cell(i, j);
                let degenerate = cell.pole().is_some();
                let corner = (j - block.j.0) * SIX * width + (i - block.i.0) * SIX;
                for half in self.halves(i, j, &cell) {
                    farthest.push(if degenerate {
                        let at = beside_pole(self.surface.evaluator(), half.map(|k| cell.places[k]));
                        of_triangle(&|(u, v)| self.surface.point(u, v), at, half.map(|k| self.nodes[cell.ids[k] as usize]))
                    } else {
                        cell.farthest(*half, self.nodes, &fine[corner..], width)
                    });
                }
            }
        }
        farthest
    }

    fn cell(&self, i: usize, j: usize) -> GridCorners {
        let at = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        GridCorners { places: at.map(|(i, j)| self.grid.uv(i, j)), ids: at.map(|(i, j)| self.frame.node(i, j)) }
    }

    /// Corners of the triangles of a cell, or of the halves of its quad.
    fn halves(&self, i: usize, j: usize, cell: &GridCorners) -> &'static [[usize; 3]] {
        match cell.pole() {
            Some(0) => &[[0, 2, 3]],
            Some(1) => &[[0, 1, 3]],
            Some(_) => &[[0, 1, 2]],
            None => {
                // A triangle of the mesh that holds both b and d shows that the other diagonal is used.
                let row = self.starts.get(j).map(|start| start + 2 * i - usize::from(i > 0 && self.frame.poles[3]));
                let first = row.and_then(|place| self.triangles.get(place));
                if first.is_some_and(|t| t.contains(&cell.ids[3]) && t.contains(&cell.ids[1])) {
                    &[[0, 1, 3], [1, 2, 3]]
                } else {
                    &[[0, 1, 2], [0, 2, 3]]
                }
            }
        }
    }

    /// Surface points at sixths of the cells of a block, row by row.
    fn fine_points(&self, CellBlock { i, j }: CellBlock) -> Vec<DVec3> {
        let sixths = |(first, last): (usize, usize), at: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let inner = (first..last).flat_map(|k| {
                let (low, high) = (at(k), at(k + 1));
                (0..SIX).map(move |s| low + (high - low) * s as f64 / SIX as f64)
            });
            inner.chain([at(last)]).collect()
        };
        let us = sixths(i, &|k| self.grid.uv(k, j.0).0);
        let vs = sixths(j, &|k| self.grid.uv(i.0, k).1);
        let mut points = vec![DVec3::ZERO; us.len() * vs.len()];
        self.surface.grid(&us, &vs, &mut points);
        points
    }

    /// Its nodes, all of which may be off the surface, and triangles.
    pub fn listed(&self) -> GridList {
        let (nu, nv) = self.grid.size();
        let all = || (0..=nv).flat_map(|j| (0..=nu).map(move |i| (i, j)));
        let uv: Vec<(f64, f64)> = all().map(|(i, j)| self.grid.uv(i, j)).collect();
        let ids: Vec<u32> = all().map(|(i, j)| self.frame.node(i, j)).collect();
        let mut triangles = Vec::with_capacity(2 * nu * nv);
        for (i, j) in (0..nv).flat_map(|j| (0..nu).map(move |i| (i, j))) {
            let first = j * (nu + 1) + i;
            let corners = [first, first + 1, first + nu + 2, first + nu + 1];
            triangles.extend(self.halves(i, j, &self.cell(i, j)).iter().map(|half| half.map(|k| corners[k])));
        }
        let count = uv.len();
        GridList { uv, ids, border: count, triangles }
    }
}

/// A bound of both halves of a cell whose width along u, and along v, is between two values.
fn over_halves(bends: &Bends, across: (f64, f64), along: (f64, f64)) -> f64 {
    let least = [across.0 * across.0, across.0 * along.0, along.0 * along.0];
    let most = [across.1 * across.1, across.1 * along.1, along.1 * along.1];
    let mut bends = *bends;
    for k in 0..3 {
        // The middle of the bend times the product of widths, which varies by this share.
        let vary = 0.5 * (1.0 - least[k] / most[k]);
        bends.slack[k] += bends.mid[k].abs() * vary;
        bends.mid[k] *= 1.0 - vary;
    }
    let (u, v) = (DVec2::new(across.1, 0.0), DVec2::new(0.0, along.1));
    over_sides(&bends, [DVec2::ZERO, u, u + v], u + v).max(over_sides(&bends, [DVec2::ZERO, u, v], u + v))
}

/// A cell of a grid, counter-clockwise from the corner of least (u, v).
struct GridCorners {
    places: [(f64, f64); 4],
    ids: [u32; 4],
}

impl GridCorners {
    /// The side that is one point.
    fn pole(&self) -> Option<usize> {
        (0..4).find(|k| self.ids[*k] == self.ids[(k + 1) % 4])
    }

    /// The farthest point of a half by surface points at sixths of the cell, from its first corner on in rows `width` apart.
    fn farthest(&self, half: [usize; 3], nodes: &[DVec3], fine: &[DVec3], width: usize) -> Farthest {
        // Corners of the cell in sixths.
        let corner = [(0, 0), (SIX, 0), (SIX, SIX), (0, SIX)];
        let [a, b, c] = half.map(|k| corner[k]);
        let corners = half.map(|k| nodes[self.ids[k] as usize]);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let mut seen = Farthest::corner(corners, half.map(|k| self.places[k]));
        let place = |x: f64, y: f64| {
            let (s, t) = (x / SIX as f64, y / SIX as f64);
            let [q0, q1, _, q3] = self.places;
            (q0.0 + (q1.0 - q0.0) * s + (q3.0 - q0.0) * t, q0.1 + (q1.1 - q0.1) * s + (q3.1 - q0.1) * t)
        };
        let mut middles = [0.0; 3];
        for (wa, wb, wc) in weights() {
            let x = (a.0 * wa + b.0 * wb + c.0 * wc) / SIX;
            let y = (a.1 * wa + b.1 * wb + c.1 * wc) / SIX;
            let w = [wa, wb, wc].map(|n| n as f64 / SIX as f64);
            let p = weighted(corners, w);
            let there = fine[y * width + x];
            if let Some(k) = middle([wa, wb, wc]) {
                middles[k] = (there - p).dot(normal);
            }
            let seems = off(p, there, normal);
            if seems > seen.seems {
                seen = Farthest { seems, weights: w, uv: place(x as f64, y as f64), ..seen };
            }
        }
        if let Some((seems, w)) = peak(middles).filter(|(seems, _)| *seems > seen.seems) {
            let along = |a: usize, b: usize, c: usize| a as f64 * w[0] + b as f64 * w[1] + c as f64 * w[2];
            let uv = place(along(a.0, b.0, c.0), along(a.1, b.1, c.1));
            seen = Farthest { seems, weights: w, uv, ..seen };
        }
        seen
    }
}
