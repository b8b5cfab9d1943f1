//! Half breadths of a hull at stations and heights, from the curves in which planes across it meet its faces.
//!
//! A section is taken on both sides of its plane, nearer than anything that counts as beside it, as faces may meet in the plane itself or
//! end there; each place is then moved into the plane along the face that it lies on.

use glam::{DVec2, DVec3};

use super::cut::CuttingPlane;
use super::face::{Face, Way};
use super::sides::Side;
use super::traces::{Trace, border_crossings, traces};
use super::triangles::Triangles;
use crate::base::bbox::Box3;
use crate::base::par;
use crate::base::solve::lowest;
use crate::base::tolerance::{EPSILON, FLOAT_ALONG, FLOAT_BESIDE, FLOAT_FARTHEST, FLOAT_LEVEL};
use crate::surface::{Surface, bbox};

/// Parts of a curve of a section, at whose ends its height is looked at.
const PARTS: usize = 16;
/// Halvings of a part that a height crosses before Newton's method, and where that does not come near.
const HALVINGS: (u32, u32) = (10, 60);
/// Most steps of Newton's method.
const STEPS: u32 = 20;
/// A hull that is measured.
pub struct Hull {
    faces: Vec<Face>,
    triangles: Triangles,
    bounds: Box3,
    tolerance: f64,
}

/// A place of a curve of a section.
#[derive(Clone, Copy)]
struct Stop {
    row: f64,
    p: DVec3,
    /// An end of the curve, or where it is highest or lowest: a height that it reaches there alone is met.
    turns: bool,
}

/// A line of a section.
enum Line<'a> {
    /// On a curved face, from place to place.
    Curve(Trace<'a>, Vec<Stop>),
    /// On a flat one with its normal.
    Straight([DVec3; 2], DVec3),
}

impl Hull {
    /// A hull of faces; points nearer than `tolerance`, model units, are one.
    pub fn of_faces(surfaces: &[Surface], tolerance: f64) -> Self {
        let bounds = surfaces.iter().map(bbox).fold(Box3::EMPTY, Box3::union);
        let (about, reach) = (bounds.center(), 0.5 * bounds.diagonal());
        let faces = par::map(surfaces.len(), |k| Face::new(&surfaces[k], false, about, reach));
        Self { faces, triangles: Triangles::default(), bounds, tolerance }
    }

    /// A hull of triangles.
    pub fn of_triangles(nodes: Vec<DVec3>, corners: Vec<[u32; 3]>, tolerance: f64) -> Self {
        let bounds = Box3::of(corners.iter().flatten().map(|k| nodes[*k as usize]));
        let triangles = Triangles::new(nodes, corners, bounds.center());
        Self { faces: Vec::new(), triangles, bounds, tolerance }
    }

    /// The only side that it has; `None` of one that has both.
    pub fn only_side(&self) -> Option<Side> {
        Side::only(&self.bounds, self.tolerance)
    }

    /// The largest half breadth at each height of each station, model units: by station, then by height. 0 in the centre plane, `None` where
    /// there is no hull.
    pub fn half_breadths(&self, stations: &[f64], heights: &[f64], side: Side) -> Vec<Vec<Option<f64>>> {
        par::map(stations.len(), |k| self.of_station(stations[k], heights, side))
    }

    fn beside(&self) -> f64 {
        FLOAT_BESIDE * self.bounds.diagonal()
    }

    fn of_station(&self, x: f64, heights: &[f64], side: Side) -> Vec<Option<f64>> {
        let mut found: Vec<Option<f64>> = vec![None; heights.len()];
        let (low, high) = (self.bounds.min.x, self.bounds.max.x);
        if !(low - self.tolerance..=high + self.tolerance).contains(&x) {
            return found;
        }
        let inside = x.clamp(low, high);
        let sign = if side == Side::Port { 1.0 } else { -1.0 };
        for at in [inside - self.beside(), inside + self.beside()] {
            for line in self.section(at) {
                for (z, most) in heights.iter().zip(&mut found) {
                    self.meets(&line, DVec2::new(x, *z), &mut |y| {
                        let y = sign * y;
                        if y >= -self.tolerance {
                            let y = if y <= self.beside() { 0.0 } else { y };
                            *most = Some(most.map_or(y, |known| known.max(y)));
                        }
                    });
                }
            }
        }
        found
    }

