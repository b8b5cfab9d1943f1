//! A chart of a surface that is slow to evaluate, by bicubic Hermite patches over its parameters [de Boor 1978, chapters IV and XVII]: triangles
//! are improved on it, and their nodes put on the surface itself at the end.

use glam::{DVec2, DVec3};

use crate::base::math::powi;
use crate::base::tolerance::{INTERPOLATED, WHOLE_NUMBER};
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::{LocalExpansion, ParametricSurface, Spot};
use crate::surface::data::one_sided::OneSided;
use crate::surface::{Domain, Jet2};

/// What steers the interpolation.
struct InterpolationSettings {
    /// Cells each way of the first grid between two lines at which a surface is less than analytic.
    first_cells: usize,
    /// How far the middle of a cell's side may lie from the surface, over the size or the shortest step of the border.
    max_error: f64,
    /// Less than the factor that halving gains, which is about 16: a grid off by so many times the error is halved once more, unmeasured.
    gain_of_halving: f64,
    /// Evaluations of the grid over the nodes of the face, from which on the surface itself is as quick.
    max_places_per_node: f64,
    /// Nodes of a face from which on a grid pays.
    min_nodes: f64,
    /// Shortest step of the border over the size, below which the face is not interpolated: the grid would have to follow elements as small.
    min_step_over_size: f64,
}

const SETTINGS: InterpolationSettings = InterpolationSettings {
    first_cells: 2,
    max_error: INTERPOLATED,
    gain_of_halving: 4.0,
    max_places_per_node: 1.0,
    min_nodes: 150.0,
    min_step_over_size: 0.05,
};

/// A chart interpolated over the box of a face's parameters.
pub struct InterpolatedChart<'a> {
    chart: &'a Chart,
    /// Ends of the blocks in u and v, ascending: the box, and the lines inside at which the surface is less than analytic.
    lines: [Vec<f64>; 2],
    /// One for each step of u (fastest) and v between the lines.
    blocks: Vec<Block>,
}

/// The cells between four lines.
struct Block {
    /// Least u and v.
    low: DVec2,
    /// Cells per unit of u and v.
    cells_per_unit: DVec2,
    counts: (usize, usize),
    /// Coefficients of uⁱvʲ at 4 j + i over 0…1 of each cell, u fastest.
    cells: Vec<[DVec3; 16]>,
}

impl<'a> InterpolatedChart<'a> {
    /// Interpolates where it pays: `None` of a plane, of a net with a power form, of a face with few nodes of `size` (model units) or short steps, beyond a seam,
    /// and where the grid would be as fine as the mesh.
    pub fn new(chart: &'a Chart, outline: &Outline, size: f64) -> Option<Self> {
        let surface = chart.surface();
        let has_grid = matches!(surface.ground(), Domain::Square | Domain::Loop) && !surface.is_scattered();
        if surface.is_flat() || chart.evaluator().has_power_form() || !has_grid {
            return None;
        }
        let nodes = outline.area() / (size * size);
        let shortest = outline.edges().map(|edge| outline.length(edge)).fold(size, f64::min);
        if nodes < SETTINGS.min_nodes || shortest < SETTINGS.min_step_over_size * size {
            return None;
        }
        let (low, high) = chart.box_of(outline);
        let beyond = (-low).max(high - 1.0).max_element();
        let (low, high) = (low.max(DVec2::ZERO), high.min(DVec2::ONE));
        if beyond > WHOLE_NUMBER || (high - low).min_element() <= 0.0 {
            return None;
        }
        let inner = |lines: Vec<f64>, low: f64, high: f64| {
            let inside = lines.into_iter().filter(|x| low + WHOLE_NUMBER < *x && *x < high - WHOLE_NUMBER);
            std::iter::once(low).chain(inside).chain([high]).collect::<Vec<_>>()
        };
        let (us, vs) = surface.breaks();
        let lines = [inner(us, low.x, high.x), inner(vs, low.y, high.y)];
        let mut left = (SETTINGS.max_places_per_node * nodes) as usize;
        let mut blocks = Vec::new();
        for v in lines[1].windows(2) {
            for u in lines[0].windows(2) {
                let block = Block::new(chart, (DVec2::new(u[0], v[0]), DVec2::new(u[1], v[1])), SETTINGS.max_error * shortest, left)?;
                left -= block.cells.len();
                blocks.push(block);
            }
        }
        Some(Self { chart, lines, blocks })
    }

