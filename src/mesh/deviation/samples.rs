//! Distances of a triangle from its surface at 25 points and at the peak of the quadratic function through its sides.
//!
//! The points are those of a triangle divided in six along each side, corners left out. Each has a place on the surface by
//! linear interpolation of (u, v). What is off along the normal there is nearly the distance (the error falls with the
//! square of the size). One more point is where the quadratic function is largest that has the same heights in the corners and in the middles
//! of the sides. The triangles that seem farthest are followed to their feet.

use glam::{DVec2, DVec3};

use crate::base::tolerance::Tolerance;
use crate::mesh::deviation::poles::from_pole;
use crate::mesh::deviation::quadratic::stationary;
use crate::surface::{Domain, Evaluator, Surface, foot_within, step};

/// Divisions of a triangle's side.
pub(super) const SIX: usize = 6;

/// What steers the search for feet.
struct FootSettings {
    /// Distance over what a triangle seems to be off, from which it does not only seem so.
    min_true_share: f64,
    /// Triangles that are followed to their feet at most, but for those that only seem far.
    max_followed: usize,
}

const SETTINGS: FootSettings = FootSettings { min_true_share: 0.5, max_followed: 256 };

/// The point of a triangle that seems farthest from the surface: by how much, where, and near which (u, v).
#[derive(Clone, Copy)]
pub(super) struct Farthest {
    pub seems: f64,
    pub p: DVec3,
    pub uv: (f64, f64),
}

/// How far a point is from the surface point beside it, along the normal of its triangle.
pub(super) fn off(p: DVec3, there: DVec3, normal: DVec3) -> f64 {
    if normal == DVec3::ZERO { p.distance(there) } else { (p - there).dot(normal).abs() }
}

/// The 25 points as weights in sixths.
pub(super) fn weights() -> impl Iterator<Item = (usize, usize, usize)> {
    (0..=SIX).flat_map(|b| (0..=SIX - b).map(move |c| (SIX - b - c, b, c))).filter(|(a, b, c)| *a != SIX && *b != SIX && *c != SIX)
}

/// The side opposite which corner weights are the middle of.
pub(super) fn middle(weights: [usize; 3]) -> Option<usize> {
    const HALF: usize = SIX / 2;
    (0..3).find(|k| weights[*k] == 0 && weights[(*k + 1) % 3] == HALF)
}

/// How high the quadratic function over a triangle is where it is largest inside, and where, as weights, that vanishes at the corners and
/// has such heights in the middles of the sides opposite.
pub(super) fn peak(middles: [f64; 3]) -> Option<(f64, [f64; 3])> {
    stationary(middles.map(|height| 4.0 * height)).map(|(height, weights)| (height.abs(), weights))
}

/// Places of a triangle's corners, with one at a pole between the others.
pub(super) fn beside_pole(evaluator: Evaluator, at: [(f64, f64); 3]) -> [(f64, f64); 3] {
    let tangents = |at: DVec2| evaluator.tangents(at.x, at.y);
    from_pole(&tangents, at.map(DVec2::from)).map(Into::into)
}

/// The farthest of the 25 points of a triangle.
pub(super) fn of_triangle(point: &impl Fn((f64, f64)) -> DVec3, uv: [(f64, f64); 3], points: [DVec3; 3]) -> Farthest {
    let normal = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero();
    let mut seen = Farthest { seems: -1.0, p: points[0], uv: uv[0] };
    let place = |w: [f64; 3]| (uv[0].0 * w[0] + uv[1].0 * w[1] + uv[2].0 * w[2], uv[0].1 * w[0] + uv[1].1 * w[1] + uv[2].1 * w[2]);
    let spot = |w: [f64; 3]| points[0] * w[0] + points[1] * w[1] + points[2] * w[2];
    let mut middles = [0.0; 3];
    for (a, b, c) in weights() {
        let w = [a, b, c].map(|n| n as f64 / SIX as f64);
        let (at, p) = (place(w), spot(w));
        let there = point(at);
        if let Some(k) = middle([a, b, c]) {
            middles[k] = (there - p).dot(normal);
        }
        let seems = off(p, there, normal);
        if seems > seen.seems {
            seen = Farthest { seems, p, uv: at };
        }
    }
    if let Some((seems, w)) = peak(middles).filter(|(seems, _)| *seems > seen.seems) {
        seen = Farthest { seems, p: spot(w), uv: place(w) };
    }
    seen
}

/// The point with its distance from a near surface point, which its foot is no farther than: where (u, v) shear a surface, what is off along
/// the normal of the triangle may be less than the distance.
pub(super) fn bounded(evaluator: Evaluator, seen: Farthest) -> Farthest {
    let jet = evaluator.jet(seen.uv.0, seen.uv.1);
    let gap = seen.p - jet.p;
    let Some(by) = step(jet.du, jet.dv, gap) else { return Farthest { seems: gap.length(), ..seen } };
    let ((u0, u1), (v0, v1)) = ranges(evaluator.surface());
    let uv = ((seen.uv.0 + by.x).clamp(u0, u1), (seen.uv.1 + by.y).clamp(v0, v1));
    let there = evaluator.point(uv.0, uv.1).distance(seen.p);
    if there < gap.length() { Farthest { seems: there, uv, ..seen } } else { Farthest { seems: gap.length(), ..seen } }
}

/// The ranges of u and v in which feet lie: a trimmed face may run over the seam of the surface below.
fn ranges(surface: &Surface) -> ((f64, f64), (f64, f64)) {
    let whole = |closed: bool| {
        let over = closed && surface.domain() == Domain::Loop;
        if over { (f64::NEG_INFINITY, f64::INFINITY) } else { (0.0, 1.0) }
    };
    let (u, v) = surface.closed();
    (whole(u), whole(v))
}

/// Follows the triangles that seem farther than `known` to their feet: the distance of the farthest, or `known` if that is larger.
pub(super) fn follow(evaluator: Evaluator, mut farthest: Vec<Farthest>, known: f64, tolerance: &Tolerance) -> f64 {
    farthest.retain(|s| s.seems > tolerance.rounding.max(known));
    farthest.sort_by(|a, b| b.seems.total_cmp(&a.seems));
    let (u, v) = ranges(evaluator.surface());
    let (mut most, mut followed) = (known, 0);
    for seen in farthest {
        if seen.seems < most || followed == SETTINGS.max_followed {
            break;
        }
        let distance = foot_within(evaluator, seen.p, seen.uv, u, v).0;
        // What only seems far, as beside a pole, is passed by.
        followed += usize::from(distance >= SETTINGS.min_true_share * seen.seems);
        most = f64::max(most, distance);
    }
    most
}
