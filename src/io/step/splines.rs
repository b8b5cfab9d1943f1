//! B-spline curves and surfaces as the file has them: with knots, or with those that their form stands for.

use glam::DVec3;

use crate::geometry::shapes::nurbs::MAX_DEGREE;
use crate::io::cad::defect::{Defect, defect};
use crate::io::step::parameters::Row;
use crate::io::step::reader::Step;

/// A rational B-spline.
#[derive(Clone, Debug)]
pub struct Knotted {
    /// Degree.
    pub degree: usize,
    /// Knots, as many as points + degree + 1.
    pub knots: Vec<f64>,
    /// Control points, model units.
    pub points: Vec<DVec3>,
    /// Their weights.
    pub weights: Vec<f64>,
}

/// A rational B-spline surface; the first index of the points is the slow one, as the file has it.
#[derive(Clone, Debug)]
pub struct Netted {
    /// Degrees in u and v.
    pub degree: (usize, usize),
    /// Knots in u and v.
    pub knots: (Vec<f64>, Vec<f64>),
    /// Control points, model units, one list for each step in u.
    pub points: Vec<Vec<DVec3>>,
    /// Their weights.
    pub weights: Option<Vec<Vec<f64>>>,
}

/// The B-spline curve of an entity, simple or complex.
pub fn curve(step: &Step, k: u32) -> Result<Knotted, Defect> {
    let file = step.file;
    // A complex entity has its values under several names, without the name of the item.
    let base = file.under(k, b"B_SPLINE_CURVE");
    let (row, from) = base.map_or((file.parameters(k), 1), |row| (row, 0));
    let degree = row.count(from)?;
    let points = row.entities(from + 1)?.into_iter().map(|p| step.point(p)).collect::<Result<Vec<DVec3>, Defect>>()?;
    check(degree, points.len())?;
    let knots = match file.under(k, b"B_SPLINE_CURVE_WITH_KNOTS") {
        Some(row) => {
            let from = if base.is_some() { 0 } else { 6 };
            repeated(row, from, from + 1, points.len() + degree + 1)?
        }
        None => implied(form(step, k, "CURVE")?, degree, points.len())?,
    };
    let weights = match file.under(k, b"RATIONAL_B_SPLINE_CURVE") {
        Some(row) => row.numbers(if base.is_some() { 0 } else { row.values().count().saturating_sub(1) })?,
        None => vec![1.0; points.len()],
    };
    if weights.len() != points.len() {
        return Err(defect(format!("it has {} points and {} weights", points.len(), weights.len())));
    }
    Ok(Knotted { degree, knots, points, weights })
}

/// The B-spline surface of an entity, simple or complex.
pub fn surface(step: &Step, k: u32) -> Result<Netted, Defect> {
    let file = step.file;
    let base = file.under(k, b"B_SPLINE_SURFACE");
    let (row, from) = base.map_or((file.parameters(k), 1), |row| (row, 0));
    let degree = (row.count(from)?, row.count(from + 1)?);
    let points = lists(row.list(from + 2)?)?;
    let points = points
        .into_iter()
        .map(|row| row.values().map(|v| step.point(v.entity()?)).collect())
        .collect::<Result<Vec<Vec<DVec3>>, Defect>>()?;
    let (n, m) = (points.len(), points.first().map_or(0, Vec::len));
    if points.iter().any(|row| row.len() != m) {
        return Err(defect("its rows of points are not equally long"));
    }
    check(degree.0, n)?;
    check(degree.1, m)?;
    let knots = match file.under(k, b"B_SPLINE_SURFACE_WITH_KNOTS") {
        Some(row) => {
            let from = if base.is_some() { 0 } else { 8 };
            (repeated(row, from, from + 2, n + degree.0 + 1)?, repeated(row, from + 1, from + 3, m + degree.1 + 1)?)
        }
        None => {
            let form = form(step, k, "SURFACE")?;
            (implied(form, degree.0, n)?, implied(form, degree.1, m)?)
        }
    };
    let weights = match file.under(k, b"RATIONAL_B_SPLINE_SURFACE") {
        Some(row) => {
            let rows = lists(row.list(if base.is_some() { 0 } else { row.values().count().saturating_sub(1) })?)?;
            Some(rows.into_iter().map(|row| row.values().map(|v| v.number()).collect()).collect::<Result<Vec<Vec<f64>>, Defect>>()?)
        }
        None => None,
    };
    if weights.as_ref().is_some_and(|w| w.len() != n || w.iter().any(|row| row.len() != m)) {
        return Err(defect("it has other counts of points and weights"));
    }
    Ok(Netted { degree, knots, points, weights })
}

fn lists(row: Row) -> Result<Vec<Row>, Defect> {
    row.values().map(|v| v.list().ok_or_else(|| defect("a row of its points is not a list"))).collect()
}

fn check(degree: usize, points: usize) -> Result<(), Defect> {
    if degree == 0 || points <= degree {
        return Err(defect(format!("it has {points} points and degree {degree}")));
    }
    if degree > MAX_DEGREE {
        return Err(defect(format!("degrees are 1 to {MAX_DEGREE}, and its is {degree}")));
    }
    Ok(())
}

/// Knots by their multiplicities.
fn repeated(row: Row, counts: usize, knots: usize, wanted: usize) -> Result<Vec<f64>, Defect> {
    let (counts, knots) = (row.numbers(counts)?, row.numbers(knots)?);
    if counts.len() != knots.len() {
        return Err(defect(format!("it has {} knots and {} multiplicities", knots.len(), counts.len())));
    }
    let mut all = Vec::with_capacity(wanted);
    for (knot, n) in knots.into_iter().zip(counts) {
        let fits = n >= 1.0 && n.trunc() == n && n <= (wanted - all.len()) as f64;
        if !fits {
            return Err(defect(format!("its multiplicities do not give {wanted} knots")));
        }
        all.extend(std::iter::repeat_n(knot, n as usize));
    }
    if all.len() != wanted {
        return Err(defect(format!("its multiplicities give {} knots, not {wanted}", all.len())));
    }
    Ok(all)
}

#[derive(Clone, Copy, Debug)]
enum Form {
    Bezier,
    Uniform,
    QuasiUniform,
}

fn form(step: &Step, k: u32, of: &str) -> Result<Form, Defect> {
    let is = |word: &str| step.file.is(k, format!("{word}_{of}").as_bytes());
    match (is("BEZIER"), is("UNIFORM"), is("QUASI_UNIFORM")) {
        (true, ..) => Ok(Form::Bezier),
        (_, true, _) => Ok(Form::Uniform),
        (_, _, true) => Ok(Form::QuasiUniform),
        _ => Err(defect("it has no knots")),
    }
}

/// The knots that a form stands for.
fn implied(form: Form, degree: usize, points: usize) -> Result<Vec<f64>, Defect> {
    let all = points + degree + 1;
    let spans = points - degree;
    Ok(match form {
        Form::Uniform => (0..all).map(|k| k as f64 - degree as f64).collect(),
        Form::QuasiUniform => (0..all).map(|k| k.saturating_sub(degree).min(spans) as f64).collect(),
        Form::Bezier => {
            if !(points - 1).is_multiple_of(degree) {
                return Err(defect(format!("{points} points are not Bézier pieces of degree {degree}")));
            }
            let pieces = (points - 1) / degree;
            (0..all).map(|k| (k.saturating_sub(1) / degree).min(pieces) as f64).collect()
        }
    })
}
