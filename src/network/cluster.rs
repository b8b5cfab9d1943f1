//! Points that are one: groups of points joined by steps of at most the tolerance.
//!
//! Sorting instead of pointers: a group is sorted along an axis and cut where neighbours are further apart than the
//! tolerance, axis after axis, until no cut is left; only then are distances taken. Points that share a coordinate
//! (grids, plane models) cost no more than others. Points of one place, as ends that meet have it, are one beforehand.

use glam::DVec3;

use crate::base::job;

/// Groups of at most this many points are compared pair by pair.
const SMALL: usize = 6;

/// For each point the least index of its group; points at most `reach` apart are in one group.
pub fn cluster(points: &[DVec3], reach: f64) -> Vec<u32> {
    let first = first_of_place(points);
    let mut order: Vec<u32> = first.iter().zip(0..).filter(|(first, k)| *first == k).map(|(_, k)| k).collect();
    let mut sets = Sets { parent: first };
    let mut keyed: Vec<(i64, u32)> = Vec::new();
    // Ranges of `order`, the axis to sort them by, and how many axes in a row did not cut them.
    let mut stack = vec![(0, order.len(), 0, 0)];
    while let Some((from, to, axis, uncut)) = stack.pop() {
        job::poll();
        let group = &mut order[from..to];
        if group.len() <= SMALL {
            join_close(points, group, reach, &mut sets);
            continue;
        }
        if uncut == 3 {
            join_dense(points, group, reach, &mut sets);
            continue;
        }
        let at = |k: u32| points[k as usize][axis];
        // Beside their coordinates the indices are sorted without looking far.
        keyed.clear();
        keyed.extend(group.iter().map(|&k| (in_total_order(at(k)), k)));
        keyed.sort_unstable();
        group.iter_mut().zip(&keyed).for_each(|(k, (_, sorted))| *k = *sorted);
        let mut start = 0;
        for k in 1..=group.len() {
            if k == group.len() || at(group[k]) - at(group[k - 1]) > reach {
                let whole = k - start == group.len();
                if k - start > 1 {
                    stack.push((from + start, from + k, (axis + 1) % 3, if whole { uncut + 1 } else { 1 }));
                }
                start = k;
            }
        }
    }
    sets.roots()
}

/// A whole number for each real, in the order of [`f64::total_cmp`].
fn in_total_order(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// For each point the index of the first one with the same finite coordinates.
fn first_of_place(points: &[DVec3]) -> Vec<u32> {
    const FREE: u32 = u32::MAX;
    let mask = (2 * points.len()).next_power_of_two() - 1;
    let mut slots = vec![FREE; mask + 1];
    let mut first: Vec<u32> = (0..points.len() as u32).collect();
    for (k, p) in points.iter().enumerate().filter(|(_, p)| p.is_finite()) {
        let mut slot = hash(*p) & mask;
        while slots[slot] != FREE && points[slots[slot] as usize] != *p {
            slot = (slot + 1) & mask;
        }
        if slots[slot] == FREE {
            slots[slot] = k as u32;
        }
        first[k] = slots[slot];
    }
    first
}

/// Multiplied and rotated, mixed at the end; equal for the two zeros.
fn hash(p: DVec3) -> usize {
    const K: u64 = 0x9e37_79b9_7f4a_7c15;
    let h = (p + DVec3::ZERO).to_array().into_iter().fold(0, |h: u64, x| (h.rotate_left(23) ^ x.to_bits()).wrapping_mul(K));
    (h ^ (h >> 29)).wrapping_mul(K) as usize >> 20
}

fn join_close(points: &[DVec3], group: &[u32], reach: f64, sets: &mut Sets) {
    for (k, &a) in group.iter().enumerate() {
        for &b in &group[k + 1..] {
            if points[a as usize].distance_squared(points[b as usize]) <= reach * reach {
                sets.join(a, b);
            }
        }
    }
}

/// A group without gaps along any axis: all one when it is small enough, else a sweep along its widest axis.
fn join_dense(points: &[DVec3], group: &mut [u32], reach: f64, sets: &mut Sets) {
    let (low, high) =
        group.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), &k| (lo.min(points[k as usize]), hi.max(points[k as usize])));
    let size = high - low;
    if size.length_squared() <= reach * reach {
        for &k in &group[1..] {
            sets.join(group[0], k);
        }
        return;
    }
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let at = |k: u32| points[k as usize][axis];
    group.sort_unstable_by(|&a, &b| at(a).total_cmp(&at(b)));
    for (k, &a) in group.iter().enumerate() {
        for &b in group[k + 1..].iter().take_while(|&&b| at(b) - at(a) <= reach) {
            if points[a as usize].distance_squared(points[b as usize]) <= reach * reach {
                sets.join(a, b);
            }
        }
    }
}

/// Union–find with path halving; a root is the least index of its set.
#[derive(Clone, Debug)]
pub struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// Each index by itself.
    pub fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    /// Least index of the set that holds `k`.
    pub fn root(&mut self, mut k: u32) -> u32 {
        while self.parent[k as usize] != k {
            let above = self.parent[self.parent[k as usize] as usize];
            self.parent[k as usize] = above;
            k = above;
        }
        k
    }

    /// Makes one set of two.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// Root of every index.
    pub fn roots(mut self) -> Vec<u32> {
        (0..self.parent.len() as u32).map(|k| self.root(k)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slow(points: &[DVec3], reach: f64) -> Vec<u32> {
        let mut sets = Sets::new(points.len());
        let all: Vec<u32> = (0..points.len() as u32).collect();
        join_close(points, &all, reach, &mut sets);
        sets.roots()
    }

    #[test]
    fn groups_are_those_of_comparing_all() {
        let mut state = 3_u64;
        let mut next = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for (n, reach, flat) in
            [(0, 0.1, false), (1, 0.1, false), (200, 0.02, true), (300, 0.08, false), (300, 0.3, false), (150, 2.0, false)]
        {
            let points: Vec<DVec3> =
                (0..n).map(|_| DVec3::new(next(), if flat { 0.5 } else { next() }, (next() * 8.0).floor() / 8.0)).collect();
            assert_eq!(cluster(&points, reach), slow(&points, reach), "{n} {reach}");
        }
    }

    #[test]
    fn many_points_in_one_place_are_one() {
        let points = vec![DVec3::new(1.0, 2.0, 3.0); 20_000];
        assert!(cluster(&points, 1e-6).iter().all(|&root| root == 0));
    }
}
