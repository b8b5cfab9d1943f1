//! Curves and points of a mesh that lie inside its faces: which faces, where in (u, v), and where they cross from one patch
//! of a surface to the next.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::predicates::{Side, point_in_polygon};
use crate::base::solve::turn;
use crate::base::tolerance::Tolerance;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::loose::{self, Leaving};
use crate::mesh::request::input::Input;
use crate::model::{Patch, PatchId, SurfaceId, Track};
use crate::surface::{Domain, Nearest, Surface, foot_within};

/// Notes for each face the segments and points of the plan that lie inside it, off its borders, and a curve that shares no nodes with a face.
pub fn place(input: &Input, layout: &mut Layout) {
    let mut on_face = vec![false; layout.pieces.segments.len()];
    layout.faces.iter().flat_map(|f| &f.sides).flat_map(|s| s.segments()).for_each(|s| on_face[s] = true);
    let mut lines: Vec<usize> = layout.curves.iter().flatten().map(|u| u.segment).collect();
    if input.plan.imprint.is_some() {
        // Borders of other faces are lines of a face that they lie on.
        lines.extend((0..on_face.len()).filter(|k| on_face[*k]));
        lines.extend(&layout.meets);
    }
    lines.sort_unstable();
    lines.dedup();
    let probes: Vec<[DVec3; 3]> = lines.iter().map(|k| [0.25, 0.5, 0.75].map(|f| layout.point(*k, f))).collect();
    let points: Vec<usize> = (0..layout.points.len()).collect();
    for (face, lines) in layout.creases.clone() {
        layout.faces[face].lines.extend(lines.iter().filter(|k| !on_face[**k]));
    }
    if lines.is_empty() && points.is_empty() {
        return;
    }
    let mut known: BTreeMap<SurfaceId, Nearest> = BTreeMap::new();
    let mut leaving = Leaving::new(input, layout);
    let mut faces = std::mem::take(&mut layout.faces);
    for face in &mut faces {
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let hull = surface.hull();
        let near = |all: &[DVec3]| Box3::of(all.iter().copied()).touches(&hull, input.tolerance.point);
        let nearest = known.entry(face.surface).or_insert_with(|| Nearest::new(surface));
        let patch = &input.model.patches[face.patch.index()];
        let holds = |p: &DVec3| on(nearest, patch, *p, input.tolerance);
        let around: BTreeSet<usize> = face.sides.iter().flat_map(|s| s.uses.iter().map(|u| u.segment)).collect();
        let candidates = (0..lines.len()).filter(|n| !around.contains(&lines[*n]) && near(&probes[*n]) && probes[*n].iter().all(holds));
        let found: Vec<usize> = candidates.collect();
        let rim = if found.is_empty() { Vec::new() } else { rim(layout, &around) };
        // What runs along the border of the face and is none of it has no room beside it.
        let on_rim = |p: &DVec3| rim.iter().any(|part| part.is_near(layout, *p, input.tolerance.point));
        let own = found.into_iter().filter(|n| !probes[*n].iter().all(on_rim)).map(|n| lines[n]);
        // Probes are few: a segment may leave the face between two of them.
        let own = own.filter(|segment| leaving.part(*segment, face.surface, face.near).is_none());
        face.lines.extend(own.collect::<Vec<usize>>());
        face.lines.sort_unstable();
        face.lines.dedup();
        let segments = &layout.pieces.segments;
        let ends = face.segments().flat_map(|k| <[usize; 2]>::from(segments[k].ends)).chain(face.sides.iter().filter_map(|s| s.pole));
        let ends: BTreeSet<usize> = ends.collect();
        let is_end = |k: &usize| layout.points[*k].is_some_and(|j| ends.contains(&j));
        let inside = |k: &usize| !is_end(k) && near(&[input.plan.points[*k]]) && holds(&input.plan.points[*k]);
        face.points = points.iter().copied().filter(inside).collect();
    }
    layout.faces = faces;
    layout.loose = loose::find(input, layout, &mut leaving);
}

