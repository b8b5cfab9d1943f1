//! A surface through gridded points: the tensor C2 cubic with mean spans.

use glam::{DVec3, DVec4};

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::spline::{open_slopes, through};
use crate::geometry::data::fault::CurveFault;
use crate::geometry::shapes::nurbs::projected;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::faults::SurfaceFault;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Chord fractions of a row may differ from the mean by this factor before a word is due.
const UNEVEN: f64 = 3.0;

/// Derivatives across the border of a grid, with respect to the arc-like parameter of mean spans, and corner twists.
#[derive(Clone, Debug, Default)]
pub struct Tangents {
    /// Per row: ∂/∂u at its first and at its last point.
    pub across_u: Option<(Vec<DVec3>, Vec<DVec3>)>,
    /// Per column: ∂/∂v at its first and at its last point.
    pub across_v: Option<(Vec<DVec3>, Vec<DVec3>)>,
    /// Mixed derivatives at (first, first), (last, first), (first, last), (last, last), u first; zero unless given.
    pub twists: [DVec3; 4],
}

/// The surface through `rows[j][i]` (rows along u, one per v), natural ends: no second derivative across the border, as
/// `spline` has it. Returns warnings too (W651).
///
/// Spans are means over the grid: all rows share one parameter. A border row of one point is a pole. Fails with E402
/// below 2×2 points, E306 for rows of different length, E403 where an inner row or two whole rows coincide.
pub fn grid(rows: &[Vec<DVec3>], origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let (net, notes) = fitted(rows, &Tangents::default(), origin, tolerance)?;
    Ok((net.surface(SurfaceKind::Grid, origin, tolerance), notes))
}

/// The bicubic net of [`grid`], with derivatives across the border where they are given.
pub fn fitted(rows: &[Vec<DVec3>], tangents: &Tangents, origin: Origin, tolerance: &Tolerance) -> Result<(NurbsSurface, Vec<Fault>)> {
    let ((spans_u, spans_v), notes) = mean_spans(rows, origin, tolerance)?;
    let (nu, nv) = (rows[0].len(), rows.len());

    // First along u, row by row; the border derivatives in v travel as two more rows.
    let twist = |k: usize| tangents.across_u.is_some().then_some(tangents.twists[k]);
    let fit_u = |points: &[DVec3], ends: [Option<DVec3>; 2]| poles(points, &spans_u, ends);
    let across_u = |j: usize| tangents.across_u.as_ref().map_or([None, None], |(first, last)| [Some(first[j]), Some(last[j])]);
    let lines: Vec<Vec<DVec3>> = (0..nv).map(|j| fit_u(&rows[j], across_u(j))).collect();
    let ends_v = tangents.across_v.as_ref().map(|(first, last)| (fit_u(first, [twist(0), twist(1)]), fit_u(last, [twist(2), twist(3)])));
    // Then along v through each column of the poles.
    let (mu, mv) = (nu + 2, nv + 2);
    let mut net = vec![DVec4::ZERO; mu * mv];
    for i in 0..mu {
        job::poll();
        let column: Vec<DVec3> = lines.iter().map(|line| line[i]).collect();
        let ends = ends_v.as_ref().map_or([None, None], |(first, last)| [Some(first[i]), Some(last[i])]);
        for (j, p) in poles(&column, &spans_v, ends).into_iter().enumerate() {
            net[j * mu + i] = p.extend(1.0);
        }
    }
    let knots = (unit_knots(&spans_u), unit_knots(&spans_v));
    Ok((NurbsSurface { degree: (3, 3), knots, poles: net, counts: (mu, mv) }, notes))
}

/// Spans along u and along v.
pub(crate) type Spans = (Vec<f64>, Vec<f64>);

