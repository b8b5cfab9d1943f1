//! A small cavity in a net of quads: a disk of a few of them, with the polygon round it.

use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::cavity::EditableNet;
use crate::mesh::quad::plane::least_sine;
use crate::mesh::quad::regular::RegularInput;
use crate::mesh::quad::settings::REMESH;

/// A cavity with what is known of its quads.
pub(super) struct DiskOfQuads {
    /// Its faces.
    pub faces: Vec<u32>,
    /// Corners of its border, counter-clockwise.
    pub ring: Vec<u32>,
    /// Nodes inside.
    pub inner: Vec<u32>,
    /// Faces round each corner outside of it.
    pub outside: Vec<usize>,
    /// The least quality of its faces.
    pub least: f64,
    /// Irregular nodes on its border and inside.
    pub irregular: usize,
    /// Least and largest length of new sides.
    pub sides: (f64, f64),
}

impl DiskOfQuads {
    /// A cavity of some quads; `None` where they are no disk with few corners, or a border runs through them.
    pub fn new(of: &EditableNet, input: &RegularInput, faces: Vec<u32>) -> Option<Self> {
        let net = &*of.net;
        let mut sides: Vec<(u32, u32)> = Vec::new();
        for f in &faces {
            let c = net.face[*f as usize];
            if c[3] == NONE {
                return None;
            }
            (0..4).for_each(|k| sides.push((c[k], c[(k + 1) % 4])));
        }
        let open: Vec<(u32, u32)> = sides.iter().copied().filter(|(a, b)| !sides.contains(&(*b, *a))).collect();
        let n = open.len();
        if !(4..=REMESH.max_corners).contains(&n) {
            return None;
        }
        let is_line = |(a, b): &(u32, u32)| *a < net.fixed && *b < net.fixed && !open.contains(&(*a, *b));
        if input.has_lines && sides.iter().any(is_line) {
            return None;
        }
        let mut ring = vec![open[0].0];
        for _ in 1..n {
            let last = ring[ring.len() - 1];
            let mut next = open.iter().filter(|side| side.0 == last);
            let (_, b) = next.next().filter(|_| next.next().is_none())?;
            ring.push(*b);
        }
        let start = ring.iter().enumerate().min_by_key(|(_, n)| **n)?.0;
        ring.rotate_left(start);
        if ring.iter().enumerate().any(|(k, n)| ring[..k].contains(n)) {
            return None;
        }
        let mut inner: Vec<u32> = sides.iter().map(|s| s.0).filter(|n| !ring.contains(n)).collect();
        inner.sort_unstable();
        inner.dedup();
        if inner.len() > REMESH.max_old_inner || inner.iter().any(|n| *n < net.fixed) || 2 * faces.len() + 2 != n + 2 * inner.len() {
            return None;
        }
        let is_in = |f: &&u32| !faces.contains(f);
        let outside: Vec<usize> = ring.iter().map(|n| of.of[*n as usize].iter().filter(is_in).count()).collect();
        let irregular = ring.iter().chain(&inner).filter(|n| of.is_irregular(**n)).count();
        let (mut least, mut short, mut long) = (f64::INFINITY, f64::INFINITY, input.always);
        for f in &faces {
            let p = net.face[*f as usize].map(|n| net.xy[n as usize]);
            least = least.min(least_sine(p));
            for k in 0..4 {
                let side = p[k].distance(p[(k + 1) % 4]);
                (short, long) = (short.min(side), long.max(side));
            }
        }
        let size = ring.iter().map(|n| net.size[*n as usize]).fold(f64::INFINITY, f64::min);
        Some(Self { faces, ring, inner, outside, least, irregular, sides: (short.min(REMESH.min_side * size), long) })
    }
}