/// A segment of the border of a face, inside a ball.
struct RimSegment {
    segment: usize,
    center: DVec3,
    radius: f64,
}

impl RimSegment {
    fn is_near(&self, layout: &Layout, p: DVec3, near: f64) -> bool {
        self.center.distance(p) <= self.radius + near && layout.distance(self.segment, p) <= near
    }
}

/// The segments round a face; no point of one is farther from its middle than half its length.
fn rim(layout: &Layout, around: &BTreeSet<usize>) -> Vec<RimSegment> {
    let of = |k: &usize| RimSegment { segment: *k, center: layout.point(*k, 0.5), radius: 0.5 * layout.length(*k) };
    around.iter().map(of).collect()
}

/// Whether a point lies on a patch.
pub(crate) fn on(nearest: &Nearest, patch: &Patch, p: DVec3, tolerance: &Tolerance) -> bool {
    let surface = nearest.surface();
    let found = nearest.at(p);
    if found.distance > tolerance.point || surface.domain() == Domain::Loop {
        return found.distance <= tolerance.point;
    }
    foot_within(surface.evaluator(), p, found.uv, patch.u, patch.v).0 <= tolerance.point
}

/// (u, v) of points in a row on a patch, near enough to each other that the foot of one leads to the next; beyond 0…1 where
/// a trimmed surface closes and its border runs over the seam.
pub fn trace(surface: &Surface, patch: &Patch, points: &[DVec3]) -> Vec<(f64, f64)> {
    if let Some(flat) = points.iter().map(|p| surface.flat_uv(*p)).collect::<Option<Vec<_>>>() {
        return flat;
    }
    let trimmed = surface.domain() == Domain::Loop;
    let turns = |closed: bool| if closed { (-1.0, 2.0) } else { (0.0, 1.0) };
    let (u, v) = if trimmed { (turns(surface.closed().0), turns(surface.closed().1)) } else { (patch.u, patch.v) };
    let middle = points.len() / 2;
    let first = Nearest::new(surface).at(points[middle]).uv;
    let first = if trimmed { unwrapped(surface, first) } else { foot_within(surface.evaluator(), points[middle], first, u, v).1 };
    let mut places = vec![first; points.len()];
    for k in (0..middle).rev() {
        places[k] = foot_within(surface.evaluator(), points[k], places[k + 1], u, v).1;
    }
    for k in middle + 1..points.len() {
        places[k] = foot_within(surface.evaluator(), points[k], places[k - 1], u, v).1;
    }
    places
}

/// The place moved by whole turns into the loops of a trimmed surface.
fn unwrapped(surface: &Surface, (u, v): (f64, f64)) -> (f64, f64) {
    let outlines = surface.outlines();
    let kept = |at: &DVec2| surround(&outlines, *at);
    surface.copies((u, v)).into_iter().find(kept).map_or((u, v), |at| (at.x, at.y))
}

/// Whether polygons, the holes of others among them, have a point inside.
pub fn surround(polygons: &[Vec<DVec2>], p: DVec2) -> bool {
    polygons.iter().filter(|polygon| point_in_polygon(p, polygon) == Side::Inside).count() % 2 == 1
}

/// Samples of a curve between which it crosses a line of a surface once at most.
const SAMPLES: usize = 128;

