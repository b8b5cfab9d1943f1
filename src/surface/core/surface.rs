//! One surface of any kind: what every caller above this floor works with.

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::digest::{StableHash, StableHasher};
use crate::base::origin::Origin;
use crate::base::tolerance::SLIVER;
use crate::base::work::Once;
use crate::geometry::Motion;
use crate::network::Chain;
use crate::surface::core::evened::Evened;
use crate::surface::core::shape::Shape;
use crate::surface::core::trim::Trim;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::powers::Ready;

/// A surface over its domain. Cheap to clone.
///
/// Where derivatives jump (kink lines), [`Surface::jet`] takes those of the piece that follows in u and v;
/// [`Surface::jet_one_sided`] chooses.
#[derive(Clone, Debug)]
pub struct Surface(Arc<Whole>);

/// A surface with what is made of it for many evaluations.
#[derive(Debug)]
struct Whole {
    parts: Parts,
    ready: Ready,
    area: Once<(f64, f64)>,
    /// In parameters in which it runs evenly, where it does not in its own.
    evened: OnceLock<Option<Box<Evened>>>,
    /// The surfaces that it is a part of.
    part_of: Vec<Surface>,
}

/// Everything a surface is made of; what builders fill in.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    pub origin: Origin,
    pub kind: SurfaceKind,
    pub flow: String,
    pub domain: Domain,
    pub closed: (bool, bool),
    pub shape: Shape,
    pub borders: Vec<Border>,
    pub kinks: (Vec<f64>, Vec<f64>),
    pub chains: Vec<Chain>,
    pub generated: Vec<Chain>,
    /// Loops and trim curves of a trimmed surface.
    pub trim: Option<Arc<Trim>>,
    /// The shape is read with v backwards (a triangle: with u and v exchanged).
    pub flipped: bool,
}

crate::content!(Parts { kind, flow, domain, closed, shape, borders, kinks, chains, generated, trim, flipped } but { origin });

impl StableHash for Surface {
    fn hash_into(&self, to: &mut StableHasher) {
        self.0.parts.hash_into(to);
    }
}

impl Surface {
    pub(crate) fn new(parts: Parts) -> Self {
        Self(Arc::new(Whole { parts, ready: Ready::default(), area: Once::default(), evened: OnceLock::new(), part_of: Vec::new() }))
    }

    /// The surfaces that this one was cut from, and those that they were cut from; none of what was moved since.
    pub fn part_of(&self) -> &[Self] {
        &self.0.part_of
    }

    /// The same as a part cut from some surfaces.
    pub fn cut_from(&self, wholes: &[Self]) -> Self {
        let before = wholes.iter().flat_map(|w| w.part_of().iter().cloned());
        // What is kept holds no list of its own: a row of cuts makes no row of surfaces within surfaces.
        let own = wholes.iter().map(|w| if w.part_of().is_empty() { w.clone() } else { Self::new(w.0.parts.clone()) });
        let part_of = own.chain(before).chain(self.part_of().iter().cloned()).collect();
        Self(Arc::new(Whole {
            parts: self.0.parts.clone(),
            ready: Ready::default(),
            area: Once::default(),
            evened: OnceLock::new(),
            part_of,
        }))
    }

    /// Other parts of the same surface: it stays a part of what it is a part of.
    pub(crate) fn remade(&self, parts: Parts) -> Self {
        Self(Arc::new(Whole {
            parts,
            ready: Ready::default(),
            area: Once::default(),
            evened: OnceLock::new(),
            part_of: self.0.part_of.clone(),
        }))
    }

    /// Its area with an estimate of the error, square model units, as `measure` finds them: once for all copies of it.
    pub fn area_once(&self, measure: impl FnOnce() -> (f64, f64)) -> (f64, f64) {
        self.0.area.get(measure)
    }

    /// The same surface in parameters in which it runs evenly, where it is a trimmed net that runs very unevenly in its own.
    pub fn evened(&self) -> Option<&Evened> {
        self.0.evened.get_or_init(|| Evened::of(self).map(Box::new)).as_deref()
    }

    pub(crate) fn ready(&self) -> &Ready {
        &self.0.ready
    }

    pub(crate) fn parts(&self) -> &Parts {
        &self.0.parts
    }

    /// Whether two values are one and the same: made once and copied, not only alike.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// The expression that made it.
    pub fn origin(&self) -> Origin {
        self.0.parts.origin
    }

    /// The same made by another expression.
    pub fn with_origin(&self, origin: Origin) -> Self {
        self.remade(Parts { origin, ..self.0.parts.clone() })
    }

    /// The word it was made with.
    pub fn kind(&self) -> SurfaceKind {
        self.0.parts.kind
    }

    /// Its flow in words, for example "quadrilateral"; empty where there is none.
    pub fn flow(&self) -> String {
        self.0.parts.flow.clone()
    }

