//! The borders of surfaces with four sides, and which of them are one.

use glam::DVec3;

use crate::base::job;
use crate::base::tolerance::Tolerance;
use crate::surface::core::joined_piece::{JoinedPiece, Turn, foot, foot_round};
use crate::surface::core::surface::Surface;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::side::Side;

/// Steps along a border.
const STEPS: usize = 32;

/// A side of a surface, sampled.
pub struct Rim {
    /// v = 0, u = 1, v = 1, u = 0.
    side: usize,
    points: Vec<DVec3>,
    piece: JoinedPiece,
    /// The surface closes along it.
    closed: bool,
}

/// Two sides that are one curve.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Surface and side of both.
    pub ends: [(usize, usize); 2],
    /// They run against each other.
    pub reversed: bool,
    /// They are closed and begin at different points.
    pub apart: bool,
}

impl Link {
    /// The side of a surface that it joins.
    pub fn side(&self, n: usize) -> usize {
        if self.ends[0].0 == n { self.ends[0].1 } else { self.ends[1].1 }
    }

    /// The other surface and its side.
    pub fn other(&self, n: usize) -> (usize, usize) {
        if self.ends[0].0 == n { self.ends[1] } else { self.ends[0] }
    }

    /// The end that is not this one.
    pub fn from(&self, end: (usize, usize)) -> (usize, usize) {
        if self.ends[0] == end { self.ends[1] } else { self.ends[0] }
    }
}

/// How a surface lies whose side is entered at x = 0 (`ahead`) or at x = 1, its own direction turned or not.
pub fn turn(side: usize, ahead: bool, back_y: bool) -> Turn {
    Turn { swap: side.is_multiple_of(2), back_x: matches!(side, 1 | 2) == ahead, back_y }
}

impl Rim {
    /// The sides of a surface that are curves.
    pub fn all(surface: &Surface) -> Vec<Self> {
        job::poll();
        let curve = |side: &usize| !matches!(surface.side(*side), Side::Pole(_));
        (0..4).filter(curve).map(|side| Self::of(surface, side)).collect()
    }

    fn of(surface: &Surface, side: usize) -> Self {
        let piece = JoinedPiece::new(surface.clone(), turn(side, true, false), 0);
        let at = |n: usize| piece.jet(0.0, n as f64 / STEPS as f64, (OneSided::After, OneSided::After)).p;
        let closed = if side.is_multiple_of(2) { surface.closed().0 } else { surface.closed().1 };
        Self { side, points: (0..=STEPS).map(at).collect(), piece, closed }
    }

    /// How far it is from another one at the most, and where on it.
    pub fn apart(&self, other: &Self) -> (f64, DVec3) {
        let far = |p: DVec3| {
            let near = |n: &usize| other.points[*n].distance_squared(p);
            let start = (0..=STEPS).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap_or(0);
            let start = start as f64 / STEPS as f64;
            let w = if other.closed { foot_round(&other.piece, 0.0, start, p) } else { foot(&other.piece, start, p) };
            other.piece.jet(0.0, w, (OneSided::After, OneSided::After)).p.distance(p)
        };
        let each = self.points.iter().map(|p| (far(*p), *p));
        each.fold((0.0, self.points[0]), |most, next| if next.0 > most.0 { next } else { most })
    }

    /// Whether both are one curve, and if so whether they run against each other, and whether they begin at different points.
    fn same(&self, other: &Self, tolerance: &Tolerance) -> Option<(bool, bool)> {
        let ends = |rim: &Self| (rim.points[0], rim.points[STEPS]);
        let ((a, b), (c, d)) = (ends(self), ends(other));
        let one = |p: DVec3, q: DVec3| tolerance.same_point(p, q);
        let (reversed, apart) = match (one(a, c) && one(b, d), one(a, d) && one(b, c)) {
            (false, false) if self.closed && other.closed => (self.runs_against(other), true),
            (false, false) => return None,
            // Closed: a quarter of the way decides.
            (true, true) => {
                let (p, q) = (self.points[STEPS / 4], [other.points[STEPS / 4], other.points[STEPS - STEPS / 4]]);
                (p.distance(q[1]) < p.distance(q[0]), false)
            }
            (_, reversed) => (reversed, false),
        };
        (self.apart(other).0 <= tolerance.point && other.apart(self).0 <= tolerance.point).then_some((reversed, apart))
    }

    /// Of closed ones that are one curve: whether they run against each other, by what is a little farther on.
    fn runs_against(&self, other: &Self) -> bool {
        let near = |p: DVec3| {
            let far = |n: &usize| other.points[*n].distance_squared(p);
            (0..STEPS).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
        };
        let step = (near(self.points[STEPS / 8]) + STEPS - near(self.points[0])) % STEPS;
        step > STEPS / 2
    }
}

/// All pairs of sides of different surfaces that are one.
pub fn links(all: &[Surface], rims: &[Vec<Rim>], tolerance: &Tolerance) -> Vec<Link> {
    let mut found = Vec::new();
    for a in 0..all.len() {
        for b in a + 1..all.len() {
            for (x, y) in rims[a].iter().flat_map(|x| rims[b].iter().map(move |y| (x, y))) {
                if let Some((reversed, apart)) = x.same(y, tolerance) {
                    found.push(Link { ends: [(a, x.side), (b, y.side)], reversed, apart });
                }
            }
        }
    }
    found
}
