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
use crate::geometry::construct::fit_curve::{bessel, bessel_last};
use crate::geometry::shapes::least_squares::{Cubics, DEGREE, Problem};
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::points::interpolate::{Spans, Tangents, fitted, mean_spans};
use crate::surface::shapes::nurbs::NurbsSurface;

/// The surface through `rows[j][i]`, or within `within` model units of each point; rows run along u, one per v. Warnings too (W651).
///
/// Through all points its cross tangents at the border are those of parabolas. Fails as [`grid`](crate::surface::points::interpolate::grid) does.
pub fn fit(rows: &[Vec<DVec3>], within: Option<f64>, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let (spans, _) = mean_spans(rows, origin, tolerance)?;
    let (whole, notes) = fitted(rows, &parabolic(rows, &spans), origin, tolerance)?;
    let net = within.and_then(|within| NetSearch::new(rows, &spans, within).nearest()).unwrap_or(whole);
    Ok((net.surface(SurfaceKind::Fit, origin, tolerance), notes))
}

/// Derivatives across the border from parabolas through the three points next to it.
fn parabolic(rows: &[Vec<DVec3>], spans: &Spans) -> Tangents {
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<DVec3>>();
    let across_u: (Vec<DVec3>, Vec<DVec3>) = rows.iter().map(|row| (bessel(row, &spans.0), bessel_last(row, &spans.0))).unzip();
    let columns = (0..rows[0].len()).map(|i| (bessel(&column(i), &spans.1), bessel_last(&column(i), &spans.1)));
    let across_v: (Vec<DVec3>, Vec<DVec3>) = columns.unzip();
    let twists = [
        bessel(&across_u.0, &spans.1),
        bessel(&across_u.1, &spans.1),
        bessel_last(&across_u.0, &spans.1),
        bessel_last(&across_u.1, &spans.1),
    ];
    Tangents { across_u: Some(across_u), across_v: Some(across_v), twists }
}

/// Points to come near to, with their parameters from 0 to 1.
struct NetSearch<'a> {
    rows: &'a [Vec<DVec3>],
    columns: Vec<Vec<DVec3>>,
    parameters: (Vec<f64>, Vec<f64>),
    /// How much the points turn there, along rows and columns, row by row.
    turns: Vec<Vec<f64>>,
    within: f64,
}

/// How far the lines of one direction are from their points.
struct Misses {
    /// At each parameter.
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
    fn new(rows: &'a [Vec<DVec3>], spans: &Spans, within: f64) -> Self {
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
        Self { rows, columns, parameters: (shares(&spans.0), shares(&spans.1)), turns: turned, within }
    }

    /// The net of fewest spans that was found; none where that would be as many as there are points.
    fn nearest(&self) -> Option<NurbsSurface> {
        let one = || Cubics { breaks: vec![0.0, 1.0], closed: false };
        let (mut u, mut v) = (one(), one());
        loop {
            job::poll();
            let (off_u, off_v) = (self.own_off(&u, true)?, self.own_off(&v, false)?);
            // Both together are hardly nearer than half of what either is off alone.
            if 0.5 * off_u.mean.max(off_v.mean) <= self.within
                && let Some(net) = self.net(&u, &v).filter(|net| self.is_near(net))
            {
                return Some(self.spared(u, v, net));
            }
            let parted = |along_u: bool| {
                let (cubics, off, parameters) = if along_u { (&u, &off_u, &self.parameters.0) } else { (&v, &off_v, &self.parameters.1) };
                let mut more = finer(&cubics.breaks, parameters, &off.largest).map(|breaks| Cubics { breaks, closed: false });
                more.find(|made| Problem::new(made, parameters).is_some()).map(|made| (along_u, made))
            };
            let worse = off_u.worst() >= off_v.worst();
            match parted(worse).or_else(|| parted(!worse))? {
                (true, made) => u = made,
                (false, made) => v = made,
            }
        }
    }

    /// How far lines along u, or along v, are from their points by themselves.
    fn own_off(&self, cubics: &Cubics, along_u: bool) -> Option<Misses> {
        let (lines, parameters) = if along_u { (self.rows, &self.parameters.0) } else { (&self.columns[..], &self.parameters.1) };
        let problem = Problem::new(cubics, parameters)?;
        let knots = cubics.knots();
        let mut largest = vec![0.0_f64; parameters.len()];
        let mut squares = 0.0;
        for line in lines {
            let poles = problem.solve(line);
            for ((largest, t), p) in largest.iter_mut().zip(parameters).zip(line) {
                let (first, shares) = cubics.shares(&knots, *t);
                let at: DVec3 = (0..=DEGREE).map(|k| poles[first + k] * shares[k]).sum();
                let off = at.distance(*p);
                *largest = largest.max(off);
                squares += off * off;
            }
        }
        let count = (lines.len() * parameters.len()) as f64;
        Some(Misses { largest, mean: (squares / count).sqrt() })
    }

    fn net(&self, u: &Cubics, v: &Cubics) -> Option<NurbsSurface> {
        let (along_u, along_v) = (Problem::new(u, &self.parameters.0)?, Problem::new(v, &self.parameters.1)?);
        let lines: Vec<Vec<DVec3>> = self.rows.iter().map(|row| along_u.solve(row)).collect();
        let (nu, nv) = (u.poles(), v.poles());
        let mut poles = vec![DVec4::ZERO; nu * nv];
        for i in 0..nu {
            let column: Vec<DVec3> = lines.iter().map(|line| line[i]).collect();
            for (j, p) in along_v.solve(&column).into_iter().enumerate() {
                poles[j * nu + i] = p.extend(1.0);
            }
        }
        Some(NurbsSurface { degree: (DEGREE, DEGREE), knots: (u.knots(), v.knots()), poles, counts: (nu, nv) })
    }

    /// Whether all points are within the distance of their own places on the net, and nothing swings out between them.
    fn is_near(&self, net: &NurbsSurface) -> bool {
        self.off(net) <= self.within && self.is_calm(net)
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
            let mut i = 1;
            loop {
                job::poll();
                let old = if along_u { &u } else { &v };
                if i + 1 >= old.breaks.len() {
                    break;
                }
                let mut fewer = old.clone();
                fewer.breaks.remove(i);
                let tried = if along_u { self.net(&fewer, &v) } else { self.net(&u, &fewer) };
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
