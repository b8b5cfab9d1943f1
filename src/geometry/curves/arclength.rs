//! Arc length and its inverse [Koh & Park 1990, §3.2]: adaptive Gauss–Kronrod panels, a monotone table, bracketed Newton.

use crate::base::job;
use crate::base::quadrature::{KRONROD, NODES, Panel, RUNNING, chebyshev, kronrod, running_integral};
use crate::base::solve;
use crate::base::tolerance::{CUSP, EPSILON, LENGTH_ACCURACY, LENGTH_FLOOR, LENGTH_ROUNDING};
use crate::base::work;
use crate::geometry::curves::curve::Curve;
use crate::geometry::data::jet::Jet;

/// A panel is halved at most this often.
const DEPTH: u32 = 40;
/// Panels for each span at most: where rounding is all there is, halving would never end.
const PANELS: usize = 1 << 12;
/// Newton corrections before the bracket's middle is taken.
const ROUNDS: usize = 60;

/// Lengths of one curve up to the ends of its panels, and the way inside each panel.
#[derive(Clone, Debug)]
pub(crate) struct Lengths {
    /// Parameters of the panels' ends, ascending.
    t: Vec<f64>,
    /// Arc length from the start to each, ascending.
    s: Vec<f64>,
    /// Length inside each panel; empty when it is proportional to the parameter everywhere.
    inside: Vec<Inside>,
    /// Parameters where the curve stands still between two knots.
    pub(crate) cusps: Vec<f64>,
    /// A parameter where halving did not reach the accuracy.
    pub(crate) stalled: Option<f64>,
}

/// Arc length inside a panel as a polynomial of x = −1…1.
#[derive(Clone, Debug)]
struct Inside {
    /// Chebyshev coefficients; 0 at x = −1.
    length: [f64; RUNNING],
    /// How many of them are more than rounding.
    terms: usize,
    /// A bound of the second derivative of the length by x.
    bend: f64,
    /// Cubic guess of x from the share y = 0…1 of the panel's length: end slopes dx/dy, kept monotone.
    slopes: (f64, f64),
}

impl Lengths {
    /// Integrates |C′| between neighbouring `splits` (domain ends, knots, kinks; ascending).
    pub(crate) fn integrate(splits: &[f64], jet: impl Fn(f64) -> Jet) -> Self {
        let mut table = Self { t: vec![splits[0]], s: vec![0.0], inside: Vec::new(), cusps: Vec::new(), stalled: None };
        let mut open = Vec::new();
        for span in splits.windows(2) {
            let most = table.t.len() + PANELS;
            open.push((span[0], span[1], DEPTH));
            while let Some((a, b, left)) = open.pop() {
                job::poll();
                let mut farthest = 0.0_f64;
                let panel = kronrod(a, b, |t| {
                    let jet = jet(t);
                    farthest = farthest.max(jet.p.length_squared());
                    jet.d1.length()
                });
                let done = table.s[table.s.len() - 1];
                let rounding = LENGTH_ROUNDING * farthest.sqrt();
                if panel.error <= LENGTH_ACCURACY * (done + panel.integral) + LENGTH_FLOOR + rounding {
                    table.push(b, &panel);
                    continue;
                }
                let cusp = cusp_between(a, b, &panel, &jet);
                let middle = cusp.unwrap_or(0.5 * (a + b));
                if left == 0 || table.t.len() + open.len() > most || !(a < middle && middle < b) {
                    table.stalled = Some(middle);
                    table.push(b, &panel);
                    continue;
                }
                table.cusps.extend(cusp);
                open.push((middle, b, left - 1));
                open.push((a, middle, left - 1));
            }
        }
        table
    }

    /// Straight pieces between `(parameter, length so far)`; the parameter runs evenly inside each.
    pub(crate) fn proportional(ends: impl Iterator<Item = (f64, f64)>) -> Self {
        let (t, s) = ends.unzip();
        Self { t, s, inside: Vec::new(), cusps: Vec::new(), stalled: None }
    }

    fn push(&mut self, b: f64, panel: &Panel) {
        let (a, done) = (self.t[self.t.len() - 1], self.s[self.s.len() - 1]);
        let half = 0.5 * (b - a);
        let length = running_integral(&panel.values).map(|c| c * half);
        let slope = |x: f64| {
            let speed = chebyshev(&length, x).1;
            // Slopes beyond three times the secant would bend the cubic back.
            if speed * 6.0 > panel.integral { panel.integral / speed } else { 6.0 }
        };
        let slopes = (slope(-1.0), slope(1.0));
        let (terms, bend) = (terms_of(&length, EPSILON * panel.integral), bend_of(&length));
        self.inside.push(Inside { length, terms, bend, slopes });
        self.t.push(b);
        self.s.push(done + panel.integral);
    }

    /// Length of the whole curve.
    pub(crate) fn total(&self) -> f64 {
        self.s[self.s.len() - 1]
    }

    /// Arc length at a parameter of the domain.
    pub(crate) fn at(&self, t: f64) -> f64 {
        let last = self.t.len() - 1;
        if t.is_nan() || t <= self.t[0] {
            return 0.0;
        }
        if t >= self.t[last] {
            return self.s[last];
        }
        let k = self.t.partition_point(|x| *x <= t) - 1;
        let (a, b) = (self.t[k], self.t[k + 1]);
        let share = (t - a) / (b - a);
        let inside = match self.inside.get(k) {
            Some(panel) => panel.length_and_speed(2.0 * share - 1.0).0,
            None => share * (self.s[k + 1] - self.s[k]),
        };
        (self.s[k] + inside).clamp(self.s[k], self.s[k + 1])
    }

