//! Samples of a surface over its unit square, and the places from which a descent to the point nearest to a given one starts.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::tolerance::EPSILON;
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::{chain_breaks, tidy};
use crate::surface::data::kind::Domain;
use crate::surface::rails::side::Side;

/// How finely a surface is sampled, and from where descents start.
struct Sampling {
    /// Samples along each side of a block.
    block_side: usize,
    /// A local minimum among the samples that is farther than the nearest sample by so many distances of neighbouring samples is
    /// not tried.
    behind_spacings: f64,
    /// Samples along one direction, at the least.
    least_each_way: usize,
    /// Samples in a cell between breaks, at the least.
    least_in_cell: usize,
    /// Samples of a surface between its breaks, at the most.
    max_samples: usize,
    /// Even cells along each direction of a surface with three sides, at the most.
    max_even_cells: f64,
    /// Points from whose samples a descent starts, at the most.
    max_starts: usize,
}

const SAMPLING: Sampling = Sampling {
    block_side: 8,
    behind_spacings: 2.0,
    least_each_way: 24,
    least_in_cell: 4,
    max_samples: 1 << 18,
    max_even_cells: 127.0,
    max_starts: 64,
};

/// Points of a surface at the crossings of columns and rows of its square.
#[derive(Clone, Debug, Default)]
pub(crate) struct Samples {
    columns: SampleLine,
    rows: SampleLine,
    points: Vec<DVec3>,
    blocks: Vec<Block>,
}

/// Where the square is sampled along one direction.
#[derive(Clone, Debug, Default)]
struct SampleLine {
    at: Vec<f64>,
    /// Between which creases each of them lies, as places among `stops`: of the interval before and of the one after, which differ on a
    /// crease only.
    intervals: Vec<(usize, usize)>,
    /// Creases, with 0 and 1.
    stops: Vec<f64>,
    /// The places among `at` of the stops.
    ends: Vec<usize>,
    /// Whether the last one is the first one again.
    closed: bool,
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

/// Where a descent starts, and the rectangle without creases inside that it stays in: ends of x, then of y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub place: (f64, f64),
    pub within: [(f64, f64); 2],
    /// A descent from here ends no nearer than that, by the distances of samples beside it.
    pub least: f64,
}

impl SampleLine {
    fn new(at: Vec<f64>, creases: &[f64], closed: bool) -> Self {
        let (mut stops, mut ends) = (vec![0.0], vec![0]);
        for crease in creases {
            let near = at.partition_point(|x| *x < crease - EPSILON);
            if near > 0 && near + 1 < at.len() && (at[near] - crease).abs() <= EPSILON {
                stops.push(at[near]);
                ends.push(near);
            }
        }
        stops.push(1.0);
        ends.push(at.len().saturating_sub(1));
        let interval = |k: usize| {
            let after = ends[1..ends.len() - 1].partition_point(|end| *end <= k);
            let before = ends[1..ends.len() - 1].partition_point(|end| *end < k);
            (before, after)
        };
        let intervals = (0..at.len()).map(interval).collect();
        Self { at, intervals, stops, ends, closed }
    }

    /// The intervals that a sample belongs to.
    fn of(&self, k: usize) -> impl Iterator<Item = usize> + use<> {
        let (before, after) = self.intervals[k];
        before..=after
    }

    /// The samples beside one in an interval, and itself.
    fn beside(&self, k: usize, interval: usize) -> std::ops::RangeInclusive<usize> {
        k.saturating_sub(1).max(self.ends[interval])..=(k + 1).min(self.ends[interval + 1])
    }

    fn within(&self, interval: usize) -> (f64, f64) {
        (self.stops[interval], self.stops[interval + 1])
    }

