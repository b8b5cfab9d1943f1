//! Quads and triangles that know their neighbours.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::halves::{Halves, NONE};
use crate::mesh::quad::pair::SingleTriangles;
use crate::mesh::tri::triangulation::Triangulation;

/// Elements on a surface: border nodes first, which never move, then inner ones.
#[derive(Clone, Debug, Default)]
pub struct Net {
    /// Points.
    pub p: Vec<DVec3>,
    /// Their places in the chart.
    pub xy: Vec<DVec2>,
    /// Unit normals of the surface there; zero where there is none.
    pub normal: Vec<DVec3>,
    /// Wanted lengths.
    pub size: Vec<f64>,
    /// Number of border nodes.
    pub fixed: u32,
    /// Corners, counter-clockwise; the last one of a triangle is [`NONE`].
    pub face: Vec<[u32; 4]>,
    /// Side 4 f + k against each side, which runs from corner k to the next one.
    pub across: Vec<[u32; 4]>,
    /// Bit k: side k is part of a border or line.
    pub locked: Vec<u8>,
    /// The border node in the middle of each side; [`NONE`] where none is given.
    pub mid: Vec<[u32; 4]>,
}

/// The least sine of the corners of a quad, negative where it is concave or turned over against the normals of its corners.
pub fn least_sine(p: [DVec3; 4], normal: [DVec3; 4]) -> f64 {
    let side = [p[1] - p[0], p[2] - p[1], p[3] - p[2], p[0] - p[3]];
    let unit = side.map(DVec3::normalize_or_zero);
    let sum = normal[0] + normal[1] + normal[2] + normal[3];
    let up = sum.try_normalize().unwrap_or_else(|| (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero());
    let sine = |k: usize| unit[(k + 3) % 4].cross(unit[k]).dot(up);
    sine(0).min(sine(1)).min(sine(2)).min(sine(3))
}

/// The least sine of the corners of a triangle over that of an equilateral one.
pub fn least_sine_of_triangle(p: [DVec3; 3], normal: [DVec3; 3]) -> f64 {
    const SIXTY: f64 = 0.866_025_403_784_438_6;
    let unit = [p[1] - p[0], p[2] - p[1], p[0] - p[2]].map(DVec3::normalize_or_zero);
    let sum = normal[0] + normal[1] + normal[2];
    let up = sum.try_normalize().unwrap_or_else(|| unit[0].cross(unit[1]).normalize_or_zero());
    let sine = |k: usize| unit[(k + 2) % 3].cross(unit[k]).dot(up);
    sine(0).min(sine(1)).min(sine(2)) / SIXTY
}

impl Net {
    /// Corners of a face: four or three.
    pub fn corners(&self, f: usize) -> &[u32] {
        let face = &self.face[f];
        if face[3] == NONE { &face[..3] } else { face }
    }

    /// Quality of a face: the least sine of its corners, 1 at best.
    pub fn quality(&self, f: usize) -> f64 {
        let [a, b, c, d] = self.face[f].map(|n| n as usize);
        let (p, n) = (&self.p, &self.normal);
        if self.face[f][3] == NONE {
            return least_sine_of_triangle([p[a], p[b], p[c]], [n[a], n[b], n[c]]);
        }
        least_sine([p[a], p[b], p[c], p[d]], [n[a], n[b], n[c], n[d]])
    }

    /// Keeps some nodes, those of all faces among them; gives their new numbers.
    pub fn keep_nodes(&mut self, is_kept: impl Fn(usize) -> bool) -> Vec<u32> {
        let mut number = vec![NONE; self.p.len()];
        let mut next = 0;
        for n in job::looking(0..number.len()).filter(|n| is_kept(*n)) {
            number[n] = next as u32;
            (self.p[next], self.xy[next], self.normal[next], self.size[next]) = (self.p[n], self.xy[n], self.normal[n], self.size[n]);
            next += 1;
        }
        self.p.truncate(next);
        self.xy.truncate(next);
        self.normal.truncate(next);
        self.size.truncate(next);
        self.face.iter_mut().flatten().filter(|n| **n != NONE).for_each(|n| *n = number[*n as usize]);
        number
    }

    /// Takes a face out; the last one gets its number.
    pub fn remove(&mut self, f: usize) {
        self.face.swap_remove(f);
        if self.across.is_empty() {
            return;
        }
        self.across.swap_remove(f);
        self.mid.swap_remove(f);
        self.locked.swap_remove(f);
        for k in 0..4 {
            let beyond = self.across.get(f).map_or(NONE, |across| across[k]);
            if beyond != NONE {
                self.across[beyond as usize / 4][beyond as usize % 4] = (4 * f + k) as u32;
            }
        }
    }
}

/// The least quality of some faces.
pub fn least_quality(net: &Net, faces: &[u32]) -> f64 {
    faces.iter().map(|f| net.quality(*f as usize)).fold(f64::INFINITY, f64::min)
}

/// What a net is made of.
pub struct Raw<'a> {
    /// Triangles over the cells' border.
    pub triangulation: &'a Triangulation,
    /// The triangle that each is paired with.
    pub mate: &'a [u32],
    /// Triangles that are a point or a line in space.
    pub flat: &'a [bool],
    /// Normals at the nodes of the triangulation.
    pub normal: &'a [DVec3],
    /// The whole border.
    pub halves: &'a Halves,
}

