//! Whether the elements of a face are a surface whose border is that of the face, by their node numbers alone.
//!
//! Every edge is used once each way, but for those of the border, which are used as the face's loops run. Edges that touch a border node
//! are counted one by one; of the others each direction adds or subtracts a pseudo-random number drawn from its nodes, and the sum must
//! be zero. Together with the number of elements, edges and nodes (Euler) this excludes a filled hole, a gap, and an element that is
//! there twice.

use std::collections::BTreeMap;

use crate::base::job;
use crate::mesh::data::edge_uses::signed;
use crate::mesh::request::methods::Elements;
use crate::mesh::verify::defect::Defect;

/// The elements of one face, with what they must match.
pub struct Claim<'a> {
    /// Triangles of the face.
    pub triangles: &'a [[u32; 3]],
    /// Quads of the face.
    pub quads: &'a [[u32; 4]],
    /// The requested kind.
    pub kind: Elements,
    /// Edges of the border with the elements on their left; one that the face meets on both sides is there twice.
    pub border: &'a [[u32; 2]],
    /// Edges of lines inside the face.
    pub lines: &'a [[u32; 2]],
    /// Single nodes inside the face that lie on no line.
    pub points: &'a [u32],
    /// First node of the face's own, and how many there are; lower ones are those of borders, lines and points.
    pub own: (u32, u32),
    /// Euler number of the face without its border: 1 for a disc, less 1 for each hole; `None` where it is not known.
    pub euler: Option<i64>,
}

/// Uses of edges by elements.
#[derive(Default)]
struct EdgeUses {
    /// Of those at a border node: lower node, higher node, whether they run downwards.
    near: Vec<(u32, u32, bool)>,
    /// Signed sum of the numbers drawn for the others: 0 where each is used once each way.
    sum: u64,
    /// Number of uses of the others.
    inside: u64,
}

impl EdgeUses {
    fn add(&mut self, a: u32, b: u32, first: u32) {
        let low = a.min(b);
        if low < first {
            self.near.push((low, a.max(b), a > b));
        } else {
            self.sum = self.sum.wrapping_add(signed(a, b));
            self.inside += 1;
        }
    }

    /// Counts the sides of an element, and marks which of the face's own nodes, from `first` on, it has.
    fn element<const N: usize>(&mut self, corners: &[u32; N], first: u32, used: &mut [bool]) -> std::result::Result<(), Defect> {
        for (k, a) in corners.iter().enumerate() {
            if corners[k + 1..].contains(a) {
                return Err(Defect::Node(*a));
            }
            if *a >= first {
                *used.get_mut((a - first) as usize).ok_or(Defect::Node(*a))? = true;
            }
        }
        if corners.iter().all(|a| *a >= first) {
            self.add_inner(corners);
        } else {
            (0..N).for_each(|k| self.add(corners[k], corners[(k + 1) % N], first));
        }
        Ok(())
    }

    /// The sides of an element without a node of the border.
    fn add_inner<const N: usize>(&mut self, corners: &[u32; N]) {
        self.sum = (0..N).fold(self.sum, |sum, k| sum.wrapping_add(signed(corners[k], corners[(k + 1) % N])));
        self.inside += N as u64;
    }
}

impl Claim<'_> {
    /// Checks the elements; fails with the first defect.
    pub fn hold(&self) -> std::result::Result<(), Defect> {
        if self.triangles.is_empty() && self.quads.is_empty() {
            return Err(Defect::Empty);
        }
        if self.kind == Elements::Triangles && !self.quads.is_empty() || self.kind == Elements::Quads && !self.triangles.is_empty() {
            return Err(Defect::Kind);
        }
        let uses = self.edge_uses()?;
        let (edges, nodes) = self.inner_edges(&uses)?;
        if uses.sum != 0 || uses.inside % 2 != 0 {
            return Err(Defect::Torn);
        }
        let inside = i64::from(self.own.1) + nodes - edges - (uses.inside / 2) as i64;
        let found = inside + (self.triangles.len() + self.quads.len()) as i64;
        match self.euler {
            Some(wanted) if wanted != found => Err(Defect::Euler(found, wanted)),
            _ => Ok(()),
        }
    }

    /// All edges of all elements; every node must be one of the face's own or below them, and each own one must be used.
    fn edge_uses(&self) -> std::result::Result<EdgeUses, Defect> {
        let mut uses = EdgeUses::default();
        let (first, own) = self.own;
        let mut used = vec![false; own as usize];
        job::looking(self.triangles).try_for_each(|t| uses.element(t, first, &mut used))?;
        job::looking(self.quads).try_for_each(|q| uses.element(q, first, &mut used))?;
        used.iter().position(|used| !used).map_or(Ok(uses), |n| Err(Defect::Loose(first + n as u32)))
    }

    /// Edges that touch border nodes: the number of those inside the face, and of the lines' and points' nodes inside it.
    fn inner_edges(&self, uses: &EdgeUses) -> std::result::Result<(i64, i64), Defect> {
        // Uses by elements each way, then by the border.
        let mut edges: BTreeMap<(u32, u32), [u32; 4]> = BTreeMap::new();
        let mut near = uses.near.clone();
        near.sort_unstable();
        for same in near.chunk_by(|a, b| a == b) {
            edges.entry((same[0].0, same[0].1)).or_default()[usize::from(same[0].2)] = same.len() as u32;
        }
        let mut known: BTreeMap<u32, bool> = BTreeMap::new();
        for [a, b] in self.border {
            edges.entry((*a.min(b), *a.max(b))).or_default()[2 + usize::from(a > b)] += 1;
            known.extend([(*a, false), (*b, false)]);
        }
        for [a, b] in self.lines {
            edges.entry((*a.min(b), *a.max(b))).or_default();
        }
        for n in self.lines.iter().flatten().chain(self.points) {
            known.entry(*n).or_insert(true);
        }
        let mut inside = 0;
        for ((a, b), [up, down, along, against]) in edges {
            if let Some(foreign) = [a, b].into_iter().find(|n| *n < self.own.0 && !known.contains_key(n)) {
                return Err(Defect::Node(foreign));
            }
            let is_border = along + against > 0;
            let wanted = if is_border { [along, against] } else { [1, 1] };
            if [up, down] != wanted {
                return Err(Defect::Edge([a, b], [up, down], wanted));
            }
            inside += i64::from(!is_border);
        }
        Ok((inside, known.values().filter(|inner| **inner).count() as i64))
    }
}
