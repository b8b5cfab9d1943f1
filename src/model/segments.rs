//! Segments of edges: what is left when every edge is cut where a corner of another one lies on it [Yoo & Yoon 2000].
//!
//! One long side may meet several shorter ones (a non-conformal join). The sides keep their own edges; their segments are
//! shared, so that shells know which segments are free and meshes divide each segment once. How near borders must be to be
//! one is said by each of them: the model's tolerance, or what a shell of imported faces allows.

use std::collections::BTreeMap;

use glam::DVec3;

use super::feet::{Index, TrackPart, stations};
use super::gather::{Station, gather};
use super::trace::Track;
use crate::base::job;
use crate::base::math::compare_points;
use crate::base::par;
use crate::base::tolerance::Tolerance;

/// A part of an edge between two neighbouring junctions.
#[derive(Clone, Debug)]
pub struct Segment {
    /// First and last junction.
    pub ends: (usize, usize),
    /// The track that gives its geometry.
    pub track: usize,
    /// Arc lengths on that track, ascending.
    pub s: (f64, f64),
}

crate::content!(Segment { ends, track, s });

impl Segment {
    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.s.1 - self.s.0
    }
}

/// A segment as a part of a track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentUse {
    /// The segment.
    pub segment: usize,
    /// The track runs against it.
    pub against: bool,
    /// Arc lengths on the track that uses it, ascending.
    pub s: (f64, f64),
}

crate::content!(SegmentUse { segment, against, s });

/// All tracks in pieces.
#[derive(Clone, Debug, Default)]
pub struct Segments {
    /// Points where segments end.
    pub junctions: Vec<DVec3>,
    /// The segments.
    pub segments: Vec<Segment>,
    /// Segments of each track from its start to its end; none for a track that is shorter than its reach and became a junction.
    pub of_track: Vec<Vec<SegmentUse>>,
    /// The junction of each anchor, where some track passes or ends there.
    pub of_anchor: Vec<Option<usize>>,
    /// Junction of the start of each track.
    pub starts: Vec<usize>,
}

crate::content!(Segments { junctions, segments, of_track, of_anchor, starts });

/// A track with what its user knows of it.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its geometry.
    pub track: Track,
    /// Arc lengths inside at which it must be cut, ascending.
    pub cuts: Vec<f64>,
    /// Tracks of lower rank give the geometry of segments that several share (0: links).
    pub rank: u8,
    /// How far another track may be and still be the same, model units; of two tracks the smaller one counts.
    pub near: f64,
}

crate::content!(Part { track, cuts, rank, near });

/// Cuts tracks at each other's ends and at anchors that lie on them, and joins the pieces that lie on each other.
///
/// `anchors` are points that give their place to the junctions they hit: vertices, nodes, declared points.
pub fn segments(parts: &[Part], anchors: &[Station], tolerance: &Tolerance) -> Segments {
    let stops = Stops::new(parts, anchors, tolerance);
    let turns = stops.turns(parts);
    if turns.is_empty() {
        return joined(parts, anchors.len(), &stops, tolerance);
    }
    let mut cut = parts.to_vec();
    for (part, s) in turns {
        cut[part].cuts.push(s);
        cut[part].cuts.sort_by(f64::total_cmp);
    }
    joined(&cut, anchors.len(), &Stops::new(&cut, anchors, tolerance), tolerance)
}

/// Where tracks are cut.
struct Stops {
    /// Anchors, then the ends and cuts of each track.
    points: Vec<Station>,
    /// The junction of each point.
    group: Vec<usize>,
    /// Of each track its first point among all.
    first: Vec<usize>,
    /// Arc lengths and junctions of each track, ends included, ascending.
    of_track: Vec<Vec<(f64, usize)>>,
}

impl Stops {
    fn new(parts: &[Part], anchors: &[Station], tolerance: &Tolerance) -> Self {
        let mut points = anchors.to_vec();
        let mut first = Vec::with_capacity(parts.len());
        for part in parts {
            job::poll();
            first.push(points.len());
            let stops = [0.0, part.track.length()].into_iter().chain(part.cuts.iter().copied());
            points.extend(stops.map(|s| Station { point: part.track.point(s), reach: part.near }));
        }
        let group = gather(&points, tolerance.point);
        let index = Index::new(&points, &group);
        let of_track = par::map(parts.len(), |n| stations(&parts[n], (group[first[n]], group[first[n] + 1]), &index));
        Self { points, group, first, of_track }
    }

    /// Tracks with arc lengths at which they turn back along themselves: in the middle of a segment from a junction to the same one
    /// whose halves are the same way there and back. Cut there, the halves are one segment.
    fn turns(&self, parts: &[Part]) -> Vec<(usize, f64)> {
        let of_part = |n: usize| {
            let part = &parts[n];
            let turn = |w: &[(f64, usize)]| {
                let middle = 0.5 * (w[0].0 + w[1].0);
                let half = |s: (f64, f64)| TrackPart { track: &part.track, s };
                let back = w[0].1 == w[1].1 && half((w[0].0, middle)).off(&half((middle, w[1].0)), true).0 <= part.near;
                back.then_some((n, middle))
            };
            self.of_track[n].windows(2).filter_map(turn).collect::<Vec<_>>()
        };
        par::map(parts.len(), of_part).into_iter().flatten().collect()
    }
}

