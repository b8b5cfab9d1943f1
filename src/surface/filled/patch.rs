//! How unit squares lie in a hole's plane: Coons patches between sides, or halves of them, and straight lines.
//!
//! One patch at each corner round a centre; where corners are flat or turn back, one at each side round an inner polygon.

use glam::DVec2;

use crate::surface::filled::ribbon::Ribbons;

/// Steps along each direction of a patch at which its map is looked at.
const STEPS: usize = 6;
/// Rounds in which the centre is moved, each with half the step of the one before.
const ROUNDS: usize = 6;
/// Sine of the angle between u and v above which patches at corners are good enough.
const ROUND: f64 = 0.5;
/// Share of the way from corners to the centre at which an inner polygon has its corners.
const INNER: f64 = 0.4;

/// A part of a side.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    pub side: usize,
    pub from: f64,
    pub to: f64,
}

impl Part {
    /// Fraction of the side.
    pub fn fraction(self, t: f64) -> f64 {
        self.from + (self.to - self.from) * t
    }
}

/// A place of an edge of a patch, in the plane.
#[derive(Clone, Copy, Debug)]
pub struct EdgePlace {
    pub t: f64,
    pub p: DVec2,
    pub d: DVec2,
}

/// A part of a hole: edges that are no parts of sides are straight.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// What lies along v = 0.
    pub bottom: Option<Part>,
    /// What lies along u = 0.
    pub left: Option<Part>,
    /// Places of (0, 0), (1, 0), (0, 1) and (1, 1).
    corners: [DVec2; 4],
}

impl Patch {
    fn edge(ribbons: &Ribbons, part: Option<Part>, ends: (DVec2, DVec2), t: f64) -> EdgePlace {
        let Some(part) = part else { return EdgePlace { t, p: ends.0.lerp(ends.1, t), d: ends.1 - ends.0 } };
        let (p, d) = ribbons.flat(part.side, part.fraction(t));
        EdgePlace { t, p, d: d * (part.to - part.from) }
    }

    /// A place of the edge v = 0.
    pub fn on_bottom(&self, ribbons: &Ribbons, u: f64) -> EdgePlace {
        Self::edge(ribbons, self.bottom, (self.corners[0], self.corners[1]), u)
    }

    /// A place of the edge u = 0.
    pub fn on_left(&self, ribbons: &Ribbons, v: f64) -> EdgePlace {
        Self::edge(ribbons, self.left, (self.corners[0], self.corners[2]), v)
    }

    /// Place and both derivatives, of places of the bottom and the left edge.
    pub fn map(&self, a: &EdgePlace, b: &EdgePlace) -> [DVec2; 3] {
        let (u, v) = (a.t, b.t);
        let [corner, east, _, far] = self.corners;
        let right = east.lerp(far, v);
        let low = corner.lerp(east, u);
        let place = a.p * (1.0 - v) + b.p * (1.0 - u) + right * u - low * (1.0 - v);
        let du = (a.d - (east - corner)) * (1.0 - v) - b.p + right;
        let dv = low - a.p + b.d * (1.0 - u) + (far - east) * u;
        [place, du, dv]
    }
}

/// Patches round a centre, one at each corner.
fn kites(ribbons: &Ribbons, centre: DVec2) -> Vec<Patch> {
    let n = ribbons.sides.len();
    let at = |k: usize, f: f64| ribbons.flat(k % n, f).0;
    let one = |k: usize| Patch {
        bottom: Some(Part { side: k, from: 0.0, to: 0.5 }),
        left: Some(Part { side: (k + n - 1) % n, from: 1.0, to: 0.5 }),
        corners: [at(k, 0.0), at(k, 0.5), at(k + n - 1, 0.5), centre],
    };
    (0..n).map(one).collect()
}

