//! Lengths by bends over a face: a grid over its chart, with more lines where lengths differ, that no length grows faster across than
//! allowed.

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::base::tolerance::PARALLEL;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField};
use crate::mesh::tri::grid_lines::Lines;
use crate::mesh::tri::placement_settings::BACKGROUND;

/// A place, the normal of the surface there, and the wanted length.
type Node = (DVec3, (DVec3, f64));

/// Lengths at the nodes of a grid, read between them by the mean of the four round a place.
#[derive(Clone, Debug)]
pub struct Background {
    /// Lines across x, and across y.
    lines: (Lines, Lines),
    p: Vec<DVec3>,
    /// Normals of the surface.
    normal: Vec<DVec3>,
    size: Vec<f64>,
    growth: f64,
}

impl Background {
    /// A grid over a box of the chart with the length `of` each place; `growth` is the largest ratio of neighbouring edges.
    ///
    /// The distance of grid lines follows from the mean length, which a first, coarse grid has, and from the number of `breaks` of the surface
    /// along x and y, where that counts: a bump may be as narrow as two of them are near. Between lines whose lengths differ, or between
    /// which the surface turns, as at a sharp nose or fold, lines are added until they are as near to each other as the lengths there demand.
    pub fn new(
        chart_surface: &dyn ParametricSurface,
        (low, high): (DVec2, DVec2),
        growth: f64,
        breaks: [usize; 2],
        of: &(impl Fn(DVec2) -> f64 + Sync),
    ) -> Self {
        let extent = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        let node = |xy: DVec2| {
            let xy = chart_surface.clamp(xy);
            let spot = chart_surface.spot(xy);
            // At a pole there is no normal but by rounding.
            let longest = spot.dx.length_squared().max(spot.dy.length_squared());
            let normal = if spot.dx.cross(spot.dy).length() > PARALLEL * longest { spot.normal() } else { DVec3::ZERO };
            (spot.p, (normal, of(xy)))
        };
        let even = |most: usize| {
            let lines = |from: f64, x: f64, breaks: usize| {
                let by_breaks = if breaks > BACKGROUND.many_breaks { breaks.min(BACKGROUND.max_lines_by_breaks) } else { 0 };
                let n = ((most as f64 * x / extent.max_element()).ceil() as usize).clamp(4, most).max(by_breaks);
                Lines::new((0..=n).map(|k| from + x * (k as f64 / n as f64)).collect())
            };
            Self::with_lines((lines(low.x, extent.x, breaks[0]), lines(low.y, extent.y, breaks[1])), growth, &node)
        };
        let mut field = even(BACKGROUND.first_lines);
        let mut level = field.clone();
        level.level();
        let mean = level.size.iter().map(|h| 1.0 / (h * h)).sum::<f64>() / level.size.len() as f64;
        let lines = extent.max_element() * mean.sqrt() / BACKGROUND.line_spacing;
        if lines > BACKGROUND.first_lines as f64 {
            field = even((lines as usize).min(BACKGROUND.max_lines));
        }
        let most = BACKGROUND.max_added_nodes.max(field.size.len() + field.size.len() / 2);
        let even = field.lines.clone();
        for _ in 0..BACKGROUND.max_rounds {
            let Some(lines) = field.finer_lines(most) else { break };
            field = field.with_more_lines(lines, &node);
        }
        field.drop_needless_lines(&even);
        field.level();
        field
    }

    /// Drops the lines that were added between two even ones where all lengths turned out as these two say: round a cylinder the surface
    /// turns, but lengths are alike.
    fn drop_needless_lines(&mut self, even: &(Lines, Lines)) {
        let (nx, ny) = self.n();
        let size = |i: usize, j: usize| self.size[j * nx + i];
        let columns = needed_lines(&self.lines.0, &even.0, ny, size);
        let rows = needed_lines(&self.lines.1, &even.1, nx, |j, i| size(i, j));
        if columns.len() == nx && rows.len() == ny {
            return;
        }
        let kept: Vec<usize> = rows.iter().flat_map(|j| columns.iter().map(move |i| j * nx + i)).collect();
        self.p = kept.iter().map(|k| self.p[*k]).collect();
        self.normal = kept.iter().map(|k| self.normal[*k]).collect();
        self.size = kept.iter().map(|k| self.size[*k]).collect();
        let of = |lines: &Lines, kept: &[usize]| Lines::new(kept.iter().map(|k| lines.at[*k]).collect());
        self.lines = (of(&self.lines.0, &columns), of(&self.lines.1, &rows));
    }

    fn with_lines(lines: (Lines, Lines), growth: f64, node: &(impl Fn(DVec2) -> Node + Sync)) -> Self {
        let row = |j: usize| lines.0.at.iter().map(|x| node(DVec2::new(*x, lines.1.at[j]))).collect::<Vec<_>>();
        let (p, (normal, size)) = par::map(lines.1.at.len(), row).into_iter().flatten().unzip();
        Self { lines, p, normal, size, growth }
    }

