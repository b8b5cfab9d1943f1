//! How faces join along the edges they share: gap, angle of the normals, jump of the curvature across.
//!
//! Each segment that two faces share is sampled in equal steps along the first face's own border, at least 200 and 20 a
//! span; round the least and the largest value found the samples are refined. So a bump narrower than a step may be missed.

use std::collections::BTreeSet;

use glam::DVec3;

use super::loops::Loop;
use super::nearest::down;
use super::shells::Joins;
use super::topology::{EdgeId, Model, Patch, PatchId, SurfaceId};
use crate::base::math::angle_between;
use crate::base::par;
use crate::base::solve::lowest;
use crate::base::tolerance::{NEAREST, PARALLEL, Tolerance};
use crate::network::Network;
use crate::surface::{Jet2, OneSided, Surface};

/// Steps of a segment, at the least.
const STEPS: usize = 200;
/// Steps of each span of it, at the least.
const STEPS_A_SPAN: usize = 20;
/// Steps of a segment that is shown.
const SEEN: usize = 24;
/// Projections before a foot point is taken as it is.
const ROUNDS: usize = 20;

/// Values met along a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The least.
    pub min: f64,
    /// The largest.
    pub max: f64,
    /// The mean by arc length.
    pub mean: f64,
    /// Where the largest is.
    pub at: DVec3,
}

/// A segment of border that two faces share.
#[derive(Clone, Debug)]
pub struct Contact {
    /// The faces; the same one twice at a seam.
    pub faces: (PatchId, PatchId),
    /// The edge of the first face; the second one's may be another where a long side meets several shorter ones.
    pub edges: (EdgeId, EdgeId),
    /// Arc length, model units.
    pub length: f64,
    /// Halfway along it.
    pub middle: DVec3,
    /// Distance of the first face's border from the second one's, model units.
    pub gap: Spread,
    /// Angle between the normals of the faces, whatever their sides, 0 to a right angle, radians; `None` where a face has
    /// no normal anywhere on the segment.
    pub angle: Option<Spread>,
    /// Size of the difference of the curvatures of the faces across the segment, both seen from one side, 1/model units; `None` where a
    /// face has none anywhere on the segment.
    pub curvature: Option<Spread>,
}

/// A face's side of a segment: a part of a piece of its loop.
struct SegmentSide<'a> {
    surface: &'a Surface,
    patch: &'a Patch,
    face: PatchId,
    /// The place of the face among those asked for.
    rank: usize,
    edge: EdgeId,
    around: &'a Loop,
    piece: usize,
    /// Arc lengths on the piece at the segment's start and end.
    ends: (f64, f64),
}

impl SegmentSide<'_> {
    /// Arc length on the piece at a share of the segment.
    fn station(&self, f: f64) -> f64 {
        self.ends.0 + (self.ends.1 - self.ends.0) * f
    }

    fn jet(&self, s: f64) -> BorderJet {
        self.around.pieces[self.piece].at(s)
    }

    /// Arc length of the nearest point of the border near a place.
    fn foot(&self, p: DVec3, near: f64) -> f64 {
        foot(|s| self.jet(s), p, near, (self.ends.0.min(self.ends.1), self.ends.0.max(self.ends.1))).0
    }

    /// Point and derivatives of the face at (u, v) on its border, from inside.
    fn inside(&self, (u, v): (f64, f64)) -> Jet2 {
        let lean = |x: f64, (low, high): (f64, f64)| if x - low > high - x { OneSided::Before } else { OneSided::After };
        self.surface.jet_one_sided(u, v, (lean(u, self.patch.u), lean(v, self.patch.v)))
    }

    /// The face's unit normal at (u, v) on its border, from inside.
    fn normal(&self, uv: (f64, f64)) -> DVec3 {
        self.surface.normal_of(&self.inside(uv), uv)
    }

    /// Spans of the surface along the segment.
    fn spans(&self) -> usize {
        let ((a, _, _), (b, _, _)) = (self.jet(self.ends.0), self.jet(self.ends.1));
        let (us, vs) = self.surface.breaks();
        let inside = |list: &[f64], a: f64, b: f64| list.iter().filter(|x| (**x - a) * (**x - b) < 0.0).count();
        1 + inside(&us, a.0, b.0) + inside(&vs, a.1, b.1)
    }
}

