//! Surfaces through or near gridded points: bicubic nets with mean spans, or within a tolerance with fewest spans.
//!
//! Near points: least squares along the rows, then along the columns of what that gives, judged at every point. The direction whose
//! own error is larger gets knots where that is largest, until all points are near; then every knot goes that is not needed.

use glam::{DVec3, DVec4};

use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::fewest::{finer, swings, turns};
use crate::geometry::shapes::least_squares::{Cubics, Problem};
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::PointsFault;
use crate::surface::points::interpolate::{BorderEnds, Spans, mean_spans, on_spans};
use crate::surface::points::scatter_estimate::scatter;
use crate::surface::shapes::nurbs::NurbsSurface;

/// How near a surface comes to its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Near {
    /// Through all.
    All,
    /// No point farther than this, model units.
    Within(f64),
    /// Points that scatter about what is sought by this standard deviation: the mean square of the distances is at most
    /// [`SLACK`] times its square [Dierckx 1993, section 5.3].
    Noise(f64),
}

/// Settings of [`fit`].
#[derive(Clone, Debug, PartialEq)]
pub struct NetFitting {
    /// How near.
    pub near: Near,
    /// Borders of a surface through all points; the spacing of the parameters of any.
    pub ends: BorderEnds,
    /// Degree of a surface near the points, 1 to 3.
    pub degree: usize,
}

/// What the mean square of noise may come to, as a share of that expected.
pub const SLACK: f64 = 1.1;

/// A surface with at least this share of the points as control points follows their noise.
const FOLLOWS: f64 = 0.25;
/// Points that scatter by this many times what was stated had it stated too small.
const UNDERSTATED: f64 = 1.5;

/// The surface through or near `rows[j][i]`; rows run along u, one per v. Warnings too (W651, W678).
///
/// Fails as [`grid`](crate::surface::points::interpolate::grid) does.
pub fn fit(rows: &[Vec<DVec3>], how: &NetFitting, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let (spans, mut notes) = mean_spans(rows, how.ends.spacing, origin, tolerance)?;
    let near = match how.near {
        Near::All => None,
        near => NetSearch::new(rows, &spans, near, how.degree).nearest(),
    };
    let net = match near {
        Some(net) => net,
        None => on_spans(rows, &spans, &how.ends.tangents(rows, &spans)?),
    };
    if let Near::Noise(stated) = how.near
        && net.poles.len() as f64 >= FOLLOWS * (rows.len() * rows[0].len()) as f64
        && let Some((found, at)) = scatter(rows, &spans).filter(|(found, _)| *found > UNDERSTATED * stated)
    {
        notes.push(PointsFault::Scatter { surface: origin, found, stated, at, net: net.counts }.into());
    }
    Ok((net.surface(SurfaceKind::Fit, origin, tolerance), notes))
}

/// Points to come near to, with their parameters from 0 to 1.
struct NetSearch<'a> {
    rows: &'a [Vec<DVec3>],
    /// Their coordinates, row by row and column by column.
    numbers: [Vec<f64>; 2],
    parameters: (Vec<f64>, Vec<f64>),
    /// How much the points turn there, along rows and columns, row by row.
    turns: Vec<Vec<f64>>,
    within: f64,
    noisy: bool,
    degree: usize,
}

/// How far the lines of one direction are from their points.
struct Misses {
    /// At each parameter the largest, of noisy points the root of the mean square.
    largest: Vec<f64>,
    /// The root of the mean square of all.
    mean: f64,
}

impl Misses {
    fn worst(&self) -> f64 {
        self.largest.iter().copied().fold(0.0, f64::max)
    }
}