    /// How neighbouring curves of a Coons surface are blended, `linear` or `cubic`; none for other surfaces.
    pub fn blending(&self) -> Option<&'static str> {
        match (&self.parts().shape, self.kind()) {
            (Shape::Blend(blend), SurfaceKind::Coons) => blend.axes().0.rule.name(),
            _ => None,
        }
    }

    /// The curves that a flow put along u (ascending v) and along v (ascending u), `None` for a pole, in the parameters it
    /// found; empty for surfaces that no curves were sorted for.
    pub fn families(&self) -> (Vec<Option<&Chain>>, Vec<Option<&Chain>>) {
        match &self.0.parts.shape {
            Shape::Blend(blend) => {
                fn given(rails: &[Rail]) -> Vec<Option<&Chain>> {
                    rails.iter().filter(|rail| !matches!(rail, Rail::Mixed(_))).map(Rail::chain).collect()
                }
                (given(blend.along_u()), given(blend.along_v()))
            }
            Shape::Trilateral(sides) => sides.families(),
            _ => (Vec::new(), Vec::new()),
        }
    }

    /// Square, triangle for a uniform trilateral, or a plane without a map.
    pub fn domain(&self) -> Domain {
        self.0.parts.domain
    }

    /// Whether u (first) and v (second) are periodic.
    pub fn closed(&self) -> (bool, bool) {
        self.0.parts.closed
    }

    /// Point and derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        self.jet_one_sided(u, v, (OneSided::After, OneSided::After))
    }

    /// Point and derivatives of the smooth piece on the given side in u (first) and v (second): on the border of a
    /// patch the side where the patch lies.
    pub fn jet_one_sided(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> Jet2 {
        let (u, v) = self.wrapped(u, v);
        let (u, v, side) = self.inner(u, v, side);
        self.outer(self.0.parts.shape.jet(u, v, side))
    }

    /// Into 0…1 where a surface closes: borders may run over the seam. What rounding put beside a seam stays on its side.
    pub(crate) fn wrapped(&self, u: f64, v: f64) -> (f64, f64) {
        let wrap = |x: f64, closed: bool| if closed && !(-SLIVER..=1.0 + SLIVER).contains(&x) { x - x.floor() } else { x };
        (wrap(u, self.0.parts.closed.0), wrap(v, self.0.parts.closed.1))
    }

    /// From this surface's parameters to the shape's.
    pub(crate) fn inner(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> (f64, f64, (OneSided, OneSided)) {
        match (self.0.parts.flipped, self.ground()) {
            (false, _) => (u, v, side),
            (true, Domain::Triangle) => (v, u, (side.1, side.0)),
            (true, _) => (u, 1.0 - v, (side.0, side.1.turned())),
        }
    }

    /// From the shape's derivatives to this surface's.
    pub(crate) fn outer(&self, jet: Jet2) -> Jet2 {
        match (self.0.parts.flipped, self.ground()) {
            (false, _) => jet,
            (true, Domain::Triangle) => Jet2 { du: jet.dv, dv: jet.du, duu: jet.dvv, dvv: jet.duu, ..jet },
            (true, _) => Jet2 { dv: -jet.dv, duv: -jet.duv, ..jet },
        }
    }

    /// Point.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        self.jet(u, v).p
    }

    /// Points of the tensor grid `us × vs`, row by row (u fastest), curves evaluated once per row.
    ///
    /// `out` holds `us.len() * vs.len()` points.
    pub fn grid(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        match (self.0.parts.flipped, self.ground()) {
            (false, _) => self.0.parts.shape.grid(us, vs, out),
            (true, Domain::Triangle) => {
                for (row, &v) in out.chunks_exact_mut(us.len().max(1)).zip(vs) {
                    for (p, &u) in row.iter_mut().zip(us) {
                        *p = self.point(u, v);
                    }
                }
            }
            (true, _) => {
                let turned: Vec<f64> = vs.iter().map(|v| 1.0 - v).collect();
                self.0.parts.shape.grid(us, &turned, out);
            }
        }
    }

    /// Jets of the tensor grid `us × vs`, each parameter with its side, u fastest; curves evaluated once per row.
    pub fn jets(&self, us: &[(f64, OneSided)], vs: &[(f64, OneSided)]) -> Vec<Jet2> {
        let mut out = Vec::with_capacity(us.len() * vs.len());
        if self.0.parts.flipped && self.ground() == Domain::Triangle {
            for &(v, side_v) in vs {
                out.extend(us.iter().map(|&(u, side_u)| self.jet_one_sided(u, v, (side_u, side_v))));
            }
        } else if self.0.parts.flipped {
            let turned: Vec<(f64, OneSided)> = vs.iter().map(|(v, side)| (1.0 - v, side.turned())).collect();
            self.0.parts.shape.jets(us, &turned, &mut out);
            out.iter_mut().for_each(|jet| *jet = self.outer(*jet));
        } else {
            self.0.parts.shape.jets(us, vs, &mut out);
        }
        out
    }

    /// How many sides: 4, 3 for a triangle, any number for a plane without a map, 0 when unbounded.
    pub fn n_sides(&self) -> usize {
        self.0.parts.borders.len()
    }

    /// Sides in the order v = 0, u = 1, v = 1, u = 0 (a triangle: v = 0, the slant from (1, 0) to (0, 1), u = 0;
    /// a plane without a map: counter-clockwise, each in the loop's direction).
    ///
    /// Each runs with ascending u or v (the slant: ascending v).
    pub fn side(&self, k: usize) -> Side {
        self.0.parts.borders.get(k).map_or(Side::Free, |border| border.side.clone())
    }

    /// Side parameter (u or v) at a fraction of the chain that lies along side `k`.
    pub fn side_parameter(&self, k: usize, fraction: f64) -> f64 {
        let Some(border) = self.0.parts.borders.get(k) else { return fraction };
        let Side::Chain { from, to, .. } = &border.side else { return fraction };
        match &border.map {
            Some(map) if border.turned => 1.0 - map.inverse(fraction),
            Some(map) => map.inverse(fraction),
            None => ((fraction - from) / (to - from)).clamp(0.0, 1.0),
        }
    }

    /// Inverse of [`Surface::side_parameter`]: fraction of the chain at a side parameter.
    pub fn side_fraction(&self, k: usize, parameter: f64) -> f64 {
        let Some(border) = self.0.parts.borders.get(k) else { return parameter };
        let Side::Chain { from, to, .. } = &border.side else { return parameter };
        match &border.map {
            Some(map) => map.value(if border.turned { 1.0 - parameter } else { parameter }),
            None if parameter == 1.0 => *to,
            None => from + (to - from) * parameter,
        }
    }

    /// (u, v) of the foot of a point on a plane; `None` on any other surface.
    pub fn flat_uv(&self, p: DVec3) -> Option<(f64, f64)> {
        let Shape::Plane(frame) = &self.0.parts.shape else { return None };
        let (u, v) = frame.uv(p);
        Some(if self.0.parts.flipped { (u, 1.0 - v) } else { (u, v) })
    }

    /// The modeling curves it stands on.
    pub fn chains(&self) -> &[Chain] {
        &self.0.parts.chains
    }

    /// Curves the surface makes itself: copies of a swept profile and the paths of its ends. They join the network as
    /// links and nodes, not as modeling curves [Koh & Park 1990, §4.2].
    pub fn generated(&self) -> &[Chain] {
        &self.0.parts.generated
    }

    /// The same surface with its other side up: v runs backwards (a triangle: u and v exchanged), so the normal turns.
    pub fn flipped(&self) -> Self {
        let parts = &self.0.parts;
        let old = &parts.borders;
        let borders = match parts.domain {
            Domain::Square => vec![old[2].clone(), old[1].turned(), old[0].clone(), old[3].turned()],
            Domain::Triangle => vec![old[2].clone(), old[1].turned(), old[0].clone()],
            Domain::Loop | Domain::Unbounded => {
                let mut first = 0;
                let each = |n: usize| {
                    first += n;
                    old[first - n..first].iter().rev().map(Border::turned).collect::<Vec<_>>()
                };
                self.loops().into_iter().flat_map(each).collect()
            }
        };
        let trim = parts.trim.as_ref().map(|trim| Arc::new(trim.flipped()));
        let (us, vs) = &parts.kinks;
        let kinks = if parts.domain == Domain::Triangle {
            (vs.clone(), us.clone())
        } else {
            (us.clone(), vs.iter().rev().map(|v| 1.0 - v).collect())
        };
        self.remade(Parts { borders, kinks, trim, flipped: !parts.flipped, ..parts.clone() })
    }

    /// The same points without curves that others may share: sides are free, seams or poles, as those of a net.
    pub fn without_curves(&self) -> Self {
        let parts = self.0.parts.clone();
        let side = |(k, border): (usize, &Border)| match border.side {
            Side::Chain { .. } if [parts.closed.1, parts.closed.0][k % 2] => Border::straight(Side::Seam),
            Side::Chain { .. } => Border::straight(Side::Free),
            _ => border.clone(),
        };
        let borders = parts.borders.iter().enumerate().map(side).collect();
        self.remade(Parts { borders, chains: Vec::new(), generated: Vec::new(), ..parts })
    }

    /// Carried by a motion, exactly.
    pub fn moved(&self, motion: &Motion) -> Self {
        let parts = &self.0.parts;
        Self::new(Parts {
            shape: parts.shape.moved(motion),
            borders: parts.borders.iter().map(|b| b.moved(motion)).collect(),
            chains: parts.chains.iter().map(|c| c.moved(motion)).collect(),
            generated: parts.generated.iter().map(|c| c.moved(motion)).collect(),
            ..parts.clone()
        })
    }

    /// A box that holds the surface, of control points and curve boxes: larger than the exact one.
    pub fn hull(&self) -> Box3 {
        self.0.parts.shape.hull()
    }
}
