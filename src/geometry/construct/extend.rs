//! Curves made longer at an end.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::{Fault, LengthRange, Result, ValueFault};
use crate::base::job;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{CUSP, NEAREST, NUDGE, PARALLEL, ROUNDING_SHARE};
use crate::geometry::construct::build::{composite, finite, line};
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::curves::offset::Offset;
use crate::geometry::data::extend_fault::{ExtendFault, NoEnd, Stop};
use crate::geometry::data::kind::Kind;
use crate::geometry::data::motion::Motion;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::nurbs::{Nurbs, weighted};
use crate::geometry::shapes::nurbs_edit::Bezier;

/// How a curve or surface goes on beyond its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Onward {
    /// Straight, along its tangent.
    Linear,
    /// As its last piece runs.
    Curvature,
    /// As its mirror image in the plane across its end.
    Reflect,
}

/// An end of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Where its parameter begins.
    Start,
    /// Where it ends.
    End,
}

impl End {
    /// The word of the language.
    pub fn word(self) -> &'static str {
        if self == Self::Start { "start" } else { "end" }
    }
}

/// Rounds of the search for a parameter.
const ROUNDS: usize = 200;
/// A stretch of the parameter is long enough where the curve over it is no longer than so many times the length wanted.
const ENOUGH: f64 = 4.0;

/// E306 unless a length to be added is above 0 and can be computed with.
pub fn check_length(by: f64, origin: Origin) -> Result<()> {
    finite(DVec3::splat(by), "by", origin)?;
    if by > 0.0 {
        return Ok(());
    }
    Err(ValueFault::LengthOutside { argument: "by", found: by, range: LengthRange::Positive }.into())
}

/// By how much the parameter of a B-spline goes on beyond its end until an arc length `by` is added; E417 and E418 as of [`extend`].
pub(crate) fn step_beyond(curve: &Curve, by: f64) -> Result<f64> {
    let longer = Longer { of: curve.origin(), end: End::End, by, how: Onward::Curvature };
    let (from, to) = longer.more(curve)?.domain();
    Ok(to - from)
}

/// The curve with an arc length `by`, model units, added at an end.
///
/// With [`Onward::Curvature`] lines, arcs, ellipses and helices stay what they are, exactly; a B-spline goes on as the polynomial or
/// rational function of its last span, so that all derivatives are continuous, and an offset follows its curve that does. Otherwise a line
/// or a mirror image is joined on; a line stays one line. Fails with E306 for a length that is not above 0, E417 for a closed curve and one
/// that has no direction at its end, E418 where it goes on for less than `by`.
pub fn extend(curve: &Curve, end: End, by: f64, how: Onward, origin: Origin) -> Result<Curve> {
    check_length(by, origin)?;
    let size = curve.bbox().diagonal();
    if curve.start().distance(curve.end()) <= ROUNDING_SHARE * size {
        return Err(ExtendFault::NoEnd { of: curve.origin(), side: end.word(), why: NoEnd::Closed, by }.into());
    }
    let longer = Longer { of: curve.origin(), end, by, how };
    let made = match end {
        End::Start => longer.run(&curve.reversed())?.reversed(),
        End::End => longer.run(curve)?,
    };
    let tip = if end == End::Start { made.start() } else { made.end() };
    finite(tip, "by", origin)?;
    Ok(made.built_through(None).with_origin(origin))
}

/// A request to make a curve longer by a length at its end.
struct Longer {
    of: Origin,
    end: End,
    by: f64,
    how: Onward,
}

impl Longer {
    fn run(&self, curve: &Curve) -> Result<Curve> {
        match self.how {
            Onward::Curvature => self.same(curve),
            Onward::Linear => self.straight(curve),
            Onward::Reflect => self.mirrored(curve),
        }
    }

    fn too_far(&self, most: f64, stop: Stop) -> Fault {
        ExtendFault::TooFar { of: self.of, by: self.by, most, stop }.into()
    }

    /// The unit tangent at the end; E417 where the curve stands still there.
    fn tangent(&self, curve: &Curve) -> Result<DVec3> {
        let knots = curve.knots();
        let (from, to) = (knots[knots.len().saturating_sub(2)], curve.domain().1);
        let jet = curve.jet_before(to);
        // Against the mean speed of the last piece: what is left of a zero is not a direction.
        let mean = (curve.length() - curve.length_at(from)) / (to - from);
        let fault = || ExtendFault::NoDirection { of: self.of, side: self.end.word(), at: jet.p, surface: false, by: self.by }.into();
        if jet.d1.length() > CUSP * mean { math::unit(jet.d1, 0.0).ok_or_else(fault) } else { Err(fault()) }
    }

