//! Monotone maps from a surface parameter to the arc-length fraction of a network curve.
//!
//! `u_i ↦ s_i` at the nodes. Piecewise linear maps, as in [Koh & Park 1990, eq. 4.8], leave a turn of the normal across
//! `u_i`; a C1 monotone cubic does not.

use crate::base::range::Interval;
use crate::base::tolerance::EPSILON;

/// How the map runs between the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reparam {
    /// C1 monotone cubic: harmonic mean of the neighbouring secants [Fritsch & Butland 1984].
    Smooth,
    /// Piecewise linear, the C0 map of [Koh & Park 1990, eq. 4.8].
    Linear,
}

/// A cubic rises all along a piece where its slopes at the ends are at most so many times the secant [Fritsch & Carlson 1980].
const STEEPEST: f64 = 3.0;

/// Pieces of a map that have a constant slope.
#[derive(Clone, Debug)]
pub struct Even {
    /// One per piece.
    pub pieces: Vec<bool>,
    /// Nodes at which the slope may jump between two such pieces: corners.
    pub jumps: Vec<usize>,
}

/// Value and two derivatives of a map.
pub type Scalar = [f64; 3];

/// A strictly monotone map through nodes; ascending or descending values.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    x: Vec<f64>,
    y: Vec<f64>,
    /// At both ends of each piece; nothing of a linear map.
    slope: Vec<(f64, f64)>,
    linear: bool,
}

crate::content!(Map { x, y, slope, linear });

impl Map {
    /// The map through `(x[i], y[i])`, `x` ascending, `y` strictly monotone, at least two nodes.
    ///
    /// `periodic` joins the slopes of the two ends. A monotone cubic through two nodes is the straight line.
    pub fn new(x: Vec<f64>, y: Vec<f64>, how: Reparam, periodic: bool) -> Self {
        let even = vec![false; x.len() - 1];
        Self::even_over(x, y, how, &Even { pieces: even, jumps: Vec::new() }, periodic)
    }

    /// The same with a constant slope over some pieces: what is blended between straight lines is straight only if each has one. The piece
    /// beside such a piece begins with its slope, or with three times its own secant where that is less.
    pub fn even_over(x: Vec<f64>, y: Vec<f64>, how: Reparam, even: &Even, periodic: bool) -> Self {
        let slope = if how == Reparam::Linear { Vec::new() } else { slopes(&x, &y, periodic) };
        // Nodes on a line up to rounding need no cubic: most maps are the identity.
        let straight = slope.windows(2).all(|w| (w[1] - w[0]).abs() <= EPSILON * (w[0].abs() + w[1].abs()))
            && secants(&x, &y).windows(2).all(|w| (w[1] - w[0]).abs() <= EPSILON * (w[0].abs() + w[1].abs()));
        let (x, y, slope) = if straight && x.len() > 2 && how == Reparam::Smooth {
            (vec![x[0], x[x.len() - 1]], vec![y[0], y[y.len() - 1]], Vec::new())
        } else {
            let slope = if slope.is_empty() { Vec::new() } else { of_pieces(&slope, &secants(&x, &y), even, periodic) };
            (x, y, slope)
        };
        let linear = how == Reparam::Linear || x.len() == 2;
        Self { x, y, slope, linear }
    }

    /// 0…1 ↦ 0…1.
    pub fn identity() -> Self {
        Self { x: vec![0.0, 1.0], y: vec![0.0, 1.0], slope: Vec::new(), linear: true }
    }

    /// 0…1 ↦ 1…0.
    pub fn reverse() -> Self {
        Self { y: vec![1.0, 0.0], ..Self::identity() }
    }

    /// Whether values fall.
    pub fn falls(&self) -> bool {
        self.y[self.y.len() - 1] < self.y[0]
    }

    /// Value, first and second derivative. `before` takes the piece before a node; outside the nodes the end pieces go on.
    pub fn at(&self, x: f64, before: bool) -> Scalar {
        let last = self.x.len() - 2;
        let k = self.x[1..=last].partition_point(|&node| if before { node < x - EPSILON } else { node <= x + EPSILON });
        let (x0, x1, y0, y1) = (self.x[k], self.x[k + 1], self.y[k], self.y[k + 1]);
        let h = x1 - x0;
        let secant = (y1 - y0) / h;
        if self.linear {
            // From the nearer node, so that both nodes are met exactly.
            let y = if x - x0 < x1 - x { y0 + (x - x0) * secant } else { y1 - (x1 - x) * secant };
            return [y, secant, 0.0];
        }
        let (a, b) = self.slope[k];
        // Newton form of the cubic Hermite piece from the nearer node.
        if x - x0 <= x1 - x {
            let (c, d) = ((3.0 * secant - 2.0 * a - b) / h, (a + b - 2.0 * secant) / (h * h));
            let t = x - x0;
            [y0 + t * (a + t * (c + t * d)), a + t * (2.0 * c + 3.0 * t * d), 2.0 * c + 6.0 * t * d]
        } else {
            let (c, d) = ((2.0 * b + a - 3.0 * secant) / h, (a + b - 2.0 * secant) / (h * h));
            let t = x - x1;
            [y1 + t * (b + t * (c + t * d)), b + t * (2.0 * c + 3.0 * t * d), 2.0 * c + 6.0 * t * d]
        }
    }

