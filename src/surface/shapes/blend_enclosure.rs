//! Bounds of surfaces blended from curves.
//!
//! With E_i = F_i − Σ_j b_j P_ij and H_j = G_j − Σ_i a_i P_ij the derivatives are sums of products of a function of u and
//! one of v: ∂uu = Σ a_i″ E_i + Σ b_j G_j″, ∂uv = Σ a_i′ E_i′ + Σ b_j′ G_j′, ∂vv = Σ a_i F_i″ + Σ b_j″ H_j.

use std::sync::OnceLock;

use glam::DVec3;

use crate::base::range::{Interval, Interval3};
use crate::geometry::Jet;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::{Line, Shares, blended, taylor};
use crate::surface::shapes::blend::Blend;

/// What is known of a blended surface between two values of u: weights a and curves G_j; of v: b and F_i.
#[derive(Clone, Debug)]
pub struct BlendStrip {
    /// Terms that take part, and how many of their functions sum to 1 (they come first).
    terms: Vec<usize>,
    shares: usize,
    weights: Vec<([f64; 3], [Interval; 3])>,
    /// Third derivatives of the weights, where these are numbers.
    thirds: Option<Vec<f64>>,
    /// The curves along the strip, one per node of the other direction, made for the cells that ask for them.
    rails: Vec<OnceLock<Line>>,
    /// Where it begins and ends.
    ends: (f64, f64),
    /// Slopes across them: sums of all curves, made for the cells that ask for them.
    slopes: Vec<OnceLock<Line>>,
}

impl BlendStrip {
    fn shares_of(&self, half: f64) -> Shares<'_> {
        Shares { weights: &self.weights, shares: self.shares, thirds: self.thirds.as_deref(), half }
    }
}

impl Blend {
    /// Lines where the blending rule changes, ends included.
    pub fn rule_changes(&self, along_u: bool) -> Vec<f64> {
        let axis = if along_u { self.axes().0 } else { self.axes().1 };
        if axis.is_piecewise() { axis.nodes.clone() } else { Vec::new() }
    }

    /// What depends on u (`along_u`) or on v alone, between two values inside one cell.
    pub fn strip(&self, along_u: bool, (x0, x1): (f64, f64)) -> BlendStrip {
        let axes = self.axes();
        let (axis, rails, across) = if along_u { (axes.0, self.along_u(), axes.1) } else { (axes.1, self.along_v(), axes.0) };
        // Without curves along v nothing is blended across u.
        let idle = along_u && self.along_v().is_empty();
        let middle = axis.weights(0.5 * (x0 + x1), OneSided::After);
        let weights = if idle { Vec::new() } else { middle.values().iter().copied().zip(axis.ranges(x0, x1)).collect::<Vec<_>>() };
        let rails = vec![OnceLock::new(); rails.len()];
        let slopes = if rails.is_empty() { Vec::new() } else { vec![OnceLock::new(); across.slopes().len()] };
        let terms = if idle { Vec::new() } else { middle.iter().map(|(term, _)| term).collect() };
        let thirds = if idle { Vec::new() } else { axis.thirds(x0, x1) };
        let thirds = thirds.iter().all(|third| third.low == third.high).then(|| thirds.iter().map(|third| third.low).collect());
        BlendStrip { terms, shares: axis.shares(), weights, thirds, rails, ends: (x0, x1), slopes }
    }

    /// The curve or slope of a term along a strip (`along_u`: of u).
    fn term(&self, strip: &BlendStrip, along_u: bool, term: usize) -> Line {
        let rails = if along_u { self.along_u() } else { self.along_v() };
        let rail = |k: usize| *strip.rails[k].get_or_init(|| rails[k].line(strip.ends.0, strip.ends.1));
        let Some(slope) = term.checked_sub(rails.len()) else { return rail(term) };
        let across = if along_u { self.axes().1 } else { self.axes().0 };
        let felt = || across.slopes()[slope].iter().enumerate().filter(|(_, by)| **by != 0.0);
        if felt().next().is_none() {
            return Line::new(0.5 * (strip.ends.1 - strip.ends.0), Jet::default(), None, Interval3::default());
        }
        let sum = || Line::sum(felt().map(|(k, by)| (*by, rail(k))));
        *strip.slopes[slope].get_or_init(sum)
    }

    /// The sum of some terms of a strip.
    fn mixed(&self, strip: &BlendStrip, along_u: bool, terms: &[usize], m: &[f64]) -> Line {
        Line::sum(m.iter().copied().zip(terms.iter().map(|term| self.term(strip, along_u, *term))))
    }

