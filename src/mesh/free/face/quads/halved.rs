//! Which nodes of a border are the corners of cells that become four quads each.

use crate::mesh::free::face::{Border, Made};
use crate::mesh::free::outline::Outline;
use crate::mesh::free::quads::halves::Halves;
use crate::mesh::free::quads::net::NONE;
use crate::mesh::layout::Face;

/// Every second node of each stretch, ascending.
pub(in crate::mesh::free::face) fn odd(made: &Made, face: &Face) -> Vec<u32> {
    let odd = |stretch| {
        let ids = made.nodes.of_stretch(made.layout, stretch, false);
        ids.into_iter().skip(1).step_by(2)
    };
    let mut middles: Vec<u32> = face.stretches().flat_map(odd).collect();
    middles.sort_unstable();
    middles
}

/// The border of the cells: every second node of each stretch; round a loop with odd counts every second node of all of it.
///
/// There `other` takes the other half of the nodes.
pub(in crate::mesh) fn halved(made: &Made, face: &Face, border: &Border, outline: &Outline, other: bool) -> Option<Halves> {
    if has_odd(made, face) {
        let middles = alternating(made, face, border, (outline, other))?;
        return Halves::new(outline, &border.ids, |n| middles[n as usize]);
    }
    let middles = odd(made, face);
    Halves::new(outline, &border.ids, |n| middles.binary_search(&border.ids[n as usize]).is_ok())
}

/// Whether a stretch round a face has an odd count.
pub(super) fn has_odd(made: &Made, face: &Face) -> bool {
    face.sides.iter().flat_map(|s| &s.uses).any(|u| made.nodes.count(u.atom) % 2 == 1)
}

/// Every second place round each loop, so that as few corners as can be are in the middle of a cell's side; every second one
/// of the lines inside.
fn alternating(made: &Made, face: &Face, border: &Border, (outline, other): (&Outline, bool)) -> Option<Vec<bool>> {
    let mut next = vec![NONE; outline.p.len()];
    for [a, b] in &outline.loops {
        (std::mem::replace(&mut next[*a as usize], *b) == NONE).then_some(())?;
    }
    let mut corner = vec![false; made.nodes.total as usize];
    for stretch in face.stretches() {
        let ends = made.layout.pieces.atoms[stretch].ends;
        [ends.0, ends.1].into_iter().for_each(|j| corner[made.nodes.of_junction(j) as usize] = true);
    }
    let mut middle = vec![false; outline.p.len()];
    let mut seen = vec![false; outline.p.len()];
    // From a corner, so that without odd counts all corners are ends of sides.
    let starts = (0..next.len()).filter(|n| next[*n] != NONE && corner[border.ids[*n] as usize]);
    for start in starts {
        let (mut round, mut n) = (Vec::new(), start);
        while n != NONE as usize && !std::mem::replace(&mut seen[n], true) {
            round.push(n);
            n = next[n] as usize;
        }
        if round.is_empty() {
            continue;
        }
        let (even, odd): (Vec<usize>, Vec<usize>) = (0..round.len()).partition(|k| k % 2 == 0);
        (n == start && even.len() == odd.len()).then_some(())?;
        let corners = |half: &[usize]| half.iter().map(|k| turn(outline, &round, *k)).sum::<f64>();
        let half = if (corners(&odd) <= corners(&even)) != other { odd } else { even };
        half.into_iter().for_each(|k| middle[round[k]] = true);
    }
    for line in &face.lines {
        let inner = made.nodes.of_stretch(made.layout, *line, false);
        let own = |n: &usize| inner.iter().position(|id| *id == border.ids[*n]).is_some_and(|k| k % 2 == 1);
        (0..middle.len()).filter(|n| next[*n] == NONE).filter(own).for_each(|n| middle[n] = true);
    }
    Some(middle)
}

/// How much a loop turns at a place, 0 for straight on, 2 for back.
fn turn(outline: &Outline, round: &[usize], k: usize) -> f64 {
    let at = |k: usize| outline.p[round[k % round.len()]];
    let (before, here, after) = (at(k + round.len() - 1), at(k), at(k + 1));
    1.0 - (here - before).normalize_or_zero().dot((after - here).normalize_or_zero())
}
