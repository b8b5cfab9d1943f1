//! The pieces of the edges of some surfaces with who uses it: what is free, bent or shared, for showing.

use std::collections::BTreeSet;

use super::topology::{EdgeId, Model, Patch, SurfaceId};
use super::trace::Track;
use crate::base::tolerance::Tolerance;
use crate::network::Network;
use crate::surface::Domain;

/// What a piece of an edge is to the faces around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meeting {
    /// One face only.
    Free,
    /// Two patches of one surface at a kink line.
    Kink,
    /// A surface that closes on itself.
    Seam,
    /// Two surfaces.
    Joined,
    /// Three faces or more.
    Crowded,
}

/// A piece between two junctions.
#[derive(Clone, Debug)]
pub struct EdgePiece {
    /// Its geometry.
    pub track: Track,
    /// Arc lengths on the track where it begins and ends, ascending.
    pub s: (f64, f64),
    /// What it is to the faces around it.
    pub meeting: Meeting,
    /// The surfaces of these faces, in the order of the model.
    pub surfaces: Vec<SurfaceId>,
    /// How far the normal turns across it at most, 0 to a half turn, radians; `None` where not two faces meet, or one has no normal.
    pub turn: Option<f64>,
}

impl Model {
    /// Pieces of the edges of some surfaces; faces of other surfaces do not count.
    ///
    /// One long side against several shorter ones is cut where they end, as in [`Model::shell`]; borders up to `near` apart are
    /// shared.
    pub fn edge_pieces(&self, members: &BTreeSet<SurfaceId>, near: f64, network: &Network, tolerance: &Tolerance) -> Vec<EdgePiece> {
        let joins = self.joins(members, near, network, tolerance);
        let n = joins.pieces.segments.len();
        let mut users: Vec<Vec<SurfaceId>> = vec![Vec::new(); n];
        let mut inside = vec![false; n];
        for (edge, uses) in joins.edges.iter().zip(&joins.pieces.of_track) {
            for (patch, _) in &self.edges[edge.index()].users {
                let patch = &self.patches[patch.index()];
                if members.contains(&patch.surface) {
                    for segment in uses.iter().map(|u| u.segment) {
                        users[segment].push(patch.surface);
                        inside[segment] |= self.is_inside(patch, *edge);
                    }
                }
            }
        }
        let meeting = |segment: usize| match users[segment].as_slice() {
            [_] => Meeting::Free,
            [a, b] if a != b => Meeting::Joined,
            [_, _] if inside[segment] => Meeting::Kink,
            [_, _] => Meeting::Seam,
            _ => Meeting::Crowded,
        };
        let members: Vec<SurfaceId> = members.iter().copied().collect();
        let turns = self.turns_across(&members, &joins);
        let piece = |(k, segment): (usize, &super::segments::Segment)| EdgePiece {
            track: joins.parts[segment.track].track.clone(),
            s: segment.s,
            meeting: meeting(k),
            surfaces: users[k].clone(),
            turn: turns[k],
        };
        joins.pieces.segments.iter().enumerate().filter(|(k, _)| !users[*k].is_empty()).map(piece).collect()
    }

    /// Whether an edge is on a side of its patch that is not a side of the whole surface.
    fn is_inside(&self, patch: &Patch, edge: EdgeId) -> bool {
        let square = self.surfaces[patch.surface.index()].surface.domain() == Domain::Square;
        let ends = [patch.v.0, patch.u.1, patch.v.1, patch.u.0];
        let on = |k: &usize| patch.sides[*k].edges.iter().any(|(e, _)| *e == edge);
        square && (0..patch.sides.len().min(4)).filter(on).any(|k| ends[k] > 0.0 && ends[k] < 1.0)
    }
}
