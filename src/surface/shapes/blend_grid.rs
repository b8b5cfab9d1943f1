//! A blended surface on tensor grids: what depends on u alone or on v alone is evaluated once.

use glam::DVec3;

use crate::base::par;
use crate::geometry::Jet;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::blend::{Blend, BlendSum};
use crate::surface::shapes::blend_terms::{all_terms, asked_terms};
use crate::surface::shapes::weights::Weights;

/// Rows of points made by one thread at a time.
const ROWS: usize = 16;

impl Blend {
    /// Points of the tensor grid `us × vs`, u fastest. Every curve is evaluated once per row or column.
    pub fn grid(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        let rows: Vec<Weights> = vs.iter().map(|&v| self.axes().1.weights(v, OneSided::After)).collect();
        let columns = Columns::new(self, us, &rows);
        let rows = RowPoints::new(self, vs, rows);
        let width = us.len().max(1);
        par::chunks_mut(out, width * ROWS, |chunk, part| {
            for (line, k) in part.chunks_exact_mut(width).zip(chunk * ROWS..vs.len()) {
                self.grid_row(&columns, &rows, k, line);
            }
        });
    }

    fn grid_row(&self, columns: &Columns, rows: &RowPoints, k: usize, line: &mut [DVec3]) {
        let b = &rows.weights[k];
        let curves: Vec<(&[DVec3], f64)> = b.iter().map(|(j, w)| (columns.along_u[j].as_slice(), w[0])).collect();
        // F_i(v) less the nodes: what each term along v adds at weight 1.
        let own: Vec<DVec3> =
            (0..rows.along_v.len()).map(|i| b.iter().fold(rows.along_v[i][k], |f, (j, w)| f - self.corner(i, j) * w[0])).collect();
        match (curves.as_slice(), own.is_empty()) {
            ([(g0, w0), (g1, w1)], false) if columns.paired => {
                for run in &columns.runs {
                    let (f0, step) = (own[run.first], own[run.first + 1] - own[run.first]);
                    let range = run.from..run.to;
                    let second = &columns.second[range.clone()];
                    let (g0, g1) = (&g0[range.clone()], &g1[range.clone()]);
                    for (((p, s), a), b) in line[range].iter_mut().zip(second).zip(g0).zip(g1) {
                        *p = f0 + step * *s + *a * *w0 + *b * *w1;
                    }
                }
            }
            _ => {
                for (c, p) in line.iter_mut().enumerate() {
                    let along = curves.iter().fold(DVec3::ZERO, |sum, (g, w)| sum + g[c] * *w);
                    *p = if own.is_empty() { along } else { columns.weights[c].iter().fold(along, |sum, (i, w)| sum + own[i] * w[0]) };
                }
            }
        }
    }

    /// Jets of the tensor grid `us × vs`, u fastest, each with its own side (see [`Blend::jet`]).
    pub fn jets(&self, us: &[(f64, OneSided)], vs: &[(f64, OneSided)], out: &mut Vec<Jet2>) {
        let a: Vec<Weights> = us.iter().map(|&(u, side)| self.axes().0.weights(u, side)).collect();
        let rows: Vec<Weights> = vs.iter().map(|&(v, side)| self.axes().1.weights(v, side)).collect();
        let curve = |j: usize| us.iter().map(|&(u, side)| self.along_u()[j].jet(u, side)).collect();
        let along_u: Vec<Vec<Jet>> = asked_terms(self.axes().1, self.along_u().len(), &rows, curve);
        for (&(v, side), b) in vs.iter().zip(&rows) {
            let along_v = self.along_v().iter().map(|f| vec![f.jet(v, side)]).collect();
            let mut along_v: Vec<Vec<Jet>> = all_terms(self.axes().0, along_v);
            along_v.iter_mut().enumerate().for_each(|(i, f)| self.less_nodes(i, b, &mut f[0]));
            for (c, a) in a.iter().enumerate() {
                let mut row = BlendSum::default();
                if !along_v.is_empty() {
                    a.iter().for_each(|(i, w)| row.add_along_v(&along_v[i][0], w));
                }
                for (j, w) in b.iter() {
                    row.add_along_u(&along_u[j][c], w);
                }
                out.push(row.0);
            }
        }
    }
}

/// Everything of a grid that depends on u alone.
struct Columns {
    /// Two terms take part along u and two along v, at every parameter: columns have no other weights than `second`.
    paired: bool,
    weights: Vec<Weights>,
    /// Of pairs: the weight of the second one, and runs of columns between the same two curves.
    second: Vec<f64>,
    runs: Vec<ColumnRun>,
    along_u: Vec<Vec<DVec3>>,
}

struct ColumnRun {
    from: usize,
    to: usize,
    first: usize,
}

impl Columns {
    fn new(blend: &Blend, us: &[f64], rows: &[Weights]) -> Self {
        let paired = blend.axes().0.active() == 2 && blend.axes().1.active() == 2;
        let (mut weights, mut second, mut runs) = (Vec::new(), Vec::new(), Vec::<ColumnRun>::new());
        for (c, &u) in us.iter().enumerate() {
            let a = blend.axes().0.weights(u, OneSided::After);
            if paired {
                second.push(a.values()[1][0]);
                match runs.last_mut() {
                    Some(run) if run.first == a.cell() => run.to = c + 1,
                    _ => runs.push(ColumnRun { from: c, to: c + 1, first: a.cell() }),
                }
            } else {
                weights.push(a);
            }
        }
        let along_u = asked_terms(blend.axes().1, blend.along_u().len(), rows, |j| blend.along_u()[j].points(us));
        Self { paired, weights, second, runs, along_u }
    }
}

/// Everything of a grid that depends on v alone.
struct RowPoints {
    weights: Vec<Weights>,
    along_v: Vec<Vec<DVec3>>,
}

impl RowPoints {
    fn new(blend: &Blend, vs: &[f64], weights: Vec<Weights>) -> Self {
        Self { weights, along_v: all_terms(blend.axes().0, blend.along_v().iter().map(|f| f.points(vs)).collect()) }
    }
}
