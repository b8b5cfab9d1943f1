//! How near the borders of a shell's faces must be to be one, and what joining them did (`docs/notes/glue.md`).

use crate::model::fault::GluingFault;
use std::collections::BTreeMap;

use glam::DVec3;

use super::feet::TrackPart;
use super::measure;
use super::segments::Segments;
use super::shells::{Joins, ShellRequest};
use super::topology::{EdgeId, Model, Patch, PatchId, SurfaceId};
use crate::base::fault::{Fault, Result};
use crate::base::tolerance::{GAP_ROOM, MISMATCH, Tolerance};
use crate::surface::Domain;

/// A place where two borders that became one are apart.
struct Gap {
    width: f64,
    at: DVec3,
    surfaces: (SurfaceId, SurfaceId),
}

/// What joining edges needs to be judged.
pub(super) struct Seams<'a> {
    pub model: &'a Model,
    pub joins: &'a Joins,
}

impl Model {
    /// How far apart borders of some surfaces may be and still be one edge, model units: what is stated, else ten times the
    /// widest gap within the borders that a face came with, and the tolerance at the least.
    pub fn reach(&self, surfaces: impl IntoIterator<Item = SurfaceId>, stated: Option<f64>, tolerance: &Tolerance) -> f64 {
        // What is just as far apart as stated is within it.
        stated.map_or_else(|| GAP_ROOM * self.own_gap(surfaces), |d| d + tolerance.rounding).max(tolerance.point)
    }

    /// The widest gap within the borders that a face came with, model units.
    pub(super) fn own_gap(&self, surfaces: impl IntoIterator<Item = SurfaceId>) -> f64 {
        surfaces.into_iter().map(|s| self.surfaces[s.index()].surface.gap()).fold(0.0, f64::max)
    }
}

/// Places along each direction at which the area of a patch is sampled.
const SAMPLES: usize = 8;

impl Model {
    /// Whether a patch is thinner than what was glued: its loop runs along every segment there and back, and it has no more area than
    /// a strip as wide as `near` along half its border. A tube or a torus runs there and back along its seam, too, but has area.
    /// `edges`, ascending, are those of the tracks of `pieces`.
    pub fn is_sliver(&self, id: PatchId, edges: &[EdgeId], pieces: &Segments, near: f64) -> bool {
        let patch = &self.patches[id.index()];
        let mut net: BTreeMap<usize, i32> = BTreeMap::new();
        let mut around = 0.0;
        for (k, side) in patch.sides.iter().enumerate() {
            let backwards = self.runs_back(patch, k);
            for (edge, against) in &side.edges {
                around += self.edges[edge.index()].length;
                let Ok(part) = edges.binary_search(edge) else { return false };
                for u in &pieces.of_track[part] {
                    *net.entry(u.segment).or_default() += if (*against != backwards) == u.against { 1 } else { -1 };
                }
            }
        }
        net.values().all(|n| *n == 0) && self.patch_area(patch) <= 0.5 * around * near
    }

    /// Area of a patch: of a rectangle of (u, v) about, by samples.
    fn patch_area(&self, patch: &Patch) -> f64 {
        let surface = &self.surfaces[patch.surface.index()].surface;
        if surface.domain() != Domain::Square {
            return measure::area(surface);
        }
        let n = SAMPLES as f64;
        let at = |(low, high): (f64, f64), k: usize| low + (high - low) * (k as f64 + 0.5) / n;
        let places = (0..SAMPLES * SAMPLES).map(|k| (at(patch.u, k % SAMPLES), at(patch.v, k / SAMPLES)));
        let rates = places.map(|(u, v)| surface.jet(u, v)).map(|jet| jet.du.cross(jet.dv).length());
        rates.sum::<f64>() * (patch.u.1 - patch.u.0) * (patch.v.1 - patch.v.0) / (n * n)
    }
}