    /// The lines of the section at x.
    fn section(&self, x: f64) -> Vec<Line<'_>> {
        let diagonal = self.bounds.diagonal();
        let plane = CuttingPlane { normal: DVec3::X, distance: x, none: EPSILON * diagonal, along: FLOAT_ALONG * diagonal };
        let mut lines = Vec::new();
        self.triangles.segments(&|p| p.x - x, |a, b, n| lines.push(Line::Straight([a, b], n.normalize_or_zero())));
        for face in &self.faces {
            if face.way == Way::Flat {
                self.chords(face, plane, &mut lines);
            } else {
                lines.extend(traces(face, plane).into_iter().map(|trace| Line::Curve(trace, stops(&trace))));
            }
        }
        lines
    }

    /// The chords of a flat face in a plane: from an odd crossing of its border to the next one.
    fn chords(&self, face: &Face, plane: CuttingPlane, lines: &mut Vec<Line<'_>>) {
        let whole = &face.cells[0].sums;
        let normal = DVec3::new(whole[1], whole[2], whole[3]).normalize_or_zero();
        let along = normal.cross(plane.normal);
        if along.length() <= FLOAT_LEVEL {
            return;
        }
        let (near, along) = (0.1 * self.beside(), along.normalize());
        let mut ends: Vec<DVec3> = border_crossings(face, plane).into_iter().filter(|p| (p.x - plane.distance).abs() <= near).collect();
        ends.sort_by(|a, b| along.dot(*a).total_cmp(&along.dot(*b)));
        ends.dedup_by(|a, b| a.distance(*b) <= self.beside());
        lines.extend(ends.chunks_exact(2).map(|pair| Line::Straight([pair[0], pair[1]], normal)));
    }

    /// Gives y of each place where a line meets the height `at.y` of the station `at.x`.
    fn meets(&self, line: &Line, at: DVec2, found: &mut impl FnMut(f64)) {
        let level = |p: DVec3| (p.z - at.y).abs() <= self.tolerance;
        match line {
            Line::Straight([a, b], n) => {
                let moved = |p: DVec3| if n.y.abs() > FLOAT_LEVEL { p.y - (at.x - p.x) * n.x / n.y } else { p.y };
                [a, b].into_iter().filter(|p| level(**p)).for_each(|p| found(p.y));
                let (da, db) = (a.z - at.y, b.z - at.y);
                if da * db < 0.0 {
                    found(moved(a.lerp(*b, da / (da - db))));
                }
            }
            Line::Curve(trace, stops) => {
                let flat = stops.iter().all(|stop| level(stop.p));
                for stop in stops {
                    if (stop.turns || flat) && level(stop.p) {
                        found(self.in_plane(trace, stop, at.x).y);
                    } else if stop.p.z == at.y {
                        let y = self.newton(trace, (stop.row, stop.row), at);
                        found(y.unwrap_or_else(|| self.in_plane(trace, stop, at.x).y));
                    }
                }
                for pair in stops.windows(2) {
                    if (pair[0].p.z - at.y) * (pair[1].p.z - at.y) < 0.0 {
                        found(self.crossing(trace, &pair[0], &pair[1], at));
                    }
                }
            }
        }
    }

    /// A place of a curve beside the plane, moved into it along its row.
    fn in_plane(&self, trace: &Trace, stop: &Stop, x: f64) -> DVec3 {
        let (u, v) = place(trace, stop.row);
        let tangent = trace.cut.face.tangents(u, v)[1 + trace.strip.along];
        let by = tangent * ((x - stop.p.x) / tangent.x);
        if by.length() <= self.tolerance { stop.p + by } else { stop.p }
    }

    /// y where a curve crosses a height between two places: by some halvings, then by Newton's method on the face itself.
    fn crossing(&self, trace: &Trace, low: &Stop, high: &Stop, at: DVec2) -> f64 {
        let below = low.p.z < at.y;
        let (mut a, mut b) = (low.row, high.row);
        for k in 0..HALVINGS.1 {
            let middle = 0.5 * (a + b);
            if k == HALVINGS.0
                && let Some(y) = self.newton(trace, (a, b), at)
            {
                return y;
            }
            if (trace.point(middle).z < at.y) == below { a = middle } else { b = middle }
        }
        trace.point(0.5 * (a + b)).y
    }

    /// y at a station and a height, between two rows; `None` where the steps do not come near, or lead elsewhere.
    fn newton(&self, trace: &Trace, (a, b): (f64, f64), at: DVec2) -> Option<f64> {
        let size = self.bounds.diagonal();
        let start = trace.point(0.5 * (a + b));
        // Where the hull ends round, the plane beside lies so far from its end.
        let near = 4.0 * trace.point(a).distance(trace.point(b)) + FLOAT_BESIDE.sqrt() * size;
        let (mut u, mut v) = place(trace, 0.5 * (a + b));
        let enough = 4.0 * f64::EPSILON * size;
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let [p, du, dv] = trace.cut.face.tangents(u, v);
            let (ex, ez) = (at.x - p.x, at.y - p.z);
            let off = ex.abs().max(ez.abs());
            // Rounding has the last word: the place found before is as good.
            if off <= enough || off >= last && off <= EPSILON * size {
                return (p.distance(start) <= near).then_some(p.y);
            }
            last = off;
            let det = du.x * dv.z - dv.x * du.z;
            if det == 0.0 {
                return None;
            }
            (u, v) = (u + (ex * dv.z - dv.x * ez) / det, v + (du.x * ez - ex * du.z) / det);
            (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        }
        None
    }
}

/// Parameters of the place of a row.
fn place(trace: &Trace, row: f64) -> (f64, f64) {
    trace.place(row, 0.5 * (trace.strip.reach.0 + trace.strip.reach.1))
}

/// Places along a curve: ends of its parts, and where it is highest or lowest.
fn stops(trace: &Trace) -> Vec<Stop> {
    let (first, last) = trace.rows;
    let row = |k: usize| if k == PARTS { last } else { first + (last - first) * k as f64 / PARTS as f64 };
    let stop = |row: f64, turns: bool| Stop { row, p: trace.point(row), turns };
    let mut out: Vec<Stop> = (0..=PARTS).map(|k| stop(row(k), k == 0 || k == PARTS)).collect();
    for k in 1..PARTS {
        let (before, here, after) = (out[k - 1].p.z, out[k].p.z, out[k + 1].p.z);
        let sign = if here > before && here >= after {
            -1.0
        } else if here < before && here <= after {
            1.0
        } else {
            continue;
        };
        let at = lowest(row(k - 1), row(k + 1), FLOAT_FARTHEST, |row| sign * trace.point(row).z);
        out.push(stop(at, true));
    }
    out.sort_by(|a, b| a.row.total_cmp(&b.row));
    out
}
