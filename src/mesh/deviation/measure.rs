//! The distance between mesh and surface, measured at 25 points a triangle.
//!
//! The points are those of a triangle divided in six along each side, corners left out. Each has a place on the surface by
//! linear interpolation of (u, v). What is off along the normal there is nearly the distance (the error falls with the
//! square of the size). One more point is where the quadratic function is largest that has the same heights in the corners and in the middles
//! of the sides. Of each row the triangles that seem farthest are followed to their feet.

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::deviation::poles::from_pole;
use crate::mesh::deviation::quadratic::stationary;
use crate::mesh::mapped::grid::{Grid, triangle_rows};
use crate::surface::{Domain, Evaluator, Surface, foot_within, step};

/// Divisions of a triangle's side.
const SIX: usize = 6;

/// What steers the measurement.
struct MeasureSettings {
    /// Distance over what a triangle seems to be off, from which it does not only seem so.
    min_true_share: f64,
    /// Triangles that one thread measures at a time.
    batch: usize,
    /// Triangles of a row that are followed to their feet at most, but for those that only seem far.
    max_followed: usize,
}

const SETTINGS: MeasureSettings = MeasureSettings { min_true_share: 0.5, batch: 1024, max_followed: 256 };

/// Largest distance of a face's elements from its surface, model units; `triangles` are those of the face.
pub fn of_face(surface: &Surface, geometry: &FaceGeometry, triangles: &[[u32; 3]], nodes: &[DVec3], tolerance: &Tolerance) -> f64 {
    match &geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let (nu, nv) = grid.size();
            let starts = triangle_rows(frame, !triangles.is_empty());
            let rows = par::map(nv, |j| {
                let cells = GridRow { surface, grid, frame, nodes, tolerance };
                let of_row = if starts.is_empty() { &[][..] } else { triangles.get(starts[j]..starts[j + 1]).unwrap_or(&[]) };
                cells.measure(j, nu, of_row)
            });
            rows.into_iter().fold(0.0, f64::max)
        }
        listed if surface.is_flat() => from_plane(surface, &listed.listed_ids(), nodes, tolerance),
        listed => {
            let (uv, ids) = (listed.listed_uv(), listed.listed_ids());
            let mut halves: Vec<[usize; 3]> = Vec::new();
            listed.each_listed_cell(|c| {
                halves.push([c[0], c[1], c[2]]);
                if let [a, _, b, d] = *c {
                    halves.push([a, b, d]);
                }
            });
            let power_form = surface.power_form();
            let evaluator = Evaluator::new(surface, power_form.as_ref());
            let point = |(u, v)| evaluator.point(u, v);
            let of_half = |k: usize| {
                let at = beside_pole(surface, halves[k].map(|n| uv[n]));
                let seen = of_triangle(&point, at, halves[k].map(|n| nodes[ids[n] as usize]));
                bounded(evaluator, seen)
            };
            let batches = par::map(halves.len().div_ceil(SETTINGS.batch), |batch| {
                (batch * SETTINGS.batch..halves.len().min((batch + 1) * SETTINGS.batch)).map(of_half).collect::<Vec<_>>()
            });
            let farthest = batches.into_iter().flatten().collect();
            follow(evaluator, farthest, tolerance)
        }
    }
}

/// Elements on a plane are as far from it as their farthest node.
fn from_plane(surface: &Surface, ids: &[u32], nodes: &[DVec3], tolerance: &Tolerance) -> f64 {
    const ANYWHERE: (f64, f64) = (0.5, 0.5);
    let jet = surface.jet(ANYWHERE.0, ANYWHERE.1);
    let normal = jet.du.cross(jet.dv).normalize_or_zero();
    let farthest = ids.iter().map(|n| (nodes[*n as usize] - jet.p).dot(normal).abs()).fold(0.0, f64::max);
    if farthest > tolerance.rounding { farthest } else { 0.0 }
}

/// One row of cells of a grid.
struct GridRow<'a> {
    surface: &'a Surface,
    grid: &'a Grid,
    frame: &'a crate::mesh::mapped::grid::GridIds,
    nodes: &'a [DVec3],
    tolerance: &'a Tolerance,
}

