//! Odd counts: a step of the border that is the whole side of a cell, not half of one, goes on through the cells as a row of
//! sides that are not halved either, and ends at another such step.
//!
//! Around each cell the sides that are not halved are then even in number, and so are the steps, which is all that quads need.
//! It does not matter on which loops of the face the odd counts are.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::base::job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::net::Net;
use crate::mesh::quad::settings::ROW_COSTS;

/// Which sides of each face are not halved, as bits; `None` where borders part the odd counts.
pub fn whole_sides(net: &Net) -> Option<Vec<u8>> {
    let mut rows = Rows { net, whole: vec![0; net.face.len()] };
    for f in 0..net.face.len() {
        job::poll();
        for k in 0..net.corners(f).len() {
            rows.whole[f] |= u8::from(rows.is_border(f, k) && net.mid[f][k] == NONE) << k;
        }
    }
    let ends: Vec<usize> = (0..net.face.len()).filter(|f| rows.whole[*f].count_ones() % 2 == 1).collect();
    if ends.len() > ROW_COSTS.max_permuted_ends {
        rows.nearest(ends)?;
        return Some(rows.whole);
    }
    let mut best: Option<(u32, Vec<u8>)> = None;
    for way in ways(&ends) {
        let mut trial = Rows { net, whole: rows.whole.clone() };
        let cost = way.iter().map(|(a, b)| trial.join(*a, &[*b]).map(|found| found.1)).sum::<Option<u32>>();
        if let Some(cost) = cost
            && best.as_ref().is_none_or(|best| cost < best.0)
        {
            best = Some((cost, trial.whole));
        }
    }
    best.map(|best| best.1)
}

/// All ways to take some two by two.
fn ways(of: &[usize]) -> Vec<Vec<(usize, usize)>> {
    let Some((first, rest)) = of.split_first() else { return vec![Vec::new()] };
    let mut all = Vec::new();
    for (k, other) in rest.iter().enumerate() {
        let left: Vec<usize> = rest[..k].iter().chain(&rest[k + 1..]).copied().collect();
        all.extend(ways(&left).into_iter().map(|mut way| {
            way.push((*first, *other));
            way
        }));
    }
    all
}

struct Rows<'a> {
    net: &'a Net,
    whole: Vec<u8>,
}

/// A face that a row gets into over a side, for so much.
#[derive(PartialEq, Eq)]
struct RowStep {
    cost: u32,
    state: usize,
}

impl Ord for RowStep {
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.cmp(&self.cost).then(other.state.cmp(&self.state))
    }
}

impl PartialOrd for RowStep {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Rows<'_> {
    fn is_border(&self, f: usize, k: usize) -> bool {
        self.net.locked[f] >> k & 1 == 1
    }

    /// Joins each end to the nearest one that is left.
    fn nearest(&mut self, mut ends: Vec<usize>) -> Option<()> {
        while let Some((first, others)) = ends.split_first() {
            let (other, _) = self.join(*first, others)?;
            ends = others.iter().copied().filter(|e| *e != other).collect();
        }
        Some(())
    }

    /// The cost of a face between two of its sides.
    fn cost(&self, f: usize, from: usize, to: usize) -> u32 {
        let own = if self.net.face[f][3] == NONE {
            if self.is_border(f, 3 - from - to) { ROW_COSTS.flat_triangle } else { ROW_COSTS.triangle }
        } else if from.abs_diff(to) == 2 {
            ROW_COSTS.straight
        } else {
            ROW_COSTS.corner
        };
        own + if self.whole[f].count_ones() > 1 { ROW_COSTS.crossed_again } else { 0 }
    }

    /// Lays the cheapest row from a face to the nearest of others; which one that is, and what it costs.
    fn join(&mut self, start: usize, others: &[usize]) -> Option<(usize, u32)> {
        let net = self.net;
        let first = (self.whole[start].trailing_zeros() as usize).min(3);
        let mut known = vec![(u32::MAX, usize::MAX); 4 * net.face.len()];
        let mut open = BinaryHeap::from([RowStep { cost: 0, state: 4 * start + first }]);
        known[4 * start + first] = (0, usize::MAX);
        let mut last = None;
        while let Some(RowStep { cost, state }) = open.pop() {
            job::poll();
            let (f, from) = (state / 4, state % 4);
            if cost > known[state].0 {
                continue;
            }
            if f != start && others.contains(&f) {
                last = Some((state, cost));
                break;
            }
            for to in (0..net.corners(f).len()).filter(|k| *k != from && !self.is_border(f, *k)) {
                let next = net.across[f][to];
                if next == NONE || next as usize / 4 == f {
                    continue;
                }
                let there = cost + self.cost(f, from, to);
                if there < known[next as usize].0 {
                    known[next as usize] = (there, state);
                    open.push(RowStep { cost: there, state: next as usize });
                }
            }
        }
        let (mut state, cost) = last?;
        let end = state / 4;
        while known[state].1 != usize::MAX {
            let back = net.across[state / 4][state % 4] as usize;
            self.whole[state / 4] ^= 1 << (state % 4);
            self.whole[back / 4] ^= 1 << (back % 4);
            state = known[state].1;
        }
        Some((end, cost))
    }
}
