//! A tree of boxes: which boxes touch a box, and which touch each other.
//!
//! Items are sorted along a space-filling curve and packed in groups of eight, groups again in groups: arrays only,
//! no pointers, no balancing [Kamel & Faloutsos 1993].

use super::bbox::Box3;

/// Children of a node.
const FAN: usize = 8;
/// Bits of each coordinate in the sorting key.
const KEY_BITS: u32 = 21;

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
        let key = |b: &Box3| {
            let at = b.center() - all.min;
            spread((at.x * scale(size.x)) as u64) | spread((at.y * scale(size.y)) as u64) << 1 | spread((at.z * scale(size.z)) as u64) << 2
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
    pub fn pairs(&self, margin: f64) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        let Some(top) = self.levels.len().checked_sub(1) else { return pairs };
        // Nodes of one level, to be compared with each other; equal ones with themselves.
        let mut stack: Vec<(usize, usize, usize)> = Vec::new();
        let n = self.levels[top].len();
        for a in 0..n {
            stack.extend((a..n).map(|b| (top, a, b)));
        }
        while let Some((level, a, b)) = stack.pop() {
            let boxes = &self.levels[level];
            if a != b && !boxes[a].touches(&boxes[b], margin) {
                continue;
            }
            if level == 0 {
                if a != b {
                    let (a, b) = (self.items[a], self.items[b]);
                    pairs.push((a.min(b), a.max(b)));
                }
                continue;
            }
            let below = level - 1;
            for c in self.children(level, a) {
                let others = if a == b { c..self.children(level, a).end } else { self.children(level, b) };
                stack.extend(others.map(|d| (below, c, d)));
            }
        }
        pairs.sort_unstable();
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

/// Moves bit i of a coordinate to bit 3i.
fn spread(x: u64) -> u64 {
    let mut x = x & ((1 << KEY_BITS) - 1);
    for (shift, mask) in [
        (32, 0x1f_0000_0000_ffff),
        (16, 0x1f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

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
            assert_eq!(tree.pairs(margin), all, "{n}");
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
        assert_eq!(tree.pairs(0.0).len(), 40 * 39 / 2);
    }
}
