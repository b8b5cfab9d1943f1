//! Terms of a blending sum: rows of values at the nodes of an axis, and for splines rows of the slopes there.

use glam::DVec3;

use crate::geometry::Jet;
use crate::surface::shapes::weights::{BlendAxis, Weights};

/// The lines of a spline's four active terms in a cell, each curve evaluated once.
pub(super) fn active_lines(axis: &BlendAxis, cell: usize, curve: impl Fn(usize) -> Jet) -> [Jet; 4] {
    let mut lines = [Jet::default(); 4];
    let rows = axis.slopes_of(cell);
    let (first, second) = (&axis.slopes()[rows.0], &axis.slopes()[rows.1]);
    for i in 0..axis.nodes.len() {
        if first[i] == 0.0 && second[i] == 0.0 && i != cell && i != cell + 1 {
            continue;
        }
        let jet = curve(i);
        if i == cell {
            lines[0] = jet;
        } else if i == cell + 1 {
            lines[1] = jet;
        }
        jet.add_times(first[i], &mut lines[2]);
        jet.add_times(second[i], &mut lines[3]);
    }
    lines
}

/// What sums of curves are made of.
pub(super) trait Terms: Copy + Default {
    /// `sum += by · self`.
    fn add_times(&self, by: f64, sum: &mut Self);
}

impl Terms for DVec3 {
    fn add_times(&self, by: f64, sum: &mut Self) {
        *sum += *self * by;
    }
}

impl Terms for Jet {
    fn add_times(&self, by: f64, sum: &mut Self) {
        sum.p += self.p * by;
        sum.d1 += self.d1 * by;
        sum.d2 += self.d2 * by;
    }
}

/// Rows of values, one per node of an axis (or none), and after them those of the slopes across the nodes.
pub(super) fn all_terms<T: Terms>(axis: &BlendAxis, mut rows: Vec<Vec<T>>) -> Vec<Vec<T>> {
    let width = rows.first().map_or(0, Vec::len);
    if !rows.is_empty() {
        for slope in axis.slopes() {
            let mut sums = vec![T::default(); width];
            for (row, &by) in rows.iter().zip(slope).filter(|(_, by)| **by != 0.0) {
                row.iter().zip(&mut sums).for_each(|(x, sum)| x.add_times(by, sum));
            }
            rows.push(sums);
        }
    }
    rows
}

/// The same of the terms that some blending values ask for, from the `n` curves that these are sums of; the others are empty.
pub(super) fn asked_terms<T: Terms>(axis: &BlendAxis, n: usize, weights: &[Weights], curve: impl Fn(usize) -> Vec<T>) -> Vec<Vec<T>> {
    if axis.slopes().is_empty() || n == 0 {
        return (0..n).map(curve).collect();
    }
    let mut asked = vec![false; axis.terms()];
    weights.iter().flat_map(Weights::iter).for_each(|(term, _)| asked[term] = true);
    let slopes = || axis.slopes().iter().zip(&asked[n..]);
    let taken = |i: usize| asked[i] || slopes().any(|(slope, asked)| *asked && slope[i] != 0.0);
    let mut rows: Vec<Vec<T>> = (0..n).map(|i| if taken(i) { curve(i) } else { Vec::new() }).collect();
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    for (slope, asked) in slopes() {
        let mut sums = if *asked { vec![T::default(); width] } else { Vec::new() };
        for (row, &by) in rows.iter().zip(slope).filter(|(_, by)| **by != 0.0) {
            row.iter().zip(&mut sums).for_each(|(x, sum)| x.add_times(by, sum));
        }
        rows.push(sums);
    }
    rows
}

/// Nodes, `i` fastest, with their slopes in u, in v and in both.
pub(super) fn with_slopes(nodes: &[DVec3], width: usize, u: &BlendAxis, v: &BlendAxis) -> Vec<DVec3> {
    if width == 0 || (u.slopes().is_empty() && v.slopes().is_empty()) {
        return nodes.to_vec();
    }
    let columns = (0..width).map(|i| nodes.iter().skip(i).step_by(width).copied().collect()).collect();
    let columns = all_terms(u, columns);
    let rows = (0..nodes.len() / width).map(|j| columns.iter().map(|column| column[j]).collect()).collect();
    all_terms(v, rows).concat()
}
