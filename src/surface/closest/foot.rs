//! The foot of a point near a guess: steps in (u, v), halved until the distance falls.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::EPSILON;
use crate::surface::core::evaluator::Evaluator;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::rails::side::Side;
use crate::surface::rails::trim_curve::TrimCurve;

/// The step in the parameters whose image under two tangents is a vector's tangential part, to first order; `None` where
/// the tangents run together.
pub fn step(du: DVec3, dv: DVec3, d: DVec3) -> Option<DVec2> {
    let (e, f, g) = (du.length_squared(), du.dot(dv), dv.length_squared());
    let (a, b) = (du.dot(d), dv.dot(d));
    let det = e * g - f * f;
    let found = DVec2::new((g * a - f * b) / det, (e * b - f * a) / det);
    found.is_finite().then_some(found)
}

/// Where a foot is looked for: a surface held in a part of its parameters.
pub(crate) trait FootSearch {
    /// Steps before the nearest place found so far is taken.
    const STEPS: usize = 24;
    /// Tries of a step, each half as long as the one before.
    const TRIES: usize = 6;

    /// Point and derivatives.
    fn jet(&self, uv: DVec2) -> Jet2;
    /// The nearest place that is allowed.
    fn hold(&self, uv: DVec2) -> DVec2;
    /// The step in (u, v) whose image is nearest to `d`, from the surface to the point.
    fn step(&self, jet: &Jet2, _uv: DVec2, d: DVec3) -> Option<DVec2> {
        step(jet.du, jet.dv, d)
    }
    /// Whether the step is too short to change the distance.
    fn is_last(&self, _jet: &Jet2, _d: DVec3, _step: DVec2) -> bool {
        false
    }
    /// Whether the last step, between two places with their squared distances, changed nothing.
    fn settled(&self, (from, _): (DVec2, f64), (to, _): (DVec2, f64)) -> bool {
        (to - from).length() <= EPSILON
    }

    /// The foot of a point near a guess, with its distance.
    fn foot(&self, p: DVec3, guess: DVec2) -> (DVec2, f64) {
        let mut uv = self.hold(guess);
        let mut jet = self.jet(uv);
        let mut best = jet.p.distance_squared(p);
        for _ in 0..Self::STEPS {
            job::poll();
            let Some(full) = self.step(&jet, uv, p - jet.p) else { break };
            if self.is_last(&jet, p - jet.p, full) {
                return (self.hold(uv + full), best.sqrt());
            }
            let mut share = 1.0;
            let mut better = None;
            for _ in 0..Self::TRIES {
                let next = self.hold(uv + full * share);
                let there = self.jet(next);
                let distance = there.p.distance_squared(p);
                if distance < best {
                    better = Some((next, there, distance));
                    break;
                }
                share *= 0.5;
            }
            let Some((next, there, distance)) = better else { break };
            let still = self.settled((uv, best), (next, distance));
            (uv, jet, best) = (next, there, distance);
            if still {
                break;
            }
        }
        (uv, best.sqrt())
    }
}

/// A surface held inside ranges of u and v, with its second derivatives.
struct Within<'a> {
    evaluator: Evaluator<'a>,
    u: (f64, f64),
    v: (f64, f64),
}

