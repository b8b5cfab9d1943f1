//! The constrained Delaunay triangulation of points in a plane, as plain arrays.

use glam::DVec2;

use super::job;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

/// Why points and edges have no triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointsFault {
    /// Two points are at one place.
    Same(u32, u32),
    /// This edge crosses another one, or runs through a point.
    Crosses(u32, u32),
    /// All points are on one line.
    Flat,
}

/// Triangles with their neighbours; they fill the convex hull of the points.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// Corners, counter-clockwise.
    pub corners: Vec<[u32; 3]>,
    /// The triangle across the side opposite each corner; [`NO_TRIANGLE`] outside the hull.
    pub across: Vec<[u32; 3]>,
    /// Bit k: the side opposite corner k is one of the given edges.
    pub given: Vec<u8>,
}

/// Where there is no triangle.
pub const NO_TRIANGLE: u32 = u32::MAX;

/// One of so many nodes looks whether the triangulation should go on when it is asked where it is.
const NODES_PER_LOOK: u32 = 32;

#[derive(Clone, Copy)]
struct Node {
    at: Point2<f64>,
    index: u32,
}

impl HasPosition for Node {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        // The only place of ours that a long triangulation comes by: every predicate asks for its points.
        if self.index.is_multiple_of(NODES_PER_LOOK) {
            job::poll();
        }
        self.at
    }
}

/// Triangulates points with edges that must be there, by exact predicates; the same input gives the same triangles.
///
/// Fails where two points fall together, edges cross, or the points have no area. Indices of `edges` must be of `points`.
pub fn points(points: &[DVec2], edges: &[[u32; 2]]) -> Result<Triangles, PointsFault> {
    super::work::spend(4 * points.len() as u64);
    let (low, high) = points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    let scale = 1.0 / (high - low).max_element().max(f64::MIN_POSITIVE);
    let middle = 0.5 * (low + high);
    let nodes: Vec<Node> = points
        .iter()
        .enumerate()
        .map(|(k, p)| {
            let q = (*p - middle) * scale;
            Node { at: spade::mitigate_underflow(Point2::new(q.x, q.y)), index: k as u32 }
        })
        .collect();
    // Loaded together with the edges, what lies on the hull would come in the order of a hash set with random seeds: another triangulation
    // in each run.
    let mut cdt = ConstrainedDelaunayTriangulation::<Node>::bulk_load(nodes).map_err(|_| PointsFault::Flat)?;
    if cdt.num_vertices() != points.len() {
        return Err(twins(points).map_or(PointsFault::Flat, |(a, b)| PointsFault::Same(a, b)));
    }
    if cdt.num_inner_faces() == 0 {
        return Err(PointsFault::Flat);
    }
    let mut vertices = vec![None; points.len()];
    cdt.vertices().for_each(|vertex| vertices[vertex.data().index as usize] = Some(vertex.fix()));
    for [a, b] in job::looking(edges.iter().copied()) {
        if let (Some(from), Some(to)) = (vertices[a as usize], vertices[b as usize])
            // Nothing where it crosses another edge, several where points lie on it.
            && cdt.try_add_constraint(from, to).len() != 1
        {
            return Err(PointsFault::Crosses(a, b));
        }
    }
    // In the order of their corners: that of loading follows distances from the middle of all, which the last bit of a point changes.
    let mut faces: Vec<([u32; 3], usize, usize)> = job::looking(cdt.inner_faces().enumerate())
        .map(|(k, face)| {
            let mut corners = face.vertices().map(|vertex| vertex.data().index);
            let first = (0..3).min_by_key(|k| corners[*k]).unwrap_or(0);
            corners.rotate_left(first);
            (corners, first, k)
        })
        .collect();
    job::sort(&mut faces);
    let mut place = vec![NO_TRIANGLE; faces.len()];
    faces.iter().enumerate().for_each(|(k, (.., face))| place[*face] = k as u32);
    let handles: Vec<_> = cdt.inner_faces().map(|face| face.fix()).collect();
    let mut result = Triangles { corners: faces.iter().map(|(corners, ..)| *corners).collect(), ..Triangles::default() };
    for (_, first, face) in job::looking(faces) {
        let mut sides = cdt.face(handles[face]).adjacent_edges();
        sides.rotate_left(first);
        let (mut across, mut fixed) = ([NO_TRIANGLE; 3], 0);
        for (k, side) in sides.iter().enumerate() {
            // Side k runs from corner k to the next one: opposite the third.
            let opposite = (k + 2) % 3;
            if let Some(other) = side.rev().face().as_inner() {
                // The outer face is the first of all.
                across[opposite] = place[other.index() - 1];
            }
            fixed |= u8::from(side.is_constraint_edge()) << opposite;
        }
        result.across.push(across);
        result.given.push(fixed);
    }
    Ok(result)
}

/// Two points at one place.
fn twins(points: &[DVec2]) -> Option<(u32, u32)> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let key = |n: u32| points[n as usize];
    order.sort_by(|a, b| key(*a).x.total_cmp(&key(*b).x).then(key(*a).y.total_cmp(&key(*b).y)).then(a.cmp(b)));
    order.windows(2).find(|w| key(w[0]) == key(w[1])).map(|w| (w[0], w[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::powi;

    #[test]
    fn a_cusp_has_the_same_triangles_each_time() {
        let mut places = vec![DVec2::new(0.5, 0.5), DVec2::new(0.5, -0.5)];
        for s in (8..160).map(|k| powi(0.917, k)) {
            places.extend([DVec2::new(s - 0.5, 0.0), DVec2::new(s - 0.5, s * s * s)]);
        }
        let edges: Vec<[u32; 2]> = (2..20).map(|k| [2 * k, 2 * k + 2]).collect();
        let all = || points(&places, &edges).map(|all| (all.corners, all.across, all.given));
        let first = all();
        assert!(first.as_ref().is_ok_and(|all| all.0.len() > 500));
        assert!((0..20).all(|_| all() == first));
    }
}
