//! A surface through gridded points: the tensor C2 cubic with mean spans, in four steps: lines along u, border derivatives, lines along v.

use glam::{DVec3, DVec4};

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::spline::{Ends, Spacing, bessel, bessel_last, open_slopes, through};
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
    /// Per row: ∂/∂u at its first and at its last point; none: natural.
    pub across_u: [Option<Vec<DVec3>>; 2],
    /// Per column: ∂/∂v at its first and at its last point; none: natural.
    pub across_v: [Option<Vec<DVec3>>; 2],
    /// Mixed derivatives at (first, first), (last, first), (first, last), (last, last), u first; zero unless given.
    pub twists: [DVec3; 4],
}

/// How a surface leaves one border of its grid.
#[derive(Clone, Debug, PartialEq)]
pub enum BorderEnd {
    /// At each of its points as a spline does there; one direction serves all.
    Alike(Ends),
    /// In a direction at each of its points.
    Along(Vec<DVec3>),
}

/// Mixed derivatives at the corners of a grid, where no border is natural.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CornerTwists {
    /// Those that parabolas give to the derivatives along the border in u.
    #[default]
    Parabolas,
    /// None.
    Zero,
    /// Those of the bilinear Coons patches of the corner cells [Barnhill, Brown & Klucewicz 1978].
    Adini,
    /// Over local parameters, each from 0 to 1 in the corner cell; at (first, first), (last, first), (first, last), (last, last), u first.
    Given([DVec3; 4]),
}

/// Borders of a grid: at the first and the last u, at the first and the last v.
#[derive(Clone, Debug, PartialEq)]
pub struct BorderEnds {
    /// At the first and at the last u.
    pub u: [BorderEnd; 2],
    /// At the first and at the last v.
    pub v: [BorderEnd; 2],
    /// Spacing of the parameters.
    pub spacing: Spacing,
    /// Mixed derivatives at the corners.
    pub twists: CornerTwists,
}

impl BorderEnds {
    /// All borders alike, chord lengths.
    pub fn alike(ends: Ends) -> Self {
        let border = || BorderEnd::Alike(ends);
        Self { u: [border(), border()], v: [border(), border()], spacing: Spacing::Chord, twists: CornerTwists::Parabolas }
    }

