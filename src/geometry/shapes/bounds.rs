//! Bounds of a Bézier piece's turning and second derivative from its control points (convex hull property).

use glam::{DVec3, DVec4};

use crate::geometry::shapes::nurbs::{MAX_DEGREE, projected};
use crate::geometry::shapes::nurbs_edit::Bezier;

/// Bernstein coefficients of the direction of a rational piece, at most.
const MOST: usize = 2 * MAX_DEGREE;

/// Most turning a unit of parameter and largest second derivative over the piece.
pub(crate) fn rates(piece: &Bezier, polynomial: bool) -> Rates {
    let h = piece.t1 - piece.t0;
    let p = piece.poles.len() - 1;
    if p == 1 && polynomial {
        return Rates { turn: 0.0, bend: 0.0 };
    }
    let mut directions = [DVec3::ZERO; MOST];
    if polynomial {
        let w = 1.0 / piece.poles[0].w;
        for (direction, pair) in directions.iter_mut().zip(piece.poles.windows(2)) {
            *direction = (pair[1] - pair[0]).truncate() * (w * p as f64 / h);
        }
        let bend = differences(&directions[..p]).map(DVec3::length).fold(0.0, f64::max) * (p - 1) as f64 / h;
        return Rates { turn: turning(&directions[..p], h), bend };
    }
    let count = rational_direction(&piece.poles, h, &mut directions);
    Rates { turn: turning(&directions[..count], h), bend: rational_bend(&piece.poles, h) }
}

fn differences(points: &[DVec3]) -> impl Iterator<Item = DVec3> {
    points.windows(2).map(|d| d[1] - d[0])
}

/// Largest |D × D′| / |D|² of the Bernstein polynomial D over an interval of length `h`.
fn turning(d: &[DVec3], h: f64) -> f64 {
    let sum: DVec3 = d.iter().sum();
    let axis = sum.normalize_or_zero();
    let least = d.iter().map(|d| d.dot(axis)).fold(f64::INFINITY, f64::min);
    if least.is_nan() || least <= 0.0 {
        return f64::INFINITY;
    }
    // All D lie within this slope of the axis.
    let slope = d.iter().map(|d| (*d - axis * d.dot(axis)).length()).fold(0.0, f64::max) / least;
    let sine = slope / (1.0 + slope * slope).sqrt();
    let (mut across, mut along): (f64, f64) = (0.0, 0.0);
    for e in differences(d) {
        let forward = e.dot(axis);
        across = across.max((e - axis * forward).length());
        along = along.max(forward.abs());
    }
    (across + along * sine) * (d.len() - 1) as f64 / (h * least)
}

/// Bernstein coefficients (degree 2p − 1) of A′w − Aw′, the direction of the rational piece A / w; returns their number.
fn rational_direction(poles: &[DVec4], h: f64, out: &mut [DVec3; MOST]) -> usize {
    let p = poles.len() - 1;
    let start = projected(poles[0]);
    // Relative to the first point little cancels.
    let local = |q: DVec4| (q.truncate() - start * q.w, q.w);
    let degree = 2 * p - 1;
    for i in 0..p {
        let ((a0, w0), (a1, w1)) = (local(poles[i]), local(poles[i + 1]));
        let (da, dw) = ((a1 - a0) * p as f64, (w1 - w0) * p as f64);
        for (j, q) in poles.iter().enumerate() {
            let (a, w) = local(*q);
            let share = binomial(p - 1, i) * binomial(p, j) / binomial(degree, i + j);
            out[i + j] += (da * w - a * dw) * (share / h);
        }
    }
    degree + 1
}

/// n over k.
pub(crate) fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |value, i| value * (n - i) as f64 / (i + 1) as f64)
}

/// Bound of |C″| from wC″ = A″ − 2w′C′ − w″C with C relative to the first point.
fn rational_bend(poles: &[DVec4], h: f64) -> f64 {
    let p = poles.len() - 1;
    let start = projected(poles[0]);
    let local: Vec<DVec4> = poles.iter().map(|q| (q.truncate() - start * q.w).extend(q.w)).collect();
    let largest = |order: usize| {
        let mut d = local.clone();
        for r in 0..order {
            for i in 0..d.len() - 1 {
                d[i] = (d[i + 1] - d[i]) * ((p - r) as f64 / h);
            }
            d.pop();
        }
        d.iter().fold((0.0_f64, 0.0_f64), |(a, w), q| (a.max(q.truncate().length()), w.max(q.w.abs())))
    };
    let least = poles.iter().map(|q| q.w).fold(f64::INFINITY, f64::min);
    let reach = poles.iter().map(|q| projected(*q).distance(start)).fold(0.0, f64::max);
    let (a1, w1) = largest(1);
    let speed = (a1 + w1 * reach) / least;
    let (a2, w2) = if p > 1 { largest(2) } else { (0.0, 0.0) };
    (a2 + 2.0 * w1 * speed + w2 * reach) / least
}

/// Rates that hold over a whole piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rates {
    /// Most turning of the direction, radians a unit of parameter; infinite where there is a cusp.
    pub(crate) turn: f64,
    /// Largest second derivative; infinite when not known.
    pub(crate) bend: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shapes::nurbs::{Nurbs, weighted};

    #[test]
    fn bounds_hold_and_are_not_far_off() {
        let points =
            [(0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (2.0, 2.5, 0.0), (4.0, 2.0, -1.0), (5.0, 0.0, 0.0)].map(|(x, y, z)| DVec3::new(x, y, z));
        for weights in [[1.0; 5], [1.0, 0.6, 2.0, 0.8, 1.2]] {
            let poles: Vec<DVec4> = points.iter().zip(weights).map(|(p, w)| weighted(*p, w)).collect();
            let curve = Nurbs::bezier(1.0, 3.0, poles);
            let mut pieces = curve.beziers();
            for _ in 0..3 {
                pieces = pieces.iter().flat_map(|b| <[Bezier; 2]>::from(b.halves())).collect();
            }
            for piece in pieces {
                let Rates { turn, bend } = rates(&piece, curve.polynomial);
                let (mut most_turn, mut most_bend): (f64, f64) = (0.0, 0.0);
                for i in 0..=50 {
                    let j = curve.jet(piece.t0 + (piece.t1 - piece.t0) * f64::from(i) / 50.0);
                    most_turn = most_turn.max(j.d1.cross(j.d2).length() / j.d1.length_squared());
                    most_bend = most_bend.max(j.d2.length());
                }
                assert!(most_turn <= turn * (1.0 + 1e-12) && turn < 1.6 * most_turn + 0.2, "{most_turn} {turn}");
                assert!(most_bend <= bend * (1.0 + 1e-12) && bend < 4.0 * most_bend, "{most_bend} {bend}");
            }
        }
    }
}
