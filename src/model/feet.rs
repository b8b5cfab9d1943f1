//! Where points of other borders lie on a track: the places at which it is cut.

use glam::DVec3;

use super::gather::Station;
use super::segments::Part;
use super::trace::Track;
use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::job;

/// Samples of a track for finding points on it; its spacing bounds how far a near point is from a sample.
const SAMPLES: usize = 32;
/// Largest ratio of the length of a track to the distance of its ends for which it is nearly straight: a loop of what is left over is
/// shorter than the spacing of the samples, which would not show it either.
const NEARLY_STRAIGHT: f64 = 1.0 + 0.5 / SAMPLES as f64;
/// Projections before a foot point is taken as it is.
const ROUNDS: usize = 20;
/// Visits of one point nearer than this many reaches along the track are one.
const ONE_VISIT: f64 = 4.0;
/// Places of a piece at which another one must lie on it.
const PROBES: usize = 7;

/// Characteristic points of all borders, each with the junction it became, to be asked by place.
pub struct Index<'a> {
    points: &'a [Station],
    junctions: &'a [usize],
    tree: BoxTree,
}

impl<'a> Index<'a> {
    /// Junctions by point.
    pub fn new(points: &'a [Station], junctions: &'a [usize]) -> Self {
        let boxes: Vec<Box3> = points.iter().map(|p| Box3::of([p.point])).collect();
        Self { points, junctions, tree: BoxTree::build(&boxes) }
    }
}

/// A foot of a characteristic point: arc length, junction, distance.
type Foot = (f64, usize, f64);

/// Arc lengths and junctions at which a track is cut, ends included, ascending. `ends` are the junctions of its ends.
/// Empty for a track that is no longer than its reach and ends where it starts.
pub fn stations(part: &Part, ends: (usize, usize), index: &Index) -> Vec<(f64, usize)> {
    let length = part.track.length();
    if ends.0 != ends.1 && is_met_at_ends_only(part, index) {
        return vec![(0.0, ends.0), (length, ends.1)];
    }
    let mut at: Vec<f64> = (0..=SAMPLES).map(|k| length * k as f64 / SAMPLES as f64).chain(part.cuts.iter().copied()).collect();
    at.sort_by(f64::total_cmp);
    let samples: Vec<(f64, DVec3)> = at.into_iter().map(|s| (s, part.track.point(s))).collect();
    // No point of the track is farther from a sample than half the spacing.
    let reach = 0.5 * length / SAMPLES as f64 + part.near;
    let mut found: Vec<Foot> = vec![(0.0, ends.0, 0.0), (length, ends.1, 0.0)];
    let mut near = Vec::new();
    index.tree.query(&Box3::of(samples.iter().map(|(_, p)| *p)), reach, |n| near.push(n));
    near.sort_unstable();
    for n in near {
        job::poll();
        let point = index.points[n];
        for (s, distance) in feet(&part.track, &samples, point.point, reach) {
            let allowed = part.near.min(point.reach);
            if s > part.near && s < length - part.near && distance <= allowed {
                found.push((s, index.junctions[n], distance));
            }
        }
    }
    // A track that stays where it starts is no border of anything.
    if ends.0 == ends.1 && length <= ONE_VISIT * part.near { Vec::new() } else { visits(found, ONE_VISIT * part.near) }
}

/// Whether no point but those at its own ends is within reach of a track, found without looking along it: a curve of length L whose
/// ends are c apart stays in the ellipsoid about them with the half axes L / 2 and √(L² − c²) / 2. Nearly straight tracks only.
fn is_met_at_ends_only(part: &Part, index: &Index) -> bool {
    let length = part.track.length();
    let ends = [part.track.point(0.0), part.track.point(length)];
    let apart = ends[0].distance(ends[1]);
    if length > NEARLY_STRAIGHT * apart {
        return false;
    }
    let aside = 0.5 * (length * length - apart * apart).max(0.0).sqrt();
    let mut only = true;
    index.tree.query(&Box3::of(ends), aside + part.near, |n| {
        only = only && ends.iter().any(|end| end.distance(index.points[n].point) <= part.near);
    });
    only
}

