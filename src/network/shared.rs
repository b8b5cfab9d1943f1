//! Overlaps of two curves: the same nodes on both, one link, owned by the curve first by name.

use super::assemble::{Parts, Station, Stations, settle};
use super::cluster::Sets;
use super::graph::NetCurve;
use super::hits::{Contact, ranks};
use crate::base::fault::Fault;
use crate::base::tolerance::Tolerance;
use crate::geometry::closest;
use crate::network::fault::GraphFault;

/// Rounds of copying nodes from curve to curve over overlaps; chains of more curves than this are not one run.
const ROUNDS: usize = 16;

/// Which segment owns each segment, and notes about it.
#[derive(Debug, Default)]
pub struct Shared {
    /// First segment of each curve in the list of all; empty when nothing is shared.
    first: Vec<usize>,
    /// Owner of each segment, as curve and place.
    owner: Vec<(u32, u32)>,
    /// One N512 per pair of curves and overlap.
    pub notes: Vec<Fault>,
}

impl Shared {
    /// Whether nothing is shared.
    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Curve and place of the segment that owns segment `i` of curve `k`; itself when it is not shared.
    pub fn owner(&self, k: usize, i: usize) -> (usize, usize) {
        self.first.get(k).map_or((k, i), |first| {
            let (curve, place) = self.owner[first + i];
            (curve as usize, place as usize)
        })
    }
}

/// Gives both curves of every overlap the same nodes, and finds the owner of every segment between nodes.
pub fn match_segments(curves: &[NetCurve], parts: &Parts, stations: &mut Stations) -> Shared {
    let overlaps: Vec<&Contact> = parts.contacts.iter().filter(|c| c.to.is_some()).collect();
    if overlaps.is_empty() {
        return Shared::default();
    }
    for _ in 0..ROUNDS {
        let mut changed = false;
        for overlap in &overlaps {
            changed |= copy_nodes(curves, overlap, 0, stations, parts.tolerance);
            changed |= copy_nodes(curves, overlap, 1, stations, parts.tolerance);
        }
        if !changed {
            break;
        }
    }
    let mut first = Vec::with_capacity(curves.len());
    let mut all: Vec<(u32, u32)> = Vec::new();
    for k in 0..stations.rows.len() {
        let row = stations.rows.row(k);
        first.push(all.len());
        let n = if stations.closed[k] { row.len() } else { row.len() - 1 };
        all.extend((0..n as u32).map(|i| (k as u32, i)));
    }
    let mut sets = Sets::new(all.len());
    for overlap in &overlaps {
        for (i, j) in pairs(curves, overlap, stations, parts.tolerance) {
            sets.join((first[overlap.curves[0] as usize] + i) as u32, (first[overlap.curves[1] as usize] + j) as u32);
        }
    }
    let rank = ranks(curves);
    let roots = sets.roots();
    let mut owner: Vec<(u32, u32)> = all.clone();
    let key = |segment: (u32, u32)| (rank[segment.0 as usize], segment.1);
    for (k, &root) in roots.iter().enumerate() {
        if key(all[k]) < key(owner[root as usize]) {
            owner[root as usize] = all[k];
        }
    }
    let owner: Vec<(u32, u32)> = roots.iter().map(|&root| owner[root as usize]).collect();
    let notes = overlaps.iter().filter_map(|overlap| note(curves, overlap)).collect();
    Shared { first, owner, notes }
}

fn note(curves: &[NetCurve], overlap: &Contact) -> Option<Fault> {
    let (s, to) = *overlap.to.as_deref()?;
    let [owner, other] = overlap.curves.map(|k| curves[k as usize].curve.origin());
    Some(GraphFault::SharedRun { owner, other, run: (overlap.at, to), length: (s[0] - overlap.s[0]).abs() }.into())
}

/// Arc lengths of one side's overlap, ascending.
fn span(overlap: &Contact, side: usize) -> (f64, f64) {
    let end = overlap.to.as_deref().map_or(overlap.s[side], |(s, _)| s[side]);
    (overlap.s[side].min(end), overlap.s[side].max(end))
}

/// Copies the nodes inside an overlap from one side to the other; whether any was new there.
fn copy_nodes(curves: &[NetCurve], overlap: &Contact, from: usize, stations: &mut Stations, tolerance: &Tolerance) -> bool {
    let (a, b) = (overlap.curves[from] as usize, overlap.curves[1 - from] as usize);
    let ((a0, a1), (b0, b1)) = (span(overlap, from), span(overlap, 1 - from));
    let reach = 4.0 * tolerance.point;
    let missing: Vec<u32> = stations
        .rows
        .row(a)
        .iter()
        .filter(|st| st.s > a0 && st.s < a1)
        .filter(|st| !stations.rows.row(b).iter().any(|other| other.node == st.node && other.s >= b0 - reach && other.s <= b1 + reach))
        .map(|st| st.node)
        .collect();
    if missing.is_empty() {
        return false;
    }
    let curve = &curves[b].curve;
    let part = curve.part(curve.param_at_length(b0), curve.param_at_length(b1));
    let mut row = stations.rows.row(b).to_vec();
    for node in missing {
        let near = closest(&part, stations.points[node as usize]);
        row.push(Station { s: b0 + part.length_at(near.t), node });
    }
    settle(curve, curve.length(), &mut row, &stations.points, stations.closed[b], tolerance);
    stations.rows.set(b, row);
    true
}

/// Segments between neighbouring nodes that lie in the shared run on both sides and have the same ends.
fn pairs(curves: &[NetCurve], overlap: &Contact, stations: &Stations, tolerance: &Tolerance) -> Vec<(usize, usize)> {
    let inside = |side: usize| -> Vec<(usize, (u32, u32))> {
        let k = overlap.curves[side] as usize;
        let (row, length) = (stations.rows.row(k), curves[k].curve.length());
        let (lo, hi) = span(overlap, side);
        let reach = 4.0 * tolerance.point;
        let n = if stations.closed[k] { row.len() } else { row.len() - 1 };
        (0..n)
            .filter(|&i| {
                let s0 = row[i].s;
                let s1 = if i + 1 < row.len() { row[i + 1].s } else { row[0].s + length };
                // A segment past the start of a ring lies in a run that ends there only when it is the whole ring.
                [0.0, length].iter().any(|turn| s0 - turn >= lo - reach && s1 - turn <= hi + reach)
            })
            .map(|i| (i, (row[i].node, row[(i + 1) % row.len()].node)))
            .collect()
    };
    let ([first, second], reversed) = ([inside(0), inside(1)], overlap.to.as_deref().is_some_and(|(s, _)| s[1] < overlap.s[1]));
    let mut found = Vec::new();
    for &(i, ends) in &first {
        let wanted = if reversed { (ends.1, ends.0) } else { ends };
        found.extend(second.iter().filter(|&&(_, other)| other == wanted).map(|&(j, _)| (i, j)));
    }
    found
}
