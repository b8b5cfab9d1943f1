//! Atoms of edges: what is left when every edge is cut where a corner of another one lies on it.
//!
//! One long side may meet several shorter ones (a non-conformal join). The sides keep their own edges; their atoms are
//! shared, so that shells know which stretches are free and meshes divide each stretch once.

use std::collections::BTreeMap;

use glam::DVec3;

use super::glue::{cluster, same_run};
use super::trace::Track;
use crate::base::bbox::Box3;
use crate::base::par;
use crate::base::tolerance::Tolerance;

/// Samples of a track for finding points on it; its spacing bounds how far a near point is from a sample.
const SAMPLES: usize = 32;
/// Projections before a foot point is taken as it is.
const ROUNDS: usize = 20;

/// A stretch between two neighbouring junctions.
#[derive(Clone, Debug)]
pub struct Atom {
    /// First and last junction.
    pub ends: (usize, usize),
    /// The track that gives its geometry.
    pub track: usize,
    /// Arc lengths on that track, ascending.
    pub s: (f64, f64),
}

crate::content!(Atom { ends, track, s });

impl Atom {
    /// Arc length, model units.
    pub fn length(&self) -> f64 {
        self.s.1 - self.s.0
    }
}

/// An atom as a part of a track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Use {
    /// The atom.
    pub atom: usize,
    /// The track runs against it.
    pub against: bool,
    /// Arc lengths on the track that uses it, ascending.
    pub s: (f64, f64),
}

crate::content!(Use { atom, against, s });

/// All tracks in pieces.
#[derive(Clone, Debug, Default)]
pub struct Atoms {
    /// Points where atoms end.
    pub junctions: Vec<DVec3>,
    /// The atoms.
    pub atoms: Vec<Atom>,
    /// Atoms of each track from its start to its end.
    pub of_track: Vec<Vec<Use>>,
    /// The junction of each anchor, where some track passes or ends there.
    pub of_anchor: Vec<Option<usize>>,
}

crate::content!(Atoms { junctions, atoms, of_track, of_anchor });

/// A track with what its user knows of it.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its geometry.
    pub track: Track,
    /// Arc lengths inside at which it must be cut, ascending.
    pub cuts: Vec<f64>,
    /// Tracks of lower rank give the geometry of atoms that several share (0: links).
    pub rank: u8,
}

crate::content!(Part { track, cuts, rank });

/// An atom with its probes.
type Known = (usize, [DVec3; 3]);

/// Cuts tracks at each other's ends and at anchors that lie on them, and joins the pieces that lie on each other.
///
/// `anchors` are points that give their place to the junctions they hit: vertices, nodes, declared points.
pub fn atoms(parts: &[Part], anchors: &[DVec3], tolerance: &Tolerance) -> Atoms {
    let mut points = anchors.to_vec();
    for part in parts {
        points.push(part.track.point(0.0));
        points.push(part.track.point(part.track.length()));
        points.extend(part.cuts.iter().map(|s| part.track.point(*s)));
    }
    let (group, mut junctions) = cluster(&points, tolerance);
    let mut named = vec![false; junctions.len()];
    for (n, point) in anchors.iter().enumerate() {
        if !std::mem::replace(&mut named[group[n]], true) {
            junctions[group[n]] = *point;
        }
    }
    let stations = par::map(parts.len(), |n| stations(&parts[n], &junctions, tolerance));
    let mut result = Atoms { junctions, ..Atoms::default() };
    let mut known: BTreeMap<(usize, usize), Vec<Known>> = BTreeMap::new();
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by_key(|n| (parts[*n].rank, *n));
    result.of_track = vec![Vec::new(); parts.len()];
    for n in order {
        for w in stations[n].windows(2) {
            let ((s0, a), (s1, b)) = (w[0], w[1]);
            let probes = [0.25, 0.5, 0.75].map(|f| parts[n].track.point(s0 + (s1 - s0) * f));
            let same = known.entry((a.min(b), a.max(b))).or_default();
            let found = same.iter().find_map(|(id, other)| same_run(other, &probes, tolerance).map(|against| (*id, against)));
            let (atom, against) = found.unwrap_or_else(|| {
                result.atoms.push(Atom { ends: (a, b), track: n, s: (s0, s1) });
                same.push((result.atoms.len() - 1, probes));
                (result.atoms.len() - 1, false)
            });
            result.of_track[n].push(Use { atom, against, s: (s0, s1) });
        }
    }
    let mut used = vec![false; result.junctions.len()];
    for atom in &result.atoms {
        used[atom.ends.0] = true;
        used[atom.ends.1] = true;
    }
    result.of_anchor = group[..anchors.len()].iter().map(|g| used[*g].then_some(*g)).collect();
    result
}

