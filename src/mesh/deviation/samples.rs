//! Distances of a triangle from its surface at 25 points and at the peak of the quadratic function through its sides.
//!
//! The points are those of a triangle divided in six along each side, corners left out. Each has a place on the surface by
//! linear interpolation of (u, v). What is off along the normal there is nearly the distance (the error falls with the
//! square of the size). One more point is where the quadratic function is largest that has the same heights in the corners and in the middles
//! of the sides. The triangles that seem farthest are followed to their feet, and in the farthest one the point climbs to where it is
//! farthest: on a bend sharper than a sixth of a side the largest distance lies between the points.

use glam::{DVec2, DVec3};

use crate::base::tolerance::Tolerance;
use crate::mesh::deviation::poles::from_pole;
use crate::mesh::deviation::quadratic::stationary;
use crate::surface::{Domain, Evaluator, Surface, foot_within, step};

/// Divisions of a triangle's side.
pub(super) const SIX: usize = 6;

/// What steers the search for feet.
struct FootSettings {
    /// Steps along the sides by which a point climbs, as shares of a side: the first, and the last.
    steps: (f64, f64),
    /// Points that are tried in a climb at most.
    max_tried: usize,
    /// Triangles that are climbed in at most, and the share of the largest distance from which on one is.
    climbed: usize,
    min_climbed_share: f64,
    /// Distance over what a triangle seems to be off, from which it does not only seem so.
    min_true_share: f64,
    /// Triangles that are followed to their feet at most, but for those that only seem far.
    max_followed: usize,
}

const SETTINGS: FootSettings = FootSettings {
    steps: (1.0 / 12.0, 1.0 / 400.0),
    max_tried: 96,
    climbed: 4,
    min_climbed_share: 0.9,
    min_true_share: 0.5,
    max_followed: 256,
};

/// The point of a triangle that seems farthest from the surface: by how much, where, and near which (u, v).
#[derive(Clone, Copy)]
pub(super) struct Farthest {
    pub seems: f64,
    pub corners: [DVec3; 3],
    /// (u, v) of the corners.
    pub places: [(f64, f64); 3],
    /// Of the corners.
    pub weights: [f64; 3],
    pub uv: (f64, f64),
}

impl Farthest {
    /// A corner of a triangle, which seems nearer than any point.
    pub fn corner(corners: [DVec3; 3], places: [(f64, f64); 3]) -> Self {
        Self { seems: -1.0, corners, places, weights: [1.0, 0.0, 0.0], uv: places[0] }
    }

    fn p(&self) -> DVec3 {
        weighted(self.corners, self.weights)
    }
}

/// The point of a triangle with such weights of its corners.
pub(super) fn weighted(corners: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}

/// The place with such weights of those of the corners.
fn weighted_place(uv: [(f64, f64); 3], w: [f64; 3]) -> (f64, f64) {
    (uv[0].0 * w[0] + uv[1].0 * w[1] + uv[2].0 * w[2], uv[0].1 * w[0] + uv[1].1 * w[1] + uv[2].1 * w[2])
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
    let mut seen = Farthest::corner(points, uv);
    let place = |w: [f64; 3]| weighted_place(uv, w);
    let mut middles = [0.0; 3];
    for (a, b, c) in weights() {
        let w = [a, b, c].map(|n| n as f64 / SIX as f64);
        let (at, p) = (place(w), weighted(points, w));
        let there = point(at);
        if let Some(k) = middle([a, b, c]) {
            middles[k] = (there - p).dot(normal);
        }
        let seems = off(p, there, normal);
        if seems > seen.seems {
            seen = Farthest { seems, weights: w, uv: at, ..seen };
        }
    }
    if let Some((seems, w)) = peak(middles).filter(|(seems, _)| *seems > seen.seems) {
        seen = Farthest { seems, weights: w, uv: place(w), ..seen };
    }
    seen
}

