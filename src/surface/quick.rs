//! A net made ready for many evaluations: one polynomial a span, and bounds of its third derivatives.
//!
//! The power form over 0…1 of a span costs a few dozen multiplications a point where the basis functions cost hundreds.
//! With |∂³| known over a box, second derivatives in it are those in its middle and a little more: a bound for the price
//! of one evaluation. `docs/notes/bounds.md` has the formulas.

use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

use glam::{DVec2, DVec3, DVec4};

use super::Jet2;
use super::core::Surface;
use super::net_enclosure::NetStrip;
use super::nurbs::{NurbsSurface, multiplicity, quotient};
use super::rail::OneSided;
use super::shape::Shape;
use super::thirds::Thirds;
use crate::base::tolerance::{BEFORE_KNOT, EPSILON};
use crate::base::work;
use crate::geometry::bounds::binomial;
use crate::geometry::nurbs::COMMON_DEGREE;

/// Highest degree in powers: about the middle of a span they lose a factor of 2 a degree, here 4e-12 of the size.
const HIGHEST: usize = 14;

/// A net, ready.
#[derive(Clone, Debug)]
pub struct PowerForm {
    surface: Surface,
    net: Arc<Powers>,
}

/// What is made of a net: shared by all that use it at the same time, and gone with the last of them, for it takes many times
/// the room of the net.
#[derive(Debug)]
struct Powers {
    degree: (usize, usize),
    stops: (Stops, Stops),
    /// Coefficients of each span (u fastest): those of s^i t^j with i fastest.
    powers: Vec<DVec4>,
    /// Found when they are asked for; of a net there always are some.
    thirds: OnceLock<Option<Thirds>>,
    /// Knots at which second derivatives may jump.
    rough: (Vec<f64>, Vec<f64>),
    /// Those of them at which first derivatives jump.
    corners: (Vec<f64>, Vec<f64>),
}

/// Knots without repetition, 0 and 1 among them, and one over the widths between them.
#[derive(Debug)]
struct Stops {
    at: Vec<f64>,
    by: Vec<f64>,
    /// Where in a span, from 0 to 1, its powers are taken.
    about: f64,
}

impl Stops {
    fn new(at: Vec<f64>, degree: usize) -> Self {
        Self { by: at.windows(2).map(|w| 1.0 / (w[1] - w[0])).collect(), at, about: about(degree) }
    }

    /// The span of a parameter, the place in it, from 0 to 1 less where its powers are taken, and one over its width.
    fn place(&self, x: f64) -> (usize, f64, f64) {
        let (stops, n) = (&self.at, self.by.len());
        // Even knots are met at once.
        let mut k = ((x * n as f64) as usize).min(n - 1);
        while k > 0 && x < stops[k] {
            k -= 1;
        }
        while k + 1 < n && x >= stops[k + 1] {
            k += 1;
        }
        (k, (x - stops[k]) * self.by[k] - self.about, self.by[k])
    }
}

/// The powers of a surface that is a net, while somebody holds them.
#[derive(Debug, Default)]
pub(super) struct Ready(Mutex<Weak<Powers>>);

impl Ready {
    fn take(&self, make: impl FnOnce() -> Powers) -> Arc<Powers> {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        held.upgrade().unwrap_or_else(|| {
            let made = Arc::new(make());
            *held = Arc::downgrade(&made);
            made
        })
    }
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

/// Evaluation by the net made ready, where it is.
impl Surface {
    /// The point.
    pub fn point_by(&self, quick: Option<&PowerForm>, u: f64, v: f64) -> DVec3 {
        quick.map_or_else(|| self.point(u, v), |quick| quick.point(u, v))
    }

    /// Point, ∂/∂u and ∂/∂v.
    pub fn tangents_by(&self, quick: Option<&PowerForm>, u: f64, v: f64) -> [DVec3; 3] {
        let plain = || {
            let jet = self.jet(u, v);
            [jet.p, jet.du, jet.dv]
        };
        quick.map_or_else(plain, |quick| quick.tangents(u, v))
    }

