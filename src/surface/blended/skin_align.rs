//! How sections of a skin are read: each in the direction, and a closed one from the start, in which it twists least against the one
//! before it; corners to corners, where all have equally many.

use glam::{DQuat, DVec3};

use crate::base::fault::Result;
use crate::base::quadrature::gauss_legendre;
use crate::base::tolerance::{EPSILON, Tolerance, WHOLE_NUMBER};
use crate::base::{job, solve};
use crate::network::Chain;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::{Map, Reparam};
use crate::surface::rails::ring::{PLACES, Ring};

/// Starts tried along a closed section before the best one is made better.
const STARTS: usize = 64;
/// A start as it is drawn is kept where it lies within this share of the length of the best one, and its mean squared distance is at most
/// so many times the least: sections of one shape, which have a start without any twist, never keep another one.
const AS_DRAWN: (f64, f64) = (1.0 / 32.0, 64.0);
/// Intervals over which squared distances are integrated, beside those between corners.
const PANELS: usize = 16;
/// Points of the rule for each of them.
const ORDER: usize = 3;

/// A section as it is read.
#[derive(Clone, Debug)]
pub enum Read {
    /// A curve, and the shares of its length by the surface's parameter.
    Curve(Chain, Map),
    /// A point.
    Point(DVec3),
}

impl Read {
    /// A curve from its start, or backwards.
    pub fn whole(chain: Chain, turned: bool) -> Self {
        Self::Curve(chain, if turned { Map::reverse() } else { Map::identity() })
    }

    /// At a place of the surface's parameter.
    pub fn point(&self, x: f64) -> DVec3 {
        match self {
            Self::Curve(chain, map) => chain.point(map.value(x)),
            Self::Point(p) => *p,
        }
    }

    /// The curve that the surface has of it.
    pub fn rail(&self) -> Rail {
        match self {
            Self::Curve(chain, map) => Rail::new(chain.clone(), map.clone()),
            Self::Point(p) => Rail::Point(*p),
        }
    }

    /// Places of its curve by shares of its length as it is read, ends left out; nothing of a point.
    fn stops(&self, of: &impl Fn(&Chain) -> Vec<f64>) -> Option<Vec<f64>> {
        let Self::Curve(chain, map) = self else { return None };
        let inside = |f: &f64| *f > WHOLE_NUMBER && *f < 1.0 - WHOLE_NUMBER;
        let mut own: Vec<f64> = of(chain).into_iter().filter(inside).map(|f| if map.falls() { 1.0 - f } else { f }).collect();
        own.sort_by(f64::total_cmp);
        Some(own)
    }
}

/// Joins corners to corners where all curves have equally many: at the means of their shares. Between them curves run by their lengths.
pub fn join_corners(all: &mut [Read], tolerance: &Tolerance) {
    join_at(all, &|chain| chain.kinks(tolerance), tolerance);
}

/// The same with other places than corners.
pub fn join_at(all: &mut [Read], of: &impl Fn(&Chain) -> Vec<f64>, tolerance: &Tolerance) {
    let corners: Vec<Option<Vec<f64>>> = all.iter().map(|read| read.stops(of)).collect();
    let mut curves = corners.iter().flatten();
    let Some(count) = curves.next().map(Vec::len).filter(|count| *count > 0) else { return };
    if curves.any(|own| own.len() != count) {
        return;
    }
    let curves = corners.iter().flatten().count() as f64;
    let means: Vec<f64> = (0..count).map(|k| corners.iter().flatten().map(|own| own[k]).sum::<f64>() / curves).collect();
    let with_ends = |inner: &[f64]| [&[0.0][..], inner, &[1.0]].concat();
    let distinct = |inner: &[f64]| with_ends(inner).windows(2).all(|w| w[1] - w[0] > WHOLE_NUMBER);
    if !distinct(&means) || !corners.iter().flatten().all(|own| distinct(own)) {
        return;
    }
    for (read, own) in all.iter_mut().zip(&corners) {
        let (Read::Curve(_, map), Some(own)) = (read, own) else { continue };
        if own.iter().zip(&means).all(|(own, mean)| (own - mean).abs() <= tolerance.parameter) {
            continue;
        }
        let shares = with_ends(own);
        let places = if map.falls() { shares.iter().map(|x| 1.0 - x).collect() } else { shares };
        *map = Map::new(with_ends(&means), places, Reparam::Linear, false);
    }
}

