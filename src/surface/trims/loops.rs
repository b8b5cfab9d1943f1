//! How the loops of one face lie to each other: apart, or touching in one point.
//!
//! Curves of two loops are intersected where their boxes meet, so that a face with many holes is checked in about the time it
//! takes to sort the boxes; which loop lies in which is decided by one place of each, exactly.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, meet};
use crate::surface::closest::inside::within;
use crate::surface::core::surface::Surface;
use crate::surface::core::trim::reach;
use crate::surface::faults::LoopFault;
use crate::surface::rails::side::Side;
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::trims::cutters::of_loop;
use crate::surface::trims::trim_loop::TrimLoop;

/// Meetings nearer to each other than this many tolerances are one.
const REACH: f64 = 4.0;

/// A loop of a face with its curves in space.
pub(crate) struct LoopRing {
    /// The curve, or the surface, that is named for it.
    pub of: Origin,
    /// Its place in the list of holes; `None` for a loop that the surface had before.
    pub hole: Option<usize>,
    /// It bounds the face from outside.
    pub outer: bool,
    /// Its curves, those along seams and poles left out.
    pub chains: Vec<Chain>,
    /// The seams of a closed surface in it: the face goes on across them.
    seams: Vec<Chain>,
}

impl LoopRing {
    /// A loop given by curves.
    pub fn of_chains(chains: &[Chain], hole: Option<usize>, otherwise: Origin) -> Self {
        let of = chains.first().map_or(otherwise, Chain::origin);
        Self { of, hole, outer: hole.is_none(), chains: chains.to_vec(), seams: Vec::new() }
    }

    /// A loop that a surface has.
    pub fn of_trim_loop(base: &Surface, trim_loop: &TrimLoop, outer: bool, tolerance: &Tolerance) -> Result<Self> {
        let (mut chains, mut seams) = (Vec::new(), Vec::new());
        for curve in of_loop(base, trim_loop, tolerance)? {
            if let Some(chain) = curve.chain {
                if curve.seam { seams.push(chain) } else { chains.push(chain) }
            }
        }
        let of = if outer { base.origin() } else { chains.first().map_or(base.origin(), Chain::origin) };
        Ok(Self { of, hole: None, outer, chains, seams })
    }

    fn length(&self) -> f64 {
        self.chains.iter().map(Chain::length).sum()
    }
}

/// The number of a chain of a loop, and a fraction of it.
pub(crate) type ChainCut = (usize, f64);

/// Where two loops meet.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoopTouch {
    /// Points, those of one place once; ends of common runs too.
    pub places: Vec<DVec3>,
    /// Ends of the first run that both have.
    pub run: Option<(DVec3, DVec3)>,
    /// Length of all such runs.
    pub shared: f64,
    /// How far they are from each other at the first place.
    pub apart: f64,
    /// Where the chains of the first and the second loop are cut.
    pub cuts: (Vec<ChainCut>, Vec<ChainCut>),
}

impl LoopTouch {
    /// Whether it is more than a contact in one point.
    pub fn is_crossing(&self) -> bool {
        self.run.is_some() || self.places.len() > 1
    }

    fn add(&mut self, p: DVec3, apart: f64, tolerance: &Tolerance) {
        if self.places.is_empty() {
            self.apart = apart;
        }
        if self.places.iter().all(|q| q.distance(p) > REACH * tolerance.point) {
            self.places.push(p);
        }
    }
}

/// One curve of a loop with its box.
struct Fence<'a> {
    ring: usize,
    number: usize,
    chain: &'a Chain,
    reach: Box3,
}

