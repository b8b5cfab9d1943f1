//! A cavity in a net of quads: grown about an irregular node until its border runs straight from corner to corner, so that quads of a
//! pattern may take its place and no node of the border becomes irregular [Docampo-Sánchez and Haimes 2020].

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use crate::base::job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::chart::parametric_surface::{SizeField, Spot};
use crate::mesh::quad::net::Net;

/// A net that changes quad by quad.
pub(super) struct EditableNet<'a> {
    pub net: &'a mut Net,
    /// Faces round each node.
    pub of: Vec<Vec<u32>>,
    /// Faces that are still there.
    pub alive: Vec<bool>,
}

impl<'a> EditableNet<'a> {
    /// Takes a net.
    pub fn new(net: &'a mut Net) -> Self {
        let mut of: Vec<Vec<u32>> = job::looking(&net.p).map(|_| Vec::with_capacity(4)).collect();
        for (f, c) in job::looking(net.face.iter().enumerate()) {
            c.iter().filter(|n| **n != NONE).for_each(|n| of[*n as usize].push(f as u32));
        }
        let alive = vec![true; net.face.len()];
        Self { net, of, alive }
    }

    /// Puts other faces into a cavity of a plane net.
    pub fn replace(&mut self, content: &Content, plane: &Spot, field: &dyn SizeField) {
        let Self { net, of, alive } = self;
        content.faces.iter().for_each(|f| alive[*f as usize] = false);
        content.inner.iter().for_each(|n| of[*n as usize].clear());
        content.ring.iter().for_each(|n| of[*n as usize].retain(|f| alive[*f as usize]));
        let (first, normal) = (net.p.len() as u32, plane.normal());
        for xy in content.xy {
            let p = plane.p + plane.dx * xy.x + plane.dy * xy.y;
            net.p.push(p);
            net.xy.push(*xy);
            net.normal.push(normal);
            net.size.push(field.size(*xy, p));
            of.push(Vec::with_capacity(4));
        }
        let corners = content.ring.len() as u32;
        let node = |n: u32| content.ring.get(n as usize).copied().unwrap_or(first + n.saturating_sub(corners));
        for new in content.new {
            let face = new.map(node);
            face.iter().for_each(|n| of[*n as usize].push(net.face.len() as u32));
            net.face.push(face);
            alive.push(true);
        }
    }

    /// Takes out the faces and nodes that are gone; gives the new numbers of nodes.
    pub fn compact(self) -> Vec<u32> {
        let Self { net, of, alive } = self;
        let mut number = 0;
        net.face.retain(|_| {
            number += 1;
            alive[number - 1]
        });
        let fixed = net.fixed as usize;
        net.keep_nodes(|n| n < fixed || !of[n].is_empty())
    }

    /// Whether it is an inner node without four faces.
    pub fn is_irregular(&self, node: u32) -> bool {
        node >= self.net.fixed && !matches!(self.of[node as usize].len(), 0 | 4)
    }
}

/// New faces of a cavity.
pub(super) struct Content<'a> {
    /// Faces that go.
    pub faces: &'a [u32],
    /// Nodes that go.
    pub inner: &'a [u32],
    /// Nodes round the cavity.
    pub ring: &'a [u32],
    /// Corners of the new faces: numbers below that of the nodes round the cavity are theirs, the others of new nodes.
    pub new: &'a [[u32; 4]],
    /// Places of new nodes.
    pub xy: &'a [DVec2],
}

/// Some faces of a net.
#[derive(Default)]
pub(super) struct Cavity {
    pub faces: Vec<u32>,
    is_in: Vec<bool>,
    /// Number of its faces at each node.
    count: BTreeMap<u32, u8>,
}

/// The border of a cavity.
pub(super) struct Rim {
    /// Sides from corner to corner, counter-clockwise, each with both ends.
    pub sides: Vec<Vec<u32>>,
    /// Nodes inside.
    pub inner: Vec<u32>,
    /// How many of those are irregular.
    pub irregular: usize,
}

impl Cavity {
    /// Empties it.
    pub fn clear(&mut self, faces: usize) {
        self.faces.drain(..).for_each(|f| self.is_in[f as usize] = false);
        self.is_in.resize(faces, false);
        self.count.clear();
    }

    fn add(&mut self, of: &EditableNet, f: u32) {
        if !std::mem::replace(&mut self.is_in[f as usize], true) {
            self.faces.push(f);
            of.net.corners(f as usize).iter().for_each(|n| *self.count.entry(*n).or_insert(0) += 1);
        }
    }

    /// Adds all faces of a node.
    pub fn add_node(&mut self, of: &EditableNet, node: u32) {
        of.of[node as usize].iter().for_each(|f| self.add(of, *f));
    }

