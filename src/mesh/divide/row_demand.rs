//! How many steps the rows inside a face demand: sampled curvature first, the finished mesh decides (see `limits`).

use glam::DVec3;

use crate::base::math::widest_angle;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::request::limits::Limits;
use crate::mesh::size::border_spacing::SIZE_ROOM;
use crate::surface::{Domain, Surface};

/// Cells of the sample grid in each direction.
const CELLS: usize = 32;

/// Wanted steps in one direction of a face: for the size, and the least for chord and angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowDemand {
    /// For the size.
    pub size: f64,
    /// For chord error and angle.
    pub least: f64,
    /// Longest row, model units.
    pub length: f64,
    /// Largest second difference along the rows, normal part, a step of the sample grid: by which directions are refined.
    pub bend: f64,
}

impl RowDemand {
    /// The same for so many uneven rows, which are spaced for the limits already.
    pub fn of_uneven(self, rows: u32) -> Self {
        let rows = f64::from(rows);
        let share = rows / rows.max(self.least);
        Self { size: rows, least: 0.0, bend: self.bend * share * share, ..self }
    }
}

/// Demands along u and along v of a patch over the rectangle (a triangle: one for both).
pub fn demands(surface: &Surface, u: (f64, f64), v: (f64, f64), size: f64, limits: &Limits) -> [RowDemand; 2] {
    let n = CELLS + 1;
    let at = |(low, high): (f64, f64), k: usize| low + (high - low) * k as f64 / CELLS as f64;
    let mut points = vec![DVec3::ZERO; n * n];
    let triangle = surface.domain() == Domain::Triangle;
    if triangle {
        for j in 0..n {
            for i in 0..n - j {
                points[j * n + i] = surface.point(at(u, i), at(v, j));
            }
        }
    } else {
        let us: Vec<f64> = (0..n).map(|i| at(u, i)).collect();
        let vs: Vec<f64> = (0..n).map(|j| at(v, j)).collect();
        surface.grid(&us, &vs, &mut points);
    }
    let sample = Sample { points, triangle };
    let (mut a, mut b) = (RowDemand::default(), RowDemand::default());
    for k in 0..n {
        a.length = a.length.max(sample.line(k, true));
        b.length = b.length.max(sample.line(k, false));
    }
    let cells = CELLS as f64;
    for demand in [&mut a, &mut b] {
        demand.size = (demand.length - limits.near).max(0.0) / (SIZE_ROOM * size);
    }
    sample.bends(&mut a, &mut b, limits);
    if triangle {
        let slant = sample.slants(limits);
        let both = RowDemand {
            size: a.size.max(b.size).max((slant.length - limits.near).max(0.0) / (SIZE_ROOM * size)),
            least: a.least.max(b.least).max(slant.least),
            length: a.length.max(b.length).max(slant.length),
            bend: a.bend.max(b.bend).max(slant.bend),
        };
        return [both; 2];
    }
    if let Some(chord) = limits.chord {
        sample.balance(&mut a, &mut b, chord, cells);
    }
    [a, b]
}

struct Sample {
    points: Vec<DVec3>,
    triangle: bool,
}

impl Sample {
    const N: usize = CELLS + 1;

    fn point(&self, i: usize, j: usize) -> DVec3 {
        self.points[j * Self::N + i]
    }

    fn holds(&self, i: usize, j: usize) -> bool {
        !self.triangle && i < Self::N && j < Self::N || i + j < Self::N
    }

    /// Length of row (`along_u`) or column `k`.
    fn line(&self, k: usize, along_u: bool) -> f64 {
        let end = if self.triangle { CELLS - k } else { CELLS };
        let at = |n: usize| if along_u { self.point(n, k) } else { self.point(k, n) };
        (0..end).map(|n| at(n).distance(at(n + 1))).sum()
    }

    /// Unit normal at an inner sample.
    fn normal(&self, i: usize, j: usize) -> Option<DVec3> {
        let inside = i > 0 && j > 0 && self.holds(i + 1, j + 1);
        let n = inside.then(|| {
            (self.point(i + 1, j) - self.point(i - 1, j)).cross(self.point(i, j + 1) - self.point(i, j - 1)).normalize_or_zero()
        })?;
        (n != DVec3::ZERO).then_some(n)
    }

