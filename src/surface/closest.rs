//! Nearest points of surfaces.
//!
//! A surface is sampled once; a query starts a safeguarded Newton descent from the best few local minima among the
//! samples; blocks of samples whose box is too far away are not looked at. The samples are finer than the bends of the curves
//! below (at least four in every cell between knots), but this is sampling: a dent narrower than a sixteenth of a cell may be missed. The distance found is never below the true one.

use glam::DVec3;

use super::Jet2;
use super::breaks::{chain_breaks, tidy};
use super::core::{Domain, Side, Surface};
use super::descent::{Local, descend};
use super::quick::Quick;
use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::tolerance::EPSILON;
use crate::network::Chain;

/// The point of a surface nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Surface parameters.
    pub uv: (f64, f64),
    /// The point there.
    pub point: DVec3,
    /// Its distance, model units.
    pub distance: f64,
}

/// A surface prepared for many queries.
#[derive(Clone, Debug)]
pub struct Nearest {
    surface: Surface,
    /// The surface without its borders, which is sampled.
    whole: Surface,
    quick: Option<Quick>,
    xs: Vec<f64>,
    ys: Vec<f64>,
    points: Vec<DVec3>,
    blocks: Vec<Block>,
}

/// Samples that lie together.
#[derive(Clone, Debug)]
struct Block {
    /// First and one past the last of its rows and columns.
    rows: (usize, usize),
    columns: (usize, usize),
    /// Their box.
    around: Box3,
    /// The farthest that samples beside them are from them.
    reach: f64,
}

impl Block {
    /// The places of its samples among all, `nx` a row.
    fn samples(&self, nx: usize) -> impl Iterator<Item = usize> + use<> {
        let columns = self.columns;
        (self.rows.0..self.rows.1).flat_map(move |j| (columns.0..columns.1).map(move |i| j * nx + i))
    }
}

/// Samples along each side of a block.
const BLOCK: usize = 8;
/// A local minimum among the samples that is farther than the nearest sample by so many distances of neighbouring samples is
/// not tried.
const BEHIND: f64 = 2.0;

/// Samples along one direction, at the least.
const LEAST: usize = 24;
/// Samples in a cell between breaks, at the least.
const EACH: usize = 4;
/// Samples of a surface between its breaks, at the most.
const MOST: usize = 1 << 18;
/// Even cells along each direction of a surface with three sides, at the most.
const CELLS: f64 = 127.0;
/// Samples of a border that no curve carries.
const BORDER: usize = 64;
/// Local minima tried.
const STARTS: usize = 6;

impl Nearest {
    /// Samples the surface.
    pub fn new(surface: &Surface) -> Self {
        let whole = if surface.domain() == Domain::Loop && !surface.is_flat() { surface.untrimmed() } else { surface.clone() };
        let mut nearest =
            Self { surface: surface.clone(), quick: None, xs: Vec::new(), ys: Vec::new(), points: Vec::new(), blocks: Vec::new(), whole };
        if matches!(nearest.whole.domain(), Domain::Square | Domain::Triangle) {
            nearest.sample();
        }
        nearest
    }

    fn sample(&mut self) {
        (self.xs, self.ys) = self.stations();
        self.quick = self.whole.quick();
        self.points = self.whole.square_jets(&self.xs, &self.ys).iter().map(|jet| jet.p).collect();
        let (nx, ny) = (self.xs.len(), self.ys.len());
        for j in (0..ny).step_by(BLOCK) {
            for i in (0..nx).step_by(BLOCK) {
                job::look();
                let (rows, columns) = ((j, (j + BLOCK).min(ny)), (i, (i + BLOCK).min(nx)));
                let mut block = Block { rows, columns, around: Box3::EMPTY, reach: 0.0 };
                for k in block.samples(nx) {
                    block.around = block.around.with(self.points[k]);
                    block.reach = block.reach.max(self.reach(k));
                }
                self.blocks.push(block);
            }
        }
    }

