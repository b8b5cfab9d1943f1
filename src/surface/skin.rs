//! Surfaces through sections alone: each section is contained exactly, and splines run across them.

use glam::DVec3;

use super::coons::evenly;
use super::core::{Border, Side, Surface, SurfaceKind};
use super::flow_words::phrase;
use super::gordon::{CurveNet, Named, blended};
use super::rail::Rail;
use super::reparam::Map;
use super::skin_ends::{Spanned, ended};
use super::skin_fit::fitted;
use crate::base::fault::{Fault, NetFault, Result, ValueFault};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;

pub use super::skin_ends::Leaving;

/// Places along a section at which neighbours are compared.
const COMPARED: usize = 32;
/// Starts tried along a closed section before the best one is made better.
const STARTS: usize = 64;
/// Halvings to the best start.
const STEPS: usize = 48;
/// How often a fit is made closer because of what its ends add.
const CLOSER: usize = 8;

/// How the surface runs from section to section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    /// Straight, with a kink along each inner section.
    Linear,
    /// By cubic splines, twice continuously differentiable.
    Cubic,
}

/// What a skin goes through.
#[derive(Clone, Debug)]
pub enum Section {
    /// A curve.
    Curve(Chain),
    /// A point, where the skin begins or ends in a pole.
    Point(DVec3),
}

/// Settings of [`skin`].
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// How it runs from section to section.
    pub across: Across,
    /// The last section is joined to the first one.
    pub closed: bool,
    /// What it does at the first and at the last section; plain where it is closed or linear.
    pub ends: (Leaving, Leaving),
    /// How far inner sections may be left for fewer spans, model units.
    pub smooth: Option<f64>,
    /// The declaration.
    pub origin: Origin,
}

/// The surface through sections in the order given, u along them, with warnings (W614, N677).
///
/// Every section is read in the direction, and every closed one from the start, in which it runs nearest to the section
/// before; v goes with the mean distance between sections. Needs two sections, three where they close; the curves are all
/// open or all closed, at least one of them, and only the first and the last section is a point.
pub fn skin(sections: &[Section], settings: &Settings, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let chains: Vec<Chain> = sections.iter().filter_map(|s| if let Section::Curve(c) = s { Some(c.clone()) } else { None }).collect();
    let round = chains.iter().all(|c| c.is_closed(tolerance));
    let mut aligned: Vec<Read> = Vec::with_capacity(sections.len());
    for section in sections {
        job::look();
        let before =
            aligned.iter().rev().find_map(|read| if let Read::Curve(chain, turned) = read { Some((chain, *turned)) } else { None });
        let next = match (section, before) {
            (Section::Point(p), _) => Read::Point(*p),
            (Section::Curve(chain), None) => Read::Curve(chain.clone(), false),
            (Section::Curve(chain), Some(before)) if round => nearest_start(before, chain, tolerance)?,
            (Section::Curve(chain), Some(before)) => {
                Read::Curve(chain.clone(), apart(before, (chain, 0.0, true)) < apart(before, (chain, 0.0, false)))
            }
        };
        aligned.push(next);
    }
    if settings.closed
        && !round
        && let [Read::Curve(first, turned), .., Read::Curve(last, before)] = aligned.as_slice()
        && apart((last, *before), (first, 0.0, !*turned)) < apart((last, *before), (first, 0.0, *turned))
    {
        let (found, range) = ("sections of which the last one runs against the first one".to_owned(), "`false` for them".to_owned());
        return Err(ValueFault::OutsideRange { argument: "closed", found, range }.into());
    }
    let (nodes, length) = distances(&aligned, settings.closed);
    if let Some(k) = nodes.windows(2).position(|w| (w[1] - w[0]).max(0.0) <= tolerance.parameter) {
        let origin = |k: usize| if let Section::Curve(c) = &sections[k % sections.len()] { c.origin() } else { settings.origin };
        let at = aligned[k].point(0.0);
        return Err(NetFault::Cross { a: origin(k), b: origin(k + 1), guides: false, at }.into());
    }
    let rails: Vec<Rail> = aligned.iter().map(Read::rail).collect();
    let poles = sections.len() - chains.len();
    let named = |chains: Vec<Chain>| Named {
        origin: settings.origin,
        kind: SurfaceKind::Skin,
        flow: phrase(poles, (round, settings.closed)),
        chains,
    };
    let side = if round { Side::Seam } else { Side::Free };
    let made = |given: Spanned| {
        let Spanned { nodes, rails } = ended(given, settings.ends, length, tolerance);
        let net = CurveNet { along_u: rails, along_v: Vec::new(), nodes: (evenly(2), nodes), closed: (false, settings.closed) };
        let (surface, notes) = blended(net, named(chains.clone()), settings.across == Across::Linear, tolerance);
        (surface.with_ends(side.clone(), round), notes)
    };
    let Some(allowed) = settings.smooth else { return Ok(made(Spanned { nodes, rails })) };
    let mut within = allowed;
    for step in 0..=CLOSER {
        let last = step == CLOSER;
        let fit = fitted(&nodes, &rails, settings.closed, if last { 0.0 } else { within }, tolerance);
        let spans = fit.nodes.len() - 1;
        let (surface, mut notes) = made(fit);
        let (off, k, at) = farthest(&surface, &nodes, &rails);
        if off <= allowed || last {
            let section = if let Section::Curve(c) = &sections[k] { c.origin() } else { settings.origin };
            let given = nodes.len() - 1;
            notes.push(NetFault::Smoothed { surface: settings.origin, section, off, at, spans, given }.into());
            return Ok((surface, notes));
        }
        within *= 0.5;
    }
    Ok(made(Spanned { nodes, rails }))
}