/// Arc lengths and junctions at which a track is cut, ends included, ascending.
fn stations(part: &Part, junctions: &[DVec3], tolerance: &Tolerance) -> Vec<(f64, usize)> {
    let length = part.track.length();
    let samples: Vec<(f64, DVec3)> = {
        let mut at: Vec<f64> = (0..=SAMPLES).map(|k| length * k as f64 / SAMPLES as f64).chain(part.cuts.iter().copied()).collect();
        at.sort_by(f64::total_cmp);
        at.into_iter().map(|s| (s, part.track.point(s))).collect()
    };
    // No point of the track is farther from a sample than half the spacing.
    let reach = 0.5 * length / SAMPLES as f64 + tolerance.point;
    let around = Box3::of(samples.iter().map(|(_, p)| *p));
    let mut found: Vec<(f64, usize)> = Vec::new();
    for (junction, point) in junctions.iter().enumerate() {
        if !around.touches(&Box3::of([*point]), reach) {
            continue;
        }
        for s in feet(&part.track, &samples, *point, reach, tolerance) {
            found.push((s, junction));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // Near its ends and near itself a track meets one junction many times over.
    let mut stations: Vec<(f64, usize)> = Vec::new();
    for (s, junction) in found {
        match stations.last() {
            Some((_, last)) if *last == junction && !leaves(stations[stations.len() - 1].0, s, tolerance) => {}
            _ => stations.push((s, junction)),
        }
    }
    if let Some(first) = stations.first_mut() {
        first.0 = 0.0;
    }
    if let Some(last) = stations.last_mut() {
        last.0 = length;
    }
    stations
}

/// Whether the track goes away and comes back between two visits of one point.
fn leaves(a: f64, b: f64, tolerance: &Tolerance) -> bool {
    b - a > 4.0 * tolerance.point
}

/// Arc lengths at which a track passes a point within tolerance.
fn feet(track: &Track, samples: &[(f64, DVec3)], point: DVec3, reach: f64, tolerance: &Tolerance) -> Vec<f64> {
    let length = track.length();
    let mut found = Vec::new();
    let ends = [(0.0, samples[0].1), (length, samples[samples.len() - 1].1)];
    found.extend(ends.iter().filter(|(_, p)| tolerance.same_point(*p, point)).map(|(s, _)| *s));
    for w in samples.windows(2) {
        let ((a, pa), (b, pb)) = (w[0], w[1]);
        if pa.distance(point) > reach && pb.distance(point) > reach {
            continue;
        }
        let s = nearest(track, point, a, b);
        let inside = s > tolerance.point && s < length - tolerance.point;
        if inside && tolerance.same_point(track.point(s), point) {
            found.push(s);
        }
    }
    found
}

/// The place near a start where a track passes nearest to a point, by projection on the tangent.
///
/// Converges fast where the point lies on the track, which is all that is asked; elsewhere the caller finds it too far.
fn nearest(track: &Track, point: DVec3, a: f64, b: f64) -> f64 {
    let slack = b - a;
    let mut s = 0.5 * (a + b);
    for _ in 0..ROUNDS {
        let (p, tangent) = track.jet(s);
        let next = (s + (point - p).dot(tangent)).clamp(a - slack, b + slack);
        if next == s {
            break;
        }
        s = next;
    }
    s
}