    /// Where the surface is sampled: in each cell between its breaks, for a smooth curve may be sharply bent between two of its
    /// knots; where both directions have very many, in the cells of its shape alone.
    fn stations(&self) -> (Vec<f64>, Vec<f64>) {
        let (us, vs) = self.whole.cells();
        let (mut xs, mut ys) = self.whole.breaks();
        if self.whole.domain() == Domain::Triangle {
            // Lines of constant u or v are none of the square there: even cells no wider than the narrowest between breaks.
            let gaps = |k: usize| match self.whole.side(k) {
                Side::Chain { chain, .. } => {
                    let stops = [vec![0.0], chain_breaks(&chain), vec![1.0]].concat();
                    stops.windows(2).map(|w| w[1] - w[0]).fold(1.0, f64::min)
                }
                _ => 1.0,
            };
            let narrowest = (0..self.whole.n_sides()).map(gaps).fold(1.0, f64::min);
            let cells = (1.0 / narrowest).ceil().min(CELLS) as usize;
            xs = (1..cells).map(|k| k as f64 / cells as f64).collect();
            ys.clone_from(&xs);
        }
        xs.extend(&us);
        ys.extend(&vs);
        let (xs, ys) = (stations(&tidy(xs, EPSILON)), stations(&tidy(ys, EPSILON)));
        if xs.len().saturating_mul(ys.len()) <= MOST { (xs, ys) } else { (stations(&us), stations(&vs)) }
    }