    /// What follows an interval at its end where `x` is: the place there and its interval, beyond a crease or a seam.
    fn beyond(&self, x: f64, (low, high): (f64, f64)) -> Option<(f64, (f64, f64))> {
        let n = self.stops.len();
        let interval = |k: usize| (self.stops[k], self.stops[k + 1]);
        let at = |x: f64| self.stops.iter().position(|stop| *stop == x);
        if x == high {
            at(high).filter(|k| k + 1 < n).map(|k| (x, interval(k))).or(self.closed.then(|| (0.0, interval(0))))
        } else if x == low {
            at(low).filter(|k| *k > 0).map(|k| (x, interval(k - 1))).or(self.closed.then(|| (1.0, interval(n - 2))))
        } else {
            None
        }
    }
}

impl Block {
    /// The places of its samples among all, `nx` a row.
    fn samples(&self, nx: usize) -> impl Iterator<Item = usize> + use<> {
        let columns = self.columns;
        (self.rows.0..self.rows.1).flat_map(move |j| (columns.0..columns.1).map(move |i| j * nx + i))
    }
}

impl Samples {
    /// Samples a surface with a square or a triangle of parameters.
    pub fn new(surface: &Surface) -> Self {
        let (xs, ys) = grid(surface);
        let points: Vec<DVec3> = surface.square_jets(&xs, &ys).iter().map(|jet| jet.p).collect();
        let square = surface.domain() == Domain::Square;
        let (us, vs) = if square { surface.kinks() } else { (&[][..], &[][..]) };
        let (closed_u, closed_v) = if square { surface.closed() } else { (false, false) };
        let (columns, rows) = (SampleLine::new(xs, us, closed_u), SampleLine::new(ys, vs, closed_v));
        let mut made = Self { columns, rows, points, blocks: Vec::new() };
        let (nx, ny) = made.size();
        for j in (0..ny).step_by(SAMPLING.block_side) {
            for i in (0..nx).step_by(SAMPLING.block_side) {
                job::poll();
                let (rows, columns) = ((j, (j + SAMPLING.block_side).min(ny)), (i, (i + SAMPLING.block_side).min(nx)));
                let mut block = Block { rows, columns, around: Box3::EMPTY, reach: 0.0 };
                for k in block.samples(nx) {
                    block.around = block.around.with(made.points[k]);
                    block.reach = block.reach.max(made.reach(k));
                }
                made.blocks.push(block);
            }
        }
        made
    }

    fn size(&self) -> (usize, usize) {
        (self.columns.at.len(), self.rows.at.len())
    }

    /// How many they are.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The places of all samples in the square, row by row.
    pub fn places(&self) -> impl Iterator<Item = (f64, f64)> {
        self.rows.at.iter().flat_map(|y| self.columns.at.iter().map(|x| (*x, *y)))
    }

    /// The farthest of the samples beside one.
    fn reach(&self, k: usize) -> f64 {
        let (nx, ny) = self.size();
        let (i, j) = (k % nx, k / nx);
        let beside = [(i > 0, k.wrapping_sub(1)), (i + 1 < nx, k + 1), (j > 0, k.wrapping_sub(nx)), (j + 1 < ny, k + nx)];
        let apart = beside.into_iter().filter(|b| b.0).map(|(_, n)| self.points[n].distance_squared(self.points[k]));
        apart.fold(0.0, f64::max).sqrt()
    }

    /// The rectangles between creases in which a sample lies, as intervals of columns and rows.
    fn rectangles(&self, k: usize) -> impl Iterator<Item = (usize, usize)> {
        let (i, j) = (k % self.columns.at.len(), k / self.columns.at.len());
        self.rows.of(j).flat_map(move |r| self.columns.of(i).map(move |c| (c, r)))
    }