impl Model {
    /// Segments that faces of some surfaces share; those for which `wanted` holds, which is given both faces and edges. Borders up to
    /// `near` apart are shared. They come by the first of their faces, in the order of the list, then along its border; where
    /// more than two faces meet, each two of them have one.
    pub fn contacts(
        &self,
        members: &[SurfaceId],
        near: f64,
        network: &Network,
        tolerance: &Tolerance,
        wanted: impl Fn((PatchId, EdgeId), (PatchId, EdgeId)) -> bool + Sync + Send,
    ) -> Vec<Contact> {
        let joins = self.joins(&members.iter().copied().collect(), near, network, tolerance);
        let one =
            |a: &SegmentSide, b: &SegmentSide, segment| wanted((a.face, a.edge), (b.face, b.edge)).then(|| contact(a, b, &joins, segment));
        self.across(members, &joins, one)
    }

    /// How far the normal turns at most across each segment that two faces share, 0 to a half turn, radians, whatever the sides
    /// of their surfaces: an edge of each with where on it the middle of the segment is. Otherwise as [`Model::contacts`].
    pub fn turns(&self, members: &[SurfaceId], near: f64, network: &Network, tolerance: &Tolerance) -> Vec<Turn> {
        let joins = self.joins(&members.iter().copied().collect(), near, network, tolerance);
        let one = |a: &SegmentSide, b: &SegmentSide, segment| {
            most_turn(a, b, STEPS.max(STEPS_A_SPAN * a.spans().max(b.spans()))).map(|turn| {
                let place =
                    joins.edges.binary_search(&a.edge).ok().and_then(|k| joins.pieces.of_track[k].iter().find(|u| u.segment == segment));
                Turn { edge: a.edge, s: place.map_or(0.0, |u| 0.5 * (u.s.0 + u.s.1)), turn }
            })
        };
        self.across(members, &joins, one)
    }

    /// What is found of each segment that two faces share, given by their borders and its number, in the order of [`pairs_in_order`].
    fn across<T: Send>(
        &self,
        members: &[SurfaceId],
        joins: &Joins,
        one: impl Fn(&SegmentSide, &SegmentSide, usize) -> Option<T> + Sync + Send,
    ) -> Vec<T> {
        let faces = self.faces_of(members);
        let loops = par::map(faces.len(), |n| self.loop_of(faces[n]));
        let borders = self.borders(&faces, &loops, joins);
        let pairs = pairs_in_order(&borders);
        let found = par::map(pairs.len(), |n| {
            let (segment, a, b) = pairs[n];
            one(&borders[segment][a], &borders[segment][b], segment)
        });
        found.into_iter().flatten().collect()
    }

    /// The largest turn of the normal across each of the joined segments at a few places, otherwise as in [`Model::turns`]; `None` where
    /// not two faces meet, or one has no normal.
    pub(super) fn turns_across(&self, members: &[SurfaceId], joins: &Joins) -> Vec<Option<f64>> {
        let faces = self.faces_of(members);
        let loops = par::map(faces.len(), |n| self.loop_of(faces[n]));
        let borders = self.borders(&faces, &loops, joins);
        par::map(borders.len(), |segment| match borders[segment].as_slice() {
            [a, b] => most_turn(a, b, SEEN),
            _ => None,
        })
    }

    /// Patches of some surfaces, in the order of the list, each once.
    fn faces_of(&self, members: &[SurfaceId]) -> Vec<PatchId> {
        let mut seen = BTreeSet::new();
        members.iter().filter(|s| seen.insert(**s)).flat_map(|s| self.patches_of(*s)).collect()
    }

    /// The borders on each segment.
    fn borders<'a>(&'a self, faces: &[PatchId], loops: &'a [Loop], joins: &Joins) -> Vec<Vec<SegmentSide<'a>>> {
        let mut borders: Vec<Vec<SegmentSide>> = joins.pieces.segments.iter().map(|_| Vec::new()).collect();
        for (rank, (face, around)) in faces.iter().zip(loops).enumerate() {
            let patch = &self.patches[face.index()];
            let surface = &self.surfaces[patch.surface.index()].surface;
            for (piece, entry) in around.pieces.iter().enumerate() {
                let Some((edge, against)) = entry.edge else { continue };
                let Ok(place) = joins.edges.binary_search(&edge) else { continue };
                let share = entry.length() / joins.parts[place].track.length();
                for part in &joins.pieces.of_track[place] {
                    let on = |s: f64| if against { entry.length() - s * share } else { s * share };
                    let ends = if part.against { (on(part.s.1), on(part.s.0)) } else { (on(part.s.0), on(part.s.1)) };
                    borders[part.segment].push(SegmentSide { surface, patch, face: *face, rank, edge, around, piece, ends });
                }
            }
        }
        borders
    }
}

