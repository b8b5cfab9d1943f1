//! Skins that keep to their sections within a distance, with few spans across.
//!
//! Curves at chosen sections are fitted by least squares to all of them; the first and the last section are kept as they are.
//! Where a section is left by more than the distance allows the worst one is chosen too; then those are given up again that
//! are not needed.

use glam::DVec3;

use crate::base::job;
use crate::base::solve::dense;
use crate::base::tolerance::Tolerance;
use crate::surface::blended::family::evenly;
use crate::surface::blended::skin_ends::Spanned;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::mixed::{Mixed, Part};
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::weights::BlendAxis;

/// Places along each section at which a fit is measured.
const PLACES: usize = 65;

/// The sections as points at their parameters across.
struct SectionFit<'a> {
    nodes: &'a [f64],
    points: Vec<Vec<DVec3>>,
    closed: bool,
}

/// Fewer curves, sums of those given, of which a spline leaves the given ones by `allowed` at most.
///
/// In a closed direction the last of `nodes` is 1 and has no curve, given and returned.
pub fn fitted(nodes: &[f64], rails: &[Rail], closed: bool, allowed: f64, tolerance: &Tolerance) -> Spanned {
    let us = evenly(PLACES);
    let fit = SectionFit { nodes, points: rails.iter().map(|rail| rail.points(&us)).collect(), closed };
    let chosen = fit.few(allowed);
    let shares = fit.shares(&chosen).unwrap_or_default();
    let mut all: Vec<f64> = chosen.iter().map(|k| nodes[*k]).collect();
    if closed {
        all.push(1.0);
    }
    let curve = |(row, k): (&Vec<f64>, &usize)| {
        if row[*k] == 1.0 && row.iter().filter(|by| **by != 0.0).count() == 1 {
            return rails[*k].clone();
        }
        let parts = rails.iter().zip(row).map(|(rail, by)| Part { by: *by, rail: rail.clone(), onto: None }).collect();
        Rail::Mixed(Box::new(Mixed::new(parts, tolerance)))
    };
    let curves = shares.iter().zip(&chosen).map(curve).collect();
    Spanned { nodes: all, rails: curves }
}

impl SectionFit<'_> {
    /// Sections at which the fit has its curves.
    fn few(&self, allowed: f64) -> Vec<usize> {
        let n = self.points.len();
        let (least, last) = if self.closed { (3, n) } else { (2, n - 1) };
        let mut chosen: Vec<usize> = if self.closed { vec![0, n / 3, 2 * n / 3] } else { vec![0, last] };
        chosen.dedup();
        while chosen.len() < n {
            job::poll();
            let off = self.off(&chosen);
            let worst = (0..n).filter(|k| !chosen.contains(k)).max_by(|a, b| off[*a].total_cmp(&off[*b]).then(b.cmp(a)));
            if off.iter().all(|off| *off <= allowed) {
                break;
            }
            let Some(worst) = worst else { break };
            chosen.insert(chosen.partition_point(|k| *k < worst), worst);
        }
        let mut k = 1;
        while k < chosen.len() && chosen.len() > least {
            job::poll();
            if !self.closed && k + 1 == chosen.len() {
                break;
            }
            let mut fewer = chosen.clone();
            fewer.remove(k);
            if self.off(&fewer).iter().all(|off| *off <= allowed) {
                chosen = fewer;
            } else {
                k += 1;
            }
        }
        chosen
    }

    /// How far each section is left.
    fn off(&self, chosen: &[usize]) -> Vec<f64> {
        let n = self.points.len();
        let Some(shares) = self.shares(chosen) else { return vec![f64::INFINITY; n] };
        let basis = self.basis(chosen);
        let places = self.points[0].len();
        let mixed = |by: &[f64], of: &[Vec<DVec3>], c: usize| by.iter().zip(of).fold(DVec3::ZERO, |sum, (by, row)| sum + row[c] * *by);
        let curves: Vec<Vec<DVec3>> = shares.iter().map(|row| (0..places).map(|c| mixed(row, &self.points, c)).collect()).collect();
        let one = |k: usize| (0..places).map(|c| mixed(&basis[k], &curves, c).distance(self.points[k][c])).fold(0.0, f64::max);
        (0..n).map(one).collect()
    }

    /// Of each section the shares of the chosen curves in the spline at its parameter.
    fn basis(&self, chosen: &[usize]) -> Vec<Vec<f64>> {
        let mut nodes: Vec<f64> = chosen.iter().map(|k| self.nodes[*k]).collect();
        if self.closed {
            nodes.push(1.0);
        }
        let axis = BlendAxis::new(nodes, if self.closed { Rule::Periodic } else { Rule::Spline });
        let m = chosen.len();
        let row = |k: usize| {
            let weights = axis.weights(self.nodes[k], OneSided::After);
            // Where it closes the last node is the first one.
            let own = |i: usize| axis.whole(&weights, i)[0];
            (0..m).map(|i| own(i) + if self.closed && i == 0 { own(m) } else { 0.0 }).collect()
        };
        (0..self.points.len()).map(row).collect()
    }

    /// The chosen curves as shares of the sections, in rows: least squares with the first one, and the last open one, as given.
    fn shares(&self, chosen: &[usize]) -> Option<Vec<Vec<f64>>> {
        let (n, m) = (self.points.len(), chosen.len());
        let basis = self.basis(chosen);
        let kept = |i: usize| i == 0 || !self.closed && i + 1 == m;
        let free: Vec<usize> = (0..m).filter(|i| !kept(*i)).collect();
        let width = free.len();
        let mut matrix = vec![0.0; width * width];
        for row in &basis {
            for (a, i) in free.iter().enumerate() {
                free.iter().enumerate().for_each(|(b, j)| matrix[a * width + b] += row[*i] * row[*j]);
            }
        }
        let mut shares = vec![vec![0.0; n]; m];
        (0..m).filter(|i| kept(*i)).for_each(|i| shares[i][chosen[i]] = 1.0);
        for k in 0..n {
            // What section k adds to the right side, less what the kept ones do.
            let mut right: Vec<f64> = free.iter().map(|i| basis[k][*i]).collect();
            for (i, _) in chosen.iter().enumerate().filter(|(i, c)| kept(*i) && **c == k) {
                for row in &basis {
                    right.iter_mut().zip(&free).for_each(|(x, j)| *x -= row[*j] * row[i]);
                }
            }
            if width > 0 && !dense(&mut matrix.clone(), &mut right) {
                return None;
            }
            free.iter().zip(right).for_each(|(i, x)| shares[*i][k] = x);
        }
        Some(shares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_of_sections_needs_three_spans_less() {
        let nodes = evenly(9);
        let place = |v: f64, u: f64| DVec3::new(u, v, v * v * (1.0 - v) * (1.0 + u));
        let us = evenly(PLACES);
        let points = nodes.iter().map(|v| us.iter().map(|u| place(*v, *u)).collect()).collect();
        let fit = SectionFit { nodes: &nodes, points, closed: false };
        let chosen = fit.few(1e-12);
        assert_eq!(chosen.len(), 4, "{chosen:?}");
        assert!(fit.off(&chosen).iter().all(|off| *off < 1e-12));
        let all: Vec<usize> = (0..9).collect();
        let shares = fit.shares(&all).expect("a system that can be solved");
        assert!(shares.iter().enumerate().all(|(k, row)| (row[k] - 1.0).abs() < 1e-9), "all of them are interpolated");
    }
}
