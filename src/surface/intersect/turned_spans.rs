//! Where along the profile of a surface of revolution a plane has points of it: the intervals between the places at which it meets the
//! profile, turned into the plane of symmetry.
//!
//! ```text
//!   plane  a z + b x = d        y² = g(v) = r(v)² − x(v)²,   x(v) = (d − a z(v)) / b
//!   r(v), z(v): the profile     x: distance from the axis along n less its part along the axis,
//!                               n the plane's normal; y: at right angles to that and to the axis
//!   s = (z − a d) / b: along the plane, across y
//! ```

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::solve::{bracketed, turn};
use crate::base::tolerance::{EPSILON, TOLD_APART, Tolerance};
use crate::geometry::Jet;
use crate::network::Chain;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::intersect::extrusions::{HalfSpace, stops};

/// Profiles that end within this share of the tolerance of the axis end in a pole.
const POLE: f64 = 0.25;

/// Curves and touches, or the intervals and places of the profile that they are over.
#[derive(Debug)]
pub(super) struct Found<C, T> {
    pub curves: Vec<C>,
    pub touches: Vec<T>,
}

impl<C, T> Default for Found<C, T> {
    fn default() -> Self {
        Self { curves: Vec::new(), touches: Vec::new() }
    }
}

/// A profile and a plane, both in the frame of the axis.
pub(super) struct Section {
    meridian: Chain,
    is_closed: bool,
    /// The plane, as above; b > 0.
    pub a: f64,
    pub b: f64,
    d: f64,
}

/// The section at a place of the profile: where it is in the plane, and y² with its derivatives by v.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub s: f64,
    /// y², negative where the plane has no points.
    pub g: f64,
    /// First and half the second derivative of it.
    pub slope: f64,
    pub bend: f64,
    /// Derivative of z.
    pub rise: f64,
    radius: f64,
}

/// An end of an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub v: f64,
    /// The residual: what y² is there, where it should be 0.
    pub residual: f64,
    pub kind: EndKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EndKind {
    /// The profile ends, or begins again.
    Border,
    /// Both sides go over into each other.
    Turn,
    /// Both sides cross each other, or meet in a pole.
    Node,
}

/// An interval of the profile over which the plane has two points at each place.
pub(super) struct Span {
    pub ends: [End; 2],
    /// Where it is less than analytic in between.
    pub breaks: Vec<f64>,
}

impl Section {
    /// Of a profile in the frame of the axis and (a, b, d).
    pub fn new(meridian: Chain, (a, b, d): (f64, f64, f64), tolerance: &Tolerance) -> Self {
        let is_closed = meridian.is_closed(tolerance);
        Self { meridian, is_closed, a, b, d }
    }

    /// x and z of a place along the plane.
    pub fn across_and_along(&self, s: f64) -> (f64, f64) {
        (self.b * self.d - self.a * s, self.a * self.d + self.b * s)
    }

    /// The section at a place; of a closed profile v and v + 1 are one place.
    pub fn place(&self, v: f64) -> Place {
        self.of_jet(&self.meridian.jet(if self.is_closed { v.rem_euclid(1.0) } else { v }))
    }

    /// The same from what lies before it.
    pub fn place_before(&self, v: f64) -> Place {
        let part = if self.is_closed { v.rem_euclid(1.0) } else { v };
        self.of_jet(&self.meridian.jet_before(if self.is_closed && part == 0.0 { 1.0 } else { part }))
    }

    fn of_jet(&self, jet: &Jet) -> Place {
        let (r, z, dr, dz) = (jet.p.x, jet.p.z, jet.d1.x, jet.d1.z);
        let lean = self.a / self.b;
        let (x, dx) = (self.d / self.b - lean * z, -lean * dz);
        Place {
            s: (z - self.a * self.d) / self.b,
            g: (r - x) * (r + x),
            slope: 2.0 * (r * dr - x * dx),
            bend: dr * dr + r * jet.d2.x - dx * dx + x * lean * jet.d2.z,
            rise: dz,
            radius: r,
        }
    }

    /// The intervals over which the plane has points, and places at which it touches. `None` where it runs along the profile or what it
    /// does there could not be told.
    pub fn spans(&self, tolerance: &Tolerance) -> Result<Option<Found<Span, f64>>> {
        let mut zeros = Vec::new();
        for side in [1.0, -1.0] {
            let line = HalfSpace { inward: DVec3::new(side * self.b, 0.0, self.a), height: self.d };
            let Some(more) = stops(&self.meridian, &line, tolerance)? else { return Ok(None) };
            zeros.extend(more);
        }
        zeros.sort_by(f64::total_cmp);
        zeros.dedup();
        let near = tolerance.point / self.meridian.length();
        let (low, high) = self.domain(&mut zeros);
        let at_low = !self.is_closed && zeros.first().is_some_and(|v| *v <= near);
        let at_high = !self.is_closed && zeros.last().is_some_and(|v| *v >= 1.0 - near);
        zeros.retain(|v| self.is_closed || *v > near && *v < 1.0 - near);
        let mut ends = vec![End { v: low, residual: 0.0, kind: EndKind::Border }];
        let mut found = Found::default();
        let all = [&[low][..], &zeros, &[high]].concat();
        for w in all.windows(3) {
            let (from, to) = (0.5 * (w[0] + w[1]), 0.5 * (w[1] + w[2]));
            if !self.resolve(w[1], (from, to), &mut ends, &mut found.touches, tolerance) {
                return Ok(None);
            }
        }
        ends.push(End { v: high, residual: 0.0, kind: EndKind::Border });
        self.merge(&mut ends, &mut found.touches, tolerance);
        for w in ends.windows(2).filter(|w| w[1].v > w[0].v) {
            let middle = 0.5 * (w[0].v + w[1].v);
            if self.place(middle).g <= 0.0 {
                let ends = [(at_low, w[0]), (at_high, w[1])];
                found.touches.extend(ends.into_iter().filter(|(at, end)| *at && end.kind == EndKind::Border).map(|(_, end)| end.v));
                continue;
            }
            let ends = [self.settled(w[0], middle, tolerance), self.settled(w[1], middle, tolerance)];
            let turns = if self.is_closed { &[-1.0, 0.0, 1.0, 2.0][..] } else { &[0.0] };
            let own = [&[0.0][..], &chain_breaks(&self.meridian)].concat();
            let mut breaks: Vec<f64> = turns.iter().flat_map(|turn| own.iter().map(move |v| v + turn)).collect();
            breaks.retain(|v| *v > ends[0].v + EPSILON && *v < ends[1].v - EPSILON);
            found.curves.push(Span { ends, breaks });
        }
        Ok(Some(found))
    }