/// Arc lengths at which tracks cross from one patch of a surface to the next, or over the seam of a closed one: there the
/// border is in the way, which no curve of the network is.
pub fn crossings(input: &Input, patches: &[PatchId], track: &Track) -> Vec<f64> {
    let mut surfaces: Vec<SurfaceId> = patches.iter().map(|p| input.model.patches[p.index()].surface).collect();
    surfaces.sort_unstable();
    surfaces.dedup();
    let at = |k: usize| track.length() * k as f64 / SAMPLES as f64;
    let points: Vec<DVec3> = (0..=SAMPLES).map(|k| track.point(at(k))).collect();
    let around = Box3::of(points.iter().copied());
    let mut cuts = Vec::new();
    for id in surfaces {
        let surface = &input.model.surfaces[id.index()].surface;
        if surface.is_flat() || !around.touches(&surface.hull(), input.tolerance.point) {
            continue;
        }
        let (us, vs) = walls(input, id);
        if us.is_empty() && vs.is_empty() {
            continue;
        }
        let nearest = Nearest::new(surface);
        let foot = |s: f64| {
            let found = nearest.at(track.point(s));
            let on = found.distance <= input.tolerance.point;
            let jet = surface.jet(found.uv.0, found.uv.1);
            on.then(|| [(found.uv.0, jet.du.length()), (found.uv.1, jet.dv.length())])
        };
        let feet: Vec<Option<[(f64, f64); 2]>> = (0..=SAMPLES).map(|k| foot(at(k))).collect();
        for (along, walls) in [us, vs].into_iter().enumerate() {
            for wall in walls {
                let wall = Wall { at: wall, near: 2.0 * input.tolerance.point };
                // The last sample truly on one side of the line; those on it do not count.
                let mut last: Option<(usize, f64)> = None;
                for (k, place) in feet.iter().enumerate() {
                    let Some(place) = place else {
                        last = None;
                        continue;
                    };
                    let (x, speed) = place[along];
                    if wall.side(x, speed).is_none() {
                        continue;
                    }
                    let before = last.replace((k, x));
                    let Some((from, a)) = before.filter(|(_, a)| wall.between(*a, x)) else { continue };
                    cuts.extend(wall.crossed((at(from), at(k)), a, &|s| foot(s).map(|place| place[along].0)));
                }
            }
        }
    }
    let near = 2.0 * input.tolerance.point;
    cuts.retain(|s| *s > near && *s < track.length() - near);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a <= near);
    cuts
}

/// u and v of the lines between patches; 0 stands for a seam.
fn walls(input: &Input, surface: SurfaceId) -> (Vec<f64>, Vec<f64>) {
    let whole = &input.model.surfaces[surface.index()].surface;
    let closed = if whole.domain() == Domain::Square { whole.closed() } else { (false, false) };
    let (mut us, mut vs) = (Vec::new(), Vec::new());
    for patch in input.model.patches_of(surface) {
        let record = &input.model.patches[patch.index()];
        us.push(record.u.0);
        vs.push(record.v.0);
        if whole.domain() == Domain::Loop {
            us.extend(whole.kinks().0);
            vs.extend(whole.kinks().1);
        }
    }
    for (all, closed) in [(&mut us, closed.0), (&mut vs, closed.1)] {
        all.sort_by(f64::total_cmp);
        all.dedup();
        all.retain(|x| *x > 0.0 || closed);
    }
    (us, vs)
}

/// A line of constant u or v; at 0 a seam.
struct Wall {
    at: f64,
    /// How far from it is on it, model units.
    near: f64,
}

impl Wall {
    const HALF: f64 = 0.5;

    /// Which side a parameter is on: beside a seam by the nearer end.
    fn below(&self, x: f64) -> bool {
        if self.at == 0.0 { x < Self::HALF } else { x < self.at }
    }

    /// The side, `None` on the line; `speed` is the length of a step in the parameter.
    fn side(&self, x: f64, speed: f64) -> Option<bool> {
        let off = if self.at == 0.0 { x.min(1.0 - x) } else { (x - self.at).abs() };
        (off * speed > self.near).then(|| self.below(x))
    }

    /// Whether the line is between two parameters on different sides: over a seam they leap by a turn.
    fn between(&self, a: f64, b: f64) -> bool {
        self.below(a) != self.below(b) && ((b - a).abs() > Self::HALF) == (self.at == 0.0)
    }

    /// Where a parameter that starts at `a` passes the line.
    fn crossed(&self, (s0, s1): (f64, f64), a: f64, parameter: &dyn Fn(f64) -> Option<f64>) -> Option<f64> {
        turn(s0, s1, self.below(a), |s| parameter(s).map(|x| self.below(x)))
    }
}
