//! Wanted lengths over a face: a grid over its chart that no length grows faster across than allowed.

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField};
use crate::mesh::request::sources::Sources;
use crate::mesh::tri::placement_settings::BACKGROUND;

/// Lengths at the nodes of a grid, read between them by the mean of the four round a place.
#[derive(Clone, Debug)]
pub struct Background {
    low: DVec2,
    cell: DVec2,
    n: (usize, usize),
    p: Vec<DVec3>,
    size: Vec<f64>,
    growth: f64,
}

impl Background {
    /// A grid over a box of the chart with the length `of` each place; `growth` is the largest ratio of neighbouring edges.
    ///
    /// The distance of grid lines follows from the mean length, which a first, coarse grid has.
    pub fn new(
        chart_surface: &dyn ParametricSurface,
        (low, high): (DVec2, DVec2),
        growth: f64,
        of: &(impl Fn(DVec2) -> f64 + Sync),
    ) -> Self {
        let first = Self::with_lines(BACKGROUND.first_lines, chart_surface, (low, high), growth, of);
        let mean = first.size.iter().map(|h| 1.0 / (h * h)).sum::<f64>() / first.size.len() as f64;
        let lines = (high - low).max_element() * mean.sqrt() / BACKGROUND.line_spacing;
        if lines <= BACKGROUND.first_lines as f64 {
            return first;
        }
        Self::with_lines((lines as usize).min(BACKGROUND.max_lines), chart_surface, (low, high), growth, of)
    }

    fn with_lines(
        most: usize,
        chart_surface: &dyn ParametricSurface,
        (low, high): (DVec2, DVec2),
        growth: f64,
        of: &(impl Fn(DVec2) -> f64 + Sync),
    ) -> Self {
        let extent = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        let longest = extent.max_element();
        let lines = |x: f64| ((most as f64 * x / longest).ceil() as usize).clamp(4, most) + 1;
        let n = (lines(extent.x), lines(extent.y));
        let cell = DVec2::new(extent.x / (n.0 - 1) as f64, extent.y / (n.1 - 1) as f64);
        let place = |k: usize| chart_surface.clamp(low + cell * DVec2::new((k % n.0) as f64, (k / n.0) as f64));
        let row =
            |j: usize| -> Vec<(DVec3, f64)> { (0..n.0).map(|i| place(j * n.0 + i)).map(|xy| (chart_surface.spot(xy).p, of(xy))).collect() };
        let rows = par::map(n.1, row);
        let p = rows.iter().flatten().map(|node| node.0).collect();
        let size = rows.iter().flatten().map(|node| node.1).collect();
        let mut field = Self { low, cell, n, p, size, growth };
        field.level();
        field
    }

    /// Lowers the length round a place to at most `size`; where lengths round it differ, as beside a tip, all by the same share.
    pub fn lower(&mut self, xy: DVec2, size: f64) {
        let at = ((xy - self.low) / self.cell).max(DVec2::ZERO);
        let (i, j) = ((at.x as usize).min(self.n.0 - 2), (at.y as usize).min(self.n.1 - 2));
        let round = [j * self.n.0 + i, j * self.n.0 + i + 1, (j + 1) * self.n.0 + i, (j + 1) * self.n.0 + i + 1];
        let [least, most] = [f64::min, f64::max].map(|f| round.into_iter().map(|k| self.size[k]).reduce(f).unwrap_or(size));
        let share = (most > BACKGROUND.max_even_ratio * least).then(|| (size / self.size(xy, DVec3::ZERO)).min(1.0));
        for k in round {
            self.size[k] = self.size[k].min(share.map_or(size, |share| share * self.size[k]));
        }
    }

    /// Multiplies all lengths.
    pub fn scale(&mut self, by: f64) {
        self.size.iter_mut().for_each(|size| *size *= by);
    }

    /// No length exceeds that of a neighbour by more than the growth over their distance in space; after lowering.
    pub fn level(&mut self) {
        let slope = (self.growth - 1.0).max(0.0);
        let (nx, ny) = self.n;
        let mut reach = |k: usize, other: usize| {
            let most = self.size[other] + slope * self.p[k].distance(self.p[other]);
            if self.size[k] > most {
                self.size[k] = most;
            }
        };
        // Two sweeps there and back carry a length along every way but the most winding; the rest is caught by the next.
        for _ in 0..2 {
            for j in 0..ny {
                for i in 0..nx {
                    let k = j * nx + i;
                    if i > 0 {
                        reach(k, k - 1);
                    }
                    if j > 0 {
                        reach(k, k - nx);
                        if i > 0 {
                            reach(k, k - nx - 1);
                        }
                        if i + 1 < nx {
                            reach(k, k - nx + 1);
                        }
                    }
                }
            }
            for j in (0..ny).rev() {
                for i in (0..nx).rev() {
                    let k = j * nx + i;
                    if i + 1 < nx {
                        reach(k, k + 1);
                    }
                    if j + 1 < ny {
                        reach(k, k + nx);
                        if i + 1 < nx {
                            reach(k, k + nx + 1);
                        }
                        if i > 0 {
                            reach(k, k + nx - 1);
                        }
                    }
                }
            }
        }
    }
}

/// Lengths by places with a size of their own, under those of a background.
pub struct GradedSize<'a> {
    /// Places, in lengths of edges.
    pub sources: &'a Sources,
    /// Largest and least length of an edge.
    pub range: (f64, f64),
    /// Distance of nodes over the length of edges.
    pub spacing: f64,
    /// Distances of nodes by bends.
    pub background: Option<Background>,
}

impl GradedSize<'_> {
    /// A lower bound of the wanted distances of nodes.
    pub fn least(&self) -> f64 {
        let by_bends = self.background.as_ref().map_or(f64::INFINITY, |b| b.size.iter().copied().fold(f64::INFINITY, f64::min));
        let (most, least) = self.range;
        (self.sources.least().min(most) * self.spacing).min(by_bends).max(least * self.spacing)
    }

    /// The distance of nodes that bends demand.
    pub fn by_bends(&self, xy: DVec2, p: DVec3) -> f64 {
        self.background.as_ref().map_or(f64::INFINITY, |b| b.size(xy, p))
    }
}

impl SizeField for GradedSize<'_> {
    fn size(&self, xy: DVec2, p: DVec3) -> f64 {
        let (most, least) = self.range;
        // Sources are evaluated up to what bends allow.
        let bends = self.by_bends(xy, p).min(most * self.spacing);
        self.sources.who(p, bends / self.spacing).map_or(bends, |found| found.size * self.spacing).max(least * self.spacing)
    }
}

impl SizeField for Background {
    fn size(&self, xy: DVec2, _: DVec3) -> f64 {
        let at = ((xy - self.low) / self.cell).max(DVec2::ZERO);
        let (i, j) = ((at.x as usize).min(self.n.0 - 2), (at.y as usize).min(self.n.1 - 2));
        let (s, t) = ((at.x - i as f64).min(1.0), (at.y - j as f64).min(1.0));
        let k = j * self.n.0 + i;
        let row = |k: usize| self.size[k] * (1.0 - s) + self.size[k + 1] * s;
        row(k) * (1.0 - t) + row(k + self.n.0) * t
    }
}
