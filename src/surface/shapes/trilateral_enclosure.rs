//! Bounds of the uniform trilateral.
//!
//! With D = C_b − C_c, w = b / (b + c), q = 1 − w and Q(t) = (t D′ − D) / t² = ∫₀¹ s D″(ts) ds the second derivatives of
//! P_a are w C_b″ + q C_c″ + (2q, 2q − 1, −2w) Q for bb, bc, cc: nothing is 0/0, also at the corner. Where only the weight
//! between two sides changes, P_a is linear.

use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::EPSILON;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::rails::line::Line;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::trilateral::Trilateral;

/// P_a over a range of its two weights: w, q, Q and the second derivatives of both sides.
struct CornerBounds {
    w: Interval,
    q: Interval,
    rest: Interval3,
    sides: (Interval3, Interval3),
}

impl CornerBounds {
    fn blended(&self) -> Interval3 {
        self.sides.0 * self.w + self.sides.1 * self.q
    }

    fn bb(&self) -> Interval3 {
        self.blended() + self.rest * (self.q * 2.0)
    }

    fn bc(&self) -> Interval3 {
        self.blended() + self.rest * (self.q * 2.0 - Interval::at(1.0))
    }

    fn cc(&self) -> Interval3 {
        self.blended() - self.rest * (self.w * 2.0)
    }
}

/// A side read from its corner outwards: the rail and whether it runs towards the corner.
type Outward<'a> = (&'a Rail, bool);

fn line((rail, back): Outward, t: Interval) -> Line {
    if back { rail.line(1.0 - t.high, 1.0 - t.low).backwards() } else { rail.line(t.low, t.high) }
}

/// The corner's part for weights in `b` and `c`, whose sum is in `t`.
fn corner(side_b: Outward, side_c: Outward, b: Interval, c: Interval, t: Interval) -> CornerBounds {
    let (f, g) = (line(side_b, t), line(side_c, t));
    let bent = f.d2 - g.d2;
    let share = |x: f64, y: f64, none: f64| if x + y > 0.0 { x / (x + y) } else { none };
    let w = Interval { low: share(b.low, c.high, 0.0), high: share(b.high, c.low, 1.0) };
    let q = Interval { low: share(c.low, b.high, 0.0), high: share(c.high, b.low, 1.0) };
    let near = Interval { low: 0.0, high: t.high };
    let at_corner = || (line(side_b, near).d2 - line(side_c, near).d2) * 0.5;
    let rest = if t.low <= EPSILON {
        at_corner()
    } else {
        let middle = 0.5 * (t.low + t.high);
        let at = (f.mid.d1 - g.mid.d1) * middle - (f.mid.p - g.mid.p);
        // (t D′ − D)′ = t D″.
        let away = (bent * (t * Interval::around_zero(f.half)) + at) * t.square().inverse();
        if t.low < 0.5 * t.high { away.intersection(at_corner()) } else { away }
    };
    CornerBounds { w, q, rest, sides: (f.d2, g.d2) }
}

impl Trilateral {
    /// Bounds over the part of a rectangle inside the triangle.
    pub fn enclosure(&self, u: (f64, f64), v: (f64, f64)) -> Enclosure {
        let unit = |low: f64, high: f64| Interval { low: low.clamp(0.0, 1.0), high: high.clamp(0.0, 1.0) };
        let [bottom, slant, left] = self.sides();
        let l = [unit(1.0 - u.1 - v.1, 1.0 - u.0 - v.0), unit(u.0, u.1), unit(v.0, v.1)];
        let a = corner((bottom, false), (left, false), l[1], l[2], unit(u.0 + v.0, u.1 + v.1));
        let b = corner((bottom, true), (slant, false), l[0], l[2], unit(1.0 - u.1, 1.0 - u.0));
        let c = corner((left, true), (slant, true), l[0], l[1], unit(1.0 - v.1, 1.0 - v.0));
        let second = [(a.bb() + b.bb()) * 0.5, (a.bc() + b.rest + c.rest) * 0.5, (a.cc() + c.bb()) * 0.5];
        let (x, y) = (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
        let half = (0.5 * (u.1 - u.0), 0.5 * (v.1 - v.0));
        // The middle of a rectangle over the slant may lie outside: Taylor's formula then starts on the slant.
        let over = (x + y - 1.0).max(0.0);
        let place = (x - 0.5 * over, y - 0.5 * over);
        let mid: Jet2 = self.jet(place.0, place.1);
        let mut enclosure = Enclosure::new(mid, (half.0 + 0.5 * over, half.1 + 0.5 * over), second, None);
        enclosure.half = half;
        enclosure
    }
}
