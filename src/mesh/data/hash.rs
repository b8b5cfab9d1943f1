//! A hash of a mesh as a graph with its groups, blind to numbers, positions and names.
//!
//! Every node starts with a colour made of the elements and groups it is in; in four rounds of colour refinement it takes
//! in the colours of its neighbours, element by element in the element's own order of corners. The hash is made of the
//! sorted colours of all elements and nodes: renumbering keeps it, a flipped edge or another group changes it.

use crate::base::job;
use crate::mesh::data::mesh::{Group, Mesh};

const ROUNDS: usize = 4;

/// One step of mixing (the finaliser of SplitMix64 [Steele, Lea & Flood 2014]).
fn mix(a: u64, b: u64) -> u64 {
    mix_spread(a, spread(b))
}

/// A number for a group: what it is called does not matter, what it holds does.
fn of_group(group: &Group) -> u64 {
    let parts = [&group.nodes, &group.lines, &group.triangles, &group.quads];
    parts.iter().fold(parts.len() as u64, |h, part| mix(h, part.len() as u64))
}

/// The second operand of [`mix`] before its multiplication, for a colour that several cells mix in.
fn spread(colour: u64) -> u64 {
    colour.wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

/// [`mix`] with a second operand that is [`spread`].
fn mix_spread(a: u64, spread: u64) -> u64 {
    let mut x = a.rotate_left(23) ^ spread;
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// An element of `N` corners as the hash sees it; `kind` tells lines, triangles and quads apart.
#[derive(Clone, Copy)]
struct HashedElement<'a, const N: usize> {
    kind: u64,
    corners: &'a [u32; N],
    /// Its mid nodes; none of first order.
    mids: &'a [u32],
}

impl<const N: usize> HashedElement<'_, N> {
    /// The colours round the element, as seen from each corner.
    fn seen(&self, colours: &[u64]) -> [u64; N] {
        let start = mix(self.kind, N as u64);
        let own = self.corners.map(|n| spread(colours[n as usize]));
        std::array::from_fn(|from| (0..N).fold(start, |h, k| mix_spread(h, own[(from + k) % N])))
    }

    /// What is seen from all corners, in no order: where the element begins does not matter.
    fn colour(&self, seen: [u64; N]) -> u64 {
        seen.iter().fold(self.kind, |sum, from| sum.wrapping_add(mix(self.kind, *from)))
    }

    /// Adds what its nodes see of it to their next colours.
    fn refine(&self, tag: u64, colours: &[u64], next: &mut [u64]) {
        let seen = self.seen(colours);
        for (corner, from) in self.corners.iter().zip(seen) {
            let own = &mut next[*corner as usize];
            *own = own.wrapping_add(mix(tag, from));
        }
        if self.mids.is_empty() {
            return;
        }
        let all = mix(self.colour(seen), tag);
        for (side, mid) in self.mids.iter().enumerate() {
            // A mid node knows the edge it is on.
            let ends = [side, (side + 1) % N].map(|c| colours[self.corners[c] as usize]);
            let own = &mut next[*mid as usize];
            *own = own.wrapping_add(mix(all, ends[0].wrapping_add(ends[1])));
        }
    }
}

/// What is done with every element in turn, lines first, then triangles and quads; `k` counts all of them.
trait VisitElements {
    fn element<const N: usize>(&mut self, k: usize, element: HashedElement<N>);
}

/// One round of colour refinement.
struct Refinement<'a> {
    tags: &'a [u64],
    colours: &'a [u64],
    next: Vec<u64>,
}

impl VisitElements for Refinement<'_> {
    fn element<const N: usize>(&mut self, k: usize, element: HashedElement<N>) {
        element.refine(self.tags[k], self.colours, &mut self.next);
    }
}

/// The sum over the colours of all elements.
struct ElementSum<'a> {
    tags: &'a [u64],
    colours: &'a [u64],
    sum: u64,
}

impl VisitElements for ElementSum<'_> {
    fn element<const N: usize>(&mut self, k: usize, element: HashedElement<N>) {
        let colour = element.colour(element.seen(self.colours));
        self.sum = self.sum.wrapping_add(mix(mix(5, self.tags[k]), colour));
    }
}

impl Mesh {
    /// Hash of the connectivity with what the groups hold; 16 hexadecimal digits print it.
    pub fn hash(&self) -> u64 {
        let mut colours = vec![0_u64; self.nodes.len()];
        self.points.iter().for_each(|p| colours[*p as usize] = mix(1, colours[*p as usize]));
        let mut tags = self.tags();
        for (group, number) in self.groups.iter().map(|g| (g, of_group(g))) {
            group.nodes.iter().for_each(|n| colours[*n as usize] = colours[*n as usize].wrapping_add(mix(2, number)));
            self.tag(group, number, &mut tags);
        }
        for _ in 0..ROUNDS {
            let next = colours.iter().map(|c| mix(3, *c)).collect();
            let mut round = Refinement { tags: &tags, colours: &colours, next };
            self.each_element(&mut round);
            colours = round.next;
        }
        let mut sum = mix(u64::from(self.order), self.nodes.len() as u64);
        sum = colours.iter().fold(sum, |s, c| s.wrapping_add(mix(4, *c)));
        let mut elements = ElementSum { tags: &tags, colours: &colours, sum };
        self.each_element(&mut elements);
        let sum = elements.sum;
        mix(sum, self.groups.iter().fold(0_u64, |s, g| s.wrapping_add(mix(6, of_group(g)))))
    }