    /// Where descents to the point nearest to `p` start, the nearest first: at local minima among the samples of each rectangle between
    /// creases that may lead to it, of those samples alone that `kept` says yes of.
    pub fn starts(&self, p: DVec3, kept: Option<&[bool]>) -> Vec<Start> {
        let far = |k: usize| if kept.is_none_or(|kept| kept[k]) { self.points[k].distance_squared(p) } else { f64::INFINITY };
        // Samples of one point count as one: of a seam, whose two sides are both tried, and of a pole.
        let nx = self.columns.at.len();
        let (mut starts, mut points, mut last, mut poles) = (Vec::new(), 0, None, Vec::new());
        for (k, rectangle) in self.minima(p, &far) {
            let again = last.is_some_and(|l: DVec3| l.distance_squared(self.points[k]) <= EPSILON * EPSILON * l.length_squared());
            if !again {
                (points, last) = (points + 1, Some(self.points[k]));
            }
            if points > SAMPLING.max_starts {
                break;
            }
            let least = far(k).sqrt() - SAMPLING.behind_spacings * self.reach(k);
            let mut add = |k: usize, (c, r): (usize, usize)| {
                let place = (self.columns.at[k % nx], self.rows.at[k / nx]);
                starts.push(Start { place, within: [self.columns.within(c), self.rows.within(r)], least });
            };
            add(k, rectangle);
            if !poles.contains(&k) {
                let mut round = self.round_pole(k, &far, &mut poles);
                round.sort_unstable();
                round.dedup();
                round.into_iter().for_each(|n| self.rectangles(n).for_each(|r| add(n, r)));
            }
        }
        starts
    }

    /// Where a descent that ended at the border of its rectangle may go on: in those beyond it.
    pub fn beyond(&self, (x, y): (f64, f64), within: [(f64, f64); 2]) -> impl Iterator<Item = Start> {
        let across =
            self.columns.beyond(x, within[0]).map(|(x, columns)| Start { place: (x, y), within: [columns, within[1]], least: 0.0 });
        let along = self.rows.beyond(y, within[1]).map(|(y, rows)| Start { place: (x, y), within: [within[0], rows], least: 0.0 });
        across.into_iter().chain(along)
    }

    /// Local minima among the samples of a rectangle, with the rectangle, that may lead to the nearest point, the nearest first.
    fn minima(&self, p: DVec3, far: &impl Fn(usize) -> f64) -> Vec<(usize, (usize, usize))> {
        let nx = self.columns.at.len();
        let apart: Vec<f64> = self.blocks.iter().map(|block| block.around.distance_squared(p)).collect();
        let Some(first) = (0..apart.len()).min_by(|a, b| apart[*a].total_cmp(&apart[*b])) else { return Vec::new() };
        let mut best = f64::INFINITY;
        for b in std::iter::once(first).chain(0..apart.len()) {
            if apart[b] < best {
                best = self.blocks[b].samples(nx).map(far).fold(best, f64::min);
            }
        }
        let nearest = best.sqrt();
        let lowest = |k: usize, (c, r): (usize, usize)| {
            let (columns, rows) = (self.columns.beside(k % nx, c), self.rows.beside(k / nx, r));
            rows.into_iter().all(|j| columns.clone().all(|i| far(k) <= far(j * nx + i)))
        };
        let mut minima = Vec::new();
        for (block, apart) in self.blocks.iter().zip(&apart) {
            if apart.sqrt() > nearest + SAMPLING.behind_spacings * block.reach {
                continue;
            }
            for k in block.samples(nx).filter(|k| far(*k).sqrt() <= nearest + SAMPLING.behind_spacings * self.reach(*k)) {
                minima.extend(self.rectangles(k).filter(|r| lowest(k, *r)).map(|r| (k, r)));
            }
        }
        minima.sort_by(|a, b| far(a.0).total_cmp(&far(b.0)).then(a.cmp(b)));
        minima
    }