    /// The cell of surface parameters, the place in it, 0…1, and its cells per unit; `None` well outside the box.
    fn cell(&self, (u, v): (f64, f64)) -> Option<(&[DVec3; 16], DVec2, DVec2)> {
        let step = |lines: &[f64], x: f64| lines[1..lines.len() - 1].partition_point(|line| *line <= x);
        let [us, vs] = &self.lines;
        let block = &self.blocks[step(vs, v) * (us.len() - 1) + step(us, u)];
        let at = (DVec2::new(u, v) - block.low) * block.cells_per_unit;
        let (nu, nv) = (block.counts.0 as f64, block.counts.1 as f64);
        if !(-0.25..=nu + 0.25).contains(&at.x) || !(-0.25..=nv + 0.25).contains(&at.y) {
            return None;
        }
        let (i, j) = (at.x.clamp(0.0, nu - 1.0) as usize, at.y.clamp(0.0, nv - 1.0) as usize);
        Some((&block.cells[j * block.counts.0 + i], at - DVec2::new(i as f64, j as f64), block.cells_per_unit))
    }
}

impl Block {
    /// Halves cells until the middles of their sides are off by `allowed` (model units) at most; `None` above `most` cells.
    fn new(chart: &Chart, ends: (DVec2, DVec2), allowed: f64, most: usize) -> Option<Self> {
        let mut counts = (SETTINGS.first_cells, SETTINGS.first_cells);
        let mut error = DVec2::INFINITY;
        loop {
            if counts.0 * counts.1 > most {
                return None;
            }
            let grid = Grid::new(chart, ends, counts);
            if error.max_element() > SETTINGS.gain_of_halving * allowed {
                error = grid.errors(chart);
            } else {
                error = DVec2::ZERO;
            }
            if error.max_element() <= allowed {
                return Some(Self { low: ends.0, cells_per_unit: 1.0 / grid.cell, counts, cells: grid.cells() });
            }
            let halved = |count: usize, error: f64| if error > allowed { 2 * count } else { count };
            counts = (halved(counts.0, error.x), halved(counts.1, error.y));
        }
    }
}

impl ParametricSurface for InterpolatedChart<'_> {
    fn spot(&self, xy: DVec2) -> Spot {
        let Some((c, at, by)) = self.cell(self.chart.uv(xy)) else { return self.chart.spot(xy) };
        let row = |j: usize| {
            let (c0, c1, c2, c3) = (c[4 * j], c[4 * j + 1], c[4 * j + 2], c[4 * j + 3]);
            (((c3 * at.x + c2) * at.x + c1) * at.x + c0, (c3 * (3.0 * at.x) + c2 * 2.0) * at.x + c1)
        };
        let rows = [row(0), row(1), row(2), row(3)];
        let along = |f: &dyn Fn(usize) -> DVec3| ((f(3) * at.y + f(2)) * at.y + f(1)) * at.y + f(0);
        let (p, du) = (along(&|j| rows[j].0), along(&|j| rows[j].1));
        let dv = (rows[3].0 * (3.0 * at.y) + rows[2].0 * 2.0) * at.y + rows[1].0;
        self.chart.spot_of([p, du * by.x, dv * by.y])
    }

    fn expansion(&self, xy: DVec2) -> LocalExpansion {
        let Some((c, at, by)) = self.cell(self.chart.uv(xy)) else { return self.chart.expansion(xy) };
        // Derivatives of order m by u and n by v.
        let derivative = |m: usize, n: usize| {
            let factor = |k: usize, m: usize| (0..m).map(|d| k as f64 - d as f64).product::<f64>();
            let power = |x: f64, k: usize, m: usize| if k < m { 0.0 } else { factor(k, m) * powi(x, (k - m) as i32) };
            (0..16).map(|k| c[k] * (power(at.x, k % 4, m) * power(at.y, k / 4, n))).sum::<DVec3>()
        };
        let jet = Jet2 {
            p: derivative(0, 0),
            du: derivative(1, 0) * by.x,
            dv: derivative(0, 1) * by.y,
            duu: derivative(2, 0) * (by.x * by.x),
            duv: derivative(1, 1) * (by.x * by.y),
            dvv: derivative(0, 2) * (by.y * by.y),
        };
        self.chart.expansion_of(&jet)
    }

    fn clamp(&self, xy: DVec2) -> DVec2 {
        self.chart.clamp(xy)
    }
}

