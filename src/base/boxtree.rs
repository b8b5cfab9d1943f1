//! A tree of boxes: which boxes touch a box, and which touch each other.
//!
//! Items are sorted along a space-filling curve and packed in groups of eight, groups again in groups: arrays only,
//! no pointers, no balancing [Kamel & Faloutsos 1993].
//!
//! The cells of the curve are shaped as the boxes are. Boxes of mean size b whose middles lie in a cell of size c make a
//! group of size c + b, and how many other groups it touches goes with Π(cᵢ + bᵢ); for cells of one volume that is least
//! where c is proportional to b.

use glam::DVec3;

use super::bbox::Box3;
use super::{job, work};

/// Children of a node.
const FAN: usize = 8;
/// Work of a pair that is found where hardly anything is done with it, in evaluations of a curve.
pub const PAIR: u64 = 4;
/// Bits of each coordinate in the sorting key.
const KEY_BITS: u32 = 21;
/// Bits that are looked up at once, and how many times.
const PART: usize = 7;
const PARTS: usize = KEY_BITS as usize / PART;

/// Boxes that can be asked for neighbours. Items keep the index they had in the list given.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    /// Item of each place in sorting order.
    items: Vec<u32>,
    /// Level 0: boxes of the items in sorting order; each next level: boxes of groups of [`FAN`] of the level below.
    levels: Vec<Vec<Box3>>,
}

impl BoxTree {
    /// A tree over boxes; O(n log n).
    pub fn build(boxes: &[Box3]) -> Self {
        let all = boxes.iter().fold(Box3::EMPTY, |all, b| all.union(*b));
        let size = all.max - all.min;
        let scale = |x: f64| if x > 0.0 { ((1_u64 << KEY_BITS) - 1) as f64 / x } else { 0.0 };
        let scale = DVec3::new(scale(size.x), scale(size.y), scale(size.z));
        let parts = key_parts(&cuts(boxes, size));
        let key = |b: &Box3| {
            let at = (b.center() - all.min) * scale;
            let key =
                |axis: usize, at: usize| (0..PARTS).fold(0, |key, part| key | parts[axis][part][(at >> (part * PART)) & ((1 << PART) - 1)]);
            key(0, at.x as usize) | key(1, at.y as usize) | key(2, at.z as usize)
        };
        let mut order: Vec<(u64, u32)> = boxes.iter().enumerate().map(|(k, b)| (key(b), k as u32)).collect();
        order.sort_unstable();
        let mut levels = vec![order.iter().map(|&(_, k)| boxes[k as usize]).collect::<Vec<_>>()];
        while levels[levels.len() - 1].len() > FAN {
            let below = &levels[levels.len() - 1];
            let above = below.chunks(FAN).map(|group| group.iter().fold(Box3::EMPTY, |all, b| all.union(*b))).collect();
            levels.push(above);
        }
        Self { items: order.into_iter().map(|(_, k)| k).collect(), levels }
    }

    /// The items of [`BoxTree::query`], ascending.
    pub fn near(&self, bbox: &Box3, margin: f64) -> Vec<usize> {
        job::poll();
        let mut found = Vec::new();
        self.query(bbox, margin, |k| found.push(k));
        found.sort_unstable();
        found
    }

    /// Calls `found` with each item whose box comes within `margin` of `bbox` along every axis, in no particular order.
    pub fn query(&self, bbox: &Box3, margin: f64, mut found: impl FnMut(usize)) {
        let Some(top) = self.levels.len().checked_sub(1) else { return };
        let mut stack: Vec<(usize, usize)> = (0..self.levels[top].len()).map(|k| (top, k)).collect();
        while let Some((level, k)) = stack.pop() {
            if !self.levels[level][k].touches(bbox, margin) {
                continue;
            }
            if level == 0 {
                found(self.items[k] as usize);
            } else {
                stack.extend(self.children(level, k).map(|c| (level - 1, c)));
            }
        }
    }

