//! Sections between given ones: copies of these, deformed to one station, blended along the guides and as smooth as the given ones are.

use glam::{DVec3, DVec4};

use crate::base::solve;
use crate::base::tolerance::{NEAREST, Tolerance};
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::surface::swept::course::{Course, end_slopes};
use crate::surface::swept::deform::Pieces;

/// A given section as it is at a station.
pub(super) struct Copy<'a> {
    /// Fraction of the main guide at which it was given.
    pub w: f64,
    pub pieces: Pieces,
    pub course: &'a Course,
}

/// The section at the fraction `w` of the main guide, between copies `before` and `before + 1` of some in ascending order: linear between
/// two, and with more a cubic along the guide at each control point, linear where these are; its slopes are limited by length, not by coordinate.
pub(super) fn blended(copies: &[Copy], before: usize, w: f64, closed: bool, tolerance: &Tolerance) -> Pieces {
    let (a, b) = (&copies[before], &copies[before + 1]);
    let x = (w - a.w) / (b.w - a.w);
    let pole = |copy: usize, k: usize, i: usize| copies[copy].pieces[k][i];
    let at = |k: usize, i: usize| -> DVec4 {
        let (p, q) = (pole(before, k, i), pole(before + 1, k, i));
        let rate = |n: usize| (pole(n + 1, k, i) - pole(n, k, i)) / (copies[n + 1].w - copies[n].w);
        let span = |n: usize| copies[n + 1].w - copies[n].w;
        let own = rate(before);
        let first = (before > 0).then(|| slope(rate(before - 1), own, span(before - 1), span(before)));
        let last = (before + 2 < copies.len()).then(|| slope(own, rate(before + 1), span(before), span(before + 1)));
        // At the outer sections the cubic has no second derivative.
        let free = |other: Option<DVec4>| other.map_or(own, |other| (own * 3.0 - other) * 0.5);
        let (m, n) = (first.unwrap_or_else(|| free(last)), last.unwrap_or_else(|| free(first)));
        let y = 1.0 - x;
        p * (y * y * (1.0 + 2.0 * x)) + q * (x * x * (3.0 - 2.0 * x)) + (m * y - n * x) * (x * y * span(before))
    };
    let mut made: Pieces = (0..a.pieces.len()).map(|k| (0..a.pieces[k].len()).map(|i| at(k, i)).collect()).collect();
    smoothed(&mut made, [a.course, b.course], x, closed, tolerance);
    made
}

/// The rate in which a value changes where it changed by `before` over one span and changes by `after` over the next: that of the parabola,
/// less where it turns [Fritsch & Butland 1984].
fn slope(before: DVec4, after: DVec4, first: f64, second: f64) -> DVec4 {
    const MOST: f64 = 3.0;
    let (a, b) = (before.length(), after.length());
    let along = before.dot(after);
    if along <= 0.0 {
        return DVec4::ZERO;
    }
    let parabola = (before * second + after * first) / (first + second);
    (parabola * (along / (a * b))).clamp_length_max(MOST * a.min(b))
}

/// Blends of pieces that follow each other smoothly do so themselves only if their speeds change alike. Where the tangent and the curvature
/// of both sections go on, the blend becomes the cubic spline through its joints; where the tangent alone does, its handles are turned.
fn smoothed(made: &mut Pieces, courses: [&Course; 2], x: f64, closed: bool, tolerance: &Tolerance) {
    let n = made.len();
    let spans: Vec<f64> = (0..n).map(|k| courses[0].spans[k] * (1.0 - x) + courses[1].spans[k] * x).collect();
    let fair = |k: usize| courses.iter().all(|course| course.fair[k]);
    let alike = |k: usize| {
        let ratio = |course: &Course| course.spans[k] / course.spans[k - 1];
        (ratio(courses[0]) / ratio(courses[1]) - 1.0).abs() <= NEAREST
    };
    let mut from = 0;
    while from < n {
        let to = (from + 1..n).find(|k| !fair(*k)).unwrap_or(n);
        if (from + 1..to).any(|k| !alike(k)) {
            let ring = closed && from == 0 && to == n && fair(0) && n > 2;
            spline(&mut made[from..to], &spans[from..to], ring);
        }
        from = to;
    }
    for k in 0..n {
        let next = (k + 1) % n;
        if next == 0 && !closed {
            break;
        }
        if courses.iter().all(|course| course.smooth[next]) {
            straighten(made, (k, next), tolerance);
        }
    }
}

