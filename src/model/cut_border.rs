//! The borders of a trimmed surface as ways in (u, v).

use glam::DVec2;

use crate::base::quadrature::gauss_legendre;
use crate::network::Chain;
use crate::surface::{Side, Surface, chain_breaks};

/// Points of the rule for areas.
const ORDER: usize = 10;

/// A border: the chain that carries it, or a line in (u, v).
enum BorderLine {
    Chain(Chain, f64, f64),
    Line(DVec2, DVec2),
    None,
}

/// All borders of a trimmed surface.
pub(super) struct Border<'a> {
    surface: &'a Surface,
    ways: Vec<BorderLine>,
    rule: Vec<(f64, f64)>,
}

impl<'a> Border<'a> {
    /// The borders of a trimmed surface.
    pub fn new(surface: &'a Surface) -> Self {
        let way = |k: usize| match (surface.side(k), surface.border_line(k)) {
            (_, Some((a, b))) => BorderLine::Line(a.into(), b.into()),
            (Side::Chain { chain, from, to }, None) => BorderLine::Chain(chain, from, to),
            _ => BorderLine::None,
        };
        Self { surface, ways: (0..surface.n_sides()).map(way).collect(), rule: gauss_legendre(ORDER) }
    }

    /// Loop by loop the borders in their order, in steps between places where they are less than smooth: shares 0…1 of each.
    pub fn loops(&self) -> Vec<Vec<(usize, (f64, f64))>> {
        let mut next = 0;
        let steps = |k: usize| -> Vec<(usize, (f64, f64))> {
            let mut stops = vec![0.0, 1.0];
            if let BorderLine::Chain(chain, from, to) = &self.ways[k] {
                stops.extend(chain_breaks(chain).into_iter().map(|f| (f - from) / (to - from)));
            }
            stops.retain(|t| (0.0..=1.0).contains(t));
            stops.sort_by(f64::total_cmp);
            stops.dedup();
            stops.windows(2).map(|w| (k, (w[0], w[1]))).collect()
        };
        let mut one = |n: usize| {
            let range = next..next + n;
            next += n;
            range.filter(|k| !matches!(self.ways[*k], BorderLine::None)).flat_map(steps).collect()
        };
        self.surface.loops().into_iter().map(&mut one).collect()
    }

    /// (u, v) at a share of a border.
    pub fn at(&self, k: usize, t: f64) -> DVec2 {
        match &self.ways[k] {
            BorderLine::Line(a, b) => a.lerp(*b, t),
            BorderLine::Chain(_, from, to) => self.surface.border_place(k, from + (to - from) * t).unwrap_or_default().into(),
            BorderLine::None => DVec2::ZERO,
        }
    }

    /// The same with its derivative by the share.
    pub fn place(&self, k: usize, t: f64) -> (DVec2, DVec2) {
        let at = self.at(k, t);
        let way = match &self.ways[k] {
            BorderLine::Line(a, b) => *b - *a,
            BorderLine::Chain(chain, from, to) => {
                let (jet, d) = (self.surface.jet(at.x, at.y), chain.jet(from + (to - from) * t).d1 * (to - from));
                let (e, g, m) = (jet.du.length_squared(), jet.dv.length_squared(), jet.du.dot(jet.dv));
                let (x, y) = (jet.du.dot(d), jet.dv.dot(d));
                DVec2::new(g * x - m * y, e * y - m * x) / (e * g - m * m)
            }
            BorderLine::None => DVec2::ZERO,
        };
        (at, if way.is_finite() { way } else { DVec2::ZERO })
    }

    /// The area between a part of a border and a place, counter-clockwise positive.
    pub fn moment(&self, k: usize, (from, to): (f64, f64), about: DVec2) -> f64 {
        let half = 0.5 * (to - from);
        let one = |(x, w): &(f64, f64)| {
            let (at, way) = self.place(k, 0.5 * (from + to) + half * x);
            0.5 * half * w * (at - about).perp_dot(way)
        };
        self.rule.iter().map(one).sum()
    }
}