    /// Point and all derivatives.
    pub fn jet_by(&self, quick: Option<&PowerForm>, u: f64, v: f64) -> Jet2 {
        quick.map_or_else(|| self.jet(u, v), |quick| quick.jet(u, v))
    }
}

impl Powers {
    fn new(net: &NurbsSurface) -> Self {
        let (us, vs) = net.breaks();
        let stops = |inner: Vec<f64>| [vec![0.0], inner, vec![1.0]].concat();
        let stops = (stops(us), stops(vs));
        let (u_spans, v_spans) = (spans(net, true, &stops.0), spans(net, false, &stops.1));
        let coefficients = (coefficients(net.degree.0), coefficients(net.degree.1));
        let pieces = v_spans.iter().flat_map(|v| u_spans.iter().map(move |u| net.piece(u, v)));
        let powers = pieces.flat_map(|piece| powers(&piece, &coefficients));
        let repeated = |stops: &[f64], knots: &[f64], wanted: &dyn Fn(usize) -> bool| -> Vec<f64> {
            stops[1..stops.len() - 1].iter().copied().filter(|x| wanted(multiplicity(knots, *x))).collect()
        };
        let rough = |stops: &[f64], knots: &[f64], degree: usize| repeated(stops, knots, &|often| often + 1 >= degree);
        let rough = (rough(&stops.0, &net.knots.0, net.degree.0), rough(&stops.1, &net.knots.1, net.degree.1));
        let corners = |in_u: bool, rough: &[f64]| rough.iter().copied().filter(|x| net.has_corner(in_u, *x)).collect();
        Self {
            degree: net.degree,
            powers: powers.collect(),
            thirds: OnceLock::new(),
            corners: (corners(true, &rough.0), corners(false, &rough.1)),
            rough,
            stops: (Stops::new(stops.0, net.degree.0), Stops::new(stops.1, net.degree.1)),
        }
    }
}

impl PowerForm {
    /// Bounds of the third derivatives along a unit vector over a box of the net's own parameters: ∂uuu, ∂uuv, ∂uvv, ∂vvv.
    fn most_thirds(&self, area: (DVec2, DVec2), along: DVec3) -> [f64; 4] {
        let made = || {
            let Shape::Nurbs(net) = &self.surface.parts().shape else { return None };
            let normal = |u: f64, v: f64| {
                let jet = self.own_jet(u, v);
                jet.du.cross(jet.dv).normalize_or_zero()
            };
            Some(Thirds::new(net, (&self.net.stops.0.at, &self.net.stops.1.at), &normal))
        };
        // Made once for everyone, whoever comes first.
        let thirds = self.net.thirds.get_or_init(|| work::uncharged(made));
        thirds.as_ref().map_or([f64::INFINITY; 4], |thirds| thirds.most(area, along))
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
            let third = self.most_thirds((ends[0], ends[1]), along)[if in_u { 2 } else { 1 }];
            let jump = (after.0 - before.0).dot(along).abs() + half * (after.1 - before.1).dot(along).abs() + half * half * third;
            most = most.max(jump);
            from = to;
        }
        most
    }

    /// The same over a box of the net's own parameters in which second derivatives do not jump.
    fn smooth(&self, (low, high): (DVec2, DVec2), along: DVec3) -> Bends {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let most = self.most_thirds((low, high), along);
        let jet = self.surface.outer(self.own_jet(middle.x, middle.y));
        let slack = [0, 1, 2].map(|k| most[k] * half.x + most[k + 1] * half.y);
        Bends { mid: [jet.duu, jet.duv, jet.dvv].map(|d| d.dot(along)), slack, jump: 0.0 }
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

fn spans(net: &NurbsSurface, in_u: bool, stops: &[f64]) -> Vec<NetStrip> {
    stops.windows(2).map(|w| net.strip(in_u, (w[0], w[1]))).collect()
}

/// Coefficients of powers from Bézier points, in both directions.
fn powers(net: &[Vec<DVec4>], (in_u, in_v): &(Vec<Vec<f64>>, Vec<Vec<f64>>)) -> Vec<DVec4> {
    let one = |points: &[DVec4], coefficients: &[Vec<f64>]| -> Vec<DVec4> {
        coefficients.iter().map(|row| points.iter().zip(row).map(|(point, x)| *point * *x).sum()).collect()
    };
    let rows: Vec<Vec<DVec4>> = net.iter().map(|row| one(row, in_u)).collect();
    let n = rows[0].len();
    let columns: Vec<Vec<DVec4>> = (0..n).map(|i| one(&rows.iter().map(|row| row[i]).collect::<Vec<_>>(), in_v)).collect();
    (0..rows.len()).flat_map(|j| columns.iter().map(move |c| c[j])).collect()
}

/// For each power, ascending, what it has of each Bézier point; points beyond the last entry have no share.
fn coefficients(degree: usize) -> Vec<Vec<f64>> {
    let from_start = |k: usize, i: usize| {
        let sign = if (k - i).is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * binomial(degree, k) * binomial(k, i)
    };
    let row = |k: usize| -> Vec<f64> {
        if about(degree) == 0.0 {
            (0..=k).map(|i| from_start(k, i)).collect()
        } else {
            (0..=degree).map(|i| from_middle(degree, i, k)).collect()
        }
    };
    (0..=degree).map(row).collect()
}

/// Where in a span, from 0 to 1, the powers of a degree are taken: at its start while that loses nothing to speak of, else in its middle.
fn about(degree: usize) -> f64 {
    if degree <= COMMON_DEGREE { 0.0 } else { 0.5 }
}

/// The coefficient of x^k in the i-th Bernstein polynomial of degree p at ½ + x.
fn from_middle(p: usize, i: usize, k: usize) -> f64 {
    let term = |m: usize| {
        let sign = if (k - m).is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * binomial(i, m) * binomial(p - i, k - m)
    };
    let first = k.saturating_sub(p - i);
    let sum: f64 = (first..=k.min(i)).map(term).sum();
    (0..p - k).fold(binomial(p, i) * sum, |x, _| 0.5 * x)
}
