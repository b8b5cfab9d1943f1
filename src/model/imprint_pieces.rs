//! Faces cut by each other where they touch, so that a shell or mesh of the pieces conforms.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use super::imprint::Met;
use super::measure;
use super::topology::{EdgeId, Model, SurfaceId};
use crate::base::fault::{CurveFault, CutFault, Fault, Result};
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::{SIGN_ACCURACY, Tolerance};
use crate::network::{Chain, Network};
use crate::surface::meet::with_curve;
use crate::surface::{Domain, Nearest, Surface, divide, trim};

/// Places along a curve at which it is compared with another one.
const SAMPLES: usize = 9;
/// Places along each direction of a face that are looked at, one grid after the other until enough is known.
const GRIDS: [usize; 3] = [12, 48, 192];
/// Points of a face that tell whether another one covers it, at the least.
const ENOUGH: usize = 8;

impl Model {
    /// The pieces into which some surfaces cut each other, surface by surface as listed; one that nothing cuts stays as it is.
    /// Of what several surfaces cover the first one's piece is taken alone. `origin` is given to the curves of cuts.
    ///
    /// Fails with E413 when the work exceeds its limit.
    pub fn imprinted(
        &self,
        listed: &[SurfaceId],
        origin: Origin,
        (network, tolerance): (&Network, &Tolerance),
        job: &Job,
    ) -> Result<Vec<Surface>> {
        let met = self.met(listed, origin, tolerance, job)?;
        let pieces = par::try_map(listed.len(), |k| {
            job.go_on()?;
            let cutters = self.cutters(listed[k], &met, network, tolerance)?;
            parts(&self.surfaces[listed[k].index()].surface, cutters, tolerance)
        })?;
        let mut out = Vec::new();
        for (k, own) in pieces.into_iter().enumerate() {
            for piece in own {
                let hull = piece.hull();
                let before = listed[..k].iter().map(|s| &self.surfaces[s.index()].surface);
                let near: Vec<&Surface> = before.filter(|s| s.hull().touches(&hull, tolerance.point)).collect();
                let places = if near.is_empty() { Vec::new() } else { inner_points(&piece, tolerance)? };
                let covers = |s: &&Surface| {
                    let nearest = Nearest::new(s);
                    places.iter().all(|p| nearest.at(*p).distance <= tolerance.point)
                };
                if places.is_empty() || !near.iter().any(covers) {
                    out.push(piece);
                }
            }
        }
        Ok(out)
    }

    /// The curves that cut a surface: those in which it crosses others, and edges of others that lie on it.
    fn cutters(&self, of: SurfaceId, met: &[Met], network: &Network, tolerance: &Tolerance) -> Result<Vec<Chain>> {
        let surface = &self.surfaces[of.index()].surface;
        let own = met.iter().filter(|m| m.pair.0 == of || m.pair.1 == of);
        let mut edges: BTreeSet<EdgeId> = BTreeSet::new();
        let mut found: Vec<Chain> = Vec::new();
        for m in own {
            edges.extend(self.sides_of(if m.pair.0 == of { m.pair.1 } else { m.pair.0 }));
            found.extend(m.curves.iter().cloned());
        }
        let mut borders = Vec::new();
        for edge in self.sides_of(of) {
            borders.extend(self.edge_way(edge, network, tolerance)?);
        }
        let mut kept: Vec<Chain> = Vec::new();
        for edge in edges {
            let Some(way) = self.edge_way(edge, network, tolerance)? else { continue };
            for run in with_curve(&way, std::slice::from_ref(surface), tolerance)? {
                let Some(to) = run.shared_to else { continue };
                let whole = run.f <= 0.0 && to >= 1.0;
                kept.push(if whole { way.clone() } else { way.slice(run.f, to, tolerance)? });
            }
        }
        // Edges come before curves found by crossing, which may be the same.
        kept.extend(found);
        let mut out: Vec<Chain> = Vec::new();
        for chain in kept {
            let on = |others: &[Chain]| lies_on(&chain, others, tolerance);
            if !on(&borders) && !on(&out) {
                out.push(chain);
            }
        }
        Ok(out)
    }
}

