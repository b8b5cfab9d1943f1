//! Surfaces through sections alone: each section is contained exactly, and splines run across them.

use glam::DVec3;

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::network::fault::NetFault;
use crate::surface::blended::family::evenly;
use crate::surface::blended::gordon::{CurveNet, Named, blended};
use crate::surface::blended::skin_align::{Read, SkinSection, aligned, distances, runs_back};
use crate::surface::blended::skin_ends::{Leaving, Spanned, ended};
use crate::surface::blended::skin_fit::fitted;
use crate::surface::core::surface::Surface;
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::{Construction, DeviationFault, SurfaceFault};
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::{Border, Side};

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

/// Settings of [`skin`].
#[derive(Clone, Copy, Debug)]
pub struct SkinSettings {
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

/// E304 unless there are enough sections, all open or all closed, and points only where they may be.
pub fn said_well(sections: &[SkinSection], closed: bool, tolerance: &Tolerance) -> Result<()> {
    let wrong = |found: String, range: &str| -> Result<()> {
        Err(ValueFault::OutsideRange { argument: "sections", found, range: range.to_owned() }.into())
    };
    let least = if closed { 3 } else { 2 };
    if sections.len() < least {
        return wrong(format!("{} sections", sections.len()), &format!("at least {least}"));
    }
    let is_point = |s: &SkinSection| matches!(s, SkinSection::Point(_));
    let last = sections.len() - 1;
    if let Some(k) = (0..=last).find(|k| is_point(&sections[*k]) && (closed || (*k != 0 && *k != last))) {
        let may = if closed { "curves only where it is closed" } else { "points at the first and the last place only" };
        return wrong(format!("a point at place {k}"), may);
    }
    if sections.iter().all(is_point) {
        return wrong("points only".to_owned(), "a curve between them");
    }
    let curves = || sections.iter().filter_map(|s| if let SkinSection::Curve(c) = s { Some(c) } else { None });
    let (rings, all) = (curves().filter(|c| c.is_closed(tolerance)).count(), curves().count());
    if rings != 0 && rings != all {
        return wrong(format!("{rings} closed of {all} curves"), "all open or all closed");
    }
    Ok(())
}

/// The surface through sections in the order given, u along them, with warnings (W607, W614, N677).
///
/// Every section is read in the direction, and every closed one from the start, in which it runs nearest to the section
/// before; v goes with the mean distance between sections. Needs two sections, three where they close; the curves are all
/// open or all closed, at least one of them, and only the first and the last section is a point.
pub fn skin(sections: &[SkinSection], settings: &SkinSettings, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let chains: Vec<Chain> = sections.iter().filter_map(|s| if let SkinSection::Curve(c) = s { Some(c.clone()) } else { None }).collect();
    let round = chains.iter().all(|c| c.is_closed(tolerance));
    let aligned = aligned(sections, round, tolerance)?;
    if settings.closed && !round && runs_back(&aligned) {
        let (found, range) = ("sections of which the last one runs against the first one".to_owned(), "`false` for them".to_owned());
        return Err(ValueFault::OutsideRange { argument: "closed", found, range }.into());
    }
    let (nodes, length) = distances(&aligned, settings.closed, round);
    let least = tolerance.point.max(tolerance.parameter * length);
    if let Some(k) = nodes.windows(2).position(|w| length <= least || (w[1] - w[0]) * length <= least) {
        let origin = |k: usize| if let SkinSection::Curve(c) = &sections[k] { c.origin() } else { settings.origin };
        let closing = k + 1 == sections.len();
        let (a, b) = if closing { (origin(0), origin(k)) } else { (origin(k), origin(k + 1)) };
        return Err(NetFault::OneSection { a, b, at: aligned[k].point(0.0), closing }.into());
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
        let back = if settings.across == Across::Linear { turned_back(&surface) } else { None };
        (surface.with_ends(side.clone(), round), [notes, back.into_iter().collect()].concat())
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
            let section = if let SkinSection::Curve(c) = &sections[k] { c.origin() } else { settings.origin };
            let given = nodes.len() - 1;
            notes.push(DeviationFault::Smoothed { surface: settings.origin, section, off, at, spans, given }.into());
            return Ok((surface, notes));
        }
        within *= 0.5;
    }
    Ok(made(Spanned { nodes, rails }))
}

/// W607 where a skin of straight pieces runs back over itself at a section, all along it.
fn turned_back(surface: &Surface) -> Option<Fault> {
    const PLACES: usize = 8;
    let (_, vs) = surface.kinks();
    let turn = |v: f64, u: f64| {
        let [a, b] = [OneSided::Before, OneSided::After].map(|side| surface.jet_one_sided(u, v, (OneSided::After, side)).dv);
        math::angle_between(a, b)
    };
    vs.iter().find_map(|&v| {
        let at = |k: usize| (k as f64 + 0.5) / PLACES as f64;
        let least = (0..PLACES).map(|k| turn(v, at(k))).fold(f64::INFINITY, f64::min);
        let made = Construction::Sections;
        let fault =
            || SurfaceFault::PatchFolded { surface: surface.origin(), uv: (at(0), v), at: surface.point(at(0), v), turn: least, made };
        (least > BACK).then(|| fault().into())
    })
}

/// Turn at a section, radians, beyond which the surface runs back: it may be sharper at some places of a section, not at all.
const BACK: f64 = 3.0;

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