    /// More lines, up to so many nodes: one in the middle of each gap in which lengths or normals differ for its width about as much as in the
    /// worst one; `None` where there is no such gap. Of gaps that are alike, as on both sides of a nose, all or none are halved.
    fn finer_lines(&self, most: usize) -> Option<(Lines, Lines)> {
        let (nx, ny) = self.n();
        let need = |k: usize, other: usize| {
            let (least, largest) = (self.size[k].min(self.size[other]), self.size[k].max(self.size[other]));
            let apart = self.p[k].distance(self.p[other]) / (BACKGROUND.line_spacing * least);
            let [one, next] = [self.normal[k], self.normal[other]];
            let turns = one != DVec3::ZERO && next != DVec3::ZERO && one.dot(next) < BACKGROUND.min_turn_cosine;
            // Lengths on both sides of a nose say nothing of it.
            let near = if turns { BACKGROUND.min_turn_spacing } else { 1.0 };
            if (turns || largest > BACKGROUND.max_ratio * least) && apart > near && apart.is_finite() { apart } else { 0.0 }
        };
        let columns = (0..nx - 1).map(|i| (true, i, (0..ny).map(|j| need(j * nx + i, j * nx + i + 1)).fold(0.0, f64::max)));
        let rows = (0..ny - 1).map(|j| (false, j, (0..nx).map(|i| need(j * nx + i, j * nx + nx + i)).fold(0.0, f64::max)));
        let mut worst: Vec<(bool, usize, f64)> = columns.chain(rows).filter(|gap| gap.2 > 0.0).collect();
        worst.sort_by(|a, b| b.2.total_cmp(&a.2).then((a.0, a.1).cmp(&(b.0, b.1))));
        let (mut added, mut n) = ((Vec::new(), Vec::new()), (nx, ny));
        let largest = worst.first()?.2;
        let alike = |a: &(bool, usize, f64), b: &(bool, usize, f64)| b.2 >= BACKGROUND.alike * a.2;
        for gaps in worst.chunk_by(alike).take_while(|gaps| gaps[0].2 >= BACKGROUND.halved_share * largest) {
            let middle = |k: usize, lines: &Lines| lines.at[k].midpoint(lines.at[k + 1]);
            let inside = |k: usize, lines: &Lines| lines.at[k] < middle(k, lines) && middle(k, lines) < lines.at[k + 1];
            let of = |is_column: bool, lines: &Lines| -> Vec<f64> {
                gaps.iter().filter(|gap| gap.0 == is_column && inside(gap.1, lines)).map(|gap| middle(gap.1, lines)).collect()
            };
            let (columns, rows) = (of(true, &self.lines.0), of(false, &self.lines.1));
            let next = (n.0 + columns.len(), n.1 + rows.len());
            if next.0 * next.1 > most {
                break;
            }
            added.0.extend(columns);
            added.1.extend(rows);
            n = next;
        }
        (n != (nx, ny)).then(|| (self.lines.0.and(added.0), self.lines.1.and(added.1)))
    }

    /// The same grid with more lines.
    fn with_more_lines(&self, lines: (Lines, Lines), node: &(impl Fn(DVec2) -> Node + Sync)) -> Self {
        let nx = self.n().0;
        let (columns, rows) = (self.lines.0.indices_in(&lines.0), self.lines.1.indices_in(&lines.1));
        let row = |j: usize| {
            let known = |i: usize| columns[i].zip(rows[j]).map(|(i, j)| j * nx + i).map(|k| (self.p[k], (self.normal[k], self.size[k])));
            let all = lines.0.at.iter().enumerate();
            all.map(|(i, x)| known(i).unwrap_or_else(|| node(DVec2::new(*x, lines.1.at[j])))).collect::<Vec<_>>()
        };
        let (p, (normal, size)) = par::map(lines.1.at.len(), row).into_iter().flatten().unzip();
        Self { lines, p, normal, size, growth: self.growth }
    }

    /// Number of lines across x, and across y.
    fn n(&self) -> (usize, usize) {
        (self.lines.0.at.len(), self.lines.1.at.len())
    }

    /// The least length of all.
    pub fn least(&self) -> f64 {
        self.size.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Lowers the length round a place to at most `size`; where lengths round it differ, as beside a tip, all by the same share.
    pub fn lower(&mut self, xy: DVec2, size: f64) {
        let ((i, _), (j, _), nx) = (self.lines.0.place(xy.x), self.lines.1.place(xy.y), self.n().0);
        let round = [j * nx + i, j * nx + i + 1, (j + 1) * nx + i, (j + 1) * nx + i + 1];
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
        let (nx, ny) = self.n();
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

/// The even lines, and those between two of them where a length differs from what lies between the lengths at these two; `across` lengths lie
/// on each line.
fn needed_lines(lines: &Lines, even: &Lines, across: usize, size: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    let is_even = even.indices_in(lines);
    let even: Vec<usize> = (0..lines.at.len()).filter(|k| is_even[*k].is_some()).collect();
    let mut needed = vec![even[0]];
    for gap in even.windows(2) {
        let [low, high] = [gap[0], gap[1]];
        let differs = |k: usize, at: usize| {
            let share = (lines.at[k] - lines.at[low]) / (lines.at[high] - lines.at[low]);
            let between = size(low, at) + share * (size(high, at) - size(low, at));
            size(k, at) > BACKGROUND.max_needless_ratio * between || between > BACKGROUND.max_needless_ratio * size(k, at)
        };
        if (low + 1..high).any(|k| (0..across).any(|at| differs(k, at))) {
            needed.extend(low + 1..high);
        }
        needed.push(high);
    }
    needed
}

impl SizeField for Background {
    fn size(&self, xy: DVec2, _: DVec3) -> f64 {
        let ((i, s), (j, t), nx) = (self.lines.0.place(xy.x), self.lines.1.place(xy.y), self.lines.0.at.len());
        let k = j * nx + i;
        let row = |k: usize| self.size[k] * (1.0 - s) + self.size[k + 1] * s;
        row(k) * (1.0 - t) + row(k + nx) * t
    }
}
