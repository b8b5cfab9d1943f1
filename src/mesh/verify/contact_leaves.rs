//! Elements of a face in small boxes, to find those near a point or a line.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::job;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::deviation::point_triangle;
use crate::mesh::verify::contact_reach::{BULGE, FaceBulge};

/// Number of elements in a box.
const LEAF_SIZE: usize = 8;
/// Share of the way from a node of the border to the middle of its element.
const INWARD_SHARE: f64 = 0.25;

/// The triangles of a face, quads as two, in boxes.
pub struct Leaves {
    triangles: Vec<[u32; 3]>,
    /// The box of each leaf of triangles.
    boxes: Vec<Box3>,
    tree: BoxTree,
    /// How far the face may be from each box's triangles, model units.
    reach: Vec<f64>,
    /// The largest of them.
    most: f64,
    /// The box of the face itself.
    pub hull: Box3,
    /// All triangles lie in one plane.
    flat: bool,
    /// The face itself is a plane.
    plane: bool,
}

impl Leaves {
    /// The elements of a face of a mesh by its number; `glued` is how far nodes of its border may be from its surface.
    pub fn new(mesh: &Mesh, face: usize, flat: bool, (near, glued): (f64, f64)) -> Self {
        let range = |r: &std::ops::Range<u32>| r.start as usize..r.end as usize;
        let own = &mesh.faces[face];
        let halves = |q: &[u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]];
        let mut triangles = mesh.triangles[range(&own.triangles)].to_vec();
        triangles.extend(mesh.quads[range(&own.quads)].iter().flat_map(halves));
        let (mut boxes, mut reach) = (Vec::new(), Vec::new());
        let bulge = if flat { None } else { FaceBulge::new(mesh, face) };
        for (k, leaf) in triangles.chunks(LEAF_SIZE).enumerate() {
            job::poll();
            let around = leaf.iter().flatten().fold(Box3::EMPTY, |all, n| all.with(mesh.nodes[*n as usize]));
            let longest = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|n| mesh.nodes[n as usize]);
                a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
            };
            let most = || BULGE * leaf.iter().map(longest).fold(0.0, f64::max).sqrt();
            let known = |bulge: &FaceBulge| (k * LEAF_SIZE..k * LEAF_SIZE + leaf.len()).map(|t| bulge.of(t)).fold(0.0, f64::max);
            let by = if flat { near } else { near + most().min(bulge.as_ref().map_or(f64::INFINITY, |bulge| glued + known(bulge))) };
            boxes.push(around);
            reach.push(by);
        }
        let most = reach.iter().copied().fold(near, f64::max);
        let hull = boxes.iter().fold(Box3::EMPTY, |all, b| all.union(*b));
        let hull = Box3 { min: hull.min - DVec3::splat(most), max: hull.max + DVec3::splat(most) };
        let plane = flat;
        let flat = flat || is_flat(mesh, &triangles, near);
        Self { triangles, tree: BoxTree::build(&boxes), boxes, reach, most, hull, flat, plane }
    }

    /// Whether all triangles lie in one plane.
    pub fn is_flat(&self) -> bool {
        self.flat
    }

    /// Whether the face itself is a plane.
    pub fn is_plane(&self) -> bool {
        self.plane
    }

    /// Whether some triangles of two faces come as near each other as their faces may be from them, by their boxes.
    pub fn near(&self, other: &Self) -> bool {
        let mut found = false;
        self.tree.pairs_with(&other.tree, self.most + other.most, |a, b| {
            found |= self.boxes[a].touches(&other.boxes[b], self.reach[a] + other.reach[b]);
        });
        found
    }

    /// Whether the face may come near the line between two points, as far as `bend`, beside those of its ends that it has itself.
    pub fn beside_line(&self, mesh: &Mesh, (p, q): (DVec3, DVec3), (first, last): (bool, bool), bend: f64) -> bool {
        /// Length of the part of a line at an end on the face that does not count, over the reach of the face.
        const EXCLUDED_LENGTH: f64 = 2.0;
        /// Least and largest share of the line that does not count at such an end.
        const EXCLUDED_SHARE: (f64, f64) = (0.01, 0.5);
        let mut found = false;
        self.tree.query(&Box3::of([p, q]), self.most + bend, |k| {
            let reach = self.reach[k] + bend;
            let part = (EXCLUDED_LENGTH * reach / p.distance(q)).clamp(EXCLUDED_SHARE.0, EXCLUDED_SHARE.1);
            let (low, high) = (if first { part } else { 0.0 }, if last { 1.0 - part } else { 1.0 });
            found = found
                || self.leaf(k).iter().any(|t| {
                    let corners = t.map(|n| mesh.nodes[n as usize]);
                    part_near(corners, (p, q), reach).is_some_and(|(from, to)| from <= high && to >= low)
                });
        });
        found
    }

    /// A place inside the face off a point of its border, about so far; nearer where its element is small.
    pub fn inwards(&self, mesh: &Mesh, p: DVec3, by: f64) -> Option<DVec3> {
        let mut best: Option<(f64, DVec3)> = None;
        self.tree.query(&Box3::of([p]), self.most, |k| {
            for t in self.leaf(k) {
                let corners = t.map(|n| mesh.nodes[n as usize]);
                let (off, middle) = (point_triangle::distance(corners, p), corners.iter().sum::<DVec3>() / 3.0);
                if best.is_none_or(|b| off < b.0 || off == b.0 && crate::base::math::compare_points(middle, b.1).is_lt()) {
                    best = Some((off, middle));
                }
            }
        });
        let (_, middle) = best?;
        let far = p.distance(middle);
        (far > 0.0).then(|| p.lerp(middle, INWARD_SHARE.min(by / far)))
    }

    fn leaf(&self, k: usize) -> &[[u32; 3]] {
        &self.triangles[k * LEAF_SIZE..((k + 1) * LEAF_SIZE).min(self.triangles.len())]
    }

    /// Whether the face may hold a point: a triangle is near it.
    pub fn holds(&self, mesh: &Mesh, p: DVec3) -> bool {
        let mut found = false;
        self.tree.query(&Box3::of([p]), self.most, |k| {
            found |= self.leaf(k).iter().any(|t| point_triangle::distance(t.map(|n| mesh.nodes[n as usize]), p) <= self.reach[k]);
        });
        found
    }

    /// Where a line between two points goes through a triangle, or past its border within `near`.
    pub fn pierced(&self, mesh: &Mesh, (p, q): (DVec3, DVec3), near: f64) -> Option<DVec3> {
        let mut found: Option<DVec3> = None;
        self.tree.query(&Box3::of([p, q]), near, |k| {
            if found.is_none() {
                found = self.leaf(k).iter().find_map(|t| through(t.map(|n| mesh.nodes[n as usize]), (p, q), near));
            }
        });
        found
    }

    /// A place inside the face, off its border where it has nodes there.
    pub fn place(&self, mesh: &Mesh) -> Option<DVec3> {
        let t = self.triangles.get(self.triangles.len() / 2)?;
        Some(t.iter().map(|n| mesh.nodes[*n as usize]).sum::<DVec3>() / 3.0)
    }

    /// A place inside the face beside one of its nodes.
    pub fn beside(&self, mesh: &Mesh, node: u32) -> Option<DVec3> {
        let p = mesh.nodes[node as usize];
        let mut found = None;
        self.tree.query(&Box3::of([p]), 0.0, |k| {
            if let (None, Some(t)) = (found, self.leaf(k).iter().find(|t| t.contains(&node))) {
                found = Some(p.lerp(t.iter().map(|n| mesh.nodes[*n as usize]).sum::<DVec3>() / 3.0, INWARD_SHARE));
            }
        });
        found
    }

    /// The triangles of a leaf whose boxes touch a box, with their corners.
    fn within(&self, mesh: &Mesh, leaf: usize, around: &Box3, out: &mut Vec<([u32; 3], [DVec3; 3], Box3)>) {
        out.clear();
        for t in self.leaf(leaf) {
            let corners = t.map(|n| mesh.nodes[n as usize]);
            let own = Box3::of(corners);
            if own.touches(around, 0.0) {
                out.push((*t, corners, own));
            }
        }
    }

    /// How often a line between two points goes through triangles.
    pub fn pierces(&self, mesh: &Mesh, line: (DVec3, DVec3)) -> usize {
        let mut count = 0;
        self.tree.query(&Box3::of([line.0, line.1]), 0.0, |k| {
            count += self.leaf(k).iter().filter(|t| through(t.map(|n| mesh.nodes[n as usize]), line, 0.0).is_some()).count();
        });
        count
    }

    /// Up to so many places where triangles of two faces that share no node go through each other; the faces may be of two meshes.
    pub fn crossings(&self, mesh: &Mesh, other: &Self, other_mesh: &Mesh, most: usize) -> Vec<DVec3> {
        let is_one = std::ptr::eq(mesh, other_mesh);
        let mut pairs = Vec::new();
        self.tree.pairs_with(&other.tree, 0.0, |a, b| pairs.push((a, b)));
        pairs.sort_unstable();
        let mut found = Vec::new();
        let (mut own, mut others) = (Vec::new(), Vec::new());
        for (a, b) in pairs {
            job::poll();
            self.within(mesh, a, &other.boxes[b], &mut own);
            if own.is_empty() {
                continue;
            }
            other.within(other_mesh, b, &self.boxes[a], &mut others);
            for (s, corners, around) in &own {
                for (t, faces, box_of) in &others {
                    if !around.touches(box_of, 0.0) {
                        continue;
                    }
                    if !is_one {
                        found.extend(middle_of_crossing(*corners, *faces));
                    } else if !t.iter().any(|n| s.contains(n)) {
                        found.extend(crossing(*corners, *faces).or_else(|| crossing(*faces, *corners)));
                    }
                }
            }
            if found.len() >= most {
                break;
            }
        }
        found.truncate(most);
        found
    }
}

