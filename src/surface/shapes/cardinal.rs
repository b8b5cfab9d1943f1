//! Slopes of the cubic splines through one direction's curves, as a matrix: C² interpolation written as Hermite pieces.
//!
//! A spline through values y_i at nodes x_i has the slopes m = D y at the nodes, and between two nodes it is the cubic of
//! their values and slopes. D is made once; every curve, node and slope of a Gordon surface goes through the same D, so
//! that its three parts cancel on the network to rounding.
//!
//! End conditions are "not a knot": the first two pieces are one cubic, and so are the last two, so every cubic is
//! reproduced and no end slope has to be invented [de Boor 1978, chapter IV]. Three nodes give the parabola, two the line.
//! A closed direction is periodic instead: value, slope and bend agree across the seam, wherever it lies.
//!
//! A value is felt by slopes at other nodes less and less, by a factor of 2 + √3 a node where these are even. What is below
//! rounding is left out, so that a slope is a sum over some fifty nodes at most, however many there are.

use crate::base::tolerance::EPSILON;

/// D in rows, `nodes.len()` square: slopes at the nodes of the spline through values at the nodes.
///
/// `periodic`: the last node stands for the first one; its own values are not read.
pub fn slopes(nodes: &[f64], periodic: bool) -> Vec<Vec<f64>> {
    let steps: Vec<f64> = nodes.windows(2).map(|w| w[1] - w[0]).collect();
    if periodic { around(&steps) } else { felt(open(&steps)) }
}

/// The same rows without what is rounding beside their largest entry; what is left out goes to the node itself, so that rows still
/// sum to 0.
fn felt(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = rows.len();
    for (k, row) in rows.iter_mut().enumerate() {
        let least = EPSILON * row[..n].iter().fold(0.0, |most: f64, by| most.max(by.abs()));
        let mut rest = 0.0;
        for by in row[..n].iter_mut().filter(|by| by.abs() < least) {
            rest += std::mem::take(by);
        }
        row[k] += rest;
        // Given slopes.
        row[n..].iter_mut().filter(|by| by.abs() < EPSILON).for_each(|by| *by = 0.0);
    }
    rows
}

/// What a spline does at one of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Its first two pieces are one cubic ("not a knot").
    Plain,
    /// It does not bend.
    Natural,
    /// It has a given slope.
    Slope,
}

/// [`slopes`] of an open spline with other ends: two columns more, for given slopes at the first and at the last node.
pub fn ended(nodes: &[f64], ends: (End, End)) -> Vec<Vec<f64>> {
    let steps: Vec<f64> = nodes.windows(2).map(|w| w[1] - w[0]).collect();
    let n = nodes.len();
    let mut rows = Rows::wide(n, n + 2);
    for k in 1..n - 1 {
        rows.smooth(k, (k - 1, k, k + 1), (steps[k - 1], steps[k]));
    }
    for (last, end) in [(false, ends.0), (true, ends.1)] {
        let node = |k: usize| if last { n - 1 - k } else { k };
        let sign = if last { -1.0 } else { 1.0 };
        let first = if last { steps[n - 2] } else { steps[0] };
        let (mid, next) = match end {
            End::Slope => {
                rows.right[node(0)][n + usize::from(last)] = 1.0;
                (1.0, 0.0)
            }
            // Of two nodes a plain end makes the cubic a parabola.
            End::Plain if n == 2 => {
                add_secant(&mut rows.right[node(0)], (node(0), node(1)), sign * 2.0 / first);
                (1.0, 1.0)
            }
            End::Plain => {
                let second = if last { steps[n - 3] } else { steps[1] };
                let sum = first + second;
                add_secant(&mut rows.right[node(0)], (node(0), node(1)), sign * (first + 2.0 * sum) * second / sum / first);
                add_secant(&mut rows.right[node(0)], (node(1), node(2)), sign * first * first / sum / second);
                (second, sum)
            }
            End::Natural => {
                add_secant(&mut rows.right[node(0)], (node(0), node(1)), sign * 3.0 / first);
                (2.0, 1.0)
            }
        };
        rows.mid[node(0)] = mid;
        (if last { &mut rows.low } else { &mut rows.high })[node(0)] = next;
    }
    felt(rows.solved())
}

/// The row of a difference quotient over one cell, times a factor.
fn add_secant(row: &mut [f64], (from, to): (usize, usize), by: f64) {
    row[from] -= by;
    row[to] += by;
}