/// The pieces of tracks between their stops, those that lie on each other as one; the first points are `anchors`.
fn joined(parts: &[Part], anchors: usize, stops: &Stops, tolerance: &Tolerance) -> Segments {
    let group = &stops.group;
    let mut result = Segments { junctions: places(&stops.points, group, anchors), ..Segments::default() };
    result.starts = stops.first.iter().map(|n| group[*n]).collect();
    result.of_track = vec![Vec::new(); parts.len()];
    Joiner { parts, result: &mut result, same: BTreeMap::new(), point: tolerance.point }.join(&stops.of_track);
    let mut used = vec![false; result.junctions.len()];
    for segment in &result.segments {
        used[segment.ends.0] = true;
        used[segment.ends.1] = true;
    }
    result.of_anchor = group[..anchors].iter().map(|g| used[*g].then_some(*g)).collect();
    result
}

/// Where each junction is: its first anchor in the order of coordinates, else its first point.
fn places(points: &[Station], group: &[usize], anchors: usize) -> Vec<DVec3> {
    let count = group.iter().max().map_or(0, |most| most + 1);
    let mut best: Vec<Option<(bool, DVec3)>> = vec![None; count];
    for (n, station) in points.iter().enumerate() {
        let here = (n >= anchors, station.point);
        let slot = &mut best[group[n]];
        if slot.is_none_or(|old| here.0.cmp(&old.0).then(compare_points(here.1, old.1)).is_lt()) {
            *slot = Some(here);
        }
    }
    best.into_iter().map(|b| b.map_or(DVec3::ZERO, |b| b.1)).collect()
}

/// Pieces found so far, by their pair of junctions.
struct Joiner<'a> {
    parts: &'a [Part],
    result: &'a mut Segments,
    same: BTreeMap<(usize, usize), Vec<usize>>,
    point: f64,
}

/// A piece of a track before it is known what it is.
struct Raw {
    part: usize,
    ends: (usize, usize),
    s: (f64, f64),
}

impl Joiner<'_> {
    fn join(mut self, stations: &[Vec<(f64, usize)>]) {
        let mut raw = Vec::new();
        for (part, stops) in stations.iter().enumerate() {
            for w in stops.windows(2) {
                job::poll();
                raw.push(Raw { part, ends: (w[0].1, w[1].1), s: (w[0].0, w[1].0) });
            }
        }
        raw.sort_by_key(|r| (self.parts[r.part].rank, r.part));
        for piece in &raw {
            let (segment, against) = self.find(piece).unwrap_or_else(|| self.add(piece));
            self.result.of_track[piece.part].push(SegmentUse { segment, against, s: piece.s });
        }
        self.settle();
    }

    /// Where borders are further apart than the tolerance, the one whose middle comes first in the order of coordinates gives
    /// the geometry: the mesh does not depend on the order in which faces are listed.
    fn settle(&mut self) {
        let rank = |parts: &[Part], part: usize| parts[part].rank;
        let middle = |part: usize, s: (f64, f64)| self.parts[part].track.point(0.5 * (s.0 + s.1));
        let mut turned = vec![false; self.result.segments.len()];
        for (part, uses) in self.result.of_track.iter().enumerate().filter(|(part, _)| self.parts[*part].near > self.point) {
            for u in uses {
                let segment = &mut self.result.segments[u.segment];
                let better = rank(self.parts, part).cmp(&rank(self.parts, segment.track));
                if better.then(compare_points(middle(part, u.s), middle(segment.track, segment.s))).is_lt() {
                    (segment.track, segment.s) = (part, u.s);
                    turned[u.segment] = u.against;
                }
            }
        }
        for (segment, _) in self.result.segments.iter_mut().zip(&turned).filter(|(_, turned)| **turned) {
            segment.ends = (segment.ends.1, segment.ends.0);
        }
        self.result.of_track.iter_mut().flatten().for_each(|u| u.against ^= turned[u.segment]);
    }

    fn add(&mut self, raw: &Raw) -> (usize, bool) {
        self.result.segments.push(Segment { ends: raw.ends, track: raw.part, s: raw.s });
        let segment = self.result.segments.len() - 1;
        self.same.entry((raw.ends.0.min(raw.ends.1), raw.ends.0.max(raw.ends.1))).or_default().push(segment);
        (segment, false)
    }

    /// The segment that a piece lies on, with whether it runs against it.
    fn find(&self, raw: &Raw) -> Option<(usize, bool)> {
        let here = TrackPart { track: &self.parts[raw.part].track, s: raw.s };
        let known = self.same.get(&(raw.ends.0.min(raw.ends.1), raw.ends.0.max(raw.ends.1)))?;
        known.iter().find_map(|id| {
            let segment = &self.result.segments[*id];
            let there = TrackPart { track: &self.parts[segment.track].track, s: segment.s };
            let near = self.parts[raw.part].near.min(self.parts[segment.track].near);
            let against = if raw.ends.0 == raw.ends.1 { here.ring_against(&there) } else { raw.ends != segment.ends };
            (here.off(&there, against).0 <= near).then_some((*id, against))
        })
    }
}