    /// One number an element: lines, triangles, quads.
    fn tags(&self) -> Vec<u64> {
        vec![0; self.lines.len() + self.triangles.len() + self.quads.len()]
    }

    fn tag(&self, group: &Group, number: u64, tags: &mut [u64]) {
        let (l, t) = (self.lines.len(), self.triangles.len());
        let all = group.lines.iter().map(|n| *n as usize);
        let all = all.chain(group.triangles.iter().map(|n| l + *n as usize)).chain(group.quads.iter().map(|n| l + t + *n as usize));
        all.for_each(|k| tags[k] = tags[k].wrapping_add(mix(7, number)));
    }

    fn each_element(&self, visitor: &mut impl VisitElements) {
        let none: &[u32] = &[];
        let mut k = 0;
        for (n, corners) in job::looking(self.lines.iter().enumerate()) {
            let mids = self.line_mids.get(n).map_or(none, std::slice::from_ref);
            visitor.element(k, HashedElement { kind: 2, corners, mids });
            k += 1;
        }
        for (n, corners) in job::looking(self.triangles.iter().enumerate()) {
            visitor.element(k, HashedElement { kind: 3, corners, mids: self.triangle_mids.get(n).map_or(none, |m| m) });
            k += 1;
        }
        for (n, corners) in job::looking(self.quads.iter().enumerate()) {
            visitor.element(k, HashedElement { kind: 4, corners, mids: self.quad_mids.get(n).map_or(none, |m| m) });
            k += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of n by m cells as triangles, `other` names cells with the other diagonal.
    fn strip(n: u32, m: u32, other: &[(u32, u32)]) -> Mesh {
        let id = |i: u32, j: u32| j * (n + 1) + i;
        let mut mesh = Mesh { order: 1, nodes: vec![glam::DVec3::ZERO; ((n + 1) * (m + 1)) as usize], ..Mesh::default() };
        for j in 0..m {
            for i in 0..n {
                let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                mesh.triangles.extend(if other.contains(&(i, j)) { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] });
            }
        }
        mesh
    }

    fn renumbered(mesh: &Mesh) -> Mesh {
        let n = mesh.nodes.len() as u32;
        // 7 has no factor in common with the sizes used here, so this is a permutation.
        let map = |k: u32| (7 * k + 3) % n;
        let mut other = mesh.clone();
        other.triangles = mesh.triangles.iter().rev().map(|t| [map(t[1]), map(t[2]), map(t[0])]).collect();
        let last = mesh.triangles.len() as u32 - 1;
        for group in &mut other.groups {
            group.nodes = group.nodes.iter().map(|k| map(*k)).collect();
            group.triangles = group.triangles.iter().map(|k| last - k).collect();
        }
        other
    }

    #[test]
    fn renumbering_keeps_it() {
        let mut mesh = strip(5, 3, &[(1, 1)]);
        mesh.groups.push(Group { name: "edge".to_owned(), nodes: vec![0, 1, 2], triangles: vec![4, 5], ..Group::default() });
        assert_eq!(mesh.nodes.len(), 24);
        assert_eq!(mesh.hash(), renumbered(&mesh).hash());
    }

    #[test]
    fn a_flipped_edge_or_another_group_changes_it() {
        let plain = strip(6, 6, &[]);
        assert_ne!(plain.hash(), strip(6, 6, &[(3, 3)]).hash());
        assert_ne!(strip(6, 6, &[(2, 3)]).hash(), strip(6, 6, &[(3, 3)]).hash());
        let with = |name: &str, nodes: &[u32]| {
            let mut mesh = plain.clone();
            mesh.groups.push(Group { name: name.to_owned(), nodes: nodes.to_vec(), ..Group::default() });
            mesh.hash()
        };
        assert_ne!(plain.hash(), with("a", &[]));
        assert_eq!(with("a", &[0]), with("b", &[0]), "a name is no part of it");
        assert_ne!(with("a", &[0]), with("a", &[1]));
        let mut turned = plain.clone();
        turned.triangles[5].swap(0, 1);
        assert_ne!(plain.hash(), turned.hash());
    }

    #[test]
    fn positions_do_not_matter() {
        let mut moved = strip(3, 2, &[]);
        moved.nodes[4] = glam::DVec3::ONE;
        assert_eq!(moved.hash(), strip(3, 2, &[]).hash());
    }
}
