//! Blending functions of one direction: linear or cubic between neighbours (Coons), Lagrange or cubic splines through all.
//!
//! A blend is a sum of functions of one parameter times *terms*. The first terms are the curves at the nodes; where the
//! rule is a spline there follow as many slopes across the nodes, which are fixed sums of the curves. So few functions
//! differ from 0 at any parameter, whatever the number of curves. Hermite blends have the same functions, and slopes of no curves.
//!
//! Where all curves of the other family have a corner at one node, splines have one too and run on either side by themselves; a smooth
//! one would swing beside it. Where they are straight up to a node, splines leave it with the slope of the straight part.

use crate::base::range::Interval;
use crate::base::tolerance::EPSILON;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::spline_parts::{Joins, slopes_between};

/// Parameters of the curves across one direction, ascending from 0 to 1, and the rule between them.
#[derive(Clone, Debug)]
pub struct BlendAxis {
    /// u_0 = 0 … u_M = 1.
    pub nodes: Vec<f64>,
    /// The rule.
    pub rule: Rule,
    /// Places of nodes at which splines are less than C2, ascending: inner ones, and 0 where a closed direction is so at its seam.
    joints: Vec<(usize, Joins)>,
    /// Of splines and Hermite blends: slopes at the nodes as sums of values at the nodes, in rows; zero of Hermite blends. Joints have
    /// two rows, that of the part before them first.
    slopes: Vec<Vec<f64>>,
}

crate::content!(BlendAxis { nodes, rule, joints } but { slopes });

/// Terms that take part at one parameter, each with value, first and second derivative of its function.
#[derive(Clone, Debug)]
pub struct Weights {
    /// Terms, see [`Weights::term`].
    first: usize,
    slopes: usize,
    few: [[f64; 3]; FEW],
    n: usize,
    many: Vec<[f64; 3]>,
}

/// Share of the largest number of a slope's row that no sum feels any more: numbers halve at least from node to node.
const UNFELT: f64 = f64::EPSILON / 256.0;

/// Up to so many blending values live without an allocation.
const FEW: usize = 6;

impl Weights {
    /// The blending values.
    pub fn values(&self) -> &[[f64; 3]] {
        if self.n <= FEW { &self.few[..self.n] } else { &self.many }
    }

    /// The term that blending value `k` belongs to.
    pub fn term(&self, k: usize) -> usize {
        if self.slopes > 0 && k > 1 { self.slopes + self.first + k - 2 } else { self.first + k }
    }

    /// The cell, or 0 where the rule knows none.
    pub fn cell(&self) -> usize {
        self.first
    }

    /// Terms with their blending values.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[f64; 3])> {
        self.values().iter().enumerate().map(|(k, w)| (self.term(k), w))
    }

    fn room(first: usize, n: usize) -> Self {
        Self { first, slopes: 0, few: [[0.0; 3]; FEW], n, many: if n > FEW { vec![[0.0; 3]; n] } else { Vec::new() } }
    }

    fn set(&mut self, k: usize, value: [f64; 3]) {
        if self.n <= FEW {
            self.few[k] = value;
        } else {
            self.many[k] = value;
        }
    }
}

impl BlendAxis {
    /// An axis with what its rule needs to be evaluated.
    pub fn new(nodes: Vec<f64>, rule: Rule) -> Self {
        Self::with_joints(nodes, rule, Vec::new())
    }

    /// The same with joints at some nodes, by ascending places; only splines know them.
    pub fn with_joints(nodes: Vec<f64>, rule: Rule, mut joints: Vec<(usize, Joins)>) -> Self {
        if !matches!(rule, Rule::Spline | Rule::Periodic) {
            joints.clear();
        }
        let mut slopes = match rule {
            Rule::Hermite => vec![vec![0.0; nodes.len()]; nodes.len()],
            _ if rule.has_slopes() => slopes_between(&nodes, &joints, rule == Rule::Periodic),
            _ => Vec::new(),
        };
        for row in &mut slopes {
            let least = row.iter().fold(0.0, |most: f64, x| most.max(x.abs())) * UNFELT;
            row.iter_mut().filter(|x| x.abs() <= least).for_each(|x| *x = 0.0);
        }
        Self { nodes, rule, joints, slopes }
    }

    /// How many terms take part at any one parameter.
    pub fn active(&self) -> usize {
        match self.rule {
            Rule::Lagrange => self.nodes.len(),
            Rule::Linear | Rule::Cubic => 2,
            Rule::Spline | Rule::Periodic | Rule::Hermite => 4,
        }
    }

    /// Whether the blending functions change their formula at the nodes.
    pub fn is_piecewise(&self) -> bool {
        self.rule != Rule::Lagrange
    }

