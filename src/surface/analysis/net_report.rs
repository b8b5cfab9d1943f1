//! What a surface through a net says of itself: how it keeps to its curves, and what they miss each other by.

use glam::DVec3;

use crate::base::fault::Fault;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::closest::nearest::Nearest;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::DeviationFault;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::blend::Blend;

/// Places along each curve at which it is compared with the surface.
const PLACES: usize = 128;

/// Where two curves of a net miss each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetGap {
    /// By how much, model units.
    pub by: f64,
    /// The curve along u.
    pub profile: Origin,
    /// The curve along v.
    pub guide: Origin,
    /// The middle between the two.
    pub at: DVec3,
}

/// One curve that a surface was made through.
#[derive(Clone, Debug, PartialEq)]
pub struct NetCurve {
    /// The curve; that of the surface where it was made for it.
    pub origin: Origin,
    /// Whether it is one of those given.
    pub given: bool,
    /// It runs along u, as guides of a sweep and sections of a skin do.
    pub along_u: bool,
    /// Its v, or u.
    pub at: f64,
    /// Smooth pieces.
    pub segments: usize,
    /// The scale of the section that was deformed to it that differs most from 1; none of curves that were not.
    pub scale: Option<f64>,
    /// How far the surface lies from it at most at its own parameters, model units.
    pub residual: f64,
}

impl Surface {
    fn blend(&self) -> Option<&Blend> {
        use SurfaceKind as K;
        let of_curves = matches!(self.kind(), K::Sweep | K::Gordon | K::Skin | K::Coons | K::Transfinite | K::Hermite);
        if let (Shape::Blend(blend), true) = (&self.parts().shape, of_curves) { Some(blend) } else { None }
    }

    /// Pairs of curves that miss each other, the widest first; none where it is not made through a net.
    pub fn net_gaps(&self) -> Vec<NetGap> {
        let Some(blend) = self.blend() else { return Vec::new() };
        let (u, v) = blend.axes();
        let mut all = Vec::new();
        for (g, &y) in blend.along_u().iter().zip(&v.nodes) {
            for (f, &x) in blend.along_v().iter().zip(&u.nodes) {
                if let (Rail::Chain { chain: profile, .. }, Rail::Chain { chain: guide, .. }) = (g, f) {
                    let (p, q) = (g.point(x), f.point(y));
                    all.push(NetGap { by: p.distance(q), profile: profile.origin(), guide: guide.origin(), at: p.midpoint(q) });
                }
            }
        }
        all.sort_by(|a, b| b.by.total_cmp(&a.by));
        all
    }

    /// N677 where curves miss each other by more than the model's tolerance.
    pub fn gap_note(&self, tolerance: &Tolerance) -> Option<Fault> {
        let all = self.net_gaps();
        let pairs = all.iter().filter(|gap| gap.by > tolerance.point).count();
        let widest = all.first().filter(|_| pairs > 0)?;
        let NetGap { by: gap, profile, guide, at } = *widest;
        Some(DeviationFault::Gap { surface: self.origin(), profile, guide, gap, at, pairs }.into())
    }