/// How far the normal turns across a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// An edge that it is a part of.
    pub edge: EdgeId,
    /// Arc length on that edge at the middle of the segment, model units.
    pub s: f64,
    /// The largest angle, 0 to a half turn, radians.
    pub turn: f64,
}

/// Each two borders on one segment, with the segment: by the first one's face, then along its border.
fn pairs_in_order(borders: &[Vec<SegmentSide>]) -> Vec<(usize, usize, usize)> {
    let of_segment = |segment: usize| {
        let count = borders[segment].len();
        (0..count).flat_map(move |a| (a + 1..count).map(move |b| (segment, a, b)))
    };
    let mut order: Vec<(usize, usize, usize)> = (0..borders.len()).flat_map(of_segment).collect();
    let key = |(segment, a, _): &(usize, usize, usize)| {
        (borders[*segment][*a].rank, borders[*segment][*a].piece, borders[*segment][*a].station(0.5))
    };
    order.sort_by(|a, b| {
        let (a, b) = (key(a), key(b));
        (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
    });
    order
}

/// The largest turn of the normal from one face to the other along a segment; `None` where one has no normal anywhere.
fn most_turn(a: &SegmentSide, b: &SegmentSide, steps: usize) -> Option<f64> {
    // Faces of one side run along a segment in opposite senses.
    let turned = (a.ends.0 < a.ends.1) == (b.ends.0 < b.ends.1);
    let at = |k: usize| {
        let f = k as f64 / steps as f64;
        let (uv, p, _) = a.jet(a.station(f));
        let (m, n) = (a.normal(uv), b.normal(b.jet(b.foot(p, b.station(f))).0));
        let defined = m != DVec3::ZERO && n != DVec3::ZERO;
        defined.then(|| angle_between(m, if turned { -n } else { n }))
    };
    (0..=steps).filter_map(at).reduce(f64::max)
}

/// Two borders that do not touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// The surfaces.
    pub surfaces: (SurfaceId, SurfaceId),
    /// Smallest distance found, model units.
    pub gap: f64,
    /// Where that is, on the second surface.
    pub at: DVec3,
}

impl Model {
    /// Where borders of some surfaces come nearest to those of others, from samples and projections: the distance is never
    /// below the true one. `None` without borders.
    pub fn apart(&self, some: &[SurfaceId], others: &[SurfaceId]) -> Option<Apart> {
        const SAMPLES: u32 = 48;
        let loops = |list: &[SurfaceId]| -> Vec<(SurfaceId, Loop)> {
            list.iter().flat_map(|s| self.patches_of(*s).map(|p| (*s, self.loop_of(p)))).collect()
        };
        let (ours, theirs) = (loops(some), loops(others));
        let samples = |list: &[(SurfaceId, Loop)]| -> Vec<(usize, usize, f64, DVec3)> {
            let pieces = list.iter().enumerate().flat_map(|(l, (_, around))| (0..around.pieces.len()).map(move |p| (l, p)));
            let at = |k: u32, l: usize, p: usize| {
                let s = list[l].1.pieces[p].length() * f64::from(k) / f64::from(SAMPLES);
                (l, p, s, list[l].1.pieces[p].at(s).1)
            };
            pieces.flat_map(|(l, p)| (0..=SAMPLES).map(move |k| at(k, l, p))).collect()
        };
        let (a, b) = (samples(&ours), samples(&theirs));
        let pairs = a.iter().flat_map(|x| b.iter().map(move |y| (x, y)));
        let (x, y) = pairs.min_by(|p, q| p.0.3.distance_squared(p.1.3).total_cmp(&q.0.3.distance_squared(q.1.3)))?;
        let (first, second) = (&ours[x.0].1.pieces[x.1], &theirs[y.0].1.pieces[y.1]);
        let (mut s, mut t) = (x.2, y.2);
        for _ in 0..ROUNDS {
            (s, _) = foot(|s| first.at(s), second.at(t).1, s, (0.0, first.length()));
            (t, _) = foot(|t| second.at(t), first.at(s).1, t, (0.0, second.length()));
        }
        let at = second.at(t).1;
        Some(Apart { surfaces: (ours[x.0].0, theirs[y.0].0), gap: first.at(s).1.distance(at), at })
    }
}

/// A place on a border by its arc length: (u, v), point and unit tangent.
type BorderJet = ((f64, f64), DVec3, DVec3);

/// Arc length and distance of the point of a border nearest to a point, near a place.
fn foot(jet: impl Fn(f64) -> BorderJet, p: DVec3, near: f64, range: (f64, f64)) -> (f64, f64) {
    let jet = |s: f64| {
        let (_, q, tangent) = jet(s);
        (q, tangent)
    };
    down(&jet, p, near, range)
}