/// Whether all of a curve lies on others.
fn lies_on(chain: &Chain, others: &[Chain], tolerance: &Tolerance) -> bool {
    let point = |k: usize| chain.point((k as f64 + 0.5) / SAMPLES as f64);
    !others.is_empty() && (0..SAMPLES).all(|k| others.iter().any(|o| o.closest(point(k)).2 <= tolerance.point))
}

/// A surface divided by curves; those that hang loose cut nothing and are left out.
fn parts(surface: &Surface, mut cutters: Vec<Chain>, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    while !cutters.is_empty() {
        match all_parts(surface, &cutters, tolerance) {
            Err(Fault::Cut(fault)) => {
                let CutFault::CutOpen { ends, .. } = &*fault else { return Err(Fault::Cut(fault)) };
                let loose = |c: &Chain| [c.start(), c.end()].into_iter().any(|p| ends.iter().any(|end| tolerance.same_point(p, *end)));
                let before = cutters.len();
                cutters.retain(|c| !loose(c));
                if cutters.len() == before {
                    return Err(Fault::Cut(fault));
                }
            }
            found => return found,
        }
    }
    Ok(vec![surface.clone()])
}

/// All parts into which curves divide a surface: the part round each of many places, until their areas add up to the whole.
fn all_parts(surface: &Surface, cutters: &[Chain], tolerance: &Tolerance) -> Result<Vec<Surface>> {
    let whole = measure::area(surface);
    let bordered = bordered(surface, tolerance)?;
    let (mut found, mut nearest, mut area): (Vec<Surface>, Vec<Nearest>, f64) = (Vec::new(), Vec::new(), 0.0);
    for steps in GRIDS {
        for place in places(&bordered, steps) {
            let p = bordered.point(place.x, place.y);
            if nearest.iter().any(|n| n.at(p).distance <= tolerance.point) {
                continue;
            }
            match divide(surface, cutters, p, surface.origin(), tolerance) {
                Ok(part) => {
                    area += measure::area(&part);
                    nearest.push(Nearest::new(&part));
                    found.push(part);
                }
                // On a cut: another place tells.
                Err(Fault::Cut(fault)) if matches!(*fault, CutFault::KeepOff { .. }) => {}
                Err(fault) => return Err(fault),
            }
            if (area - whole).abs() <= SIGN_ACCURACY * SIGN_ACCURACY * whole {
                return Ok(found);
            }
        }
    }
    let at = bordered.point(0.5, 0.5);
    Err(CurveFault::NotConverged { of: surface.origin(), what: "the pieces of the surface".to_owned(), at }.into())
}

/// A plane without a map as one whose loops are known in (u, v); any other surface as it is.
fn bordered(surface: &Surface, tolerance: &Tolerance) -> Result<Surface> {
    let bare = surface.domain() == Domain::Loop && surface.outlines().is_empty();
    if bare { trim(surface, &[], &[], surface.origin(), tolerance) } else { Ok(surface.clone()) }
}

/// Places inside a face at the middles of a grid.
fn places(surface: &Surface, steps: usize) -> Vec<DVec2> {
    let outlines = surface.outlines();
    let trimmed = surface.domain() == Domain::Loop;
    let start = if trimmed { (DVec2::INFINITY, DVec2::NEG_INFINITY) } else { (DVec2::ZERO, DVec2::ONE) };
    let (low, high) = outlines.iter().flatten().fold(start, |(l, h), p| (l.min(*p), h.max(*p)));
    let middle = |k: usize| (k as f64 + 0.5) / steps as f64;
    let all = (0..steps * steps).map(|k| DVec2::new(middle(k % steps), middle(k / steps)));
    let narrow = if surface.domain() == Domain::Triangle { 1.0 } else { 0.0 };
    let at = all.map(|p| low + (high - low) * DVec2::new(p.x * (1.0 - narrow * p.y), p.y));
    at.filter(|p| !trimmed || surface.holds(p.x, p.y)).collect()
}

/// Some points inside a face, too many to lie on a line by chance; none where none was found.
fn inner_points(surface: &Surface, tolerance: &Tolerance) -> Result<Vec<DVec3>> {
    let surface = &bordered(surface, tolerance)?;
    let found = GRIDS.iter().map(|steps| places(surface, *steps)).find(|found| found.len() >= ENOUGH).unwrap_or_default();
    Ok(found.iter().step_by(found.len().div_ceil(2 * ENOUGH).max(1)).map(|p| surface.point(p.x, p.y)).collect())
}
