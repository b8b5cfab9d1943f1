//! The cubic triangle [Clough & Tocher 1965]: three cubics about the centre of a triangle that meet its corners with their
//! gradients. Towards the centre of the neighbour the slope is linear along each side: neighbours are C1, quadratics are reproduced,
//! and a short side does not pass its steepness on through a long triangle, as slopes at right angles to it would.

use glam::DVec2;

use crate::base::digest::{StableHash, StableHasher};
use crate::base::range::Interval;

/// Where the ordinate with these three indices of corners stands in the row of ten.
const fn place(a: usize, b: usize, c: usize) -> usize {
    let mut counts = [0; 3];
    counts[a] += 1;
    counts[b] += 1;
    counts[c] += 1;
    match counts {
        [3, 0, 0] => 0,
        [0, 3, 0] => 1,
        [0, 0, 3] => 2,
        [2, 1, 0] => 3,
        [1, 2, 0] => 4,
        [0, 2, 1] => 5,
        [0, 1, 2] => 6,
        [1, 0, 2] => 7,
        [2, 0, 1] => 8,
        _ => 9,
    }
}

/// The same of all indices, looked up where heights are asked for.
const PLACES: [[[usize; 3]; 3]; 3] = {
    let mut places = [[[0; 3]; 3]; 3];
    let mut k = 0;
    while k < 27 {
        places[k / 9][k / 3 % 3][k % 3] = place(k / 9, k / 3 % 3, k % 3);
        k += 1;
    }
    places
};

/// A cubic over a triangle in (u, v).
#[derive(Clone, Copy, Debug)]
pub struct TrianglePiece {
    /// Corners, counter-clockwise; the third one is the centre of the triangle that this is a third of.
    pub corners: [DVec2; 3],
    /// Bézier ordinates.
    pub ordinates: [f64; 10],
    /// Gradients of the weights of the corners.
    gradients: [DVec2; 3],
}

impl StableHash for TrianglePiece {
    fn hash_into(&self, to: &mut StableHasher) {
        (self.corners.map(|c| (c.x, c.y)), self.ordinates).hash_into(to);
    }
}

impl TrianglePiece {
    fn new(corners: [DVec2; 3], ordinates: [f64; 10]) -> Self {
        let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
        let gradient = |k: usize| (corners[(k + 2) % 3] - corners[(k + 1) % 3]).perp() / area;
        Self { corners, ordinates, gradients: [0, 1, 2].map(gradient) }
    }

    fn at(&self, a: usize, b: usize, c: usize) -> f64 {
        self.ordinates[PLACES[a][b][c]]
    }

    /// Weights of the corners at a place, read from the nearest corner: exact there, however thin the triangle.
    pub fn weights(&self, p: DVec2) -> [f64; 3] {
        let arms = self.corners.map(|c| p - c);
        let far = arms.map(DVec2::length_squared);
        let near = if far[0] <= far[1] && far[0] <= far[2] { 0 } else { 1 + usize::from(far[2] < far[1]) };
        let mut weights = self.gradients.map(|g| g.dot(arms[near]));
        weights[near] += 1.0;
        weights
    }

    /// Corners of the box about it.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let [a, b, c] = self.corners;
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// Whether it may meet a rectangle; surely says so where it does.
    pub fn meets(&self, low: DVec2, high: DVec2) -> bool {
        let (own_low, own_high) = self.bounds();
        let beside = own_low.cmpgt(high).any() || own_high.cmplt(low).any();
        let corners = [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)].map(|p| self.weights(p));
        !beside && (0..3).all(|k| corners.iter().any(|w| w[k] >= -crate::base::tolerance::EPSILON))
    }

    /// Value and derivatives in (u, v).
    pub fn height(&self, p: DVec2) -> Height {
        let w = self.weights(p);
        let q = |a: usize, b: usize| (0..3).map(|c| w[c] * self.at(a, b, c)).sum::<f64>();
        let second = [[q(0, 0), q(0, 1), q(0, 2)], [q(0, 1), q(1, 1), q(1, 2)], [q(0, 2), q(1, 2), q(2, 2)]];
        let first = [0, 1, 2].map(|a| (0..3).map(|b| w[b] * second[a][b]).sum::<f64>());
        let g = &self.gradients;
        let bend = |i: usize, j: usize| {
            6.0 * (0..3).flat_map(|a| (0..3).map(move |b| (a, b))).map(|(a, b)| second[a][b] * g[a][i] * g[b][j]).sum::<f64>()
        };
        Height {
            h: (0..3).map(|a| w[a] * first[a]).sum(),
            d1: (0..3).map(|a| g[a] * (3.0 * first[a])).sum(),
            d2: [bend(0, 0), bend(0, 1), bend(1, 1)],
        }
    }

    /// Ranges over the part of it in a rectangle: Taylor's formula about the middle of that part's box, with second derivatives
    /// that are linear, and the hulls of Bézier ordinates.
    pub fn heights(&self, low: DVec2, high: DVec2) -> Heights {
        let (own_low, own_high) = self.bounds();
        let (low, high) = (low.max(own_low), high.min(own_high));
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(DVec2::ZERO));
        let at = self.height(middle);
        let ends = self.corners.map(|c| self.height(c).d2);
        let g = &self.gradients;
        let over = |k: usize| {
            let slope: DVec2 = (0..3).map(|c| g[c] * ends[c][k]).sum();
            let off = slope.abs().dot(half);
            Interval { low: at.d2[k] - off, high: at.d2[k] + off }
        };
        let second = [0, 1, 2].map(over);
        let (a, b) = (Interval::around_zero(half.x), Interval::around_zero(half.y));
        let d1 = [second[0] * a + second[1] * b + Interval::at(at.d1.x), second[1] * a + second[2] * b + Interval::at(at.d1.y)];
        let square = |h: f64| Interval { low: 0.0, high: 0.5 * h * h };
        let bent = second[0] * square(half.x) + second[1] * Interval::around_zero(half.x * half.y) + second[2] * square(half.y);
        let h = a * at.d1.x + b * at.d1.y + bent + Interval::at(at.h);
        let hull = |values: &[f64]| values.iter().fold(Interval::at(values[0]), |r, x| r.union(Interval::at(*x)));
        let slopes = self.slopes();
        let known = |k: usize| hull(&slopes.map(|d| d[k]));
        Heights {
            h: h.intersection(hull(&self.ordinates)),
            d1: [d1[0].intersection(known(0)), d1[1].intersection(known(1))],
            d2: [0, 1, 2].map(|k| second[k].intersection(hull(&ends.map(|e| e[k])))),
        }
    }

    /// Bézier ordinates of the gradient: three corners, then the three sides'.
    fn slopes(&self) -> [DVec2; 6] {
        let slope = |(a, b): (usize, usize)| (0..3).map(|c| self.gradients[c] * (3.0 * self.at(a, b, c))).sum();
        [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].map(slope)
    }

    /// Those of the side between the first two corners.
    pub fn side_slopes(&self) -> [DVec2; 3] {
        let [a, b, _, between, ..] = self.slopes();
        [a, between, b]
    }

    /// Bézier ordinates of the height along the side between the first two corners.
    pub fn side_heights(&self) -> [f64; 4] {
        [place(0, 0, 0), place(0, 0, 1), place(0, 1, 1), place(1, 1, 1)].map(|k| self.ordinates[k])
    }
}