    /// Goes on as its last piece does.
    fn same(&self, curve: &Curve) -> Result<Curve> {
        let origin = curve.origin();
        let new = |shape: Shape, kind: Kind| Ok(Curve::new(shape, kind, origin));
        match curve.shape() {
            Shape::Line(a, b) => new(Shape::Line(*a, *b + self.tangent(curve)? * self.by), Kind::Line),
            Shape::Arc(arc) => {
                let sweep = arc.sweep + self.turn(curve, arc)?;
                let kind = if arc.radius.is_some() { Kind::Arc } else { Kind::Ellipse };
                new(Shape::Arc(Box::new(EllipticArc { sweep: sweep.min(TAU), ..**arc })), kind)
            }
            Shape::Helix(helix) => {
                let mut helix = helix.clone();
                helix.sweep += self.by / helix.speed();
                new(Shape::Helix(helix), Kind::Helix)
            }
            Shape::Nurbs(net) if net.degree == 1 && net.polynomial => {
                new(Shape::Nurbs(Arc::new(self.last_leg(net, self.tangent(curve)?))), Kind::Polyline)
            }
            Shape::Nurbs(net) => {
                let more = self.more(curve)?;
                let Shape::Nurbs(more) = more.shape() else { return Ok(more) };
                new(Shape::Nurbs(Arc::new(Nurbs::joined(&[net.as_ref().clone(), more.as_ref().clone()]))), Kind::Nurbs)
            }
            Shape::Offset(offset) => {
                let more = self.more(curve)?;
                let (from, to) = (curve.domain().1, more.domain());
                let base = lengthened(&offset.base, from, to.1 - to.0).ok_or_else(|| self.too_far(0.0, Stop::Polynomial))?;
                new(Shape::Offset(Box::new(Offset { base, ..**offset })), Kind::Offset)
            }
            Shape::Composite(c) => {
                let (last, before) = c.pieces.split_last().ok_or_else(|| self.too_far(0.0, Stop::Polynomial))?;
                composite(&[before, &[self.same(last)?]].concat(), origin)
            }
        }
    }

    /// The angle by which an arc turns on; E418 where that is more than is left of a turn.
    fn turn(&self, curve: &Curve, arc: &EllipticArc) -> Result<f64> {
        let left = TAU - arc.sweep;
        if let Some(radius) = arc.radius {
            let turn = self.by / radius;
            return if turn <= left + TAU * PARALLEL { Ok(turn) } else { Err(self.too_far(left * radius, Stop::Turn)) };
        }
        let most = Curve::new(Shape::Arc(Box::new(arc.part(arc.sweep, TAU))), Kind::Ellipse, curve.origin());
        let most_length = most.length();
        if self.by > most_length * (1.0 + PARALLEL) {
            return Err(self.too_far(most_length, Stop::Turn));
        }
        Ok(most.param_at_length(self.by))
    }

    /// A polyline whose last leg is longer; its parameter goes on as it runs there.
    fn last_leg(&self, net: &Nurbs, tangent: DVec3) -> Nurbs {
        let mut net = net.clone();
        let n = net.poles.len();
        let (w, last) = (net.poles[n - 1].w, net.pole(n - 1));
        let leg = last.distance(net.pole(n - 2));
        let rate = (net.knots[n] - net.knots[n - 1]) / leg;
        net.poles[n - 1] = weighted(last + tangent * self.by, w);
        let to = net.knots[n] + self.by * rate;
        net.knots[n..].fill(to);
        net
    }

