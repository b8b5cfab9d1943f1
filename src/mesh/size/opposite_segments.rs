//! Segments that are opposite to each other: across mapped faces whose sides are divided into segments at the same shares of their lengths.

use crate::mesh::border::layout::{FaceSide, Layout};
use crate::model::glue::{join, root};

/// The first of the segments that are opposite to one, and to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Opposite {
    pub first: usize,
    /// It runs the other way.
    pub is_reversed: bool,
}

/// The groups of segments that are opposite to each other.
pub(super) struct OppositeSegments {
    of: Vec<Opposite>,
    /// The strip of each segment: all that follow each other along sides are of one, with all that are opposite to them.
    strip: Vec<usize>,
    /// Whether both sides of each face along a direction are divided alike.
    aligned: Vec<[bool; 2]>,
}

impl OppositeSegments {
    /// Of a layout. The ends of opposite segments may be `near` apart, model units, when both are taken as shares of their sides.
    pub fn new(layout: &Layout, near: f64) -> Self {
        let n = layout.pieces.segments.len();
        let mut strip: Vec<usize> = (0..n).collect();
        // Each segment in both directions: 2 k along it, 2 k + 1 against it.
        let mut directed: Vec<usize> = (0..2 * n).collect();
        let mut aligned = vec![[true; 2]; layout.faces.len()];
        for (f, face) in layout.faces.iter().enumerate().filter(|(_, face)| !face.free && !face.is_triangle()) {
            for direction in [0, 1] {
                let [a, b] = [&face.sides[direction], &face.sides[direction + 2]];
                aligned[f][direction] = is_aligned(a, b, near);
                let along: Vec<usize> = [a, b].into_iter().flat_map(FaceSide::segments).collect();
                along.windows(2).for_each(|w| join(&mut strip, w[0], w[1]));
                if aligned[f][direction] {
                    for (x, y) in a.uses.iter().zip(&b.uses) {
                        let against = usize::from(x.against != y.against);
                        join(&mut directed, 2 * x.segment, 2 * y.segment + against);
                        join(&mut directed, 2 * x.segment + 1, 2 * y.segment + 1 - against);
                    }
                }
            }
        }
        let of: Vec<Opposite> = (0..n)
            .map(|k| {
                let first = root(&mut directed, 2 * k);
                Opposite { first: first / 2, is_reversed: first % 2 == 1 }
            })
            .collect();
        // A segment that is opposite to itself turned round cannot follow a law that is not the same from both ends.
        let turned: Vec<bool> = (0..n).map(|k| root(&mut directed, 2 * k) == root(&mut directed, 2 * k + 1)).collect();
        for (f, face) in layout.faces.iter().enumerate() {
            for direction in [0, 1] {
                let is_turned = |k: usize| face.sides.get(k).is_some_and(|side| side.uses.iter().any(|part| turned[part.segment]));
                aligned[f][direction] &= !is_turned(direction) && !is_turned(direction + 2);
            }
        }
        let strip = (0..n).map(|k| root(&mut strip, k)).collect();
        Self { of, strip, aligned }
    }

    /// The group of a segment.
    pub fn of(&self, segment: usize) -> Opposite {
        self.of[segment]
    }

    /// The strip of a segment.
    pub fn strip(&self, segment: usize) -> usize {
        self.strip[segment]
    }

    /// Whether each segment of a side of a face along a direction has one opposite to it, or the other side is a pole.
    pub fn is_aligned(&self, face: usize, direction: usize) -> bool {
        self.aligned[face][direction]
    }
}

/// Whether two sides are divided into segments at the same shares of their lengths, or one of them is a pole.
fn is_aligned(a: &FaceSide, b: &FaceSide, near: f64) -> bool {
    let end = |side: &FaceSide, k: usize| side.uses[k].s.1 / side.length;
    let same = |k: usize| (end(a, k) - end(b, k)).abs() * a.length.min(b.length) <= near;
    a.uses.is_empty() || b.uses.is_empty() || a.uses.len() == b.uses.len() && (0..a.uses.len()).all(same)
}