/// Cubics with the same ends as a C² spline over `spans`, with the slopes that they have at both ends, or without ends.
fn spline(pieces: &mut [Vec<DVec4>], spans: &[f64], ring: bool) {
    let n = pieces.len();
    let joints: Vec<DVec3> = pieces.iter().map(|piece| projected(piece[0])).chain([projected(pieces[n - 1][3])]).collect();
    let secant = |k: usize| (joints[k + 1] - joints[k]) / spans[k];
    let row = |before: usize, after: usize| [spans[after], 2.0 * (spans[before] + spans[after]), spans[before]];
    let right = |before: usize, after: usize| (secant(before) * spans[after] + secant(after) * spans[before]) * 3.0;
    let slopes = if ring {
        let place = |k: usize| ((k + n - 1) % n, k);
        let rows: Vec<_> = (0..n).map(|k| row(place(k).0, place(k).1)).collect();
        let mut slopes: Vec<DVec3> = (0..n).map(|k| right(place(k).0, place(k).1)).collect();
        solve::cyclic(&rows, &mut slopes);
        slopes.push(slopes[0]);
        slopes
    } else {
        let (first, last) = (end_slopes(&pieces[0]).0 / spans[0], end_slopes(&pieces[n - 1]).1 / spans[n - 1]);
        let rows: Vec<_> = (0..=n).map(|k| if k == 0 || k == n { [0.0, 1.0, 0.0] } else { row(k - 1, k) }).collect();
        let of = |k: usize| {
            if k == 0 {
                first
            } else if k == n {
                last
            } else {
                right(k - 1, k)
            }
        };
        let mut slopes: Vec<DVec3> = (0..=n).map(of).collect();
        solve::tridiagonal(&rows, &mut slopes);
        slopes
    };
    for (k, piece) in pieces.iter_mut().enumerate() {
        let third = spans[k] / 3.0;
        piece[1] = (joints[k] + slopes[k] * third).extend(1.0);
        piece[2] = (joints[k + 1] - slopes[k + 1] * third).extend(1.0);
    }
}

/// Turns both handles of a joint into their common direction, as long as they are.
fn straighten(pieces: &mut Pieces, (k, next): (usize, usize), tolerance: &Tolerance) {
    let last = pieces[k].len() - 1;
    let joint = projected(pieces[k][last]);
    let (before, after) = (joint - projected(pieces[k][last - 1]), projected(pieces[next][1]) - joint);
    let way = (before + after).normalize_or_zero();
    if way == DVec3::ZERO || before.cross(after).length() <= tolerance.parameter * before.length() * after.length() {
        return;
    }
    let w = (pieces[k][last - 1].w, pieces[next][1].w);
    pieces[k][last - 1] = weighted(joint - way * before.length(), w.0);
    pieces[next][1] = weighted(joint + way * after.length(), w.1);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(w: f64, ys: &[f64], before: usize) -> f64 {
        let pieces = |y: f64| vec![vec![DVec4::new(0.0, y, 0.0, 1.0); 4]];
        let tolerance = Tolerance::new(1e-6, 5.0);
        let course = Course::new(&pieces(0.0), &[0.0, 1.0], false, &tolerance);
        let copies: Vec<Copy> = ys.iter().enumerate().map(|(k, y)| Copy { w: k as f64, pieces: pieces(*y), course: &course }).collect();
        blended(&copies, before, w, false, &tolerance)[0][0].y
    }

    #[test]
    fn blends_are_linear_where_the_sections_are_and_never_overshoot() {
        assert!((at(0.25, &[0.0, 1.0], 0) - 0.25).abs() < 1e-15);
        assert!((at(1.3, &[0.0, 1.0, 2.0, 3.0], 1) - 1.3).abs() < 1e-14);
        let step = |w: f64| at(w, &[0.0, 0.0, 1.0, 1.0], 1);
        assert!((0..=64).all(|k| (0.0..=1.0).contains(&step(1.0 + f64::from(k) / 64.0))));
        assert_eq!(step(1.25), 0.15625);
    }

    #[test]
    fn a_blend_of_cubics_becomes_one_spline() {
        let pole = |p: [f64; 2]| DVec4::new(p[0], p[1], 0.0, 1.0);
        let mut pieces: Vec<Vec<DVec4>> = vec![
            [[0.0, 0.0], [1.0, 0.5], [1.8, 1.0], [3.0, 1.0]].map(pole).to_vec(),
            [[3.0, 1.0], [4.2, 1.1], [5.0, 0.6], [6.0, 0.0]].map(pole).to_vec(),
        ];
        spline(&mut pieces, &[0.45, 0.55], false);
        let second = |piece: &[DVec4], end: usize, h: f64| {
            let p = |k: usize| projected(piece[k]);
            (p(end + 1) - 2.0 * p(end) + p(end - 1)) * (6.0 / (h * h))
        };
        assert!(second(&pieces[0], 2, 0.45).distance(second(&pieces[1], 1, 0.55)) < 1e-12);
    }
}
