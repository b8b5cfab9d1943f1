//! The plane of scattered points, their places in it, and duplicates among them.

use glam::{DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::base::{job, math};
use crate::geometry::data::fault::CurveFault;
use crate::surface::faults::ScatterFault;

/// Sweeps of rotations after which a symmetric matrix of three rows is diagonal.
const SWEEPS: usize = 32;

/// A plane with axes.
#[derive(Clone, Copy, Debug)]
pub struct PlaneFrame {
    /// A point of it.
    pub center: DVec3,
    /// Unit vectors along x and y in it.
    pub axes: [DVec3; 2],
    /// Unit normal.
    pub normal: DVec3,
}

impl PlaneFrame {
    fn coordinates(&self, p: DVec3) -> DVec3 {
        let arm = p - self.center;
        DVec3::new(arm.dot(self.axes[0]), arm.dot(self.axes[1]), arm.dot(self.normal))
    }

    /// The point with these coordinates.
    pub fn place(&self, p: DVec3) -> DVec3 {
        self.center + self.axes[0] * p.x + self.axes[1] * p.y + self.normal * p.z
    }
}

/// Points over a plane.
pub struct Cloud {
    /// The plane.
    pub plane: PlaneFrame,
    /// x and y in the plane and the height over it, each point once, in the order of the points' coordinates.
    pub places: Vec<DVec3>,
    /// How many points were left out because they coincide with another point, and the first of them.
    pub merged: Option<(usize, DVec3)>,
}

/// The points over their plane; fails as `scatter` does.
pub fn cloud(points: &[DVec3], along: Option<DVec3>, origin: Origin, tolerance: &Tolerance) -> Result<Cloud> {
    let mut sorted: Vec<DVec3> = points.iter().map(|p| *p + DVec3::ZERO).collect();
    sorted.sort_by(|a, b| math::compare_points(*a, *b));
    let center = sorted[0] + sorted.iter().map(|p| *p - sorted[0]).sum::<DVec3>() / sorted.len() as f64;
    let normal = match along {
        Some(along) => {
            math::unit(along, 0.0).ok_or(CurveFault::ZeroDirection { of: origin, argument: "along", needed: "with a length" })?
        }
        None => upward(flattest(&sorted, center)),
    };
    let plane = PlaneFrame { center, axes: axes(normal), normal };
    let all: Vec<DVec3> = sorted.iter().map(|p| plane.coordinates(*p)).collect();
    let flat: Vec<DVec2> = all.iter().map(|p| p.truncate()).collect();
    if width(&flat) <= tolerance.point {
        return Err(on_one_line(&sorted, &flat, origin));
    }
    let (kept, first) = without_duplicates(&all, &sorted, origin, tolerance)?;
    let places: Vec<DVec3> = kept.iter().map(|k| all[*k]).collect();
    let merged = first.map(|at| (all.len() - kept.len(), at));
    Ok(Cloud { plane, places, merged })
}

/// E665: all points lie on one line.
pub fn on_one_line(points: &[DVec3], flat: &[DVec2], origin: Origin) -> Fault {
    let (a, b) = farthest(flat);
    ScatterFault::OneLine {
        surface: origin,
        count: points.len(),
        from: points[a.min(points.len() - 1)],
        to: points[b.min(points.len() - 1)],
    }
    .into()
}

/// Two points far from each other: the farthest from the first, and the farthest from that.
fn farthest(flat: &[DVec2]) -> (usize, usize) {
    let from = |k: usize| (0..flat.len()).max_by(|a, b| flat[*a].distance(flat[k]).total_cmp(&flat[*b].distance(flat[k]))).unwrap_or(0);
    let a = from(0);
    (a, from(a))
}

/// The largest distance of points from a line through two of them that are far apart.
fn width(flat: &[DVec2]) -> f64 {
    let (a, b) = farthest(flat);
    let way = (flat[b] - flat[a]).normalize_or_zero();
    flat.iter().map(|p| way.perp_dot(*p - flat[a]).abs()).fold(0.0, f64::max)
}

/// Points without duplicates, and the first duplicate; E675 where two points lie over one another.
fn without_duplicates(all: &[DVec3], points: &[DVec3], origin: Origin, tolerance: &Tolerance) -> Result<(Vec<usize>, Option<DVec3>)> {
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|a, b| all[*a].x.total_cmp(&all[*b].x).then(a.cmp(b)));
    let mut is_duplicate = vec![false; all.len()];
    let mut same_place: Option<(usize, usize)> = None;
    for (i, &a) in order.iter().enumerate() {
        job::poll();
        let near = order[i + 1..].iter().take_while(|b| all[**b].x - all[a].x <= tolerance.point);
        for &b in near.filter(|b| all[**b].truncate().distance(all[a].truncate()) <= tolerance.point) {
            let (first, last) = (a.min(b), a.max(b));
            if tolerance.same_point(points[a], points[b]) {
                is_duplicate[last] = true;
            } else if same_place.is_none_or(|pair| (first, last) < pair) {
                same_place = Some((first, last));
            }
        }
    }
    if let Some((a, b)) = same_place {
        return Err(ScatterFault::SamePlace { surface: origin, a: points[a], b: points[b], tolerance: tolerance.point }.into());
    }
    let first = is_duplicate.iter().position(|d| *d).map(|k| points[k]);
    Ok(((0..all.len()).filter(|k| !is_duplicate[*k]).collect(), first))
}

