//! Curves of CAD files: transformed exactly, put in a row, and looked at before anything is computed from them.

use std::sync::Arc;

use glam::{DAffine3, DVec3, DVec4};

use crate::base::limits;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::Shape;
use crate::geometry::shapes::nurbs::projected;
use crate::io::cad::defect::{Defect, defect};

/// Coordinates must leave room for what is computed from them.
pub fn check_reach(points: impl IntoIterator<Item = DVec3>) -> Result<(), Defect> {
    let fits = |p: DVec3| p.abs().max_element() <= limits::COORDINATE && !p.is_nan();
    if points.into_iter().all(fits) { Ok(()) } else { Err(defect("its coordinates are too large")) }
}

/// Weights must be above 0, and not too different to be added.
pub fn check_weights(weights: &[f64]) -> Result<(), Defect> {
    if let Some(k) = weights.iter().position(|w| *w <= 0.0) {
        return Err(defect(format!("weight {} is {}; weights must be above 0", k + 1, weights[k])));
    }
    let (least, largest) = weights.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
    if largest > limits::COORDINATE || least < 1.0 / limits::COORDINATE {
        return Err(defect(format!("its weights from {least:e} to {largest:e} cannot be added")));
    }
    Ok(())
}

/// Turns pieces that start where the one before does not end, when turning them closes the gap; returns the largest gap left. Points
/// within `same` are one.
pub fn ordered(pieces: &mut [Curve], same: f64) -> f64 {
    let nearest = |p: DVec3, to: &Curve| p.distance(to.start()).min(p.distance(to.end()));
    if let [first, second, ..] = pieces
        && nearest(first.end(), second) > same
        && nearest(first.start(), second) < 0.5 * nearest(first.end(), second)
    {
        *first = first.reversed();
    }
    let mut widest = 0.0_f64;
    for k in 1..pieces.len() {
        let end = pieces[k - 1].end();
        let missed = end.distance(pieces[k].start());
        if missed > same && end.distance(pieces[k].end()) < 0.5 * missed {
            pieces[k] = pieces[k].reversed();
        }
        widest = widest.max(end.distance(pieces[k].start()));
    }
    widest
}

/// Control points and pieces of a curve: what a copy costs.
pub fn weight(curve: &Curve) -> usize {
    match curve.shape() {
        Shape::Nurbs(c) => c.poles.len(),
        Shape::Composite(c) => c.pieces.iter().map(weight).sum(),
        _ => 1,
    }
}

/// The curve transformed by any affine map, exactly; an offset within the tolerance.
pub fn transformed(curve: &Curve, m: &DAffine3, tolerance: &Tolerance) -> Result<Curve, Defect> {
    let image = |curve: &Curve| curve.mapped(|p| m.transform_point3(p), |v| m.transform_vector3(v));
    if let Some(image) = image(curve) {
        return Ok(image);
    }
    let of_shape = |shape| Curve::new(shape, curve.kind(), curve.origin());
    if let Shape::Composite(c) = curve.shape() {
        let pieces: Result<Vec<Curve>, Defect> = c.pieces.iter().map(|piece| transformed(piece, m, tolerance)).collect();
        return Ok(of_shape(Shape::Composite(Arc::new(Composite::new(pieces?)))));
    }
    let spline = of_shape(Shape::Nurbs(Arc::new(curve.to_nurbs(tolerance)?)));
    Ok(image(&spline).unwrap_or(spline))
}

/// A homogeneous control point transformed.
pub fn transformed_pole(q: DVec4, m: &DAffine3) -> DVec4 {
    (m.transform_point3(projected(q)) * q.w).extend(q.w)
}