/// One station for each visit of a junction: where a point of it comes nearest, an end before all.
fn visits(mut found: Vec<Foot>, apart: f64) -> Vec<(f64, usize)> {
    found.sort_by(|a, b| a.1.cmp(&b.1).then(a.0.total_cmp(&b.0)));
    let mut stations: Vec<(f64, usize)> = Vec::new();
    for visit in found.chunk_by(|a, b| a.1 == b.1 && b.0 - a.0 <= apart) {
        stations.extend(visit.iter().min_by(|a, b| a.2.total_cmp(&b.2).then(a.0.total_cmp(&b.0))).map(|best| (best.0, best.1)));
    }
    stations.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    stations
}

/// Arc lengths at which a track passes a point, with the distances; some of one passage several times.
fn feet(track: &Track, samples: &[(f64, DVec3)], point: DVec3, reach: f64) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for w in samples.windows(2) {
        let ((a, pa), (b, pb)) = (w[0], w[1]);
        if pa.distance(point) > reach && pb.distance(point) > reach {
            continue;
        }
        let s = nearest(track, point, 0.5 * (a + b), (a - (b - a), b + (b - a)));
        found.push((s, track.point(s).distance(point)));
    }
    found
}

/// The place near a start where a track passes nearest to a point, by projection on the tangent, held in a range.
///
/// Converges fast where the point is much nearer than the track's radius, which is all that is asked; elsewhere the caller
/// finds it too far.
pub fn nearest(track: &Track, point: DVec3, start: f64, range: (f64, f64)) -> f64 {
    let mut s = start;
    for _ in 0..ROUNDS {
        let (p, tangent) = track.jet(s);
        let next = (s + (point - p).dot(tangent)).clamp(range.0, range.1);
        if next == s {
            break;
        }
        s = next;
    }
    s
}

/// A part of a track.
#[derive(Clone, Copy)]
pub struct TrackPart<'a> {
    /// The track.
    pub track: &'a Track,
    /// Arc lengths on it, ascending.
    pub s: (f64, f64),
}

impl TrackPart<'_> {
    /// Point at a share 0…1 of its length.
    pub fn point(&self, f: f64) -> DVec3 {
        self.track.point(self.s.0 + (self.s.1 - self.s.0) * f)
    }

    /// Share of the foot of a point that lies about at a share, and its distance.
    fn foot(&self, p: DVec3, about: f64) -> (f64, f64) {
        let length = self.s.1 - self.s.0;
        let s = nearest(self.track, p, self.s.0 + length * about, self.s);
        ((s - self.s.0) / length, self.track.point(s).distance(p))
    }

    /// The same for a point about which nothing is known: from the nearest of some samples.
    fn foot_anywhere(&self, p: DVec3) -> (f64, f64) {
        let shares = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64);
        let best = shares.min_by(|a, b| self.point(*a).distance_squared(p).total_cmp(&self.point(*b).distance_squared(p)));
        self.foot(p, best.unwrap_or(0.5))
    }

    /// Largest distance of some of its inner points from another piece with the same ends, with the place; `against`: the
    /// other one runs the other way.
    pub fn off(&self, other: &Self, against: bool) -> (f64, DVec3) {
        let mut worst = (0.0, self.point(0.5));
        for k in 1..=PROBES {
            let f = k as f64 / (PROBES + 1) as f64;
            let p = self.point(f);
            let about = other.foot(p, if against { 1.0 - f } else { f });
            let distance = about.1.min(if about.1 > worst.0 { other.foot_anywhere(p).1 } else { about.1 });
            if distance > worst.0 {
                worst = (distance, p);
            }
        }
        worst
    }

    /// Largest distance of its points, ends included, from another piece wherever on that they lie, with the place.
    pub fn from(&self, other: &Self) -> (f64, DVec3) {
        let places = (0..=PROBES + 1).map(|k| self.point(k as f64 / (PROBES + 1) as f64));
        let off = places.map(|p| (other.foot_anywhere(p).1, p));
        off.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, self.point(0.5)))
    }

    /// Whether a ring runs against another one through the same junction.
    pub fn ring_against(&self, other: &Self) -> bool {
        other.foot_anywhere(self.point(0.25)).0 > 0.5
    }
}