/// Of the two normals of a plane the one that points up, or else along y, or x.
fn upward(n: DVec3) -> DVec3 {
    let is_zero = |x: f64| x.abs() <= crate::base::tolerance::PARALLEL;
    let leading = [n.z, n.y, n.x].into_iter().find(|x| !is_zero(*x)).unwrap_or(1.0);
    if leading < 0.0 { -n } else { n }
}

/// Axes across a normal, the first as near to the x-axis as can be (of a plane across it: to the y-axis).
fn axes(n: DVec3) -> [DVec3; 2] {
    const ALONG: f64 = 0.9;
    let towards = if n.x.abs() > ALONG { DVec3::Y } else { DVec3::X };
    let ex = (towards - n * n.dot(towards)).normalize_or(DVec3::X);
    [ex, n.cross(ex)]
}

/// The direction in which points reach least: the eigenvector of the least eigenvalue of their covariance.
fn flattest(points: &[DVec3], center: DVec3) -> DVec3 {
    let size = points.iter().map(|p| (*p - center).abs().max_element()).fold(0.0, f64::max);
    if size <= 0.0 {
        return DVec3::Z;
    }
    let mut a = [[0.0; 3]; 3];
    for p in points {
        let d = (*p - center) / size;
        (0..9).for_each(|k| a[k / 3][k % 3] += d[k / 3] * d[k % 3]);
    }
    let mut vectors = [DVec3::X, DVec3::Y, DVec3::Z];
    for _ in 0..SWEEPS {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut vectors, i, j);
        }
    }
    let least = (0..3).min_by(|i, j| a[*i][*i].total_cmp(&a[*j][*j])).unwrap_or(2);
    vectors[least].normalize_or(DVec3::Z)
}

/// Jacobi's rotation that makes two elements beside the diagonal zero.
fn rotate(a: &mut [[f64; 3]; 3], vectors: &mut [DVec3; 3], i: usize, j: usize) {
    if a[i][j] == 0.0 {
        return;
    }
    let half = (a[j][j] - a[i][i]) / (2.0 * a[i][j]);
    let t = if half.is_finite() { half.signum() / (half.abs() + (half * half + 1.0).sqrt()) } else { 0.0 };
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let k = 3 - i - j;
    let (ii, jj, ij, ik, jk) = (a[i][i], a[j][j], a[i][j], a[i][k], a[j][k]);
    (a[i][i], a[j][j]) = (ii - t * ij, jj + t * ij);
    (a[i][j], a[j][i]) = (0.0, 0.0);
    let (x, y) = (c * ik - s * jk, s * ik + c * jk);
    (a[i][k], a[k][i], a[j][k], a[k][j]) = (x, x, y, y);
    (vectors[i], vectors[j]) = (vectors[i] * c - vectors[j] * s, vectors[i] * s + vectors[j] * c);
}