    /// Second differences with their normals: along u, along v.
    fn curvatures(&self) -> impl Iterator<Item = (usize, usize, f64, f64)> + '_ {
        (1..CELLS).flat_map(move |j| {
            (1..CELLS).filter_map(move |i| {
                let n = self.normal(i, j)?;
                let p = self.point(i, j);
                let uu = (self.point(i + 1, j) - 2.0 * p + self.point(i - 1, j)).dot(n);
                let vv = (self.point(i, j + 1) - 2.0 * p + self.point(i, j - 1)).dot(n);
                Some((i, j, uu, vv))
            })
        })
    }

    fn bends(&self, a: &mut RowDemand, b: &mut RowDemand, limits: &Limits) {
        let cells = CELLS as f64;
        for (_, _, uu, vv) in self.curvatures() {
            a.bend = a.bend.max(uu.abs());
            b.bend = b.bend.max(vv.abs());
        }
        if let Some(chord) = limits.chord {
            a.least = cells * (a.bend / (8.0 * chord)).sqrt();
            b.least = cells * (b.bend / (8.0 * chord)).sqrt();
        }
        if let Some(angle) = limits.angle {
            for (demand, along_u) in [(a, true), (b, false)] {
                let most = angle * (1.0 + limits.turn_room(demand.length, angle));
                demand.least = demand.least.max(self.least_for_turns(along_u, most));
            }
        }
    }

    /// The least number of even steps over no one of which the normals of the samples turn by more than `most`; of steps shorter
    /// than two cells as many as the cell takes over which it turns most.
    fn least_for_turns(&self, along_u: bool, most: f64) -> f64 {
        let row = |k: usize| (0..Self::N).map(|n| if along_u { self.normal(n, k) } else { self.normal(k, n) }).collect();
        let rows: Vec<Vec<Option<DVec3>>> = (1..CELLS).map(row).collect();
        let turn = |row: &[Option<DVec3>]| widest_angle(&row.iter().copied().flatten().collect::<Vec<_>>());
        let keeps = |n: &usize| {
            let step = |k: usize| (k * CELLS).div_ceil(*n)..=(k + 1) * CELLS / n;
            rows.iter().all(|row| (0..*n).all(|k| turn(&row[step(k)]) <= most))
        };
        let few = CELLS / 2;
        (1..=few).find(keeps).map_or_else(
            || {
                let worst = rows.iter().flat_map(|row| row.windows(2)).map(turn).fold(0.0, f64::max);
                (CELLS as f64 * worst / most).max((few + 1) as f64)
            },
            |n| n as f64,
        )
    }

    /// Lines of constant u + v of a triangle.
    fn slants(&self, limits: &Limits) -> RowDemand {
        let mut demand = RowDemand::default();
        for sum in 1..Self::N {
            let length = (0..sum).map(|j| self.point(sum - j, j).distance(self.point(sum - j - 1, j + 1))).sum();
            demand.length = demand.length.max(length);
            for j in 1..sum {
                let i = sum - j;
                if let Some(n) = self.normal(i, j) {
                    let second = self.point(i + 1, j - 1) - 2.0 * self.point(i, j) + self.point(i - 1, j + 1);
                    demand.bend = demand.bend.max(second.dot(n).abs());
                }
            }
        }
        if let Some(chord) = limits.chord {
            demand.least = CELLS as f64 * (demand.bend / (8.0 * chord)).sqrt();
        }
        demand
    }

    /// The middle of a cell is off by the bends of both directions: raises the one that adds more until their sum is kept.
    fn balance(&self, a: &mut RowDemand, b: &mut RowDemand, chord: f64, cells: f64) {
        let steps = |demand: &RowDemand| (demand.least.max(demand.size).max(1.0) - WHOLE_NUMBER).ceil();
        for _ in 0..CELLS {
            let share = |demand: &RowDemand| cells * cells / (8.0 * steps(demand) * steps(demand));
            let (fu, fv) = (share(a), share(b));
            let sums = self.curvatures().map(|(_, _, uu, vv)| (uu * fu, vv * fv));
            let Some((du, dv)) = sums.max_by(|x, y| (x.0 + x.1).abs().total_cmp(&(y.0 + y.1).abs())) else {
                return;
            };
            if (du + dv).abs() <= chord {
                return;
            }
            let (demand, other, own) = if du.abs() >= dv.abs() { (&mut *a, dv.abs(), du.abs()) } else { (&mut *b, du.abs(), dv.abs()) };
            // What is left for the larger one when the smaller stays; at least half.
            let left = (chord - other).max(0.5 * chord);
            let now = steps(demand);
            demand.least = (now * (own / left).sqrt()).max(now + 1.0);
        }
    }
}