/// Meetings of loops, by the numbers of two of them in ascending order; loops before `new` are not compared with each other.
pub(crate) fn touches(rings: &[LoopRing], new: usize, tolerance: &Tolerance) -> Result<BTreeMap<(usize, usize), LoopTouch>> {
    let of_ring = |(ring, r): (usize, &'_ LoopRing)| r.chains.iter().enumerate().map(move |(number, _)| (ring, number)).collect::<Vec<_>>();
    let mut fences: Vec<Fence> = rings
        .iter()
        .enumerate()
        .flat_map(of_ring)
        .map(|(ring, number)| {
            let chain = &rings[ring].chains[number];
            Fence { ring, number, chain, reach: chain.bbox() }
        })
        .collect();
    fences.sort_by(|a, b| a.reach.min.x.total_cmp(&b.reach.min.x).then((a.ring, a.number).cmp(&(b.ring, b.number))));
    let mut found: BTreeMap<(usize, usize), LoopTouch> = BTreeMap::new();
    let mut open: Vec<usize> = Vec::new();
    for k in 0..fences.len() {
        job::poll();
        open.retain(|j| fences[*j].reach.max.x + tolerance.point >= fences[k].reach.min.x);
        for &j in &open {
            job::poll();
            let (a, b) = if fences[j].ring < fences[k].ring { (&fences[j], &fences[k]) } else { (&fences[k], &fences[j]) };
            if a.ring == b.ring || b.ring < new || !a.reach.touches(&b.reach, tolerance.point) {
                continue;
            }
            for m in meet(a.chain, b.chain, tolerance)? {
                let touch = found.entry((a.ring, b.ring)).or_default();
                touch.add(m.point, a.chain.point(m.fa).distance(b.chain.point(m.fb)), tolerance);
                touch.cuts.0.push((a.number, m.fa));
                touch.cuts.1.push((b.number, m.fb));
                if let Some((fa, fb)) = m.overlap_end {
                    let end = a.chain.point(fa);
                    touch.add(end, end.distance(b.chain.point(fb)), tolerance);
                    touch.cuts.0.push((a.number, fa));
                    touch.cuts.1.push((b.number, fb));
                    touch.run.get_or_insert((m.point, end));
                    touch.shared += (fa - m.fa).abs() * a.chain.length();
                }
            }
        }
        open.push(k);
    }
    Ok(found)
}

/// The fault of two loops that meet in more than a point.
pub(crate) fn crossing((a, b): (&LoopRing, &LoopRing), touch: &LoopTouch, trimming: Origin, tolerance: &Tolerance) -> LoopFault {
    let (old, later) = if b.outer { (b, a) } else { (a, b) };
    let room = REACH * tolerance.point;
    let whole = |ring: &LoopRing| touch.shared >= ring.length() - room;
    if let (Some(hole), true, true) = (later.hole, whole(old), whole(later)) {
        let earlier = if old.outer { None } else { old.hole };
        if old.outer || earlier.is_some() {
            return LoopFault::Repeated { a: (later.of, hole), b: (old.of, earlier), trimming };
        }
    }
    let (places, run, apart) = (touch.places.clone(), touch.run, touch.apart);
    LoopFault::Meet { a: later.of, b: old.of, outer: old.outer, trimming, places, run, apart, tolerance: tolerance.point }
}

impl TrimLoop {
    /// A place of it and its point in space: the farthest from a point at which it touches another loop.
    pub fn place_off(&self, base: &Surface, touched: Option<DVec3>) -> (DVec2, DVec3) {
        let places = self.trim_curves.iter().flat_map(TrimCurve::places).map(|uv| (uv, base.point(uv.x, uv.y)));
        let far = |p: &(DVec2, DVec3)| touched.map_or(0.0, |t| t.distance_squared(p.1));
        let first = |best: Option<(DVec2, DVec3)>, p: (DVec2, DVec3)| match best {
            Some(q) if far(&p) <= far(&q) => Some(q),
            _ => Some(p),
        };
        places.fold(None, first).unwrap_or((DVec2::ZERO, DVec3::ZERO))
    }

    /// The angle by which it turns about a place, by its curves and not by polygons.
    pub fn turning(&self, base: &Surface, p: DVec2) -> f64 {
        let turn = |k: usize| match &self.borders[k].side {
            Side::Chain { chain, .. } => base.turn_along(&self.trim_curves[k], Some(chain), p),
            _ => base.turn_along(&self.trim_curves[k], None, p),
        };
        (0..self.trim_curves.len()).map(turn).sum::<f64>()
    }

    /// Whether it goes round a place.
    pub fn goes_round(&self, base: &Surface, p: DVec2) -> bool {
        self.turning(base, p).abs() > std::f64::consts::PI
    }

    /// A place and the same place whole turns round the surface away, as far as the loop reaches.
    pub fn copies(&self, base: &Surface, p: DVec2) -> Vec<DVec2> {
        let (low, high) = reach(&self.trim_curves);
        let along = |closed: bool, axis: usize| if closed { within(p[axis], (low[axis], high[axis])) } else { vec![p[axis]] };
        let vs = along(base.closed().1, 1);
        along(base.closed().0, 0).into_iter().flat_map(|u| vs.iter().map(move |v| DVec2::new(u, *v))).collect()
    }

    /// The whole turns by which a place must be moved to lie inside it, if it does.
    pub fn holds_moved(&self, base: &Surface, p: DVec2) -> Option<DVec2> {
        self.copies(base, p).into_iter().find(|at| self.goes_round(base, *at)).map(|at| at - p)
    }
}

/// Two of some loops in (u, v), by their numbers, of which the first lies inside the second; both are holes that do not cross.
pub(crate) fn nested(
    base: &Surface,
    holes: &[(usize, &TrimLoop)],
    touched: impl Fn(usize, usize) -> Option<DVec3>,
) -> Option<(usize, usize, DVec3)> {
    let reaches: Vec<(DVec2, DVec2)> = holes.iter().map(|(_, trim_loop)| reach(&trim_loop.trim_curves)).collect();
    let near = |p: DVec2, (low, high): (DVec2, DVec2)| low.cmple(p).all() && p.cmple(high).all();
    for (inner, trim_loop) in holes {
        let (first, _) = trim_loop.place_off(base, None);
        for ((around, other), reach) in holes.iter().zip(&reaches) {
            if inner == around || !near(first, *reach) {
                continue;
            }
            let (place, at) = trim_loop.place_off(base, touched(*inner, *around));
            if other.goes_round(base, place) {
                return Some((*inner, *around, at));
            }
        }
    }
    None
}

impl LoopRing {
    /// Whether it crosses a seam of the surface that has this border.
    pub fn crosses_seam(&self, border: &Self, tolerance: &Tolerance) -> Result<bool> {
        let (mut touch, seams) = (LoopTouch::default(), &border.seams);
        for seam in seams {
            for chain in &self.chains {
                for m in meet(seam, chain, tolerance)? {
                    touch.add(m.point, 0.0, tolerance);
                    touch.run = touch.run.or(m.overlap_end.map(|_| (m.point, m.point)));
                }
            }
        }
        Ok(touch.is_crossing())
    }
}