    /// All pairs of items whose boxes come within `margin` of each other along every axis, ascending, the smaller index first.
    ///
    /// Each costs `work`, in evaluations of a curve, so that the list is not longer than a budget allows.
    pub fn pairs(&self, margin: f64, work: u64) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        let Some(top) = self.levels.len().checked_sub(1) else { return pairs };
        // Nodes of one level that touch, to be looked into; equal ones touch themselves.
        let mut stack: Vec<(usize, usize, usize)> = Vec::new();
        let mut look = |stack: &mut Vec<(usize, usize, usize)>, level: usize, a: usize, others: std::ops::Range<usize>| {
            let boxes = &self.levels[level];
            let own = boxes[a].grown(margin);
            for b in others.filter(|&b| a == b || own.touches(&boxes[b], 0.0)) {
                if level > 0 {
                    stack.push((level, a, b));
                } else if a != b {
                    work::spend(work);
                    let (a, b) = (self.items[a], self.items[b]);
                    pairs.push((a.min(b), a.max(b)));
                }
            }
        };
        let n = self.levels[top].len();
        for a in 0..n {
            look(&mut stack, top, a, a..n);
        }
        while let Some((level, a, b)) = stack.pop() {
            job::poll();
            for c in self.children(level, a) {
                // A child that is away from the whole other node is away from all in it.
                if a != b && !self.levels[level - 1][c].touches(&self.levels[level][b], margin) {
                    continue;
                }
                let others = if a == b { c..self.children(level, a).end } else { self.children(level, b) };
                look(&mut stack, level - 1, c, others);
            }
        }
        sort_pairs(&mut pairs, self.items.len());
        pairs
    }

    /// Calls `found` with each pair of an item of this tree and one of another whose boxes come within `margin` of each
    /// other along every axis, in no particular order.
    pub fn pairs_with(&self, other: &Self, margin: f64, mut found: impl FnMut(usize, usize)) {
        let (Some(top), Some(other_top)) = (self.levels.len().checked_sub(1), other.levels.len().checked_sub(1)) else { return };
        let mut stack: Vec<(usize, usize, usize, usize)> = Vec::new();
        for a in 0..self.levels[top].len() {
            stack.extend((0..other.levels[other_top].len()).map(|b| (top, a, other_top, b)));
        }
        while let Some((level, a, other_level, b)) = stack.pop() {
            job::poll();
            if !self.levels[level][a].touches(&other.levels[other_level][b], margin) {
                continue;
            }
            if level == 0 && other_level == 0 {
                found(self.items[a] as usize, other.items[b] as usize);
            } else if level >= other_level {
                stack.extend(self.children(level, a).map(|c| (level - 1, c, other_level, b)));
            } else {
                stack.extend(other.children(other_level, b).map(|c| (level, a, other_level - 1, c)));
            }
        }
    }

    fn children(&self, level: usize, k: usize) -> std::ops::Range<usize> {
        k * FAN..((k + 1) * FAN).min(self.levels[level - 1].len())
    }
}

/// Sorts pairs of `n` items: counted by their first item, then sorted by the second one.
fn sort_pairs(pairs: &mut [(u32, u32)], n: usize) {
    let mut next = vec![0_u32; n + 1];
    for (a, _) in pairs.iter() {
        next[*a as usize + 1] += 1;
    }
    for k in 0..n {
        next[k + 1] += next[k];
    }
    let mut seconds = vec![0_u32; pairs.len()];
    for (a, b) in pairs.iter() {
        let place = &mut next[*a as usize];
        seconds[*place as usize] = *b;
        *place += 1;
    }
    // Where the pairs of an item end, those of the next one begin.
    let mut from = 0;
    for (a, to) in next[..n].iter().map(|to| *to as usize).enumerate() {
        seconds[from..to].sort_unstable();
        pairs[from..to].iter_mut().zip(&seconds[from..to]).for_each(|(pair, b)| *pair = (a as u32, *b));
        from = to;
    }
}

/// The bits of a coordinate in the sorting key, `PART` of them at a time.
type KeyParts = [[[u64; 1 << PART]; PARTS]; 3];

/// What each coordinate adds to the key when the cuts, the first one highest, are its bits.
fn key_parts(cuts: &[(usize, u32)]) -> KeyParts {
    let mut parts = [[[0; 1 << PART]; PARTS]; 3];
    for (place, &(axis, bit)) in cuts.iter().rev().enumerate() {
        let (part, bit) = (bit as usize / PART, bit as usize % PART);
        for (value, key) in parts[axis][part].iter_mut().enumerate() {
            *key |= ((value >> bit & 1) as u64) << place;
        }
    }
    parts
}