impl Seams<'_> {
    fn surface(&self, part: usize) -> SurfaceId {
        let user = self.model.edges[self.joins.edges[part].index()].users[0];
        self.model.patches[user.0.index()].surface
    }

    fn piece(&self, part: usize, s: (f64, f64)) -> TrackPart<'_> {
        TrackPart { track: &self.joins.parts[part].track, s }
    }

    /// Where the borders of a segment are furthest from the one that gives its geometry.
    fn widest(&self) -> Option<Gap> {
        let mut found: Option<Gap> = None;
        for (part, uses) in self.joins.pieces.of_track.iter().enumerate() {
            for u in uses {
                let segment = &self.joins.pieces.segments[u.segment];
                if segment.track == part {
                    continue;
                }
                let (here, there) = (self.piece(part, u.s), self.piece(segment.track, segment.s));
                let (width, at) = here.off(&there, u.against);
                if found.as_ref().is_none_or(|f| width > f.width) {
                    found = Some(Gap { width, at, surfaces: (self.surface(segment.track), self.surface(part)) });
                }
            }
        }
        found
    }

    /// N712 for edges that became a corner and faces that became an edge, N513 where borders apart became one.
    pub fn report(&self, request: &ShellRequest, slivers: &[PatchId], tolerance: &Tolerance, sink: &mut Vec<Fault>) {
        let parts = &self.joins.parts;
        let gone = |n: &usize| self.joins.pieces.of_track[*n].is_empty() && parts[*n].track.length() > tolerance.point;
        let short: Vec<usize> = (0..parts.len()).filter(gone).collect();
        let length = |n: usize| parts[n].track.length();
        if let Some(longest) = short.iter().copied().max_by(|a, b| length(*a).total_cmp(&length(*b)).then(b.cmp(a))) {
            let of = self.model.origin_of(self.surface(longest));
            let at = parts[longest].track.point(0.5 * length(longest));
            sink.push(GluingFault::EdgeTooShort { of, length: length(longest), at, more: short.len() - 1 }.into());
        }
        if let Some(first) = slivers.first() {
            let surface = self.model.patches[first.index()].surface;
            let around = self.model.loop_of(*first);
            let fault = GluingFault::FaceTooThin { surface: self.model.origin_of(surface), at: around.at(0.5).1, more: slivers.len() - 1 };
            sink.push(fault.into());
        }
        if let Some(gap) = self.widest().filter(|gap| gap.width > tolerance.point) {
            let (a, b) = (self.model.origin_of(gap.surfaces.0), self.model.origin_of(gap.surfaces.1));
            let fault = GluingFault::Glued { shell: request.origin, says: request.snap.map(|s| s.1), a, b, gap: gap.width, at: gap.at };
            sink.push(fault.into());
        }
    }

    /// E711 for two free pieces that run along each other just beyond a stated reach: they were meant to be one.
    pub fn refuse_gaps(&self, request: &ShellRequest, free: &[usize]) -> Result<()> {
        let Some((stated, says)) = request.snap else { return Ok(()) };
        let segments = &self.joins.pieces.segments;
        let mut worst: Option<Gap> = None;
        for (n, a) in free.iter().enumerate() {
            for b in &free[n + 1..] {
                let (a, b) = (&segments[*a], &segments[*b]);
                let (long, short) = if a.length() >= b.length() { (a, b) } else { (b, a) };
                let (here, there) = (self.piece(short.track, short.s), self.piece(long.track, long.s));
                let (width, at) = here.from(&there);
                let along = width <= MISMATCH * stated && width < short.length();
                if along && worst.as_ref().is_none_or(|w| width > w.width) {
                    worst = Some(Gap { width, at, surfaces: (self.surface(a.track), self.surface(b.track)) });
                }
            }
        }
        let Some(gap) = worst else { return Ok(()) };
        let (a, b) = (self.model.origin_of(gap.surfaces.0), self.model.origin_of(gap.surfaces.1));
        Err(GluingFault::EdgeMismatch { a, b, gap: gap.width, at: gap.at, stated: (stated, says) }.into())
    }
}
