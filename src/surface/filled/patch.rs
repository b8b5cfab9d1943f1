//! How the unit square lies in a corner of a hole's plane: a Coons patch between two halves of sides and the lines to the centre.

use glam::DVec2;

use crate::surface::filled::ribbon::Ribbons;

/// Steps along each direction of a patch at which its map is looked at.
const STEPS: usize = 6;
/// Rounds in which the centre is moved, each with half the step of the one before.
const ROUNDS: usize = 6;

/// Half a side, from the corner to its middle.
#[derive(Clone, Copy, Debug)]
pub struct Half {
    pub side: usize,
    pub from: f64,
    pub to: f64,
}

impl Half {
    /// Fraction of the side.
    pub fn fraction(self, t: f64) -> f64 {
        self.from + (self.to - self.from) * t
    }

    /// Place and derivative by t, in the plane.
    pub fn flat(self, ribbons: &Ribbons, t: f64) -> EdgePlace {
        let (p, d) = ribbons.flat(self.side, self.fraction(t));
        EdgePlace { t, p, d: d * (self.to - self.from) }
    }
}

/// A place of half a side, in the plane.
#[derive(Clone, Copy, Debug)]
pub struct EdgePlace {
    pub t: f64,
    pub p: DVec2,
    pub d: DVec2,
}

/// The part of a hole about one corner: u runs along the side that begins there, v back along the one that ends there.
#[derive(Clone, Copy, Debug)]
pub struct Kite {
    pub bottom: Half,
    pub left: Half,
    ends: [EdgePlace; 4],
    pub centre: DVec2,
}

impl Kite {
    fn new(ribbons: &Ribbons, corner: usize) -> Self {
        let n = ribbons.sides.len();
        let bottom = Half { side: corner, from: 0.0, to: 0.5 };
        let left = Half { side: (corner + n - 1) % n, from: 1.0, to: 0.5 };
        let ends = [bottom.flat(ribbons, 0.0), bottom.flat(ribbons, 1.0), left.flat(ribbons, 0.0), left.flat(ribbons, 1.0)];
        Self { bottom, left, ends, centre: DVec2::ZERO }
    }

    /// Place and both derivatives, of places of the bottom and the left edge.
    pub fn map(&self, a: &EdgePlace, b: &EdgePlace) -> [DVec2; 3] {
        let (u, v) = (a.t, b.t);
        let (corner, east, north, centre) = (self.ends[0].p, self.ends[1].p, self.ends[3].p, self.centre);
        let (top, right) = (north.lerp(centre, u), east.lerp(centre, v));
        let low = corner.lerp(east, u);
        let high = north.lerp(centre, u);
        let place = a.p * (1.0 - v) + top * v + b.p * (1.0 - u) + right * u - low.lerp(high, v);
        let du = a.d * (1.0 - v) + (centre - north) * v - b.p + right - ((east - corner) * (1.0 - v) + (centre - north) * v);
        let dv = top - a.p + b.d * (1.0 - u) + (centre - east) * u - (high - low);
        [place, du, dv]
    }
}

/// The kites of a hole round the centre about which they are least distorted, and the least of their Jacobians.
pub fn kites(ribbons: &Ribbons) -> (Vec<Kite>, f64) {
    let mut all: Vec<Kite> = (0..ribbons.sides.len()).map(|k| Kite::new(ribbons, k)).collect();
    let steps = || (0..=STEPS).map(|k| k as f64 / STEPS as f64);
    let edges: Vec<[Vec<EdgePlace>; 2]> =
        all.iter().map(|k| [k.bottom, k.left].map(|half| steps().map(|t| half.flat(ribbons, t)).collect())).collect();
    let least = |all: &mut [Kite], centre: DVec2| {
        let mut least = f64::INFINITY;
        for (kite, [bottom, left]) in all.iter_mut().zip(&edges) {
            kite.centre = centre;
            for (a, b) in bottom.iter().flat_map(|a| left.iter().map(move |b| (a, b))) {
                let [_, du, dv] = kite.map(a, b);
                least = least.min(du.perp_dot(dv));
            }
        }
        least
    };
    let outline: Vec<DVec2> = edges.iter().flat_map(|[bottom, _]| bottom.iter().map(|p| p.p)).collect();
    let mut centre = outline.iter().sum::<DVec2>() / outline.len() as f64;
    let mut best = least(&mut all, centre);
    let mut step = 0.25;
    for _ in 0..ROUNDS {
        for way in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
            let next = centre + way * step;
            let found = least(&mut all, next);
            // A little more is not worth a centre that is off the middle.
            if found > best + 0.02 * best.abs() {
                (centre, best) = (next, found);
            }
        }
        step *= 0.5;
    }
    least(&mut all, centre);
    (all, best)
}