/// Bits of the coordinates, as axis and place, in the order in which they cut the cells: always across the longest side
/// of the cell, measured in mean boxes.
fn cuts(boxes: &[Box3], size: DVec3) -> Vec<(usize, u32)> {
    let mean = boxes.iter().map(|b| b.max - b.min).sum::<DVec3>() / boxes.len().max(1) as f64;
    // Boxes that are points along an axis count as thin ones: the last cell of the longest axis.
    let unit = mean.max(DVec3::splat(size.max_element() / (1_u64 << KEY_BITS) as f64));
    let mut cell = (size / unit).to_array();
    let mut left = size.to_array().map(|x| if x > 0.0 { KEY_BITS } else { 0 });
    let mut cuts = Vec::with_capacity(3 * KEY_BITS as usize);
    while let Some(axis) = (0..3).filter(|&axis| left[axis] > 0).reduce(|a, b| if cell[b] > cell[a] { b } else { a }) {
        left[axis] -= 1;
        cell[axis] *= 0.5;
        cuts.push((axis, left[axis]));
    }
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes(n: usize) -> Vec<Box3> {
        let mut state = 1_u64;
        let mut next = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..n)
            .map(|k| {
                let min = DVec3::new(next(), next(), if k % 5 == 0 { 0.0 } else { next() });
                Box3 { min, max: min + DVec3::new(next(), next(), next()) * 0.1 }
            })
            .collect()
    }

    #[test]
    fn pairs_and_queries_are_those_of_comparing_all() {
        for n in [0, 1, 2, 8, 9, 70, 300] {
            let (boxes, margin) = (boxes(n), 0.01);
            let tree = BoxTree::build(&boxes);
            let mut all = Vec::new();
            for a in 0..n {
                let mut near: Vec<usize> = Vec::new();
                tree.query(&boxes[a], margin, |k| near.push(k));
                near.sort_unstable();
                let expected: Vec<usize> = (0..n).filter(|&b| boxes[b].touches(&boxes[a], margin)).collect();
                assert_eq!(near, expected, "{n}");
                all.extend(expected.iter().filter(|&&b| b > a).map(|&b| (a as u32, b as u32)));
            }
            assert_eq!(tree.pairs(margin, PAIR), all, "{n}");
        }
    }

    /// Tall thin boxes in a long row, one of them over all: pairs are right, and groups of eight hold few strangers.
    #[test]
    fn thin_boxes_are_grouped_with_their_neighbours() {
        for turn in 0..3 {
            let mut thin = boxes(1000);
            for (k, b) in thin.iter_mut().enumerate() {
                b.min.x = 100.0 * k as f64;
                b.max = DVec3::new(b.min.x + 100.0, b.min.y + 0.3, 0.0);
                b.min.z = 0.0;
            }
            thin[7] = Box3 { min: DVec3::ZERO, max: DVec3::new(1e5, 0.1, 0.0) };
            let rolled = |p: DVec3| DVec3::from_array(std::array::from_fn(|axis| p[(axis + turn) % 3]));
            let thin: Vec<Box3> = thin.iter().map(|b| Box3 { min: rolled(b.min), max: rolled(b.max) }).collect();
            let tree = BoxTree::build(&thin);
            let pairs: Vec<(u32, u32)> = (0..1000_u32)
                .flat_map(|a| (a + 1..1000).map(move |b| (a, b)))
                .filter(|&(a, b)| thin[a as usize].touches(&thin[b as usize], 0.0))
                .collect();
            assert_eq!(tree.pairs(0.0, PAIR), pairs);
            let groups = &tree.levels[1];
            let touching = |a: &Box3| groups.iter().filter(|b| a.touches(b, 0.0)).count();
            let most = groups.iter().map(touching).filter(|&n| n < groups.len() / 2).max();
            assert!(most.is_some_and(|n| n <= 6), "{most:?}");
        }
    }

    #[test]
    fn pairs_of_two_trees_are_those_of_comparing_all() {
        let (first, second, margin) = (boxes(300), boxes(77), 0.02);
        let mut pairs = Vec::new();
        BoxTree::build(&first).pairs_with(&BoxTree::build(&second), margin, |a, b| pairs.push((a, b)));
        pairs.sort_unstable();
        let all = (0..300).flat_map(|a| (0..77).map(move |b| (a, b)));
        assert_eq!(pairs, all.filter(|&(a, b)| first[a].touches(&second[b], margin)).collect::<Vec<_>>());
    }

    #[test]
    fn boxes_in_one_place_are_all_pairs() {
        let tree = BoxTree::build(&vec![Box3::of([DVec3::ONE]); 40]);
        let all = 40 * 39 / 2;
        assert_eq!(work::measured(|| tree.pairs(0.0, 32).len()), (all, 32 * all as u64));
    }
}
