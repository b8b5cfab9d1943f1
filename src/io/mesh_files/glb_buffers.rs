//! Vertices, normals and indices of a GLB file: what its binary chunk holds, little endian, in single precision.

use glam::DVec3;

use crate::base::{job, math};
use crate::io::mesh_files::deck::Deck;

/// Cosine of the angle from which two faces of one surface meet at an edge that is seen: 40°.
const CREASE: f64 = 0.766;
/// Triangles about a node up to which each is compared with each.
const MOST_COMPARED: usize = 256;

/// Elements with vertices of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Geometry {
    /// The node of each vertex.
    pub nodes: Vec<u32>,
    /// The unit normal of each vertex in the axes of the file; none for lines and points.
    pub normals: Vec<[f32; 3]>,
    /// Vertices of the elements one after the other; none for points, which are the vertices in order.
    pub indices: Vec<u32>,
}

/// A place or direction of a model with z up in the axes of glTF, y up and z to the front: x, z, −y.
fn y_up(v: DVec3) -> DVec3 {
    DVec3::new(v.x, v.z, -v.y)
}

fn single(v: DVec3) -> [f32; 3] {
    // Negative zero is written as zero.
    v.to_array().map(|x| x as f32 + 0.0)
}

/// Triangles of one surface: a node has one vertex where its faces are smooth, else one for each side of the edges there.
///
/// The normal of a corner is the mean of those of the faces about the node that turn less than 40° from its own, weighted by
/// their angles there.
pub(crate) fn shaded(deck: &Deck, triangles: &[[u32; 3]]) -> Geometry {
    let mut normals: Vec<DVec3> = Vec::with_capacity(triangles.len());
    let mut corners: Vec<(u32, u32)> = Vec::with_capacity(3 * triangles.len());
    let mut angles: Vec<f64> = Vec::with_capacity(3 * triangles.len());
    for (k, nodes) in job::looking(triangles).enumerate() {
        let places = nodes.map(|n| deck.place(n));
        normals.push(math::unit((places[1] - places[0]).cross(places[2] - places[0]), 0.0).unwrap_or_default());
        for c in 0..3 {
            corners.push((nodes[c], (3 * k + c) as u32));
            angles.push(math::angle_between(places[(c + 1) % 3] - places[c], places[(c + 2) % 3] - places[c]));
        }
    }
    job::sort(&mut corners);
    let mut found = Geometry { indices: vec![0; corners.len()], ..Geometry::default() };
    for about in job::looking(corners.chunk_by(|a, b| a.0 == b.0)) {
        let first = found.nodes.len();
        for (node, corner) in about {
            let own = normals[*corner as usize / 3];
            let smooth = |other: &u32| normals[*other as usize / 3].dot(own) >= CREASE;
            let mean = match about.len() <= MOST_COMPARED {
                true => about.iter().filter(|(_, other)| smooth(other)).map(|(_, k)| normals[*k as usize / 3] * angles[*k as usize]).sum(),
                false => own,
            };
            let normal = single(y_up(math::unit(mean, 0.0).or(math::unit(own, 0.0)).unwrap_or(DVec3::Z)));
            let known = found.normals[first..].iter().position(|known| *known == normal);
            let vertex = known.unwrap_or_else(|| {
                found.nodes.push(*node);
                found.normals.push(normal);
                found.nodes.len() - 1 - first
            });
            found.indices[*corner as usize] = (first + vertex) as u32;
        }
    }
    found
}

/// Line elements of one curve.
pub(crate) fn joined(lines: &[[u32; 2]]) -> Geometry {
    let mut nodes = lines.as_flattened().to_vec();
    job::sort(&mut nodes);
    nodes.dedup();
    let indices = lines.as_flattened().iter().map(|n| nodes.partition_point(|known| known < n) as u32).collect();
    Geometry { nodes, normals: Vec::new(), indices }
}

/// Numbers of one kind in a buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    /// First byte.
    pub start: usize,
    /// How many vertices or indices.
    pub count: usize,
}

/// Where the numbers of a geometry stand.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placed {
    /// Positions, with the smallest and largest coordinates.
    pub positions: (Span, [f32; 3], [f32; 3]),
    /// Normals.
    pub normals: Option<Span>,
    /// Indices.
    pub indices: Option<Span>,
}

/// The three buffers; every number takes four bytes.
#[derive(Default)]
pub(crate) struct Buffers {
    /// Three coordinates for each vertex, metres from the origin of the node.
    pub positions: Vec<u8>,
    /// Three coordinates for each vertex of triangles.
    pub normals: Vec<u8>,
    /// Indices.
    pub indices: Vec<u8>,
}

impl Buffers {
    /// Adds a geometry, with positions relative to `origin`, units of the file.
    pub(crate) fn add(&mut self, deck: &Deck, origin: DVec3, geometry: &Geometry) -> Placed {
        let at = Span { start: self.positions.len(), count: geometry.nodes.len() };
        let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for node in job::looking(&geometry.nodes) {
            let place = single(y_up(deck.place(*node) - origin));
            for k in 0..3 {
                (min[k], max[k]) = (min[k].min(place[k]), max[k].max(place[k]));
                self.positions.extend(place[k].to_le_bytes());
            }
        }
        let normals = Span { start: self.normals.len(), count: geometry.normals.len() };
        job::looking(geometry.normals.as_flattened()).for_each(|x| self.normals.extend(x.to_le_bytes()));
        let indices = Span { start: self.indices.len(), count: geometry.indices.len() };
        job::looking(&geometry.indices).for_each(|n| self.indices.extend(n.to_le_bytes()));
        let used = |span: Span| (span.count > 0).then_some(span);
        Placed { positions: (at, min, max), normals: used(normals), indices: used(indices) }
    }

    /// The place of the node that holds all, in the axes of the file.
    pub(crate) fn translation(origin: DVec3) -> [f64; 3] {
        y_up(origin).to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::mesh_files::deck::Options;
    use crate::mesh::Mesh;

    /// Two squares of two triangles along y, the second turned up by an angle.
    fn bent(degrees: f64) -> Geometry {
        let (s, c) = math::sin_cos(degrees.to_radians());
        let rows = [(-1.0, 0.0), (0.0, 0.0), (c, s)];
        let nodes = rows.iter().flat_map(|(x, z)| [DVec3::new(*x, 0.0, *z), DVec3::new(*x, 1.0, *z)]).collect();
        let mesh = Mesh { nodes, order: 1, ..Mesh::default() };
        let options = Options::default();
        shaded(&Deck { mesh: &mesh, unit: "m", options: &options }, &[[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]])
    }

    #[test]
    fn an_edge_is_seen_where_faces_turn_much() {
        let (smooth, sharp) = (bent(30.0), bent(60.0));
        assert_eq!((smooth.nodes.len(), sharp.nodes.len()), (6, 8));
        assert_eq!(smooth.indices, [0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3]);
        // A face whose normal is z points to y in the file.
        assert_eq!(smooth.normals[0], [0.0, 1.0, 0.0]);
    }

    #[test]
    fn lines_share_their_vertices() {
        let found = joined(&[[7, 3], [3, 9]]);
        assert_eq!((found.nodes, found.indices), (vec![3, 7, 9], vec![1, 0, 0, 2]));
    }
}
