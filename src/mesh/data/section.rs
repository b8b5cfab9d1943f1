//! Plane sections of meshes: rows of points joined by the edges of the mesh, not by coordinates.
//!
//! Every node is above the plane or below it; nodes in the plane count as above. So each triangle is cut through two of its edges or
//! none, each inner edge ends one segment on either side, and the rows close without gaps whatever lies in the plane. A
//! cut edge with its upper node in the plane is cut at that node, and points that follow each other at one node are one.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::mesh::data::mesh::Mesh;

/// A row of points in the plane of a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The points; of a closed row the first is not repeated.
    pub points: Vec<DVec3>,
    /// Whether the last point joins the first.
    pub closed: bool,
}

/// An edge by its nodes, the smaller first.
type Edge = (u32, u32);

fn edge(a: u32, b: u32) -> Edge {
    (a.min(b), a.max(b))
}

/// The section of the faces of a mesh by the plane through a point with a unit normal: closed rows, open ones where they
/// run into a free edge. Those around material run counter-clockwise seen against the normal.
///
/// Nodes nearer to the plane than `rounding` lie in it. Points nearer to the one before than `least` are left out, and
/// rows that are no longer. Elements of order 2 count with the straight lines between all their nodes.
pub fn section(mesh: &Mesh, at: DVec3, normal: DVec3, rounding: f64, least: f64) -> Vec<Row> {
    let heights: Vec<f64> = mesh.nodes.iter().map(|p| (*p - at).dot(normal)).map(|h| if h.abs() <= rounding { 0.0 } else { h }).collect();
    let above = |n: u32| heights[n as usize] >= 0.0;
    let mut segments: Vec<(Edge, Edge)> = Vec::new();
    for [a, b, c] in triangles(mesh) {
        let sides = [(a, b), (b, c), (c, a)];
        let falls = sides.iter().find(|(p, q)| above(*p) && !above(*q));
        let rises = sides.iter().find(|(p, q)| !above(*p) && above(*q));
        if let (Some((p, q)), Some((r, s))) = (falls, rises) {
            segments.push((edge(*p, *q), edge(*r, *s)));
        }
    }
    let point = |(a, b): Edge| {
        let (x, y) = (heights[a as usize], heights[b as usize]);
        let (p, q) = (mesh.nodes[a as usize], mesh.nodes[b as usize]);
        if x == 0.0 {
            p
        } else if y == 0.0 {
            q
        } else {
            p.lerp(q, x / (x - y))
        }
    };
    let rows = chained(&segments).into_iter().map(|(edges, closed)| tidied(edges.into_iter().map(point).collect(), closed, least));
    rows.flatten().collect()
}

/// All faces as triangles between neighbouring nodes; both faces at an edge have its parts in common.
fn triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
    let mut out = Vec::new();
    for (k, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        match mesh.triangle_mids.get(k) {
            Some(&[ab, bc, ca]) => out.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]),
            None => out.push([a, b, c]),
        }
    }
    for (k, &[a, b, c, d]) in mesh.quads.iter().enumerate() {
        match mesh.quad_mids.get(k) {
            Some(&[ab, bc, cd, da]) => {
                out.extend([[a, ab, da], [b, bc, ab], [c, cd, bc], [d, da, cd], [ab, bc, cd], [ab, cd, da]]);
            }
            None => out.extend([[a, b, c], [a, c, d]]),
        }
    }
    out
}

/// Segments in rows: open ones from their ends first, then closed ones. Neighbours that are turned over are followed all the same.
fn chained(segments: &[(Edge, Edge)]) -> Vec<(Vec<Edge>, bool)> {
    let mut at: BTreeMap<Edge, Vec<usize>> = BTreeMap::new();
    for (k, (from, to)) in segments.iter().enumerate() {
        at.entry(*from).or_default().push(k);
        at.entry(*to).or_default().push(k);
    }
    let mut used = vec![false; segments.len()];
    let mut rows = Vec::new();
    for ends_only in [true, false] {
        for k in 0..segments.len() {
            let starts = at[&segments[k].0].len() % 2 == 1;
            let stops = at[&segments[k].1].len() % 2 == 1;
            if used[k] || ends_only && !starts && !stops {
                continue;
            }
            let backwards = ends_only && !starts;
            let mut row = followed(segments, &at, &mut used, k, backwards);
            let closed = row.len() > 2 && row.first() == row.last();
            if closed {
                row.pop();
            }
            if backwards {
                row.reverse();
            }
            rows.push((row, closed));
        }
    }
    rows
}

