//! Nets with a strip more on a side.

use glam::DVec4;

use crate::base::solve::lowest;
use crate::base::tolerance::{CUSP, NEAREST, NUDGE};
use crate::geometry::Nurbs;
use crate::geometry::construct::extend::{Onward, step_beyond};
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::kind::Kind;
use crate::geometry::shapes::nurbs_edit::Bezier;
use crate::surface::analysis::extend::Rim;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Rows of a net that run across a side, each towards it.
struct Across {
    rows: Vec<Nurbs>,
    /// Their last spans.
    tails: Vec<Nurbs>,
    /// Degree and knots of the side.
    side: (usize, Vec<f64>),
}

impl Across {
    fn of(net: &NurbsSurface, rim: Rim) -> Self {
        let (nu, nv) = net.counts;
        let in_u = rim.in_u();
        let (along, across) = if in_u { (nu, nv) } else { (nv, nu) };
        let row = |j: usize| {
            let poles = (0..along).map(|i| if in_u { net.pole(i, j) } else { net.pole(j, i) }).collect();
            let (degree, knots) = if in_u { (net.degree.0, &net.knots.0) } else { (net.degree.1, &net.knots.1) };
            let row = Nurbs::new(degree, knots.clone(), poles);
            if rim.at_start() { row.reversed() } else { row }
        };
        let side = if in_u { (net.degree.1, net.knots.1.clone()) } else { (net.degree.0, net.knots.0.clone()) };
        let rows: Vec<Nurbs> = (0..across).map(row).collect();
        let tail = |row: &Nurbs| row.part(row.knots[row.span_before(row.domain().1)], row.domain().1);
        Self { tails: rows.iter().map(tail).collect(), rows, side }
    }

    /// The net of the rows.
    fn net(self, rim: Rim) -> NurbsSurface {
        let rows: Vec<Nurbs> = self.rows.into_iter().map(|row| if rim.at_start() { row.reversed() } else { row }).collect();
        let (degree, knots) = (rows[0].degree, &rows[0].knots);
        let (low, high) = rows[0].domain();
        let knots: Vec<f64> = knots.iter().map(|k| if *k == high { 1.0 } else { (k - low) / (high - low) }).collect();
        let (along, across) = (rows[0].poles.len(), rows.len());
        if rim.in_u() {
            let poles = rows.into_iter().flat_map(|row| row.poles).collect();
            NurbsSurface { degree: (degree, self.side.0), knots: (knots, self.side.1), poles, counts: (along, across) }
        } else {
            let poles = (0..along).flat_map(|i| rows.iter().map(move |row| row.poles[i])).collect();
            NurbsSurface { degree: (self.side.0, degree), knots: (self.side.1, knots), poles, counts: (across, along) }
        }
    }

    /// A combination of the last spans at a parameter of the side: a line across it.
    fn line(&self, t: f64) -> Nurbs {
        let poles = (0..self.tails[0].poles.len()).map(|i| {
            let column: Vec<DVec4> = self.tails.iter().map(|row| row.poles[i]).collect();
            let side = Nurbs::new(self.side.0, self.side.1.clone(), column);
            let k = side.span(t);
            side.blossom(k, &vec![t; side.degree])
        });
        Nurbs::new(self.tails[0].degree, self.tails[0].knots.clone(), poles.collect())
    }

    /// Parameter beyond the side at which the line across it at `t` is longer by `by`; infinite where it never is, or stands still.
    fn step(&self, t: f64, by: f64, how: Onward) -> f64 {
        let line = self.line(t);
        let end = line.domain().1;
        if how == Onward::Linear {
            let jet = line.jet_in(line.span_before(end), end);
            // (N + s N′) / (w + s w′) is at a distance |P′| s / (1 + s w′/w) from N / w.
            let slowing = rate(&line).w / line.poles[line.poles.len() - 1].w;
            let left = jet.d1.length() - by * slowing;
            return if left > 0.0 { by / left } else { f64::INFINITY };
        }
        let curve = Curve::new(Shape::Nurbs(line.into()), Kind::Nurbs, crate::base::origin::Origin::NONE);
        step_beyond(&curve, by).unwrap_or(f64::INFINITY)
    }

    /// The smallest of all steps: no line across becomes longer by more than `by`, and one by just that.
    fn least_step(&self, by: f64, how: Onward) -> f64 {
        let places = 4 * self.side.0 + 4;
        let mut stops: Vec<f64> = self.side.1.clone();
        stops.dedup();
        let inside = |w: &[f64]| -> Vec<f64> { (0..places).map(|k| w[0] + (w[1] - w[0]) * k as f64 / places as f64).collect() };
        let mut all: Vec<f64> = stops.windows(2).flat_map(inside).collect();
        all.push(1.0);
        let steps: Vec<f64> = all.iter().map(|t| self.step(*t, by, how)).collect();
        let best = (0..all.len()).min_by(|a, b| steps[*a].total_cmp(&steps[*b])).unwrap_or(0);
        let (low, high) = (all[best.saturating_sub(1)], all[(best + 1).min(all.len() - 1)]);
        let even = |other: f64| (other - steps[best]).abs() <= NEAREST * steps[best];
        if !steps[best].is_finite() || steps.iter().copied().all(even) {
            return steps[best];
        }
        let at = lowest(low, high, NUDGE, |t| self.step(t, by, how));
        steps[best].min(self.step(at, by, how))
    }
}

/// Homogeneous derivative of a row at its end.
fn rate(row: &Nurbs) -> DVec4 {
    let n = row.poles.len();
    let span = row.knots[n] - row.knots[n - 1];
    (row.poles[n - 1] - row.poles[n - 2]) * (row.degree as f64 / span)
}

/// Why a net has no strip more.
pub(super) enum NoStrip {
    /// Nothing crosses the side with a direction.
    Still,
    /// A weight vanishes on the way.
    Weight,
}

/// A net with a strip on at a side that is no point: the parameter goes on so far that the longest of the lines across the side becomes
/// longer by `by` model units. Linear ones are straight; others go on as their last polynomial or rational pieces.
pub(super) fn with_strip(net: &NurbsSurface, rim: Rim, by: f64, how: Onward) -> Result<NurbsSurface, NoStrip> {
    let mut across = Across::of(net, rim);
    let size = net.hull().diagonal();
    let moving = across.rows.iter().any(|row| {
        let end = row.domain().1;
        row.jet_in(row.span_before(end), end).d1.length() > CUSP * size
    });
    if !moving {
        return Err(NoStrip::Still);
    }
    let step = across.least_step(by, how);
    if !step.is_finite() {
        return Err(NoStrip::Weight);
    }
    let degree = across.rows[0].degree;
    let strip = |row: &Nurbs| match how {
        Onward::Linear => {
            let (last, rate, t0) = (row.poles[row.poles.len() - 1], rate(row), row.domain().1);
            let poles = (0..=degree).map(|k| last + rate * (step * k as f64 / degree as f64)).collect();
            Bezier { t0, t1: t0 + step, poles }
        }
        _ => row.onward(step),
    };
    let parts = Bezier::with_weights(across.rows.iter().map(strip).collect()).ok_or(NoStrip::Weight)?;
    for part in parts {
        for (row, more) in across.rows.iter_mut().zip(part) {
            row.knots.truncate(row.poles.len() + degree);
            row.knots.extend(std::iter::repeat_n(more.t1, degree + 1));
            row.poles.extend(&more.poles[1..]);
            row.polynomial = row.poles.windows(2).all(|q| q[0].w == q[1].w);
        }
    }
    Ok(across.net(rim))
}