    /// The piece that is added to a B-spline or an offset, of the wanted length; its parameter begins where that of the curve ends.
    fn more(&self, curve: &Curve) -> Result<Curve> {
        self.tangent(curve)?;
        let (from, to) = curve.domain();
        let speed = curve.jet_before(to).d1.length();
        let mut step = (self.by / speed).min(to - from);
        let (mut low, mut high, mut most) = (0.0, f64::INFINITY, 0.0_f64);
        for _ in 0..ROUNDS {
            job::poll();
            let made = beyond(curve, step).map(|more| (more.length(), more));
            match made {
                Some((length, more)) if length >= self.by && length <= ENOUGH * self.by => {
                    let end = more.param_at_length(self.by);
                    if let Some(cusp) = more.lengths().cusps.iter().copied().filter(|cusp| *cusp < end).reduce(f64::min) {
                        return Err(self.too_far(more.length_at(cusp), Stop::Polynomial));
                    }
                    let more = more.part(more.domain().0, end);
                    let right = (more.length() - self.by).abs() <= NEAREST * self.by;
                    return if right { Ok(more) } else { Err(self.too_far(most, Stop::Polynomial)) };
                }
                Some((length, _)) if length < self.by => {
                    // The parameter doubles and the curve hardly grows: it comes to a point, as a conic does that goes on without end.
                    if high.is_infinite() && low > 0.0 && length - most <= NUDGE * length {
                        return Err(self.too_far(most, Stop::Polynomial));
                    }
                    low = step;
                    most = most.max(length);
                }
                _ => high = step,
            }
            let next = if high.is_finite() { 0.5 * (low + high) } else { 2.0 * low };
            if next == step || !next.is_finite() {
                break;
            }
            step = next;
        }
        Err(self.too_far(most, Stop::Polynomial))
    }

    /// Goes on straight.
    fn straight(&self, curve: &Curve) -> Result<Curve> {
        let origin = curve.origin();
        match curve.shape() {
            Shape::Line(..) => self.same(curve),
            Shape::Nurbs(net) if net.degree == 1 && net.polynomial => self.same(curve),
            Shape::Composite(c) if !c.pieces.is_empty() => {
                let last = c.pieces.len() - 1;
                composite(&[&c.pieces[..last], &[self.straight(&c.pieces[last])?]].concat(), origin)
            }
            _ => {
                let end = curve.end();
                composite(&[curve.clone(), line(end, end + self.tangent(curve)? * self.by, origin)?], origin)
            }
        }
    }

    /// Goes on as its mirror image in the plane across its end.
    fn mirrored(&self, curve: &Curve) -> Result<Curve> {
        let length = curve.length();
        if self.by > length * (1.0 + PARALLEL) {
            return Err(self.too_far(length, Stop::Image));
        }
        let tangent = self.tangent(curve)?;
        // The images of lines and circles are these again.
        let alike = match curve.shape() {
            Shape::Line(..) => true,
            Shape::Arc(arc) => arc.radius.is_some(),
            _ => false,
        };
        if alike {
            return self.same(curve);
        }
        let part = curve.part(curve.param_at_length(length - self.by), curve.domain().1);
        let image = part.moved(&Motion::mirror(curve.end(), tangent)).reversed();
        composite(&[curve.clone(), image], curve.origin())
    }
}

/// The continuation of a B-spline, an ellipse or an offset of one over `step` of the parameter; `None` where it does not reach so far.
fn beyond(curve: &Curve, step: f64) -> Option<Curve> {
    let shape = match curve.shape() {
        Shape::Nurbs(net) => {
            let parts = Bezier::with_weights(vec![net.onward(step)])?;
            let pieces: Vec<Nurbs> = parts.into_iter().flatten().map(|b| Nurbs::bezier(b.t0, b.t1, b.poles)).collect();
            Shape::Nurbs(Arc::new(Nurbs::joined(&pieces)))
        }
        Shape::Arc(arc) => (arc.sweep + step <= TAU).then(|| Shape::Arc(Box::new(arc.part(arc.sweep, arc.sweep + step))))?,
        Shape::Offset(offset) => Shape::Offset(Box::new(Offset { base: beyond(&offset.base, step)?, ..**offset })),
        _ => return None,
    };
    let made = Curve::new(shape, curve.kind(), curve.origin());
    made.end().is_finite().then_some(made)
}

/// The base of an offset over a longer domain.
fn lengthened(base: &Curve, from: f64, step: f64) -> Option<Curve> {
    let shape = match base.shape() {
        Shape::Arc(arc) => Shape::Arc(Box::new(EllipticArc { sweep: from + step, ..**arc })),
        Shape::Nurbs(net) => {
            let more = beyond(base, step)?;
            let Shape::Nurbs(more) = more.shape() else { return None };
            Shape::Nurbs(Arc::new(Nurbs::joined(&[net.as_ref().clone(), more.as_ref().clone()])))
        }
        _ => return None,
    };
    Some(Curve::new(shape, base.kind(), base.origin()))
}
