//! File names that could have been meant.

use std::fs;
use std::path::Path;

/// How many names are offered.
const OFFERED: usize = 3;

/// Names in the folder of `wanted` that look like it, best first.
///
/// Same words in another order come first (`bow_offsets.csv`, `offsets_bow.csv`), then names a few letters away.
pub fn similar_names(wanted: &Path) -> Vec<String> {
    let folder = match wanted.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let Some(name) = wanted.file_name().and_then(|n| n.to_str()) else { return Vec::new() };
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
    let mut ranked: Vec<(usize, String)> =
        names.filter(|n| !n.starts_with('.')).filter_map(|other| distance(name, &other).map(|d| (d, other))).collect();
    ranked.sort();
    ranked.into_iter().take(OFFERED).map(|(_, name)| name).collect()
}

/// How far two words are from each other; `None` when too far to be meant.
pub(super) fn word_distance(a: &str, b: &str) -> Option<usize> {
    let d = edit_distance(a, b);
    (d <= a.chars().count().min(b.chars().count()).div_ceil(3)).then_some(d)
}

/// How far two file names are from each other; `None` when too far to be meant.
fn distance(a: &str, b: &str) -> Option<usize> {
    let (a, b) = (a.to_lowercase(), b.to_lowercase());
    if words(&a) == words(&b) {
        return Some(0);
    }
    let stem = |s: &str| s.rsplit_once('.').map_or(s.len(), |(stem, _)| stem.len());
    if a[..stem(&a)] == b[..stem(&b)] {
        return Some(1);
    }
    let d = edit_distance(&a, &b);
    (d <= a.chars().count().min(b.chars().count()).div_ceil(4)).then_some(d + 1)
}

fn words(name: &str) -> Vec<&str> {
    let mut words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    words.sort_unstable();
    words
}

/// Least number of letters to add, drop or change.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let change = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = change.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_in_another_order_are_nearest() {
        assert_eq!(distance("bow_offsets.csv", "offsets_bow.csv"), Some(0));
        assert_eq!(distance("offsets.csv", "offsets.txt"), Some(1));
        assert_eq!(distance("ofsets.csv", "offsets.csv"), Some(2));
        assert_eq!(distance("a.csv", "readme.md"), None);
    }
}
