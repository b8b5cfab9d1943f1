//! Interned names, compared in normal form C, and the nearest of several names.

use unicode_normalization::{UnicodeNormalization, is_nfc};

crate::ids! {
    /// A name; equal names have equal ids.
    Name,
}

/// All names of a run, numbered in the order in which they were first seen.
///
/// The table is open-addressed with a hash of our own, so that nothing depends on the run.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// All texts, one behind the other.
    text: String,
    /// Where the text of each name ends; it begins where the one before ends.
    ends: Vec<u32>,
    /// Name numbers plus one by hash; 0 is free. The length is a power of two, at least twice the number of names.
    slots: Vec<u32>,
    hashes: Vec<u32>,
}

impl Names {
    /// The id of a name, new or known; the text is brought to normal form C.
    pub fn intern(&mut self, text: &str) -> Name {
        if text.is_ascii() || is_nfc(text) {
            return self.intern_normal(text);
        }
        self.intern_normal(&text.nfc().collect::<String>())
    }

    /// The id of a name that is known already.
    pub fn find(&self, text: &str) -> Option<Name> {
        if text.is_ascii() || is_nfc(text) {
            return self.slot(text, hash(text)).ok();
        }
        let text: String = text.nfc().collect();
        self.slot(&text, hash(&text)).ok()
    }

    /// Text of a name.
    pub fn text(&self, name: Name) -> &str {
        let index = name.index();
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.text[start as usize..self.ends[index] as usize]
    }

    /// Number of names.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    fn intern_normal(&mut self, text: &str) -> Name {
        if self.slots.len() < 2 * (self.ends.len() + 1) {
            self.grow();
        }
        let hash = hash(text);
        match self.slot(text, hash) {
            Ok(name) => name,
            Err(slot) => {
                let name = Name::at(self.ends.len());
                self.text.push_str(text);
                self.ends.push(self.text.len() as u32);
                self.hashes.push(hash);
                self.slots[slot] = name.0 + 1;
                name
            }
        }
    }

    /// The name with this text, or the free slot where it belongs.
    fn slot(&self, text: &str, hash: u32) -> Result<Name, usize> {
        let mask = self.slots.len().wrapping_sub(1);
        if self.slots.is_empty() {
            return Err(0);
        }
        let mut slot = hash as usize & mask;
        loop {
            match self.slots[slot] {
                0 => return Err(slot),
                n => {
                    let name = Name(n - 1);
                    if self.hashes[name.index()] == hash && self.text(name) == text {
                        return Ok(name);
                    }
                }
            }
            slot = (slot + 1) & mask;
        }
    }

    fn grow(&mut self) {
        let size = (self.slots.len() * 2).max(64);
        self.slots.clear();
        self.slots.resize(size, 0);
        for (index, &hash) in self.hashes.iter().enumerate() {
            let mut slot = hash as usize & (size - 1);
            while self.slots[slot] != 0 {
                slot = (slot + 1) & (size - 1);
            }
            self.slots[slot] = index as u32 + 1;
        }
    }
}

/// Multiply and rotate over eight bytes at a time, mixed at the end.
fn hash(text: &str) -> u32 {
    const K: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut h = text.len() as u64;
    let (chunks, rest) = text.as_bytes().as_chunks();
    for chunk in chunks {
        h = (h.rotate_left(23) ^ u64::from_le_bytes(*chunk)).wrapping_mul(K);
    }
    if !rest.is_empty() {
        let last = rest.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        h = (h.rotate_left(23) ^ last).wrapping_mul(K);
    }
    h ^= h >> 29;
    (h.wrapping_mul(K) >> 32) as u32
}

/// The candidate that was probably meant by `word`: the fewest letters wrong, at most a third of them (two swapped
/// neighbours count as one); of two equally near the one that begins like it for longer, then the first. Words that differ in case alone are nearest.
pub fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let wanted: Vec<char> = word.chars().take(64).collect();
    let allowed = wanted.len() / 3;
    let mut best: Option<((usize, usize), &str)> = None;
    for candidate in candidates {
        let limit = best.map_or((allowed * 2 + 2, 0), |(rank, _)| rank);
        let letters: Vec<char> = candidate.chars().take(65).collect();
        if letters.len().abs_diff(wanted.len()) > allowed || candidate == word {
            continue;
        }
        let alike = wanted.iter().zip(&letters).take_while(|(a, b)| a == b).count();
        let rank = (distance(&wanted, &letters, limit.0), wanted.len() - alike);
        if rank < limit {
            best = Some((rank, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Twice the number of letters inserted, deleted, replaced or swapped with their neighbour; a change of case, or of a letter for one of another script that looks like it, costs one.
/// Something above `most` where it is more than that.
fn distance(a: &[char], b: &[char], most: usize) -> usize {
    let width = b.len() + 1;
    let (mut two_back, mut back) = (vec![0; width], (0..width).map(|j| 2 * j).collect::<Vec<usize>>());
    for i in 1..=a.len() {
        let mut row = vec![2 * i; width];
        for j in 1..width {
            let (x, y) = (a[i - 1], b[j - 1]);
            let change = match x == y {
                true => 0,
                false if x.to_lowercase().eq(y.to_lowercase()) || crate::lang::words::lookalikes::alike(x, y) => 1,
                false => 2,
            };
            row[j] = (back[j] + 2).min(row[j - 1] + 2).min(back[j - 1] + change);
            if i > 1 && j > 1 && x == b[j - 2] && a[i - 2] == y {
                row[j] = row[j].min(two_back[j - 2] + 2);
            }
        }
        // What follows is made from these two rows.
        if row.iter().chain(&back).all(|d| *d > most) {
            return most + 1;
        }
        two_back = std::mem::replace(&mut back, row);
    }
    back[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_names_have_equal_ids() {
        let mut names = Names::default();
        let ids: Vec<Name> = (0..1000).map(|i| names.intern(&format!("name_{i}"))).collect();
        for (i, &id) in ids.iter().enumerate() {
            let text = format!("name_{i}");
            assert_eq!((names.intern(&text), names.find(&text), names.text(id)), (id, Some(id), text.as_str()));
        }
        assert_eq!((names.len(), names.find("other")), (1000, None));
    }

    #[test]
    fn names_compare_in_normal_form() {
        let mut names = Names::default();
        let composed = names.intern("\u{ac01}");
        assert_eq!(names.intern("\u{1100}\u{1161}\u{11a8}"), composed);
        assert_eq!(names.find("\u{1100}\u{1161}\u{11a8}"), Some(composed));
        assert_eq!(names.text(composed), "\u{ac01}");
    }

    #[test]
    fn the_nearest_name_is_near() {
        let words = ["width", "height", "roof", "A", "north"];
        let near = |word| nearest(word, words.iter().copied());
        assert_eq!(near("widht"), Some("width"));
        assert_eq!(near("hight"), Some("height"));
        assert_eq!(near("Roof"), Some("roof"));
        assert_eq!(near("a"), Some("A"));
        assert_eq!(near("span"), None);
        assert_eq!(near("B"), None);
        assert_eq!(near("nroth"), Some("north"));
        for order in [["min", "len", "line"], ["line", "len", "min"]] {
            assert_eq!(nearest("lin", order.into_iter()), Some("line"));
        }
    }
}
