//! A net in powers, one polynomial a span.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::{DVec2, DVec3, DVec4};

use crate::geometry::shapes::bounds::binomial;
use crate::geometry::shapes::nurbs::COMMON_DEGREE;
use crate::surface::data::jet::Jet2;
use crate::surface::shapes::blend_powers::BlendPowers;
use crate::surface::shapes::net_enclosure::NetStrip;
use crate::surface::shapes::nurbs::{NurbsSurface, multiplicity, quotient};
use crate::surface::shapes::polynomial_pieces::BoxBends;
use crate::surface::shapes::third_derivative_bounds::{DerivativesAlong, ThirdDerivativeBounds};

/// What is made of a net: shared by all that use it at the same time, and gone with the last of them, for it takes many times
/// the room of the net.
#[derive(Debug)]
pub(crate) struct Powers {
    pub(crate) degree: (usize, usize),
    pub(crate) stops: (Stops, Stops),
    /// Coefficients of each span (u fastest): those of s^i t^j with i fastest.
    pub(crate) powers: Vec<DVec4>,
    pub(crate) thirds: ThirdDerivativeBounds,
    /// Knots at which second derivatives may jump.
    pub(crate) rough: (Vec<f64>, Vec<f64>),
    /// Those of them at which first derivatives jump.
    pub(crate) corners: (Vec<f64>, Vec<f64>),
}

/// Knots without repetition, 0 and 1 among them, and one over the widths between them.
#[derive(Debug)]
pub(crate) struct Stops {
    pub(crate) at: Vec<f64>,
    pub(crate) by: Vec<f64>,
    /// Where in a span, from 0 to 1, its powers are taken.
    about: f64,
}

impl Stops {
    fn new(at: Vec<f64>, degree: usize) -> Self {
        Self { by: at.windows(2).map(|w| 1.0 / (w[1] - w[0])).collect(), at, about: about(degree) }
    }

    /// The span of a parameter, the place in it, from 0 to 1 less where its powers are taken, and one over its width.
    pub(crate) fn place(&self, x: f64) -> (usize, f64, f64) {
        let (stops, n) = (&self.at, self.by.len());
        // Even knots are met at once.
        let mut k = ((x * n as f64) as usize).min(n - 1);
        while k > 0 && x < stops[k] {
            k -= 1;
        }
        while k + 1 < n && x >= stops[k + 1] {
            k += 1;
        }
        (k, (x - stops[k]) * self.by[k] - self.about, self.by[k])
    }
}

/// What a surface is made ready by, while somebody holds it.
#[derive(Debug)]
pub(crate) struct Held<T>(Mutex<Weak<T>>);

impl<T> Default for Held<T> {
    fn default() -> Self {
        Self(Mutex::new(Weak::new()))
    }
}

impl<T> Held<T> {
    pub(crate) fn take(&self, make: impl FnOnce() -> Option<T>) -> Option<Arc<T>> {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(held) = held.upgrade() {
            return Some(held);
        }
        let made = Arc::new(make()?);
        *held = Arc::downgrade(&made);
        Some(made)
    }
}

/// The powers of a surface that is a net, or blended from curves.
#[derive(Debug, Default)]
pub(crate) struct Ready {
    pub net: Held<Powers>,
    pub blend: Held<BlendPowers>,
}

impl Powers {
    pub(crate) fn new(net: &NurbsSurface) -> Self {
        let (us, vs) = net.breaks();
        let stops = |inner: Vec<f64>| [vec![0.0], inner, vec![1.0]].concat();
        let stops = (stops(us), stops(vs));
        let (u_spans, v_spans) = (spans(net, true, &stops.0), spans(net, false, &stops.1));
        let coefficients = (coefficients(net.degree.0), coefficients(net.degree.1));
        let pieces = v_spans.iter().flat_map(|v| u_spans.iter().map(move |u| net.piece(u, v)));
        let powers = pieces.flat_map(|piece| powers(&piece, &coefficients));
        let repeated = |stops: &[f64], knots: &[f64], wanted: &dyn Fn(usize) -> bool| -> Vec<f64> {
            stops[1..stops.len() - 1].iter().copied().filter(|x| wanted(multiplicity(knots, *x))).collect()
        };
        let rough = |stops: &[f64], knots: &[f64], degree: usize| repeated(stops, knots, &|often| often + 1 >= degree);
        let rough = (rough(&stops.0, &net.knots.0, net.degree.0), rough(&stops.1, &net.knots.1, net.degree.1));
        let corners = |in_u: bool, rough: &[f64]| rough.iter().copied().filter(|x| net.has_corner(in_u, *x)).collect();
        Self {
            degree: net.degree,
            powers: powers.collect(),
            thirds: ThirdDerivativeBounds::new(stops.clone()),
            corners: (corners(true, &rough.0), corners(false, &rough.1)),
            rough,
            stops: (Stops::new(stops.0, net.degree.0), Stops::new(stops.1, net.degree.1)),
        }
    }
}

impl Powers {
    /// The point.
    pub(crate) fn point(&self, u: f64, v: f64) -> DVec3 {
        let ((i, s, _), (j, t, _)) = (self.stops.0.place(u), self.stops.1.place(v));
        let mut sum = DVec4::ZERO;
        for row in self.span(i, j).rchunks_exact(self.degree.0 + 1) {
            let value = row.iter().rev().fold(DVec4::ZERO, |value, c| value * s + *c);
            sum = sum * t + value;
        }
        sum.truncate() * (1.0 / sum.w)
    }