/// Places along each section at which a fit is measured.
const MEASURED: usize = 128;

/// How far sections lie from the surface at most at their own parameters, which one, and where.
fn farthest(surface: &Surface, nodes: &[f64], rails: &[Rail]) -> (f64, usize, DVec3) {
    let us = evenly(MEASURED);
    let mut worst = (0.0, 0, rails[0].point(0.0));
    for (k, (rail, v)) in rails.iter().zip(nodes).enumerate() {
        let mut found = vec![DVec3::ZERO; us.len()];
        surface.grid(&us, &[*v], &mut found);
        for (p, q) in rail.points(&us).into_iter().zip(found) {
            if p.distance(q) > worst.0 {
                worst = (p.distance(q), k, p);
            }
        }
    }
    worst
}

/// A section as it is read.
#[derive(Clone, Debug)]
enum Read {
    /// A curve from its start, or backwards.
    Curve(Chain, bool),
    Point(DVec3),
}

impl Read {
    fn point(&self, x: f64) -> DVec3 {
        match self {
            Self::Curve(chain, turned) => read((chain, 0.0, *turned), x),
            Self::Point(p) => *p,
        }
    }

    fn rail(&self) -> Rail {
        match self {
            Self::Curve(chain, turned) => Rail::new(chain.clone(), if *turned { Map::reverse() } else { Map::identity() }),
            Self::Point(p) => Rail::Point(*p),
        }
    }
}

/// A section: `turn` of its length later, backwards or not.
fn read((chain, turn, turned): (&Chain, f64, bool), x: f64) -> DVec3 {
    let x = if turned { 1.0 - x } else { x };
    let f = x + turn;
    chain.point(if f > 1.0 { f - 1.0 } else { f })
}

/// Sum of squared distances between two sections.
fn apart((before, turned): (&Chain, bool), section: (&Chain, f64, bool)) -> f64 {
    let at = |k: usize| k as f64 / COMPARED as f64;
    (0..=COMPARED).map(|k| read((before, 0.0, turned), at(k)).distance_squared(read(section, at(k)))).sum()
}

/// How that sum grows with the turn of the second one, halved.
fn slope((before, back): (&Chain, bool), (chain, turn, turned): (&Chain, f64, bool)) -> f64 {
    let one = |k: usize| {
        let x = k as f64 / COMPARED as f64;
        let f = (if turned { 1.0 - x } else { x }) + turn;
        let jet = chain.jet(if f > 1.0 { f - 1.0 } else { f });
        (jet.p - read((before, 0.0, back), x)).dot(jet.d1)
    };
    (0..=COMPARED).map(one).sum()
}

/// A closed section from the start, and in the direction, that twists least against the one before.
///
/// Corners go to corners: where both have equally many, only these are tried.
fn nearest_start(before: (&Chain, bool), section: &Chain, tolerance: &Tolerance) -> Result<Read> {
    let corners = |chain: &Chain| chain.kinks(tolerance).into_iter().filter(|f| *f < 1.0).collect::<Vec<_>>();
    let (own, other) = (corners(section), corners(before.0));
    let kinked = own.len() == other.len() && !own.is_empty();
    let starts = if kinked { own } else { (0..STARTS).map(|k| k as f64 / STARTS as f64).collect() };
    let off = |start: f64, turned: bool| apart(before, (section, start.rem_euclid(1.0), turned));
    let mut best = (f64::INFINITY, 0.0, false);
    for (start, turned) in starts.iter().flat_map(|start| [(*start, false), (*start, true)]) {
        let miss = off(start, turned);
        if miss < best.0 * (1.0 - tolerance.parameter) {
            best = (miss, start, turned);
        }
    }
    let mut start = best.1;
    if !kinked && start != 0.0 {
        // Where the sum no longer falls: halving keeps all digits, the sum itself only half of them.
        let falls = |start: f64| slope(before, (section, start.rem_euclid(1.0), best.2)) < 0.0;
        let (mut low, mut high) = (start - 1.0 / STARTS as f64, start + 1.0 / STARTS as f64);
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            if falls(middle) { low = middle } else { high = middle }
        }
        start = (0.5 * (low + high)).rem_euclid(1.0);
    }
    if start * section.length() <= tolerance.point || (1.0 - start) * section.length() <= tolerance.point {
        return Ok(Read::Curve(section.clone(), best.2));
    }
    Ok(Read::Curve(section.slice(start, start, tolerance)?, best.2))
}

/// v of the sections: sums of their mean distances, from 0 to 1; and their whole, model units.
fn distances(aligned: &[Read], closed: bool) -> (Vec<f64>, f64) {
    let n = aligned.len();
    let at = |k: usize| k as f64 / COMPARED as f64;
    let mean = |a: &Read, b: &Read| (0..=COMPARED).map(|k| a.point(at(k)).distance(b.point(at(k)))).sum::<f64>();
    let mut sums = vec![0.0];
    for k in 1..n + usize::from(closed) {
        sums.push(sums[k - 1] + mean(&aligned[k - 1], &aligned[k % n]));
    }
    let last = sums.len() - 1;
    let whole = sums[last];
    let shares = sums.iter().enumerate().map(|(k, sum)| if k == last { 1.0 } else { sum / whole }).collect();
    (shares, whole / (COMPARED + 1) as f64)
}

impl Surface {
    /// The same with both ends of u free or joined.
    fn with_ends(&self, side: Side, round: bool) -> Self {
        let mut parts = self.parts().clone();
        parts.closed.0 = round;
        for k in [1, 3] {
            parts.borders[k] = Border::straight(side.clone());
        }
        Self::new(parts)
    }
}