    /// Adds faces until no inner node of the border turns inwards or is irregular; `false` where there would be more than `most`.
    pub fn straighten(&mut self, of: &EditableNet, most: usize) -> bool {
        loop {
            let bent: Vec<u32> = self.count.iter().filter(|(n, count)| self.is_bent(of, **n, **count)).map(|c| *c.0).collect();
            if bent.is_empty() || self.faces.len() > most {
                return self.faces.len() <= most;
            }
            job::poll();
            bent.iter().for_each(|n| self.add_node(of, *n));
        }
    }

    fn is_bent(&self, of: &EditableNet, node: u32, count: u8) -> bool {
        let all = &of.of[node as usize];
        if node < of.net.fixed || usize::from(count) == all.len() {
            return false;
        }
        count > 2 || all.len() != 4 || count == 2 && !self.are_beside(of, node)
    }

    /// Whether the two faces at a node of the border have a side in common.
    fn are_beside(&self, of: &EditableNet, node: u32) -> bool {
        let own: Vec<u32> = of.of[node as usize].iter().copied().filter(|f| self.is_in[*f as usize]).collect();
        let [a, b] = own[..] else { return false };
        let (a, b) = (of.net.face[a as usize], of.net.face[b as usize]);
        a.iter().any(|n| *n != node && b.contains(n) && beside(&a, node, *n))
    }

    /// Its border; `None` where that is no loop of sides, or the cavity has triangles or nodes inside that must stay.
    pub fn rim(&self, of: &EditableNet) -> Option<Rim> {
        let mut next: BTreeMap<u32, u32> = BTreeMap::new();
        let mut sides: BTreeSet<(u32, u32)> = BTreeSet::new();
        for f in &self.faces {
            let c = of.net.face[*f as usize];
            if c[3] == NONE {
                return None;
            }
            (0..4).for_each(|k| _ = sides.insert((c[k], c[(k + 1) % 4])));
        }
        for (a, b) in &sides {
            if !sides.contains(&(*b, *a)) {
                if next.insert(*a, *b).is_some() {
                    return None;
                }
            } else if *a < of.net.fixed && *b < of.net.fixed {
                return None;
            }
        }
        let inner: Vec<u32> = self.count.keys().copied().filter(|n| !next.contains_key(n)).collect();
        // A disk.
        if inner.iter().any(|n| *n < of.net.fixed) || 2 * (self.faces.len() + 1) != 2 * inner.len() + next.len() {
            return None;
        }
        let is_corner = |n: &u32| self.count.get(n) == Some(&1);
        if next.keys().any(|n| self.count.get(n).is_none_or(|count| *count > 2) || !is_corner(n) && !self.are_beside(of, *n)) {
            return None;
        }
        let first = *next.keys().find(|n| is_corner(n))?;
        let (mut all, mut side, mut n) = (Vec::new(), vec![first], first);
        for _ in 0..next.len() {
            n = *next.get(&n)?;
            side.push(n);
            if is_corner(&n) {
                all.push(std::mem::replace(&mut side, vec![n]));
            }
            if n == first {
                break;
            }
        }
        let whole = all.iter().map(|s| s.len() - 1).sum::<usize>() == next.len();
        let irregular = inner.iter().filter(|n| of.is_irregular(**n)).count();
        whole.then_some(Rim { sides: all, inner, irregular })
    }

    /// Faces beyond the sides of the border that irregular nodes are nearest to, or beyond all; `false` where there are none.
    pub fn extend(&mut self, of: &EditableNet, rim: &Rim) -> bool {
        let beyond = |side: &Vec<u32>| -> Vec<u32> {
            let faces = side.windows(2).filter_map(|w| {
                let shared = |f: &&u32| !self.is_in[**f as usize] && of.of[w[1] as usize].contains(f);
                of.of[w[0] as usize].iter().find(shared).copied()
            });
            faces.collect()
        };
        let rows: Vec<Vec<u32>> = rim.sides.iter().map(beyond).collect();
        let odd = |row: &Vec<u32>| row.iter().flat_map(|f| of.net.corners(*f as usize)).any(|n| of.is_irregular(*n));
        let some = rows.iter().any(odd);
        let before = self.faces.len();
        rows.iter().filter(|row| !some || odd(row)).flatten().for_each(|f| self.add(of, *f));
        self.faces.len() > before
    }
}

/// Whether two corners of a face are ends of one side.
fn beside(c: &[u32; 4], a: u32, b: u32) -> bool {
    (0..4).any(|k| c[k] == a && (c[(k + 1) % 4] == b || c[(k + 3) % 4] == b))
}