/// The sections as they are read; `round`: the curves among them are closed.
pub fn aligned(sections: &[SkinSection], round: bool, tolerance: &Tolerance) -> Result<Vec<Read>> {
    let mut all: Vec<Read> = Vec::with_capacity(sections.len());
    for section in sections {
        job::poll();
        let before = all.iter().rev().find_map(|read| if let Read::Curve(chain, map) = read { Some((chain, map.falls())) } else { None });
        let next = match (section, before) {
            (SkinSection::Point(p), _) => Read::Point(*p),
            (SkinSection::Curve(chain), None) => Read::whole(chain.clone(), false),
            (SkinSection::Curve(chain), Some(before)) if round => nearest_start(before, chain, tolerance)?,
            (SkinSection::Curve(chain), Some(before)) => Read::whole(chain.clone(), nearer_backwards(before.0, before.1, chain)),
        };
        all.push(next);
    }
    join_corners(&mut all, tolerance);
    Ok(all)
}

/// Whether the last of some open sections runs against the first one.
pub fn runs_back(aligned: &[Read]) -> bool {
    let [Read::Curve(first, own), .., Read::Curve(last, before)] = aligned else { return false };
    nearer_backwards(last, before.falls(), first) != own.falls()
}

/// v of the sections: sums of their mean distances, from 0 to 1; and their whole, model units. `closed`: the last one is joined to the
/// first; `round`: the curves are closed.
pub fn distances(aligned: &[Read], closed: bool, round: bool) -> (Vec<f64>, f64) {
    let n = aligned.len();
    let places = PLACES + usize::from(!round);
    let at = |k: usize| k as f64 / PLACES as f64;
    let mean = |a: &Read, b: &Read| (0..places).map(|k| a.point(at(k)).distance(b.point(at(k)))).sum::<f64>() / places as f64;
    let mut sums = vec![0.0];
    for k in 1..n + usize::from(closed) {
        sums.push(sums[k - 1] + mean(&aligned[k - 1], &aligned[k % n]));
    }
    let last = sums.len() - 1;
    let whole = sums[last];
    let shares = sums.iter().enumerate().map(|(k, sum)| if k == last { 1.0 } else { sum / whole }).collect();
    (shares, whole)
}

/// A section: `turn` of its length later, backwards or not.
fn read(chain: &Chain, turn: f64, turned: bool, x: f64) -> DVec3 {
    let x = if turned { 1.0 - x } else { x };
    let f = x + turn;
    chain.point(if f > 1.0 { f - 1.0 } else { f })
}

/// Whether an open section comes nearer to the one before when it is read backwards.
fn nearer_backwards(before: &Chain, back: bool, chain: &Chain) -> bool {
    let at = |k: usize| k as f64 / PLACES as f64;
    let apart = |turned: bool| -> f64 {
        (0..=PLACES).map(|k| read(before, 0.0, back, at(k)).distance_squared(read(chain, 0.0, turned, at(k)))).sum()
    };
    apart(true) < apart(false)
}

/// A closed section and the one that is to follow it.
struct SectionPair<'a> {
    before: (&'a Chain, bool),
    section: &'a Chain,
    /// Whether the second is read backwards.
    turned: bool,
    /// The rotation that brings the plane of the first into that of the second, how many times as large that one is, and both centres.
    turn: DQuat,
    scale: f64,
    centers: (DVec3, DVec3),
}