    /// Point and derivatives at a place of the unit square.
    fn jet(&self, x: f64, y: f64) -> Jet2 {
        self.quick.as_ref().map_or_else(|| self.whole.square_jet(x, y), |quick| quick.jet(x, y))
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The nearest point of the surface.
    pub fn at(&self, p: DVec3) -> Closest {
        job::look();
        match self.surface.domain() {
            Domain::Unbounded => self.foot(p),
            Domain::Loop if self.surface.is_flat() => self.inside_loop(p),
            Domain::Loop => self.inside_trim(p),
            Domain::Square | Domain::Triangle => self.search(p),
        }
    }

    fn closest(&self, uv: (f64, f64), p: DVec3) -> Closest {
        let point = self.surface.point(uv.0, uv.1);
        Closest { uv, point, distance: point.distance(p) }
    }

    /// The farthest of the samples beside one.
    fn reach(&self, k: usize) -> f64 {
        let (nx, ny) = (self.xs.len(), self.ys.len());
        let (i, j) = (k % nx, k / nx);
        let beside = [(i > 0, k.wrapping_sub(1)), (i + 1 < nx, k + 1), (j > 0, k.wrapping_sub(nx)), (j + 1 < ny, k + nx)];
        let apart = beside.into_iter().filter(|b| b.0).map(|(_, n)| self.points[n].distance_squared(self.points[k]));
        apart.fold(0.0, f64::max).sqrt()
    }

    /// Local minima among the samples that may lead to the nearest point, the nearest first.
    fn starts(&self, p: DVec3) -> Vec<usize> {
        let nx = self.xs.len();
        let far = |k: usize| self.points[k].distance_squared(p);
        let apart: Vec<f64> = self.blocks.iter().map(|block| block.around.distance_squared(p)).collect();
        let Some(first) = (0..apart.len()).min_by(|a, b| apart[*a].total_cmp(&apart[*b])) else { return Vec::new() };
        let mut best = f64::INFINITY;
        for b in std::iter::once(first).chain(0..apart.len()) {
            if apart[b] < best {
                best = self.blocks[b].samples(nx).map(far).fold(best, f64::min);
            }
        }
        let lowest = |k: usize| {
            let (i, j) = (k % nx, k / nx);
            let (low, high) = ((i.saturating_sub(1), j.saturating_sub(1)), ((i + 1).min(nx - 1), (j + 1).min(self.ys.len() - 1)));
            (low.1..=high.1).all(|b| (low.0..=high.0).all(|a| far(k) <= far(b * nx + a)))
        };
        let nearest = best.sqrt();
        let mut starts = Vec::new();
        for (block, apart) in self.blocks.iter().zip(&apart) {
            if apart.sqrt() > nearest + BEHIND * block.reach {
                continue;
            }
            starts.extend(block.samples(nx).filter(|&k| lowest(k) && far(k).sqrt() <= nearest + BEHIND * self.reach(k)));
        }
        starts.sort_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
        starts
    }

    fn search(&self, p: DVec3) -> Closest {
        let nx = self.xs.len();
        let starts = self.starts(p);
        let half_square = |jet: &Jet2| {
            let gap = jet.p - p;
            Local {
                value: 0.5 * gap.length_squared(),
                gradient: [gap.dot(jet.du), gap.dot(jet.dv)],
                hessian: [
                    jet.du.length_squared() + gap.dot(jet.duu),
                    jet.du.dot(jet.dv) + gap.dot(jet.duv),
                    jet.dv.length_squared() + gap.dot(jet.dvv),
                ],
            }
        };
        // Samples of one point count as one: of a seam, whose two sides are both tried, and of a pole.
        let (mut places, mut points, mut last) = (Vec::new(), 0, None);
        for &k in &starts {
            let again = last.is_some_and(|l: DVec3| l.distance_squared(self.points[k]) <= EPSILON * EPSILON * l.length_squared());
            if !again {
                (points, last) = (points + 1, Some(self.points[k]));
            }
            if points > STARTS {
                break;
            }
            places.push(k);
            if !again {
                places.extend(self.round_pole(k, p));
            }
        }
        places.sort_unstable();
        places.dedup();
        let found = places.into_iter().map(|k| {
            let end = descend(&|x, y| self.jet(x, y), (self.xs[k % nx], self.ys[k / nx]), half_square);
            let point = self.jet(end.place.0, end.place.1).p;
            Closest { uv: self.whole.from_square(end.place.0, end.place.1), point, distance: point.distance(p) }
        });
        found.reduce(|best, next| if next.distance < best.distance { next } else { best }).unwrap_or_else(|| self.closest((0.0, 0.0), p))
    }

    /// Where a sample is one of a pole, where all samples of a row or column coincide: the local minima of the rows beside.
    /// From the pole itself no descent can turn into the direction that leads to the point.
    fn round_pole(&self, k: usize, p: DVec3) -> Vec<usize> {
        let (nx, ny) = (self.xs.len(), self.ys.len());
        let (i, j) = (k % nx, k / nx);
        let least = EPSILON * (self.points[k].length() + self.reach(k));
        let is_pole = |line: &[usize]| line.iter().all(|n| self.points[*n].distance(self.points[k]) <= least);
        let far = |k: usize| self.points[k].distance_squared(p);
        let row = |j: usize| (0..nx).map(|i| j * nx + i).collect::<Vec<_>>();
        let column = |i: usize| (0..ny).map(|j| j * nx + i).collect::<Vec<_>>();
        let beside = |at: usize, of: usize| [at.checked_sub(1), (at + 1 < of).then_some(at + 1)].into_iter().flatten();
        let rings: Vec<Vec<usize>> = if is_pole(&row(j)) {
            beside(j, ny).map(row).collect()
        } else if is_pole(&column(i)) {
            beside(i, nx).map(column).collect()
        } else {
            Vec::new()
        };
        let mut starts = Vec::new();
        for ring in rings {
            let low = |n: usize| beside(n, ring.len()).all(|m| far(ring[n]) <= far(ring[m]));
            starts.extend((0..ring.len()).filter(|n| low(*n)).map(|n| ring[n]));
        }
        starts
    }

    /// The foot on the plane.
    fn foot(&self, p: DVec3) -> Closest {
        self.closest(self.surface.flat_uv(p).unwrap_or_default(), p)
    }

    /// The nearest point of the whole surface where that is kept, else the nearest one of the borders.
    fn inside_trim(&self, p: DVec3) -> Closest {
        let found = self.search(p);
        if self.surface.keeps(found.uv.0, found.uv.1) {
            return found;
        }
        let border = |k: usize| match (self.surface.side(k), self.surface.border_line(k)) {
            (Side::Chain { chain, .. }, _) => {
                let (f, point, distance) = chain.closest(p);
                Some(Closest { uv: self.surface.border_place(k, f).unwrap_or_default(), point, distance })
            }
            (_, Some((a, b))) => {
                let uv = |t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
                let far = |t: f64| self.closest(uv(t), p).distance;
                let best = (0..=BORDER).map(|k| k as f64 / BORDER as f64).min_by(|s, t| far(*s).total_cmp(&far(*t))).unwrap_or(0.0);
                let step = 1.0 / BORDER as f64;
                let t = crate::base::solve::lowest((best - step).max(0.0), (best + step).min(1.0), crate::base::tolerance::NEAREST, far);
                Some(self.closest(uv(t), p))
            }
            _ => None,
        };
        (0..self.surface.n_sides()).filter_map(border).min_by(|a, b| a.distance.total_cmp(&b.distance)).unwrap_or(found)
    }

    /// The foot on the plane where it lies inside the boundary, else the nearest point of the boundary.
    fn inside_loop(&self, p: DVec3) -> Closest {
        let foot = self.foot(p);
        let normal = self.surface.normal(0.5, 0.5);
        let borders: Vec<Chain> = (0..self.surface.n_sides())
            .filter_map(|k| match self.surface.side(k) {
                Side::Chain { chain, from, to } => Some(if from > to { chain.reversed() } else { chain }),
                _ => None,
            })
            .collect();
        let turns: f64 = borders.iter().map(|chain| winding(chain, (0.0, 1.0), foot.point, normal)).sum();
        if turns.abs() > std::f64::consts::PI {
            return foot;
        }
        let nearest = borders.iter().map(|chain| chain.closest(p)).min_by(|a, b| a.2.total_cmp(&b.2));
        nearest.map_or(foot, |(_, point, distance)| Closest { uv: self.surface.flat_uv(point).unwrap_or_default(), point, distance })
    }
}

/// The point of a surface nearest to a given one; for many points make a [`Nearest`] once.
pub fn closest(surface: &Surface, p: DVec3) -> Closest {
    Nearest::new(surface).at(p)
}

/// Angle by which a run of a chain turns about a point, seen against a unit normal, radians.
///
/// A run shorter than the way from its start to the point and on to its end turns as its chord does; longer ones are halved.
fn winding(chain: &Chain, whole: (f64, f64), about: DVec3, normal: DVec3) -> f64 {
    const DEEPEST: u32 = 48;
    let mut open = vec![(whole, 0)];
    let mut turn = 0.0;
    while let Some(((f0, f1), depth)) = open.pop() {
        job::look();
        let (a, b) = (chain.point(f0) - about, chain.point(f1) - about);
        if (f1 - f0) * chain.length() < a.length() + b.length() || depth == DEEPEST {
            turn += crate::base::math::atan2(a.cross(b).dot(normal), a.dot(b));
        } else {
            let middle = 0.5 * (f0 + f1);
            open.push(((middle, f1), depth + 1));
            open.push(((f0, middle), depth + 1));
        }
    }
    turn
}

/// Sample stations between given inner ends of cells.
pub(super) fn stations(inner: &[f64]) -> Vec<f64> {
    let stops = [&[0.0], inner, &[1.0]].concat();
    let each = EACH.max(LEAST.div_ceil(stops.len() - 1));
    let mut all = Vec::with_capacity(each * stops.len());
    for w in stops.windows(2) {
        all.extend((0..each).map(|k| w[0] + (w[1] - w[0]) * k as f64 / each as f64));
    }
    all.push(1.0);
    all
}