    /// Σ m_k (F_k − Σ_j b_j P_kj) of some terms of one strip (`along_u`: G_k less Σ_i a_i P_ik).
    ///
    /// Corners are mixed before they meet ranges, and as the weights' derivatives sum to 0 their differences count alone.
    fn rest(&self, strip: &BlendStrip, along_u: bool, terms: &[usize], m: &[f64]) -> Line {
        let line = self.mixed(strip, along_u, terms, m);
        let corner = |own: &usize| -> DVec3 {
            let at = |k: usize| if along_u { self.corner(*own, k) } else { self.corner(k, *own) };
            terms.iter().zip(m).map(|(k, share)| at(*k) * *share).sum()
        };
        let corners: Vec<DVec3> = strip.terms.iter().map(corner).collect();
        let (mut mid, mut d1, mut d2) = (line.mid, line.d1, line.d2);
        for (q, (w, _)) in corners.iter().zip(&strip.weights) {
            mid.p -= *q * w[0];
            mid.d1 -= *q * w[1];
            mid.d2 -= *q * w[2];
        }
        if let Some(thirds) = &strip.thirds {
            let sum = |d: usize| -> DVec3 { corners.iter().zip(&strip.weights).map(|(q, (w, _))| *q * w[d]).sum() };
            let third: DVec3 = corners.iter().zip(thirds).map(|(q, w)| *q * *w).sum();
            d1 = d1 + -sum(1) - taylor(line.half, 1) * sum(2) - taylor(line.half, 2) * third;
            d2 = d2 + -sum(2) - taylor(line.half, 1) * third;
        } else {
            for (k, (q, (_, range))) in corners.iter().zip(&strip.weights).enumerate() {
                let step = if k < strip.shares { *q - corners[0] } else { *q };
                d1 = d1 - range[1] * step;
                d2 = d2 - range[2] * step;
            }
        }
        Line::new(line.half, mid, Some(d1), d2)
    }

    /// Bounds over the rectangle of a strip of u and one of v.
    pub fn enclosure(&self, u: &BlendStrip, v: &BlendStrip, half: (f64, f64)) -> Enclosure {
        let g = |m: &[f64]| self.mixed(u, true, &v.terms, m);
        let (a, b) = (u.shares_of(half.0), v.shares_of(half.1));
        if self.along_v().is_empty() {
            let second = [blended(b, 0, 2, &g), blended(b, 1, 1, &g), blended(b, 2, 0, &g)];
            let first = [blended(b, 0, 1, &g), blended(b, 1, 0, &g)];
            return Enclosure::new(self.middle(u, v), half, second, Some(first));
        }
        let f = |m: &[f64]| self.mixed(v, false, &u.terms, m);
        let e = |m: &[f64]| self.rest(v, false, &u.terms, m);
        let h = |m: &[f64]| self.rest(u, true, &v.terms, m);
        let second = [
            blended(a, 2, 0, &e) + blended(b, 0, 2, &g),
            blended(a, 1, 1, &e) + blended(b, 1, 1, &g),
            blended(a, 0, 2, &f) + blended(b, 2, 0, &h),
        ];
        let first = [blended(a, 1, 0, &e) + blended(b, 0, 1, &g), blended(a, 0, 1, &f) + blended(b, 1, 0, &h)];
        Enclosure::new(self.middle(u, v), half, second, Some(first))
    }

    /// The surface's derivatives in the middle of both strips.
    fn middle(&self, u: &BlendStrip, v: &BlendStrip) -> Jet2 {
        let mut jet = Jet2::default();
        let unit = |k: usize, n: usize| (0..n).map(|i| f64::from(u8::from(i == k))).collect::<Vec<f64>>();
        for (k, (w, _)) in u.weights.iter().enumerate().filter(|_| !self.along_v().is_empty()) {
            let e = self.rest(v, false, &u.terms, &unit(k, u.weights.len())).mid;
            jet.p += e.p * w[0];
            jet.du += e.p * w[1];
            jet.duu += e.p * w[2];
            jet.dv += e.d1 * w[0];
            jet.duv += e.d1 * w[1];
            jet.dvv += e.d2 * w[0];
        }
        for ((w, _), term) in v.weights.iter().zip(&v.terms) {
            let g = self.term(u, true, *term).mid;
            jet.p += g.p * w[0];
            jet.dv += g.p * w[1];
            jet.dvv += g.p * w[2];
            jet.du += g.d1 * w[0];
            jet.duv += g.d1 * w[1];
            jet.duu += g.d2 * w[0];
        }
        jet
    }
}