    /// Value.
    pub fn value(&self, x: f64) -> f64 {
        self.at(x, false)[0]
    }

    /// Bounds over `x0 < x1`: value, first and second derivative, and the sum of the jumps of the slope inside.
    pub fn ranges(&self, x0: f64, x1: f64) -> ([Interval; 3], f64) {
        let value = Interval::between(self.at(x0, false)[0], self.at(x1, true)[0]);
        let mut out = [value, Interval::at(self.at(x0, false)[1]), Interval::at(self.at(x0, false)[2])];
        let mut jumps = 0.0;
        let inner = self.breaks().iter().copied().filter(|x| *x > x0 + EPSILON && *x < x1 - EPSILON);
        let stops: Vec<f64> = std::iter::once(x0).chain(inner).chain(std::iter::once(x1)).collect();
        for w in stops.windows(2) {
            let (first, last) = (self.at(w[0], false), self.at(w[1], true));
            let middle = self.at(0.5 * (w[0] + w[1]), false);
            // On one cubic the second derivative is linear, so the first lies within its steps about the middle.
            let second = Interval::between(first[2], last[2]);
            let slope = Interval::at(middle[1]) + second * Interval::around_zero(0.5 * (w[1] - w[0]));
            (out[1], out[2]) = (out[1].union(slope), out[2].union(second));
            if w[0] > x0 {
                jumps += (first[1] - self.at(w[0], true)[1]).abs();
            }
        }
        (out, jumps)
    }

    /// The x of a value; values outside give the nearer end. Newton kept inside a shrinking bracket, at most 60 steps.
    pub fn inverse(&self, y: f64) -> f64 {
        let n = self.x.len();
        let sign = if self.falls() { -1.0 } else { 1.0 };
        let rises = |a: f64, b: f64| (b - a) * sign > 0.0;
        if !rises(self.y[0], y) {
            return self.x[0];
        }
        if !rises(y, self.y[n - 1]) {
            return self.x[n - 1];
        }
        let k = self.y[1..n - 1].partition_point(|&node| !rises(y, node));
        let (mut low, mut high) = (self.x[k], self.x[k + 1]);
        if y == self.y[k] {
            return low;
        }
        let mut x = low + (high - low) * ((y - self.y[k]) / (self.y[k + 1] - self.y[k]));
        for _ in 0..60 {
            let [value, slope, _] = self.at(x, false);
            let miss = (value - y) * sign;
            if miss == 0.0 {
                return x;
            }
            if miss > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let newton = x - miss / (slope * sign);
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - x).abs() <= f64::EPSILON * 0.5 {
                return next;
            }
            x = next;
        }
        x
    }

    /// Nodes where the second derivative jumps, ends left out.
    pub fn breaks(&self) -> &[f64] {
        &self.x[1..self.x.len() - 1]
    }
}

/// Slopes at both ends of each piece from those at the nodes.
fn of_pieces(nodes: &[f64], secant: &[f64], even: &Even, periodic: bool) -> Vec<(f64, f64)> {
    let n = secant.len();
    // The slope of piece `k` at a node that it has in common with piece `other`.
    let at = |k: usize, node: usize, other: Option<usize>| match other {
        _ if even.pieces[k] && other.is_none_or(|other| !even.pieces[other] || even.jumps.contains(&node)) => secant[k],
        Some(other) if !even.pieces[k] && even.pieces[other] && !even.jumps.contains(&node) => {
            let most = STEEPEST * secant[k];
            if secant[other].abs() < most.abs() { secant[other] } else { most }
        }
        _ => nodes[node],
    };
    let before = |k: usize| if k > 0 { Some(k - 1) } else { periodic.then_some(n - 1) };
    let after = |k: usize| if k + 1 < n { Some(k + 1) } else { periodic.then_some(0) };
    (0..n).map(|k| (at(k, k, before(k)), at(k, (k + 1) % if periodic { n } else { n + 1 }, after(k)))).collect()
}