    /// The curves that it was made through, those along v (sections of a sweep) first; none where it was not made through curves.
    pub fn net_curves(&self) -> Vec<NetCurve> {
        let Some(blend) = self.blend() else { return Vec::new() };
        let (u, v) = blend.axes();
        let side = (OneSided::After, OneSided::After);
        let place = |k: usize| k as f64 / PLACES as f64;
        let row = |rail: &Rail, at: f64, along_u: bool| {
            let chain = rail.chain();
            let origin = chain.map_or(self.origin(), |chain| chain.origin());
            let jet = |x: f64| if along_u { blend.jet(x, at, side) } else { blend.jet(at, x, side) };
            let mut breaks = Vec::new();
            rail.breaks(&mut breaks);
            let inner = |x: &f64| *x > NUDGE && *x < 1.0 - NUDGE;
            let mut breaks: Vec<f64> = breaks.into_iter().filter(inner).collect();
            breaks.sort_by(f64::total_cmp);
            breaks.dedup_by(|b, a| *b - *a <= NUDGE);
            NetCurve {
                origin,
                given: chain.is_some() && self.chains().iter().any(|c| c.origin() == origin),
                along_u,
                at,
                segments: breaks.len() + 1,
                scale: None,
                residual: (0..=PLACES).map(|k| jet(place(k)).p.distance(rail.point(place(k)))).fold(0.0, f64::max),
            }
        };
        let closed = self.closed();
        let once = |rails: usize, closed: bool| if closed && rails > 1 { rails - 1 } else { rails };
        let (n, m) = (once(blend.along_v().len(), closed.0), once(blend.along_u().len(), closed.1));
        let mut all: Vec<NetCurve> = blend.along_v().iter().zip(&u.nodes).take(n).map(|(rail, x)| row(rail, *x, false)).collect();
        scales(blend, &mut all, m, closed.0, &|j| {
            blend.along_u()[j].chain().is_some_and(|c| self.chains().iter().any(|g| g.origin() == c.origin()))
        });
        all.extend(blend.along_u().iter().zip(&v.nodes).take(m).map(|(rail, y)| row(rail, *y, true)));
        if self.kind() == SurfaceKind::Skin {
            // Sections that a loose skin is not made through, beside those that it is.
            let kept: Vec<&Chain> = blend.along_u().iter().filter_map(Rail::chain).collect();
            let through = |chain: &Chain| kept.iter().any(|own| own.is(chain) || own.closest(chain.point(0.3)).2 <= NUDGE * chain.length());
            let loose = blend.along_u().iter().any(|rail| matches!(rail, Rail::Mixed(_))) || kept.len() < self.chains().len();
            let left = self.chains().iter().filter(|chain| loose && !through(chain));
            all.extend(left.map(|chain| self.beside(chain)));
            all.retain(|c| c.given);
            all.sort_by(|a, b| a.at.total_cmp(&b.at));
        }
        all
    }
}

impl Surface {
    /// A section that it passes at a distance, with the v of its middle.
    fn beside(&self, chain: &Chain) -> NetCurve {
        const MAX_SAMPLES: usize = 32;
        let nearest = Nearest::new(self);
        let feet: Vec<_> = (0..=MAX_SAMPLES).map(|k| nearest.at(chain.point(k as f64 / MAX_SAMPLES as f64))).collect();
        NetCurve {
            origin: chain.origin(),
            given: true,
            along_u: true,
            at: feet[MAX_SAMPLES / 2].uv.1,
            segments: chain_breaks(chain).len() + 1,
            scale: None,
            residual: feet.iter().map(|foot| foot.distance).fold(0.0, f64::max),
        }
    }
}

/// Scales of the stations between those given: of their meetings with the guides against those of the sections beside them.
fn scales(blend: &Blend, stations: &mut [NetCurve], guides: usize, round: bool, is_guide: &dyn Fn(usize) -> bool) {
    let anchors: Vec<usize> = (0..guides).filter(|j| is_guide(*j)).collect();
    if anchors.is_empty() || stations.iter().all(|s| s.given) {
        return;
    }
    let mean_radius = |i: usize| {
        let points: Vec<DVec3> = anchors.iter().map(|j| blend.corner(i, *j)).collect();
        let n = points.len() as f64;
        let middle = points.iter().sum::<DVec3>() / n;
        points.iter().map(|p| p.distance(middle)).sum::<f64>() / n
    };
    let given: Vec<usize> = (0..stations.len()).filter(|i| stations[*i].given).collect();
    for (i, station) in stations.iter_mut().enumerate().filter(|(_, s)| !s.given) {
        // Where the sections go round, the first one comes again after the last.
        let before = given.iter().rev().find(|k| **k < i).or(given.last().filter(|_| round));
        let after = given.iter().find(|k| **k > i).or(given.first().filter(|_| round));
        let scale = |k: &usize| if anchors.len() == 1 || mean_radius(*k) == 0.0 { 1.0 } else { mean_radius(i) / mean_radius(*k) };
        let off = |x: f64| if x > 1.0 { x } else { 1.0 / x };
        let both = before.into_iter().chain(after).map(scale);
        station.scale = both.max_by(|a, b| off(*a).total_cmp(&off(*b)));
    }
}