fn open(steps: &[f64]) -> Vec<Vec<f64>> {
    let n = steps.len() + 1;
    if n == 2 {
        return vec![vec![-1.0 / steps[0], 1.0 / steps[0]]; 2];
    }
    // Three nodes: the parabola's end slopes take the place of the two conditions, which would be the same one.
    let parabola = n == 3;
    let mut rows = Rows::new(n);
    for k in 1..n - 1 {
        rows.smooth(k, (k - 1, k, k + 1), (steps[k - 1], steps[k]));
    }
    for last in [false, true] {
        // Cells and nodes counted from this end; a difference quotient has the same sign from either end.
        let node = |k: usize| if last { n - 1 - k } else { k };
        let (a, b) = if last { (steps[n - 2], steps[n - 3]) } else { (steps[0], steps[1]) };
        let sign = if last { -1.0 } else { 1.0 };
        let end = node(0);
        let (first, second, next) = if parabola {
            (((2.0 * a + b) / (a + b)) / a, -(a / (a + b)) / b, 0.0)
        } else {
            ((a + 2.0 * (a + b)) * b / (a + b) / a, a * a / (a + b) / b, a + b)
        };
        rows.mid[end] = if parabola { 1.0 } else { b };
        (if last { &mut rows.low } else { &mut rows.high })[end] = next;
        add_secant(&mut rows.right[end], (node(0), node(1)), sign * first);
        add_secant(&mut rows.right[end], (node(1), node(2)), sign * second);
    }
    rows.solved()
}

/// Periodic: node `n` is node 0.
fn around(steps: &[f64]) -> Vec<Vec<f64>> {
    let n = steps.len();
    let mut rows = Rows::new(n);
    for k in 0..n {
        let (before, after) = ((k + n - 1) % n, (k + 1) % n);
        rows.smooth(k, (before, k, after), (steps[before], steps[k]));
    }
    let mut slopes = felt(if n <= 2 {
        // Both neighbours are one node: the slopes are equal.
        rows.right.iter().zip(&rows.mid).map(|(row, mid)| row.iter().map(|x| x / (1.5 * mid)).collect()).collect()
    } else {
        rows.solved_around()
    });
    for row in &mut slopes {
        row.push(0.0);
    }
    let first = slopes[0].clone();
    slopes.push(first);
    slopes
}

/// A system of three diagonals with a right side of rows.
struct Rows {
    low: Vec<f64>,
    mid: Vec<f64>,
    high: Vec<f64>,
    right: Vec<Vec<f64>>,
}

impl Rows {
    fn new(n: usize) -> Self {
        Self::wide(n, n)
    }

    fn wide(n: usize, width: usize) -> Self {
        Self { low: vec![0.0; n], mid: vec![0.0; n], high: vec![0.0; n], right: vec![vec![0.0; width]; n] }
    }

    /// Row `k`: the bends of the pieces before and after a node are equal.
    fn smooth(&mut self, k: usize, (before, at, after): (usize, usize, usize), (a, b): (f64, f64)) {
        (self.low[k], self.mid[k], self.high[k]) = (b, 2.0 * (a + b), a);
        add_secant(&mut self.right[k], (before, at), 3.0 * b / a);
        add_secant(&mut self.right[k], (at, after), 3.0 * a / b);
    }

    /// Elimination without exchange: each pivot stays above the sum of what is left in its row.
    fn solved(mut self) -> Vec<Vec<f64>> {
        let n = self.mid.len();
        for k in 1..n {
            let by = self.low[k] / self.mid[k - 1];
            self.mid[k] -= by * self.high[k - 1];
            let (done, rest) = self.right.split_at_mut(k);
            rest[0].iter_mut().zip(&done[k - 1]).for_each(|(x, y)| *x -= by * y);
        }
        for k in (0..n).rev() {
            let (rest, done) = self.right.split_at_mut(k + 1);
            let high = self.high[k];
            for (i, x) in rest[k].iter_mut().enumerate() {
                *x = (*x - done.first().map_or(0.0, |next| high * next[i])) / self.mid[k];
            }
        }
        self.right
    }

