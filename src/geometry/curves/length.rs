//! Lengths along a curve of any kind: in closed form where its speed is even, else from its table.

use glam::DVec3;

use crate::geometry::curves::arclength::{Lengths, lengths_of};
use crate::geometry::curves::curve::{Curve, Shape};

impl Curve {
    /// Arc length, model units (relative error 1e-13).
    pub fn length(&self) -> f64 {
        match self.shape() {
            Shape::Line(a, b) => a.distance(*b),
            Shape::Composite(c) => c.starts()[c.pieces.len()],
            _ => match self.even_speed() {
                Some(speed) => speed * (self.domain().1 - self.domain().0),
                None => self.lengths().total(),
            },
        }
    }

    /// Arc length from the start to parameter `t`.
    pub fn length_at(&self, t: f64) -> f64 {
        match self.shape() {
            Shape::Composite(c) => c.length_at(t),
            _ => match self.even_speed() {
                Some(speed) => speed * t.clamp(0.0, self.domain().1),
                None => self.lengths().at(t),
            },
        }
    }

    /// Parameter at arc length `s` from the start; `s` outside 0…length gives the nearer end.
    pub fn param_at_length(&self, s: f64) -> f64 {
        match self.shape() {
            Shape::Composite(c) => c.param_at_length(s),
            _ => match self.even_speed() {
                Some(speed) => even_param(s, speed, self.domain().1),
                None => self.lengths().param(s),
            },
        }
    }

    /// Parameters at many arc lengths, appended to `out`; fastest when the lengths ascend.
    pub fn params_at_lengths(&self, lengths: &[f64], out: &mut Vec<f64>) {
        out.reserve(lengths.len());
        match (self.shape(), self.even_speed()) {
            (Shape::Composite(c), _) => out.extend(lengths.iter().map(|s| c.param_at_length(*s))),
            (_, Some(speed)) => out.extend(lengths.iter().map(|s| even_param(*s, speed, self.domain().1))),
            (_, None) => {
                let (table, mut panel) = (self.lengths(), usize::MAX);
                out.extend(lengths.iter().map(|s| table.param_near(*s, &mut panel)));
            }
        }
    }

    /// `n` equally spaced points along the curve, both ends included (a single one is the start).
    pub fn points_along(&self, n: usize) -> Vec<DVec3> {
        let (length, last) = (self.length(), n.saturating_sub(1).max(1));
        let lengths: Vec<f64> = (0..n).map(|i| length * i as f64 / last as f64).collect();
        let mut params = Vec::new();
        self.params_at_lengths(&lengths, &mut params);
        // The ends are the curve's own, whatever rounding made of the last length.
        let ends = |i: usize, t: f64| if i + 1 == n && n > 1 { self.end() } else { self.point(t) };
        params.iter().enumerate().map(|(i, t)| ends(i, *t)).collect()
    }

    /// Length per parameter where it is the same everywhere and the domain starts at 0.
    fn even_speed(&self) -> Option<f64> {
        match self.shape() {
            Shape::Line(a, b) => Some(a.distance(*b)),
            Shape::Arc(arc) => arc.radius,
            Shape::Helix(helix) => Some(helix.speed()),
            _ => None,
        }
    }
}

impl Lengths {
    /// The table of a curve; of a polyline in closed form.
    pub(crate) fn of(curve: &Curve) -> Self {
        match curve.shape() {
            Shape::Nurbs(c) if c.degree == 1 && c.polynomial => {
                let mut done = 0.0;
                let mut before = curve.start();
                Self::proportional(c.breaks().into_iter().map(|(t, _)| {
                    let p = c.jet_in(c.span_before(t), t).p;
                    done += p.distance(before);
                    before = p;
                    (t, done)
                }))
            }
            _ => lengths_of(curve, &curve.knots()),
        }
    }
}

fn even_param(s: f64, speed: f64, last: f64) -> f64 {
    if speed > 0.0 { (s / speed).clamp(0.0, last) } else { 0.0 }
}