    /// Where the profile begins and ends; a closed one in the middle of the longest way between places, which are moved by whole turns.
    fn domain(&self, zeros: &mut [f64]) -> (f64, f64) {
        let (Some(first), true) = (zeros.first().copied(), self.is_closed) else { return (0.0, 1.0) };
        let next = |k: usize| zeros.get(k + 1).copied().unwrap_or(first + 1.0);
        let gaps = (0..zeros.len()).map(|k| (next(k) - zeros[k], 0.5 * (next(k) + zeros[k])));
        let low = gaps.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, middle)| middle);
        zeros.iter_mut().filter(|v| **v < low).for_each(|v| *v += 1.0);
        zeros.sort_by(f64::total_cmp);
        (low, low + 1.0)
    }

    /// What a place where the profile comes to the plane means: ends of intervals, or a touch. Whether that could be told.
    fn resolve(&self, at: f64, (from, to): (f64, f64), ends: &mut Vec<End>, touches: &mut Vec<f64>, tolerance: &Tolerance) -> bool {
        let live = self.place(from).g > 0.0;
        if live != (self.place(to).g > 0.0) {
            ends.push(self.zero(from, to));
            return true;
        }
        let Some(best) = self.extreme(at, (from, to), live) else { return false };
        let g = self.place(best).g;
        if live != (g > 0.0) {
            ends.extend([self.zero(from, best), self.zero(best, to)]);
        } else if !live {
            touches.push(best);
        } else if 2.0 * g.sqrt() <= TOLD_APART * tolerance.point {
            ends.push(End { v: best, residual: g, kind: EndKind::Node });
        }
        true
    }

    /// The place between two at which y² changes its sign.
    fn zero(&self, from: f64, to: f64) -> End {
        let v = bracketed(from, to, 0.0, |v| {
            let place = self.place(v);
            (place.g, place.slope)
        });
        End { v, residual: self.place(v).g, kind: EndKind::Turn }
    }

    /// The lowest (`lowest`) or highest place of y² about another one.
    fn extreme(&self, at: f64, (from, to): (f64, f64), lowest: bool) -> Option<f64> {
        const FIRST: f64 = 1.0 / (1 << 20) as f64;
        let falls = |v: f64| (self.place(v).slope < 0.0) == lowest;
        let mut reach = FIRST * (to - from);
        while reach < to - from {
            let (low, high) = ((at - reach).max(from), (at + reach).min(to));
            if falls(low) && !falls(high) {
                return turn(low, high, true, |v| Some(falls(v)));
            }
            reach *= 2.0;
        }
        None
    }

    /// Joins ends that are one place: two intervals in a node, and an interval without length in a touch.
    fn merge(&self, ends: &mut Vec<End>, touches: &mut Vec<f64>, tolerance: &Tolerance) {
        let mut k = 0;
        while k + 1 < ends.len() {
            let (x, y) = (ends[k], ends[k + 1]);
            let far = (self.place(x.v).s - self.place(y.v).s).abs();
            let live = self.place(0.5 * (x.v + y.v)).g > 0.0;
            let best = self.extreme(0.5 * (x.v + y.v), (x.v, y.v), !live).map(|v| (v, self.place(v).g));
            match best {
                Some((v, g)) if x.kind == EndKind::Turn && y.kind == EndKind::Turn && far <= TOLD_APART * tolerance.point => {
                    if live && 2.0 * g.max(0.0).sqrt() > TOLD_APART * tolerance.point {
                        k += 1;
                        continue;
                    }
                    ends.drain(k..k + 2);
                    if live {
                        touches.push(v);
                    } else {
                        ends.insert(k, End { v, residual: g, kind: EndKind::Node });
                    }
                }
                _ => k += 1,
            }
        }
    }

    /// An end of an interval with points in its middle: the border of the profile may have none, by rounding or beside a pole.
    fn settled(&self, end: End, middle: f64, tolerance: &Tolerance) -> End {
        let place = self.place(end.v);
        if end.kind != EndKind::Border {
            end
        } else if place.radius.abs() <= POLE * tolerance.point && place.g.abs().sqrt() <= POLE * tolerance.point {
            End { residual: place.g, kind: EndKind::Node, ..end }
        } else if place.g < 0.0 {
            self.zero(end.v.min(middle), end.v.max(middle))
        } else {
            end
        }
    }
}
