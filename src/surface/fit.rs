//! Surfaces through or near gridded points: bicubic nets of math notes §11.3, or within a tolerance with fewest spans.
//!
//! Near points: least squares along the rows, then along the columns of what that gives. Each direction gets knots where its own
//! error is largest; both together are then judged at every point.

use glam::{DVec3, DVec4};

use super::core::{Surface, SurfaceKind};
use super::interpolate::{Spans, Tangents, fitted, mean_spans};
use super::nurbs::NurbsSurface;
use super::rail::Lean;
use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::fit::{bessel, bessel_last};
use crate::geometry::least_squares::{Cubics, DEGREE, Problem};

/// The surface through `rows[j][i]`, or within `within` model units of each point; rows run along u, one per v. Warnings too (W651).
///
/// Through all points its cross tangents at the border are those of parabolas. Fails as [`super::grid`] does.
pub fn fit(rows: &[Vec<DVec3>], within: Option<f64>, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let (spans, _) = mean_spans(rows, origin, tolerance)?;
    let (whole, notes) = fitted(rows, &parabolic(rows, &spans), origin, tolerance)?;
    let net = within.and_then(|within| Search::new(rows, &spans, within).nearest()).unwrap_or(whole);
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
struct Search<'a> {
    rows: &'a [Vec<DVec3>],
    columns: Vec<Vec<DVec3>>,
    parameters: (Vec<f64>, Vec<f64>),
    within: f64,
}

impl<'a> Search<'a> {
    fn new(rows: &'a [Vec<DVec3>], spans: &Spans, within: f64) -> Self {
        let columns = (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
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
        Self { rows, columns, parameters: (shares(&spans.0), shares(&spans.1)), within }
    }

    /// The net of fewest spans that was found; none where that would be as many as there are points.
    fn nearest(&self) -> Option<NurbsSurface> {
        let one = || Cubics { breaks: vec![0.0, 1.0], closed: false };
        let (mut u, mut v) = (one(), one());
        let mut share = 0.5;
        let net = loop {
            job::look();
            // Each direction may use its share; together they are judged at the points.
            u = self.near(u, (self.rows, &self.parameters.0), share * self.within)?;
            v = self.near(v, (&self.columns, &self.parameters.1), share * self.within)?;
            match self.net(&u, &v) {
                Some(net) if self.off(&net) <= self.within => break net,
                _ => share *= 0.5,
            }
        };
        Some(self.spared(u, v, net))
    }

    /// Finer breaks until every line is within a distance of its points.
    fn near(&self, mut cubics: Cubics, (lines, parameters): (&[Vec<DVec3>], &[f64]), within: f64) -> Option<Cubics> {
        loop {
            job::look();
            let problem = Problem::new(&cubics, parameters)?;
            let knots = cubics.knots();
            let mut off = vec![0.0_f64; parameters.len()];
            for line in lines {
                let poles = problem.solve(line);
                for ((off, t), p) in off.iter_mut().zip(parameters).zip(line) {
                    let (first, shares) = cubics.shares(&knots, *t);
                    let at: DVec3 = (0..=DEGREE).map(|k| poles[first + k] * shares[k]).sum();
                    *off = off.max(at.distance(*p));
                }
            }
            if off.iter().all(|off| *off <= within) {
                return Some(cubics);
            }
            let at = knot_for(&cubics.breaks, parameters, &off, within)?;
            cubics.breaks.push(at);
            cubics.breaks.sort_by(f64::total_cmp);
        }
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

    /// Largest distance of a point from its own place on the net: no less than from the surface.
    fn off(&self, net: &NurbsSurface) -> f64 {
        let places =
            self.rows.iter().zip(&self.parameters.1).flat_map(|(row, v)| row.iter().zip(&self.parameters.0).map(move |(p, u)| (p, *u, *v)));
        places.map(|(p, u, v)| net.jet(u, v, (Lean::After, Lean::After)).p.distance(*p)).fold(0.0, f64::max)
    }

    /// Without the knots that are not needed, of either direction.
    fn spared(&self, mut u: Cubics, mut v: Cubics, mut net: NurbsSurface) -> NurbsSurface {
        for along_u in [true, false] {
            let mut i = 1;
            loop {
                job::look();
                let old = if along_u { &u } else { &v };
                if i + 1 >= old.breaks.len() {
                    break;
                }
                let mut fewer = old.clone();
                fewer.breaks.remove(i);
                let tried = if along_u { self.net(&fewer, &v) } else { self.net(&u, &fewer) };
                match tried.filter(|net| self.off(net) <= self.within) {
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

/// A knot in the worst span, with half of its squared error to either side; none where no span has data left to part.
fn knot_for(breaks: &[f64], parameters: &[f64], off: &[f64], within: f64) -> Option<f64> {
    let spans = breaks.windows(2).filter_map(|ends| {
        let low = parameters.partition_point(|t| *t < ends[0]);
        let high = parameters.partition_point(|t| *t < ends[1]).max(low);
        let worst = off[low..high].iter().copied().fold(0.0, f64::max);
        (worst > within && high - low >= 2).then_some((worst, low, high))
    });
    let (_, low, high) = spans.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let total: f64 = off[low..high].iter().map(|x| x * x).sum();
    let mut sum = 0.0;
    let passed = |x: &&f64| {
        sum += **x * **x;
        sum < 0.5 * total
    };
    let k = (low + off[low..high].iter().take_while(passed).count()).clamp(low + 1, high - 1);
    let at = 0.5 * (parameters[k - 1] + parameters[k]);
    breaks.iter().all(|x| *x != at).then_some(at)
}