impl Raw<'_> {
    /// Pairs of triangles as quads; what is flat goes, and what it parted is joined.
    pub fn net(&self) -> Net {
        let (triangulation, halves) = (self.triangulation, self.halves);
        let fixed = halves.p.len();
        let node = |n: u32| if n < triangulation.fixed { halves.of[n as usize] } else { n - triangulation.fixed + fixed as u32 };
        let mut net = Net { fixed: fixed as u32, p: halves.p.clone(), xy: halves.xy.clone(), ..Net::default() };
        net.p.extend(&triangulation.p[triangulation.fixed as usize..]);
        net.xy.extend(&triangulation.xy[triangulation.fixed as usize..]);
        net.normal = vec![DVec3::ZERO; fixed];
        net.size = vec![0.0; fixed];
        for n in 0..triangulation.fixed as usize {
            job::poll();
            let at = halves.of[n] as usize;
            (net.normal[at], net.size[at]) = (self.normal[n], triangulation.size[n]);
        }
        net.normal.extend(&self.normal[triangulation.fixed as usize..]);
        net.size.extend(&triangulation.size[triangulation.fixed as usize..]);
        // Sides of faces as sides of triangles.
        let mut sides: Vec<[(u32, usize); 4]> = Vec::new();
        let mut side_of = vec![[NONE; 3]; triangulation.tri.len()];
        for t in 0..triangulation.tri.len() as u32 {
            job::poll();
            let mate = self.mate[t as usize];
            if self.flat[t as usize] || mate != NO_TRIANGLE && mate < t {
                continue;
            }
            let c = triangulation.tri[t as usize];
            let (corners, of) = if mate == NO_TRIANGLE {
                ([c[0], c[1], c[2], NONE], [(t, 2), (t, 0), (t, 1), (t, usize::MAX)])
            } else {
                let k = triangulation.across[t as usize].iter().position(|o| *o == mate).unwrap_or(0);
                let j = triangulation.across[mate as usize].iter().position(|o| *o == t).unwrap_or(0);
                let quad = [c[k], c[(k + 1) % 3], triangulation.tri[mate as usize][j], c[(k + 2) % 3]];
                (quad, [(t, (k + 2) % 3), (mate, (j + 1) % 3), (mate, (j + 2) % 3), (t, (k + 1) % 3)])
            };
            for (k, (t, side)) in of.iter().enumerate().filter(|(_, s)| s.1 < 3) {
                side_of[*t as usize][*side] = 4 * net.face.len() as u32 + k as u32;
            }
            net.face.push(corners.map(|n| if n == NONE { NONE } else { node(n) }));
            sides.push(of);
        }
        for of in sides {
            let (mut across, mut mid, mut locked) = ([NONE; 4], [NONE; 4], 0);
            for (k, side) in of.into_iter().enumerate().filter(|(_, s)| s.1 < 3) {
                let beyond = self.beyond(side);
                across[k] = beyond.side.map_or(NONE, |(t, side)| side_of[t as usize][side]);
                mid[k] = beyond.mid;
                locked |= u8::from(beyond.locked) << k;
            }
            net.across.push(across);
            net.mid.push(mid);
            net.locked.push(locked);
        }
        net
    }

    /// What lies beyond a side, flat triangles left out.
    fn beyond(&self, (mut t, mut k): (u32, usize)) -> Beyond {
        let triangulation = self.triangulation;
        let mut beyond = Beyond { side: None, locked: false, mid: NONE };
        for _ in 0..=triangulation.tri.len() {
            job::poll();
            let c = triangulation.tri[t as usize];
            if triangulation.locked[t as usize] >> k & 1 == 1 {
                beyond.locked = true;
                let mid = self.halves.mid(c[(k + 1) % 3], c[(k + 2) % 3]);
                beyond.mid = if mid == NONE { beyond.mid } else { mid };
            }
            let other = triangulation.across[t as usize][k];
            let j = (0..3).find(|j| other != NO_TRIANGLE && triangulation.across[other as usize][*j] == t);
            let Some(j) = j else { return beyond };
            if !self.flat[other as usize] {
                beyond.side = Some((other, j));
                return beyond;
            }
            // The other one of the two sides that are one line in space.
            let ids = triangulation.tri[other as usize].map(|n| self.halves.id(n));
            let long = |i: &usize| *i != j && ids[(i + 1) % 3] != ids[(i + 2) % 3];
            let Some(next) = (0..3).find(long) else { return beyond };
            (t, k) = (other, next);
        }
        beyond
    }
}

/// What lies beyond a side of a face.
struct Beyond {
    side: Option<(u32, usize)>,
    locked: bool,
    mid: u32,
}

/// How many faces are triangles.
pub fn alone(net: &Net) -> usize {
    net.face.iter().filter(|f| f[3] == NONE).count()
}

impl SingleTriangles {
    /// Triangles of a triangulation that are a point or a line in space: two corners are one node.
    pub fn flat(triangulation: &Triangulation, halves: &Halves) -> Vec<bool> {
        let flat = |t: &[u32; 3]| (0..3).any(|k| halves.id(t[k]) != NONE && halves.id(t[k]) == halves.id(t[(k + 1) % 3]));
        triangulation.tri.iter().map(flat).collect()
    }
}