/// The row that begins with a segment, from its first edge or backwards from its last.
fn followed(segments: &[(Edge, Edge)], at: &BTreeMap<Edge, Vec<usize>>, used: &mut [bool], first: usize, backwards: bool) -> Vec<Edge> {
    let (from, to) = segments[first];
    let mut row = if backwards { vec![to, from] } else { vec![from, to] };
    used[first] = true;
    loop {
        let here = row[row.len() - 1];
        let Some(&next) = at[&here].iter().find(|k| !used[**k]) else { return row };
        used[next] = true;
        let (a, b) = segments[next];
        row.push(if a == here { b } else { a });
        if row[row.len() - 1] == row[0] {
            return row;
        }
    }
}

/// A row without points that are one with the point before; `None` when nothing is left of it.
fn tidied(points: Vec<DVec3>, closed: bool, least: f64) -> Option<Row> {
    let mut kept: Vec<DVec3> = Vec::with_capacity(points.len());
    for p in points {
        if kept.last().is_none_or(|q| q.distance(p) > least) {
            kept.push(p);
        }
    }
    while closed && kept.len() > 1 && kept[0].distance(kept[kept.len() - 1]) <= least {
        kept.pop();
    }
    // A loop of two points runs forth and back over one line: a face on edge that only touches.
    let enough = if closed { kept.len() > 2 } else { kept.len() > 1 };
    enough.then_some(Row { points: kept, closed })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of 1 with corners at whole numbers, all sides split into triangles, normals outward.
    fn cube() -> Mesh {
        let nodes = (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.into_iter().flat_map(|[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]]).collect();
        Mesh { nodes, triangles, order: 1, ..Mesh::default() }
    }

    fn length(row: &Row) -> f64 {
        let n = row.points.len();
        (0..if row.closed { n } else { n - 1 }).map(|k| row.points[k].distance(row.points[(k + 1) % n])).sum()
    }

    fn cut(mesh: &Mesh, at: DVec3, normal: DVec3) -> Vec<Row> {
        section(mesh, at, normal.normalize(), 1e-12, 1e-9)
    }

    #[test]
    fn a_cube_is_cut_in_polygons() {
        let cube = cube();
        let half = DVec3::splat(0.5);
        for (at, normal, wanted) in [
            (half, DVec3::Z, Some(4.0)),
            // Through four nodes, and along two diagonals.
            (half, DVec3::new(1.0, 1.0, 0.0), Some(2.0 + 2.0 * 2.0_f64.sqrt())),
            (half, DVec3::new(1.0, -1.0, 0.0), Some(2.0 + 2.0 * 2.0_f64.sqrt())),
            // A hexagon through no node, a triangle through three.
            (half, DVec3::ONE, Some(3.0 * 2.0_f64.sqrt())),
            (DVec3::X, DVec3::ONE, Some(3.0 * 2.0_f64.sqrt())),
            (DVec3::ONE, DVec3::ONE, None),
            (DVec3::ZERO, DVec3::ONE, None),
            // A side in the plane counts as above it.
            (DVec3::Z, DVec3::Z, Some(4.0)),
            (DVec3::ZERO, DVec3::Z, None),
            (DVec3::Z * 2.0, DVec3::Z, None),
        ] {
            let rows = cut(&cube, at, normal);
            let found = (rows.len() == 1).then(|| length(&rows[0]));
            assert!(rows.len() <= 1 && rows.iter().all(|r| r.closed), "{at} {normal}: {rows:?}");
            assert!((found.unwrap_or(0.0) - wanted.unwrap_or(0.0)).abs() < 1e-12, "{at} {normal}: {rows:?}");
        }
        let ring = &cut(&cube, half, DVec3::Z)[0].points;
        let area: DVec3 = (0..ring.len()).map(|k| ring[k].cross(ring[(k + 1) % ring.len()])).sum();
        assert!((0.5 * area.z - 1.0).abs() < 1e-12, "counter-clockwise: {area}");
    }

    /// Without its top the cube is open: a plane through the opening gives one open row.
    #[test]
    fn open_meshes_give_open_rows() {
        let mut cube = cube();
        cube.triangles.drain(2..4);
        let rows = cut(&cube, DVec3::splat(0.5), DVec3::X);
        assert!(matches!(rows.as_slice(), [row] if !row.closed && (length(row) - 3.0).abs() < 1e-12), "{rows:?}");
        // Turned over, one side is still followed.
        cube.triangles[4].swap(0, 1);
        cube.triangles[5].swap(0, 1);
        let rows = cut(&cube, DVec3::splat(0.5), DVec3::X);
        assert!(matches!(rows.as_slice(), [row] if !row.closed && (length(row) - 3.0).abs() < 1e-12), "{rows:?}");
    }
}