    /// Parameter at arc length `s`, clamped to the curve.
    pub(crate) fn param(&self, s: f64) -> f64 {
        let mut panel = usize::MAX;
        self.param_near(s, &mut panel)
    }

    /// Like [`Lengths::param`]; `panel` remembers the panel from call to call, so that a walk needs no search.
    pub(crate) fn param_near(&self, s: f64, panel: &mut usize) -> f64 {
        let last = self.s.len() - 1;
        if s.is_nan() || s <= 0.0 {
            return self.t[0];
        }
        if s >= self.s[last] {
            return self.t[last];
        }
        let holds = |k: usize| k < last && self.s[k] <= s && s < self.s[k + 1];
        if !holds(*panel) {
            let next = panel.wrapping_add(1);
            *panel = if holds(next) { next } else { self.s.partition_point(|x| *x <= s) - 1 };
        }
        self.invert(*panel, s)
    }

    fn invert(&self, k: usize, s: f64) -> f64 {
        // A step or two of Newton's.
        work::spend(2);
        let (a, b) = (self.t[k], self.t[k + 1]);
        let (wanted, length) = (s - self.s[k], self.s[k + 1] - self.s[k]);
        let slack = EPSILON * self.total();
        // At a cusp the root of a rounding error is far from it; the ends are known exactly.
        if wanted <= slack {
            return a;
        }
        if length - wanted <= slack {
            return b;
        }
        let y = wanted / length;
        let Some(panel) = self.inside.get(k) else { return a + (b - a) * y };
        let x = panel.invert(wanted, y, LENGTH_ACCURACY * self.total());
        (a + (b - a) * (0.5 * (x + 1.0))).clamp(a, b)
    }
}

/// Chebyshev coefficients up to the last ones that together are less than `rounding`; at least two.
fn terms_of(c: &[f64], rounding: f64) -> usize {
    let mut dropped = 0.0;
    let small = c.iter().rev().take_while(|c| {
        dropped += c.abs();
        dropped <= rounding
    });
    (c.len() - small.count()).max(2)
}

/// A bound of the second derivative of Σ cₖ Tₖ over −1…1: |Tₖ″| is largest at the ends, k² (k² − 1) / 3.
fn bend_of(c: &[f64]) -> f64 {
    c.iter().enumerate().map(|(k, c)| c.abs() * ((k * k * (k * k).saturating_sub(1)) as f64 / 3.0)).sum()
}

impl Inside {
    /// Length up to x, and its derivative by x.
    #[inline]
    fn length_and_speed(&self, x: f64) -> (f64, f64) {
        chebyshev(&self.length[..self.terms], x)
    }

    /// x where the length inside the panel is `wanted`, share `y` of the whole.
    fn invert(&self, wanted: f64, y: f64, accuracy: f64) -> f64 {
        let (p, q) = (self.slopes.0 - 2.0, self.slopes.1 - 2.0);
        // Hermite cubic from −1 to 1 written as the straight guess plus a correction.
        let z = 1.0 - y;
        let mut x = 2.0 * y - 1.0 + y * z * (p * z - q * y);
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..ROUNDS {
            let (value, slope) = self.length_and_speed(x);
            let miss = value - wanted;
            let step = miss / slope;
            let next = x - step;
            let is_inside = low <= next && next <= high;
            // A step leaves at most half of the second derivative times its square.
            if miss.abs() <= accuracy || is_inside && 0.5 * self.bend * step * step <= accuracy {
                return if is_inside { next } else { x };
            }
            if miss > 0.0 {
                high = x;
            } else {
                low = x;
            }
            x = if low < next && next < high { next } else { 0.5 * (low + high) };
        }
        0.5 * (low + high)
    }
}

/// A parameter between `a` and `b` where the curve stands still, if the panel's values dip and it does.
fn cusp_between(a: f64, b: f64, panel: &Panel, jet: &impl Fn(f64) -> Jet) -> Option<f64> {
    let largest = panel.values.iter().copied().fold(0.0, f64::max);
    let lowest = (1..KRONROD - 1).filter(|&i| panel.values[i] <= panel.values[i - 1] && panel.values[i] <= panel.values[i + 1]);
    let i = lowest.min_by(|&i, &j| panel.values[i].total_cmp(&panel.values[j]))?;
    let at = |x: f64| 0.5 * (a + b) + 0.5 * (b - a) * x;
    let (low, high) = (at(NODES[i - 1]), at(NODES[i + 1]));
    // d|C′|²/dt changes sign at a least speed; its own slope is at least |C″|² there.
    let rise = |t: f64| {
        let j = jet(t);
        (j.d1.dot(j.d2), j.d2.length_squared())
    };
    if !(rise(low).0 < 0.0 && rise(high).0 > 0.0) {
        return None;
    }
    let t = solve::bracketed(low, high, EPSILON * (b - a), rise);
    (jet(t).d1.length() < CUSP * largest).then_some(t)
}

/// Parameters at which the quadrature of a curve must be split: its ends and every distinct knot.
pub(crate) fn lengths_of(curve: &Curve, splits: &[f64]) -> Lengths {
    Lengths::integrate(splits, |t| curve.jet(t))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn halving_ends_where_only_rounding_is_left() {
        // A speed between 1 and 2 that changes from bit to bit of the parameter.
        let noise = |t: f64| 1.0 + (t.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64 / (1_u64 << 53) as f64;
        let table = Lengths::integrate(&[0.0, 1.0, 2.0], |t| Jet { d1: DVec3::X * noise(t), ..Jet::default() });
        assert!(table.stalled.is_some() && table.t.len() < 3 * PANELS, "{} panels", table.t.len());
        assert!((2.0..4.0).contains(&table.total()), "{}", table.total());
    }
}