/// Whether all nodes of triangles lie in the plane of the first of them that has one.
fn is_flat(mesh: &Mesh, triangles: &[[u32; 3]], near: f64) -> bool {
    let p = |n: u32| mesh.nodes[n as usize];
    let normal = |t: &[u32; 3]| (p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0])).normalize_or_zero();
    let plane = triangles.iter().map(|t| (normal(t), p(t[0]))).find(|(n, _)| *n != DVec3::ZERO);
    plane.is_none_or(|(n, at)| triangles.iter().flatten().all(|k| n.dot(p(*k) - at).abs() <= near))
}

/// Where an edge of one triangle goes through another one.
fn crossing(edges: [DVec3; 3], face: [DVec3; 3]) -> Option<DVec3> {
    (0..3).find_map(|k| through(face, (edges[k], edges[(k + 1) % 3]), 0.0))
}

/// The middle of the line along which two triangles cross.
fn middle_of_crossing(a: [DVec3; 3], b: [DVec3; 3]) -> Option<DVec3> {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for (edges, face) in [(a, b), (b, a)] {
        for p in (0..3).filter_map(|k| through(face, (edges[k], edges[(k + 1) % 3]), 0.0)) {
            (sum, count) = (sum + p, count + 1.0);
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// Where the line between two points goes through a triangle from one side to the other, or past its border within `near`.
fn through([a, b, c]: [DVec3; 3], (p, q): (DVec3, DVec3), near: f64) -> Option<DVec3> {
    let normal = (b - a).cross(c - a);
    let (from, to) = (normal.dot(p - a), normal.dot(q - a));
    if from * to >= 0.0 {
        return None;
    }
    let at = p.lerp(q, from / (from - to));
    let slack = near * normal.length();
    let inside = |x: DVec3, y: DVec3| (y - x).cross(at - x).dot(normal) >= -slack * x.distance(y);
    (inside(a, b) && inside(b, c) && inside(c, a)).then_some(at)
}

/// Shares of the line between two points within which it may be so near a triangle: by the box, the plane and the sides of that; `None`: nowhere.
fn part_near([a, b, c]: [DVec3; 3], (p, q): (DVec3, DVec3), near: f64) -> Option<(f64, f64)> {
    let mut part = (0.0, 1.0);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    for k in 0..3 {
        part = clipped(part, (p[k], q[k]), (low[k] - near, high[k] + near))?;
    }
    let normal = (b - a).cross(c - a).normalize_or_zero();
    if normal == DVec3::ZERO {
        return Some(part);
    }
    part = clipped(part, (normal.dot(p - a), normal.dot(q - a)), (-near, near))?;
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let out = (to - from).cross(normal).normalize_or_zero();
        part = clipped(part, (out.dot(p - from), out.dot(q - from)), (f64::NEG_INFINITY, near))?;
    }
    Some(part)
}

/// The part of a line between two shares where a coordinate that runs from `start` to `end` lies between two values.
fn clipped((from, to): (f64, f64), (start, end): (f64, f64), (low, high): (f64, f64)) -> Option<(f64, f64)> {
    let run = end - start;
    if run == 0.0 {
        return (low <= start && start <= high).then_some((from, to));
    }
    let (x, y) = ((low - start) / run, (high - start) / run);
    let (from, to) = (from.max(x.min(y)), to.min(x.max(y)));
    (from <= to).then_some((from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_go_through_triangles() {
        let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let p = DVec3::new(0.2, 0.3, 1.0);
        assert!(through(t, (p, p - 2.0 * DVec3::Z), 0.0).is_some_and(|x| x.distance(DVec3::new(0.2, 0.3, 0.0)) < 1e-15));
        assert!(
            through(t, (p, p - 0.5 * DVec3::Z), 0.0).is_none() && through(t, (p + DVec3::X, p + DVec3::X - 2.0 * DVec3::Z), 0.0).is_none()
        );
    }

    #[test]
    fn lines_are_near_triangles_within_their_sides() {
        let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let line = |x: f64, y: f64| (DVec3::new(x, y, 0.0), DVec3::new(x + 1.0, y + 1.0, 0.0));
        let (from, to) = part_near(t, line(0.0, 0.0), 0.1).unwrap();
        assert!(from == 0.0 && (to - (0.5 + 0.1 * 0.5_f64.sqrt())).abs() < 1e-15, "{to}");
        assert_eq!(part_near(t, line(0.6, 0.6), 0.1), None, "in the box of the triangle, and beyond its side");
        assert_eq!(part_near(t, (DVec3::Z, DVec3::X + DVec3::Z), 0.1), None);
    }
}
