//! A net made ready for many evaluations: one polynomial a span, and bounds of its third derivatives.
//!
//! The power form over 0…1 of a span costs a few dozen multiplications a point where the basis functions cost hundreds.
//! With |∂³| known over a box, second derivatives in it are those in its middle and a little more: a bound for the price
//! of one evaluation. `docs/notes/bounds.md` has the formulas.

use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4};

use crate::base::tolerance::{BEFORE_KNOT, EPSILON};
use crate::base::work;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::nurbs::quotient;
use crate::surface::shapes::powers::Powers;
use crate::surface::shapes::third_derivative_bounds::DerivativesAlong;

/// Highest degree in powers: about the middle of a span they lose a factor of 2 a degree, here 4e-12 of the size.
const HIGHEST: usize = 14;

/// A net, ready.
#[derive(Clone, Debug)]
pub struct PowerForm {
    surface: Surface,
    net: Arc<Powers>,
}

/// Second derivatives along a unit vector over a box.
#[derive(Clone, Copy, Debug)]
pub struct Bends {
    /// Those in the middle: ∂uu, ∂uv, ∂vv.
    pub mid: [f64; 3],
    /// How far they may be from there.
    pub slack: [f64; 3],
    /// How far jumps of first derivatives inside move the surface away from what second ones say, model units.
    pub jump: f64,
}

impl Bends {
    /// What holds both.
    pub fn union(&self, other: &Self) -> Self {
        let range = |k: usize| {
            let low = (self.mid[k] - self.slack[k]).min(other.mid[k] - other.slack[k]);
            let high = (self.mid[k] + self.slack[k]).max(other.mid[k] + other.slack[k]);
            (0.5 * (low + high), 0.5 * (high - low))
        };
        let ranges = [0, 1, 2].map(range);
        Self { mid: ranges.map(|r| r.0), slack: ranges.map(|r| r.1), jump: self.jump.max(other.jump) }
    }

    /// The most that the second derivative along a step of (u, v) is.
    pub fn along(&self, step: DVec2) -> f64 {
        let squares = [step.x * step.x, 2.0 * step.x * step.y, step.y * step.y];
        let mid: f64 = (0..3).map(|k| self.mid[k] * squares[k]).sum();
        mid.abs() + (0..3).map(|k| self.slack[k] * squares[k].abs()).sum::<f64>()
    }
}

impl Surface {
    /// The net made ready; `None` for surfaces that are none.
    pub fn power_form(&self) -> Option<PowerForm> {
        match &self.parts().shape {
            Shape::Nurbs(net) if net.degree.0.max(net.degree.1) <= HIGHEST => {
                Some(PowerForm { surface: self.clone(), net: self.ready().take(|| Powers::new(net)) })
            }
            _ => None,
        }
    }
}

impl PowerForm {
    /// Derivatives along a unit vector over a box of the net's own parameters.
    fn derivatives(&self, area: (DVec2, DVec2), along: DVec3) -> DerivativesAlong {
        match &self.surface.parts().shape {
            Shape::Nurbs(net) => self.net.thirds.along(net, &|at: DVec2| self.own_jet(at.x, at.y), area, along),
            _ => DerivativesAlong::UNBOUNDED,
        }
    }

