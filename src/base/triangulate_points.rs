//! The constrained Delaunay triangulation of points in a plane, as plain arrays.

use std::cmp::Ordering;

use glam::DVec2;

use super::job;
use super::math::compare_points;
use super::predicates::orient;
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

/// Number of points nearest to the mean that are checked for lying on one line before a bulk load.
const FIRST_OF_LOAD: usize = 64;

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
    let one_place = || twins(points).map_or(PointsFault::Flat, |(a, b)| PointsFault::Same(a, b));
    let mut cdt = delaunay(nodes).ok_or_else(one_place)?;
    if cdt.num_vertices() != points.len() {
        return Err(one_place());
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
    drop(vertices);
    let (corners, given) = by_corners(&cdt);
    // What the triangulation knows of neighbours takes several times the memory of the triangles.
    drop(cdt);
    let across = across(&corners, points.len());
    Ok(Triangles { corners, across, given })
}

/// The Delaunay triangulation of points without edges; `None` where many points are all on one line, or a coordinate is no number.
///
/// spade's bulk load inserts points by their distance from the mean, and as long as all inserted ones are on one line it sorts them again for each
/// new one. Where that would be many, as on a border that is flat in its chart, points are inserted one by one: first one off the line, then
/// those along it.
fn delaunay(mut nodes: Vec<Node>) -> Option<ConstrainedDelaunayTriangulation<Node>> {
    let place = |node: &Node| DVec2::new(node.at.x, node.at.y);
    let mean = nodes.iter().map(place).sum::<DVec2>() / nodes.len().max(1) as f64;
    let mut nearest: Vec<DVec2> = nodes.iter().map(place).collect();
    if nearest.len() > FIRST_OF_LOAD {
        nearest.select_nth_unstable_by(FIRST_OF_LOAD, |p, q| p.distance_squared(mean).total_cmp(&q.distance_squared(mean)));
        nearest.truncate(FIRST_OF_LOAD);
    }
    let (a, b) = most_distant(&nearest)?;
    if nearest.len() < FIRST_OF_LOAD || nearest.iter().any(|p| orient(a, b, *p) != 0.0) {
        drop(nearest);
        return ConstrainedDelaunayTriangulation::bulk_load(nodes).ok();
    }
    let along = |node: &Node| (place(node) - a).dot(b - a);
    nodes.sort_unstable_by(|m, n| along(m).total_cmp(&along(n)).then(m.index.cmp(&n.index)));
    // The first point off the line.
    let apex = nodes.iter().position(|node| orient(a, b, place(node)) != 0.0)?;
    // Each point goes between two that are there already, near the middle: few triangles change.
    let spans = std::iter::successors(Some(nodes.len().next_power_of_two()), |span| (*span > 1).then_some(span / 2));
    let halving = spans.flat_map(|span| (0..nodes.len()).step_by(span).filter(move |k| k / span % 2 == 1));
    let others = std::iter::once(0).chain(halving).filter(|k| *k != apex);
    let mut cdt = ConstrainedDelaunayTriangulation::new();
    std::iter::once(apex).chain(others).try_for_each(|k| cdt.insert(nodes[k]).map(|_| ())).ok()?;
    Some(cdt)
}

/// The first and the last of points by their coordinates: two ends of the line where they are all on one.
fn most_distant(points: &[DVec2]) -> Option<(DVec2, DVec2)> {
    let low = points.iter().copied().min_by(by_coordinates)?;
    Some((low, points.iter().copied().max_by(by_coordinates)?))
}

fn by_coordinates(p: &DVec2, q: &DVec2) -> Ordering {
    compare_points(p.extend(0.0), q.extend(0.0))
}