/// Patches at the sides, and those of the polygon inside them: one like the hole, or one inscribed in a circle.
fn ring(ribbons: &Ribbons, centre: DVec2, round: bool) -> Vec<Patch> {
    let n = ribbons.sides.len();
    let outer: Vec<DVec2> = (0..n).map(|k| ribbons.flat(k, 0.0).0).collect();
    let nearest = outer.iter().map(|p| p.distance(centre)).fold(f64::INFINITY, f64::min);
    let rounded = |p: DVec2| centre + (p - centre).normalize_or_zero() * nearest * (1.0 - INNER);
    let inner: Vec<DVec2> = outer.iter().map(|p| if round { rounded(*p) } else { p.lerp(centre, INNER) }).collect();
    let next = |k: usize| (k + 1) % n;
    let at_side = |k: usize| Patch {
        bottom: Some(Part { side: k, from: 0.0, to: 1.0 }),
        left: None,
        corners: [outer[k], outer[next(k)], inner[k], inner[next(k)]],
    };
    let mut all: Vec<Patch> = (0..n).map(at_side).collect();
    if n == 4 {
        all.push(Patch { bottom: None, left: None, corners: [inner[0], inner[1], inner[3], inner[2]] });
        return all;
    }
    let middle = |k: usize| 0.5 * (inner[k] + inner[next(k)]);
    let inside = |k: usize| Patch { bottom: None, left: None, corners: [inner[k], middle(k), middle((k + n - 1) % n), centre] };
    all.extend((0..n).map(inside));
    all
}

/// The least Jacobian of patches, and the least sine of the angle between u and v.
fn worst(ribbons: &Ribbons, patches: &[Patch]) -> (f64, f64) {
    let steps = || (0..=STEPS).map(|k| k as f64 / STEPS as f64);
    let (mut least, mut sine) = (f64::INFINITY, f64::INFINITY);
    for patch in patches {
        let bottom: Vec<EdgePlace> = steps().map(|t| patch.on_bottom(ribbons, t)).collect();
        let left: Vec<EdgePlace> = steps().map(|t| patch.on_left(ribbons, t)).collect();
        for (a, b) in bottom.iter().flat_map(|a| left.iter().map(move |b| (a, b))) {
            let [_, du, dv] = patch.map(a, b);
            let area = du.perp_dot(dv);
            least = least.min(area);
            sine = sine.min(area / (du.length() * dv.length()).max(f64::MIN_POSITIVE));
        }
    }
    (least, sine)
}

/// The centre about which patches are least distorted, a little more not being worth one that is off the middle; with their least sine.
fn centred(ribbons: &Ribbons, of: impl Fn(&Ribbons, DVec2) -> Vec<Patch>) -> (Vec<Patch>, f64) {
    const WORTH: f64 = 0.02;
    let n = ribbons.sides.len();
    let outline: Vec<DVec2> =
        (0..n).flat_map(|k| (0..STEPS).map(move |i| (k, i as f64 / STEPS as f64))).map(|(k, f)| ribbons.flat(k, f).0).collect();
    let mut centre = outline.iter().sum::<DVec2>() / outline.len() as f64;
    let mut best = worst(ribbons, &of(ribbons, centre)).0;
    let mut step = 0.25;
    for _ in 0..ROUNDS {
        for way in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
            let next = centre + way * step;
            let found = worst(ribbons, &of(ribbons, next)).0;
            if found > best + WORTH * best.abs() {
                (centre, best) = (next, found);
            }
        }
        step *= 0.5;
    }
    let patches = of(ribbons, centre);
    let sine = worst(ribbons, &patches).1;
    (patches, sine)
}

/// The patches of a hole; none where they fold over.
pub fn patches(ribbons: &Ribbons) -> Option<Vec<Patch>> {
    let at_corners = centred(ribbons, kites);
    if at_corners.1 >= ROUND {
        return Some(at_corners.0);
    }
    let like = centred(ribbons, |ribbons, centre| ring(ribbons, centre, false));
    let round = centred(ribbons, |ribbons, centre| ring(ribbons, centre, true));
    let better = |a: (Vec<Patch>, f64), b: (Vec<Patch>, f64)| if b.1 > a.1 { b } else { a };
    let (best, sine) = better(better(at_corners, like), round);
    (sine > 0.0).then_some(best)
}