    /// Where a sample is one of a pole, at which samples beside one another in a row or column coincide (all of them, or an interval):
    /// the local minima of the rows beside, and the samples next to the interval. From the pole itself no descent can turn into the
    /// direction that leads to the point. The samples of the pole are added to `poles`.
    fn round_pole(&self, k: usize, far: &impl Fn(usize) -> f64, poles: &mut Vec<usize>) -> Vec<usize> {
        let (nx, ny) = self.size();
        let (i, j) = (k % nx, k / nx);
        let least = EPSILON * (self.points[k].length() + self.reach(k));
        let same = |n: usize| self.points[n].distance(self.points[k]) <= least;
        let beside = |at: usize, of: usize| [at.checked_sub(1), (at + 1 < of).then_some(at + 1)].into_iter().flatten();
        let mut starts = Vec::new();
        let mut look = |at: usize, of: usize, line: usize, lines: usize, place: &dyn Fn(usize, usize) -> usize| {
            let first = (0..at).rev().take_while(|n| same(place(*n, line))).last().unwrap_or(at);
            let last = (at + 1..of).take_while(|n| same(place(*n, line))).last().unwrap_or(at);
            if first == last {
                return;
            }
            poles.extend((first..=last).map(|n| place(n, line)));
            let (low, high) = (first.saturating_sub(1), (last + 1).min(of - 1));
            starts.extend([low, high].into_iter().filter(|n| !(first..=last).contains(n)).map(|n| place(n, line)));
            for line in beside(line, lines) {
                let ring: Vec<usize> = (low..=high).map(|n| place(n, line)).collect();
                let lowest = |n: usize| beside(n, ring.len()).all(|m| far(ring[n]) <= far(ring[m]));
                starts.extend((0..ring.len()).filter(|n| lowest(*n)).map(|n| ring[n]));
            }
        };
        look(i, nx, j, ny, &|i, j| j * nx + i);
        look(j, ny, i, nx, &|j, i| j * nx + i);
        starts
    }
}

/// Where a surface is sampled: in each cell between its breaks, for a smooth curve may be sharply bent between two of its knots;
/// where both directions have very many, in the cells of its shape alone.
fn grid(surface: &Surface) -> (Vec<f64>, Vec<f64>) {
    let (us, vs) = surface.cells();
    let (mut xs, mut ys) = surface.breaks();
    if surface.domain() == Domain::Triangle {
        // Lines of constant u or v are none of the square there: even cells no wider than the narrowest between breaks.
        let gaps = |k: usize| match surface.side(k) {
            Side::Chain { chain, .. } => {
                let stops = [vec![0.0], chain_breaks(&chain), vec![1.0]].concat();
                stops.windows(2).map(|w| w[1] - w[0]).fold(1.0, f64::min)
            }
            _ => 1.0,
        };
        let narrowest = (0..surface.n_sides()).map(gaps).fold(1.0, f64::min);
        let cells = (1.0 / narrowest).ceil().min(SAMPLING.max_even_cells) as usize;
        xs = (1..cells).map(|k| k as f64 / cells as f64).collect();
        ys.clone_from(&xs);
    }
    xs.extend(&us);
    ys.extend(&vs);
    let (kinks_u, kinks_v) = surface.kinks();
    if surface.domain() == Domain::Square {
        xs.extend(kinks_u);
        ys.extend(kinks_v);
    }
    let (xs, ys) = (stations(&tidy(xs, EPSILON)), stations(&tidy(ys, EPSILON)));
    if xs.len().saturating_mul(ys.len()) <= SAMPLING.max_samples { (xs, ys) } else { (stations(&us), stations(&vs)) }
}

/// Sample stations between given inner ends of cells.
pub(crate) fn stations(inner: &[f64]) -> Vec<f64> {
    let stops = [&[0.0], inner, &[1.0]].concat();
    let each = SAMPLING.least_in_cell.max(SAMPLING.least_each_way.div_ceil(stops.len() - 1));
    let mut all = Vec::with_capacity(each * stops.len());
    for w in stops.windows(2) {
        all.extend((0..each).map(|k| w[0] + (w[1] - w[0]) * k as f64 / each as f64));
    }
    all.push(1.0);
    all
}