/// The point with its distance from a near surface point, which its foot is no farther than: where (u, v) shear a surface, what is off along
/// the normal of the triangle may be less than the distance.
pub(super) fn bounded(evaluator: Evaluator, seen: Farthest) -> Farthest {
    let jet = evaluator.jet(seen.uv.0, seen.uv.1);
    let p = seen.p();
    let gap = p - jet.p;
    let Some(by) = step(jet.du, jet.dv, gap) else { return Farthest { seems: gap.length(), ..seen } };
    let ((u0, u1), (v0, v1)) = ranges(evaluator.surface());
    let uv = ((seen.uv.0 + by.x).clamp(u0, u1), (seen.uv.1 + by.y).clamp(v0, v1));
    let there = evaluator.point(uv.0, uv.1).distance(p);
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

/// The largest distance of those that were followed, and the points that have the largest ones.
#[derive(Clone)]
pub(super) struct Largest {
    pub distance: f64,
    /// Distances with their points, the largest first.
    at: Vec<(f64, Farthest)>,
}

impl Largest {
    pub fn new() -> Self {
        Self { distance: 0.0, at: Vec::new() }
    }

    /// The distance from which on a triangle may be climbed in.
    fn least_wanted(&self) -> f64 {
        let last = self.at.get(SETTINGS.climbed - 1).map_or(0.0, |last| last.0);
        last.max(SETTINGS.min_climbed_share * self.distance)
    }

    /// Follows the triangles that seem farthest to their feet.
    pub fn follow(&mut self, evaluator: Evaluator, mut farthest: Vec<Farthest>, tolerance: &Tolerance) {
        farthest.retain(|s| s.seems > tolerance.rounding.max(self.least_wanted()));
        farthest.sort_by(|a, b| b.seems.total_cmp(&a.seems));
        let (u, v) = ranges(evaluator.surface());
        let mut followed = 0;
        for seen in farthest {
            if seen.seems < self.least_wanted() || followed == SETTINGS.max_followed {
                break;
            }
            let (distance, uv) = foot_within(evaluator, seen.p(), seen.uv, u, v);
            // What only seems far, as beside a pole, is passed by.
            followed += usize::from(distance >= SETTINGS.min_true_share * seen.seems);
            let place = self.at.partition_point(|known| known.0 >= distance);
            if place < SETTINGS.climbed {
                self.at.truncate(SETTINGS.climbed - 1);
                self.at.insert(place, (distance, Farthest { uv, ..seen }));
            }
            self.distance = self.distance.max(distance);
        }
    }

    /// The largest distance in the triangles of the farthest points, climbed to from there.
    pub fn climbed(self, evaluator: Evaluator) -> f64 {
        let ranges = ranges(evaluator.surface());
        self.at.iter().map(|(distance, from)| climbed(evaluator, ranges, *distance, *from)).fold(self.distance, f64::max)
    }
}

/// The largest distance in the triangle of a point that is so far: of six points round it the farthest is taken as long as one is farther,
/// then nearer ones are tried. The distance of each is the least to two feet: one searched from the last foot, one from the place of the
/// point in (u, v), which is never farther than that place.
fn climbed(evaluator: Evaluator, (u, v): ((f64, f64), (f64, f64)), mut most: f64, from: Farthest) -> f64 {
    const AROUND: [[f64; 3]; 6] =
        [[1.0, -1.0, 0.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0], [0.0, -1.0, 1.0]];
    let Farthest { corners, places, mut weights, mut uv, .. } = from;
    let (mut tried, mut width) = (0, SETTINGS.steps.0);
    while width > SETTINGS.steps.1 && tried < SETTINGS.max_tried {
        let before = most;
        for by in AROUND {
            let next = [0, 1, 2].map(|k| weights[k] + width * by[k]);
            if next.iter().any(|w| *w < 0.0) {
                continue;
            }
            tried += 1;
            let p = weighted(corners, next);
            let feet = [uv, weighted_place(places, next)].map(|guess| foot_within(evaluator, p, guess, u, v));
            let (distance, foot) = if feet[0].0 < feet[1].0 { feet[0] } else { feet[1] };
            if distance > most {
                (most, weights, uv) = (distance, next, foot);
            }
        }
        if most <= before {
            width *= 0.5;
        }
    }
    most
}