impl GridRow<'_> {
    fn measure(&self, j: usize, nu: usize, triangles: &[[u32; 3]]) -> f64 {
        let fine = self.fine_points(j, nu);
        let mut farthest = Vec::with_capacity(2 * nu);
        let mut next = triangles.iter();
        for i in 0..nu {
            let places = [self.grid.uv(i, j), self.grid.uv(i + 1, j), self.grid.uv(i + 1, j + 1), self.grid.uv(i, j + 1)];
            let ids = [self.frame.node(i, j), self.frame.node(i + 1, j), self.frame.node(i + 1, j + 1), self.frame.node(i, j + 1)];
            let points = ids.map(|n| self.nodes[n as usize]);
            let degenerate = (0..4).find(|k| ids[*k] == ids[(k + 1) % 4]);
            // A triangle of the mesh that holds both b and d shows that the other diagonal is used.
            let other = match (next.next(), degenerate) {
                (Some(t), None) => {
                    next.next();
                    t.contains(&ids[3]) && t.contains(&ids[1])
                }
                _ => false,
            };
            let halves: &[[usize; 3]] = match degenerate {
                Some(0) => &[[0, 2, 3]],
                Some(1) => &[[0, 1, 3]],
                Some(_) => &[[0, 1, 2]],
                None if other => &[[0, 1, 3], [1, 2, 3]],
                None => &[[0, 1, 2], [0, 2, 3]],
            };
            for half in halves {
                let cell = HalfCell { places, points, half: *half };
                farthest.push(match &fine {
                    Some(fine) if degenerate.is_none() => cell.farthest(fine, i, nu),
                    _ => {
                        let at = beside_pole(self.surface, half.map(|k| places[k]));
                        of_triangle(&|(u, v)| self.surface.point(u, v), at, half.map(|k| points[k]))
                    }
                });
            }
        }
        follow(self.surface.evaluator(), farthest, self.tolerance)
    }

    /// Surface points at sixths of the cells of a row, when they form a tensor grid.
    fn fine_points(&self, j: usize, nu: usize) -> Option<Vec<DVec3>> {
        if self.grid.straight != (true, true) {
            return None;
        }
        let sixth = |a: f64, b: f64, k: usize| a + (b - a) * k as f64 / SIX as f64;
        let us: Vec<f64> = (0..=nu * SIX)
            .map(|k| {
                if k == nu * SIX {
                    self.grid.uv(nu, 0).0
                } else {
                    sixth(self.grid.uv(k / SIX, 0).0, self.grid.uv(k / SIX + 1, 0).0, k % SIX)
                }
            })
            .collect();
        let (low, high) = (self.grid.uv(0, j).1, self.grid.uv(0, j + 1).1);
        let vs: Vec<f64> = (0..=SIX).map(|k| sixth(low, high, k)).collect();
        let mut points = vec![DVec3::ZERO; us.len() * vs.len()];
        self.surface.grid(&us, &vs, &mut points);
        Some(points)
    }
}

/// Half a cell of a grid.
struct HalfCell {
    places: [(f64, f64); 4],
    points: [DVec3; 4],
    half: [usize; 3],
}

impl HalfCell {
    /// The farthest of its points by surface points at sixths of the row's cells.
    fn farthest(&self, fine: &[DVec3], i: usize, nu: usize) -> Farthest {
        let width = nu * SIX + 1;
        // Corners of the cell in sixths.
        let corner = [(0, 0), (SIX, 0), (SIX, SIX), (0, SIX)];
        let [a, b, c] = self.half.map(|k| corner[k]);
        let [pa, pb, pc] = self.half.map(|k| self.points[k]);
        let normal = (pb - pa).cross(pc - pa).normalize_or_zero();
        let mut seen = Farthest { seems: -1.0, p: pa, uv: self.places[0] };
        let place = |x: f64, y: f64| {
            let (s, t) = (x / SIX as f64, y / SIX as f64);
            let [q0, q1, _, q3] = self.places;
            (q0.0 + (q1.0 - q0.0) * s + (q3.0 - q0.0) * t, q0.1 + (q1.1 - q0.1) * s + (q3.1 - q0.1) * t)
        };
        let mut middles = [0.0; 3];
        for (wa, wb, wc) in weights() {
            let x = (a.0 * wa + b.0 * wb + c.0 * wc) / SIX;
            let y = (a.1 * wa + b.1 * wb + c.1 * wc) / SIX;
            let p = (pa * wa as f64 + pb * wb as f64 + pc * wc as f64) / SIX as f64;
            let there = fine[y * width + i * SIX + x];
            if let Some(k) = middle([wa, wb, wc]) {
                middles[k] = (there - p).dot(normal);
            }
            let seems = off(p, there, normal);
            if seems > seen.seems {
                seen = Farthest { seems, p, uv: place(x as f64, y as f64) };
            }
        }
        if let Some((seems, w)) = peak(middles).filter(|(seems, _)| *seems > seen.seems) {
            let along = |a: usize, b: usize, c: usize| a as f64 * w[0] + b as f64 * w[1] + c as f64 * w[2];
            let uv = place(along(a.0, b.0, c.0), along(a.1, b.1, c.1));
            seen = Farthest { seems, p: pa * w[0] + pb * w[1] + pc * w[2], uv };
        }
        seen
    }
}

/// The point of a triangle that seems farthest from the surface: by how much, where, and near which (u, v).
#[derive(Clone, Copy)]
struct Farthest {
    seems: f64,
    p: DVec3,
    uv: (f64, f64),
}

/// How far a point is from the surface point beside it, along the normal of its triangle.
fn off(p: DVec3, there: DVec3, normal: DVec3) -> f64 {
    if normal == DVec3::ZERO { p.distance(there) } else { (p - there).dot(normal).abs() }
}