    /// The derivatives across the border of a grid, and its twists.
    ///
    /// Fails with E306 for directions that are not as many as the points of their border, E301 for twists where a border is natural.
    pub fn tangents(&self, rows: &[Vec<DVec3>], spans: &Spans) -> Result<Tangents> {
        let columns: Vec<Vec<DVec3>> = (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
        let [u0, u1] = [across(&self.u[0], rows, &spans.0, ("start_u", true))?, across(&self.u[1], rows, &spans.0, ("end_u", false))?];
        let [v0, v1] =
            [across(&self.v[0], &columns, &spans.1, ("start_v", true))?, across(&self.v[1], &columns, &spans.1, ("end_v", false))?];
        let mut tangents = Tangents { across_u: [u0, u1], across_v: [v0, v1], twists: [DVec3::ZERO; 4] };
        tangents.twists = self.twists.of(rows, spans, &tangents)?;
        Ok(tangents)
    }
}

impl CornerTwists {
    fn of(self, rows: &[Vec<DVec3>], (spans_u, spans_v): &Spans, tangents: &Tangents) -> Result<[DVec3; 4]> {
        let sides = [&tangents.across_u[0], &tangents.across_u[1], &tangents.across_v[0], &tangents.across_v[1]];
        if self == Self::Parabolas {
            let twist = |k: usize| {
                let along = |d: &Vec<DVec3>| if k < 2 { bessel(d, spans_v) } else { bessel_last(d, spans_v) };
                tangents.across_u[k % 2].as_ref().map_or(DVec3::ZERO, along)
            };
            return Ok([0, 1, 2, 3].map(twist));
        }
        let [Some(u0), Some(u1), Some(v0), Some(v1)] = sides else {
            let what = "borders that are not natural, for their corners to have twists: `bessel` or directions at all four";
            let example = "grid(rows, start_u: bessel, end_u: bessel, start_v: bessel, end_v: bessel, twist: adini)";
            return Err(ValueFault::Missing { function: "grid", what, example }.into());
        };
        let (last_u, last_v) = (spans_u.len() - 1, spans_v.len() - 1);
        let steps = |k: usize| (spans_u[if k.is_multiple_of(2) { 0 } else { last_u }], spans_v[if k < 2 { 0 } else { last_v }]);
        Ok([0, 1, 2, 3].map(|k: usize| {
            let (h, l) = steps(k);
            // The corner cell: its lower column and row.
            let (i, j) = (if k.is_multiple_of(2) { 0 } else { last_u }, if k < 2 { 0 } else { last_v });
            match self {
                Self::Parabolas | Self::Zero => DVec3::ZERO,
                Self::Given(twists) => twists[k] / (h * l),
                Self::Adini => {
                    let (s, t) = (if k.is_multiple_of(2) { u0 } else { u1 }, if k < 2 { v0 } else { v1 });
                    let bilinear = rows[j + 1][i + 1] - rows[j + 1][i] - rows[j][i + 1] + rows[j][i];
                    (s[j + 1] - s[j]) / l + (t[i + 1] - t[i]) / h - bilinear / (h * l)
                }
            }
        }))
    }
}

/// The derivative across one border, at the end of each line.
fn across(end: &BorderEnd, lines: &[Vec<DVec3>], spans: &[f64], (argument, first): (&'static str, bool)) -> Result<Option<Vec<DVec3>>> {
    let at = |ends: Ends, line: &[DVec3]| if first { ends.first(line, spans) } else { ends.last(line, spans) };
    match end {
        BorderEnd::Alike(ends) => Ok(lines.iter().map(|line| at(*ends, line)).collect()),
        BorderEnd::Along(all) if all.len() == lines.len() => {
            Ok(lines.iter().zip(all).map(|(line, along)| at(Ends::Clamped(*along), line)).collect())
        }
        BorderEnd::Along(all) => {
            let (found, range) = (format!("{} directions", all.len()), format!("one direction, or {}", lines.len()));
            Err(ValueFault::OutsideRange { argument, found, range }.into())
        }
    }
}

/// The surface through `rows[j][i]` (rows along u, one per v), natural ends: no second derivative across the border, as
/// `spline` has it. Returns warnings too (W651).
///
/// Fails as [`grid_with`] does.
pub fn grid(rows: &[Vec<DVec3>], origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    grid_with(rows, &BorderEnds::alike(Ends::Natural), origin, tolerance)
}

/// The surface through `rows[j][i]` that leaves its borders in a given way. Returns warnings too (W651).
///
/// Spans are means over the grid: all rows share one parameter. A border row of one point is a pole. Fails with E402
/// below 2×2 points, E306 for rows of different length, E403 where an inner row or two whole rows coincide.
pub fn grid_with(rows: &[Vec<DVec3>], ends: &BorderEnds, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let (spans, notes) = mean_spans(rows, ends.spacing, origin, tolerance)?;
    let net = on_spans(rows, &spans, &ends.tangents(rows, &spans)?);
    Ok((net.surface(SurfaceKind::Grid, origin, tolerance), notes))
}

/// The bicubic net of [`grid`], with derivatives across the border where they are given.
pub fn fitted(rows: &[Vec<DVec3>], tangents: &Tangents, origin: Origin, tolerance: &Tolerance) -> Result<(NurbsSurface, Vec<Fault>)> {
    let (spans, notes) = mean_spans(rows, Spacing::Chord, origin, tolerance)?;
    Ok((on_spans(rows, &spans, tangents), notes))
}

/// The bicubic net through points on given spans.
pub(crate) fn on_spans(rows: &[Vec<DVec3>], (spans_u, spans_v): &Spans, tangents: &Tangents) -> NurbsSurface {
    let (nu, nv) = (rows[0].len(), rows.len());

    // First along u, row by row; the border derivatives in v travel as two more rows.
    let twist = |k: usize| tangents.across_u[k % 2].is_some().then_some(tangents.twists[k]);
    let fit_u = |points: &[DVec3], ends: [Option<DVec3>; 2]| poles(points, spans_u, ends);
    let across_u = |j: usize| [0, 1].map(|k: usize| tangents.across_u[k].as_ref().map(|all| all[j]));
    let lines: Vec<Vec<DVec3>> = (0..nv).map(|j| fit_u(&rows[j], across_u(j))).collect();
    let ends_v = [0, 1].map(|k: usize| tangents.across_v[k].as_ref().map(|all| fit_u(all, [twist(2 * k), twist(2 * k + 1)])));
    // Then along v through each column of the poles.
    let (mu, mv) = (nu + 2, nv + 2);
    let mut net = vec![DVec4::ZERO; mu * mv];
    for i in 0..mu {
        job::poll();
        let column: Vec<DVec3> = lines.iter().map(|line| line[i]).collect();
        let ends = [0, 1].map(|k: usize| ends_v[k].as_ref().map(|all| all[i]));
        for (j, p) in poles(&column, spans_v, ends).into_iter().enumerate() {
            net[j * mu + i] = p.extend(1.0);
        }
    }
    let knots = (unit_knots(spans_u), unit_knots(spans_v));
    NurbsSurface { degree: (3, 3), knots, poles: net, counts: (mu, mv) }
}

/// Spans along u and along v.
pub type Spans = (Vec<f64>, Vec<f64>);

/// Mean spans along u and along v of a grid; warnings too (W651). Fails as [`grid`] does.
pub(crate) fn mean_spans(rows: &[Vec<DVec3>], spacing: Spacing, origin: Origin, tolerance: &Tolerance) -> Result<(Spans, Vec<Fault>)> {
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
    let (spans_u, mut notes) = spans(rows, "row", spacing, origin, tolerance)?;
    let (spans_v, more) = spans(&columns, "column", spacing, origin, tolerance)?;
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
fn spans(
    lines: &[Vec<DVec3>],
    word: &'static str,
    spacing: Spacing,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<(Vec<f64>, Vec<Fault>)> {
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
    let spaced = |i: usize| live.iter().map(|&k| spacing.of(chord(&lines[k], i))).sum::<f64>() / live.len() as f64;
    let spans: Vec<f64> = (0..n).map(spaced).collect();
    if spacing == Spacing::Uniform {
        return Ok((spans, Vec::new()));
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
    Ok((spans, note.into_iter().collect()))
}