    /// With `low[0]` and `high[n − 1]` in the corners: two rank-one terms taken out and put back [Sherman & Morrison 1950].
    fn solved_around(mut self) -> Vec<Vec<f64>> {
        let n = self.mid.len();
        let (top, bottom, gamma) = (self.low[0], self.high[n - 1], -self.mid[0]);
        self.mid[0] -= gamma;
        self.mid[n - 1] -= top * bottom / gamma;
        for (k, row) in self.right.iter_mut().enumerate() {
            row.push(if k == 0 {
                gamma
            } else if k == n - 1 {
                bottom
            } else {
                0.0
            });
        }
        let mut x = self.solved();
        let z: Vec<f64> = x.iter_mut().filter_map(Vec::pop).collect();
        let scale = 1.0 / (1.0 + z[0] + top / gamma * z[n - 1]);
        let shares: Vec<f64> = (0..n).map(|i| (x[0][i] + top / gamma * x[n - 1][i]) * scale).collect();
        for (row, z) in x.iter_mut().zip(&z) {
            row.iter_mut().zip(&shares).for_each(|(x, share)| *x -= share * z);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;

    #[test]
    fn cubics_parabolas_and_lines_keep_their_slopes() {
        let nodes = [0.0, 0.15, 0.4, 0.55, 0.6, 0.83, 1.0];
        for n in 2..=nodes.len() {
            let x = &nodes[..n];
            let degree = (n - 1).min(3) as i32;
            let (value, slope) = (|x: f64| math::powi(x - 0.3, degree), |x: f64| f64::from(degree) * math::powi(x - 0.3, degree - 1));
            for (k, row) in slopes(x, false).iter().enumerate() {
                let found: f64 = row.iter().zip(x).map(|(d, x)| d * value(*x)).sum();
                assert!((found - slope(x[k])).abs() < 1e-12, "{n} {k}: {found} {}", slope(x[k]));
                assert!(row.iter().sum::<f64>().abs() < 1e-11);
            }
        }
    }

    #[test]
    fn ends_are_as_they_are_said() {
        let nodes = [0.0, 0.15, 0.4, 0.55, 1.0];
        let cubic = |x: f64| (math::powi(x - 0.3, 3) + x, 3.0 * (x - 0.3) * (x - 0.3) + 1.0);
        for n in 2..=nodes.len() {
            let x = &nodes[..n];
            let given = |rows: &[Vec<f64>], k: usize| {
                let values = x.iter().map(|x| cubic(*x).0).chain([cubic(x[0]).1, cubic(x[n - 1]).1]);
                rows[k].iter().zip(values).map(|(d, y)| d * y).sum::<f64>()
            };
            let both = ended(x, (End::Slope, End::Slope));
            (0..n).for_each(|k| assert!((given(&both, k) - cubic(x[k]).1).abs() < 1e-12, "{n} {k}"));
            if n > 2 {
                let one = ended(x, (End::Slope, End::Plain));
                (0..n).for_each(|k| assert!((given(&one, k) - cubic(x[k]).1).abs() < 1e-12, "{n} {k}"));
            }
            // Without a bend at its start the first piece ends with the slope (3 secants − its first slope) / 2.
            let natural = ended(x, (End::Natural, End::Slope));
            let secant = (cubic(x[1]).0 - cubic(x[0]).0) / (x[1] - x[0]);
            assert!((2.0 * given(&natural, 0) + given(&natural, 1) - 3.0 * secant).abs() < 1e-12, "{n}");
        }
    }

    #[test]
    fn slopes_of_many_nodes_feel_some_fifty_and_still_know_cubics() {
        let nodes: Vec<f64> = (0..400).map(|k| math::powi(f64::from(k) / 399.0, 2)).skip(100).collect();
        for (k, row) in slopes(&nodes, false).iter().enumerate() {
            let near: Vec<usize> = (0..row.len()).filter(|i| row[*i] != 0.0).collect();
            assert!(near.len() < 60 && near.iter().all(|i| i.abs_diff(k) < 30), "{k}: {near:?}");
            let found: f64 = row.iter().zip(&nodes).map(|(d, x)| d * x * x * x).sum();
            assert!((found - 3.0 * nodes[k] * nodes[k]).abs() < 1e-11, "{k}: {found}");
        }
        let ring: Vec<f64> = (0..=200).map(|k| f64::from(k) / 200.0).collect();
        let rows = slopes(&ring, true);
        assert!(rows.iter().all(|row| row.iter().filter(|by| **by != 0.0).count() < 60 && row[200] == 0.0));
    }

    #[test]
    fn periodic_slopes_satisfy_their_equations_and_do_not_know_the_seam() {
        let steps = [0.2, 0.1, 0.4, 0.3];
        let values = [3.0, -1.0, 0.5, 2.0];
        let m = |turn: usize| -> Vec<f64> {
            let mut nodes = vec![0.0];
            (0..4).for_each(|k| nodes.push(nodes[k] + steps[(k + turn) % 4]));
            let d = slopes(&nodes, true);
            assert_eq!(d[0], d[4]);
            (0..4).map(|k| (0..4).map(|i| d[k][i] * values[(i + turn) % 4]).sum()).collect()
        };
        let base = m(0);
        for k in 0..4 {
            let (a, b) = (steps[(k + 3) % 4], steps[k]);
            let secant = |k: usize| (values[(k + 1) % 4] - values[k % 4]) / steps[k % 4];
            let left = b * base[(k + 3) % 4] + 2.0 * (a + b) * base[k] + a * base[(k + 1) % 4];
            assert!((left - 3.0 * (b * secant(k + 3) + a * secant(k))).abs() < 1e-12);
            (0..4).for_each(|turn| assert!((m(turn)[(k + 4 - turn) % 4] - base[k]).abs() < 1e-12));
        }
        for n in [1, 2] {
            let nodes: Vec<f64> = (0..=n).map(|k| k as f64 / n as f64).collect();
            assert!(slopes(&nodes, true).iter().flatten().all(|d| d.abs() < 1e-12));
        }
    }
}