    /// Point and first derivatives; the others are 0.
    pub(crate) fn tangents(&self, u: f64, v: f64) -> Jet2 {
        let ((i, s, w), (j, t, h)) = (self.stops.0.place(u), self.stops.1.place(v));
        let mut sums = [DVec4::ZERO; 3];
        for row in self.span(i, j).rchunks_exact(self.degree.0 + 1) {
            let (mut value, mut slope) = (DVec4::ZERO, DVec4::ZERO);
            for c in row.iter().rev() {
                slope = slope * s + value;
                value = value * s + *c;
            }
            sums[2] = sums[2] * t + sums[0];
            sums[0] = sums[0] * t + value;
            sums[1] = sums[1] * t + slope;
        }
        let over = 1.0 / sums[0].w;
        let p = sums[0].truncate() * over;
        let du = (sums[1].truncate() - p * sums[1].w) * (over * w);
        let dv = (sums[2].truncate() - p * sums[2].w) * (over * h);
        Jet2 { p, du, dv, ..Jet2::default() }
    }

    /// Point and all derivatives.
    pub(crate) fn jet(&self, u: f64, v: f64) -> Jet2 {
        let ((i, s, w), (j, t, h)) = (self.stops.0.place(u), self.stops.1.place(v));
        // Value, ∂s, ∂t, ½ ∂ss, ∂st, ½ ∂tt.
        let mut sums = [DVec4::ZERO; 6];
        for row in self.span(i, j).rchunks_exact(self.degree.0 + 1) {
            let (mut value, mut slope, mut bend) = (DVec4::ZERO, DVec4::ZERO, DVec4::ZERO);
            for c in row.iter().rev() {
                bend = bend * s + slope;
                slope = slope * s + value;
                value = value * s + *c;
            }
            sums[5] = sums[5] * t + sums[2];
            sums[2] = sums[2] * t + sums[0];
            sums[0] = sums[0] * t + value;
            sums[4] = sums[4] * t + sums[1];
            sums[1] = sums[1] * t + slope;
            sums[3] = sums[3] * t + bend;
        }
        let scale = [1.0, w, h, 2.0 * w * w, w * h, 2.0 * h * h];
        for (sum, scale) in sums.iter_mut().zip(scale) {
            *sum *= scale;
        }
        quotient(&sums)
    }

    /// Second derivatives along a unit vector over a box in which they do not jump.
    pub(crate) fn bends(&self, net: &NurbsSurface, (low, high): (DVec2, DVec2), along: DVec3) -> BoxBends {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let DerivativesAlong { third, low, high } = self.thirds.along(net, &|at: DVec2| self.jet(at.x, at.y), (low, high), along);
        let jet = self.jet(middle.x, middle.y);
        let range = |k: usize, at: DVec3| {
            let (at, slack) = (at.dot(along), third[k] * half.x + third[k + 1] * half.y);
            let (low, high) = (low[k].max(at - slack), high[k].min(at + slack));
            (0.5 * (low + high), 0.5 * (high - low))
        };
        let ranges = [range(0, jet.duu), range(1, jet.duv), range(2, jet.dvv)];
        BoxBends { mid: ranges.map(|r| r.0), slack: ranges.map(|r| r.1) }
    }

    fn span(&self, i: usize, j: usize) -> &[DVec4] {
        let n = (self.degree.0 + 1) * (self.degree.1 + 1);
        &self.powers[(j * self.stops.0.by.len() + i) * n..][..n]
    }
}

pub(crate) fn spans(net: &NurbsSurface, in_u: bool, stops: &[f64]) -> Vec<NetStrip> {
    stops.windows(2).map(|w| net.strip(in_u, (w[0], w[1]))).collect()
}

/// Coefficients of powers from Bézier points, in both directions.
pub(crate) fn powers(net: &[Vec<DVec4>], (in_u, in_v): &(Vec<Vec<f64>>, Vec<Vec<f64>>)) -> Vec<DVec4> {
    let one = |points: &[DVec4], coefficients: &[Vec<f64>]| -> Vec<DVec4> {
        coefficients.iter().map(|row| points.iter().zip(row).map(|(point, x)| *point * *x).sum()).collect()
    };
    let rows: Vec<Vec<DVec4>> = net.iter().map(|row| one(row, in_u)).collect();
    let n = rows[0].len();
    let columns: Vec<Vec<DVec4>> = (0..n).map(|i| one(&rows.iter().map(|row| row[i]).collect::<Vec<_>>(), in_v)).collect();
    (0..rows.len()).flat_map(|j| columns.iter().map(move |c| c[j])).collect()
}

/// For each power, ascending, what it has of each Bézier point; points beyond the last entry have no share.
pub(crate) fn coefficients(degree: usize) -> Vec<Vec<f64>> {
    let from_start = |k: usize, i: usize| {
        let sign = if (k - i).is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * binomial(degree, k) * binomial(k, i)
    };
    let row = |k: usize| -> Vec<f64> {
        if about(degree) == 0.0 {
            (0..=k).map(|i| from_start(k, i)).collect()
        } else {
            (0..=degree).map(|i| from_middle(degree, i, k)).collect()
        }
    };
    (0..=degree).map(row).collect()
}

/// Where in a span, from 0 to 1, the powers of a degree are taken: at its start while that loses nothing to speak of, else in its middle.
pub(crate) fn about(degree: usize) -> f64 {
    if degree <= COMMON_DEGREE { 0.0 } else { 0.5 }
}

/// The coefficient of x^k in the i-th Bernstein polynomial of degree p at ½ + x.
fn from_middle(p: usize, i: usize, k: usize) -> f64 {
    let term = |m: usize| {
        let sign = if (k - m).is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * binomial(i, m) * binomial(p - i, k - m)
    };
    let first = k.saturating_sub(p - i);
    let sum: f64 = (first..=k.min(i)).map(term).sum();
    (0..p - k).fold(binomial(p, i) * sum, |x, _| 0.5 * x)
}