impl<'a> NetSearch<'a> {
    fn new(rows: &'a [Vec<DVec3>], spans: &Spans, near: Near, degree: usize) -> Self {
        let (within, noisy) = match near {
            Near::All => (0.0, false),
            Near::Within(within) => (within, false),
            Near::Noise(deviation) => (deviation * SLACK.sqrt(), true),
        };
        let columns: Vec<Vec<DVec3>> = (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
        let mut turned: Vec<Vec<f64>> = rows.iter().map(|row| turns(row, false)).collect();
        for (i, column) in columns.iter().enumerate() {
            turned.iter_mut().zip(turns(column, false)).for_each(|(row, turn)| row[i] = row[i].max(turn));
        }
        let shares = |spans: &[f64]| {
            let total: f64 = spans.iter().sum();
            let mut sum = 0.0;
            let inner = spans[..spans.len() - 1].iter().map(|span| {
                sum += span;
                sum / total
            });
            let inner: Vec<f64> = inner.collect();
            [0.0].into_iter().chain(inner).chain([1.0]).collect::<Vec<f64>>()
        };
        let flat = |lines: &[Vec<DVec3>]| lines.iter().flatten().flat_map(|p| p.to_array()).collect::<Vec<f64>>();
        let numbers = [flat(rows), flat(&columns)];
        Self { rows, numbers, parameters: (shares(&spans.0), shares(&spans.1)), turns: turned, within, noisy, degree }
    }

    /// The net of fewest spans that was found; none where that would be as many as there are points.
    fn nearest(&self) -> Option<NurbsSurface> {
        let one = || Cubics { breaks: vec![0.0, 1.0], closed: false, degree: self.degree };
        let (mut u, mut v) = (one(), one());
        let (mut off_u, mut off_v) = (self.own_off(&u, true)?, self.own_off(&v, false)?);
        loop {
            job::poll();
            // Both together are hardly nearer than half of what either is off alone.
            if 0.5 * off_u.mean.max(off_v.mean) <= self.within
                && let Some(net) = self.net(&u, &v).filter(|net| self.is_near(net))
            {
                return Some(self.spared(u, v, net));
            }
            let parted = |along_u: bool| {
                let (cubics, off, parameters) = if along_u { (&u, &off_u, &self.parameters.0) } else { (&v, &off_v, &self.parameters.1) };
                let mut more = finer(&cubics.breaks, parameters, &off.largest).map(|breaks| Cubics { breaks, ..cubics.clone() });
                more.find(|made| Problem::new(made, parameters).is_some()).map(|made| (along_u, made))
            };
            let worse = off_u.worst() >= off_v.worst();
            match parted(worse).or_else(|| parted(!worse))? {
                (true, made) => (off_u, u) = (self.own_off(&made, true)?, made),
                (false, made) => (off_v, v) = (self.own_off(&made, false)?, made),
            }
        }
    }

    /// The points as lines across one direction, and how many numbers each has.
    fn across(&self, along_u: bool) -> (&[f64], usize, &[f64]) {
        let (m, n) = (self.rows.len(), self.rows[0].len());
        if along_u { (&self.numbers[1], 3 * m, &self.parameters.0) } else { (&self.numbers[0], 3 * n, &self.parameters.1) }
    }

    /// How far lines along u, or along v, are from their points by themselves.
    fn own_off(&self, cubics: &Cubics, along_u: bool) -> Option<Misses> {
        let (numbers, width, parameters) = self.across(along_u);
        let problem = Problem::new(cubics, parameters)?;
        let poles = problem.solve_all(numbers, width);
        let mut at = vec![0.0; width];
        let mut squares = 0.0;
        let mut largest = Vec::with_capacity(parameters.len());
        for (k, points) in numbers.chunks_exact(width).enumerate() {
            problem.put(k, &poles, &mut at);
            let off = at.chunks_exact(3).zip(points.chunks_exact(3));
            let off = off.map(|(a, b)| (0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis])).sum::<f64>());
            let (sum, most) = off.fold((0.0, 0.0_f64), |(sum, most), square| (sum + square, most.max(square)));
            squares += sum;
            largest.push(if self.noisy { (sum * 3.0 / width as f64).sqrt() } else { most.sqrt() });
        }
        let count = self.rows.len() * self.rows[0].len();
        Some(Misses { largest, mean: (squares / count as f64).sqrt() })
    }

    /// The points solved along one direction, as lines across the other one.
    fn half(&self, cubics: &Cubics, along_u: bool) -> Option<Vec<f64>> {
        let (numbers, width, parameters) = self.across(along_u);
        Some(transposed(&Problem::new(cubics, parameters)?.solve_all(numbers, width), width / 3))
    }

    fn net(&self, u: &Cubics, v: &Cubics) -> Option<NurbsSurface> {
        self.whole(&self.half(u, true)?, u, v, false)
    }

    /// The net of what is solved along the other direction already.
    fn whole(&self, half: &[f64], u: &Cubics, v: &Cubics, along_u: bool) -> Option<NurbsSurface> {
        let (nu, nv) = (u.poles(), v.poles());
        let problem = if along_u { Problem::new(u, &self.parameters.0)? } else { Problem::new(v, &self.parameters.1)? };
        let solved = problem.solve_all(half, 3 * if along_u { nv } else { nu });
        let numbers = if along_u { transposed(&solved, nv) } else { solved };
        let poles = numbers.chunks_exact(3).map(|p| DVec4::new(p[0], p[1], p[2], 1.0)).collect();
        Some(NurbsSurface { degree: (u.degree, v.degree), knots: (u.knots(), v.knots()), poles, counts: (nu, nv) })
    }

    /// Whether all points are within the distance of their own places on the net, and nothing swings out between them.
    fn is_near(&self, net: &NurbsSurface) -> bool {
        if self.noisy { self.scatter(net) <= self.within } else { self.off(net) <= self.within && self.is_calm(net) }
    }

    fn at(net: &NurbsSurface, u: f64, v: f64) -> DVec3 {
        net.jet(u, v, (OneSided::After, OneSided::After)).p
    }

    /// Largest distance of a point from its own place on the net: no less than from the surface.
    fn off(&self, net: &NurbsSurface) -> f64 {
        let places =
            self.rows.iter().zip(&self.parameters.1).flat_map(|(row, v)| row.iter().zip(&self.parameters.0).map(move |(p, u)| (p, *u, *v)));
        places.map(|(p, u, v)| Self::at(net, u, v).distance(*p)).fold(0.0, f64::max)
    }

    /// The root of the mean square of the distances of the points from their own places on the net.
    fn scatter(&self, net: &NurbsSurface) -> f64 {
        let [along_u, along_v] = [(&net.knots.0, net.degree.0, &self.parameters.0), (&net.knots.1, net.degree.1, &self.parameters.1)].map(
            |(knots, degree, parameters)| {
                let breaks = knots[degree..knots.len() - degree].to_vec();
                let splines = Cubics { breaks, closed: false, degree };
                parameters.iter().map(|t| splines.shares(knots, *t)).collect::<Vec<_>>()
            },
        );
        let mut line = vec![DVec3::ZERO; net.counts.0];
        let mut squares = 0.0;
        for (row, (first_v, shares_v)) in self.rows.iter().zip(&along_v) {
            for (i, pole) in line.iter_mut().enumerate() {
                *pole = (0..=net.degree.1).map(|l| net.poles[(first_v + l) * net.counts.0 + i].truncate() * shares_v[l]).sum();
            }
            for (p, (first, shares)) in row.iter().zip(&along_u) {
                let at: DVec3 = (0..=net.degree.0).map(|k| line[first + k] * shares[k]).sum();
                squares += at.distance_squared(*p);
            }
        }
        (squares / (self.rows.len() * self.rows[0].len()) as f64).sqrt()
    }

    /// Whether it runs near the middle of neighbours, along u, along v and across, as far as these let it.
    fn is_calm(&self, net: &NurbsSurface) -> bool {
        let (us, vs) = &self.parameters;
        let middle = |all: &[f64], i: usize, on: usize| 0.5 * (all[i] + all[i + on]);
        let calm = |i: usize, j: usize| {
            [(1, 0), (0, 1), (1, 1)].into_iter().filter(|(k, l)| i + k < us.len() && j + l < vs.len()).all(|(k, l)| {
                let corners = [(i, j), (i + k, j), (i, j + l), (i + k, j + l)];
                let beside = corners.map(|(i, j)| self.rows[j][i]).into_iter().sum::<DVec3>() / 4.0;
                let turn = corners.map(|(i, j)| self.turns[j][i]).into_iter().fold(0.0, f64::max);
                !swings(Self::at(net, middle(us, i, k), middle(vs, j, l)), beside, turn, self.within)
            })
        };
        (0..vs.len()).all(|j| (0..us.len()).all(|i| calm(i, j)))
    }

    /// Without the knots that are not needed, of either direction.
    fn spared(&self, mut u: Cubics, mut v: Cubics, mut net: NurbsSurface) -> NurbsSurface {
        for along_u in [true, false] {
            let Some(half) = (if along_u { self.half(&v, false) } else { self.half(&u, true) }) else { return net };
            let mut i = 1;
            loop {
                job::poll();
                let old = if along_u { &u } else { &v };
                if i + 1 >= old.breaks.len() {
                    break;
                }
                let mut fewer = old.clone();
                fewer.breaks.remove(i);
                let tried = if along_u { self.whole(&half, &fewer, &v, true) } else { self.whole(&half, &u, &fewer, false) };
                match tried.filter(|net| self.is_near(net)) {
                    Some(better) => {
                        net = better;
                        *(if along_u { &mut u } else { &mut v }) = fewer;
                    }
                    None => i += 1,
                }
            }
        }
        net
    }
}

/// Points in rows of a length, by columns.
fn transposed(numbers: &[f64], length: usize) -> Vec<f64> {
    let rows = numbers.len() / (3 * length);
    let places = (0..length).flat_map(|i| (0..rows).map(move |j| 3 * (j * length + i)));
    places.flat_map(|k| [numbers[k], numbers[k + 1], numbers[k + 2]]).collect()
}