impl<'a> SectionPair<'a> {
    /// `a` and `b` are the rings of both, the second one as it is drawn.
    fn new(before: (&'a Chain, bool), section: &'a Chain, turned: bool, a: Ring, b: Ring) -> Self {
        let b = if turned { b.turned() } else { b };
        Self { before, section, turned, turn: a.rotation_to(&b), scale: b.size / a.size, centers: (a.center, b.center) }
    }

    /// Where the first wants the second to be at a share of its length.
    fn wanted(&self, x: f64) -> DVec3 {
        self.centers.1 + self.turn * (read(self.before.0, 0.0, self.before.1, x) - self.centers.0) * self.scale
    }

    /// Mean of squared distances of the second, read from a start, from places where it is wanted.
    fn apart(&self, wanted: &[DVec3], start: f64) -> f64 {
        let at = |k: usize| read(self.section, start, self.turned, k as f64 / wanted.len() as f64);
        wanted.iter().enumerate().map(|(k, p)| p.distance_squared(at(k))).sum::<f64>() / wanted.len() as f64
    }

    /// Half the derivative of the integral of squared distances by the start, and its own; exact beside corners.
    fn slope(&self, start: f64, corners: &[Vec<f64>; 2], rule: &[(f64, f64)]) -> (f64, f64) {
        let own = |f: &f64| if self.turned { start - f } else { f - start };
        let first = |f: &f64| if self.before.1 { 1.0 - f } else { *f };
        let mut stops: Vec<f64> = corners[0].iter().map(first).chain(corners[1].iter().map(own)).map(|x| x.rem_euclid(1.0)).collect();
        stops.extend((0..=PANELS).map(|k| k as f64 / PANELS as f64));
        stops.sort_by(f64::total_cmp);
        let (mut value, mut rise) = (0.0, 0.0);
        for w in stops.windows(2).filter(|w| w[1] > w[0]) {
            for (node, weight) in rule {
                let x = 0.5 * (w[0] + w[1]) + 0.5 * (w[1] - w[0]) * node;
                let f = (if self.turned { 1.0 - x } else { x }) + start;
                let jet = self.section.jet(f.rem_euclid(1.0));
                let off = jet.p - self.wanted(x);
                let by = 0.5 * (w[1] - w[0]) * weight;
                value += by * off.dot(jet.d1);
                rise += by * (jet.d1.length_squared() + off.dot(jet.d2));
            }
        }
        (value, rise)
    }
}

/// Starts of a closed section that lie between its corners as the start of the one before does between its own: one for each corner.
fn starts_between([before, own]: &[Vec<f64>; 2], (back, turned): (bool, bool)) -> Vec<f64> {
    let read = |f: &f64| if back { (1.0 - f).rem_euclid(1.0) } else { *f };
    let (first, last) = before.iter().map(read).fold((f64::MAX, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    // Of the way from the corner before the start to the one after it; a whole way where it is a corner.
    let share = (1.0 - last) / (1.0 - last + first);
    let previous = |k: usize| if k == 0 { own[own.len() - 1] - 1.0 } else { own[k - 1] };
    (0..own.len())
        .map(|k| {
            let (low, high) = (previous(k), own[k]);
            let start = if turned { high - share * (high - low) } else { low + share * (high - low) };
            start.rem_euclid(1.0)
        })
        .collect()
}

/// A closed section in the direction in which a tube passes both, from the start at which it twists least against the one before, once
/// both lie in one plane about one centre and are of one size.
///
/// Corners go to corners: where both have equally many, only starts that lie between them as the one before does are tried.
fn nearest_start(before: (&Chain, bool), section: &Chain, tolerance: &Tolerance) -> Result<Read> {
    let corners = [before.0, section].map(|chain| chain.kinks(tolerance).into_iter().filter(|f| *f < 1.0).collect::<Vec<_>>());
    let kinked = corners[0].len() == corners[1].len() && !corners[1].is_empty();
    let tried: Vec<f64> = (0..STARTS).map(|k| k as f64 / STARTS as f64).collect();
    let (ring, own) = (Ring::of(before.0), Ring::of(section));
    let ring = if before.1 { ring.turned() } else { ring };
    let against = ring.runs_against(&own);
    let mut best: Option<(f64, f64, SectionPair, Vec<DVec3>)> = None;
    for turned in against.map_or(vec![false, true], |turned| vec![turned]) {
        let pair = SectionPair::new(before, section, turned, ring, own);
        let wanted: Vec<DVec3> = (0..PLACES).map(|k| pair.wanted(k as f64 / PLACES as f64)).collect();
        let starts = if kinked { starts_between(&corners, (before.1, turned)) } else { tried.clone() };
        let off = starts.iter().map(|start| (pair.apart(&wanted, *start), *start));
        let nearer = |a: (f64, f64), b: (f64, f64)| if b.0 < a.0 * (1.0 - tolerance.parameter) { b } else { a };
        let Some((miss, start)) = off.reduce(nearer) else { continue };
        if best.as_ref().is_none_or(|(least, ..)| miss < least * (1.0 - tolerance.parameter)) {
            best = Some((miss, start, pair, wanted));
        }
    }
    let Some((_, mut start, pair, wanted)) = best else { return Ok(Read::whole(section.clone(), false)) };
    if !kinked {
        let (step, rule) = (1.0 / STARTS as f64, gauss_legendre(ORDER));
        let slope = |start: f64| pair.slope(start, &corners, &rule);
        let (low, high) = (start - 2.0 * step, start + 2.0 * step);
        if slope(low).0 < 0.0 && slope(high).0 > 0.0 {
            start = solve::bracketed(low, high, EPSILON, slope).rem_euclid(1.0);
        }
        // Sections of different shapes leave no start without a twist. Starts that were drawn to match then keep seams where they are.
        if start.min(1.0 - start) <= AS_DRAWN.0 && pair.apart(&wanted, 0.0) <= AS_DRAWN.1 * pair.apart(&wanted, start) {
            start = 0.0;
        }
    }
    let turned = pair.turned;
    if start * section.length() <= tolerance.point || (1.0 - start) * section.length() <= tolerance.point {
        return Ok(Read::whole(section.clone(), turned));
    }
    Ok(Read::whole(section.slice(start, start, tolerance)?, turned))
}

/// What a skin goes through.
#[derive(Clone, Debug)]
pub enum SkinSection {
    /// A curve.
    Curve(Chain),
    /// A point, where the skin begins or ends in a pole.
    Point(DVec3),
}
