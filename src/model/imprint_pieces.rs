//! Faces cut by each other where they touch, so that a shell or mesh of the pieces conforms.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::imprint::TouchingPair;
use super::measure::area_within;
use super::topology::{EdgeId, Model, SurfaceId};
use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::{MEASURE_ACCURACY, Tolerance};
use crate::geometry::data::fault::CurveFault;
use crate::network::{Chain, Network};
use crate::surface::intersect::runs::runs_on;
use crate::surface::{Domain, Nearest, Surface, over_frame, parted, with_loops};

/// Places along a curve at which it is compared with another one.
const SAMPLES: usize = 9;
/// Points of a face that tell whether another one covers it.
const ENOUGH: usize = 8;

impl Model {
    /// The pieces into which some surfaces cut each other, surface by surface as listed; one that nothing cuts stays as it is.
    /// Of what several surfaces cover the first one's piece is taken alone. `origin` is given to the curves of cuts.
    ///
    /// Fails with E413 when the work exceeds its limit, and when the areas of the pieces of a surface do not add up to its own.
    pub fn imprinted(
        &self,
        listed: &[SurfaceId],
        origin: Origin,
        network: &Network,
        tolerance: &Tolerance,
        job: &Job,
    ) -> Result<Vec<Surface>> {
        let met = self.met(listed, origin, network, tolerance, job)?;
        let pieces = par::try_map(listed.len(), |k| {
            job.go_on()?;
            let cutters = self.cutters(listed[k], &met, network, tolerance)?;
            let surface = &self.surfaces[listed[k].index()].surface;
            match parted(surface, &cutters, surface.origin(), tolerance)? {
                Some(parts) => whole(surface, parts, tolerance),
                None => Ok(vec![surface.clone()]),
            }
        })?;
        let surface = |k: usize| &self.surfaces[listed[k].index()].surface;
        let hulls: Vec<Box3> = (0..listed.len()).map(|k| surface(k).hull()).collect();
        let (mut out, mut known): (Vec<Surface>, BTreeMap<usize, Nearest>) = Default::default();
        for (k, own) in pieces.into_iter().enumerate() {
            for piece in own {
                let hull = piece.hull();
                let near: Vec<usize> = (0..k).filter(|n| hulls[*n].touches(&hull, tolerance.point)).collect();
                let places = if near.is_empty() { Vec::new() } else { inner_points(&piece, tolerance)? };
                let on = |nearest: &Nearest| places.iter().all(|p| nearest.at(*p).distance <= tolerance.point);
                for n in &near {
                    if !known.contains_key(n) {
                        known.insert(*n, Nearest::new(&over_frame(surface(*n), tolerance)?));
                    }
                }
                let covered = !places.is_empty() && near.iter().any(|n| known.get(n).is_some_and(on));
                if !covered {
                    out.push(piece);
                    continue;
                }
                // The first one's piece stands for this one too.
                let mut kept = out.iter_mut().filter(|o| o.hull().touches(&hull, tolerance.point));
                if let Some(kept) = kept.find(|other| on(&Nearest::new(other))) {
                    *kept = kept.cut_from(std::slice::from_ref(surface(k)));
                }
            }
        }
        Ok(out)
    }