    /// How many terms there are.
    pub fn terms(&self) -> usize {
        self.nodes.len() + self.slopes.len()
    }

    /// Slopes at the nodes as sums of values at the nodes, in rows; empty unless slopes are terms.
    pub fn slopes(&self) -> &[Vec<f64>] {
        &self.slopes
    }

    /// Rows of the slopes at both ends of a cell.
    pub fn slopes_of(&self, cell: usize) -> (usize, usize) {
        let first = cell + self.joints.iter().filter(|joint| joint.0 > 0 && joint.0 <= cell).count();
        (first, first + 1)
    }

    /// How many derivatives of the blending functions go on at an inner node.
    pub fn smoothness(&self, node: usize) -> usize {
        match (self.rule, self.joints.iter().find(|joint| joint.0 == node)) {
            (Rule::Linear, _) | (_, Some((_, Joins::Corner))) => 0,
            (Rule::Cubic | Rule::Hermite, _) | (_, Some(_)) => 1,
            _ => 2,
        }
    }

    /// Of the active blending values how many sum to 1 at every parameter: they come first; slopes follow.
    pub fn shares(&self) -> usize {
        if self.rule.has_slopes() { 2 } else { self.active() }
    }

    /// The blending value of the curve at node `i`, all terms counted.
    pub fn whole(&self, weights: &Weights, i: usize) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (term, w) in weights.iter() {
            let by = match term.checked_sub(self.nodes.len()) {
                Some(k) => self.slopes[k][i],
                None if term == i => 1.0,
                None => continue,
            };
            (0..3).for_each(|d| sum[d] += by * w[d]);
        }
        sum
    }

    /// Inner parameters where the slope of the blending values jumps.
    pub fn creases(&self) -> Vec<f64> {
        (1..self.nodes.len() - 1).filter(|k| self.smoothness(*k) == 0).map(|k| self.nodes[k]).collect()
    }

    /// The cell that holds a parameter.
    pub fn cell(&self, x: f64, side: OneSided) -> usize {
        let inner = &self.nodes[1..self.nodes.len() - 1];
        inner.partition_point(|&node| if side == OneSided::Before { node < x - EPSILON } else { node <= x + EPSILON })
    }

    /// Blending values at a parameter.
    pub fn weights(&self, x: f64, side: OneSided) -> Weights {
        match self.rule {
            Rule::Linear | Rule::Cubic => {
                let k = self.cell(x, side);
                let h = self.nodes[k + 1] - self.nodes[k];
                let mut weights = Weights::room(k, 2);
                // From the nearer node: at a node the weights are 0 and 1 without rounding.
                let (near, far, t, sign) = if x - self.nodes[k] <= self.nodes[k + 1] - x {
                    (0, 1, (x - self.nodes[k]) / h, 1.0)
                } else {
                    (1, 0, (self.nodes[k + 1] - x) / h, -1.0)
                };
                let [value, d1, d2] = match self.rule {
                    Rule::Linear => [t, sign / h, 0.0],
                    _ => [t * t * (3.0 - 2.0 * t), sign * 6.0 * t * (1.0 - t) / h, (6.0 - 12.0 * t) / (h * h)],
                };
                weights.set(far, [value, d1, d2]);
                weights.set(near, [1.0 - value, -d1, -d2]);
                weights
            }
            Rule::Spline | Rule::Periodic | Rule::Hermite => self.hermite(x, self.cell(x, side)),
            Rule::Lagrange => {
                let n = self.nodes.len();
                let mut weights = Weights::room(0, n);
                for i in 0..n {
                    weights.set(i, self.lagrange(i, x));
                }
                weights
            }
        }
    }

    /// The four cubics of values and slopes at the ends of a cell, from the nearer node: there they are 1 and 0 exactly.
    fn hermite(&self, x: f64, k: usize) -> Weights {
        let h = self.nodes[k + 1] - self.nodes[k];
        let mut weights = Weights::room(k, 4);
        weights.slopes = self.nodes.len() + self.slopes_of(k).0 - k;
        let (near, far, t, sign) = if x - self.nodes[k] <= self.nodes[k + 1] - x {
            (0, 1, (x - self.nodes[k]) / h, 1.0)
        } else {
            (1, 0, (self.nodes[k + 1] - x) / h, -1.0)
        };
        let value = [t * t * (3.0 - 2.0 * t), sign * 6.0 * t * (1.0 - t) / h, (6.0 - 12.0 * t) / (h * h)];
        weights.set(far, value);
        weights.set(near, [1.0 - value[0], -value[1], -value[2]]);
        weights.set(2 + near, [sign * h * t * (1.0 - t) * (1.0 - t), (1.0 - t) * (1.0 - 3.0 * t), sign * (6.0 * t - 4.0) / h]);
        weights.set(2 + far, [sign * h * t * t * (t - 1.0), t * (3.0 * t - 2.0), sign * (6.0 * t - 2.0) / h]);
        weights
    }

    /// L_i and two derivatives, factor by factor: each factor is exactly 1 or 0 at a node, so the nodes are met exactly.
    fn lagrange(&self, i: usize, x: f64) -> [f64; 3] {
        let own = self.nodes[i];
        let mut p = [1.0, 0.0, 0.0];
        for (k, &node) in self.nodes.iter().enumerate() {
            if k != i {
                let (f, d) = ((x - node) / (own - node), 1.0 / (own - node));
                p = [p[0] * f, p[1] * f + p[0] * d, p[2] * f + 2.0 * p[1] * d];
            }
        }
        p
    }

    /// Bounds of the active blending values with their derivatives over `x0 < x1` inside one cell.
    pub fn ranges(&self, x0: f64, x1: f64) -> Vec<[Interval; 3]> {
        let (middle, half) = (0.5 * (x0 + x1), 0.5 * (x1 - x0));
        let at = self.weights(middle, OneSided::After);
        let steps = Interval::around_zero(half);
        let third = self.thirds(x0, x1);
        let one = |(k, w): (usize, &[f64; 3])| {
            // Down from the third derivative by Taylor's formula about the middle.
            let d3 = third[k];
            let d2 = Interval::at(w[2]) + d3 * steps;
            let d1 = Interval::at(w[1]) + steps * w[2] + d3 * Interval { low: 0.0, high: 0.5 * half * half };
            let d0 = Interval::at(w[0]) + steps * w[1] + d2 * Interval { low: 0.0, high: 0.5 * half * half };
            [d0, d1, d2]
        };
        at.values().iter().enumerate().map(one).collect()
    }

    /// Bounds of the third derivatives of the active blending values over `x0 < x1` inside one cell: numbers but for the polynomial.
    pub fn thirds(&self, x0: f64, x1: f64) -> Vec<Interval> {
        let at = self.weights(0.5 * (x0 + x1), OneSided::After);
        let cube = || {
            let h = self.nodes[at.first + 1] - self.nodes[at.first];
            (12.0 / (h * h * h), 6.0 / (h * h))
        };
        let third = |k: usize| match self.rule {
            Rule::Linear => Interval::at(0.0),
            Rule::Cubic => Interval::at(if k == 1 { -cube().0 } else { cube().0 }),
            Rule::Spline | Rule::Periodic | Rule::Hermite => Interval::at([cube().0, -cube().0, cube().1, cube().1][k]),
            Rule::Lagrange => self.lagrange_third(k, Interval { low: x0, high: x1 }),
        };
        (0..at.values().len()).map(third).collect()
    }

    /// Bounds of L_i‴ by the product rule over intervals.
    fn lagrange_third(&self, i: usize, x: Interval) -> Interval {
        let own = self.nodes[i];
        let mut p = [Interval::at(1.0), Interval::at(0.0), Interval::at(0.0), Interval::at(0.0)];
        for (k, &node) in self.nodes.iter().enumerate() {
            if k != i {
                let d = 1.0 / (own - node);
                let f = (x - Interval::at(node)) * d;
                p = [p[0] * f, p[1] * f + p[0] * d, p[2] * f + p[1] * (2.0 * d), p[3] * f + p[2] * (3.0 * d)];
            }
        }
        p[3]
    }

    /// Largest Σ|a_i| over the direction: of the polynomial by climbing in each cell, of splines a bound.
    ///
    /// Between two nodes the polynomial's sum has a single maximum, so golden sections find it. In a cell of width h a spline's
    /// sum is at most 1 + 4h/27 (Σ|D_k| + Σ|D_k+1|), 4/27 the largest value of t (1 − t)².
    pub fn lebesgue(&self) -> f64 {
        if self.rule.has_slopes() {
            let sums: Vec<f64> = self.slopes.iter().map(|row| row.iter().map(|d| d.abs()).sum()).collect();
            let both = |(a, b): (usize, usize)| sums[a] + sums[b];
            let cell = |k: usize| 1.0 + 4.0 / 27.0 * (self.nodes[k + 1] - self.nodes[k]) * both(self.slopes_of(k));
            return (0..self.nodes.len() - 1).map(cell).fold(1.0, f64::max);
        }
        if self.rule != Rule::Lagrange {
            return 1.0;
        }
        let sum = |x: f64| (0..self.nodes.len()).map(|i| self.lagrange(i, x)[0].abs()).sum::<f64>();
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let mut largest = 1.0f64;
        for cell in self.nodes.windows(2) {
            let (mut a, mut b) = (cell[0], cell[1]);
            for _ in 0..40 {
                let (c, d) = (b - golden * (b - a), a + golden * (b - a));
                if sum(c) > sum(d) {
                    b = d;
                } else {
                    a = c;
                }
            }
            largest = largest.max(sum(0.5 * (a + b)));
        }
        largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_are_exact_at_nodes() {
        for rule in [Rule::Linear, Rule::Cubic, Rule::Lagrange, Rule::Spline, Rule::Periodic, Rule::Hermite] {
            let axis = BlendAxis::new(vec![0.0, 0.15, 0.4, 0.55, 0.6, 0.83, 1.0], rule);
            for i in 0..=100 {
                for side in [OneSided::After, OneSided::Before] {
                    let x = f64::from(i) / 100.0;
                    let w = axis.weights(x, side);
                    let sums = w.values()[..axis.shares()].iter().fold([0.0; 3], |s, v| [s[0] + v[0], s[1] + v[1], s[2] + v[2]]);
                    assert!((sums[0] - 1.0).abs() < 1e-13 && sums[1].abs() < 1e-9 && sums[2].abs() < 1e-6, "{x} {sums:?}");
                }
            }
            for (i, &node) in axis.nodes.iter().enumerate() {
                let w = axis.weights(node, OneSided::After);
                for (term, v) in w.iter() {
                    assert_eq!(v[0], if term == i { 1.0 } else { 0.0 });
                }
            }
        }
    }

    #[test]
    fn derivatives_are_difference_quotients() {
        for rule in [Rule::Linear, Rule::Cubic, Rule::Lagrange, Rule::Spline, Rule::Periodic, Rule::Hermite] {
            let axis = BlendAxis::new(vec![0.0, 0.2, 0.5, 1.0], rule);
            let h = 1e-5;
            for x in [0.05, 0.13, 0.3, 0.47, 0.7, 0.9] {
                let (a, b, c) =
                    (axis.weights(x - h, OneSided::After), axis.weights(x, OneSided::After), axis.weights(x + h, OneSided::After));
                for k in 0..b.values().len() {
                    let (p, q, r) = (a.values()[k], b.values()[k], c.values()[k]);
                    assert!(((r[0] - p[0]) / (2.0 * h) - q[1]).abs() < 1e-7);
                    assert!(((r[1] - p[1]) / (2.0 * h) - q[2]).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn splines_are_smooth_to_second_order_and_their_ranges_hold() {
        for rule in [Rule::Spline, Rule::Periodic] {
            let axis = BlendAxis::new(vec![0.0, 0.15, 0.4, 0.55, 0.6, 0.83, 1.0], rule);
            let last = axis.nodes.len() - 1;
            // The curve at a seam is counted at both of its nodes.
            let round = rule == Rule::Periodic;
            let of = |x: f64, side: OneSided, i: usize, d: usize| {
                let w = axis.weights(x, side);
                axis.whole(&w, i)[d] + if i == 0 && round { axis.whole(&w, last)[d] } else { 0.0 }
            };
            let seam = round.then_some((1.0, 0.0));
            for (x, y) in axis.nodes[1..last].iter().map(|x| (*x, *x)).chain(seam) {
                for (i, d) in (0..last).flat_map(|i| [(i, 0), (i, 1), (i, 2)]) {
                    let (a, b) = (of(x, OneSided::Before, i, d), of(y, OneSided::After, i, d));
                    assert!((a - b).abs() < 1e-10 * (1.0 + a.abs()), "{rule:?} {i} {x} {d}: {a} {b}");
                }
            }
            let (x0, x1) = (0.43, 0.52);
            let ranges = axis.ranges(x0, x1);
            for i in 0..=20 {
                let w = axis.weights(x0 + (x1 - x0) * f64::from(i) / 20.0, OneSided::After);
                for (range, value) in ranges.iter().zip(w.values()) {
                    (0..3).for_each(|d| assert!(range[d].low <= value[d] + 1e-12 && value[d] <= range[d].high + 1e-12));
                }
                let sum: f64 = (0..=last).map(|i| axis.whole(&w, i)[0].abs()).sum();
                assert!(sum <= axis.lebesgue());
            }
        }
    }

    #[test]
    fn lebesgue_constants_of_equal_nodes() {
        // Closed values for equally spaced nodes: degree 2 gives 1.25, degree 6 gives 4.549 [Brutman 1997, table 1].
        let equal = |n: usize| BlendAxis::new((0..=n).map(|k| k as f64 / n as f64).collect(), Rule::Lagrange).lebesgue();
        assert!((equal(1) - 1.0).abs() < 1e-12);
        assert!((equal(2) - 1.25).abs() < 1e-9);
        assert!((equal(6) - 4.549).abs() < 1e-3);
    }
}
