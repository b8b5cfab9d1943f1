//! Parameters of curve entities.

use glam::DVec3;

use crate::io::cad::defect::{Defect, defect};
use crate::io::iges::entity_data::{Data, SplineData};
use crate::io::iges::params::ParameterReader;

/// 100.
pub fn arc(r: &mut ParameterReader) -> Result<Data, Defect> {
    let z = r.real("plane")?;
    let mut pair = |what: &str| Ok::<_, Defect>([r.real(what)?, r.real(what)?]);
    Ok(Data::Arc { z, center: pair("centre")?, start: pair("start")?, end: pair("end")? })
}

/// 104.
pub fn conic(r: &mut ParameterReader) -> Result<Data, Defect> {
    let mut conic = [0.0; 6];
    for c in &mut conic {
        *c = r.real("coefficient")?;
    }
    let z = r.real("plane")?;
    let mut pair = |what: &str| Ok::<_, Defect>([r.real(what)?, r.real(what)?]);
    Ok(Data::ConicArc { conic, z, start: pair("start")?, end: pair("end")? })
}

/// 106: pairs in a plane, triples, or triples with a vector each.
pub fn points(form: i32, r: &mut ParameterReader) -> Result<Data, Defect> {
    let kind = r.int("kind of rows")?;
    let n = r.count("count of points")?;
    let mut points = match kind {
        1 => {
            let z = r.real("plane")?;
            r.needs(n, 2, "points")?;
            (0..n).map(|_| Ok(DVec3::new(r.real("x")?, r.real("y")?, z))).collect::<Result<Vec<_>, Defect>>()?
        }
        2 => r.points(n, "points")?,
        3 => {
            r.needs(n, 6, "points with vectors")?;
            let mut with_vector = || {
                let p = r.point("point")?;
                r.point("vector")?;
                Ok(p)
            };
            (0..n).map(|_| with_vector()).collect::<Result<Vec<_>, Defect>>()?
        }
        other => return Err(defect(format!("rows of points are of kind 1, 2 or 3, got {other}"))),
    };
    match form {
        1..=3 => Ok(Data::Points { points, is_line: false }),
        11..=13 => Ok(Data::Points { points, is_line: true }),
        63 => {
            if let [first, .., last] = *points
                && first != last
            {
                points.push(first);
            }
            Ok(Data::Points { points, is_line: true })
        }
        // Lines of drawings: centre lines, hatches, witness lines.
        _ => Ok(Data::Unknown),
    }
}

/// 112: an end value of each coordinate and its derivatives follow the pieces; they say nothing new.
pub fn polynomials(r: &mut ParameterReader) -> Result<Data, Defect> {
    r.int("kind of spline")?;
    r.int("continuity")?;
    let dimensions = r.int("count of dimensions")?;
    let n = r.count("count of pieces")?;
    if n == 0 {
        return Err(defect("a spline of no pieces"));
    }
    r.needs(n, 13, "pieces")?;
    let breaks = r.reals(n + 1, "joints")?;
    increasing(&breaks)?;
    let mut piece = || {
        let mut piece = [[0.0; 4]; 3];
        for coordinate in &mut piece {
            for c in coordinate {
                *c = r.real("coefficient")?;
            }
        }
        if dimensions == 2 {
            piece[2][1..].fill(0.0);
        }
        Ok(piece)
    };
    let pieces = (0..n).map(|_| piece()).collect::<Result<Vec<_>, Defect>>()?;
    for _ in 0..r.left().min(12) {
        r.real_or(0.0);
    }
    Ok(Data::Polynomials { breaks, pieces })
}

/// Joints must ascend.
pub fn increasing(breaks: &[f64]) -> Result<(), Defect> {
    match breaks.windows(2).position(|w| w[1] <= w[0]) {
        Some(k) => Err(defect(format!("the joints do not ascend: {} is followed by {}", breaks[k], breaks[k + 1]))),
        None => Ok(()),
    }
}

/// 126.
pub fn spline(r: &mut ParameterReader) -> Result<Data, Defect> {
    let last = r.count("last index of points")?;
    let degree = r.count("degree")?;
    for what in ["planar", "closed", "polynomial", "periodic"] {
        r.int(what)?;
    }
    let n = last + 1;
    check_degree(n, degree)?;
    let knots = r.reals(n + degree + 1, "knots")?;
    let weights = r.reals(n, "weights")?;
    let points = r.points(n, "control points")?;
    let ends = (knots[degree], knots[n]);
    let range = range(r, ends);
    // The normal of a planar curve.
    for _ in 0..r.left().min(3) {
        r.real_or(0.0);
    }
    Ok(Data::Spline(SplineData { degree, knots, weights, points, range }))
}

/// The stretch of parameters that counts; one left out or outside the knots is all of it.
pub fn range(r: &mut ParameterReader, (first, last): (f64, f64)) -> (f64, f64) {
    let (a, b) = (r.real_or(first), r.real_or(last));
    if a < b && first < b && a < last { (a.max(first), b.min(last)) } else { (first, last) }
}

/// A spline of degree p has more than p points.
pub fn check_degree(points: usize, degree: usize) -> Result<(), Defect> {
    const HIGHEST: usize = crate::geometry::shapes::nurbs::MAX_DEGREE;
    if degree == 0 || degree > HIGHEST {
        return Err(defect(format!("degree {degree} is not read; degrees are 1 to {HIGHEST}")));
    }
    if points <= degree {
        return Err(defect(format!("degree {degree} needs {} control points, got {points}", degree + 1)));
    }
    Ok(())
}

/// 130 with a constant distance.
pub fn offset(r: &mut ParameterReader) -> Result<Data, Defect> {
    let base = r.pointer("curve")?;
    let law = r.int("law of distances")?;
    r.pointer("law's curve")?;
    r.int("law's dimension")?;
    r.int("law's taper")?;
    let distance = r.real("distance")?;
    for _ in 0..3 {
        r.real("law's value")?;
    }
    let normal = r.point("normal")?;
    let range = (r.real("first parameter")?, r.real("last parameter")?);
    if law != 1 {
        return Err(defect("only offsets by one distance are read"));
    }
    Ok(Data::OffsetCurve { base, distance, normal, range })
}
