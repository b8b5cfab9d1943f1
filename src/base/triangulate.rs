//! Triangles in a polygon: constrained Delaunay in the polygon's mean plane. The only place that knows spade.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use spade::{ConstrainedDelaunayTriangulation, DelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::bbox::Box3;
use super::math::any_normal;
use super::tolerance::PARALLEL;

/// Why a polygon has no triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolygonFault {
    /// Fewer than three different points, or all on one line.
    NoArea,
    /// Sides cross each other in the mean plane.
    Crosses,
}

/// A corner: its place in the plane and its number.
#[derive(Clone, Copy)]
struct Corner {
    at: Point2<f64>,
    index: usize,
}

impl HasPosition for Corner {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// Mean normal of a closed polygon, its length twice the area that the polygon has in its mean plane (Newell).
pub fn newell(points: &[DVec3]) -> DVec3 {
    let Some(origin) = points.first() else { return DVec3::ZERO };
    let turns = points.iter().zip(points.iter().cycle().skip(1));
    turns.map(|(a, b)| (*a - *origin).cross(*b - *origin)).sum()
}

/// Triangles of a simple polygon, concave or not, as indices into `points`, turning as the polygon does.
///
/// Points need not lie in a plane; the triangles are Delaunay in the mean plane. A side that is run twice (a bridge to a
/// hole) bounds nothing. Of equal points the first is used.
pub fn polygon(points: &[DVec3]) -> Result<Vec<[usize; 3]>, PolygonFault> {
    // In units of the box, so that neither tiny nor far polygons meet the limits of the predicates.
    let bounds = Box3::of(points.iter().copied());
    let scaled: Vec<DVec3> = points.iter().map(|p| (*p - bounds.center()) / bounds.diagonal()).collect();
    let normal = newell(&scaled);
    if points.len() < 3 || normal.is_nan() || normal.length() <= PARALLEL {
        return Err(PolygonFault::NoArea);
    }
    if points.len() == 3 {
        return Ok(vec![[0, 1, 2]]);
    }
    let normal = normal.normalize();
    let u = any_normal(normal);
    let v = normal.cross(u);
    let mut triangulation = ConstrainedDelaunayTriangulation::<Corner>::new();
    let mut handles = Vec::with_capacity(points.len());
    for (index, d) in scaled.iter().enumerate() {
        let at = spade::mitigate_underflow(Point2::new(d.dot(u), d.dot(v)));
        let known = triangulation.num_vertices();
        let handle = triangulation.insert(Corner { at, index }).map_err(|_| PolygonFault::NoArea)?;
        // Inserting at a taken place overwrites what is there: the first corner is to stay.
        if triangulation.num_vertices() == known
            && let Some(first) = handles.iter().position(|other| *other == handle)
        {
            triangulation.vertex_data_mut(handle).index = first;
        }
        handles.push(handle);
    }
    let mut passes: BTreeMap<(usize, usize), u32> = BTreeMap::new();
    for (a, b) in handles.iter().zip(handles.iter().cycle().skip(1)).filter(|(a, b)| a != b) {
        let edges = triangulation.try_add_constraint(*a, *b);
        if edges.is_empty() {
            return Err(PolygonFault::Crosses);
        }
        for edge in edges {
            let ends = triangulation.directed_edge(edge).vertices().map(|vertex| vertex.fix().index());
            *passes.entry((ends[0].min(ends[1]), ends[0].max(ends[1]))).or_default() += 1;
        }
    }
    Ok(inner(&triangulation, &passes))
}

/// Delaunay triangles of points of a plane, counter-clockwise, as indices into `points`; all of their convex hull.
///
/// No two points are one, and coordinates are about 1. None where there is no triangle.
pub fn delaunay(points: &[DVec2]) -> Vec<[usize; 3]> {
    let corner = |(index, p): (usize, &DVec2)| Corner { at: spade::mitigate_underflow(Point2::new(p.x, p.y)), index };
    let Ok(made) = DelaunayTriangulation::<Corner>::bulk_load(points.iter().enumerate().map(corner).collect()) else {
        return Vec::new();
    };
    let mut found: Vec<[usize; 3]> = made.inner_faces().map(|face| face.vertices().map(|vertex| vertex.data().index)).collect();
    for t in &mut found {
        let first = (0..3).min_by_key(|k| t[*k]).unwrap_or(0);
        t.rotate_left(first);
    }
    found.sort_unstable();
    found
}

/// Faces that an odd number of border passes separates from the outside.
fn inner(cdt: &ConstrainedDelaunayTriangulation<Corner>, passes: &BTreeMap<(usize, usize), u32>) -> Vec<[usize; 3]> {
    let crosses = |ends: [usize; 2]| passes.get(&(ends[0].min(ends[1]), ends[0].max(ends[1]))).is_some_and(|n| n % 2 == 1);
    let mut inside: Vec<Option<bool>> = vec![None; cdt.num_all_faces()];
    let outer = cdt.outer_face().index();
    inside[outer] = Some(false);
    let mut open = Vec::new();
    for edge in cdt.convex_hull() {
        let (rim, ends) = (edge.rev().face(), edge.vertices().map(|vertex| vertex.index()));
        // The hull runs along the outer face on one side; whichever side is inner gets its flag.
        for face in [rim, edge.face()].into_iter().filter(|face| !face.is_outer()) {
            if inside[face.index()].is_none() {
                inside[face.index()] = Some(crosses(ends));
                open.push(face.fix());
            }
        }
    }
    while let Some(face) = open.pop() {
        let here = inside[face.index()] == Some(true);
        let Some(face) = cdt.face(face).as_inner() else { continue };
        for edge in face.adjacent_edges() {
            let next = edge.rev().face();
            if inside[next.index()].is_none() {
                inside[next.index()] = Some(here != crosses(edge.vertices().map(|vertex| vertex.index())));
                open.push(next.fix());
            }
        }
    }
    cdt.inner_faces()
        .filter(|face| inside[face.index()] == Some(true))
        .map(|face| face.vertices().map(|vertex| vertex.data().index))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[DVec3], triangles: &[[usize; 3]]) -> f64 {
        let sides = |t: &[usize; 3]| (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
        triangles.iter().map(|t| sides(t).dot(newell(points).normalize()) / 2.0).sum()
    }

    fn flat(corners: &[(f64, f64)]) -> Vec<DVec3> {
        corners.iter().map(|(x, y)| DVec3::new(*x, *y, 0.5 * x)).collect()
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        let ell = flat(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]);
        for points in [ell.clone(), ell.iter().rev().copied().collect(), ell.iter().map(|p| *p * 1e-70).collect()] {
            let triangles = polygon(&points).unwrap();
            assert_eq!(triangles.len(), 4);
            let expected = newell(&points).length() / 2.0;
            assert!((area(&points, &triangles) - expected).abs() <= 1e-12 * expected);
        }
    }

    #[test]
    fn a_bridge_to_a_hole_bounds_nothing() {
        let frame =
            [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0), (0.0, 0.0), (1.0, 1.0), (1.0, 2.0), (2.0, 2.0), (2.0, 1.0), (1.0, 1.0)];
        let points = flat(&frame);
        let triangles = polygon(&points).unwrap();
        assert_eq!(triangles.len(), 8);
        assert!((area(&points, &triangles) - newell(&points).length() / 2.0).abs() < 1e-12);
        assert!(triangles.as_flattened().iter().all(|n| !matches!(n, 4 | 9)));
    }

    #[test]
    fn points_on_a_side_and_bad_polygons() {
        assert_eq!(polygon(&flat(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0)])).unwrap().len(), 2);
        assert_eq!(polygon(&flat(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 3.0)])), Err(PolygonFault::Crosses));
        assert_eq!(polygon(&flat(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)])), Err(PolygonFault::NoArea));
        assert_eq!(polygon(&flat(&[(0.0, 0.0)])), Err(PolygonFault::NoArea));
        assert_eq!(polygon(&[]), Err(PolygonFault::NoArea));
    }
}
