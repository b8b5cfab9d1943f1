//! A function of one parameter over an interval, known by its middle and by bounds of its derivatives.

use crate::base::range::{Interval, Interval3};
use crate::geometry::Jet;

/// Taylor's formula about the middle, with what the derivatives may be over the whole interval.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Half the width of the interval.
    pub half: f64,
    /// Value and derivatives in the middle.
    pub mid: Jet,
    /// First derivative.
    pub d1: Interval3,
    /// Second derivative; unbounded where there is a cusp. Jumps of the first derivative count as what bends as far.
    pub d2: Interval3,
}

impl Line {
    /// From the middle and the second derivative; `d1` is what else is known of the first.
    pub fn new(half: f64, mid: Jet, d1: Option<Interval3>, d2: Interval3) -> Self {
        let taylor = d2 * Interval::around_zero(half) + mid.d1;
        Self { half, mid, d1: d1.map_or(taylor, |known| taylor.intersection(known)), d2 }
    }

    /// The value.
    pub fn p(&self) -> Interval3 {
        let steps = Interval::around_zero(self.half);
        let by_slope = self.d1 * steps + self.mid.p;
        let by_bend = steps * self.mid.d1 + self.d2 * Interval { low: 0.0, high: 0.5 * self.half * self.half } + self.mid.p;
        by_bend.intersection(by_slope)
    }

    /// Σ of fixed multiples of lines over the same interval.
    pub fn sum(terms: impl Iterator<Item = (f64, Self)>) -> Self {
        let zero = Self { half: 0.0, mid: Jet::default(), d1: Interval3::default(), d2: Interval3::default() };
        let whole = terms.fold(zero, |s, (w, l)| Self {
            half: l.half,
            mid: Jet { p: s.mid.p + l.mid.p * w, d1: s.mid.d1 + l.mid.d1 * w, d2: s.mid.d2 + l.mid.d2 * w },
            d1: s.d1 + l.d1 * w,
            d2: s.d2 + l.d2 * w,
        });
        Self::new(whole.half, whole.mid, Some(whole.d1), whole.d2)
    }

    /// This order of derivative.
    pub fn order(&self, k: usize) -> Interval3 {
        match k {
            0 => self.p(),
            1 => self.d1,
            _ => self.d2,
        }
    }

    /// The function backwards.
    pub fn backwards(self) -> Self {
        Self { mid: Jet { d1: -self.mid.d1, ..self.mid }, d1: -self.d1, ..self }
    }
}

/// Weights of a sum over one interval: their values in its middle and what they may be anywhere in it.
#[derive(Clone, Copy, Debug)]
pub struct Shares<'a> {
    /// Value and derivatives of each.
    pub weights: &'a [([f64; 3], [Interval; 3])],
    /// How many of them, from the first on, have the same sum everywhere.
    pub shares: usize,
    /// Their third derivatives, where these are numbers: the weights are cubics.
    pub thirds: Option<&'a [f64]>,
    /// Half the width of the interval.
    pub half: f64,
}

/// (tⁿ / n!) for −`half` ≤ t ≤ `half`.
pub fn taylor(half: f64, n: usize) -> Interval {
    match n {
        0 => Interval::at(1.0),
        1 => Interval::around_zero(half),
        2 => Interval { low: 0.0, high: 0.5 * half * half },
        _ => Interval::around_zero(half * half * half / 6.0),
    }
}

/// Σ w_k·l_k^(order) for weights known by their middle values and ranges; `mixed` gives Σ m_k l_k for numbers m.
///
/// Cubic weights are their Taylor sums about the middle, whose derivatives are mixed before they meet ranges: what of nodes and slopes
/// cancels does so exactly. What the shares of others vary by sums to 0, so it multiplies differences of the l_k only: constants cost
/// nothing.
pub fn blended(of: Shares, derivative: usize, order: usize, mixed: &dyn Fn(&[f64]) -> Line) -> Interval3 {
    if let Some(thirds) = of.thirds {
        let at = |d: usize| if d == 3 { thirds.to_vec() } else { of.weights.iter().map(|w| w.0[d]).collect() };
        let term = |n: usize| mixed(&at(derivative + n)).order(order) * taylor(of.half, n);
        return (1..=3 - derivative).map(term).fold(term(0), |sum, more| sum + more);
    }
    let mut by: Vec<f64> = of.weights.iter().map(|w| w.0[derivative]).collect();
    let mut sum = mixed(&by).order(order);
    for (k, (middle, range)) in of.weights.iter().enumerate().skip(1) {
        by.fill(0.0);
        if k < of.shares {
            by[0] = -1.0;
        }
        by[k] = 1.0;
        sum = sum + mixed(&by).order(order) * (range[derivative] - Interval::at(middle[derivative]));
    }
    sum
}