    /// The point alone.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        work::spend(1);
        let (u, v) = self.surface.wrapped(u, v);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        let ((i, s, _), (j, t, _)) = (self.net.stops.0.place(u), self.net.stops.1.place(v));
        let mut sum = DVec4::ZERO;
        for row in self.span(i, j).rchunks_exact(self.net.degree.0 + 1) {
            let value = row.iter().rev().fold(DVec4::ZERO, |value, c| value * s + *c);
            sum = sum * t + value;
        }
        sum.truncate() * (1.0 / sum.w)
    }

    /// Point, ∂/∂u and ∂/∂v.
    pub fn tangents(&self, u: f64, v: f64) -> [DVec3; 3] {
        work::spend(1);
        let (u, v) = self.surface.wrapped(u, v);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        let ((i, s, w), (j, t, h)) = (self.net.stops.0.place(u), self.net.stops.1.place(v));
        let mut sums = [DVec4::ZERO; 3];
        for row in self.span(i, j).rchunks_exact(self.net.degree.0 + 1) {
            let (mut value, mut slope) = (DVec4::ZERO, DVec4::ZERO);
            for c in row.iter().rev() {
                slope = slope * s + value;
                value = value * s + *c;
            }
            sums[2] = sums[2] * t + sums[0];
            sums[0] = sums[0] * t + value;
            sums[1] = sums[1] * t + slope;
        }
        let over = 1.0 / sums[0].w;
        let p = sums[0].truncate() * over;
        let du = (sums[1].truncate() - p * sums[1].w) * (over * w);
        let dv = (sums[2].truncate() - p * sums[2].w) * (over * h);
        let jet = self.surface.outer(Jet2 { p, du, dv, ..Jet2::default() });
        [jet.p, jet.du, jet.dv]
    }

    /// Point and all derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        let (u, v) = self.surface.wrapped(u, v);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        self.surface.outer(self.own_jet(u, v))
    }

    /// The same in the net's own parameters.
    fn own_jet(&self, u: f64, v: f64) -> Jet2 {
        work::spend(1);
        let ((i, s, w), (j, t, h)) = (self.net.stops.0.place(u), self.net.stops.1.place(v));
        // Value, ∂s, ∂t, ½ ∂ss, ∂st, ½ ∂tt.
        let mut sums = [DVec4::ZERO; 6];
        for row in self.span(i, j).rchunks_exact(self.net.degree.0 + 1) {
            let (mut value, mut slope, mut bend) = (DVec4::ZERO, DVec4::ZERO, DVec4::ZERO);
            for c in row.iter().rev() {
                bend = bend * s + slope;
                slope = slope * s + value;
                value = value * s + *c;
            }
            sums[5] = sums[5] * t + sums[2];
            sums[2] = sums[2] * t + sums[0];
            sums[0] = sums[0] * t + value;
            sums[4] = sums[4] * t + sums[1];
            sums[1] = sums[1] * t + slope;
            sums[3] = sums[3] * t + bend;
        }
        let scale = [1.0, w, h, 2.0 * w * w, w * h, 2.0 * h * h];
        for (sum, scale) in sums.iter_mut().zip(scale) {
            *sum *= scale;
        }
        quotient(&sums)
    }

    /// Second derivatives along a unit vector over a box of (u, v), and what jumps of first ones inside add; `None` over a seam.
    pub fn bends(&self, (low, high): (DVec2, DVec2), along: DVec3) -> Option<Bends> {
        work::spend(4);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        // Round the middle: a box over a seam leaves the parameters at one side and is not answered.
        let (u, v) = self.surface.wrapped(middle.x, middle.y);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        let (low, high) = (DVec2::new(u, v) - half, DVec2::new(u, v) + half);
        if low.min_element() < -EPSILON || high.max_element() > 1.0 + EPSILON {
            return None;
        }
        let mut whole: Option<Bends> = None;
        let mut from = low;
        for y in crossed(&self.net.rough.1, low.y, high.y).chain([high.y]) {
            from.x = low.x;
            for x in crossed(&self.net.rough.0, low.x, high.x).chain([high.x]) {
                let own = self.smooth((from, DVec2::new(x, y)), along);
                whole = Some(whole.map_or(own, |w| w.union(&own)));
                from.x = x;
            }
            from.y = y;
        }
        let jump = self.jump((low, high), along);
        whole.map(|whole| Bends { jump, ..whole })
    }

    /// How far jumps of first derivatives in a box of the net's own parameters move the surface along a unit vector away from
    /// what second derivatives say of it between any three places in the box. `docs/notes/bounds.md` has the formula.
    fn jump(&self, (low, high): (DVec2, DVec2), along: DVec3) -> f64 {
        let net = &self.net;
        let own = |lines: &[f64], (a, b): (f64, f64), at: &dyn Fn(f64) -> f64| {
            crossed(lines, a, b).map(|c| at(c) * (c - a) * (b - c) / (b - a)).sum::<f64>()
        };
        let (wide, high_up) = ((low.x, high.x), (low.y, high.y));
        own(&net.corners.0, wide, &|c| self.jump_along(true, c, high_up, along))
            + own(&net.corners.1, high_up, &|c| self.jump_along(false, c, wide, along))
    }

    /// The largest jump of the first derivative across a knot, along a unit vector, between two places of the knot's line.
    fn jump_along(&self, in_u: bool, c: f64, (low, high): (f64, f64), along: DVec3) -> f64 {
        let net = &self.net;
        let place = |x: f64, y: f64| if in_u { (x, y) } else { (y, x) };
        let slopes = |jet: &Jet2| if in_u { (jet.du, jet.duv) } else { (jet.dv, jet.duv) };
        let mut from = low;
        let mut most = 0.0_f64;
        // The jump is smooth between knots of the line alone.
        let rough = if in_u { &net.rough.1 } else { &net.rough.0 };
        for to in crossed(rough, low, high).chain([high]) {
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            let beside = |x: f64| {
                let (u, v) = place(x, middle);
                slopes(&self.surface.outer(self.own_jet(u, v)))
            };
            let (before, after) = (beside(c - BEFORE_KNOT), beside(c));
            let ends = [place(c - BEFORE_KNOT, from), place(c + BEFORE_KNOT, to)].map(|(u, v)| DVec2::new(u, v));
            let third = self.derivatives((ends[0], ends[1]), along).third[if in_u { 2 } else { 1 }];
            let jump = (after.0 - before.0).dot(along).abs() + half * (after.1 - before.1).dot(along).abs() + half * half * third;
            most = most.max(jump);
            from = to;
        }
        most
    }

    /// The same over a box of the net's own parameters in which second derivatives do not jump.
    fn smooth(&self, (low, high): (DVec2, DVec2), along: DVec3) -> Bends {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let DerivativesAlong { third, low, high } = self.derivatives((low, high), along);
        let jet = self.own_jet(middle.x, middle.y);
        let range = |k: usize, at: DVec3| {
            let (at, slack) = (at.dot(along), third[k] * half.x + third[k + 1] * half.y);
            let (low, high) = (low[k].max(at - slack), high[k].min(at + slack));
            // Middle and half width, to be turned as derivatives are.
            DVec3::new(0.5 * (low + high), 0.5 * (high - low), 0.0)
        };
        let turned = self.surface.outer(Jet2 { duu: range(0, jet.duu), duv: range(1, jet.duv), dvv: range(2, jet.dvv), ..Jet2::default() });
        let ranges = [turned.duu, turned.duv, turned.dvv];
        Bends { mid: ranges.map(|r| r.x), slack: ranges.map(|r| r.y.abs()), jump: 0.0 }
    }

    fn span(&self, i: usize, j: usize) -> &[DVec4] {
        let n = (self.net.degree.0 + 1) * (self.net.degree.1 + 1);
        &self.net.powers[(j * self.net.stops.0.by.len() + i) * n..][..n]
    }
}

/// Lines strictly inside an interval.
fn crossed(lines: &[f64], low: f64, high: f64) -> impl Iterator<Item = f64> + '_ {
    lines.iter().copied().filter(move |x| *x > low + EPSILON && *x < high - EPSILON)
}