/// Two faces at one place of the segment that they share. Angle and jump of curvature are NaN where a face has no normal.
#[derive(Clone, Copy)]
struct AtPlace {
    point: DVec3,
    gap: f64,
    angle: f64,
    curvature: f64,
}

/// Normal curvature of a face across a direction, seen from a unit normal, 1/model units; not a number where the face is singular.
fn curvature_across(jet: &Jet2, along: DVec3, normal: DVec3) -> f64 {
    let across = normal.cross(along).normalize_or_zero();
    let (e, f, g) = (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
    let area = e * g - f * f;
    if area <= PARALLEL * e * g || across == DVec3::ZERO {
        return f64::NAN;
    }
    let (p, q) = (across.dot(jet.du), across.dot(jet.dv));
    let (a, b) = ((g * p - f * q) / area, (e * q - f * p) / area);
    a * a * jet.duu.dot(normal) + 2.0 * a * b * jet.duv.dot(normal) + b * b * jet.dvv.dot(normal)
}

/// Gap, angle and jump of curvature at a share of the segment that two borders share.
fn at_place(a: &SegmentSide, b: &SegmentSide, f: f64) -> AtPlace {
    let (uv, point, along) = a.jet(a.station(f));
    let (other, q, _) = b.jet(b.foot(point, b.station(f)));
    let (own, beside) = (a.inside(uv), b.inside(other));
    let (m, n) = (a.surface.normal_of(&own, uv), b.surface.normal_of(&beside, other));
    let gap = point.distance(q);
    if m == DVec3::ZERO || n == DVec3::ZERO {
        return AtPlace { point, gap, angle: f64::NAN, curvature: f64::NAN };
    }
    let turn = angle_between(m, n);
    let angle = turn.min(std::f64::consts::PI - turn);
    let n = if m.dot(n) < 0.0 { -n } else { n };
    let curvature = (curvature_across(&own, along, m) - curvature_across(&beside, along, n)).abs();
    AtPlace { point, gap, angle, curvature }
}

/// Gap, angle and jump of curvature along the segment that two borders share.
fn contact(a: &SegmentSide, b: &SegmentSide, joins: &Joins, segment: usize) -> Contact {
    let steps = STEPS.max(STEPS_A_SPAN * a.spans().max(b.spans()));
    let at = |f: f64| at_place(a, b, f);
    let seen: Vec<AtPlace> = (0..=steps).map(|k| at(k as f64 / steps as f64)).collect();
    let middle = seen[steps / 2].point;
    Contact {
        faces: (a.face, b.face),
        edges: (a.edge, b.edge),
        length: joins.pieces.segments[segment].length(),
        middle: joins.middle(segment),
        gap: spread(&seen, at, |place| place.gap).unwrap_or(Spread { min: 0.0, max: 0.0, mean: 0.0, at: middle }),
        angle: spread(&seen, at, |place| place.angle),
        curvature: spread(&seen, at, |place| place.curvature),
    }
}

/// Least, largest and mean of a value along a segment, from the places `seen` in equal steps; those where it is NaN are left out. The extremes
/// are refined by `at`, the faces at any share of the segment.
fn spread(seen: &[AtPlace], at: impl Fn(f64) -> AtPlace, value: impl Fn(&AtPlace) -> f64) -> Option<Spread> {
    let steps = seen.len() - 1;
    let place = |k: usize| k as f64 / steps as f64;
    let known = || seen.iter().map(&value).enumerate().filter(|(_, x)| !x.is_nan());
    let least = known().min_by(|a, b| a.1.total_cmp(&b.1))?.0;
    let most = known().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?.0;
    let refined = |k: usize, sign: f64| {
        let around = (place(k.saturating_sub(1)), place((k + 1).min(steps)));
        let found = at(lowest(around.0, around.1, NEAREST, |f| sign * value(&at(f))));
        if sign * value(&found) < sign * value(&seen[k]) { found } else { seen[k] }
    };
    let (low, high) = (refined(least, 1.0), refined(most, -1.0));
    // Trapezoids: the ends count half.
    let weight = |k: usize| if k == 0 || k == steps { 0.5 } else { 1.0 };
    let (sum, whole) = known().fold((0.0, 0.0), |(sum, whole), (k, x)| (sum + weight(k) * x, whole + weight(k)));
    Some(Spread { min: value(&low), max: value(&high), mean: sum / whole, at: high.point })
}
