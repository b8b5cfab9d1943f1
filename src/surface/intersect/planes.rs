//! Intersects two flat faces in closed form.

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::geometry::construct::build;
use crate::network::{Chain, meet as meet_chains};
use crate::surface::closest::nearest::closest;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::intersect::coplanar::is_flat;
use crate::surface::intersect::sheet::grounded;
use crate::surface::rails::side::Side;

/// Planes that part by no more than so many tolerances over the smaller face run along each other.
const ALONG: f64 = 16.0;
/// Share of a face by which the line runs on beyond it before the borders cut it.
const BEYOND: f64 = 1.0 / 64.0;

/// A flat ground: `p + u du + v dv`.
pub(crate) struct Flat {
    pub p: DVec3,
    du: DVec3,
    dv: DVec3,
    /// A unit vector.
    pub normal: DVec3,
}

impl Flat {
    /// Of a flat face, an unbounded one as far as a box reaches; `None` for others.
    pub fn of(face: &Surface, reach: Box3) -> Option<Self> {
        if !is_flat(face) {
            return None;
        }
        let jet = grounded(face, reach).jet(0.0, 0.0);
        let normal = jet.du.cross(jet.dv).try_normalize()?;
        Some(Self { p: jet.p, du: jet.du, dv: jet.dv, normal })
    }

    /// Lines that bound the parallelogram 0 ≤ u, v ≤ 1: an inner unit normal in the plane of each, and a point of it.
    pub fn sides(&self) -> [(DVec3, DVec3); 4] {
        let inward = |along: DVec3, to: DVec3| to.reject_from(along).normalize_or_zero();
        let (across_v, across_u) = (inward(self.du, self.dv), inward(self.dv, self.du));
        let far = self.p + self.du + self.dv;
        [(across_v, self.p), (-across_v, far), (across_u, self.p), (-across_u, far)]
    }
}

/// Returns the straight line in which the planes of two flat faces meet, cut at parallelograms but not at loops, and points of loops
/// on both faces. `None` where a face is not flat, or both lie in one plane within the tolerance.
///
/// Faces know their loops in (u, v); one at most is unbounded. Fails where curves that bound a face do (`meet`).
pub(crate) fn flat_faces(faces: [&Surface; 2], boxes: [Box3; 2], origin: Origin, tolerance: &Tolerance) -> Result<Option<Lines>> {
    let (Some(a), Some(b)) = (Flat::of(faces[0], boxes[1]), Flat::of(faces[1], boxes[0])) else { return Ok(None) };
    let across = a.normal.cross(b.normal);
    let sine = across.length();
    let size = boxes[0].diagonal().min(boxes[1].diagonal());
    if sine * size <= ALONG * tolerance.point {
        return Ok(None);
    }
    let way = across / sine;
    // The point of both planes nearest to the middle of what their boxes share.
    let shared = Box3 { min: boxes[0].min.max(boxes[1].min), max: boxes[0].max.min(boxes[1].max) };
    let middle = shared.center();
    let heights = (a.normal.dot(middle - a.p), b.normal.dot(middle - b.p));
    let cosine = a.normal.dot(b.normal);
    let (x, y) = ((heights.0 - heights.1 * cosine) / (sine * sine), (heights.1 - heights.0 * cosine) / (sine * sine));
    let at = middle - a.normal * x - b.normal * y;
    // Of faces that only touch the boxes may miss each other by rounding.
    let Some(range) = clipped_to_box(at, way, &shared.grown(BEYOND * size + tolerance.point)) else {
        return Ok(Some(Lines::default()));
    };
    let mut range = range;
    for (face, flat) in faces.iter().zip([&a, &b]) {
        if face.domain() == Domain::Square {
            let Some(inner) = clipped_to_sides(at, way, flat, range, tolerance) else { return Ok(Some(Lines::default())) };
            range = inner;
        }
    }
    let (start, end) = (at + way * range.0, at + way * range.1);
    if range.1 - range.0 <= tolerance.point {
        return Ok(Some(Lines { curves: Vec::new(), touches: on_both(vec![start.midpoint(end)], faces, tolerance) }));
    }
    let line = build::line(start, end, origin)?;
    Ok(Some(Lines { touches: on_both(border_points(&line, faces, tolerance)?, faces, tolerance), curves: vec![line] }))
}

/// Lines that flat faces may share, to be cut at their loops, and points of their borders on both.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    pub curves: Vec<Curve>,
    pub touches: Vec<DVec3>,
}

/// Where a line lies in a box.
fn clipped_to_box(at: DVec3, way: DVec3, within: &Box3) -> Option<(f64, f64)> {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (from, to) = (within.min[axis] - at[axis], within.max[axis] - at[axis]);
        if way[axis] == 0.0 {
            if from > 0.0 || to < 0.0 {
                return None;
            }
            continue;
        }
        let (s, t) = (from / way[axis], to / way[axis]);
        (low, high) = (low.max(s.min(t)), high.min(s.max(t)));
    }
    (low <= high && low.is_finite() && high.is_finite()).then_some((low, high))
}

/// The part of a range of a line inside a parallelogram; along a side as far as the tolerance reaches.
fn clipped_to_sides(at: DVec3, way: DVec3, flat: &Flat, range: (f64, f64), tolerance: &Tolerance) -> Option<(f64, f64)> {
    let (mut low, mut high) = range;
    for (inward, p) in flat.sides() {
        let (height, slope) = (inward.dot(at - p), inward.dot(way));
        let (first, last) = (height + slope * range.0, height + slope * range.1);
        if first.min(last) >= -tolerance.point && (first - last).abs() <= tolerance.point {
            continue;
        }
        if first.max(last) < -tolerance.point {
            return None;
        }
        let stop = -height / slope;
        if slope > 0.0 { low = low.max(stop) } else { high = high.min(stop) }
    }
    (low <= high + tolerance.point).then_some((low, high.max(low)))
}

/// Points where a line meets the loops of faces.
fn border_points(line: &Curve, faces: [&Surface; 2], tolerance: &Tolerance) -> Result<Vec<DVec3>> {
    let chain = Chain::of_curve(line);
    let mut points = Vec::new();
    for face in faces.iter().filter(|face| face.domain() == Domain::Loop) {
        for k in 0..face.n_sides() {
            if let Side::Chain { chain: border, .. } = face.side(k) {
                points.extend(meet_chains(&chain, &border, tolerance)?.into_iter().map(|m| chain.point(m.fa)));
            }
        }
    }
    Ok(points)
}

/// Those of some points that lie on both faces.
pub(crate) fn on_both(mut points: Vec<DVec3>, faces: [&Surface; 2], tolerance: &Tolerance) -> Vec<DVec3> {
    let on = |face: &Surface, p: DVec3| {
        let foot = closest(&face.untrimmed(), p);
        foot.distance <= tolerance.point && face.keeps_point(p, DVec2::from(foot.uv), tolerance.point)
    };
    points.retain(|p| faces.iter().all(|face| face.domain() != Domain::Loop || on(face, *p)));
    points
}
