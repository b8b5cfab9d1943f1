//! Edges of one model in another one that holds some of the same surfaces, perhaps cut along further lines.

use super::shared::{Course, EdgePart};
use super::topology::{EdgeId, Model, Patch, PatchId, SurfaceId};
use crate::network::Network;
use crate::surface::Domain;

/// A model with the network that its edges run along.
#[derive(Clone, Copy)]
pub struct Stage<'a> {
    /// The model.
    pub model: &'a Model,
    /// The network.
    pub network: &'a Network,
}

impl Model {
    /// What an edge, given by its courses, is in another model: a course for each border that runs there; `place` gives the
    /// surfaces of `to`. Empty where `to` holds none of its faces.
    pub fn carried(&self, network: &Network, courses: &[Course], to: Stage, place: &dyn Fn(SurfaceId) -> Option<SurfaceId>) -> Vec<Course> {
        let mut found: Vec<Course> = Vec::new();
        for course in courses {
            let along: Vec<Vec<Course>> = course.iter().map(|part| self.part_in(network, part, to, place)).collect();
            // A border of several parts is there where each of them is.
            let most = along.iter().map(Vec::len).max().unwrap_or(0);
            for k in 0..most {
                let whole: Course = along.iter().flat_map(|ways| ways.get(k).or(ways.first()).cloned().unwrap_or_default()).collect();
                if !whole.is_empty() && !found.contains(&whole) {
                    found.push(whole);
                }
            }
        }
        found
    }

    /// A part of an edge in another model, a course for each face on it.
    fn part_in(&self, network: &Network, part: &EdgePart, to: Stage, place: &dyn Fn(SurfaceId) -> Option<SurfaceId>) -> Vec<Course> {
        let mut found: Vec<Course> = Vec::new();
        for (patch, _) in &self.edges[part.edge.index()].users {
            let Some(surface) = place(self.patches[patch.index()].surface) else { continue };
            let edges = self.edges_in(part.edge, *patch, to.model, surface);
            let mut course = self.clipped(network, part, &edges, to);
            if part.against {
                course.reverse();
                course.iter_mut().for_each(|p| p.against = !p.against);
            }
            if !course.is_empty() && !found.contains(&course) {
                found.push(course);
            }
        }
        found
    }

    /// The edges of `to` that lie on the sides of a patch that an edge lies on.
    fn edges_in(&self, edge: EdgeId, patch: PatchId, to: &Model, surface: SurfaceId) -> Vec<EdgeId> {
        let record = &self.patches[patch.index()];
        let square = self.surfaces[record.surface.index()].surface.domain() == Domain::Square;
        let inside = |x: (f64, f64), range: (f64, f64)| range.0 <= 0.5 * (x.0 + x.1) && 0.5 * (x.0 + x.1) <= range.1;
        let pieces = || to.patches_of(surface).map(|p| &to.patches[p.index()]).filter(|p| inside(p.u, record.u) && inside(p.v, record.v));
        let mut edges = Vec::new();
        for (k, side) in record.sides.iter().enumerate() {
            for n in (0..side.edges.len()).filter(|n| side.edges[*n].0 == edge) {
                for piece in pieces() {
                    let Some(there) = piece.sides.get(k) else { continue };
                    if !square {
                        edges.extend(there.edges.get(n).map(|e| e.0));
                    } else if end(record, k) == end(piece, k) {
                        edges.extend(there.edges.iter().map(|e| e.0));
                    }
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// What of some edges that make up another one lies in a part of it, in its direction.
    fn clipped(&self, network: &Network, part: &EdgePart, edges: &[EdgeId], to: Stage) -> Course {
        let old = self.track(part.edge, network);
        let mut placed: Vec<(f64, f64, EdgePart)> = Vec::new();
        for edge in edges {
            let track = to.model.track(*edge, to.network);
            let [a, middle, b] = [0.25, 0.5, 0.75].map(|f| old.closest(track.point(f * track.length()), (0.0, old.length())).0);
            let length = track.length();
            // Over the start of a ring the stations leap.
            let against = if (a < middle) == (middle < b) { b < a } else { (a < middle) == (b < a) && a > middle };
            let middle = if edges.len() == 1 { 0.5 * old.length() } else { middle };
            placed.push((middle - 0.5 * length, middle + 0.5 * length, EdgePart { edge: *edge, s: (0.0, length), against }));
        }
        placed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let whole = part.s.0 == 0.0 && part.s.1 == self.edges[part.edge.index()].length;
        let cut = |(low, high, own): &(f64, f64, EdgePart)| {
            if whole {
                return Some(*own);
            }
            let (from, upto) = (part.s.0.max(*low) - low, part.s.1.min(*high) - low);
            let s = if own.against { (high - low - upto, high - low - from) } else { (from, upto) };
            (s.1 > s.0).then_some(EdgePart { s, ..*own })
        };
        placed.iter().filter_map(cut).collect()
    }
}

/// The parameter that stays along a side of a patch.
fn end(patch: &Patch, side: usize) -> f64 {
    match side {
        0 => patch.v.0,
        1 => patch.u.1,
        2 => patch.v.1,
        _ => patch.u.0,
    }
}