    /// The curves that cut a surface: those in which it crosses others, and edges of others that lie on it.
    fn cutters(&self, of: SurfaceId, met: &[TouchingPair], network: &Network, tolerance: &Tolerance) -> Result<Vec<Chain>> {
        let surface = &self.surfaces[of.index()].surface;
        let own = met.iter().filter(|m| m.pair.0 == of || m.pair.1 == of);
        let mut edges: BTreeSet<EdgeId> = BTreeSet::new();
        let mut found: Vec<Chain> = Vec::new();
        for m in own {
            edges.extend(self.sides_of(if m.pair.0 == of { m.pair.1 } else { m.pair.0 }));
            found.extend(m.curves.iter().cloned());
        }
        // Along a seam the face goes on: a curve there cuts it.
        let is_seam = |edge: &EdgeId| {
            let users = &self.edges[edge.index()].users;
            (1..users.len()).any(|k| users[..k].iter().any(|(patch, _)| *patch == users[k].0))
        };
        let mut borders = Vec::new();
        for edge in self.sides_of(of).into_iter().filter(|edge| !is_seam(edge)) {
            borders.extend(self.edge_chain(edge, network, tolerance)?);
        }
        let mut kept: Vec<Chain> = Vec::new();
        for edge in edges {
            let Some(way) = self.edge_chain(edge, network, tolerance)? else { continue };
            kept.extend(runs_on(&way, surface, tolerance)?);
        }
        // Edges come before curves found by crossing, which may be the same.
        kept.extend(found);
        let mut out: Vec<Chain> = Vec::new();
        for chain in kept {
            let on = |others: &[Chain]| lies_on(&chain, others, tolerance);
            // Curves may share runs: dividing the surface counts each run once.
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

/// The parts of a surface, if their areas add up to its own as far as their borders are known; E413 otherwise.
fn whole(surface: &Surface, parts: Vec<Surface>, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    /// Sums are told apart where they differ by so many times their estimated errors.
    const SURE: f64 = 10.0;
    let (area, error) = area_within(surface);
    let (sum, errors) = parts.iter().map(area_within).fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    // Where curves follow each other they meet within the tolerance only.
    let corners: usize = parts.iter().map(Surface::n_sides).sum();
    let ends = corners as f64 * tolerance.point * surface.hull().diagonal();
    if (sum - area).abs() <= ends + SURE * (error + errors + MEASURE_ACCURACY * area) {
        return Ok(parts);
    }
    let at = parts.first().and_then(|part| part.border_start(0)).unwrap_or_default();
    Err(CurveFault::NotConverged { of: surface.origin(), what: "the pieces of the surface".to_owned(), at }.into())
}

/// Some points inside a face, too many to lie on a line by chance.
fn inner_points(surface: &Surface, tolerance: &Tolerance) -> Result<Vec<DVec3>> {
    let surface = &with_loops(surface, tolerance)?;
    let outlines = match surface.domain() {
        Domain::Triangle => vec![vec![DVec2::ZERO, DVec2::X, DVec2::Y]],
        Domain::Loop => surface.outlines(),
        _ => vec![vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]],
    };
    let places: Vec<DVec2> = inner_places(&outlines);
    // Of a face thinner than its borders bend between their places none may be left.
    let sure: Vec<DVec2> = places.iter().copied().filter(|p| surface.holds(p.x, p.y)).collect();
    let places = if sure.is_empty() { places } else { sure };
    Ok(places.into_iter().map(|p| surface.point(p.x, p.y)).collect())
}

/// A place on each of several rows across loops: a third of the way over the widest interval inside.
fn inner_places(outlines: &[Vec<DVec2>]) -> Vec<DVec2> {
    let all = outlines.iter().flatten();
    let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
    let row = |k: usize| {
        let v = low + (high - low) * (k as f64 + 0.5) / ENOUGH as f64;
        let steps = outlines.iter().flat_map(|loop_| (0..loop_.len()).map(move |i| (loop_[i], loop_[(i + 1) % loop_.len()])));
        let through = steps.filter(|(a, b)| (a.y <= v) != (b.y <= v));
        let mut us: Vec<f64> = through.map(|(a, b)| a.x + (b.x - a.x) * (v - a.y) / (b.y - a.y)).collect();
        us.sort_by(f64::total_cmp);
        let inside = us.chunks_exact(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
        // Rows take their place by turns on either side of the middle.
        let share = if k.is_multiple_of(2) { 1.0 / 3.0 } else { 2.0 / 3.0 };
        Some(DVec2::new(inside[0] + (inside[1] - inside[0]) * share, v))
    };
    (0..ENOUGH).filter_map(row).collect()
}
