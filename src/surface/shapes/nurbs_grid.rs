//! Points and derivatives of a rational B-spline surface on tensor grids: each basis is made once, and the net is contracted once a row.

use glam::{DVec3, DVec4};

use crate::base::par;
use crate::geometry::shapes::nurbs::projected;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::nurbs::{Basis, COMMON, MOST, NurbsSurface, basis, quotient};

/// Rows of points made by one thread at a time.
const ROWS: usize = 16;

impl NurbsSurface {
    /// Points of the tensor grid, u fastest: the net is contracted once per row.
    pub fn grid(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        if self.is_common() { self.grid_on::<COMMON>(us, vs, out) } else { self.grid_on::<MOST>(us, vs, out) }
    }

    fn grid_on<const N: usize>(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        let columns: Vec<Basis<N>> = us.iter().map(|&u| basis(&self.knots.0, self.degree.0, u, OneSided::After)).collect();
        let width = us.len().max(1);
        par::chunks_mut(out, width * ROWS, |chunk, part| {
            let mut row = vec![DVec4::ZERO; self.counts.0];
            for (line, &v) in part.chunks_exact_mut(width).zip(&vs[(chunk * ROWS).min(vs.len())..]) {
                let b: Basis<N> = basis(&self.knots.1, self.degree.1, v, OneSided::After);
                for (i, q) in row.iter_mut().enumerate() {
                    *q = b.values().iter().enumerate().fold(DVec4::ZERO, |sum, (j, y)| sum + self.pole(i, b.first + j) * y[0]);
                }
                for (p, a) in line.iter_mut().zip(&columns) {
                    let q = a.values().iter().zip(&row[a.first..]).fold(DVec4::ZERO, |sum, (x, q)| sum + *q * x[0]);
                    *p = projected(q);
                }
            }
        });
    }

    /// Points and derivatives on the tensor grid, u fastest, from the given sides where they jump; added to `out`.
    pub fn jets(&self, us: &[(f64, OneSided)], vs: &[(f64, OneSided)], out: &mut Vec<Jet2>) {
        if self.is_common() { self.jets_on::<COMMON>(us, vs, out) } else { self.jets_on::<MOST>(us, vs, out) }
    }

    fn jets_on<const N: usize>(&self, us: &[(f64, OneSided)], vs: &[(f64, OneSided)], out: &mut Vec<Jet2>) {
        let columns: Vec<Basis<N>> = us.iter().map(|&(u, side)| basis(&self.knots.0, self.degree.0, u, side)).collect();
        // Columns of the net that are needed: of a cell only few.
        let first = columns.iter().map(|a| a.first).min().unwrap_or(0);
        let end = columns.iter().map(|a| a.first + a.values().len()).max().unwrap_or(0);
        // The net at one v: values, first and second derivatives along v.
        let mut row = vec![[DVec4::ZERO; 3]; end - first];
        out.reserve(us.len() * vs.len());
        for &(v, side) in vs {
            let b: Basis<N> = basis(&self.knots.1, self.degree.1, v, side);
            row.fill([DVec4::ZERO; 3]);
            for (j, y) in b.values().iter().enumerate() {
                let poles = &self.poles[(b.first + j) * self.counts.0..][first..end];
                for (sums, q) in row.iter_mut().zip(poles) {
                    (0..3).for_each(|k| sums[k] += *q * y[k]);
                }
            }
            out.extend(columns.iter().map(|a| {
                let mut sums = [DVec4::ZERO; 6];
                for (q, x) in row[a.first - first..].iter().zip(a.values()) {
                    sums[0] += q[0] * x[0];
                    sums[1] += q[0] * x[1];
                    sums[2] += q[1] * x[0];
                    sums[3] += q[0] * x[2];
                    sums[4] += q[1] * x[1];
                    sums[5] += q[2] * x[0];
                }
                quotient(&sums)
            }));
        }
    }
}