/// A corner of a triangle: its place in model units, its height and the gradient there.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Place in the plane.
    pub at: DVec2,
    /// Height.
    pub h: f64,
    /// Gradient.
    pub slope: DVec2,
}

/// The three pieces over a triangle, counter-clockwise; piece k has the side from corner k to the next one. `opposite` are the
/// corners of the neighbours across the sides that are not on them, none on the border; `size` are the lengths of the box over which
/// u and v run 0…1 from the origin.
pub fn pieces(corners: &[Corner; 3], opposite: [Option<DVec2>; 3], size: DVec2) -> [TrianglePiece; 3] {
    let center = (corners[0].at + corners[1].at + corners[2].at) / 3.0;
    // A third of the way from corner a towards a place.
    let towards = |a: usize, p: DVec2| corners[a].h + corners[a].slope.dot(p - corners[a].at) / 3.0;
    let next = |a: usize| (a + 1) % 3;
    let side = [0, 1, 2].map(|a| (towards(a, corners[next(a)].at), towards(next(a), corners[a].at)));
    let inward = [0, 1, 2].map(|a| towards(a, center));
    // Where the line from the centre to that of the neighbour crosses a side, as a share of it; on the border in its middle.
    let crossing = |a: usize| {
        let (from, way) = (corners[a].at, corners[next(a)].at - corners[a].at);
        opposite[a].map_or(0.5, |other| {
            let apex = corners[next(next(a))].at;
            (1.0 + (apex - from).perp_dot(other - apex) / way.perp_dot(other - apex)) / 3.0
        })
    };
    // The ordinate in the middle of each piece: the slope across its side is linear.
    let middle = [0, 1, 2].map(|a| {
        let b = next(a);
        let foot = crossing(a);
        let (near, far) = side[a];
        let across = |inner: f64, first: f64, second: f64| inner - (1.0 - foot) * first - foot * second;
        (1.0 - foot) * near + foot * far + 0.5 * (across(inward[a], corners[a].h, near) + across(inward[b], far, corners[b].h))
    });
    // Towards the centre every ordinate is the mean of three round it.
    let inner = [0, 1, 2].map(|a| (inward[a] + middle[a] + middle[(a + 2) % 3]) / 3.0);
    let top = (inner[0] + inner[1] + inner[2]) / 3.0;
    let uv = |p: DVec2| p / size;
    [0, 1, 2].map(|a| {
        let b = next(a);
        let mut ordinates = [0.0; 10];
        for (k, value) in [
            (place(0, 0, 0), corners[a].h),
            (place(1, 1, 1), corners[b].h),
            (place(2, 2, 2), top),
            (place(0, 0, 1), side[a].0),
            (place(0, 1, 1), side[a].1),
            (place(1, 1, 2), inward[b]),
            (place(1, 2, 2), inner[b]),
            (place(0, 2, 2), inner[a]),
            (place(0, 0, 2), inward[a]),
            (place(0, 1, 2), middle[a]),
        ] {
            ordinates[k] = value;
        }
        TrianglePiece::new([uv(corners[a].at), uv(corners[b].at), uv(center)], ordinates)
    })
}

/// Value, gradient and second derivatives (uu, uv, vv) of a height.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Height {
    /// Value.
    pub h: f64,
    /// Gradient.
    pub d1: DVec2,
    /// ∂uu, ∂uv, ∂vv.
    pub d2: [f64; 3],
}

/// Ranges of the same.
#[derive(Clone, Copy, Debug)]
pub struct Heights {
    /// Value.
    pub h: Interval,
    /// ∂u, ∂v.
    pub d1: [Interval; 2],
    /// ∂uu, ∂uv, ∂vv.
    pub d2: [Interval; 3],
}

impl Heights {
    pub(crate) fn union(self, other: Self) -> Self {
        let each = |a: &[Interval], b: &[Interval], k: usize| a[k].union(b[k]);
        Self {
            h: self.h.union(other.h),
            d1: [0, 1].map(|k| each(&self.d1, &other.d1, k)),
            d2: [0, 1, 2].map(|k| each(&self.d2, &other.d2, k)),
        }
    }
}