/// The inner faces in the order of their corners, each from the least one on, and which of their sides are given: the order of loading follows
/// distances from the middle of all, which the last bit of a point changes. A counting sort by the least corner.
fn by_corners(cdt: &ConstrainedDelaunayTriangulation<Node>) -> (Vec<[u32; 3]>, Vec<u8>) {
    let least = |corners: &[u32; 3]| (0..3).min_by_key(|k| corners[*k]).unwrap_or(0);
    let mut starts = vec![0_u32; cdt.num_vertices() + 1];
    for face in job::looking(cdt.inner_faces()) {
        let corners = face.vertices().map(|vertex| vertex.data().index);
        starts[corners[least(&corners)] as usize + 1] += 1;
    }
    for n in 1..starts.len() {
        starts[n] += starts[n - 1];
    }
    let mut faces = vec![[NO_TRIANGLE; 3]; cdt.num_inner_faces()];
    let mut given = vec![0_u8; cdt.num_inner_faces()];
    for face in job::looking(cdt.inner_faces()) {
        let mut corners = face.vertices().map(|vertex| vertex.data().index);
        let mut sides = face.adjacent_edges();
        let first = least(&corners);
        corners.rotate_left(first);
        sides.rotate_left(first);
        let slot = &mut starts[corners[0] as usize];
        faces[*slot as usize] = corners;
        // Side k runs from corner k to the next one: opposite the third.
        given[*slot as usize] =
            sides.iter().enumerate().fold(0, |bits, (k, side)| bits | u8::from(side.is_constraint_edge()) << ((k + 2) % 3));
        *slot += 1;
    }
    // Each start is now where the faces of the next node begin.
    let (mut from, mut own) = (0, Vec::new());
    for to in job::looking(starts) {
        let range = from..to as usize;
        own.clear();
        own.extend(range.clone().map(|k| (faces[k], given[k])));
        own.sort_unstable();
        range.zip(&own).for_each(|(k, (corners, bits))| (faces[k], given[k]) = (*corners, *bits));
        from = to as usize;
    }
    (faces, given)
}

/// The triangle across each side of each triangle, by the sides at each node: a counting sort by the lower node of a side.
fn across(corners: &[[u32; 3]], nodes: usize) -> Vec<[u32; 3]> {
    /// The ends of a side by its number: three a triangle, each opposite a corner.
    fn ends(corners: &[[u32; 3]], side: u32) -> (u32, u32) {
        let (t, k) = (corners[side as usize / 3], side as usize % 3);
        let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
        (a.min(b), a.max(b))
    }
    let all = 3 * corners.len() as u32;
    let mut starts = vec![0_u32; nodes + 1];
    job::looking(0..all).for_each(|side| starts[ends(corners, side).0 as usize + 1] += 1);
    for n in 1..starts.len() {
        starts[n] += starts[n - 1];
    }
    let mut sides = vec![0_u32; all as usize];
    for side in job::looking(0..all) {
        let slot = &mut starts[ends(corners, side).0 as usize];
        sides[*slot as usize] = side;
        *slot += 1;
    }
    let mut across = vec![[NO_TRIANGLE; 3]; corners.len()];
    let mut from = 0;
    for to in job::looking(starts) {
        let own = &mut sides[from..to as usize];
        own.sort_unstable_by_key(|side| (ends(corners, *side).1, *side));
        for pair in own.chunk_by(|a, b| ends(corners, *a) == ends(corners, *b)) {
            if let [a, b] = *pair {
                across[a as usize / 3][a as usize % 3] = b / 3;
                across[b as usize / 3][b as usize % 3] = a / 3;
            }
        }
        from = to as usize;
    }
    across
}

/// Two points at one place.
fn twins(points: &[DVec2]) -> Option<(u32, u32)> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let key = |n: u32| points[n as usize];
    order.sort_by(|a, b| by_coordinates(&key(*a), &key(*b)).then(a.cmp(b)));
    order.windows(2).find(|w| key(w[0]) == key(w[1])).map(|w| (w[0], w[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::powi;

    #[test]
    fn points_on_a_line_are_flat_and_one_beside_makes_a_fan_in_time() {
        let n = 40_000;
        let mut places: Vec<DVec2> = (0..n).map(|k| DVec2::new(f64::from(k * 7919 % n), 0.0)).collect();
        assert_eq!(points(&places, &[]).err(), Some(PointsFault::Flat));
        places.push(DVec2::new(0.3 * f64::from(n), 1e-3));
        let fan = points(&places, &[[0, 1]]);
        assert_eq!(fan.map(|fan| fan.corners.len()), Err(PointsFault::Crosses(0, 1)));
        assert_eq!(points(&places, &[]).map(|fan| fan.corners.len()), Ok(n as usize - 1));
        places.push(places[17]);
        assert_eq!(points(&places, &[]).err(), Some(PointsFault::Same(17, n as u32 + 1)));
    }

    #[test]
    fn points_nearly_on_a_line_are_all_triangulated() {
        let n = 60_000;
        let wave = |k: i32| DVec2::new(f64::from(k), if (k - n / 2).abs() < 2000 { 0.0 } else { 1e-12 * f64::from(k % 7) });
        let places: Vec<DVec2> = (0..n).map(wave).collect();
        let all = points(&places, &[]).unwrap();
        assert!(all.corners.iter().all(|[a, b, c]| orient(places[*a as usize], places[*b as usize], places[*c as usize]) > 0.0));
        // Euler: 2 n − 2 less the sides of the hull.
        let hull = all.across.iter().flatten().filter(|t| **t == NO_TRIANGLE).count();
        assert_eq!(all.corners.len(), 2 * n as usize - 2 - hull);
    }

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
