//! Where numbers of entities and lines are in a file.

/// Records by their numbers.
#[derive(Debug, Default)]
pub struct Places {
    /// Numbers with the indices of their records, ascending.
    sorted: Vec<(u32, u32)>,
    /// The record of each number from 0, where most numbers are used.
    direct: Vec<u32>,
}

/// A table of all numbers may be so many times as long as there are records.
const SPARSE: usize = 4;
const NONE: u32 = u32::MAX;

impl Places {
    /// The places of records with these numbers, and the records whose number an earlier one has.
    pub fn of(ids: impl Iterator<Item = u32>) -> (Self, Vec<u32>) {
        let mut sorted: Vec<(u32, u32)> = ids.zip(0..).collect();
        sorted.sort_unstable();
        let mut doubled: Vec<u32> = sorted.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1).collect();
        doubled.sort_unstable();
        sorted.dedup_by_key(|p| p.0);
        let most = sorted.last().map_or(0, |p| p.0 as usize);
        if most <= SPARSE * sorted.len() {
            let mut direct = vec![NONE; most + 1];
            sorted.iter().for_each(|(id, k)| direct[*id as usize] = *k);
            return (Self { sorted: Vec::new(), direct }, doubled);
        }
        (Self { sorted, direct: Vec::new() }, doubled)
    }

    /// The record of a number.
    pub fn find(&self, id: u32) -> Option<u32> {
        if self.sorted.is_empty() {
            return self.direct.get(id as usize).copied().filter(|k| *k != NONE);
        }
        self.sorted.binary_search_by_key(&id, |p| p.0).ok().map(|at| self.sorted[at].1)
    }
}

/// Starts of lines, which end in LF, CR LF or CR.
#[derive(Debug)]
pub struct Lines(Vec<u32>);

impl Lines {
    /// The lines of a file.
    pub fn of(bytes: &[u8]) -> Self {
        let ends = |k: &usize| bytes[*k] == b'\n' || (bytes[*k] == b'\r' && bytes.get(k + 1) != Some(&b'\n'));
        Self(std::iter::once(0).chain((0..bytes.len()).filter(ends).map(|k| k as u32 + 1)).collect())
    }

    /// The line of a byte, from 1.
    pub fn of_byte(&self, at: u32) -> u64 {
        self.0.partition_point(|start| *start <= at) as u64
    }
}
