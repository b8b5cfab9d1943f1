//! A network curve as the surface sees it: a chain under a surface parameter, or a point where a side is a pole.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::digest::{StableHash, StableHasher};
use crate::base::range::Interval3;
use crate::base::tolerance::{EPSILON, NUDGE, Tolerance};
use crate::geometry::{Jet, Motion};
use crate::network::Chain;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;
use crate::surface::rails::mixed::Mixed;
use crate::surface::rails::reparam::Map;

/// F(u_i, ·) or F(·, v_j).
#[derive(Clone, Debug)]
pub enum Rail {
    /// A modeling curve; the map gives its fraction.
    Chain {
        /// The modeling curve.
        chain: Chain,
        /// Surface parameter ↦ fraction.
        map: Map,
        /// Kink lines of the surface and the fraction of the kink that made them.
        kinks: Vec<(f64, f64)>,
    },
    /// A degenerate curve.
    Point(DVec3),
    /// A fixed sum of others.
    Mixed(Box<Mixed>),
    /// A line of a formula at a constant u or v, with the formula's own parameter: points only.
    #[cfg(test)]
    Formula {
        /// F(u, v).
        f: fn(f64, f64) -> DVec3,
        /// The constant parameter.
        at: f64,
        /// The constant parameter is v.
        along_u: bool,
    },
}

impl StableHash for Rail {
    fn hash_into(&self, to: &mut StableHasher) {
        match self {
            Self::Chain { chain, map, kinks } => (0u8, (chain, map, kinks)).hash_into(to),
            Self::Point(p) => (1u8, *p).hash_into(to),
            Self::Mixed(sum) => (3u8, sum.as_ref()).hash_into(to),
            #[cfg(test)]
            Self::Formula { at, along_u, .. } => (2u8, (*at, *along_u)).hash_into(to),
        }
    }
}

impl Rail {
    /// A chain under a map.
    pub fn new(chain: Chain, map: Map) -> Self {
        Self::Chain { chain, map, kinks: Vec::new() }
    }

    /// Point and derivatives with respect to the surface parameter.
    pub fn jet(&self, x: f64, side: OneSided) -> Jet {
        match self {
            Self::Point(p) => Jet { p: *p, ..Jet::default() },
            Self::Mixed(sum) => sum.jet(x, side),
            #[cfg(test)]
            Self::Formula { .. } => Jet { p: self.point(x), ..Jet::default() },
            Self::Chain { chain, map, kinks } => {
                let [mut f, d1, d2] = map.at(x, side == OneSided::Before);
                // A kink line is the image of the kink up to rounding: hit the kink itself, or the side would be chance.
                if let Some((_, at)) = kinks.iter().find(|(line, _)| (*line - x).abs() <= EPSILON) {
                    f = *at;
                }
                let before = (side == OneSided::Before) != map.falls();
                let jet = if before { chain.jet_before(f) } else { chain.jet(f) };
                Jet { p: jet.p, d1: jet.d1 * d1, d2: jet.d2 * (d1 * d1) + jet.d1 * d2 }
            }
        }
    }

    /// Point.
    pub fn point(&self, x: f64) -> DVec3 {
        match self {
            Self::Point(p) => *p,
            Self::Mixed(sum) => sum.jet(x, OneSided::After).p,
            Self::Chain { chain, map, .. } => chain.point(map.value(x)),
            #[cfg(test)]
            Self::Formula { f, at, along_u } => {
                if *along_u {
                    f(x, *at)
                } else {
                    f(*at, x)
                }
            }
        }
    }

    /// Points at many parameters in ascending or descending order.
    pub fn points(&self, xs: &[f64]) -> Vec<DVec3> {
        if let Self::Mixed(sum) = self {
            return sum.points(xs);
        }
        let Self::Chain { chain, map, .. } = self else { return xs.iter().map(|&x| self.point(x)).collect() };
        let mut fractions: Vec<f64> = xs.iter().map(|&x| map.value(x)).collect();
        let mut points = vec![DVec3::ZERO; xs.len()];
        let falls = fractions.first() > fractions.last();
        if falls {
            fractions.reverse();
        }
        chain.points(&fractions, &mut points);
        if falls {
            points.reverse();
        }
        points
    }

    /// Arc length, model units; 0 for a pole.
    pub fn length(&self) -> f64 {
        match self {
            Self::Chain { chain, .. } => chain.length(),
            Self::Mixed(sum) => sum.length(),
            _ => 0.0,
        }
    }