/// Mean spans along u and along v of a grid; warnings too (W651). Fails as [`grid`] does.
pub(crate) fn mean_spans(rows: &[Vec<DVec3>], origin: Origin, tolerance: &Tolerance) -> Result<(Spans, Vec<Fault>)> {
    let (nu, nv) = (rows.first().map_or(0, Vec::len), rows.len());
    if nu < 2 || nv < 2 {
        let (what, given) = ("each direction of a grid", nu.min(nv));
        return Err(CurveFault::TooFewPoints { of: origin, what, argument: "points", needed: 2, given }.into());
    }
    if let Some(j) = rows.iter().position(|row| row.len() != nu) {
        let (found, range) = (format!("{} in row {j}", rows[j].len()), format!("rows of {nu} points each, like the first one"));
        return Err(ValueFault::OutsideRange { argument: "points", found, range }.into());
    }
    let columns: Vec<Vec<DVec3>> = (0..nu).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
    let (spans_u, mut notes) = spans(rows, "row", origin, tolerance)?;
    let (spans_v, more) = spans(&columns, "column", origin, tolerance)?;
    notes.extend(more);
    Ok(((spans_u, spans_v), notes))
}

/// Poles of the C2 cubic through points on given spans.
fn poles(points: &[DVec3], spans: &[f64], ends: [Option<DVec3>; 2]) -> Vec<DVec3> {
    let curve = through(points, spans, &open_slopes(points, spans, ends));
    curve.poles.iter().map(|q| projected(*q)).collect()
}

/// Knots x₀⁴, x₁, …, xₙ⁴ over 0…1.
fn unit_knots(spans: &[f64]) -> Vec<f64> {
    let total: f64 = spans.iter().sum();
    let mut x = 0.0;
    let mut knots = vec![0.0; 4];
    for span in &spans[..spans.len() - 1] {
        x += span;
        knots.push(x / total);
    }
    knots.extend([1.0; 4]);
    knots
}

/// Mean chord lengths between neighbouring places of all lines; E403 where all lines stand still, W651 where one line is
/// spaced much unlike the mean.
fn spans(lines: &[Vec<DVec3>], word: &'static str, origin: Origin, tolerance: &Tolerance) -> Result<(Vec<f64>, Vec<Fault>)> {
    let n = lines[0].len() - 1;
    let chord = |line: &[DVec3], i: usize| line[i].distance(line[i + 1]);
    let length = |line: &[DVec3]| (0..n).map(|i| chord(line, i)).sum::<f64>();
    let collapsed: Vec<bool> = lines.iter().map(|line| line.iter().all(|p| tolerance.same_point(line[0], *p))).collect();
    for (k, gone) in collapsed.iter().enumerate() {
        if *gone && (k != 0 && k + 1 != lines.len() || lines.len() == 2 && collapsed[0] && collapsed[1]) {
            let at = lines[k][0];
            return Err(CurveFault::DuplicatePoints {
                of: origin,
                index: k * (n + 1),
                count: lines.len() * (n + 1),
                at,
                distance: 0.0,
                tolerance: tolerance.point,
            }
            .into());
        }
    }
    let live: Vec<usize> = (0..lines.len()).filter(|k| !collapsed[*k]).collect();
    let mean: Vec<f64> = (0..n).map(|i| live.iter().map(|&k| chord(&lines[k], i)).sum::<f64>() / live.len() as f64).collect();
    if let Some(i) = (0..n).find(|&i| mean[i] <= tolerance.point) {
        let at = lines[0][i];
        return Err(
            CurveFault::DuplicatePoints { of: origin, index: i, count: n + 1, at, distance: mean[i], tolerance: tolerance.point }.into()
        );
    }
    let total: f64 = mean.iter().sum();
    let mut worst: Option<(f64, usize, DVec3)> = None;
    for &k in &live {
        job::poll();
        let whole = length(&lines[k]);
        for i in 0..n {
            let (own, common) = (chord(&lines[k], i) / whole, mean[i] / total);
            let ratio = (own / common).max(common / own);
            if ratio > UNEVEN && worst.is_none_or(|(largest, ..)| ratio > largest) {
                worst = Some((ratio, k, lines[k][i]));
            }
        }
    }
    let note = worst.map(|(ratio, index, at)| SurfaceFault::GridUneven { surface: origin, line: word, index, ratio, at }.into());
    Ok((mean, note.into_iter().collect()))
}