impl FootSearch for Within<'_> {
    const STEPS: usize = 12;
    const TRIES: usize = 12;

    fn jet(&self, uv: DVec2) -> Jet2 {
        self.evaluator.jet(uv.x, uv.y)
    }

    fn hold(&self, uv: DVec2) -> DVec2 {
        let held = DVec2::new(uv.x.clamp(self.u.0, self.u.1), uv.y.clamp(self.v.0, self.v.1));
        let over = held.x + held.y - 1.0;
        let slant = self.evaluator.surface().domain() == Domain::Triangle && over > 0.0;
        if slant { (held - 0.5 * over).clamp(DVec2::ZERO, DVec2::ONE) } else { held }
    }

    /// The full Hessian where positive definite, else the Gauss-Newton part.
    fn step(&self, jet: &Jet2, _uv: DVec2, d: DVec3) -> Option<DVec2> {
        let r = -d;
        let (gu, gv) = (r.dot(jet.du), r.dot(jet.dv));
        let (a, b, c) = (jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.dv.dot(jet.dv));
        let (ha, hb, hc) = (a + r.dot(jet.duu), b + r.dot(jet.duv), c + r.dot(jet.dvv));
        let (a, b, c) = if ha > 0.0 && ha * hc - hb * hb > 0.5 * (a * c - b * b).max(0.0) { (ha, hb, hc) } else { (a, b, c) };
        let det = a * c - b * b;
        Some(if det > EPSILON * a * c {
            DVec2::new((b * gv - c * gu) / det, (b * gu - a * gv) / det)
        } else {
            DVec2::new(if a > 0.0 { -gu / a } else { 0.0 }, if c > 0.0 { -gv / c } else { 0.0 })
        })
    }

    /// Compares what the step takes off the squared distance with rounding.
    fn is_last(&self, jet: &Jet2, d: DVec3, step: DVec2) -> bool {
        (d.dot(jet.du) * step.x + d.dot(jet.dv) * step.y).abs() <= EPSILON * d.length_squared()
    }

    fn settled(&self, (_, before): (DVec2, f64), (_, after): (DVec2, f64)) -> bool {
        before - after <= EPSILON * before
    }
}

/// Distance of a point from a surface near (u, v), model units, with the place of the foot: Newton steps with second
/// derivatives where they help, held inside the ranges of u and v.
pub fn foot_within(evaluator: Evaluator, p: DVec3, guess: (f64, f64), u: (f64, f64), v: (f64, f64)) -> (f64, (f64, f64)) {
    let (uv, distance) = Within { evaluator, u, v }.foot(p, guess.into());
    (distance, uv.into())
}

/// Feet on a surface, held in the parts of (u, v) where it is.
struct WholeSurface<'a>(Evaluator<'a>);

impl FootSearch for WholeSurface<'_> {
    fn jet(&self, uv: DVec2) -> Jet2 {
        self.0.jet(uv.x, uv.y)
    }

    fn hold(&self, uv: DVec2) -> DVec2 {
        self.0.surface().hold(uv)
    }
}

/// The foot of a point near a guess, with its distance.
pub(crate) fn foot(evaluator: Evaluator, p: DVec3, guess: DVec2) -> (DVec2, f64) {
    WholeSurface(evaluator).foot(p, guess)
}

impl Surface {
    /// (u, v) of the point of a border's chain at a fraction of the chain; borders of trimmed surfaces and of planes.
    ///
    /// Beyond 0…1 where the surface closes and the border crosses its seam.
    pub fn border_place(&self, k: usize, fraction: f64) -> Option<(f64, f64)> {
        self.evaluator().border_place(k, fraction)
    }
}

impl Evaluator<'_> {
    /// See [`Surface::border_place`].
    pub fn border_place(self, k: usize, fraction: f64) -> Option<(f64, f64)> {
        let Side::Chain { chain, .. } = self.surface().side(k) else { return None };
        self.border_place_of(k, fraction, chain.point(fraction))
    }

    /// The same of a point of the border that is known.
    pub fn border_place_of(self, k: usize, fraction: f64, p: DVec3) -> Option<(f64, f64)> {
        let surface = self.surface();
        let trim_curve = surface.parts().trim.as_ref().and_then(|trim| trim.trim_curves.get(k));
        match trim_curve {
            _ if surface.is_flat() => surface.flat_uv(p),
            Some(TrimCurve::Line(a, b)) => {
                let t = surface.side_parameter(k, fraction);
                Some((a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t))
            }
            Some(TrimCurve::Pcurve(pcurve)) => {
                let uv = foot(self, p, pcurve.guess(fraction)).0;
                Some((uv.x, uv.y))
            }
            None => None,
        }
    }
}