    /// Whether it turns by less than a millionth of a radian between two parameters; never of a sum.
    pub fn is_straight(&self, x0: f64, x1: f64) -> bool {
        let Self::Chain { chain, map, .. } = self else { return matches!(self, Self::Point(_)) };
        let (a, b) = (map.value(x0), map.value(x1));
        let (low, high) = (a.min(b), a.max(b));
        // What is beyond a knot at an end is not asked.
        let inset = NUDGE * (high - low);
        let bounds = chain.enclosure(low + inset, high - inset);
        let turn = bounds.d2.reach() * (high - low) + bounds.jumps.length();
        turn <= NUDGE * chain.length()
    }

    /// The chain; none of a pole or a sum.
    pub fn chain(&self) -> Option<&Chain> {
        match self {
            Self::Chain { chain, .. } => Some(chain),
            _ => None,
        }
    }

    /// Surface parameters of the chain's kinks with their fractions, ends left out.
    pub fn kink_lines(&self, tolerance: &Tolerance) -> Vec<(f64, f64)> {
        if let Self::Mixed(sum) = self {
            return sum.kink_lines(tolerance);
        }
        let Self::Chain { chain, map, .. } = self else { return Vec::new() };
        let end = 1.0 - tolerance.parameter;
        chain.kinks(tolerance).iter().map(|&f| (map.inverse(f), f)).filter(|(x, _)| *x > tolerance.parameter && *x < end).collect()
    }

    /// Tells the rail which kink lines of the surface its own kinks became.
    pub fn set_kinks(&mut self, lines: Vec<(f64, f64)>) {
        match self {
            Self::Chain { kinks, .. } => *kinks = lines,
            Self::Mixed(sum) => sum.set_kinks(&lines),
            _ => {}
        }
    }

    /// Kink lines of the surface that are its own, with the fractions of the kinks.
    pub fn kinks(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Chain { kinks, .. } => kinks.clone(),
            Self::Mixed(sum) => sum.kinks(),
            _ => Vec::new(),
        }
    }

    /// A box that holds it.
    pub fn hull(&self) -> Box3 {
        match self {
            Self::Chain { chain, .. } => chain.runs().iter().fold(Box3::EMPTY, |all, run| all.union(run.curve.bbox())),
            Self::Point(p) => Box3::of([*p]),
            Self::Mixed(sum) => sum.hull(),
            #[cfg(test)]
            Self::Formula { .. } => Box3::EMPTY,
        }
    }

    /// Surface parameters where this rail is less than smooth: joints, knots, nodes of the map.
    pub fn breaks(&self, out: &mut Vec<f64>) {
        if let Self::Mixed(sum) = self {
            sum.breaks(out);
        }
        if let Self::Chain { chain, map, kinks } = self {
            out.extend_from_slice(map.breaks());
            out.extend(kinks.iter().map(|k| k.0));
            out.extend(chain_breaks(chain).iter().map(|&f| map.inverse(f)));
        }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        match self {
            Self::Point(p) => Self::Point(motion.point(*p)),
            Self::Mixed(sum) => Self::Mixed(Box::new(sum.moved(motion))),
            Self::Chain { chain, map, kinks } => Self::Chain { chain: chain.moved(motion), map: map.clone(), kinks: kinks.clone() },
            #[cfg(test)]
            Self::Formula { .. } => self.clone(),
        }
    }
}

impl Rail {
    /// Its bounds over `x0 < x1`.
    pub fn line(&self, x0: f64, x1: f64) -> Line {
        if let Self::Mixed(sum) = self {
            return sum.line(x0, x1);
        }
        let half = 0.5 * (x1 - x0);
        let mid = self.jet(0.5 * (x0 + x1), OneSided::After);
        let Self::Chain { chain, map, .. } = self else {
            return Line::new(half, mid, None, Interval3::default());
        };
        let ([value, m1, m2], jumps) = map.ranges(x0, x1);
        // It stands still.
        if value.low == value.high {
            return Line::new(half, mid, None, Interval3::default());
        }
        let enclosure = chain.enclosure(value.low.clamp(0.0, 1.0), value.high.clamp(0.0, 1.0));
        // A jump J of the slope moves values by at most J·half and slopes by J: a bend of 2J/half does as much.
        let jump = enclosure.jumps * m1.reach() + enclosure.d1.low.abs().max(enclosure.d1.high.abs()) * jumps;
        let mut d2 = enclosure.d2 * m1.square() + enclosure.d1 * m2;
        if jump != DVec3::ZERO {
            d2 = d2 + Interval3::around_zero(jump * (2.0 / half));
        }
        Line::new(half, mid, Some(enclosure.d1 * m1), d2)
    }
}
