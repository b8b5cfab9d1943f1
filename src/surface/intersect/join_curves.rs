//! Curves that go on from one patch to the next, as one.

use std::sync::Arc;

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Nurbs};

/// Ends of curves that are one place: curve and whether its last point is meant.
type CurveEnd = (usize, bool);

/// Largest turn at a joint where several go on, as a cosine.
const ON: f64 = 0.9;

/// Curves joined where one ends and just one other begins, or goes straight on.
pub(crate) fn joined(curves: Vec<Curve>, tolerance: &Tolerance) -> Vec<Curve> {
    let next = continuations(&curves, tolerance);
    let mut used = vec![false; curves.len()];
    let mut out = Vec::new();
    // Rows that begin at a free end first, closed ones after them.
    for free in [true, false] {
        for k in 0..curves.len() {
            for last in [true, false] {
                if used[k] || free && next[k][usize::from(last)].is_some() {
                    continue;
                }
                out.push(row(&curves, &next, (k, last), &mut used, tolerance));
            }
        }
    }
    out
}

fn end(curve: &Curve, last: bool) -> DVec3 {
    if last { curve.end() } else { curve.start() }
}

/// Unit direction out of a curve at an end.
fn outward(curve: &Curve, last: bool) -> DVec3 {
    let (a, b) = curve.domain();
    if last { curve.jet_before(b).d1.normalize_or_zero() } else { -curve.jet(a).d1.normalize_or_zero() }
}

/// What goes on at the first (0) and last (1) point of each curve.
fn continuations(curves: &[Curve], tolerance: &Tolerance) -> Vec<[Option<CurveEnd>; 2]> {
    let ends: Vec<CurveEnd> = (0..curves.len()).flat_map(|k| [(k, false), (k, true)]).collect();
    let mut next = vec![[None, None]; curves.len()];
    for (i, &(k, last)) in ends.iter().enumerate() {
        let at = end(&curves[k], last);
        let here = |e: &CurveEnd| end(&curves[e.0], e.1).distance(at) <= 2.0 * tolerance.point;
        let others: Vec<CurveEnd> = ends.iter().enumerate().filter(|(j, e)| *j != i && here(e)).map(|(_, e)| *e).collect();
        let turn = |e: &CurveEnd| -outward(&curves[k], last).dot(outward(&curves[e.0], e.1));
        next[k][usize::from(last)] = match others.as_slice() {
            [one] => Some(*one),
            several => several.iter().copied().filter(|e| turn(e) > ON).max_by(|x, y| turn(x).total_cmp(&turn(y))),
        };
    }
    // Only where both ends choose each other.
    let chosen = next.clone();
    for (k, both) in next.iter_mut().enumerate() {
        for (last, slot) in both.iter_mut().enumerate() {
            let mutual = slot.is_some_and(|(j, side)| chosen[j][usize::from(side)] == Some((k, last == 1)));
            if !mutual {
                *slot = None;
            }
        }
    }
    next
}

/// The row that begins with a curve at its first point (`from_last`: at its last).
fn row(curves: &[Curve], next: &[[Option<CurveEnd>; 2]], (first, from_last): CurveEnd, used: &mut [bool], tolerance: &Tolerance) -> Curve {
    let mut parts: Vec<Curve> = Vec::new();
    let mut at = Some((first, from_last));
    while let Some((k, backwards)) = at {
        if used[k] {
            break;
        }
        used[k] = true;
        parts.push(if backwards { curves[k].reversed() } else { curves[k].clone() });
        at = next[k][usize::from(!backwards)];
    }
    one_of(parts, tolerance)
}

/// Parts in a row as one curve: lines that go straight on as one, cubics as one spline.
fn one_of(parts: Vec<Curve>, tolerance: &Tolerance) -> Curve {
    let mut merged: Vec<Curve> = Vec::new();
    for part in parts {
        let whole = merged.last().and_then(|last| both(last, &part, tolerance));
        match whole {
            Some(whole) => {
                merged.pop();
                merged.push(whole);
            }
            None => merged.push(part),
        }
    }
    let first = merged[0].clone();
    if merged.len() == 1 { first } else { build::composite(&merged, first.origin()).unwrap_or(first) }
}

fn both(a: &Curve, b: &Curve, tolerance: &Tolerance) -> Option<Curve> {
    match (a.shape(), b.shape()) {
        (Shape::Line(p, q), Shape::Line(_, r)) => {
            let way = (*r - *p).normalize_or_zero();
            let aside = (*q - *p).reject_from(way).length();
            (aside <= STRAIGHT * tolerance.point && (*q - *p).dot(*r - *q) > 0.0).then(|| build::line(*p, *r, a.origin()).ok())?
        }
        (Shape::Nurbs(x), Shape::Nurbs(y)) if outward(a, true).dot(-outward(b, false)) > ON => {
            Some(Curve::new(Shape::Nurbs(Arc::new(Nurbs::joined(&[(**x).clone(), (**y).clone()]))), a.kind(), a.origin()))
        }
        _ => None,
    }
}

/// Share of the tolerance within which a curve is a straight line.
pub(crate) const STRAIGHT: f64 = 1.0 / 64.0;