fn secants(x: &[f64], y: &[f64]) -> Vec<f64> {
    (1..x.len()).map(|k| (y[k] - y[k - 1]) / (x[k] - x[k - 1])).collect()
}

/// Slopes of the monotone cubic at its nodes.
fn slopes(x: &[f64], y: &[f64], periodic: bool) -> Vec<f64> {
    let n = x.len();
    let secant = secants(x, y);
    if n == 2 {
        return vec![secant[0]; 2];
    }
    let step: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let mut slope = vec![0.0; n];
    for k in 1..n - 1 {
        slope[k] = inner_slope((step[k - 1], step[k]), (secant[k - 1], secant[k]));
    }
    if periodic {
        slope[0] = inner_slope((step[n - 2], step[0]), (secant[n - 2], secant[0]));
        slope[n - 1] = slope[0];
    } else {
        slope[0] = end_slope((step[0], step[1]), (secant[0], secant[1]));
        slope[n - 1] = end_slope((step[n - 2], step[n - 3]), (secant[n - 2], secant[n - 3]));
    }
    slope
}

/// Weighted harmonic mean of two neighbouring secants, 0 where they differ in sign.
fn inner_slope(step: (f64, f64), secant: (f64, f64)) -> f64 {
    if secant.0 * secant.1 <= 0.0 {
        return 0.0;
    }
    let (before, after) = (2.0 * step.1 + step.0, step.1 + 2.0 * step.0);
    (before + after) / (before / secant.0 + after / secant.1)
}

/// Three-point formula at an end, held to the shape; `.0` is the piece at the end, `.1` the next one.
fn end_slope(step: (f64, f64), secant: (f64, f64)) -> f64 {
    let slope = ((2.0 * step.0 + step.1) * secant.0 - step.0 * secant.1) / (step.0 + step.1);
    if slope * secant.0 <= 0.0 {
        0.0
    } else if secant.0 * secant.1 <= 0.0 && slope.abs() > 3.0 * secant.0.abs() {
        3.0 * secant.0
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(map: &Map) {
        for i in 0..=400 {
            let x = f64::from(i) / 400.0;
            let [y, d, _] = map.at(x, false);
            assert!((map.inverse(y) - x).abs() < 1e-12, "{x}");
            let h = 1e-5;
            if x > h && x < 1.0 - h && map.breaks().iter().all(|b| (b - x).abs() > h) {
                let q = (map.value(x + h) - map.value(x - h)) / (2.0 * h);
                assert!((q - d).abs() < 1e-6 * (1.0 + d.abs()), "{x}: {q} {d}");
            }
        }
    }

    #[test]
    fn printed_numbers_of_a_reversed_curve() {
        let f2 = Map::new(vec![0.0, 0.5, 1.0], vec![1.0, 0.25, 0.0], Reparam::Linear, false);
        for (u, s) in [(0.0, 1.0), (0.25, 0.625), (0.5, 0.25), (0.75, 0.125), (1.0, 0.0), (0.125, 0.8125)] {
            assert_eq!(f2.value(u), s);
        }
        let f0 = Map::new(vec![0.0, 0.5, 1.0], vec![0.0, 0.25, 1.0], Reparam::Linear, false);
        assert_eq!((f0.value(0.25), f0.value(0.75)), (0.125, 0.625));
        check(&f2);
    }

    #[test]
    fn smooth_maps_are_monotone_with_exact_nodes() {
        let x = vec![0.0, 0.1, 0.4, 0.45, 1.0];
        let y = vec![0.0, 0.5, 0.52, 0.9, 1.0];
        for periodic in [false, true] {
            let map = Map::new(x.clone(), y.clone(), Reparam::Smooth, periodic);
            check(&map);
            for (x, y) in x.iter().zip(&y) {
                assert_eq!(map.value(*x), *y);
            }
            let falling = Map::new(x.clone(), y.iter().map(|y| 1.0 - y).collect(), Reparam::Smooth, periodic);
            check(&falling);
            assert!((map.at(0.0, false)[1] == map.at(1.0, true)[1]) == periodic);
        }
    }

    #[test]
    fn nodes_on_a_line_are_the_straight_map() {
        let map = Map::new(vec![0.0, 0.3, 1.0], vec![1.0, 0.7, 0.0], Reparam::Smooth, false);
        assert!(map.breaks().is_empty() && map.falls());
        assert_eq!(map.value(0.25), 0.75);
    }
}