/// The 25 points as weights in sixths.
fn weights() -> impl Iterator<Item = (usize, usize, usize)> {
    (0..=SIX).flat_map(|b| (0..=SIX - b).map(move |c| (SIX - b - c, b, c))).filter(|(a, b, c)| *a != SIX && *b != SIX && *c != SIX)
}

/// The side opposite which corner weights are the middle of.
fn middle(weights: [usize; 3]) -> Option<usize> {
    const HALF: usize = SIX / 2;
    (0..3).find(|k| weights[*k] == 0 && weights[(*k + 1) % 3] == HALF)
}

/// How high the quadratic function over a triangle is where it is largest inside, and where, as weights, that vanishes at the corners and
/// has such heights in the middles of the sides opposite.
fn peak(middles: [f64; 3]) -> Option<(f64, [f64; 3])> {
    stationary(middles.map(|height| 4.0 * height)).map(|(height, weights)| (height.abs(), weights))
}

/// Places of a triangle's corners, with one at a pole between the others.
fn beside_pole(surface: &Surface, at: [(f64, f64); 3]) -> [(f64, f64); 3] {
    let tangents = |at: DVec2| {
        let jet = surface.jet(at.x, at.y);
        [jet.p, jet.du, jet.dv]
    };
    from_pole(&tangents, at.map(DVec2::from)).map(Into::into)
}

/// The farthest of the 25 points of a triangle.
fn of_triangle(point: &impl Fn((f64, f64)) -> DVec3, uv: [(f64, f64); 3], points: [DVec3; 3]) -> Farthest {
    let normal = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero();
    let mut seen = Farthest { seems: -1.0, p: points[0], uv: uv[0] };
    let place = |w: [f64; 3]| (uv[0].0 * w[0] + uv[1].0 * w[1] + uv[2].0 * w[2], uv[0].1 * w[0] + uv[1].1 * w[1] + uv[2].1 * w[2]);
    let spot = |w: [f64; 3]| points[0] * w[0] + points[1] * w[1] + points[2] * w[2];
    let mut middles = [0.0; 3];
    for (a, b, c) in weights() {
        let w = [a, b, c].map(|n| n as f64 / SIX as f64);
        let (at, p) = (place(w), spot(w));
        let there = point(at);
        if let Some(k) = middle([a, b, c]) {
            middles[k] = (there - p).dot(normal);
        }
        let seems = off(p, there, normal);
        if seems > seen.seems {
            seen = Farthest { seems, p, uv: at };
        }
    }
    if let Some((seems, w)) = peak(middles).filter(|(seems, _)| *seems > seen.seems) {
        seen = Farthest { seems, p: spot(w), uv: place(w) };
    }
    seen
}

/// The point with its distance from a near surface point, which its foot is no farther than: where (u, v) shear a surface, what is off along
/// the normal of the triangle may be less than the distance.
fn bounded(evaluator: Evaluator, seen: Farthest) -> Farthest {
    let jet = evaluator.jet(seen.uv.0, seen.uv.1);
    let gap = seen.p - jet.p;
    let Some(by) = step(jet.du, jet.dv, gap) else { return Farthest { seems: gap.length(), ..seen } };
    let ((u0, u1), (v0, v1)) = ranges(evaluator.surface());
    let uv = ((seen.uv.0 + by.x).clamp(u0, u1), (seen.uv.1 + by.y).clamp(v0, v1));
    let there = evaluator.point(uv.0, uv.1).distance(seen.p);
    if there < gap.length() { Farthest { seems: there, uv, ..seen } } else { Farthest { seems: gap.length(), ..seen } }
}

/// The ranges of u and v in which feet lie: a trimmed face may run over the seam of the surface below.
fn ranges(surface: &Surface) -> ((f64, f64), (f64, f64)) {
    let whole = |closed: bool| {
        let over = closed && surface.domain() == Domain::Loop;
        if over { (f64::NEG_INFINITY, f64::INFINITY) } else { (0.0, 1.0) }
    };
    let (u, v) = surface.closed();
    (whole(u), whole(v))
}

/// Follows the triangles that seem farthest to their feet: the distance of the farthest.
fn follow(evaluator: Evaluator, mut farthest: Vec<Farthest>, tolerance: &Tolerance) -> f64 {
    farthest.retain(|s| s.seems > tolerance.rounding);
    farthest.sort_by(|a, b| b.seems.total_cmp(&a.seems));
    let (u, v) = ranges(evaluator.surface());
    let (mut most, mut followed) = (0.0, 0);
    for seen in farthest {
        if seen.seems < most || followed == SETTINGS.max_followed {
            break;
        }
        let distance = foot_within(evaluator, seen.p, seen.uv, u, v).0;
        // What only seems far, as beside a pole, is passed by.
        followed += usize::from(distance >= SETTINGS.min_true_share * seen.seems);
        most = f64::max(most, distance);
    }
    most
}