/// Jets of a surface on a tensor grid.
struct Grid {
    counts: (usize, usize),
    low: DVec2,
    /// Size of a cell in u and v.
    cell: DVec2,
    jets: Vec<Jet2>,
}

impl Grid {
    fn new(chart: &Chart, (low, high): (DVec2, DVec2), counts: (usize, usize)) -> Self {
        let values = |low: f64, high: f64, n: usize| -> Vec<(f64, OneSided)> {
            let side = |k: usize| if k == n { OneSided::Before } else { OneSided::After };
            (0..=n).map(|k| (if k == n { high } else { low + (high - low) * (k as f64 / n as f64) }, side(k))).collect()
        };
        let jets = chart.surface().jets(&values(low.x, high.x, counts.0), &values(low.y, high.y, counts.1));
        Self { counts, low, cell: (high - low) / DVec2::new(counts.0 as f64, counts.1 as f64), jets }
    }

    fn jet(&self, i: usize, j: usize) -> &Jet2 {
        &self.jets[j * (self.counts.0 + 1) + i]
    }

    /// The largest distance between the middles of the sides along u, and along v, and the surface there, model units.
    fn errors(&self, chart: &Chart) -> DVec2 {
        let middles = |low: f64, cell: f64, n: usize| -> Vec<f64> { (0..n).map(|k| low + cell * (k as f64 + 0.5)).collect() };
        let corners = |low: f64, cell: f64, n: usize| -> Vec<f64> { (0..n).map(|k| low + cell * k as f64).collect() };
        let ((nu, nv), low, cell) = (self.counts, self.low, self.cell);
        let points = |us: &[f64], vs: &[f64]| {
            let mut points = vec![DVec3::ZERO; us.len() * vs.len()];
            chart.surface().grid(us, vs, &mut points);
            points
        };
        let along_u = points(&middles(low.x, cell.x, nu), &corners(low.y, cell.y, nv));
        let along_v = points(&corners(low.x, cell.x, nu), &middles(low.y, cell.y, nv));
        let mut worst = DVec2::ZERO;
        for (k, (pu, pv)) in along_u.iter().zip(&along_v).enumerate() {
            let (i, j) = (k % nu, k / nu);
            let (a, b, c) = (self.jet(i, j), self.jet(i + 1, j), self.jet(i, j + 1));
            let middle_u = 0.5 * (a.p + b.p) + (a.du - b.du) * (0.125 * cell.x);
            let middle_v = 0.5 * (a.p + c.p) + (a.dv - c.dv) * (0.125 * cell.y);
            worst = worst.max(DVec2::new(middle_u.distance(*pu), middle_v.distance(*pv)));
        }
        worst
    }

    /// The coefficients of all cells.
    fn cells(&self) -> Vec<[DVec3; 16]> {
        /// Of 1, t, t² and t³ from values and derivatives at 0 and 1.
        fn powers(a: DVec3, da: DVec3, b: DVec3, db: DVec3) -> [DVec3; 4] {
            [a, da, (b - a) * 3.0 - da * 2.0 - db, (a - b) * 2.0 + da + db]
        }
        let cell = self.cell;
        let of_cell = |i: usize, j: usize| {
            let corner = |x: usize, y: usize| {
                let jet = self.jet(i + x, j + y);
                (jet.p, jet.du * cell.x, jet.dv * cell.y, jet.duv * (cell.x * cell.y))
            };
            // Along u at both ends of v: the value, and the derivative by v.
            let row = |y: usize| {
                let ((a, au, av, auv), (b, bu, bv, buv)) = (corner(0, y), corner(1, y));
                (powers(a, au, b, bu), powers(av, auv, bv, buv))
            };
            let (low, high) = (row(0), row(1));
            let mut c = [DVec3::ZERO; 16];
            for k in 0..4 {
                let along_v = powers(low.0[k], low.1[k], high.0[k], high.1[k]);
                (0..4).for_each(|n| c[4 * n + k] = along_v[n]);
            }
            c
        };
        (0..self.counts.0 * self.counts.1).map(|k| of_cell(k % self.counts.0, k / self.counts.0)).collect()
    }
}
