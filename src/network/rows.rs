//! The stations of all curves in one list, curve by curve.

use std::collections::BTreeMap;

use super::assemble::Station;

/// A row of stations for each curve.
#[derive(Debug)]
pub struct Rows {
    /// Where the row of each curve begins; one more at the end.
    first: Vec<u32>,
    all: Vec<Station>,
    /// Rows that were replaced later.
    others: BTreeMap<usize, Vec<Station>>,
}

impl Rows {
    /// The rows of `n` curves; the stations of a curve keep their order.
    pub fn of(n: usize, stations: impl Iterator<Item = (u32, Station)> + Clone) -> Self {
        let mut first = vec![0_u32; n + 1];
        for (curve, _) in stations.clone() {
            first[curve as usize + 1] += 1;
        }
        for k in 0..n {
            first[k + 1] += first[k];
        }
        let mut next = first.clone();
        let mut all = vec![Station { s: 0.0, node: 0 }; first[n] as usize];
        for (curve, station) in stations {
            let place = &mut next[curve as usize];
            all[*place as usize] = station;
            *place += 1;
        }
        Self { first, all, others: BTreeMap::new() }
    }

    /// How many curves there are.
    pub fn len(&self) -> usize {
        self.first.len() - 1
    }

    /// The row of a curve.
    pub fn row(&self, k: usize) -> &[Station] {
        let first = || &self.all[self.first[k] as usize..self.first[k + 1] as usize];
        self.others.get(&k).map_or_else(first, Vec::as_slice)
    }

    /// Replaces the row of a curve.
    pub fn set(&mut self, k: usize, row: Vec<Station>) {
        self.others.insert(k, row);
    }

    /// Changes each row, which must not get longer; to be called before any is replaced.
    pub fn change_each(&mut self, mut change: impl FnMut(usize, &mut Vec<Station>)) {
        let (mut row, mut from, mut to) = (Vec::new(), 0, 0);
        for k in 0..self.len() {
            let end = self.first[k + 1] as usize;
            row.clear();
            row.extend_from_slice(&self.all[from..end]);
            change(k, &mut row);
            self.all[to..to + row.len()].copy_from_slice(&row);
            self.first[k] = to as u32;
            (from, to) = (end, to + row.len());
        }
        if let Some(last) = self.first.last_mut() {
            *last = to as u32;
        }
        self.all.truncate(to);
    }
}
